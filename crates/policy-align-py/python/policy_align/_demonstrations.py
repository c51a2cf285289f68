"""Recordings from files or memory."""

from __future__ import annotations

import json
import operator
import os
import tempfile
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, episodes, floats, samples
from ._digesting import Piece
from ._errors import PolicyAlignError, PolicyAlignWarning
from ._trust import Decision, Finding, decisions, findings

#: LeRobot's name for the state.
_LEROBOT_STATE = "observation.state"

_LISTS = {"state", "velocity", "context", "ignore", "units", "degrees", "unwrap"}


@dataclass(frozen=True)
class Check:
    """The data for learning, and reasons for doubt, like the program's ``check``."""

    episodes: int
    samples: int
    channels: tuple[str, ...]
    time_step: float
    left_out: tuple[tuple[str, str], ...]
    decisions: tuple[Decision, ...]
    findings: tuple[Finding, ...]

    def __str__(self) -> str:
        amount = f"{_counted(self.episodes, 'episode')}, {_counted(self.samples, 'sample')}"
        head = f"{amount}, {'state' if len(self.channels) == 1 else 'states'} {', '.join(self.channels)}"
        left_out = [f"left out {name}: {why}" for name, why in self.left_out]
        return "\n".join([head, *left_out, *map(str, self.decisions), *(f"- {finding}" for finding in self.findings)])


