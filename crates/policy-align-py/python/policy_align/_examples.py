"""Small example files."""

from __future__ import annotations

import pathlib

from ._errors import PolicyAlignError

_FOLDER = pathlib.Path(__file__).parent / "examples"


def example(name: str) -> pathlib.Path:
    """The path of an example file in the package, for use as in ``Demonstrations.read(example("toy"))``.

    ``"toy"``: 40 movements of a point that slides down a bowl, along rails that change. ``"rails"``: a column names the
    constraint. ``"goals"``: every movement has a different goal, a context. ``"wall"``: a constraint, for ``rollout``.
    ``"notebook"``: a Jupyter notebook. For any other name a ``PolicyAlignError`` lists the names.
    """
    files = {path.stem: path for path in _FOLDER.iterdir()}
    if name not in files:
        names = ", ".join(f'"{known}"' for known in sorted(files))
        raise PolicyAlignError(f"there is no example {name!r}", "policy_align.example", f"one of {names}")
    return files[name]
