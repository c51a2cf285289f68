"""Roll-outs."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _native
from ._arrays import Floats, floats
from ._errors import PolicyAlignError

#: A, as rows (k, n) or one row (n); the name of a file of constraints; or A(x, t) as a function.
Constraint = Any


@dataclass(frozen=True)
class Path:
    """The path of a roll-out.

    ``times`` (N), in seconds. ``states`` and ``velocities`` (N, n); a velocity is the part of the action that the
    constraint allows. ``stop``: "at rest", "left the data", "time" or a joint's limit. ``broken_by``: the largest
    violation of a constraint, None without constraints. ``channels``: names of the state's dimensions.
    """

    times: Floats
    states: Floats
    velocities: Floats
    stop: str
    broken_by: float | None
    channels: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.times)

    def to_frame(self) -> Any:
        """A pandas DataFrame: ``t``, the channels, and their velocities, named ``v`` plus the channel's name."""
        import pandas as pd

        states = {name: self.states[:, k] for k, name in enumerate(self.channels)}
        velocities = {f"v{name}": self.velocities[:, k] for k, name in enumerate(self.channels)}
        return pd.DataFrame({"t": self.times, **states, **velocities})


def follow(
    fitted: _native.Fitted,
    start: Any,
    seconds: float | None,
    step: float | None,
    constraint: Constraint,
    limits: str | os.PathLike[str] | None,
    channels: tuple[str, ...],
) -> Path:
    """Runs the native roll-out with a user's arguments."""
    start = floats(start, "x0")
    if start.ndim != 1:
        raise PolicyAlignError(f"Expected 1D array, got {start.ndim}D array instead", "x0", "one state, (n,)")
    path = fitted.roll_out(start, seconds, step, _rows(constraint), limits)
    return Path(path.times, path.states, path.velocities, path.stop, path.broken_by, channels)


def _rows(constraint: Constraint) -> Any:
    if constraint is None or isinstance(constraint, (str, os.PathLike)):
        return constraint
    if callable(constraint):
        return _as_rows(constraint)
    return np.atleast_2d(floats(constraint, "constraint"))


def _as_rows(constraint: Callable[[Floats, float], Any]) -> Callable[[Floats, float], Floats]:
    def rows(state: Floats, time: float) -> Floats:
        found = np.atleast_2d(floats(constraint(state, time), "constraint"))
        # A list without rows has no columns either.
        return found if found.size else np.zeros((0, len(state)))

    return rows
