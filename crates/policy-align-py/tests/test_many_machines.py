"""External engines distribute the work; the result equals that of a single process, bit for bit."""

from __future__ import annotations

import hashlib
import json
import os
import pickle
import runpy
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from multiprocessing.pool import ThreadPool
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import DT, ROOT, on_rails, without_time

from policy_align import AutoGp, Demonstrations, PolicyAlign, PolicyAlignError, dask

SWEEP = ROOT / "docs/examples/sweep.py"


def rails_file(folder: Path, count: int, first: int = 0, samples: int = 10) -> Path:
    """Writes a recording of the movements from ``first`` to the last of ``count``."""
    lines = ["episode,t,x,y,vx,vy"]
    for k, (x, u) in enumerate(zip(*on_rails(count, samples), strict=True)):
        lines += [] if k < first else [",".join(map(repr, [k, DT * i, *x[i].tolist(), *u[i].tolist()])) for i in range(len(x))]
    path = folder / f"rails{count}.csv"
    path.write_text("\n".join(lines))
    return path


@contextmanager
def running(*command: str) -> Iterator[subprocess.Popen[str]]:
    """A separate process, which ends with the test."""
    command = (sys.executable, *command)
    environment = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "3s"}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment)
    try:
        yield process
    finally:
        process.kill()
        process.wait()


def until(true: Callable[[], object], seconds: float = 60.0) -> None:
    """Waits until a condition becomes true."""
    end = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < end, "it never came true"
        time.sleep(0.02)


@contextmanager
def cluster(folder: Path) -> Iterator[tuple[Any, dict[str, subprocess.Popen[str]], dict[str, str]]]:
    """A client with two workers, and the processes and addresses of the workers by name."""
    distributed = pytest.importorskip("distributed")
    address_file = folder / "scheduler.json"
    common = ("--no-dashboard", "--scheduler-file", str(address_file))
    with ExitStack() as stack:
        stack.enter_context(running("-m", "dask", "scheduler", *common, "--host", "127.0.0.1", "--port", "0"))
        until(address_file.exists)
        worker = ("-m", "dask", "worker", *common, "--nthreads", "1", "--no-nanny", "--name")
        workers = {name: stack.enter_context(running(*worker, name)) for name in ("first", "second")}
        client = stack.enter_context(distributed.Client(scheduler_file=str(address_file)))
        client.wait_for_workers(2, timeout=60)
        addresses = {worker["name"]: address for address, worker in client.scheduler_info()["workers"].items()}
        yield client, workers, addresses


@pytest.mark.filterwarnings("ignore")
def test_dask_outlives_a_killed_worker(tmp_path: Path) -> None:
    files = [rails_file(tmp_path, count) for count in (16, 18)]
    (tmp_path / "damaged.csv").write_text("episode,t,x,y\n0,0.0,1.0,none\n")
    with ExitStack() as stack:
        client, workers, addresses = stack.enter_context(cluster(tmp_path))
        address = client.scheduler.address
        sweep = stack.enter_context(running(str(SWEEP), address, str(tmp_path), *map(str, [*files, tmp_path / "damaged.csv"])))
        assert sweep.stdout is not None and sweep.stdout.readline().startswith("rails"), "nothing was learnt"
        # It is computing, or holds results: small tasks may be complete before this check.
        until(lambda: client.processing()[addresses["second"]] or client.has_what()[addresses["second"]])
        workers["second"].send_signal(signal.SIGKILL)
        assert sweep.wait(300) == 1, "the damaged file was not missed"
        assert len(client.scheduler_info()["workers"]) == 1
    assert not list(tmp_path.glob("damaged-*"))
    for file in files:
        for width, learner in runpy.run_path(str(SWEEP))["LEARNERS"].items():
            learner.fit(Demonstrations.read(file)).save(tmp_path / "alone.json")
            found = (tmp_path / f"{file.stem}-{width}.json").read_text()
            assert without_time(found) == without_time((tmp_path / "alone.json").read_text())


@pytest.mark.filterwarnings("ignore")
def test_a_search_in_processes_finds_the_same() -> None:
    pytest.importorskip("sklearn")
    from sklearn.model_selection import GridSearchCV

    positions, _ = on_rails()

    def found(jobs: int) -> tuple[np.ndarray, np.ndarray]:
        learner, grid = PolicyAlign(init_d=10.0, folds=2, max_rows=60, n_jobs=1), {"bandwidth": ["narrow", "wide"]}
        search = GridSearchCV(learner, grid, scoring=lambda model, X, y=None: model.score(X), cv=2, n_jobs=jobs)
        search.fit(positions, dt=DT)
        return search.cv_results_["mean_test_score"], search.predict(positions[0])

    for one, two in zip(found(1), found(2), strict=True):
        assert np.array_equal(one, two) and np.all(np.isfinite(one))


class Dying:
    """A client whose first task kills its worker, once."""

    def __init__(self, client: Any, marker: Path) -> None:
        self.client, self.marker = client, marker

    def map(self, function: Callable[[Any], bytes], items: list[Any]) -> Any:
        marker = str(self.marker)

        def die_once(item: Any) -> bytes:  # nested, so that workers need no test module
            try:
                os.close(os.open(marker, os.O_CREAT | os.O_EXCL))  # only one of two simultaneous tasks succeeds
                os.kill(os.getpid(), signal.SIGKILL)
            except FileExistsError:
                pass
            return function(item)

        return self.client.map(die_once, items)


