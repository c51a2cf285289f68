#!/usr/bin/env python3
"""Compares this project with dense_numpy.py, one thread each: alignment, integration to offsets and kept set.

usage: compare_align.py [--program PATH] [--repeat R]

Writes each data set to a file, runs both on it, compares the bandwidth, the kept set, H, a and the offsets, and only then prints
CPU and wall seconds (minima over the repetitions) and their ratio. Builds the program if no path is given.
Ends with an error if results differ.
"""
import argparse, json, os, pathlib, subprocess, sys, tempfile
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"  # before NumPy starts its threads
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import dense_numpy

# name, trajectories, samples, dimensions, bandwidth, repetitions
CASES = [
    ("40x40 d=2 narrow", 40, 40, 2, "narrow", 50),
    ("40x40 d=2 medium", 40, 40, 2, "medium", 50),
    ("40x40 d=2 wide", 40, 40, 2, "wide", 50),
    ("40x40 d=6 narrow", 40, 40, 6, "narrow", 50),
    ("40x40 d=22 narrow", 40, 40, 22, "narrow", 50),
    ("100x100 d=2 narrow", 100, 100, 2, "narrow", 5),
    ("100x100 d=2 medium", 100, 100, 2, "medium", 5),
    ("100x100 d=2 wide", 100, 100, 2, "wide", 5),
    ("100x100 d=6 narrow", 100, 100, 6, "narrow", 5),
    ("100x100 d=22 narrow", 100, 100, 22, "narrow", 5),
    ("300x100 d=2 narrow", 300, 100, 2, "narrow", 1),
]


def toy(rng, trajectories, samples, dimensions):
    """States (K, N, n) on the parabola .05|x|^2 under a one-dimensional random constraint, redrawn every 20 steps."""
    x = rng.uniform(-2, 2, (trajectories, dimensions))
    states = []
    for step in range(samples):
        if step % 20 == 0:
            normal = rng.standard_normal((trajectories, dimensions))
            normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        states.append(x)
        wanted = -0.1 * x
        x = x + wanted - normal * np.sum(normal * wanted, axis=1, keepdims=True)
    return np.ascontiguousarray(np.stack(states, axis=1))


def peer(states, bandwidth, repeat):
    runs = [dense_numpy.align(states, sigma=bandwidth) for _ in range(repeat)]
    return runs[0][0], min(t["cpu_total"] for _, t in runs), min(t["total"] for _, t in runs)


def ours(program, path):
    found = json.loads(subprocess.run([program, path], check=True, capture_output=True, text=True).stdout)
    count = len(found["linear"])
    found["laplacian"] = np.array(found["laplacian"]).reshape(count, count)  # empty where H was not formed
    return found


def check(name, theirs, found):
    """Exits unless both results agree, the offsets to within the peer's own rounding, about 1e-16 / lambda_2."""
    kept = np.flatnonzero(theirs["keep"])
    values = float(np.abs(theirs["a"]).max())
    problems = []
    if not np.isclose(found["sigma_squared"], theirs["sigma2"], rtol=1e-14, atol=0):
        problems.append("sigma squared")
    if list(kept) != found["kept"]:
        problems.append("kept trajectories")
    formed = len(found["linear"]) > 0
    if formed and np.abs(found["laplacian"] - theirs["H"]).max() > 1e-13 * np.abs(theirs["H"]).max():
        problems.append("H")
    if formed and np.abs(np.array(found["linear"]) - theirs["a"]).max() > 1e-12 * values:
        problems.append("a")
    if not problems:
        difference = np.abs(np.array(found["offsets"]) - theirs["b_in"][kept]).max()
        if difference > 1e-12 + 1e-15 * values / found["lambda_2"]:
            problems.append(f"offsets, by {difference:.1e}")
    if problems:
        sys.exit(f"{name}: results differ: {', '.join(problems)}")


def build():
    root = pathlib.Path(__file__).parents[2]
    subprocess.run(["cargo", "build", "--release", "-p", "benches", "--bin", "align_file"], cwd=root, check=True)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))
    return target / "release" / "align_file"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program")
    parser.add_argument("--repeat", type=float, default=1.0, help="factor on the number of repetitions")
    options = parser.parse_args()
    program = options.program or build()
    print(f"{'data':22s}{'NumPy cpu':>12s}{'ours cpu':>12s}{'ratio':>8s}{'NumPy wall':>12s}{'ours wall':>12s}{'ratio':>8s}   kept")
    for seed, (name, trajectories, samples, dimensions, bandwidth, repeat) in enumerate(CASES):
        repeat = max(1, int(repeat * options.repeat))
        states = toy(np.random.default_rng(seed), trajectories, samples, dimensions)
        with tempfile.NamedTemporaryFile() as file:
            file.write(f"{trajectories} {samples} {dimensions} {4 * repeat} {bandwidth}\n".encode() + states.astype("<f8").tobytes())
            file.flush()
            found = ours(program, file.name)
        theirs, cpu, wall = peer(states, bandwidth, repeat)
        check(name, theirs, found)
        print(f"{name:22s}{cpu * 1e3:9.2f} ms{found['cpu'] * 1e3:9.3f} ms{cpu / found['cpu']:8.1f}"
              f"{wall * 1e3:9.2f} ms{found['wall'] * 1e3:9.3f} ms{wall / found['wall']:8.1f}   {len(found['kept'])}/{trajectories}", flush=True)


if __name__ == "__main__":
    main()
