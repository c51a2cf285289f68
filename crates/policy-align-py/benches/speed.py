"""The overhead of the Python interface: times beside those of Rust alone, in the same minute on the same machine.

    cargo build -p policy-align --example speed        # with --release, if the package is built so
    python crates/policy-align-py/benches/speed.py target/debug/examples/speed
"""

from __future__ import annotations

import resource
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from policy_align import Demonstrations, PolicyAlign, SlopeGp

TOY = Path(__file__).parents[3] / "docs/examples/toy.csv"


def least(work: Callable[[], object], runs: int = 7) -> float:
    """Seconds of the fastest run."""
    seconds = []
    for _ in range(runs):
        begin = time.perf_counter()
        work()
        seconds.append(time.perf_counter() - begin)
    return min(seconds)


def rust(program: str) -> dict[str, float]:
    words = subprocess.run([program, TOY], capture_output=True, text=True, check=True).stdout.split()
    return dict(zip(words[::2], map(float, words[1::2]), strict=True))


def at_once(work: Callable[[], object], threads: int) -> float:
    """Seconds for this number of threads to do the same work each."""
    running = [threading.Thread(target=work) for _ in range(threads)]
    begin = time.perf_counter()
    for thread in running:
        thread.start()
    for thread in running:
        thread.join()
    return time.perf_counter() - begin


def main() -> None:
    alone = rust(sys.argv[1])
    toy = Demonstrations.read(TOY)
    positions, velocities = list(toy), toy.velocities
    # The same states as in the Rust program.
    states = np.sin(np.arange(100_000)[:, None] * (0.7 * np.arange(1, 3)))
    learner = SlopeGp(max_rows=100)
    fitting = least(lambda: learner.fit(positions, dt=0.05, velocities=velocities))
    print(f"fit            {1e3 * fitting:9.2f} ms  Rust {1e3 * alone['fit']:9.2f} ms")
    models = {"slope": learner, "policy_align": PolicyAlign("medium", init_d=10.0, max_rows=100).fit(toy)}
    for name, model in models.items():
        batch = least(lambda model=model: model.predict(states))
        print(f"{name:14} {1e4 * batch:9.1f} ns  Rust {1e4 * alone[name]:9.1f} ns a state, ratio {batch / alone[name]:.3f}")
        one = states[:1]
        single = least(lambda model=model: [model.predict(one) for _ in range(10_000)]) / 1e4
        pair, single_thread = (min(at_once(lambda model=model: model.predict(states), k) for _ in range(7)) for k in (2, 1))
        print(f"{'':14} one state {1e6 * single:.2f} µs; two threads {2 * single_thread / pair:.2f} times as fast as one")
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    model, one = models["policy_align"], states[:1]
    for _ in range(1_000_000):
        model.predict(one)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    print(f"memory         grown by {grown} kB over 1e6 predictions")


if __name__ == "__main__":
    main()
