"""Selection of movements, and scikit-learn's splits of them."""

from __future__ import annotations

import numpy as np
import pytest

from policy_align import Demonstrations, PolicyAlignError, SlopeGp


def same(one: Demonstrations, other: Demonstrations, places: list[int]) -> None:
    """Checks that ``one`` consists of the movements of ``other`` at ``places``, with all their attributes."""
    assert one.names == [other.names[k] for k in places] and one.channels == other.channels
    for found, of in ((one.trajectories, other.trajectories), (one.times, other.times)):
        assert len(found) == len(places)
        assert all(np.array_equal(values, of[k]) for values, k in zip(found, places, strict=True))
    assert (one.velocities is None) == (other.velocities is None)
    if one.velocities is not None and other.velocities is not None:
        assert all(np.array_equal(values, other.velocities[k]) for values, k in zip(one.velocities, places, strict=True))
    assert one.constraints == [other.constraints[k] for k in places]


def three() -> Demonstrations:
    x = np.random.default_rng(0).normal(size=(3, 9, 2)).cumsum(axis=1)
    times = [np.arange(9.0) * (k + 1) for k in range(3)]
    labels = ["wall", None, ["free"] * 4 + ["wall"] * 5]
    return Demonstrations(x, times=times, names=["a", "b", "c"], channels=["left", "up"], units=["m", None], constraints=labels)


@pytest.mark.parametrize(
    ("key", "places"),
    [
        (slice(None), [0, 1, 2]),
        (slice(None, None, -2), [2, 0]),
        ([2, 0], [2, 0]),
        ([-1, -1], [2, 2]),
        (np.array([1]), [1]),
        (["c", "a"], [2, 0]),
        ([True, False, True], [0, 2]),
        (np.array([False, True, False]), [1]),
        ((np.array([1, 2]), ...), [1, 2]),
    ],
)
def test_some_movements_keep_what_belongs_to_them(key: object, places: list[int], toy: Demonstrations) -> None:
    same(three()[key], three(), places)


def test_one_movement_is_its_positions(toy: Demonstrations) -> None:
    given = three()
    for k in range(-3, 3):
        assert np.array_equal(given[k], given.trajectories[k])
        assert np.array_equal(given[np.int64(k)], given.trajectories[k])
    assert np.array_equal(given["b"], given.trajectories[1])
    same(toy[10:12], toy, [10, 11])
    assert SlopeGp(max_rows=60).fit(toy[:20]).predict([[0.3, 1.2]]).shape == (1, 2)


@pytest.mark.parametrize(
    ("key", "error", "said"),
    [
        (3, IndexError, "no movement 3, of 3"),
        (-4, IndexError, "no movement -4, of 3"),
        ([0, 3], IndexError, "no movement 3"),
        ("d", KeyError, "one of: a, b, c"),
        (["a", "d"], KeyError, "no movement 'd'"),
        ([True, False], PolicyAlignError, "a mask of 2 booleans for 3 movements"),
        (slice(3, None), PolicyAlignError, "no movement is chosen"),
        ([0.5], TypeError, "not float64"),
        (1.0, TypeError, "not float"),
        (None, TypeError, "not NoneType"),
        ([[0, 1]], TypeError, "not list"),
    ],
)
def test_what_chooses_nothing_is_refused(key: object, error: type[Exception], said: str) -> None:
    with pytest.raises(error, match=said):
        three()[key]


def test_scikit_learn_divides_movements(toy: Demonstrations) -> None:
    selection = pytest.importorskip("sklearn.model_selection")
    learner = SlopeGp(max_rows=60)
    scores = selection.cross_val_score(learner, toy, cv=4)
    parts = [list(range(10 * k, 10 * k + 10)) for k in range(4)]
    for score, part in zip(scores, parts, strict=True):
        rest = [k for k in range(40) if k not in part]
        assert score == SlopeGp(max_rows=60).fit(toy[rest]).score(toy[part])
    train, test = selection.train_test_split(toy, test_size=0.25, random_state=0)
    assert (len(train), len(test)) == (30, 10) and not set(train.names) & set(test.names)
    grid = selection.GridSearchCV(learner, {"max_rows": [50, 60]}, cv=2).fit(toy)
    assert grid.best_score_ > 0.9 and grid.predict([[0.3, 1.2]]).shape == (1, 2)
