"""Runs: Ctrl-C, time limits, progress, threads, forks, kept answers."""

import contextlib
import io
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import warnings

import pytest
from conftest import REPOSITORY, shaft_and_bore

import models
import sensitol as st

#: Points that take days: a run ends because it is interrupted.
DAYS = 2**40


@contextlib.contextmanager
def ctrl_c(after=0.5):
    """Ctrl-C after so many seconds."""
    timer = threading.Timer(after, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        yield
    finally:
        timer.cancel()


def interrupted(study, **how):
    with ctrl_c(), pytest.raises(KeyboardInterrupt):
        study.simulate(DAYS, **how)
    # The study works on.
    assert shaft_and_bore().analyze("rss")["clearance"].sigma > 0


@pytest.mark.parametrize("model", [None, models.clearance_vectorized, models.slow], ids=["formula", "numpy", "scalar"])
def test_ctrl_c_ends_a_run(model):
    interrupted(shaft_and_bore(model))


def test_ctrl_c_ends_a_run_of_a_program(tmp_path):
    (tmp_path / "gap.py").write_text(
        "import time\nfrom sensitol.adapter import adapter\n\n\n@adapter\ndef gap(a):\n    time.sleep(0.05)\n    return a\n\n\ngap.serve()\n"
    )
    (tmp_path / "gap.toml").write_text(
        "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ngap = {}\n"
        f'[model]\ncommand = ["{sys.executable}", "gap.py"]\n'
    )
    study = st.read(tmp_path / "gap.toml")
    with ctrl_c(1.0), pytest.raises(KeyboardInterrupt):
        study.simulate(10**6, cache=False)


def test_ctrl_c_in_a_model_has_the_model_s_frames():
    with ctrl_c(), pytest.raises(KeyboardInterrupt) as error:
        shaft_and_bore(models.slow).simulate(DAYS)
    assert "slow" in [frame.name for frame in error.traceback]


def test_what_is_known_at_ctrl_c():
    study = shaft_and_bore()
    with ctrl_c(1.0):
        found = study.simulate(DAYS, on_interrupt="partial")
    assert found.stopped == "interrupted"
    assert found["clearance"].met is None


def test_a_time_limit_ends_a_run():
    found = shaft_and_bore().simulate(DAYS, time=0.2)
    assert found.stopped == "time-limit"
    assert 0 < found.samples < DAYS


def test_a_time_limit_ends_a_run_of_a_slow_function_within_a_block():
    # A block of 4096 points would take 41 s.
    found = shaft_and_bore(models.slow).simulate(4096, time=1.0)
    assert found.stopped == "time-limit"
    assert 0 < found.samples < 1000


def test_progress_is_told():
    told = []
    shaft_and_bore(models.slow).analyze("full", progress=lambda points, expected: told.append((points, expected)))
    # 14 points of the method and the check points.
    assert told[-1][0] >= 14
    assert [points for points, _ in told] == sorted(points for points, _ in told)
    with contextlib.redirect_stderr(io.StringIO()):
        shaft_and_bore(models.slow).analyze("full", progress=True)
    with pytest.raises(TypeError, match="progress must be True or a callable of points and expected points, got str"):
        shaft_and_bore().analyze(progress="yes")

    def fails(points, expected):
        raise OSError("no bar")

    with pytest.raises(OSError, match="no bar"):
        shaft_and_bore(models.slow).analyze("full", progress=fails)


@pytest.mark.parametrize("model", [None, models.clearance])
def test_four_threads_at_once(model):
    study = shaft_and_bore(model)
    expected = study.simulate(20_000, seed=1)["clearance"].to_dict()
    found = [None] * 4

    def work(place):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found[place] = study.simulate(20_000, seed=1)["clearance"].to_dict()

    threads = [threading.Thread(target=work, args=(place,)) for place in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4


def in_child(queue, model):
    queue.put(shaft_and_bore(model).simulate(20_000, seed=1)["clearance"].mean)


@pytest.mark.parametrize("start", ["fork", "spawn", "forkserver"])
@pytest.mark.parametrize("model", [None, models.clearance])
def test_children_answer(start, model):
    if start not in multiprocessing.get_all_start_methods():
        pytest.skip(f"this system has no {start}")
    expected = shaft_and_bore(model).simulate(20_000, seed=1)["clearance"].mean
    context = multiprocessing.get_context(start)
    queue = context.Queue()
    child = context.Process(target=in_child, args=(queue, model))
    child.start()
    try:
        assert queue.get(timeout=60) == expected
        child.join(60)
        assert child.exitcode == 0
    finally:
        child.kill()


def test_answers_are_kept(tmp_path):
    calls = []

    def counted(bore, shaft, tilt):
        calls.append(bore)
        return models.plain(bore, shaft, tilt)

    study, cache = shaft_and_bore(counted), tmp_path / "answers.sqlite"
    one = study.analyze("full", cache=cache)
    first = len(calls)
    other = study.analyze("full", cache=cache)
    assert (first, len(calls)) == (one.evaluations, first)
    assert (other.evaluations, other.cached) == (0, one.evaluations + one.cached)
    assert other["clearance"].sigma == one["clearance"].sigma
    # Another version is another model.
    shaft_and_bore(st.model(version="2")(counted)).analyze("full", cache=cache)
    assert len(calls) == 2 * first


def test_what_an_interrupted_run_paid_for_is_kept(tmp_path):
    study, cache = shaft_and_bore(models.slow), tmp_path / "answers.sqlite"
    with ctrl_c(0.5), pytest.raises(KeyboardInterrupt):
        study.simulate(100_000, cache=cache)
    again = study.simulate(256, cache=cache, seed=1, time=60)
    assert again.samples == 256


def test_files_that_keep_no_answers(tmp_path):
    (tmp_path / "text").write_text("this is no database, whatever its name says, and it is long enough to be seen as none")
    study = shaft_and_bore(models.clearance)
    with pytest.raises(ValueError, match="text' cannot keep answers: file is not a database"):
        study.analyze(cache=tmp_path / "text")
    import sqlite3

    with sqlite3.connect(tmp_path / "other") as other:
        other.execute("CREATE TABLE mine (x)")
    other.close()
    with pytest.raises(ValueError, match="other' keeps something else than the answers of functions: name another file"):
        study.analyze(cache=tmp_path / "other")
    with pytest.raises(ValueError, match="cache must be a file for the answers of a function"):
        study.analyze(cache=True)


def test_the_command_is_in_the_package(tmp_path):
    command = [sys.executable, "-m", "sensitol._cli"]
    run = subprocess.run([*command, "--version"], capture_output=True, text=True)
    assert (run.returncode, run.stdout.split()[0]) == (0, "sensitol")
    assert run.stdout.split()[1] == st.__version__
    wrong = subprocess.run([*command, "analyze", str(tmp_path / "none.toml")], capture_output=True, text=True)
    assert wrong.returncode == 2
    assert "none.toml" in wrong.stderr


def test_ctrl_c_of_the_command_shows_what_is_known():
    study = os.path.join(REPOSITORY, "examples/shaft-and-bore/study.toml")
    command = [sys.executable, "-m", "sensitol._cli", "simulate", study, "--samples", str(DAYS)]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    timer = threading.Timer(1.0, child.send_signal, (signal.SIGINT,))
    timer.start()
    out, _ = child.communicate(timeout=60)
    assert child.returncode == 130
    assert "clearance" in out


def test_nothing_is_imported_before_it_is_used():
    code = "import sensitol, sys; print('numpy' in sys.modules, 'sensitol._core' in sys.modules, 'json' in sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["False", "False", "False"]


def test_a_count_may_be_written_with_an_exponent():
    study = shaft_and_bore()
    assert study.simulate(1e3, seed=1)["clearance"].mean == study.simulate(1000, seed=1)["clearance"].mean
