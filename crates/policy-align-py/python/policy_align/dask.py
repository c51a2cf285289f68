"""One fit on the workers of a Dask cluster.

>>> from dask.distributed import Client                                # doctest: +SKIP
>>> from policy_align import dask                                      # doctest: +SKIP
>>> model = dask.fit(files, Client("tcp://scheduler:8786"))            # doctest: +SKIP
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ._digesting import Further
from ._learner import Learner
from ._learners import AutoGp

__all__ = ["fit"]


def fit(
    files: Sequence[str | os.PathLike[str]],
    client: Any,
    learner: Learner | None = None,
    *,
    at_once: str = "256MB",
    **options: Any,
) -> Learner:
    """Learns from files that all workers can read. The workers read the files and pieces that are read alone (``Learner.fit_files``), this
    process the others. If a worker dies, another does its work. The model is the same as with one process. ``learner``: by default AutoGp().
    ``options`` as for ``Learner.fit_files``, such as ``unfinished``.
    """

    import distributed

    as_completed: Any = distributed.as_completed

    def on_workers(function: Callable[[Further], bytes], items: list[Further]) -> Iterator[bytes]:
        for future in as_completed(client.map(function, items)):
            yield future.result()

    learner = AutoGp() if learner is None else learner
    return learner.fit_files(*files, at_once=at_once, map=on_workers, **options)
