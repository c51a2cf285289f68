#!/usr/bin/env python3
"""Compares policies learnt under constraints A u = b: the slope GP and the estimators of constraints.py, on the same data.

usage: compare_constraints.py [--sets 5] [--generators cycle,cycle-task,wiping,wiping-flat] [--decibels none,50,40,30,20,10] [--rows 400]
                              [--jobs 2] [--program PATH]

Errors are nUPE at the states of 20 fresh movements: medians over the data sets. The estimators receive the rank of A; with "J" also the arm's
Jacobian, and GSVD is tried with and without its pose, of which b is a linear function: the lower true error counts. The slope GP receives none of
these, and "ours, J" the Jacobians of the tool's position, its orientation and both. Builds the program if no path is given.
"""
import argparse, json, os, pathlib, subprocess, sys
from concurrent.futures import ProcessPoolExecutor
for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS"):
    os.environ[name] = "1"  # one process per data set
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import constraints

RANKS = {"cycle": 1, "cycle-task": 1, "wiping": 1, "wiping-flat": 3}
NOISE = ("none", "50", "40", "30", "20", "10")
PEERS = ("DPL", "CCL", "SVD", "GSVD", "SVD, J", "GSVD, J")


def read(program, generator, number, decibels, rows):
    words = [program, generator, str(number), decibels, str(rows)]
    found = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    n, samples = found["dim"], found["samples"]
    shapes = {"states": (-1, samples, n), "velocities": (-1, samples, n), "jacobians": (-1, samples, 6, n), "positions": (-1, samples, 3),
              "tool_axes": (-1, samples, 3), "test_states": (-1, n), "test_actions": (-1, n), "ours": (-1, n), "ours_with_robot": (-1, n)}
    return {name: np.reshape(value, shapes[name]) if name in shapes else value for name, value in found.items()}


def movements_for(peer, found, generator):
    """The movements with the kinematics of the arm that the peer receives, in each variant."""
    plain = [{"x": x, "u": u} for x, u in zip(found["states"], found["velocities"])]
    if not peer.endswith("J"):
        return [plain]
    if "jacobians" not in found:
        return []
    rows = slice(0, 3) if generator == "wiping" else slice(0, 6)
    with_jacobian = [{**movement, "J": jacobian[:, rows]} for movement, jacobian in zip(plain, found["jacobians"])]
    if generator == "wiping" or peer.startswith("SVD"):
        return [with_jacobian]
    poses = zip(with_jacobian, found["positions"], found["tool_axes"])
    return [with_jacobian, [{**movement, "z": np.c_[position, axis]} for movement, position, axis in poses]]


def errors(task):
    """nUPE on one data set of each peer, of ours without the arm and of ours with it, and facts about ours."""
    program, generator, number, decibels, rows = task
    found = read(program, generator, number, decibels, rows)
    error = lambda policy: constraints.nupe(policy, found["test_states"], found["test_actions"])

    def peer(name):
        estimate = constraints.ESTIMATORS[name.split(",")[0]]
        told = movements_for(name, found, generator)
        return min((error(estimate(movements, RANKS[generator])) for movements in told), default=np.nan)
    ours = [error(lambda _: found[name]) if name in found else np.nan for name in ("ours", "ours_with_robot")]
    return [peer(name) for name in PEERS] + ours, found["ours_facts"], found.get("ours_with_robot_facts")


def build():
    root = pathlib.Path(__file__).parents[2]
    subprocess.run(["cargo", "build", "--release", "-p", "benches", "--bin", "constraints_file"], cwd=root, check=True)
    return pathlib.Path(os.environ.get("CARGO_TARGET_DIR", root / "target")) / "release" / "constraints_file"


def line(generator, decibels, outcomes):
    values = np.array([outcome[0] for outcome in outcomes])
    medians = np.median(values, 0)
    peers, untold = medians[:-2], medians[:4].min()
    told = medians[-1] if not np.isnan(medians[-1]) else medians[-2]
    count = lambda of: f"{sum(of(outcome) for outcome in outcomes)} of {len(outcomes)}"
    cells = [generator, decibels, *("–" if np.isnan(value) else f"{value:.2g}" for value in medians),
             f"{medians[-2] / untold:.2g}", f"{told / np.nanmin(peers):.2g}",
             count(lambda outcome: np.nanmin(outcome[0][-2:]) <= np.nanmin(outcome[0][:-2])),
             count(lambda outcome: outcome[1]["pushed"] is not None),
             count(lambda outcome: outcome[2] is not None and outcome[2]["space"] is not None)]
    return "| " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sets", type=int, default=5)
    parser.add_argument("--generators", default=",".join(RANKS))
    parser.add_argument("--decibels", default=",".join(NOISE))
    parser.add_argument("--rows", type=int, default=400, help="rows that the slope GP learns from")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--program")
    options = parser.parse_args()
    program = str(options.program or build())
    header = ["generator", "SNR, dB", *PEERS, "ours", "ours, J", "ours / best without J", "ours (, J) / best", "ours is best",
              "stretches used", "task space used"]
    print("| " + " | ".join(header) + " |\n|" + " --- |" * len(header), flush=True)
    with ProcessPoolExecutor(options.jobs) as pool:
        for generator in options.generators.split(","):
            for decibels in options.decibels.split(","):
                tasks = [(program, generator, number, decibels, options.rows) for number in range(1, options.sets + 1)]
                print(line(generator, decibels, list(pool.map(errors, tasks))), flush=True)


if __name__ == "__main__":
    main()
