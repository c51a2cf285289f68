"""The notebook runs and reproduces its stored outputs."""

from __future__ import annotations

import re
from itertools import groupby, zip_longest
from pathlib import Path

import pytest
from conftest import ROOT

from policy_align import example

NUMBER = re.compile(r"\d+(?:\.(\d*))?(?:e([-+]\d+))?")


def outputs(notebook) -> list[list[str]]:
    """The printed text or the output type of each output, by cell."""
    cells = [cell.get("outputs", []) for cell in notebook.cells]
    # The text of a slow cell arrives in pieces.
    def joined(cell):
        streams = groupby(cell, lambda output: output.get("name", id(output)))
        return ["".join(output.get("text", output["output_type"]) for output in outputs) for _, outputs in streams]

    return [joined(cell) for cell in cells]


def says_the_same(said: str, shown: str) -> bool:
    """Equal words; numbers to 2 %, a unit of the last digit, or 1e-9, as processors differ in the last bits."""

    def near(one: re.Match[str] | None, other: re.Match[str] | None) -> bool:
        if one is None or other is None:
            return False
        unit = 10.0 ** (int(other[2] or 0) - len(other[1] or ""))
        tolerance = max(0.02 * float(other[0]), 1.01 * unit if unit < 1 else 0.0, 1e-9)
        return abs(float(one[0]) - float(other[0])) <= tolerance

    same_words = NUMBER.sub("#", said).split() == NUMBER.sub("#", shown).split()
    return same_words and all(near(*pair) for pair in zip_longest(NUMBER.finditer(said), NUMBER.finditer(shown)))


@pytest.mark.parametrize(
    ("said", "same"),
    [
        ("error 5.7e-01 in 40", True),
        ("error 5.8e-01  in 40", True),
        ("error 6.0e-01 in 40", False),
        ("error 5.7e-02 in 40", False),
        ("error -5.7e-01 in 40", False),
        ("error 5.7e-01 in 41", False),
        ("error 5.7e-01 of 40", False),
        ("error 5.7e-01 in 40 2", False),
    ],
)
def test_other_outputs_are_found(said: str, same: bool) -> None:
    assert says_the_same(said, "error 5.7e-01 in 40") is same


def test_the_notebook_runs(tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("matplotlib")
    path = example("notebook")
    assert path.stat().st_size < 120_000
    notebook = nbformat.read(path, as_version=4)
    shown = outputs(notebook)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert (tmp_path / "model.json").exists()
    said = outputs(notebook)
    assert sum(map(len, shown)) > 6
    for cell, one, other in zip(notebook.cells, said, shown, strict=True):
        assert len(one) == len(other) and all(map(says_the_same, one, other)), (cell.source, one, other)


def test_the_readme_shows_what_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    readmes = (ROOT / "README.md", ROOT / "crates/policy-align-py/README.md")
    shown, again = (re.findall(r"```python\n(.*?)```", readme.read_text(), re.DOTALL) for readme in readmes)
    assert shown == again and len(shown) == 1
    exec(compile(shown[0], "README.md", "exec"), {})
    assert (tmp_path / "model.json").exists()
