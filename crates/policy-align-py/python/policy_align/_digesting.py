"""What a worker does with a file that is not held together with others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from . import _native


@dataclass(frozen=True)
class Digesting:
    """Reads a file and keeps means of its samples; can be pickled."""

    options: str
    trim_still: bool
    digester: str

    def __call__(self, file: tuple[Any, int, int]) -> bytes:
        """What is left of a file."""
        return _native.digest(file, self.options, self.trim_still, self.digester)
