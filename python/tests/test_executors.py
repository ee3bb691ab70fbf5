"""Points sent to executors."""

import concurrent.futures
import multiprocessing
import os
import signal
import threading
import time

import pytest
from conftest import shaft_and_bore

import models
import sensitol as st
from test_running import ctrl_c


def digits(result):
    one = result["clearance"]
    return one.mean, one.sigma, one.skewness, one.kurtosis


SPAWN = multiprocessing.get_context("spawn")


@pytest.mark.parametrize("chunksize", ["auto", 1, 5])
@pytest.mark.parametrize("model", [models.clearance, models.clearance_vectorized])
def test_threads_have_the_same_digits(model, chunksize):
    study = shaft_and_bore(model)
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        assert digits(study.analyze("full", executor=pool, chunksize=chunksize)) == digits(study.analyze("full"))


@pytest.mark.parametrize("model", [models.clearance, models.clearance_vectorized, models.plain])
def test_processes_have_the_same_digits(model):
    study = shaft_and_bore(model)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=SPAWN) as pool:
        assert digits(study.analyze("full", executor=pool)) == digits(study.analyze("full"))
        assert study.simulate(9000, executor=pool, seed=1)["clearance"].mean == study.simulate(9000, seed=1)["clearance"].mean


def test_points_are_side_by_side():
    barrier = threading.Barrier(4, timeout=30)

    def together(bore, shaft, tilt):
        # The nominal point comes alone, and the others in tasks of one.
        if (bore, tilt) != (25.020, 0.0):
            barrier.wait()
        return bore - shaft + tilt

    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        # rss: two points of each dimension beside the means; tilt's own and bore's are four.
        study = st.Study(
            dimensions={"bore": st.Dimension(25.02, 0.01), "tilt": st.Dimension(0, 1), "shaft": st.Dimension(25)},
            characteristics={"gap": st.Characteristic()},
            model=together,
        )
        assert study.analyze("rss", executor=pool, chunksize=1, verify=0)["gap"].mean == pytest.approx(0.02)


def test_exceptions_come_back_and_nothing_goes_on():
    started, release = [], threading.Event()

    def raising(bore, shaft, tilt):
        started.append(bore)
        if len(started) > 1:
            release.wait(30)
        raise LookupError("no such part")

    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        with pytest.raises(LookupError, match="no such part"):
            shaft_and_bore(raising).simulate(4096, executor=pool, chunksize=1)
        release.set()
    # The one that raised, and the one that was begun by then.
    assert len(started) <= 2
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=SPAWN) as pool, pytest.raises(LookupError):
        shaft_and_bore(models.raising).analyze(executor=pool)


def test_a_pool_that_broke_is_a_failure_of_the_run():
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=SPAWN) as pool:
        with pytest.raises(concurrent.futures.process.BrokenProcessPool):
            shaft_and_bore(models.dying).analyze(executor=pool)


def test_functions_that_cannot_be_sent():
    with concurrent.futures.ProcessPoolExecutor(1, mp_context=SPAWN) as pool:
        with pytest.raises(TypeError, match=r"<lambda>\(\) cannot be sent to another process .* use an executor of loky or Dask"):
            shaft_and_bore(lambda bore, shaft, tilt: bore).analyze(executor=pool)
    with concurrent.futures.ThreadPoolExecutor(1) as pool:
        with pytest.raises(TypeError, match="executor is for models that are functions of Python, and this study has none"):
            shaft_and_bore().analyze(executor=pool)


def test_ctrl_c_cancels_what_waits():
    started = []

    def counted(bore, shaft, tilt):
        started.append(bore)
        return models.slow(bore, shaft, tilt)

    with concurrent.futures.ThreadPoolExecutor(2) as pool, ctrl_c(), pytest.raises(KeyboardInterrupt):
        shaft_and_bore(counted).simulate(100_000, executor=pool, chunksize=1)
    # The pool was left with nothing to do: of the first portion of 4096 points most were never begun.
    assert 0 < len(started) < 2000


def test_kept_answers_go_with_an_executor(tmp_path):
    study, cache = shaft_and_bore(models.clearance), tmp_path / "answers.sqlite"
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        one = study.analyze("full", executor=pool, cache=cache)
    # A check point at the end of a bounded dimension may be that of another one, and is evaluated once.
    assert study.analyze("full", cache=cache).cached == one.evaluations + one.cached


def test_loky_sends_functions_by_value():
    loky = pytest.importorskip("loky", reason="skipped: loky is not installed; install with: pip install loky")
    with loky.ProcessPoolExecutor(2) as pool:
        study = shaft_and_bore(lambda bore, shaft, tilt: bore - shaft + 0 * tilt)
        assert digits(study.analyze("full", executor=pool)) == digits(study.analyze("full"))


def test_dask_has_the_same_digits():
    distributed = pytest.importorskip(
        "distributed", reason="skipped: Dask is not installed; install with: pip install distributed"
    )
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        study = shaft_and_bore(lambda bore, shaft, tilt: bore - shaft + 0 * tilt)
        assert digits(study.analyze("full", executor=client)) == digits(study.analyze("full"))


@pytest.mark.skipif(os.name == "nt", reason="skipped: signals of Unix")
def test_a_killed_worker_of_dask_loses_nothing():
    distributed = pytest.importorskip(
        "distributed", reason="skipped: Dask is not installed; install with: pip install distributed"
    )

    def slow(bore, shaft, tilt):
        time.sleep(0.05)
        return bore - shaft + 0 * tilt

    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None)
    with cluster, distributed.Client(cluster) as client:
        workers = list(client.run(os.getpid).values())
        killed = threading.Timer(1.0, os.kill, (workers[0], signal.SIGKILL))
        killed.start()
        # 5 s on one worker, 2.5 s on two.
        found = shaft_and_bore(slow).simulate(100, executor=client, chunksize=1, seed=1)
        killed.join()
        assert workers[0] not in client.run(os.getpid).values()
    assert found["clearance"].mean == shaft_and_bore(lambda bore, shaft, tilt: bore - shaft + 0 * tilt).simulate(100, seed=1)["clearance"].mean
