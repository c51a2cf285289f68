"""Errors and warnings."""

from __future__ import annotations


class PolicyAlignError(ValueError):
    """The fault, its place and a hint: the three lines of the program's errors.

    ``what``, ``place``, ``hint``: these lines. ``code``: the name of a reading error, such as "NotFinite".
    ``trajectory``, ``sample``, ``column``: indices of the fault, counted from 0, where known; else None.
    """

    def __init__(
        self,
        what: str,
        place: str | None = None,
        hint: str | None = None,
        code: str | None = None,
        trajectory: int | None = None,
        sample: int | None = None,
        column: int | None = None,
    ) -> None:
        # All of them are arguments of the exception, so that it can be pickled.
        super().__init__(what, place, hint, code, trajectory, sample, column)
        self.what = what
        self.place = place
        self.hint = hint
        self.code = code
        self.trajectory = trajectory
        self.sample = sample
        self.column = column

    def __str__(self) -> str:
        place = "" if self.place is None else f"\n  in:  {self.place}"
        hint = "" if self.hint is None else f"\n  try: {self.hint}"
        return f"{self.what}{place}{hint}"


class NotFittedError(ValueError, AttributeError):
    """An estimator was used before ``fit``; like scikit-learn's error of this name."""


class PolicyAlignWarning(UserWarning):
    """A reason to doubt recordings or a policy."""
