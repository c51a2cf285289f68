"""Movements for the tests."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest

from policy_align import Demonstrations, PolicyAlign, SlopeGp

ROOT = Path(__file__).parents[3]
TOY = ROOT / "docs/examples/toy.csv"
DT = 0.05


def on_rails(count: int = 12, samples: int = 40, dim: int = 2) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Movements down φ = ‖x‖²/2, each on another straight rail: positions and velocities, (N, n) each."""
    numbers = np.random.default_rng(7)
    seconds = DT * np.arange(samples)[:, None]
    positions, velocities = [], []
    for _ in range(count):
        start, rail = numbers.uniform(-1.5, 1.5, dim), numbers.normal(size=dim)
        rail /= np.linalg.norm(rail)
        along = rail * (rail @ start)
        positions.append(start - along * (1 - np.exp(-seconds)))
        velocities.append(-along * np.exp(-seconds))
    return positions, velocities


def without_time(text: str) -> str:
    """A model file without the time and the checksum, which covers the time: they differ between runs."""
    text, times = re.subn(r'"time":"[^"]*"', '"time":""', text)
    text, sums = re.subn(r'"checksum":"[0-9a-f]{64}"', '"checksum":""', text)
    assert (times, sums) == (1, 1)
    return text


@pytest.fixture(scope="session")
def rails() -> tuple[list[np.ndarray], list[np.ndarray]]:
    return on_rails()


@pytest.fixture(scope="session")
def toy() -> Demonstrations:
    return Demonstrations.read(TOY)


@pytest.fixture(scope="session")
def slope(toy: Demonstrations) -> SlopeGp:
    return SlopeGp(max_rows=100).fit(toy)


@pytest.fixture(scope="session")
def aligned(toy: Demonstrations) -> PolicyAlign:
    return PolicyAlign("medium", init_d=10.0, max_rows=100).fit(toy)


@pytest.fixture(scope="session")
def program() -> Path:
    """The program, built from the same sources."""
    path = Path(os.environ.get("POLICY_ALIGN_PROGRAM", ROOT / "target/debug/policy-align"))
    if not path.exists():
        pytest.skip(f"{path} is not built: cargo build -p policy-align")
    return path
