#!/usr/bin/env python3
"""Growth of time and memory with the amount of data: fits beside scikit-learn's Gaussian process, alignments beside dense_numpy.py.

usage: growth.py [--large] [--threads 1] [--seconds 120] [--gigabytes 8] [--only fit|align] [--most N] [--picture docs/pictures/growth.svg]

Needs Linux or macOS, `pip install numpy scipy scikit-learn`, and Rust: it builds the programs. Progress goes to standard error, tables in
Markdown to standard output. Each point runs in a separate process; if ours takes less than five seconds, the least of three runs counts. A
peer gets no more data once it has exceeded these CPU seconds or gigabytes. About 6 minutes, twice as long on a busy machine; with --large,
ten million samples, half as long again.

Fits: movements of 500 samples among wells in the plane, 5 % noise on velocities, in a CSV file. Ours is `policy-align fit` from start to
end, with cross-validation and trust page. scikit-learn's GaussianProcessRegressor (squared exponential with a length for each axis, white
noise, its own optimiser) is timed from reading the file to the end of the fit, without its imports. It learns the constrained
velocities directly; its last line is a fit to samples evenly chosen from the largest file. nUPE is the mean squared error with
respect to the unconstrained policy, over the variance of that policy, at 500 states.

Alignments: movements of 100 samples of the toy system, narrow bandwidth. Time is that of the alignment alone, memory that of the process.
Where both align the same movements, kept sets must be equal, and offsets must agree to within the rounding of the peer.

Limits of a fit (of an alignment): the time to read the file (the states) once at memory bandwidth, and the bytes of the numbers themselves,
which are time, states and velocities (states). Limits of the peers: the arithmetic of one Cholesky factor, n^3/3 operations (of all squared
distances, 2 d (100 K)^2), at the rate of a matrix product, and the bytes of one covariance per pair of samples, 8 n^2 (of one distance per
pair of a sample and a trajectory, 800 K^2). Rates are measured on one thread.
"""
import argparse, json, math, os, pathlib, platform, resource, signal, subprocess, sys, tempfile, time

ROOT = pathlib.Path(__file__).resolve().parents[2]
SAMPLES, FIT_DIMENSIONS = 500, 2
FITS = [1_000, 2_000, 4_000, 10_000, 30_000, 100_000, 300_000, 1_000_000]
LARGE = 10_000_000
ALIGN_SAMPLES, ALIGN_DIMENSIONS = 100, 2
ALIGNMENTS = [100, 300, 1_000, 3_000, 10_000, 30_000, 100_000]
# Shorter runs are repeated, and the least time counts.
SHORT, REPEATED = 5.0, 3


class Stopped(Exception):
    """A process failed; in a peer the usual reason is that it exceeded its limits."""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help=f"fit {LARGE:,} samples too")
    parser.add_argument("--threads", type=int, default=1, help="of every program (default 1)")
    parser.add_argument("--seconds", type=int, default=120, help="CPU seconds of a run of a peer (default 120)")
    parser.add_argument("--gigabytes", type=float, default=8.0, help="of a run of a peer (default 8)")
    parser.add_argument("--only", choices=("fit", "align"), help="half of it, without the picture")
    parser.add_argument("--most", type=int, default=LARGE, help="samples of a fit, and of an alignment")
    parser.add_argument("--picture", type=pathlib.Path, default=ROOT / "docs/pictures/growth.svg")
    options = parser.parse_args()
    if min(options.seconds, options.gigabytes, options.threads) <= 0:
        parser.error("--threads, --seconds and --gigabytes are above 0")
    fits = [n for n in FITS + [LARGE] * options.large if n <= options.most]
    alignments = [k for k in ALIGNMENTS if k * ALIGN_SAMPLES <= options.most]
    if not fits or not alignments:
        parser.error(f"--most is at least {max(FITS[0], ALIGNMENTS[0] * ALIGN_SAMPLES):,}")
    try:
        versions = child("versions")[0]
    except Stopped as error:
        sys.exit(f"{error}\nNothing was measured: pip install numpy scipy scikit-learn")
    programs = build()
    with_threads(1)
    rates = child("rates")[0]
    with_threads(options.threads)
    print(f"{processor()}, {os.cpu_count()} processors, load {os.getloadavg()[0]:.1f} at the start; threads: {options.threads}. {versions}. One thread multiplies matrices at "
          f"{rates['operations'] / 1e9:.0f} GFLOPS and reads memory at {rates['bytes'] / 1e9:.0f} GB/s.\n", flush=True)
    with tempfile.TemporaryDirectory(prefix="growth-") as folder:
        folder = pathlib.Path(folder)
        rows = []
        if options.only != "align":
            points = measure_fits(fits, programs, folder, options)
            print(table_of_fits(points, rates), flush=True)
            rows.append(panels_of_fits(points, rates))
        if options.only != "fit":
            points = measure_alignments(alignments, programs, folder, options)
            print(table_of_alignments(points, rates), flush=True)
            rows.append(panels_of_alignments(points, rates))
        if len(rows) == 2:
            drawn = folder / "points.json"
            drawn.write_text(json.dumps(rows))
            subprocess.run([programs / "growth_picture", drawn, options.picture], check=True)
            say(f"written: {options.picture}")