@pytest.mark.filterwarnings("ignore")
def test_one_fit_is_shared_out(tmp_path: Path) -> None:
    files = [rails_file(tmp_path, 10 * k + 10, 10 * k) for k in range(6)]
    at_once = f"{2.1 * files[-1].stat().st_size / 1e3}kB"
    learner = AutoGp(max_rows=60, n_jobs=1)

    def model(learnt: AutoGp) -> str:
        learnt.save(tmp_path / "model.json")
        return without_time((tmp_path / "model.json").read_text())

    alone = model(learner.fit_files(*files, at_once=at_once))
    about = json.loads(alone)
    assert about["data"]["episodes"] == 60
    assert [file["name"] for file in about["data"]["files"]] != sorted(str(file.name) for file in files)
    assert any(decision["what"] == "at once" for decision in about["decisions"])
    with ThreadPool(2) as pool:
        assert model(learner.fit_files(*files, at_once=at_once, map=pool.map)) == alone
    assert model(learner.fit_files(*files, at_once="all")) != alone
    with pytest.raises(PolicyAlignError, match="not a size"):
        learner.fit_files(*files, at_once="much")
    with pytest.raises(PolicyAlignError, match="all files at once"):
        PolicyAlign().fit_files(*files, at_once=at_once)
    (tmp_path / "damaged.csv").write_text("episode,t,x,y\n0,0.0,1.0,none\n" * 2)
    with pytest.raises(PolicyAlignError, match="damaged.csv"):
        learner.fit_files(files[0], tmp_path / "damaged.csv", *files[1:], at_once=at_once)
    with cluster(tmp_path) as (client, _, _):
        dying: Any = Dying(client, tmp_path / "died")
        assert model(dask.fit(files, dying, learner, at_once=at_once)) == alone
        assert len(client.scheduler_info()["workers"]) == 1


@pytest.mark.filterwarnings("ignore")
def test_one_large_file_is_shared_out(tmp_path: Path) -> None:
    file = rails_file(tmp_path, 300, samples=40)
    learner = AutoGp(max_rows=60, inducing=0, n_jobs=1)

    def model(learnt: AutoGp) -> str:
        learnt.save(tmp_path / "model.json")
        return without_time((tmp_path / "model.json").read_text())

    taken: list[Any] = []

    def backwards(function: Callable[[Any], bytes], items: list[Any]) -> list[bytes]:
        taken.extend(items)
        return [function(item) for item in pickle.loads(pickle.dumps(items))[::-1]][::-1]

    alone = model(learner.fit_files(file, at_once="600kB"))
    about = json.loads(alone)["data"]
    assert about["episodes"] == 300
    summary = {"name": file.name, "sha256": hashlib.sha256(file.read_bytes()).hexdigest(), "bytes": file.stat().st_size}
    assert about["files"] == [summary]
    assert model(learner.fit_files(file, at_once="600kB", map=backwards)) == alone
    assert len(taken) > 1
    with ThreadPool(2) as pool:
        assert model(learner.fit_files(file, at_once="600kB", map=pool.map)) == alone

    def changed(function: Callable[[Any], bytes], items: list[Any]) -> list[bytes]:
        file.write_text(file.read_text() + "\n")
        return list(map(function, items))

    with pytest.raises(PolicyAlignError, match="has changed"):
        learner.fit_files(file, at_once="600kB", map=changed)


@pytest.mark.filterwarnings("ignore")
def test_an_interrupted_fit_goes_on(tmp_path: Path) -> None:
    files = [rails_file(tmp_path, 10 * k + 10, 10 * k) for k in range(8)]
    options: dict[str, Any] = {"at_once": f"{2.1 * files[-1].stat().st_size / 1e3}kB"}
    learner, unfinished = AutoGp(max_rows=60, n_jobs=1), tmp_path / "fit.unfinished"

    def model(learnt: AutoGp) -> str:
        learnt.save(tmp_path / "model.json")
        return without_time((tmp_path / "model.json").read_text())

    alone = model(learner.fit_files(*files, **options))
    counts: list[int] = []

    def two_at_most(function: Callable[[Any], bytes], items: list[Any]) -> Iterator[bytes]:
        counts.append(len(items))
        for at, item in enumerate(items):
            if at == 2:
                raise KeyboardInterrupt
            yield function(item)

    for _ in range(2):
        with pytest.raises(KeyboardInterrupt):
            learner.fit_files(*files, map=two_at_most, unfinished=unfinished, **options)
    with ThreadPool(2) as pool:

        def counted(function: Callable[[Any], bytes], items: list[Any]) -> Any:
            counts.append(len(items))
            return pool.imap(function, items)

        assert model(learner.fit_files(*files, map=counted, unfinished=unfinished, **options)) == alone
    assert counts == [counts[0], counts[0] - 2, counts[0] - 4] and not unfinished.exists()
    # A file with other contents stays unchanged.
    unfinished.write_text("notes")
    with pytest.raises(PolicyAlignError, match="something else"):
        learner.fit_files(*files, unfinished=unfinished, **options)
    assert unfinished.read_text() == "notes"
