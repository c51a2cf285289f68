"""Constraints that acted on movements."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._arrays import Floats


@dataclass(frozen=True)
class ConstraintStretch:
    """A stretch of a movement, and the constraint A v = b that was found on it."""

    #: Name of the movement.
    episode: str
    #: First and last sample.
    samples: tuple[int, int]
    #: Times of both, in seconds from the beginning of the movement.
    seconds: tuple[float, float]
    #: The recording's label of the constraint, if there is one.
    label: str | None
    #: "constraint", "changing" (it bends or changes), "nothing" or "unseen" (the policy does not move there).
    acting: str
    #: The constrained link, and "position" or "orientation"; None for a constraint on the channels.
    link: str | None
    quantity: str | None
    #: A, rows of unit length, (k, n) or (k, 3) for a link; k is 0 without a constraint.
    A: Floats
    #: b, (k): exactly 0 if indistinguishable from 0.
    b: Floats
    #: The constant value along each row, (k); NaN for an orientation, or if b is not 0.
    level: Floats
    #: Expected error of the rows, in degrees.
    angle: float
    #: Logarithm of the likelihood ratio of this constraint to no constraint.
    evidence: float
    #: Directions in the channels, (r, n), along which a further constraint would not be detected.
    hidden: Floats
    #: Description in words.
    text: str

    def __str__(self) -> str:
        begin, end = self.seconds
        name = "" if self.label is None else f" ({self.label})"
        return f"{self.episode}, {begin:.2f} to {end:.2f} s{name}: {self.text}"


def stretches(document: str, dim: int) -> tuple[ConstraintStretch, ...]:
    """Parses the native half's JSON."""
    found = json.loads(document)
    return tuple(_stretch(entry, text, dim) for entry, text in zip(found["constraints"], found["in_words"], strict=True))


def _stretch(entry: dict[str, Any], text: str, dim: int) -> ConstraintStretch:
    on = entry["on"]
    quantity, link = next(iter(on.items())) if isinstance(on, dict) else (None, None)
    level = [np.nan if value is None else value for value in entry["levels"]]
    begin, end = entry["samples"]
    start, stop = entry["seconds"]
    return ConstraintStretch(
        episode=str(entry["episode"]),
        samples=(begin, end),
        seconds=(start, stop),
        label=entry.get("label"),
        acting=str(entry["acting"]),
        link=link,
        quantity=quantity,
        A=np.array(entry["normals"], dtype=float).reshape(-1, dim if link is None else 3),
        b=np.array(entry["speeds"], dtype=float),
        level=np.array(level, dtype=float),
        angle=float(entry["angle"]),
        evidence=float(entry["evidence"]),
        hidden=np.array(entry["hidden"], dtype=float).reshape(-1, dim),
        text=text,
    )
