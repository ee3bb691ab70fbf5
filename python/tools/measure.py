"""Measures the installed package on this machine, and writes benches/python.md.

    pip install "./python[progress]" distributed && python python/tools/measure.py

Times are the shortest of several runs.
"""

from __future__ import annotations

import concurrent.futures
import math
import multiprocessing
import os
import platform
import signal
import subprocess
import sys
import threading
import time
import warnings
from typing import Any, Callable

import numpy as np

import sensitol as st

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
STUDY = os.path.join(REPOSITORY, "examples", "shaft-and-bore", "study.toml")
DAYS = 2**40


@st.model
def scalar(bore: float, shaft: float, tilt: float) -> float:
    return bore - shaft / math.cos(math.radians(tilt))


@st.model(vectorized=True)
def vectorized(bore: Any, shaft: Any, tilt: Any) -> Any:
    return bore - shaft / np.cos(np.deg2rad(tilt))


@st.model
def sleepy(bore: float, shaft: float, tilt: float) -> float:
    time.sleep(0.01)
    return bore - shaft / math.cos(math.radians(tilt))


@st.model
def minute(**x: float) -> float:
    time.sleep(0.05)
    return sum(value * value for value in x.values())


def study(model: Any = None) -> st.Study:
    return st.Study(
        dimensions={
            "bore": st.Dimension(25.020, 0.010),
            "shaft": st.Dimension(24.980, (-0.013, 0.0)),
            "tilt": st.Dimension(0.0, 1.5, distribution="uniform"),
        },
        characteristics={
            "clearance": st.Characteristic(None if model else "bore - shaft/cos(tilt*deg)", lower=0.02, upper=0.07)
        },
        model=model,
    )


def ten() -> st.Study:
    """Ten dimensions: `full` evaluates 111 points."""
    return st.Study(
        dimensions={f"x{n}": st.Dimension(n + 1.0, 0.1) for n in range(10)},
        characteristics={"y": st.Characteristic()},
        model=minute,
    )


def least(work: Callable[[], Any], runs: int = 5) -> float:
    best = math.inf
    for _ in range(runs):
        begun = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begun)
    return best


def process(*command: str) -> float:
    return least(lambda: subprocess.run(command, capture_output=True, check=True), 15)


def interrupted(one: st.Study) -> float:
    """From Ctrl-C to KeyboardInterrupt."""
    sent = [0.0]

    def send() -> None:
        sent[0] = time.perf_counter()
        os.kill(os.getpid(), signal.SIGINT)

    worst = 0.0
    for _ in range(5):
        timer = threading.Timer(0.4, send)
        timer.start()
        try:
            one.simulate(DAYS, cache=False)
        except KeyboardInterrupt:
            worst = max(worst, time.perf_counter() - sent[0])
    return worst


def main() -> None:
    warnings.simplefilter("ignore")
    python = sys.executable
    command = os.path.join(os.path.dirname(python), "sensitol")
    rows: list[tuple[str, str]] = []
    load = os.getloadavg()[0]

    def row(what: str, value: str) -> None:
        rows.append((what, value))
        print(what, value, flush=True)

    empty = process(python, "-c", "pass")
    imports = ["import sensitol", "import numpy", "import sensitol as st; st.Study"]
    times = [1e3 * (process(python, "-c", code) - empty) for code in imports]
    row("`import sensitol`, `import numpy`, and both with the first `st.Study`, beyond an empty Python", " / ".join(f"{t:.1f}" for t in times) + " ms")
    row("`sensitol --version` of the package, all of it", f"{1e3 * process(command, '--version'):.1f} ms")
    row("`sensitol analyze` of the shaft and bore", f"{1e3 * process(command, 'analyze', STUDY):.1f} ms")

    kinds = {"formula": study(), "NumPy function": study(vectorized), "scalar function": study(scalar)}
    for name, one in kinds.items():
        points = 2**17 if name == "scalar function" else 2**20
        ns = 1e9 * least(lambda: one.simulate(points, sampler="sobol"), 11) / points
        row(f"simulate {points} points of Sobol', {name}: a point, draws included", f"{ns:.0f} ns")
    for name, one in kinds.items():
        found = one.analyze("full", verify=0)
        took = least(lambda: one.analyze("full", verify=0), 50)
        row(f"analyze, {found.evaluations} evaluations, {name}", f"{1e3 * took:.2f} ms")
    result = study().analyze("full")
    row("its page as HTML", f"{1e3 * least(result.to_html, 20):.1f} ms, {len(result.to_html()) / 1e3:.0f} kB")

    slow = ten()
    expected = slow.analyze("full", verify=0)
    assert expected.evaluations == 111
    row("111 points of 50 ms: serial", f"{least(lambda: slow.analyze('full', verify=0), 1):.2f} s")

    def run(name: str, executor: Any) -> None:
        slow.analyze("full", verify=0, executor=executor)
        took = least(lambda: slow.analyze("full", verify=0, executor=executor), 3)
        assert slow.analyze("full", verify=0, executor=executor)["y"].sigma == expected["y"].sigma
        row(f"the same, {name}", f"{took:.2f} s")

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        run("8 threads", pool)
    with concurrent.futures.ProcessPoolExecutor(4, mp_context=multiprocessing.get_context("spawn")) as pool:
        run("4 processes", pool)
    try:
        import distributed
    except ImportError:
        row("the same, Dask", "skipped: not installed")
    else:
        with distributed.LocalCluster(n_workers=2, threads_per_worker=4, dashboard_address=None) as cluster:
            with distributed.Client(cluster) as client:
                run("Dask, 2 workers of 4 threads", client)

    program = os.path.join(REPOSITORY, "examples", "external-python", "study.toml")
    four = {"formula": study(), "NumPy function": study(vectorized), "scalar function of 10 ms": study(sleepy), "program": st.read(program)}
    for name, one in four.items():
        row(f"Ctrl-C to KeyboardInterrupt, {name}, the longest of five", f"{1e3 * interrupted(one):.0f} ms")

    core = sys.modules["sensitol._core"].__file__ or ""
    row("the engine's extension", f"{os.path.getsize(core) / 1e6:.1f} MB")
    page = [
        "# The Python package",
        "",
        f"`python/tools/measure.py` writes this page: {os.cpu_count()} cores, Python {platform.python_version()}, NumPy {np.__version__}, "
        f"sensitol {st.__version__} as a release wheel.",
        f"Times are the shortest of several runs, beside other work: the load average was {load:.1f} at the start.",
        "",
        "| what | value |",
        "|---|--:|",
        *(f"| {what} | {value} |" for what, value in rows),
        "",
    ]
    with open(os.path.join(REPOSITORY, "benches", "python.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(page))


if __name__ == "__main__":
    main()