class Demonstrations:
    """Movements with names, time stamps and units.

    ``len`` is the number of movements. Iteration and a single index yield (N, n) arrays of positions. Slices, masks, and
    lists of numbers or names select movements as ``Demonstrations``, so that scikit-learn splits by movement, not by
    sample. Estimators accept ``Demonstrations`` in place of arrays.
    """

    def __init__(
        self,
        trajectories: Any,
        *,
        dt: float | None = None,
        times: Iterable[Any] | None = None,
        velocities: Any = None,
        lengths: Sequence[int] | None = None,
        names: Sequence[str] | None = None,
        channels: Sequence[str] | None = None,
        units: Sequence[str | None] | None = None,
        constraints: Sequence[str | Sequence[object] | None] | None = None,
    ) -> None:
        """Takes arrays: a list of (N, n), an array (K, N, n), or a flat (M, n) with ``lengths``.

        ``dt``: seconds between samples, or ``times``: the time stamps of each movement. ``velocities``: in the form of
        ``trajectories``. If all movements have one state more than velocities, because the state after the last action was
        recorded too, that state is left out. If every movement is a DataFrame, its columns name the ``channels``.
        ``constraints``: the name of each movement's constraint or, if it changes within the movement, a list of names or
        numbers, one per sample, which marks where constraints switch.
        """
        given = episodes(trajectories, lengths, "trajectories")
        if channels is None:
            channels = _columns(given)
        count = len(given)
        positions = [_one(samples, values, "trajectories", k) for k, values in enumerate(given)]
        width = positions[0].shape[1] if positions else 0
        channels = [f"x{column}" for column in range(width)] if channels is None else [str(name) for name in channels]
        _same_length(channels, width, "channels", "columns")
        speeds = None
        if velocities is not None:
            listed = episodes(velocities, lengths, "velocities")
            _same_length(listed, count, "velocities", "trajectories")
            speeds = [_one(samples, values, "velocities", k) for k, values in enumerate(listed)]
        stamps = None
        if times is not None:
            stamps = [_stamps(values) for values in times]
            _same_length(stamps, count, "times", "trajectories")
        elif dt is None:
            hint = "dt=SECONDS (the time between samples), or times=[...] with the stamps of each movement"
            raise PolicyAlignError("neither stamps nor a time step are known", "trajectories", hint, "NoTime")
        if speeds is not None and count and all(len(x) == len(u) + 1 for x, u in zip(positions, speeds, strict=True)):
            positions = [x[:-1] for x in positions]
            stamps = stamps and [of[: len(x)] for of, x in zip(stamps, positions, strict=True)]
            if constraints is not None:
                whole = list(constraints)
                constraints = [
                    of if of is None or isinstance(of, str) else of[: len(x)] for of, x in zip(whole, positions, strict=False)
                ] + whole[count:]
        names = [str(k) for k in range(count)] if names is None else [str(name) for name in names]
        labels = [None] * count if constraints is None else list(constraints)
        unit_names = [None] * width if units is None else list(units)
        for listed_names, expected, what in ((names, count, "names"), (labels, count, "constraints")):
            _same_length(listed_names, expected, what, "trajectories")
        _same_length(unit_names, width, "units", "columns")
        of_samples = [_labels(label, len(positions[k]), k) for k, label in enumerate(labels)]
        step = None if stamps is not None else _seconds(dt)
        self._native = _native.Recordings.of(positions, speeds, (step, stamps), (names, channels), of_samples, unit_names)

    @classmethod
    def read(cls, *paths: str | os.PathLike[str], **options: Any) -> Demonstrations:
        """Reads files as one set: CSV, NPZ, JSON lines, LeRobot, HDF5, MCAP, MAT.

        Options are the program's flags: ``state``, ``velocity``, ``context``, ``time``, ``episode``, ``constraint_column``,
        ``time_unit``, ``ignore``, ``dt``, ``units``, ``degrees``, ``unwrap``, ``nan``, ``sort``, ``split_gap``, ``trim_still``,
        ``filter``, ``samples_are``, ``separator``, ``decimal``, ``topic``, ``format`` and ``trust``. Findings are issued as
        warnings, and are listed in ``notes``.
        """
        return cls._of_pieces([(os.fspath(path), len(paths) > 1, None) for path in paths], options)

    @classmethod
    def from_frame(cls, frame: Any, **options: Any) -> Demonstrations:
        """Reads a pandas or polars DataFrame like the CSV file that it would write, with the options of ``read``.

        A column of lists of equal length becomes one column per element, such as ``action_0`` for ``action``; options may
        name either. As in LeRobot's files, ``observation.state`` is the state if it is such a column and ``state`` is not
        given.
        """
        frame, lists = _without_lists(frame)
        for name in _LISTS & options.keys():
            given = [options[name]] if isinstance(options[name], str) else options[name]
            options[name] = given and [one for entry in given for one in lists.get(entry, [entry])]
        if options.get("state") is None and _LEROBOT_STATE in lists:
            options["state"] = lists[_LEROBOT_STATE]
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "frame.csv")
            if hasattr(frame, "to_csv"):
                frame.to_csv(path, index=False)
            elif hasattr(frame, "write_csv"):
                frame.write_csv(path)
            else:
                raise TypeError(f"a DataFrame is needed, not {type(frame).__name__}")
            read = cls.read(path, **options)
        return cls._of(read._native.with_origin(("[]", read._native.origin[1], "the DataFrame", read._native.origin[3])))

    def check(
        self,
        *,
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        context: str | Sequence[str] = "auto",
    ) -> Check:
        """Returns all findings and decisions before learning; parameters as for the learners."""
        found = json.loads(self._native.check(preparing(integration, scale, smooth, jumps, wraps, context)))
        return Check(
            len(found["episodes"]),
            found["samples"],
            tuple(channel["name"] for channel in found["state"]),
            found["time_step"],
            tuple((entry["episode"], entry["why"]) for entry in found["left_out"]),
            decisions(found["decisions"]),
            findings(found["findings"]),
        )

    @property
    def trajectories(self) -> list[Floats]:
        """Positions of each movement, (N, n)."""
        return list(self)

    @property
    def velocities(self) -> list[Floats] | None:
        """Velocities of each movement, (N, n); None if a movement has none."""
        found = [self._native.samples(k)[2] for k in range(len(self))]
        return None if any(one is None for one in found) else [one for one in found if one is not None]

    @property
    def times(self) -> list[Floats]:
        """Time stamps of each movement, (N), in seconds."""
        return [self._native.samples(k)[0] for k in range(len(self))]

    @property
    def dt(self) -> float:
        """The typical time between samples, in seconds."""
        return self._native.time_step

    @property
    def names(self) -> list[str]:
        """Names of the movements."""
        return self._native.names

    @property
    def channels(self) -> list[str]:
        """Names of the state's dimensions."""
        return [name for name, _ in self._native.channels]

    @property
    def constraints(self) -> list[str | list[str] | None]:
        """Label of the constraint of each movement, or of each of its samples where it changes; None without one."""
        return [each[0] if each is not None and len(set(each)) == 1 else each for each in self._native.constraints]

    @property
    def notes(self) -> list[str]:
        """Findings from reading."""
        return self._native.notes

    def __len__(self) -> int:
        return len(self._native)

    @property
    def shape(self) -> tuple[int]:
        """The number of movements, by which scikit-learn splits."""
        return (len(self),)

    @overload
    def __getitem__(self, key: int | np.integer[Any] | str) -> Floats: ...
    @overload
    def __getitem__(self, key: slice | list[Any] | npt.NDArray[Any] | tuple[Any, ...]) -> Demonstrations: ...
    def __getitem__(self, key: Any) -> Floats | Demonstrations:
        if isinstance(key, tuple) and len(key) == 2 and key[1] is Ellipsis:
            key = key[0]
        if isinstance(key, str):
            return self._native.samples(self._named(key))[1]
        if isinstance(key, slice):
            return self._some(list(range(*key.indices(len(self)))))
        if hasattr(key, "__index__") and not isinstance(key, (bool, np.bool_)) and np.ndim(key) == 0:
            return self._native.samples(self._counted(key))[1]
        chosen = np.asarray(key)
        if chosen.ndim != 1:
            raise TypeError(f"movements are chosen by a number, a name, a slice or a list of these, not {type(key).__name__}")
        if chosen.dtype.kind == "b":
            if len(chosen) != len(self):
                what = f"a mask of {len(chosen)} booleans for {len(self)} movements"
                raise PolicyAlignError(what, "Demonstrations[mask]", "one a movement, not one a sample")
            return self._some(np.flatnonzero(chosen).tolist())
        if chosen.dtype.kind in "US":
            return self._some([self._named(str(name)) for name in chosen])
        if chosen.dtype.kind not in "iu" and chosen.size:
            raise TypeError(f"movements are chosen by whole numbers, names or booleans, not {chosen.dtype}")
        return self._some([self._counted(k) for k in chosen])

    def _counted(self, k: Any) -> int:
        """The index of movement k, which may count from the end."""
        number = operator.index(k)
        place = number + len(self) if number < 0 else number
        if not 0 <= place < len(self):
            raise IndexError(f"there is no movement {number}, of {len(self)}")
        return place

    def _named(self, name: str) -> int:
        try:
            return self.names.index(name)
        except ValueError:
            few = ", ".join(self.names[:5]) + (", …" if len(self) > 5 else "")
            raise KeyError(f"there is no movement {name!r}; one of: {few}") from None

    def _some(self, places: list[int]) -> Demonstrations:
        native = self._native
        if not places:
            raise PolicyAlignError("no movement is chosen", "Demonstrations[…]", "at least one")
        times, positions, velocities = (list(each) for each in zip(*map(native.samples, places), strict=True))
        channels, units = (list(listed) for listed in zip(*native.channels, strict=True))
        names, labels = native.names, native.constraints
        of = (positions, velocities, (None, times), ([names[k] for k in places], channels), [labels[k] for k in places])
        return Demonstrations._of(_native.Recordings.of(*of, units).with_origin(native.origin))

    def __iter__(self) -> Iterator[Floats]:
        return (self._native.samples(k)[1] for k in range(len(self)))

    def __repr__(self) -> str:
        total = sum(len(one) for one in self)
        amount = f"{_counted(len(self), 'movement')}, {_counted(total, 'sample')}"
        return f"<Demonstrations: {amount} of {', '.join(self.channels)}>"

    def __reduce__(self) -> tuple[Any, ...]:
        native = self._native
        times, positions, velocities = zip(*(native.samples(k) for k in range(len(self))), strict=True)
        channels, units = (list(listed) for listed in zip(*native.channels, strict=True))
        state = (list(positions), list(velocities), (None, list(times)), (native.names, channels))
        return _restored, ((*state, native.constraints, units), native.origin)

    @classmethod
    def _of_pieces(cls, pieces: Sequence[Piece], options: Mapping[str, Any]) -> Demonstrations:
        found = cls._of(_native.Recordings.read(pieces, *reading(options)))
        for note in found.notes:
            warnings.warn(note, PolicyAlignWarning, stacklevel=3)
        return found

    @classmethod
    def _of(cls, native: _native.Recordings) -> Demonstrations:
        self = cls.__new__(cls)
        self._native = native
        return self


