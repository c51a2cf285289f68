"""Fits every setting to every recording, on all machines of a Dask scheduler: python sweep.py ADDRESS FOLDER FILE..."""

import sys
from pathlib import Path

from dask.distributed import Client, as_completed

from policy_align import Demonstrations, PolicyAlign

LEARNERS = {width: PolicyAlign(width, init_d=10.0, max_rows=100, n_jobs=1) for width in ("narrow", "medium", "wide")}


def learnt(learner, demonstrations):
    """What a worker does: an estimator comes, and goes back with its model."""
    return learner.fit(demonstrations)


def main(scheduler, folder, *files):
    """Writes FOLDER/FILE-WIDTH.json as they come; returns how many could not be learnt."""
    with Client(scheduler) as client:
        names = {}
        for file in files:
            recording = client.submit(Demonstrations.read, file)  # once for all settings; lost with its worker, again
            for width, learner in LEARNERS.items():
                names[client.submit(learnt, learner, recording)] = f"{Path(file).stem}-{width}.json"
        failed = 0
        for future in as_completed(names):
            if error := future.exception():  # a file that cannot be read, or too little to learn from
                failed += 1
                print(names[future], error, file=sys.stderr, flush=True)
                continue
            model = future.result()
            model.save(Path(folder) / names[future])
            print(names[future], f"{model.trust_.numbers['held_out_error']:.3f}", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) > 0)
