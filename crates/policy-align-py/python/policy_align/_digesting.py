"""What a worker does with a file, or a piece of one, that is not held together with others."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
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

#: As the builtin function, on any machines.
Map = Callable[[Callable[[Further], bytes], list[Further]], Iterable[bytes]]


def parts(further: list[Further], digester: str, map: Map, unfinished: str | os.PathLike[str] | None) -> list[bytes]:
    """What is left of all pieces; those that an earlier call kept in the file ``unfinished`` are not read again."""
    if unfinished is None:
        return [bytes(part) for part in map(Digesting(digester), further)]
    kept = _native.Unfinished.open(os.fspath(unfinished), further, digester)
    try:
        found, others = kept.found()
        made = [found]
        for part in map(Digesting(digester), others) if others else ():
            made.append(bytes(part))
            kept.keep(made[-1])
        return made
    finally:
        kept.close()