def preparing(
    integration: str,
    scale: dict[str, float] | None,
    smooth: str | int,
    jumps: str,
    wraps: str,
    context: str | Sequence[str],
) -> dict[str, Any]:
    """Converts options of preparation for the native half."""
    if scale is not None and not isinstance(scale, dict):
        raise TypeError(f"scale is a factor for each channel by its name, not {scale!r}: scale={{'z': 0.001}}")
    factors = list((scale or {}).items())
    return {
        "integration": integration,
        "scale": factors,
        "smooth": str(smooth),
        "jumps": jumps,
        "wraps": wraps,
        "context": context if isinstance(context, str) else [str(name) for name in context],
    }


def _without_lists(frame: Any) -> tuple[Any, dict[str, list[str]]]:
    """Replaces columns of lists by one column per element; also returns the names of these columns by original column."""
    lists: dict[str, list[str]] = {}
    if not hasattr(frame, "columns") or not len(frame):
        return frame, lists
    flat: dict[str, Any] = {}
    for place, column in enumerate(frame.columns):
        values = frame[column]
        first = values[0] if not hasattr(values, "iloc") else values.iloc[0]
        if isinstance(first, (str, bytes)) or not hasattr(first, "__len__"):
            flat[column] = values
            continue
        width = len(first)
        for k, entry in enumerate(values):
            if not hasattr(entry, "__len__") or len(entry) != width:
                what = f"column {column!r} has lists of different lengths, the first of {width}"
                raise PolicyAlignError(what, f"row {k}", "lists of equal length in every row", sample=k, column=place)
        lists[str(column)] = [f"{column}_{k}" for k in range(width)]
        array = np.array([list(entry) for entry in values])
        flat.update({name: array[:, k] for k, name in enumerate(lists[str(column)])})
    return (type(frame)(flat) if lists else frame), lists


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _restored(movements: tuple[Any, ...], origin: tuple[str, ...]) -> Demonstrations:
    positions, velocities, (step, times), *rest = movements
    native = _native.Recordings.of(_aligned(positions), _aligned(velocities), (step, _aligned(times)), *rest)
    return Demonstrations._of(native.with_origin(origin))


