"""The notebook runs, and says what it says."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from conftest import ROOT, TOY

NOTEBOOK = ROOT / "docs/examples/notebook.ipynb"


def words(notebook) -> list[str]:
    """What cells printed; numbers to a digit, and small ones as 0: processors differ in the last bits."""

    def rounded(number: re.Match[str]) -> str:
        return f"{float(number[0]):.1g}" if float(number[0]) > 1e-3 else "0"

    outputs = ["".join(output.get("text", "") for output in cell.get("outputs", [])) for cell in notebook.cells]
    return [re.sub(r"\d+\.?\d*(e[-+]\d+)?", rounded, text) for text in outputs]


def test_the_notebook_runs(tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    assert NOTEBOOK.stat().st_size < 20_000
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    shown = words(notebook)
    shutil.copy(TOY, tmp_path)
    nbclient.NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert (tmp_path / "model.json").exists()
    assert words(notebook) == shown and len(shown) > 5


def test_the_readme_shows_what_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copy(TOY, tmp_path)
    monkeypatch.chdir(tmp_path)
    readmes = (ROOT / "README.md", ROOT / "crates/policy-align-py/README.md")
    shown, again = (re.findall(r"```python\n(.*?)```", readme.read_text(), re.DOTALL) for readme in readmes)
    assert shown == again and len(shown) == 1
    exec(compile(shown[0], "README.md", "exec"), {})
    assert (tmp_path / "model.json").exists()
