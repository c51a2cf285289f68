"""The work of a worker on a file, or a piece of one, that is read alone."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass

from . import _native

#: A file, or a piece of one: its path, whether movements are named after it, and the part of the file.
Piece = tuple[str | os.PathLike[str], bool, str | None]

#: Index, piece, size in bytes, and largest number of rows.
Further = tuple[int, Piece, int, int]


@dataclass(frozen=True)
class Digesting:
    """Reads a piece and reduces it to a digest, means of its samples; can be pickled."""

    digester: str

    def __call__(self, further: Further) -> bytes:
        """The digest of a piece."""
        return _native.digest(further, self.digester)

#: A function like the builtin ``map``, on any machines.
Map = Callable[[Callable[[Further], bytes], list[Further]], Iterable[bytes]]


def parts(further: list[Further], digester: str, map: Map, unfinished: str | os.PathLike[str] | None) -> list[bytes]:
    """The digests of all pieces; pieces that an earlier call kept in the file ``unfinished`` are not read again."""
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
