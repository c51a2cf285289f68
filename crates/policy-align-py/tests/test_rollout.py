"""Roll-outs under constraints given in Python."""

from __future__ import annotations

import re

import numpy as np
import pytest

from policy_align import PolicyAlignError, SlopeGp

START = [1.5, 1.0]


def test_a_constraint_comes_in_four_forms(slope: SlopeGp, tmp_path) -> None:
    file = tmp_path / "wall.toml"
    file.write_text("[[constraint]]\nnormal = [1, 0]\n")
    usual = slope.rollout(START, 2.0, constraint=file)
    for constraint in ([1, 0], [[1.0, 0.0]], np.array([1, 0]), str(file), lambda x, t: [1, 0], lambda x, t: [[2.0, 0.0]]):
        path = slope.rollout(START, 2.0, constraint=constraint)
        shared = min(len(path), len(usual))
        assert shared > 20
        assert np.allclose(path.states[:shared], usual.states[:shared], rtol=0, atol=1e-12)
        assert np.all(path.states[:, 0] == 1.5)
    assert usual.times.shape == (len(usual),)
    assert usual.velocities.shape == usual.states.shape == (len(usual), 2)


def test_a_constraint_may_change_with_state_and_time(slope: SlopeGp) -> None:
    seen = []

    def tangent(x: np.ndarray, t: float) -> np.ndarray:
        seen.append((x.shape, t))
        return x

    path = slope.rollout(START, 1.0, constraint=tangent)
    assert path.stop == "time" and path.times[-1] == 1.0
    assert np.allclose(np.sum(path.states * path.velocities, axis=1), 0, atol=1e-9)
    assert {shape for shape, _ in seen} == {(2,)} and min(t for _, t in seen) == 0.0
    free = slope.rollout(START, 1.0)
    late = slope.rollout(START, 1.0, constraint=lambda x, t: [1, 0] if t >= 0.5 else [])
    assert np.array_equal(late.states[:10], free.states[:10])
    assert np.allclose(late.states[11:, 0], late.states[11, 0])


def test_what_a_function_raises_arrives(slope: SlopeGp) -> None:
    def fails(x: np.ndarray, t: float) -> np.ndarray:
        raise KeyError("mine") if t > 0.2 else KeyboardInterrupt if t < 0 else LookupError("early")

    with pytest.raises(LookupError, match="early"):
        slope.rollout(START, constraint=fails)

    def interrupted(x: np.ndarray, t: float) -> np.ndarray:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        slope.rollout(START, constraint=interrupted)
    with pytest.raises(TypeError, match="constraint holds"):
        slope.rollout(START, constraint=lambda x, t: ["wall"])
    with pytest.raises(PolicyAlignError, match="its rows have 3 numbers, the state 2"):
        slope.rollout(START, constraint=lambda x, t: [1, 0, 0])
    with pytest.raises(PolicyAlignError, match="not finite"):
        slope.rollout(START, constraint=lambda x, t: [np.nan, 0])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([1.0],), "the start has 1 number, the state 2: x, y"),
        (([[1.0, 2.0]],), "Expected 1D array, got 2D array instead"),
        (([np.nan, 0.0],), "the start is not finite in channel 'x'"),
        (([90.0, 0.0],), "the start is outside the data"),
        ((START, -1.0), "seconds is -1: it must be positive and finite"),
        ((START, 1e12), "samples exceed the limit of 10 million"),
    ],
)
def test_starts_and_times_are_looked_at(arguments: tuple, words: str, slope: SlopeGp) -> None:
    with pytest.raises(PolicyAlignError) as error:
        slope.rollout(*arguments)
    assert words in str(error.value)
    hint = str(error.value.hint)
    assert "--" not in hint and "policy-align" not in hint


def test_a_start_outside_the_data_is_told_where_they_are(slope: SlopeGp) -> None:
    with pytest.raises(PolicyAlignError) as error:
        slope.rollout([90.0, 0.0])
    assert re.fullmatch(r"start near a demonstration, within x -.* … .*, y -.* … .*: supports\(\[x0\]\) is True there", error.value.hint)


def test_constraints_are_looked_at(slope: SlopeGp, tmp_path) -> None:
    for constraint, words in (([0.0, 0.0], "no direction"), ([1.0], "1 number,"), ([[np.inf, 1.0]], "not finite")):
        with pytest.raises(PolicyAlignError, match=words):
            slope.rollout(START, constraint=constraint)
    file = tmp_path / "wall.toml"
    file.write_text("[[constraint]]\nnormal = [1]\n")
    with pytest.raises(PolicyAlignError, match="`normal` has 1 number"):
        slope.rollout(START, constraint=file)
    with pytest.raises(FileNotFoundError):
        slope.rollout(START, constraint=tmp_path / "none.toml")
    with pytest.raises(FileNotFoundError):
        slope.rollout(START, limits=tmp_path / "none.urdf")
