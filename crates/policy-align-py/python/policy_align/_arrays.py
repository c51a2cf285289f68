"""Conversion of array-likes to the C-ordered double-precision arrays that the native half takes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import PolicyAlignError

Floats = npt.NDArray[np.float64]

# All arrays of native doubles share this object. Comparing it costs a tenth of comparing types.
_DOUBLE = np.dtype(np.float64)


def floats(values: Any, name: str) -> Floats:
    """Converts real numbers of any type and layout; a C-ordered array of doubles is not copied."""
    if type(values) is np.ndarray and values.dtype is _DOUBLE:
        # In C order and aligned.
        if values.flags.carray or (values.flags.c_contiguous and values.flags.aligned):
            return values
    if np.ma.is_masked(values):
        raise PolicyAlignError(f"{name} holds masked values", name, "the samples without them, or .filled(…) with numbers")
    try:
        array = np.asarray(values)
    except ValueError as error:
        raise TypeError(f"{name} is not an array: {error}") from None
    if array.dtype.kind == "b":
        raise TypeError(f"{name} is a mask of booleans; numbers are needed, such as those that X[mask] selects")
    if array.dtype.kind not in "fiuO":
        raise TypeError(f"{name} holds {array.dtype}; numbers are needed")
    try:
        return np.require(array, np.float64, ["C", "A"])
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} holds what is not a number: {error}") from None


def samples(
    values: Any, name: str, columns: int | None = None, of: str = "", channels: Callable[[], Iterable[str]] | None = None
) -> Floats:
    """Converts to an (N, n) array, a row per sample. Columns of a DataFrame must equal the ``channels``, if named."""
    if channels is not None and hasattr(values, "columns"):
        found, known = [str(column) for column in values.columns], list(channels())
        if found != known and known != [f"x{k}" for k in range(len(known))]:
            hint = f"{name}[{known!r}]" if set(known) <= set(found) else f"the columns {', '.join(known)}"
            what = f"the columns of {name} are {', '.join(found)}, those learnt from {', '.join(known)}"
            raise PolicyAlignError(what, name, hint)
    array = floats(values, name)
    if array.ndim != 2:
        hint = "reshape(1, -1) if it holds a single sample, reshape(-1, 1) if a single channel"
        raise PolicyAlignError(f"Expected 2D array, got {array.ndim}D array instead", name, hint)
    if columns is not None and array.shape[1] != columns:
        raise PolicyAlignError(
            f"{name} has {array.shape[1]} features, but {of} is expecting {columns} features as input",
            name,
            "the channels that were learnt from, in their order",
        )
    return array


def episodes(values: Any, lengths: Sequence[int] | None, name: str) -> list[Any]:
    """Returns a list of movements from a list, a (K, N, n) array, or a flat (M, n) array with lengths."""
    if lengths is not None:
        flat = samples(values, name)
        counts = [int(count) for count in lengths]
        if sum(counts) != len(flat) or any(count < 0 for count in counts):
            what = f"lengths add up to {sum(counts)}, {name} has {len(flat)} rows"
            raise PolicyAlignError(what, "lengths", "the number of samples of each movement")
        ends = np.cumsum(counts)
        return [flat[end - count : end] for count, end in zip(counts, ends, strict=True)]
    if isinstance(values, np.ndarray) and values.dtype != object:
        if values.ndim == 3:
            return list(values)
        hint = "a list of (N, n) arrays, an array (K, N, n), or lengths=[...] with a flat one"
        raise PolicyAlignError(f"Expected movements, got {values.ndim}D array instead", name, hint)
    if isinstance(values, (str, bytes)) or not hasattr(values, "__iter__") or hasattr(values, "columns"):
        raise TypeError(f"{name} must be a list of movements, not {type(values).__name__}")
    return list(values)


def scaler_of(movements: Sequence[Floats]) -> str | None:
    """Describes how StandardScaler or MinMaxScaler has scaled all channels, up to rounding; None for unscaled channels."""
    rows = np.concatenate(movements) if len(movements) else np.empty((0, 0))
    if len(rows) < 3 or rows.shape[1] < 2:
        return None
    low, high = rows.min(axis=0), rows.max(axis=0)
    for ends in ((0.0, 1.0), (-1.0, 1.0)):
        if np.allclose([low, high], np.reshape(ends, (2, 1)), rtol=0, atol=1e-12):
            return f"values from {ends[0]:g} to {ends[1]:g}"
    # Rounding errors add up over the rows.
    if np.allclose(rows.mean(axis=0), 0, atol=1e-9) and np.allclose(rows.std(axis=0), 1, rtol=0, atol=1e-9):
        return "the mean 0 and the deviation 1"
    return None