def _aligned(arrays: list[Any]) -> list[Any]:
    """Aligns arrays: engines pass pickled arrays at their place in a message, which may begin at any byte."""
    return [None if array is None else floats(array, "the pickle") for array in arrays]


def _columns(given: list[Any]) -> list[str] | None:
    """The column names if every movement is a DataFrame; they must be the same for all."""
    if not given or not all(hasattr(values, "columns") for values in given):
        return None
    names = [str(name) for name in given[0].columns]
    for k, values in enumerate(given):
        found = [str(name) for name in values.columns]
        if found != names:
            what = f"columns of movement {k} are {', '.join(found)}, those of movement 0 {', '.join(names)}"
            raise PolicyAlignError(what, "trajectories", "the same columns in the same order", trajectory=k)
    return names


def _one(convert: Any, values: Any, name: str, k: int) -> Floats:
    try:
        found: Floats = convert(values, f"{name}[{k}]")
    except PolicyAlignError as error:
        error.trajectory = k
        raise
    return found


def _labels(names: Any, count: int, k: int) -> list[str] | None:
    """The name at each of the ``count`` samples of movement k, from one name for all or one per sample."""
    if names is None:
        return None
    if isinstance(names, str) or not isinstance(names, Iterable):
        return [str(names)] * count
    listed = ["" if name is None else str(name) for name in names]
    if len(listed) != count:
        what = f"there are {len(listed)} names of constraints for the {count} samples of movement {k}"
        raise PolicyAlignError(what, "constraints", "one name a sample, or one for the movement", trajectory=k)
    return listed


def _stamps(values: Any) -> Floats:
    stamps = floats(values, "times")
    if stamps.ndim != 1:
        raise PolicyAlignError(f"Expected 1D array, got {stamps.ndim}D array instead", "times", "one stamp a sample")
    return stamps


def _seconds(dt: Any) -> float:
    try:
        return float(dt)
    except (TypeError, ValueError):
        raise TypeError(f"dt is {dt!r}; a number of seconds is needed") from None


def _same_length(given: Sequence[Any], expected: int, name: str, what: str) -> None:
    if len(given) != expected:
        raise PolicyAlignError(f"there are {len(given)} {name} for {expected} {what}", name, "one each")


def reading(options: Mapping[str, Any]) -> tuple[str, bool]:
    """Converts options of ``Demonstrations.read`` for the native half."""
    plain = {name: value for name, value in options.items() if value is not None}
    if "format" in plain:
        plain["as"] = plain.pop("format")
    for name in _LISTS & plain.keys():
        plain[name] = [plain[name]] if isinstance(plain[name], str) else [str(entry) for entry in plain[name]]
    trim_still = bool(plain.pop("trim_still", False))
    return json.dumps(plain), trim_still
