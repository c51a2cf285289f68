"""The stubs match the native module, and the types of the package are consistent."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1]


@pytest.mark.parametrize(
    "arguments",
    [
        ["mypy.stubtest", "policy_align._native", "--ignore-disjoint-bases"],
        ["mypy", "--config-file", str(PACKAGE / "pyproject.toml"), "-p", "policy_align"],
    ],
)
def test_types_are_as_the_stubs_say(arguments: list[str], tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        [sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
