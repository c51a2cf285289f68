"""DataFrames."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import DT, TOY

from policy_align import Demonstrations, PolicyAlignError, SlopeGp

pd = pytest.importorskip("pandas")


def frame_of_toy():
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


def test_a_frame_for_each_movement_names_the_channels(rails) -> None:
    learner = SlopeGp(max_rows=60)
    frames = [pd.DataFrame(x, columns=["left", "up"]) for x in rails[0]]
    assert learner.fit(frames, dt=DT).feature_names_in_.tolist() == ["left", "up"]
    with pytest.raises(PolicyAlignError, match="columns of movement 1 are b, those of movement 0 a") as error:
        learner.fit([pd.DataFrame({"a": [0.0, 1.0]}), pd.DataFrame({"b": [0.0, 1.0]})], dt=DT)
    assert error.value.trajectory == 1
    with pytest.raises(TypeError):
        learner.fit(pd.DataFrame({"x": [1.0]}), dt=DT)
