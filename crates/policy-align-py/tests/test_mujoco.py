"""The MuJoCo example, reduced: a policy learnt from a hand in planes reaches the goal like the free teacher."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from conftest import ROOT

from policy_align import Demonstrations

pytest.importorskip("mujoco", reason="MuJoCo is not installed: pip install mujoco scikit-learn")
pytest.importorskip("sklearn", reason="scikit-learn is not installed: pip install scikit-learn")

sys.path.append(str(ROOT / "docs/examples/mujoco"))
from reach import GOAL, SHOULDER, Arm, attempts, learnt, on_sphere, record, start, teacher  # noqa: E402

LIMIT = 10.0


@pytest.fixture(scope="module")
def demonstrations(tmp_path_factory: pytest.TempPathFactory) -> Demonstrations:
    file = tmp_path_factory.mktemp("arm") / "demonstrations.csv"
    assert record(file, seed=7, episodes=30, seconds=4.0) < 6
    return Demonstrations.read(file)


def test_the_arm_goes_where_it_is_placed() -> None:
    arm, rng = Arm(), np.random.default_rng(1)
    for _ in range(20):
        x = start(rng)
        for place in (x, on_sphere(x)):
            arm.place(place)
            assert np.allclose(arm.hand, place, atol=1e-12) and not arm.velocity().any()
        assert np.isclose(np.linalg.norm(arm.hand - SHOULDER), np.linalg.norm(GOAL - SHOULDER))
    arm.place(GOAL)
    arm.follow(np.zeros(3))
    assert np.allclose(arm.hand, GOAL, atol=1e-6)


def test_every_demonstration_is_a_projection_of_the_teacher(demonstrations: Demonstrations) -> None:
    for positions, velocities in zip(demonstrations, demonstrations.velocities, strict=True):
        # The movement lies in a plane to 3 mm.
        _, widths, axes = np.linalg.svd(positions - positions.mean(axis=0))
        assert widths[2] < 3e-3 * np.sqrt(len(positions))
        # uᵀπ = uᵀu, except for the lag of the motors.
        wanted = np.array([teacher(x) for x in positions])
        left = np.sum(velocities * (wanted - velocities), axis=1)
        assert np.abs(left[3:]).max() < 0.1 * np.sum(wanted**2, axis=1).max()


def test_it_reaches_where_cloning_does_not(demonstrations: Demonstrations) -> None:
    policies, rng = learnt(demonstrations), np.random.default_rng(5)
    starts = [start(rng) for _ in range(3)]
    free, sphere = attempts(teacher, starts, LIMIT)
    ours = attempts(policies.pop("policy-align"), starts, LIMIT)
    assert (ours < LIMIT).all(), "free, and under a constraint that no demonstration had"
    assert ours[0].mean() < 1.3 * free.mean() and ours[1].mean() < 1.3 * sphere.mean()
    for name, policy in policies.items():
        cloned = attempts(policy, starts, LIMIT)
        # Attempts that do not arrive within 10 s count as 10 s.
        assert cloned[0].mean() > 3.5 * ours[0].mean(), name
