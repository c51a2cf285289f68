"""Threads, Ctrl-C, forks, memory, speed."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from conftest import DT, on_rails

from policy_align import PolicyAlign, SlopeGp

STATES = np.random.default_rng(5).uniform(-1, 1, (50_000, 2))


def counted_while(work) -> tuple[int, float]:
    """The count that another Python thread reaches meanwhile, and the duration in seconds."""
    done, count = threading.Event(), 0

    def counting() -> None:
        nonlocal count
        while not done.is_set():
            count += 1

    thread = threading.Thread(target=counting)
    thread.start()
    began = time.perf_counter()
    work()
    seconds = time.perf_counter() - began
    done.set()
    thread.join()
    return count, seconds


def test_other_threads_go_on(slope: SlopeGp) -> None:
    positions, velocities = on_rails()
    for work in (
        lambda: SlopeGp(max_rows=100, n_jobs=1).fit(positions, dt=DT, velocities=velocities),
        lambda: slope.predict(STATES),
    ):
        count, seconds = counted_while(work)
        alone, least = counted_while(lambda: time.sleep(0.2))
        # A thread that gets the lock between calls only would count at most a tenth of its count alone.
        assert count / seconds > 0.1 * alone / least, (count, seconds, alone)


def test_two_threads_predict_the_same_at_once(aligned: PolicyAlign) -> None:
    usual = aligned.predict(STATES)
    found: dict[int, np.ndarray] = {}
    threads = [
        threading.Thread(target=lambda k=k: found.update({k: aligned.predict(STATES)})) for k in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(found[k], usual) for k in range(4))


LONG_FIT = """
import sys, time, warnings, numpy as np
from policy_align import PolicyAlign
warnings.simplefilter("ignore")
x = np.random.default_rng(0).normal(size=(60, 120, 3)).cumsum(axis=1)
print("begins", flush=True)
try:
    PolicyAlign(max_rows={max_rows}).fit(x, dt=0.1)
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print(PolicyAlign("medium", init_d=10.0, max_rows=60).fit(x[:5, :20], dt=0.1).n_features_in_, flush=True)
"""


def interrupted(script: str, after: float, within: float, then: str) -> None:
    """Ctrl-C ``after`` seconds into the script acts in ``within`` seconds, and the interpreter continues."""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as running:
        assert running.stdout is not None and running.stdout.readline() == "begins\n"
        time.sleep(after)
        began = time.monotonic()
        running.send_signal(signal.SIGINT)
        assert running.stdout.readline() == "interrupted\n"
        assert time.monotonic() - began < within
        assert running.stdout.readline() == then
    assert running.returncode == 0


@pytest.mark.parametrize("max_rows", [60, 1500])
@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_fit_within_a_second(max_rows: int) -> None:
    interrupted(LONG_FIT.format(max_rows=max_rows), after=0.4, within=1.0, then="3\n")


LONG_PREDICTION = """
import warnings, numpy as np
from policy_align import SlopeGp
warnings.simplefilter("ignore")
x = np.random.default_rng(0).normal(size=(60, 20, 3)).cumsum(axis=1)
model = SlopeGp(max_rows=400).fit(x, dt=0.1)
print("begins", flush=True)
try:
    model.predict(np.zeros((5_000_000, 3)))
except KeyboardInterrupt:
    print("interrupted", flush=True)
    print(model.predict(x[0]).shape, flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of POSIX")
def test_ctrl_c_ends_a_prediction() -> None:
    interrupted(LONG_PREDICTION, after=2.0, within=2.0, then="(20, 3)\n")


def _fitted_in_child(out) -> None:
    positions, velocities = on_rails()
    out.send(SlopeGp(max_rows=60).fit(positions, dt=DT, velocities=velocities).predict(STATES[:50]))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_fits(rails) -> None:
    usual = SlopeGp(max_rows=60).fit(rails[0], dt=DT, velocities=rails[1]).predict(STATES[:50])
    ours, theirs = multiprocessing.Pipe()
    child = multiprocessing.get_context("fork").Process(target=_fitted_in_child, args=(theirs,))
    child.start()
    assert ours.poll(120), "the child waits for threads that it has not"
    assert np.array_equal(ours.recv(), usual)
    child.join(10)


def resident() -> int:
    """Resident memory in bytes, on Linux."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="measured on Linux")
def test_memory_does_not_grow(aligned: PolicyAlign) -> None:
    one, batch = STATES[:1], STATES[:1000]
    positions, velocities = on_rails(4, 10)
    learner = SlopeGp(max_rows=50, n_jobs=1)

    def round_of_work() -> None:
        for _ in range(20_000):
            aligned.predict(one)
        for _ in range(20):
            aligned.predict(batch)
            aligned.supports(batch)
        for _ in range(3):
            learner.fit(positions, dt=DT, velocities=velocities)

    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        round_of_work()
        gc.collect()
        tracemalloc.start()
        before, traced = resident(), tracemalloc.get_traced_memory()[0]
        for _ in range(3):
            round_of_work()
        gc.collect()
        grown, traced = resident() - before, tracemalloc.get_traced_memory()[0] - traced
        tracemalloc.stop()
    assert grown < 5_000_000 and traced < 1_000_000, (grown, traced)
