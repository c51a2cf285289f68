"""Constraints that acted on movements."""

from __future__ import annotations

import numpy as np
import pytest
from conftest import DT

from policy_align import PolicyAlignError, SlopeGp


def test_constraints_are_found(rails, tmp_path) -> None:
    positions, velocities = rails
    model = SlopeGp(max_rows=60).fit(positions, dt=DT, velocities=velocities)
    found = model.constraints_
    assert [str(stretch) for stretch in found] == [str(stretch) for stretch in model.constraints_]
    named = [stretch for stretch in found if stretch.acting == "constraint"]
    assert len(named) >= 0.8 * len(positions)
    for stretch in named:
        begin, end = stretch.samples
        moved = velocities[int(stretch.episode)][begin : end + 1]
        assert stretch.A.shape == (1, 2) and stretch.link is None
        assert np.isclose(np.linalg.norm(stretch.A), 1)
        assert np.abs(moved @ stretch.A.T - stretch.b).max() < 1e-3 * np.abs(moved).max()
        kept = positions[int(stretch.episode)][begin : end + 1] @ stretch.A.T
        assert np.abs(kept - stretch.level).max() < 0.05 and " = " in str(stretch)
    others = model.constraints(positions[:2], velocities=velocities[:2])
    assert {stretch.episode for stretch in others} <= {"0", "1"}

    half = len(positions[0]) // 2
    names = [["free"] * half + [2] * (len(samples) - half) for samples in positions]
    named = SlopeGp(max_rows=60).fit(positions, dt=DT, velocities=velocities, constraints=names).constraints_
    assert {stretch.label for stretch in named} == {"free", "2"} and "(free)" in str(named[0])
    assert all(stretch.samples[0 if stretch.label == "2" else 1] in (half, half - 1) for stretch in named)
    with pytest.raises(PolicyAlignError, match="names of constraints for the"):
        SlopeGp().fit(positions, dt=DT, velocities=velocities, constraints=[["a"]] * len(positions))

    model.save(tmp_path / "model.json")
    again = SlopeGp.load(tmp_path / "model.json")
    with pytest.raises(PolicyAlignError, match="does not hold its movements"):
        _ = again.constraints_
    with pytest.raises(PolicyAlignError, match="."):
        (tmp_path / "arm.urdf").write_text("<robot")
        again.constraints(positions, velocities=velocities, robot=tmp_path / "arm.urdf")
