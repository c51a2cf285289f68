"""The program and the package write the same files and the same texts."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import TOY, without_time

from policy_align import AutoGp, Demonstrations, DirectGp, PolicyAlign, PolicyAlignError, SlopeGp, load

#: Flags of the program, and the learners that correspond to them.
LEARNERS = {
    "auto": AutoGp(),
    "slope": SlopeGp(),
    "direct": DirectGp(),
    "policy-align --init-d 10": PolicyAlign(init_d=10.0),
}


def run(program: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([program, *arguments], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("learner", LEARNERS)
def test_model_files_are_equal_byte_for_byte(learner: str, program: Path, tmp_path: Path) -> None:
    ours, theirs = tmp_path / "ours.json", tmp_path / "theirs.json"
    flags = f"--learner {learner} --seed 3 --max-rows 100 --no-report"
    done = run(program, "fit", str(TOY), "-o", str(theirs), *flags.split())
    assert theirs.exists(), done.stderr
    LEARNERS[learner].set_params(max_rows=100, random_state=3).fit(Demonstrations.read(TOY)).save(ours)
    assert without_time(ours.read_text()) == without_time(theirs.read_text())
    # Each reads the file of the other.
    x = np.array([[0.3, 1.2], [-1.0, 0.4]])
    assert np.array_equal(load(theirs).predict(x), load(ours).predict(x))
    assert run(program, "info", str(ours)).returncode == 0


def test_settings_are_equal(program: Path, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs.json"
    flags = "--learner policy-align --bandwidth medium --init-d 10 --folds 4 --smooth 9 --jumps keep --wraps keep --scale y=2"
    done = run(program, "fit", str(TOY), "-o", str(theirs), "--max-rows", "100", "--no-report", *flags.split())
    assert theirs.exists(), done.stderr
    settings = {"init_d": 10.0, "folds": 4, "smooth": 9, "jumps": "keep", "wraps": "keep", "scale": {"y": 2}}
    ours = PolicyAlign("medium", max_rows=100, **settings).fit(Demonstrations.read(TOY))._fitted.to_json().decode()
    assert without_time(ours) == without_time(theirs.read_text())


def test_defaults_are_equal(program: Path, tmp_path: Path) -> None:
    theirs = tmp_path / "theirs.json"
    run(program, "fit", str(TOY), "-o", str(theirs), "--max-rows", "100", "--no-report")
    ours = AutoGp(max_rows=100).fit(Demonstrations.read(TOY))._fitted.to_json().decode()
    assert without_time(ours) == without_time(theirs.read_text())


def test_roll_outs_are_equal(program: Path, slope: SlopeGp, tmp_path: Path) -> None:
    model, wall, csv = tmp_path / "model.json", tmp_path / "wall.toml", tmp_path / "path.csv"
    slope.save(model)
    wall.write_text("[[constraint]]\nnormal = [1, 0]\n")
    done = run(program, "rollout", str(model), "--from", "1.5,1", "--constraint", str(wall), "-o", str(csv))
    assert done.returncode == 0, done.stderr
    theirs = Demonstrations.read(csv)
    for ours in (slope.rollout([1.5, 1.0], constraint=wall), slope.rollout([1.5, 1.0], constraint=[1, 0])):
        assert np.array_equal(ours.states, theirs.trajectories[0])
        assert ours.stop == "at rest" and ours.broken_by == 0.0


BROKEN = {
    "nan.csv": "t,x,y\n0,1,2\n0.1,nan,3\n0.2,3,4\n",
    "word.csv": "t,x,y\n0,1,2\n0.1,three,3\n0.2,3,4\n",
    "ragged.csv": "t,x,y\n0,1,2\n0.1,3\n0.2,3,4\n",
    "empty.csv": "",
    "header.csv": "t,x,y\n",
    "backwards.csv": "t,x\n0,1\n0.2,2\n0.1,3\n",
    "twice.csv": "t,x,x\n0,1,2\n0.1,2,3\n0.2,3,4\n",
    "no_time.csv": "x,y\n1,2\n2,3\n3,4\n",
    "bad.jsonl": '{"t": [0, 1], "x": [1, 2]}\n{"t": [0, 1\n',
    "not.npz": "PK\x03\x04 and nothing more",
    "not.npy": "\x93NUMPY\x01 and nothing more",
    "not.hdf5": "\x89HDF\r\n\x1a\n and nothing more",
    "not.mcap": "\x89MCAP0\r\n and nothing more",
    "not.parquet": "PAR1 and nothing more PAR1",
    "not.mat": "MATLAB 5.0 MAT-file and nothing more",
}


@pytest.mark.parametrize("name", BROKEN)
def test_errors_have_the_programs_words(name: str, program: Path, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(BROKEN[name].encode("latin-1"))
    theirs = run(program, "check", str(path)).stderr
    with pytest.raises(PolicyAlignError) as error:
        Demonstrations.read(path).check()
    lines = [line for line in theirs.splitlines() if not line.startswith("warning:")]
    assert lines[0] == f"error: {error.value.what}"
    assert lines[1] == f"  in:  {error.value.place}"
    # The hint begins with a flag, which has another name in Python.
    assert re.sub(r"\W", "", lines[2])[-12:] == re.sub(r"\W", "", error.value.hint)[-12:]
