"""What a worker does with a file, or a piece of one, that is not held together with others."""

from __future__ import annotations

import os
from dataclasses import dataclass

from . import _native

#: A file, or a piece of one: its path, whether movements carry its name, and which part of it.
Piece = tuple[str | os.PathLike[str], bool, str | None]

#: Place, piece, bytes and rows at most.
Further = tuple[int, Piece, int, int]


@dataclass(frozen=True)
class Digesting:
    """Reads a piece and keeps means of its samples; can be pickled."""

    digester: str

    def __call__(self, further: Further) -> bytes:
        """What is left of a piece."""
        return _native.digest(further, self.digester)
