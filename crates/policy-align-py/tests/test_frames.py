"""DataFrames, and files of several kinds."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from conftest import TOY

from policy_align import Demonstrations, PolicyAlignError, PolicyAlignWarning, SlopeGp


def frame_of_toy() -> pd.DataFrame:
    """Every number to its last bit, whatever this version of pandas does by default."""
    frame = pd.read_csv(TOY, dtype=str)
    return frame.astype({name: int if name == "episode" else float for name in frame.columns})


def test_a_frame_is_read_as_its_file(toy: Demonstrations) -> None:
    found = Demonstrations.from_frame(frame_of_toy())
    assert (found.names, found.channels, found.dt) == (toy.names, toy.channels, toy.dt)
    for one, another in zip((*found, *found.velocities), (*toy, *toy.velocities), strict=True):
        assert np.array_equal(one, another)
    assert np.array_equal(
        SlopeGp(max_rows=60).fit(found).predict([[0.3, 1.2]]), SlopeGp(max_rows=60).fit(toy).predict([[0.3, 1.2]])
    )


def test_a_frame_takes_options(toy: Demonstrations) -> None:
    frame = frame_of_toy().rename(columns={"episode": "take", "t": "stamp"})
    found = Demonstrations.from_frame(frame, state=["x", "y"], time="stamp", episode="take", ignore=["vx", "vy"])
    assert found.velocities is None and found.channels == ["x", "y"]
    assert np.array_equal(found.trajectories[7], toy.trajectories[7])
    with pytest.raises(PolicyAlignError) as error:
        Demonstrations.from_frame(frame, state="x,z")
    assert error.value.code == "NoColumn" and "frame.csv" in error.value.place
    with pytest.raises(TypeError, match="a DataFrame is needed, not list"):
        Demonstrations.from_frame([1, 2])


def test_what_is_noticed_is_warned_of(tmp_path) -> None:
    path = tmp_path / "gap.csv"
    stamps = [0.1 * k for k in range(10)] + [3.0 + 0.1 * k for k in range(10)]
    path.write_text("t,x\n" + "".join(f"{t},{np.sin(t)}\n" for t in stamps))
    with pytest.warns(PolicyAlignWarning, match="split_gap=SECONDS cuts there") as told:
        found = Demonstrations.read(path)
    assert found.notes == [str(warning.message) for warning in told]


def test_check_says_what_would_be_learnt_from(toy: Demonstrations) -> None:
    check = toy.check()
    assert (check.episodes, check.samples, check.channels, check.time_step) == (40, 1600, ("x", "y"), 0.05)
    assert {decision.what for decision in check.decisions} >= {"time step", "velocities"}
    assert "40 episodes, 1600 samples, states x, y" in str(check)
    assert repr(toy) == "<Demonstrations: 40 movements, 1600 samples of x, y>"
    ignored = toy.check(integration="displacement")
    assert any("told to ignore them" in decision.why for decision in ignored.decisions)


def test_arrays_carry_names_units_and_labels() -> None:
    x = np.random.default_rng(0).normal(size=(3, 9, 2)).cumsum(axis=1)
    found = Demonstrations(
        x, dt=0.1, names=["a", "b", "c"], channels=["left", "up"], units=["m", None], constraints=["wall", None, "wall"]
    )
    assert (found.names, found.channels, found.constraints) == (["a", "b", "c"], ["left", "up"], ["wall", None, "wall"])
    assert len(found) == 3 and found.velocities is None and found.dt == 0.1
    assert np.array_equal(np.stack(found.trajectories), x)
    for wrong in ({"names": ["a"]}, {"channels": ["a"]}, {"units": ["m"]}, {"constraints": ["a"]}, {"times": [[0.0]]}):
        with pytest.raises(PolicyAlignError, match="there are 1 "):
            Demonstrations(x, **{"dt": 0.1, **wrong})
    with pytest.raises(TypeError, match="have their own times"):
        SlopeGp().fit(found, dt=0.1)
