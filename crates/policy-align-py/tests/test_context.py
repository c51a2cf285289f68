"""Goals that differ between movements."""

import pathlib
import pickle

import numpy as np
import pytest

from policy_align import AutoGp, Demonstrations, PolicyAlign, PolicyAlignError, SlopeGp

GOALS = pathlib.Path(__file__).parents[3] / "docs/examples/goals.csv"


@pytest.fixture(scope="module")
def model() -> AutoGp:
    return AutoGp().fit(Demonstrations.read(GOALS))


def test_goals_are_found_and_asked_for(model: AutoGp) -> None:
    assert model.context_names_ == ["goal_x", "goal_y"] and list(model.feature_names_in_) == ["x", "y"]
    by_name = model.predict([[1.0, 0.2]], context={"goal_y": -0.5, "goal_x": 0.5})
    action, deviation = model.predict([[1.0, 0.2]], True, context=[0.5, -0.5])
    assert np.array_equal(by_name, action) and deviation.shape == (1, 2)
    assert model.supports([[1.0, 0.2]], context=[0.5, -0.5])[0] and not model.supports([[1.0, 0.2]], context=[50, 0])[0]
    assert model.rollout([1.2, -1.0], context=[-0.6, 0.6]).stop == "at rest"
    assert model.score(Demonstrations.read(GOALS)) > 0.999
    again = pickle.loads(pickle.dumps(model))
    assert np.array_equal(again.predict([[1.0, 0.2]], context=[0.5, -0.5]), action)


@pytest.mark.parametrize("context", [None, [1.0], {"goal_x": 1.0}, {"goal_x": 1.0, "goal_y": 2.0, "z": 1.0}])
def test_a_context_has_all_its_numbers(model: AutoGp, context: object) -> None:
    with pytest.raises(PolicyAlignError, match="goal_x|numbers"):
        model.predict([[1.0, 0.2]], context=context)  # type: ignore[arg-type]


def test_names_choose_the_context() -> None:
    movements = [np.c_[np.cos(k) * np.exp(-0.1 * np.arange(20)), np.full(20, float(k))] for k in range(12)]
    found = Demonstrations(movements, dt=0.1)
    assert SlopeGp(context=[found.channels[1]]).fit(movements, dt=0.1).context_names_ == [found.channels[1]]
    read = Demonstrations.read(GOALS, context=["goal_x", "goal_y"])
    assert pickle.loads(pickle.dumps(read)).check().decisions[0].why == "given"


def test_a_learner_without_use_for_it_refuses() -> None:
    with pytest.raises(PolicyAlignError, match="goal_x, goal_y"):
        PolicyAlign().fit(Demonstrations.read(GOALS))
