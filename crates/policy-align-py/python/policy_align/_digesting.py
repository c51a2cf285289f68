"""What a worker does with a file that is not held together with others."""

from __future__ import annotations

import os
from dataclasses import dataclass

from . import _native

#: Place, path, bytes and rows at most of a file.
File = tuple[int, str | os.PathLike[str], int, int]


@dataclass(frozen=True)
class Digesting:
    """Reads a file and keeps means of its samples; can be pickled."""

    digester: str

    def __call__(self, file: File) -> bytes:
        """What is left of a file."""
        return _native.digest(file, self.digester)
