"""Recordings from files or memory."""

from __future__ import annotations

import numpy as np
import pytest

from policy_align import Demonstrations, PolicyAlignError, PolicyAlignWarning, SlopeGp


def test_what_is_noticed_is_warned_of(tmp_path) -> None:
    path = tmp_path / "commas.csv"
    rows = (f"{0.1 * k:.1f};{np.sin(k):.6f}\n".replace(".", ",") for k in range(20))
    path.write_text("t;x\n" + "".join(rows))
    with pytest.warns(PolicyAlignWarning, match='read as points: decimal="[.]" if') as warned:
        found = Demonstrations.read(path)
    assert found.notes == [str(warning.message) for warning in warned]


def test_check_says_what_would_be_learnt_from(toy: Demonstrations) -> None:
    check = toy.check()
    assert (check.episodes, check.samples, check.channels, check.time_step) == (40, 1600, ("x", "y"), 0.05)
    assert {decision.what for decision in check.decisions} >= {"time step", "velocities"}
    assert "40 episodes, 1600 samples, states x, y" in str(check)
    assert repr(toy) == "<Demonstrations: 40 movements, 1600 samples of x, y>"
    ignored = toy.check(integration="displacement")
    assert any("ignored as requested" in decision.why for decision in ignored.decisions)


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
