"""DataFrames."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import DT, TOY

from policy_align import Demonstrations, PolicyAlignError, SlopeGp

pd = pytest.importorskip("pandas")


def frame_of_toy():
    """Parses every number exactly, to the last bit, whatever the default of this version of pandas."""
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


def test_columns_of_lists_become_columns(toy: Demonstrations) -> None:
    flat = frame_of_toy()
    pairs = {"observation.state": ["x", "y"], "velocity": ["vx", "vy"], "action": ["vy", "vx"]}
    listed = flat[["episode", "t"]].assign(
        **{name: [np.array(row) for row in flat[of].to_numpy()] for name, of in pairs.items()}
    )
    found = Demonstrations.from_frame(listed, velocity="velocity", ignore="action")
    assert found.channels == ["observation.state_0", "observation.state_1"]
    for one, another in zip((*found, *found.velocities), (*toy, *toy.velocities), strict=True):
        assert np.array_equal(one, another)
    by_name = Demonstrations.from_frame(listed, state=["action"], ignore=["observation.state", "velocity_0", "velocity_1"])
    assert by_name.channels == ["action_0", "action_1"]
    listed.at[3, "action"] = np.zeros(3)
    with pytest.raises(PolicyAlignError, match="'action' has lists of different lengths, the first of 2") as error:
        Demonstrations.from_frame(listed)
    assert (error.value.sample, error.value.column) == (3, 4)
    assert listed.columns.tolist() == ["episode", "t", *pairs]


def test_a_path_is_a_frame(slope: SlopeGp) -> None:
    path = slope.rollout([1.5, 1.0])
    frame = path.to_frame()
    assert frame.columns.tolist() == ["t", "x", "y", "vx", "vy"] and len(frame) == len(path)
    assert np.array_equal(frame[["x", "y"]].to_numpy(), path.states)
    assert np.array_equal(frame[["vx", "vy"]].to_numpy(), path.velocities)
    again = Demonstrations.from_frame(frame)
    assert np.allclose(again[0], path.states, rtol=0, atol=1e-12) and again.velocities is not None


def test_columns_are_those_learnt_from(slope: SlopeGp) -> None:
    states = pd.DataFrame({"x": [0.3, 0.1], "y": [1.2, 0.4]})
    assert np.array_equal(slope.predict(states), slope.predict(states.to_numpy()))
    for of in (slope.predict, slope.potential, slope.support, slope.supports):
        with pytest.raises(PolicyAlignError, match="the columns of X are y, x, those learnt from x, y") as error:
            of(states[["y", "x"]])
        assert error.value.hint == "X[['x', 'y']]"
        with pytest.raises(PolicyAlignError, match="the columns of X are a, y"):
            of(states.rename(columns={"x": "a"}))