def say(text):
    print(text, file=sys.stderr, flush=True)


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines() if platform.system() == "Linux" else []
    names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.processor() or platform.machine())


def build():
    words = ["cargo", "build", "--release", "--locked", "-p", "policy-align", "-p", "benches", "--bins"]
    subprocess.run(words, cwd=ROOT, check=True, stdout=sys.stderr)
    return pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"


def with_threads(count):
    """Sets the number of threads of all processes started from now on."""
    for library in ("RAYON", "OPENBLAS", "OMP", "MKL"):
        os.environ[f"{library}_NUM_THREADS"] = str(count)


def run(words, codes=(0,)):
    """Standard output of a process, its CPU and elapsed seconds, and its peak memory in bytes. The memory of this process when it starts
    another counts as the other's, so this process does not import NumPy."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as errors:
        started = time.perf_counter()
        process = subprocess.Popen([str(word) for word in words], stdout=out, stderr=errors)
        try:
            _, status, used = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            raise
        elapsed = time.perf_counter() - started
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        errors.seek(0)
        if process.returncode == -signal.SIGXCPU:
            raise Stopped(f"more than {words[-2]} CPU s")
        if process.returncode not in codes:
            last = errors.read().decode(errors="replace").strip().splitlines()[-1:]
            raise Stopped("".join(last) or f"{words[0]}: exit code {process.returncode}")
        peak = used.ru_maxrss * (1 if platform.system() == "Darwin" else 1024)
        return out.read().decode(), {"cpu": used.ru_utime + used.ru_stime, "elapsed": elapsed, "memory": peak}


def child(*words):
    """Runs a function of CHILDREN in a separate process; returns its answer, and the time and memory of the process."""
    text, used = run([sys.executable, __file__, "--child", *words])
    return json.loads(text), used


def least(measure):
    """The answer of the first run, and the least time and memory over all runs; only short runs are repeated."""
    answer, best = measure()
    for _ in range(REPEATED - 1):
        if best["elapsed"] > SHORT:
            break
        _, again = measure()
        best = {name: min(value, again[name]) for name, value in best.items()}
    return answer, best


def tried(who, amount, measure):
    """A point of a peer, or the reason why there is none."""
    try:
        answer, used = measure()
        used.update({name: answer[name] for name in ("cpu", "elapsed", "error") if name in answer})
        say(f"  {who}, {amount:,}: {used['cpu']:.2f} CPU s, {used['memory'] / 1e6:.0f} MB")
        return answer, used
    except Stopped as reason:
        say(f"  {who}, {amount:,}: {reason}")
        return None, {"stopped": str(reason)}


# Fits

def measure_fits(counts, programs, folder, options):
    points, goes_on, mastered = [], True, 0
    recording, truth, model, predicted = (folder / name for name in ("recording.csv", "truth.csv", "model.json", "predicted.csv"))
    for n in counts:
        say(f"fit, {n:,} samples")
        run([programs / "noisy_file", n // SAMPLES, SAMPLES, recording, truth])
        fit = [programs / "policy-align", "fit", recording, "-o", model, "--json"]
        # Exit code 1 means "do not use", which is a valid answer.
        text, ours = least(lambda: run(fit, codes=(0, 1)))
        found = json.loads(text)
        run([programs / "policy-align", "predict", model, truth, "-o", predicted])
        ours["error"] = nupe(columns(truth, ("u1", "u2")), columns(predicted, ("u_x1", "u_x2")))
        ours["rows"] = next((decision["value"] for decision in found["decisions"] if decision["what"] == "rows"), f"{n}")
        ours["expected"] = found["trust"]["numbers"]["expected_error"]
        ours["verdict"] = found["trust"]["verdict"]
        say(f"  policy-align, {n:,}: {ours['cpu']:.2f} CPU s, {ours['memory'] / 1e6:.0f} MB")
        point = {"n": n, "bytes": recording.stat().st_size, "ours": ours}
        theirs = lambda count: child("fit", recording, truth, count, options.seconds, options.gigabytes)
        if goes_on:
            answer, point["peer"] = tried("scikit-learn", n, lambda: theirs(n))
            goes_on = answer is not None
            mastered = n if goes_on else mastered
        if n == counts[-1] and not goes_on and mastered:
            _, point["chosen"] = tried("scikit-learn", mastered, lambda: theirs(mastered))
            point["chosen"]["count"] = mastered
        points.append(point)
        recording.unlink()
    return points


def columns(path, names):
    header, *lines = path.read_text().split()
    places = [header.split(",").index(name) for name in names]
    return [[float(line.split(",")[place]) for place in places] for line in lines]


def nupe(wanted, learnt):
    mean = [sum(column) / len(wanted) for column in zip(*wanted)]
    squares = lambda pairs: sum((a - b) ** 2 for one, other in pairs for a, b in zip(one, other))
    return squares(zip(wanted, learnt)) / squares((action, mean) for action in wanted)


def table_of_fits(points, rates):
    lines = [*head("samples", "rows", "CPU s", "exponent", "elapsed s", "limit s", "peak MB", "limit MB", "nUPE", "expected", "trust")]
    for before, point in zip([None, *points], points):
        ours, n = point["ours"], point["n"]
        expected = "" if ours["expected"] is None else small(ours["expected"])
        lines.append(row(amount(n), f"{int(ours['rows']):,}", seconds(ours["cpu"]), exponent(before, point), seconds(ours["elapsed"]), small(point["bytes"] / rates["bytes"]),
                         megabytes(ours["memory"]), megabytes(fit_bytes(n)), small(ours["error"]), expected, ours["verdict"]))
    lines += ["", overall(points), "", *head("samples", "scikit-learn: CPU s", "over ours", "limit s", "peak MB", "limit MB", "nUPE", "ours")]
    for point, peer in with_peers(points):
        limits = small(cholesky(point["n"], rates)), megabytes(8 * point["n"] ** 2)
        lines.append(beside(point, peer, limits, [small(peer.get("error", 0)), small(point["ours"]["error"])]))
    chosen = points[-1].get("chosen", {})
    if "error" in chosen:
        among = f"{amount(chosen['count'])} of {amount(points[-1]['n'])}"
        lines.append(row(among, seconds(chosen["cpu"]), "", "", megabytes(chosen["memory"]), "", small(chosen["error"]), small(points[-1]["ours"]["error"])))
    return "\n".join([*lines, ""])


def cholesky(n, rates):
    return n ** 3 / 3 / rates["operations"]


def fit_bytes(n):
    return 8 * n * (1 + 2 * FIT_DIMENSIONS)


# Alignments

def measure_alignments(counts, programs, folder, options):
    points, goes_on, path = [], True, folder / "states"
    for k in counts:
        say(f"alignment, {k:,} movements")
        child("toy", k, path)
        text, used = least(lambda: aligned(run([programs / "align_file", path])))
        found = json.loads(text)
        point = {"n": k, "ours": used, "kept": len(found["kept"])}
        say(f"  policy-align, {k:,}: {used['cpu']:.2f} CPU s, {used['memory'] / 1e6:.0f} MB")
        if goes_on:
            measure = lambda: child("align", path, options.seconds, options.gigabytes)
            answer, point["peer"] = tried("NumPy", k, measure)
            goes_on = answer is not None
            if goes_on:
                point["peer"]["difference"] = compare(k, found, answer)
        points.append(point)
    return points


def aligned(answer):
    """The time of the alignment alone, as measured by the program."""
    text, used = answer
    found = json.loads(text)
    return text, {"cpu": found["cpu"], "elapsed": found["wall"], "memory": found["peak_megabytes"] * 2 ** 20 or used["memory"]}


def compare(k, ours, theirs):
    """The largest difference of offsets; exits if the results differ, as in compare_align.py."""
    difference = max((abs(a - b) for a, b in zip(ours["offsets"], theirs["offsets"])), default=0.0)
    if ours["kept"] != theirs["kept"]:
        sys.exit(f"{k} movements: other trajectories are kept: {len(ours['kept'])}, and {len(theirs['kept'])} by NumPy")
    if difference > 1e-12 + 1e-15 * theirs["values"] / ours["lambda_2"]:
        sys.exit(f"{k} movements: offsets differ by {difference:.1e}")
    return difference


def table_of_alignments(points, rates):
    lines = [*head("movements", "samples", "CPU s", "exponent", "elapsed s", "limit s", "peak MB", "limit MB", "kept")]
    for before, point in zip([None, *points], points):
        ours, k = point["ours"], point["n"]
        size = align_bytes(k)
        lines.append(row(amount(k), amount(k * ALIGN_SAMPLES), seconds(ours["cpu"]), exponent(before, point), seconds(ours["elapsed"]), small(size / rates["bytes"]),
                         megabytes(ours["memory"]), megabytes(size), f"{point['kept']:,}"))
    lines += ["", overall(points), "", *head("movements", "NumPy: CPU s", "over ours", "limit s", "peak MB", "limit MB", "offsets differ by")]
    for point, peer in with_peers(points):
        limits = small(distances(point["n"], rates)), megabytes(8 * ALIGN_SAMPLES * point["n"] ** 2)
        lines.append(beside(point, peer, limits, [small(peer.get("difference", 0))]))
    return "\n".join([*lines, ""])


def distances(k, rates):
    return 2 * ALIGN_DIMENSIONS * (k * ALIGN_SAMPLES) ** 2 / rates["operations"]


def align_bytes(k):
    return 8 * k * ALIGN_SAMPLES * ALIGN_DIMENSIONS


# Tables

def row(*cells):
    return "| " + " | ".join(cells) + " |"


def head(*names):
    return row(*names), "|" + "---|" * len(names)


def with_peers(points):
    return [(point, point["peer"]) for point in points if "peer" in point]


def beside(point, peer, limits, errors):
    """A line of the table for a peer, incomplete if the peer was stopped."""
    if "stopped" in peer:
        return row(amount(point["n"]), peer["stopped"], "", limits[0], "", limits[1], *[""] * len(errors))
    times = f"{peer['cpu'] / point['ours']['cpu']:.2g} ×" if peer["cpu"] < 100 * point["ours"]["cpu"] else f"{peer['cpu'] / point['ours']['cpu']:.0f} ×"
    return row(amount(point["n"]), seconds(peer["cpu"]), times, limits[0], megabytes(peer["memory"]), limits[1], *errors)


def small(value):
    """Two digits, in plain or scientific notation."""
    text = f"{value:.1e}"
    if 1e-2 <= value < 1e3:
        return f"{float(text):g}"
    return text.replace("e-0", "e-").replace("e+0", "e")


def amount(n):
    power = round(math.log10(n))
    return f"{n:,}" if n < 10_000 or n != 10 ** power else "10" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(power))


def seconds(value):
    return f"{value:.{max(0, 1 - math.floor(math.log10(max(value, 1e-4))))}f}"


def megabytes(size):
    return f"{size / 1e6:.3g}" if size < 1e8 else f"{size / 1e6:,.0f}"


def growth(before, point):
    return math.log(point["ours"]["cpu"] / before["ours"]["cpu"]) / math.log(point["n"] / before["n"])


def exponent(before, point):
    return "" if before is None else f"{growth(before, point):.2f}"


def overall(points):
    """The exponent from 10⁴ samples, or 1,000 movements, to the largest amount."""
    first = next((point for point in points if point["n"] >= (1_000 if "kept" in point else 10_000)), points[0])
    last = points[-1]
    return "" if first is last else f"CPU time grows as n^{growth(first, last):.2f} from {amount(first['n'])} to {amount(last['n'])}."


# Pictures

def panels_of_fits(points, rates):
    last, per_sample = points[-1]["n"], points[-1]["bytes"] / points[-1]["n"]
    return panels(points, ("Samples", "A fit", "scikit-learn"), (
        (lambda n: n * per_sample / rates["bytes"], "read the file once", lambda n: cholesky(n, rates), "one Cholesky factor"),
        (fit_bytes, "the numbers", lambda n: 8 * n * n, "one n × n matrix")))


def panels_of_alignments(points, rates):
    return panels(points, ("Movements of 100 samples", "An alignment", "dense NumPy"), (
        (lambda k: align_bytes(k) / rates["bytes"], "read the states once", lambda k: distances(k, rates), "all distances"),
        (align_bytes, "the states", lambda k: 8 * ALIGN_SAMPLES * k * k, "one distance a pair")))


def panels(points, words, limits):
    """Panels of time and memory. A limit is a function of the amount, with its name."""
    x_label, title, peer = words
    x = [10.0 ** math.floor(math.log10(points[0]["n"])), 1.3 * points[-1]["n"]]
    drawn = []
    for (name, unit, factor, what), (limit, limit_name, dense, dense_name) in zip((("cpu", "s", 1.0, "CPU time"), ("memory", "MB", 1e-6, "Peak memory")), limits):
        ours = [[point["n"], factor * point["ours"][name]] for point in points]
        theirs = [[point["n"], factor * point["peer"][name]] for point in points if "stopped" not in point.get("peer", {"stopped": ""})]
        # Straight lines, from edge to edge.
        ends = lambda of: [[n, factor * of(n)] for n in (x[0], points[-1]["n"])]
        values = [value for _, value in ours + theirs + ends(limit)]
        y = [10.0 ** math.floor(math.log10(min(values))), 10.0 ** math.ceil(math.log10(2 * max(values)))]
        # The name of the peer's limit is to the right of its line, where the line is high.
        steep = ends(dense)
        slope = math.log(steep[1][1] / steep[0][1]) / math.log(steep[1][0] / steep[0][0])
        high = 10 ** (math.log10(y[0]) + 0.86 * math.log10(y[1] / y[0]))
        along = x[0] * (high / steep[0][1]) ** (1 / slope)
        beside = along * (x[1] / x[0]) ** ((3.4 * len(dense_name) + 28) / 365)  # half the width of its letters, over that of the panel in pixels
        notes = [{"at": [beside, high], "text": dense_name}]
        notes += [{"at": theirs[-1], "text": peer}] if theirs else []
        drawn.append({
            "title": f"{title}: {what[0].lower() if what[1].islower() else what[0]}{what[1:]}", "x_label": x_label, "y_label": f"{what} ({unit})", "x": x, "y": y, "notes": notes,
            "curves": [{"role": "limit", "name": limit_name, "points": ends(limit)}, {"role": "peer_limit", "name": "", "points": steep},
                       {"role": "peer", "name": "", "points": theirs}, {"role": "ours", "name": "policy-align", "points": ours}]})
    return drawn


# Functions that run in separate processes

def child_versions():
    import numpy, scipy, sklearn
    return f"Python {platform.python_version()}, NumPy {numpy.__version__}, SciPy {scipy.__version__}, scikit-learn {sklearn.__version__}"


def child_rates():
    """Operations per CPU second of a matrix product, and bytes per CPU second of reading memory; the best of ten."""
    import numpy as np
    a = np.random.default_rng(0).standard_normal((1500, 1500))
    numbers = np.ones(2 ** 25)
    best = lambda of: min(timed(of) for _ in range(10))
    return {"operations": 2 * 1500 ** 3 / best(lambda: a @ a), "bytes": numbers.nbytes / best(numbers.max)}


def timed(of):
    before = time.process_time()
    of()
    return time.process_time() - before


def child_fit(recording, truth, count, *most):
    """Fits the peer to this number of samples of the recording, evenly chosen."""
    import numpy as np
    from sklearn.gaussian_process import GaussianProcessRegressor
    from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
    at_most(*most)
    started, before = time.perf_counter(), time.process_time()
    data = np.loadtxt(recording, delimiter=",", skiprows=1)
    data = data[np.linspace(0, len(data) - 1, int(count)).round().astype(int)]
    states, velocities = data[:, 2:2 + FIT_DIMENSIONS], data[:, 2 + FIT_DIMENSIONS:]
    kernel = ConstantKernel() * RBF(np.ones(FIT_DIMENSIONS)) + WhiteKernel(0.1)
    learnt = GaussianProcessRegressor(kernel, normalize_y=True).fit(states, velocities)
    used = {"cpu": time.process_time() - before, "elapsed": time.perf_counter() - started}
    known = np.loadtxt(truth, delimiter=",", skiprows=1)
    predicted = learnt.predict(known[:, :FIT_DIMENSIONS])
    return used | {"error": nupe(known[:, FIT_DIMENSIONS:].tolist(), predicted.tolist())}


def child_toy(count, path):
    import numpy as np
    from compare_align import toy
    states = toy(np.random.default_rng(1), int(count), ALIGN_SAMPLES, ALIGN_DIMENSIONS)
    pathlib.Path(path).write_bytes(f"{count} {ALIGN_SAMPLES} {ALIGN_DIMENSIONS} 1 narrow\n".encode() + states.astype("<f8").tobytes())


def child_align(path, *most):
    import numpy as np
    import dense_numpy
    at_most(*most)
    with open(path, "rb") as file:
        count, samples, dimensions = map(int, file.readline().split()[:3])
        states = np.frombuffer(file.read(), "<f8").reshape(count, samples, dimensions)
    found, used = dense_numpy.align(states, jobs=int(os.environ["OMP_NUM_THREADS"]))
    kept = np.flatnonzero(found["keep"])
    return {"cpu": used["cpu_total"], "elapsed": used["total"], "kept": kept.tolist(), "offsets": found["b_in"][kept].tolist(), "values": float(np.abs(found["a"]).max())}


def at_most(cpu_seconds, gigabytes):
    size, end = int(float(gigabytes) * 1e9), int(cpu_seconds)
    resource.setrlimit(resource.RLIMIT_DATA, (size, size))
    resource.setrlimit(resource.RLIMIT_CPU, (end, end + 5))


CHILDREN = {"versions": child_versions, "rates": child_rates, "fit": child_fit, "toy": child_toy, "align": child_align}


def begin(name, *words):
    try:
        print(json.dumps(CHILDREN[name](*words)))
    except MemoryError:
        sys.exit(f"more than {float(words[-1]):g} GB")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--child"]:
        begin(*sys.argv[2:])
    else:
        try:
            main()
        except Stopped as error:
            sys.exit(f"{error}\nThe measurement has stopped: there is no picture.")
