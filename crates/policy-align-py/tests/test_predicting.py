"""Predictions outside the data, at single states and for invalid states; seeds, plots and HTML."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from policy_align import PolicyAlignError, SlopeGp

FAR = [[0.3, 1.2], [9.0, -9.0], [-0.5, 0.2], [1e8, 1e8]]
INSIDE = np.array([True, False, True, False])


@pytest.mark.parametrize("name", ["slope", "aligned"])
def test_there_is_no_action_outside_of_the_data(name: str, request: pytest.FixtureRequest) -> None:
    model: SlopeGp = request.getfixturevalue(name)
    assert np.array_equal(model.supports(FAR), INSIDE)
    raw = model.predict(FAR, outside="extrapolate")
    assert np.array_equal(model.predict(FAR), np.where(INSIDE[:, None], raw, 0.0))
    assert np.array_equal(model.predict(FAR, outside="nan"), np.where(INSIDE[:, None], raw, np.nan), equal_nan=True)
    with pytest.raises(PolicyAlignError, match="state 1 is outside the data") as error:
        model.predict(FAR, outside="error")
    assert error.value.sample == 1
    assert np.array_equal(model.predict(np.array(FAR)[INSIDE], outside="error"), raw[INSIDE])
    with pytest.raises(PolicyAlignError, match="'none' is none of the choices"):
        model.predict(FAR, outside="none")


@pytest.mark.parametrize("name", ["slope", "aligned"])
def test_states_are_supported_as_their_support_says(name: str, request: pytest.FixtureRequest) -> None:
    model: SlopeGp = request.getfixturevalue(name)
    states = np.random.default_rng(4).uniform(-4, 4, (3000, 2))
    support, supports = model.support(states), model.supports(states)
    assert np.array_equal(supports, support >= (0.5 if name == "slope" else np.finfo(float).tiny))
    assert 100 < supports.sum() < 2900
    # The actions do not depend on whether standard deviations are requested.
    actions = model.predict(states, outside="nan")
    assert np.array_equal(np.isnan(actions[:, 0]), ~supports)
    if name == "slope":
        assert np.array_equal(actions, model.predict(states, return_std=True, outside="nan")[0], equal_nan=True)


def test_deviations_are_not_known_outside_of_the_data(slope: SlopeGp) -> None:
    actions, deviations = slope.predict(FAR, return_std=True)
    assert np.array_equal(actions, slope.predict(FAR))
    assert np.array_equal(np.isnan(deviations[:, 0]), ~INSIDE) and (deviations[INSIDE] > 0).all()
    raw, all_of_them = slope.predict(FAR[:3], return_std=True, outside="extrapolate")
    assert raw[1].any() and np.array_equal(all_of_them[INSIDE[:3]], deviations[:3][INSIDE[:3]]) and (all_of_them > 0).all()


def test_the_program_says_the_same_outside(slope: SlopeGp, program: Path, tmp_path: Path) -> None:
    slope.save(tmp_path / "model.json")
    for state, action in zip(FAR[:3], slope.predict(FAR[:3]), strict=True):
        words = [program, "predict", tmp_path / "model.json", "--at", ",".join(map(str, state)), "--json"]
        said = json.loads(subprocess.run(words, capture_output=True, check=True).stdout)["predictions"][0]
        assert np.array_equal(said["action"], action)


def test_one_state_has_one_action(slope: SlopeGp) -> None:
    for x in FAR:
        assert np.array_equal(slope.act(x), slope.predict([x])[0])
    assert np.isnan(slope.act(FAR[1], outside="nan")).all()
    with pytest.raises(PolicyAlignError, match="Expected 1D array, got 2D array instead"):
        slope.act(FAR)
    with pytest.raises(PolicyAlignError, match="X has 3 features"):
        slope.act([0.0, 1.0, 2.0])


def test_masks_are_refused(slope: SlopeGp, rails) -> None:
    states = np.ma.masked_array(FAR, mask=[[0, 0], [1, 0], [0, 0], [0, 0]])
    with pytest.raises(PolicyAlignError, match="X holds masked values"):
        slope.predict(states)
    assert np.array_equal(slope.predict(np.ma.masked_array(FAR, mask=False)), slope.predict(FAR))
    with pytest.raises(TypeError, match="X is a mask of booleans"):
        slope.predict(INSIDE[:, None] & [True, True])
    hidden = [np.ma.masked_array(x, mask=x > 1.4) for x in rails[0]]
    with pytest.raises(PolicyAlignError, match=r"trajectories\[\d+\] holds masked values"):
        SlopeGp(max_rows=60).fit(hidden, dt=0.05)


def test_a_seed_is_a_number_none_or_a_generator(rails) -> None:
    def seed(given: object) -> int:
        model = SlopeGp(max_rows=60, random_state=given).fit(rails[0], dt=0.05, velocities=rails[1])
        return json.loads(model._fitted.about())["seed"]

    assert (seed(None), seed(7), seed(np.uint8(9))) == (1, 7, 9)
    for make in (np.random.default_rng, np.random.RandomState):
        assert seed(make(3)) == seed(make(3)) != seed(make(4))
    for wrong, error in ((-1, PolicyAlignError), (2**64, PolicyAlignError), ("1", TypeError), (1.5, TypeError)):
        with pytest.raises(error, match="random_state is"):
            seed(wrong)


def test_a_notebook_shows_how_far_to_trust(slope: SlopeGp) -> None:
    page = slope._repr_html_()
    assert "SlopeGp(max_rows=100)" in page and slope.trust_._repr_html_() in page
    assert SlopeGp(jumps="<b>")._repr_html_() == "<code>SlopeGp(jumps=&#x27;&lt;b&gt;&#x27;)</code>"
    assert "good" in page


def test_a_policy_is_drawn_where_it_is_known(slope: SlopeGp, toy) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = slope.plot(arrows=9)
    (quiver,) = axes.collections
    places = np.column_stack([quiver.X, quiver.Y])
    assert slope.supports(places).all() and 9 < len(places) <= 81
    assert np.array_equal(np.column_stack([quiver.U, quiver.V]), slope.predict(places))
    assert (axes.get_xlabel(), axes.get_ylabel(), axes.get_title()) == ("x", "y", "SlopeGp: good")
    turned = slope.plot(axes, dims=("y", 0), arrows=5)
    assert turned is axes and (axes.get_xlabel(), axes.get_ylabel()) == ("y", "x")
    other = axes.collections[1]
    expected = slope.predict(np.column_stack([other.Y, other.X]))
    assert np.array_equal(np.column_stack([other.V, other.U]), expected)
    for wrong in ((0, 0), ("z", 0), (0, 2)):
        with pytest.raises(PolicyAlignError) as error:
            slope.plot(dims=wrong)
        assert error.value.hint == "two of x, y"
    matplotlib.pyplot.close("all")
