"""The common base of the learners."""

from __future__ import annotations

import json
import operator
import os
import time
import warnings
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from html import escape
from typing import Any, ClassVar, Literal, Self, overload

import numpy as np
import numpy.typing as npt

from . import _native
from ._arrays import Floats, floats, samples, scaler_of
from ._constraints import ConstraintStretch, stretches
from ._demonstrations import Demonstrations, preparing, reading
from ._digesting import Further, Map, parts
from ._errors import NotFittedError, PolicyAlignError, PolicyAlignWarning
from ._estimator import Estimator
from ._rollout import Constraint, Path, follow
from ._trust import Decision, Trust, decisions, findings

#: Values of a context by name, or in the order of ``context_names_``; None for a policy that depends on the state alone.
Context = Mapping[str, float] | Sequence[float] | Floats | None

#: The answer of ``predict`` outside the data.
Outside = Literal["zero", "nan", "error", "extrapolate"]


class Learner(Estimator):
    """The methods and results that all learners share."""

    #: The name of the learner in a model file.
    _learner: ClassVar[str]
    _fitted: _native.Fitted | None = None
    #: The movements given to ``fit``; not part of the model.
    _learnt_from: Demonstrations | None = None

    # Parameters of every learner; only ``robot`` is missing in PolicyAlign.
    integration: str
    scale: dict[str, float] | None
    smooth: str | int
    jumps: str
    wraps: str
    context: str | Sequence[str]
    max_rows: int
    inducing: int
    robot: str | os.PathLike[str] | None
    random_state: Any
    n_jobs: int | None

    def __init__(
        self,
        *,
        integration: str = "auto",
        scale: dict[str, float] | None = None,
        smooth: str | int = "auto",
        jumps: str = "auto",
        wraps: str = "auto",
        context: str | Sequence[str] = "auto",
        max_rows: int = 400,
        inducing: int = 500,
        robot: str | os.PathLike[str] | None = None,
        random_state: Any = 1,
        n_jobs: int | None = None,
    ) -> None:
        """``integration``: "auto", "velocity" (recorded velocities are used) or "displacement" (they are ignored). ``scale``:
        factors for the channels' units. ``smooth``: smoothing of positions, "auto", "off", or a window in samples (9) or
        seconds ("0.2s"). ``jumps``: "auto" cuts movements where one step is far too long, "keep" does not. ``wraps``: "auto"
        unwraps angles that jump by a whole turn and gives quaternions consistent signs, "keep" leaves both unchanged.
        ``context``: names of the channels that a movement depends on and that are constant during it, such as a goal; "auto"
        finds them by their names, "none" uses none. ``max_rows``: the largest number of samples on which Gaussian processes
        are selected. ``inducing``: number of samples that represent all samples if more are recorded; 0 drops the others.
        ``robot``: a URDF whose joints have the channels' names; the fit tries constraints on the links at its ends, and its
        mass matrix as the metric in which constraints are orthogonal. ``random_state``: the seed, an integer; None means 1,
        as in the program; a NumPy generator supplies one. ``n_jobs``: number of threads, None or -1 for all; results do not
        depend on it.
        """
        self._store(locals())

    def fit(
        self,
        X: Any,
        y: object = None,
        *,
        dt: float | None = None,
        times: Iterable[Any] | None = None,
        velocities: Any = None,
        lengths: Sequence[int] | None = None,
        constraints: Sequence[str | Sequence[object] | None] | None = None,
    ) -> Self:
        """Learns from movements: a list of (N, n) arrays or DataFrames, an array (K, N, n), a flat (M, n) with
        ``lengths``, or ``Demonstrations``.

        ``dt``: seconds between samples, or ``times``: the time stamps of each movement. ``velocities``: recorded velocities
        in the form of X, better than differences of positions. ``constraints``: names as for ``Demonstrations``, which mark
        where constraints switch. ``y`` is ignored. Ctrl-C ends the fit.
        """
        threads = _threads(self.n_jobs)
        demonstrations = _demonstrations(X, dt, times, velocities, lengths, constraints)
        scaled = scaler_of(demonstrations.trajectories)
        if scaled:
            what = f"every channel has {scaled}, as from a scaler of scikit-learn: constraints are at right angles in one unit for all"
            warnings.warn(f"{what}: leave the scaler out, and name other units by scale={{…}}", PolicyAlignWarning, stacklevel=2)
        return self._learn(demonstrations, threads)

    def fit_files(
        self,
        *paths: str | os.PathLike[str],
        at_once: str = "256MB",
        map: Map = map,
        unfinished: str | os.PathLike[str] | None = None,
        **options: Any,
    ) -> Self:
        """Learns from files that are too large to be held in memory together, or that several machines read.

        Evenly spread files of at most ``at_once`` in total are read together. Every other file is read alone and reduced to
        means of its samples. Large text files are divided into pieces of whole movements. ``map`` applies the reduction, like
        the builtin function; the ``map`` of a process pool or of an engine (``policy_align.dask.fit``) yields the same model.
        Its arguments can be pickled. ``unfinished``: a file that keeps the results of ``map``, so that the same call continues
        after an interruption; the call creates it and removes it at the end. ``options`` as for ``Demonstrations.read``. The
        program's ``fit --at-once`` does the same.
        """
        threads = _threads(self.n_jobs)
        paths_given = [os.fspath(path) for path in paths]
        at_hand, further = _native.divide(paths_given, at_once, self._learning(), reading(options)[0])
        demonstrations = Demonstrations._of_pieces(at_hand, options)
        if not further:
            return self._learn(demonstrations, threads)
        digester = demonstrations._native.digester(self._preparing(), *reading(options))
        learnt = self._learn(demonstrations, threads, (further, parts(further, digester, map, unfinished), digester))
        if unfinished is not None:
            _native.Unfinished.remove(os.fspath(unfinished))
        return learnt

    def _learn(
        self, demonstrations: Demonstrations, threads: int, further: tuple[list[Further], list[bytes], str] = ([], [], "")
    ) -> Self:
        threads_made_at = (threads, time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()))
        given = (demonstrations._native, self._preparing(), self._learning())
        self._take(_native.Fitted.fit(*given, threads_made_at, further))
        self._learnt_from = demonstrations
        trust = self.trust_
        if trust.verdict != "good":
            more = len([finding for finding in trust.findings if finding.verdict != "good"]) - 1
            rest = f" (and {more} more: see trust_)" if more else ""
            verdict = trust.verdict.replace("_", " ")
            warnings.warn(f"{verdict}: {trust.findings[0]}{rest}", PolicyAlignWarning, stacklevel=3)
        return self

    @overload
    def predict(
        self, X: Any, return_std: Literal[False] = False, *, context: Context = None, outside: Outside = "zero"
    ) -> Floats: ...
    @overload
    def predict(
        self, X: Any, return_std: Literal[True], *, context: Context = None, outside: Outside = "zero"
    ) -> tuple[Floats, Floats]: ...
    @overload
    def predict(
        self, X: Any, return_std: bool, *, context: Context = None, outside: Outside = "zero"
    ) -> Floats | tuple[Floats, Floats]: ...
    def predict(
        self, X: Any, return_std: bool = False, *, context: Context = None, outside: Outside = "zero"
    ) -> Floats | tuple[Floats, Floats]:
        """Returns the action at each state, (N, n), in units of the state per second; with ``return_std`` also the standard
        deviation of each component, (N, n). ``context``: values by name or in order, if the policy depends on a context.

        ``outside``: like the program's ``--outside``, the answer outside the data, where ``supports(X)`` is False. The action
        is "zero" or "nan", with NaN as the standard deviation; "error" raises an error; "extrapolate" returns the learner's
        prediction.
        """
        fitted = self._in(context)
        states = samples(X, "X", fitted.dim, type(self).__name__, lambda: self.feature_names_in_)
        if outside not in ("zero", "nan", "error", "extrapolate"):
            hint = 'outside="zero", "nan", "error" or "extrapolate"'
            raise PolicyAlignError(f"{outside!r} is none of the choices", "outside", hint)
        if outside == "extrapolate" and not return_std:
            return fitted.predict(states)
        deviation = None
        if return_std:
            deviation, known = fitted.certainty(states)
            if deviation is None:
                hint = "SlopeGp or AutoGp; supports(X) tells where PolicyAlign has data"
                raise PolicyAlignError(f"{type(self).__name__} estimates no standard deviation", "return_std=True", hint)
        else:
            known = fitted.supports(states)
        actions = fitted.predict(states)
        if outside != "extrapolate" and not known.all():
            if outside == "error":
                sample = int(np.argmin(known))
                hint = 'outside="zero" or "nan", or states within the data'
                raise PolicyAlignError(f"state {sample} is outside the data", "X", hint, sample=sample)
            actions[~known] = 0.0 if outside == "zero" else np.nan
            if deviation is not None:
                deviation[~known] = np.nan
        return actions if deviation is None else (actions, deviation)

    def act(self, x: Any, *, context: Context = None, outside: Outside = "zero") -> Floats:
        """Returns the action (n) at one state (n); arguments as for ``predict``."""
        state = floats(x, "x")
        if state.ndim != 1:
            raise PolicyAlignError(f"Expected 1D array, got {state.ndim}D array instead", "x", "predict(X) for several states")
        action: Floats = self.predict(state[np.newaxis], context=context, outside=outside)[0]
        return action

    def potential(self, X: Any, *, context: Context = None) -> Floats:
        """Returns the potential at each state, (N), in units of the state squared per second; the policy points downhill."""
        fitted = self._in(context)
        found = fitted.potential(samples(X, "X", fitted.dim, type(self).__name__, lambda: self.feature_names_in_))
        if found is None:
            raise PolicyAlignError("this policy has no potential", "potential(X)", "PolicyAlign learns a potential")
        return found

    def support(self, X: Any, *, context: Context = None) -> Floats:
        """Returns the support of each state by the demonstrations, from 0 to 1, (N)."""
        fitted = self._in(context)
        return fitted.support(samples(X, "X", fitted.dim, type(self).__name__, lambda: self.feature_names_in_))

    def supports(self, X: Any, *, context: Context = None) -> npt.NDArray[np.bool_]:
        """Returns whether the support of each state is enough to act on, (N)."""
        fitted = self._in(context)
        return fitted.supports(samples(X, "X", fitted.dim, type(self).__name__, lambda: self.feature_names_in_))

    def rollout(
        self,
        x0: Any,
        seconds: float | None = None,
        *,
        step: float | None = None,
        constraint: Constraint = None,
        limits: str | os.PathLike[str] | None = None,
        context: Context = None,
    ) -> Path:
        """Follows the policy from a state (n), under constraints that need not have been demonstrated.

        ``constraint``: A with A u = 0, rows (k, n) or one row (n); a function A(x, t); or the name of a file of
        constraints, in the program's format. ``limits``: a robot's URDF, whose joints have the channels' names.
        ``seconds``: the duration, by default three times the longest demonstration. ``step``: seconds between two samples of
        the path. ``context``: as for ``predict``.
        """
        channels = tuple(map(str, self.feature_names_in_))
        return follow(self._in(context), x0, seconds, step, constraint, limits, channels)

    def plot(
        self, ax: Any = None, *, dims: tuple[int | str, int | str] = (0, 1), arrows: int = 20, context: Context = None
    ) -> Any:
        """Draws the policy in two channels with matplotlib, all others at their median; no arrows outside the data.

        ``ax``: axes to draw on, new ones if None; they are returned. ``dims``: the horizontal and vertical channel, by number
        or name. ``arrows``: number of arrows in each direction. ``context``: as for ``predict``.
        """
        names = list(map(str, self.feature_names_in_))
        across, up = (_channel(dim, names) for dim in dims)
        if across == up:
            raise PolicyAlignError(f"{names[across]!r} is named twice", "dims", f"two of {', '.join(names)}")
        state = self._about["state"]
        x, y = (np.linspace(state[dim]["low"], state[dim]["high"], arrows) for dim in (across, up))
        grid = np.tile([float(channel["median"]) for channel in state], (arrows * arrows, 1))
        grid[:, across], grid[:, up] = np.tile(x, arrows), np.repeat(y, arrows)
        actions = self.predict(grid, context=context, outside="nan")
        if ax is None:
            import matplotlib.pyplot as plt

            ax = plt.figure().add_subplot()
        inside = ~np.isnan(actions[:, 0])
        ax.quiver(grid[inside, across], grid[inside, up], actions[inside, across], actions[inside, up])
        ax.set(xlabel=names[across], ylabel=names[up], title=f"{type(self).__name__}: {self.trust_.verdict.replace('_', ' ')}")
        return ax

    def _repr_html_(self) -> str:
        """HTML for notebooks: the parameters, and the trust in the learnt policy."""
        head = f"<code>{escape(repr(self))}</code>"
        return head if self._fitted is None else f"{head}<br>{self.trust_._repr_html_()}"

    def score(
        self,
        X: Any,
        y: object = None,
        *,
        dt: float | None = None,
        times: Iterable[Any] | None = None,
        velocities: Any = None,
        lengths: Sequence[int] | None = None,
    ) -> float:
        """Returns 1 − slope error on other movements: 1 explains all of them, 0 is as good as standing still.

        Arguments as for ``fit``; without ``dt`` and ``times`` the time step is that of the training data.
        """
        fitted = self._needed()
        held_out = self._others(X, dt, times, velocities, lengths)
        judged: dict[str, float] = json.loads(fitted.evaluate(held_out._native, self._preparing()))
        return 1.0 - judged["slope_error"]

    def constraints(
        self,
        X: Any,
        *,
        dt: float | None = None,
        times: Iterable[Any] | None = None,
        velocities: Any = None,
        lengths: Sequence[int] | None = None,
        robot: str | os.PathLike[str] | None = None,
        links: Sequence[str] = (),
    ) -> tuple[ConstraintStretch, ...]:
        """Estimates the constraints on each stretch of movements, which may be the training data.

        Arguments as for ``score``. ``robot``: a URDF whose joints have the channels' names. Constraints on its ``links``, by
        default the last link of each chain, are then tested besides those on the channels.
        """
        fitted = self._needed()
        movements = self._others(X, dt, times, velocities, lengths)
        found = fitted.constraints(movements._native, self._preparing(), robot, list(links))
        return stretches(found, fitted.dim)

    @property
    def constraints_(self) -> tuple[ConstraintStretch, ...]:
        """The constraints on the movements given to ``fit``, in the channels. A model file does not contain these movements."""
        self._needed()
        if self._learnt_from is None:
            hint = "constraints(X), with the movements"
            raise PolicyAlignError("a model that was read does not hold its movements", "constraints_", hint)
        return self.constraints(self._learnt_from)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a model file, the same as the program's, completely or not at all."""
        self._needed().save(path)

    def save_lerobot(self, folder: str | os.PathLike[str]) -> None:
        """Writes the folder that LeRobot reads as a policy with the plug-in ``lerobot_policy_align``, the same as the program's
        ``export --to lerobot``; creates the folder if it does not exist.
        """
        self._needed().save_lerobot(folder)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Reads a model file written by this learner, or by the program with it.

        The file contains the learnt policy, not the parameters, which have their defaults except for the seed.
        """
        fitted = _native.Fitted.load(path)
        found = fitted.learner
        if found != cls._learner:
            hint = f"policy_align.load({os.fspath(path)!r}), which takes any"
            raise PolicyAlignError(f"a model of the learner {found!r}, not {cls._learner!r}", os.fspath(path), hint)
        return cls._of(fitted)

    @property
    def trust_(self) -> Trust:
        """The verdict on the policy, with findings and numbers."""
        trust = self._about["trust"]
        return Trust(trust["verdict"], findings(trust["findings"]), trust["numbers"])

    @property
    def decisions_(self) -> tuple[Decision, ...]:
        """The decisions that were made for the user."""
        return decisions(self._about["decisions"])

    @property
    def left_out_(self) -> tuple[tuple[str, str], ...]:
        """Names of the movements that were left out of the fit, and the reasons."""
        return tuple((entry["episode"], entry["why"]) for entry in self._about["data"]["left_out"])

    @property
    def n_features_in_(self) -> int:
        """Dimension of the state."""
        return self._needed().dim

    @property
    def feature_names_in_(self) -> npt.NDArray[np.object_]:
        """Names of the state's dimensions, (n)."""
        return np.array([channel["name"] for channel in self._about["state"]], dtype=object)

    @property
    def context_names_(self) -> list[str]:
        """Names of the context channels, on which the policy depends besides the state; empty without a context."""
        return self._needed().context

    @property
    def time_step_(self) -> float:
        """The median time between samples, in seconds."""
        return float(self._about["time_step"])

    def __sklearn_is_fitted__(self) -> bool:
        return self._fitted is not None

    def __getstate__(self) -> dict[str, Any]:
        state = {name: value for name, value in self.__dict__.items() if name not in ("_fitted", "_document", "_learnt_from")}
        return state if self._fitted is None else {**state, "_fitted": self._fitted.to_json()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        text = state.pop("_fitted", None)
        self.__dict__.update(state)
        if text is not None:
            self._take(_native.Fitted.from_json(text, "the pickled model"))

    def _take(self, fitted: _native.Fitted) -> None:
        self.__dict__.pop("_document", None)
        self.__dict__.pop("_learnt_from", None)
        self._fitted = fitted

    def _needed(self) -> _native.Fitted:
        if self._fitted is None:
            name = type(self).__name__
            raise NotFittedError(
                f"This {name} instance is not fitted yet. Call 'fit' with appropriate arguments before using this "
                "estimator."
            )
        return self._fitted

    def _in(self, context: Context) -> _native.Fitted:
        """The learnt policy, in the given context if it depends on one."""
        fitted = self._needed()
        names = fitted.context
        if context is None:
            if names:
                hint = "context={" + ", ".join(f"{name!r}: …" for name in names) + "}"
                raise PolicyAlignError(f"the policy depends on {', '.join(names)}", "context", hint)
            return fitted
        if isinstance(context, Mapping):
            values = [(str(name), float(value)) for name, value in context.items()]
        else:
            given = floats(context, "context").ravel()
            if len(given) != len(names):
                hint = f"a number for each of {', '.join(names) or 'no channel'}"
                raise PolicyAlignError(f"there are {len(given)} numbers", "context", hint)
            values = list(zip(names, given.tolist(), strict=True))
        return fitted.in_context(values)

    @property
    def _about(self) -> dict[str, Any]:
        self._needed()
        return self._document

    @cached_property
    def _document(self) -> dict[str, Any]:
        document: dict[str, Any] = json.loads(self._needed().about())
        return document

    def _others(
        self, X: Any, dt: float | None, times: Iterable[Any] | None, velocities: Any, lengths: Sequence[int] | None
    ) -> Demonstrations:
        """Other movements, with the time step of the training data unless theirs is given."""
        if dt is None and times is None and not isinstance(X, Demonstrations):
            dt = self.time_step_
        return _demonstrations(X, dt, times, velocities, lengths)

    def _preparing(self) -> dict[str, Any]:
        return preparing(self.integration, self.scale, self.smooth, self.jumps, self.wraps, self.context)

    def _learning(self) -> dict[str, Any]:
        return {
            "learner": self._learner,
            "reading": getattr(self, "reading", None),
            "bandwidth": getattr(self, "bandwidth", "auto"),
            "init_d": getattr(self, "init_d", "auto"),
            "folds": _count(getattr(self, "folds", 5), "folds"),
            "max_rows": _count(self.max_rows, "max_rows"),
            "inducing": _count(self.inducing, "inducing"),
            "robot": _text(getattr(self, "robot", None)),
            "seed": _seed(self.random_state),
        }

    @classmethod
    def _of(cls, fitted: _native.Fitted) -> Self:
        self = cls()
        self._take(fitted)
        self.random_state = self._about["seed"]
        return self


def _demonstrations(
    X: Any,
    dt: float | None,
    times: Iterable[Any] | None,
    velocities: Any,
    lengths: Sequence[int] | None,
    constraints: Sequence[str | Sequence[object] | None] | None = None,
) -> Demonstrations:
    if not isinstance(X, Demonstrations):
        return Demonstrations(
            X, dt=dt, times=times, velocities=velocities, lengths=lengths, constraints=constraints
        )
    if any(given is not None for given in (dt, times, velocities, lengths, constraints)):
        raise TypeError("Demonstrations have their own times, velocities and constraints")
    return X


def _text(path: str | os.PathLike[str] | None) -> str | None:
    if path is None:
        return None
    with open(path, encoding="utf-8") as file:
        return file.read()


def _seed(random_state: Any) -> int:
    """Converts scikit-learn's ``random_state`` to a seed; None is a fixed seed, so that the same data give the same policy."""
    if random_state is None:
        return 1
    if isinstance(random_state, np.random.Generator):
        return int(random_state.integers(2**31))
    if isinstance(random_state, np.random.RandomState):
        return int(random_state.randint(2**31 - 1))
    try:
        seed = operator.index(random_state)
    except TypeError:
        raise TypeError(f"random_state is a whole number, None or a generator, not {type(random_state).__name__}") from None
    if not 0 <= seed < 2**64:
        raise PolicyAlignError(f"random_state is {seed}", "random_state", "a whole number from 0 to 2**64 - 1, or None")
    return seed


def _count(value: Any, name: str) -> int:
    """Checks a number of samples or folds; their limits are checked by the native half."""
    if not hasattr(value, "__index__") or operator.index(value) < 0:
        raise TypeError(f"{name} is a whole number of at least 0, not {value!r}")
    return operator.index(value)


def _channel(dim: int | str, names: list[str]) -> int:
    """The index of a channel, given by number or name."""
    if isinstance(dim, str) and dim in names:
        return names.index(dim)
    if isinstance(dim, int) and -len(names) <= dim < len(names):
        return dim % len(names)
    raise PolicyAlignError(f"there is no channel {dim!r}", "dims", f"two of {', '.join(names)}")


def _threads(n_jobs: int | None) -> int:
    if n_jobs is None or n_jobs == -1:
        return 0
    if n_jobs < 1:
        raise PolicyAlignError(f"n_jobs is {n_jobs}: it must be None, -1 or at least 1", "n_jobs", "n_jobs=None")
    return n_jobs
