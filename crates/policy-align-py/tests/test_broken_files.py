"""Broken files cause errors and nothing worse."""

from __future__ import annotations

import json
import os
import shlex
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import DT, ROOT, on_rails

from policy_align import Demonstrations, PolicyAlignError, SlopeGp, load

SAMPLES = ROOT / "crates/demo-io/tests/samples"
#: Reference files of other libraries, which may be missing.
VECTORS = Path(os.environ.get("CONFORMANCE_VECTORS", ROOT.parent / "shared/vectors")) / "files"


def outcome(path: Path, **options: object) -> Demonstrations | PolicyAlignError:
    """The recordings, read and checked, or the error; a panic or another exception fails the test."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            read = Demonstrations.read(path, **options)
            read.check()
        except PolicyAlignError as error:
            # Flags are translated to arguments, except those of other programs.
            ours = (error.hint or "").split("rosbags-convert")[0].replace("--repo-type", "")
            assert "--" not in ours, error
            return error
    return read


def files(folder: Path) -> list[Path]:
    positions, velocities = on_rails(3, 8)
    np.savez(folder / "a.npz", state=np.stack(positions))
    np.save(folder / "a.npy", np.stack(positions))
    rows = [[k, DT * i, *x[i], *u[i]] for k, (x, u) in enumerate(zip(positions, velocities)) for i in range(len(x))]
    lines = [",".join(map(repr, map(float, row))) for row in rows]
    (folder / "a.csv").write_text("\n".join(["episode,t,x,y,vx,vy", *lines]))
    with (folder / "a.jsonl").open("w") as out:
        for x in positions:
            out.write(json.dumps({"t": [DT * i for i in range(len(x))], "state": x.tolist()}) + "\n")
    return [folder / f"a.{ending}" for ending in ("npz", "npy", "csv", "jsonl")] + sorted(SAMPLES.iterdir())


def test_cut_and_damaged_files_are_errors_or_recordings(tmp_path: Path) -> None:
    numbers = np.random.default_rng(11)
    refused = 0
    whole = files(tmp_path)
    for path in whole:
        given = outcome(path, dt=DT)
        assert isinstance(given, Demonstrations), f"{path}: {given}"
        content = np.frombuffer(path.read_bytes(), dtype=np.uint8)
        for k in range(40):
            broken = content.copy()
            if k < 10:
                broken = broken[: numbers.integers(len(broken))]
            else:
                at = numbers.integers(len(broken), size=1 + k % 5)
                broken[at] = numbers.integers(256, size=len(at))
            damaged = tmp_path / f"damaged{path.suffix}"
            damaged.write_bytes(broken.tobytes())
            refused += isinstance(outcome(damaged, dt=DT), PolicyAlignError)
    assert refused > 10 * len(whole)


def test_damaged_models_are_errors(tmp_path: Path, slope: SlopeGp) -> None:
    path = tmp_path / "model.json"
    slope.save(path)
    content = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    numbers = np.random.default_rng(12)
    for _ in range(60):
        broken = content[: numbers.integers(1, len(content) + 1)].copy()
        broken[numbers.integers(len(broken))] ^= 1 << numbers.integers(8)
        path.write_bytes(broken.tobytes())
        with pytest.raises(PolicyAlignError):
            load(path)


@pytest.mark.skipif(not VECTORS.exists(), reason="no reference files: CONFORMANCE_VECTORS names no folder")
def test_reference_files_say_what_is_expected() -> None:
    cases = json.loads((VECTORS / "expected.json").read_text())["cases"]
    for case in cases:
        # The part of a file to read follows #.
        found = outcome(VECTORS / case["path"].split("#")[0], **options(case.get("args", "")))
        if case["kind"] == "refuse":
            assert isinstance(found, PolicyAlignError), case
            assert found.code == case["code"], found
            said = str(found)
        else:
            assert isinstance(found, Demonstrations), f"{case['path']}: {found}"
            names, said = found.names, "\n".join(found.notes)
            if case["kind"] == "warn":
                check = found.check()
                names = [name for name in names if name not in dict(check.left_out)]
                left_out = (f"episode {name} {why}" for name, why in check.left_out)
                said = "\n".join([said, *map(str, check.findings), *left_out])
            assert len(names) == case.get("expect", {}).get("episodes", len(names))
        # Flags have other names in Python.
        assert all(words in said for words in case.get("says", []) if "--" not in words), f"{case}\n{said}"
    assert len(cases) > 40


def options(arguments: str) -> dict[str, object]:
    """Converts flags of the program, such as `--dt 0.05 --sort`, to arguments of Python."""
    found: dict[str, object] = {}
    words = shlex.split(arguments)
    for at, flag in enumerate(words):
        if not flag.startswith("--"):
            continue
        value = words[at + 1] if at + 1 < len(words) and not words[at + 1].startswith("--") else True
        name = flag[2:].replace("-", "_")
        number = name in ("dt", "split_gap")
        found["format" if name == "as" else name] = float(str(value)) if number else value
    return found
