"""adapters/dask: the same bits as without it, on workers of this machine and of a Slurm, and nothing lost when parts of it are killed."""

import contextlib
import csv
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time

import slurm
from harness import EXAMPLES, ROOT, Client, binary, client, failed, refused, report, run, sensitol, shown

ADAPTER = ROOT / "adapters/dask/sensitol_dask.py"
DIMENSIONS = {"a": 10.0, "b": 30.0, "c": 2.0}
# Everything is to be gone 15 s after a run, the linger of a cluster included.
GONE_S = 15
# All tests take six minutes on a busy machine; one that hangs must not take the time of the rest of the gate.
MOST_S = 900

MODEL = f"""
import os, sys, time
sys.path.insert(0, {str(ROOT / "adapters/python")!r})
from sensitol_adapter import NoValue, adapter

SLEEP = float(os.environ.get("MODEL_SLEEP", "0"))

@adapter(version="1", outputs=["gap", "area"])
def model(a, b, c):
    with open("asked.log", "a") as log:
        log.write(f"{{a!r}} {{b!r}} {{c!r}}\\n")
    if a > 900:
        os._exit(7)
    if a > 800:
        time.sleep(1000)
    if a < 0:
        raise NoValue("a is negative")
    time.sleep(SLEEP)
    # Powers and a root have many digits: the same bits are no accident.
    return {{"gap": (a ** 3 / b) ** 0.5 - c, "area": a * b / c}}

if __name__ == "__main__":
    model.serve()
"""


def closed(a, b, c):
    return [(a**3 / b) ** 0.5 - c, a * b / c]


def command(cluster, *model, options=()):
    return [sys.executable, str(ADAPTER), "--cluster", cluster, *map(str, options), "--", *(model or ("python3", "model.py"))]


@contextlib.contextmanager
def study(cluster=None, *model, options=(), keys=""):
    """A folder with the model and a study of it, on this cluster or as a plain program."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "model.py").write_text(MODEL)
        argv = command(cluster, *model, options=options) if cluster else ["python3", "model.py"]
        (path / "study.toml").write_text(
            f"[model]\ncommand = {json.dumps(argv)}\nstart_timeout_s = 120\n{keys}\n[dimensions]\n"
            + "".join(f"{name} = {{ nominal = {value}, tolerance = {0.05 * value} }}\n" for name, value in DIMENSIONS.items())
            + '[characteristics]\ngap = { lower = 2.5 }\narea = { lower = 100.0 }\n'
        )
        yield path / "study.toml"


def points(path):
    """The rows of a journal, in an order of their own, with every digit."""
    rows = csv.reader(io.StringIO(sensitol("journal", "export", path)[0]))
    return sorted(map(tuple, rows))


def processes(*words):
    """The running processes whose command lines have all of these words."""
    found = {}
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            line = (folder / "cmdline").read_bytes().replace(b"\0", b" ").decode("utf-8", "replace")
            dead = (folder / "stat").read_text().rpartition(")")[2].split()[0] == "Z"
        except OSError:
            continue
        if all(word in line for word in words) and not dead:
            found[int(folder.name)] = line
    return found


def parent(pid):
    return int(pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])


def family(root):
    """A process and all that descend from it."""
    members, grown = {root}, True
    while grown:
        grown = False
        for folder in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if parent(int(folder.name)) in members and int(folder.name) not in members:
                    members.add(int(folder.name))
                    grown = True
            except OSError:
                continue
    return members


def until(ready, what, seconds=60):
    begun = time.monotonic()
    while not ready():
        assert time.monotonic() - begun < seconds, what() if callable(what) else f"{what} after {seconds} s"
        time.sleep(0.1)


def here(folder):
    """The processes that work in this folder: programs of the model, and the keeper of its cluster by its parentage."""
    found = set()
    for entry in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            if os.readlink(entry / "cwd") == str(folder) and int(entry.name) != os.getpid():
                if (entry / "stat").read_text().rpartition(")")[2].split()[0] != "Z":
                    found.add(int(entry.name))
        except OSError:
            continue
    return found


def hello(names=("gap", "area")):
    return {"units": [None] * 3, "nominal": DIMENSIONS, "characteristics": list(names)}


def final(model, wanted):
    """The last answers to so many points, by their number."""
    found = {}
    while len(found) < wanted:
        line = model.process.stdout.readline()
        assert line, model.process.stderr.read()
        line = json.loads(line)
        if "y" in line or "error" in line:
            assert line["id"] not in found, line
            found[line["id"]] = line
    return found


def send(model, rows):
    text = "".join(json.dumps({"id": index, "x": list(row)}) + "\n" for index, row in enumerate(rows))
    model.process.stdin.write(text)
    model.process.stdin.flush()


@contextlib.contextmanager
def asked(cluster, *model, options=(), names=("gap", "area"), env=None):
    """The adapter without the engine."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "model.py").write_text(MODEL)
        with client(command(cluster, *model, options=options), folder, env=env, **hello(names)) as found:
            found.folder = pathlib.Path(folder)
            yield found


def spread(count):
    """Points around the nominal one."""
    return [(10.0 + 0.001 * k, 30.0 - 0.002 * k, 2.0 + 0.0005 * k) for k in range(count)]


def the_bits_are_those_without_it():
    kept = []
    for cluster in (None, "local:2"):
        with study(cluster) as path:
            if cluster:
                sensitol("probe", path)
            sensitol("simulate", path, "--samples", "400", "--journal", path.parent / "kept.sqlite")
            kept.append(points(path.parent / "kept.sqlite"))
            found = report("analyze", path, "--method", "full", "--journal", "none")[0]
            kept.append(found["characteristics"])
    assert len(kept[0]) > 400 and kept[0] == kept[2], "other values in the journal"
    assert kept[1] == kept[3], "another report"


def a_function_goes_by_its_name():
    source = "def product(a, b, c):\n    return {'gap': a * b - c, 'area': a / b}\n"
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "parts.py").write_text(source)
        with client(command("local:1x2", "parts:product"), folder, **hello()) as model:
            assert model.ready["name"] == "parts:product" and "modules " in model.ready["version"], model.ready
            rows = spread(200)
            send(model, rows)
            for index, answer in final(model, len(rows)).items():
                a, b, c = rows[index]
                assert answer["y"] == [a * b - c, a / b], answer
        for name, words in [("parts:quotient", ["quotient"]), ("nothing:product", ["nothing"])]:
            with client(command("local:1", name), folder, **hello()) as model:
                refused(model, *words)


def points_that_kill_the_model_are_errors_of_their_own():
    rows = spread(60)
    deadly, negative = {7, 8, 30, 59}, {11, 44}
    rows = [(901.0, *row[1:]) if k in deadly else (-1.0, *row[1:]) if k in negative else row for k, row in enumerate(rows)]
    with asked("local:2") as model:
        send(model, rows)
        answers = final(model, len(rows))
        for index, answer in answers.items():
            if index in deadly:
                failed(answer, "ended with code 7", "worker ")
                assert answer["retry"], answer
            elif index in negative:
                failed(answer, "a is negative")
            else:
                assert answer["y"] == closed(*rows[index]), answer
                assert answer["where"] and answer["cost_s"] >= 0, answer


def a_point_that_hangs_is_taken_back():
    with asked("local:1") as model:
        send(model, [(801.0, 30.0, 2.0)])
        until_started = None
        while until_started is None:
            line = json.loads(model.process.stdout.readline())
            until_started = line.get("started")
        model.process.stdin.write('{"cancel":[0]}\n{"id":5,"x":[10.0,30.0,2.0]}\n')
        model.process.stdin.flush()
        assert final(model, 1)[5]["y"] == closed(10.0, 30.0, 2.0)
    # In the engine it is an error of that point, after its time: 1.73 sigma above 500 is 846.
    with study("local:1", keys='timeout_s = 2\nretries = 0\nverify = 0') as path:
        text = path.read_text().replace("a = { nominal = 10.0, tolerance = 0.5 }", "a = { nominal = 500.0, tolerance = 600.0 }")
        path.write_text(text)
        found = report("analyze", path, "--method", "rss", "--characteristic", "area", "--journal", "none", "--verify", "0")[0]
        assert found["failed"] == 1, found["failed"]


@contextlib.contextmanager
def scheduler(port):
    process = start("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show")
    try:
        yield process
    finally:
        end(process)


def start(*arguments, env=None):
    return subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_" + arguments[0], *arguments[1:]],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, env=env,
    )  # fmt: skip


def worker(port):
    arguments = ["--nworkers", "1", "--nthreads", "1", "--no-dashboard", "--memory-limit", "0", "--death-timeout", "60"]
    return start("worker", f"tcp://127.0.0.1:{port}", *arguments, env={**os.environ, "MODEL_SLEEP": "0.05"})


def end(process):
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def evaluated(path):
    return (path.parent / "asked.log").read_text().splitlines() if (path.parent / "asked.log").exists() else []


def simulated(path, disturb, samples=300):
    """The journal of a simulation during which `disturb` happens, after some points were evaluated."""
    kept = path.parent / "kept.sqlite"
    command = [binary(), "simulate", str(path), "--samples", str(samples), "--journal", str(kept)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    watched = threading.Thread(target=lambda: setattr(process, "said", process.communicate()))
    watched.start()
    until(lambda: len(evaluated(path)) > 40 or not watched.is_alive(), "some points are evaluated", 120)
    disturb()
    watched.join(180)
    assert process.returncode == 0, process.said
    return points(kept)


def plain(samples=300):
    with study() as path:
        sensitol("simulate", path, "--samples", samples, "--journal", path.parent / "kept.sqlite")
        return points(path.parent / "kept.sqlite")


def nothing_is_lost_with_a_worker_its_nanny_or_the_scheduler():
    right = plain()
    port = slurm.ports(1)[0]
    held = {"scheduler": start("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show")}
    held.update({name: worker(port) for name in ("one", "two")})

    def kill_worker():
        # The nanny starts another one.
        children = family(held["one"].pid) - {held["one"].pid}
        for pid in children:
            if processes("spawn_main").get(pid):
                os.kill(pid, signal.SIGKILL)

    def kill_with_nanny():
        end(held["two"])

    def restart_scheduler():
        end(held["scheduler"])
        for name in ("one", "two"):
            end(held[name])
        held["scheduler"] = start("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show")
        held.update({name: worker(port) for name in ("one", "two")})

    try:
        for disturb in (kill_worker, kill_with_nanny, restart_scheduler):
            with study(f"tcp://127.0.0.1:{port}", options=["--batch", "1"], keys="verify = 0") as path:
                begun = time.monotonic()
                found = simulated(path, disturb)
                print(f"        {disturb.__name__}: {time.monotonic() - begun:.1f} s, {len(evaluated(path)) - len(set(evaluated(path)))} twice", flush=True)
                assert found == right, f"{disturb.__name__}: other values"
                # The nominal point is asked again at the end; beside it, what two threads had under way.
                twice = len(evaluated(path)) - len(set(evaluated(path)))
                assert twice <= 8, f"{disturb.__name__}: {twice} points twice"
    finally:
        for process in held.values():
            end(process)


def without_a_scheduler_it_gives_up():
    port = slurm.ports(1)[0]
    with asked(f"tcp://127.0.0.1:{port}") as model:
        refused(model, str(port))


def a_program_that_a_killed_adapter_left_is_ended():
    """One worker, whose only program hangs; its adapter is killed. The next adapter has the worker all the same."""
    port = slurm.ports(1)[0]
    held = [start("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show"), worker(port)]
    try:
        with asked(f"tcp://127.0.0.1:{port}") as model:
            send(model, [(801.0, 30.0, 2.0)])
            while "started" not in json.loads(model.process.stdout.readline()):
                pass
            model.process.kill()
        with asked(f"tcp://127.0.0.1:{port}") as model:
            rows = spread(3)
            send(model, rows)
            assert [answer["y"] for _, answer in sorted(final(model, 3).items())] == [closed(*row) for row in rows]
    finally:
        for process in held:
            end(process)


def nothing_stays_behind():
    """After kill -9, the first Ctrl-C, a limit of time and a normal end: no program, worker or keeper is left."""
    for how in ("kill", "interrupt", "time", "end"):
        with study("local:2", keys="verify = 0") as path:
            arguments = [binary(), "simulate", str(path), "--samples", "60" if how == "end" else "5000", "--journal", "none"]
            arguments += ["--time", "8"] if how == "time" else []
            process = subprocess.Popen(
                arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "MODEL_SLEEP": "0.05"},
            )  # fmt: skip
            until(lambda: len(evaluated(path)) > 20 or process.poll() is not None, "some points are evaluated", 120)
            started = here(path.parent)
            assert started, "nobody works in the study's folder"
            if how == "kill":
                process.kill()
            elif how == "interrupt":
                process.send_signal(signal.SIGINT)
            process.wait(timeout=60)
            until(lambda: not here(path.parent), lambda: f"{how}: {[processes()[pid] for pid in here(path.parent)]} are left", GONE_S)


def what_is_wrong_is_one_error():
    with tempfile.TemporaryDirectory() as folder:
        broken = pathlib.Path(folder) / "broken.yaml"
        broken.write_text("jobs: [1\n")
        unknown = pathlib.Path(folder) / "unknown.yaml"
        unknown.write_text("jbos: 1\n")
        wrong = {"all.yaml": "adapt: all\n", "more.yaml": "adapt: { minimum: 3, maximum: 2 }\n", "least.yaml": "adapt: { least: 1 }\n", "none.yaml": "jobs: 0\n",
                 "open.yaml": "security: no\n", "odd.yaml": "security: { tls_ca: ca.pem }\n", "gone.yaml": "security: { tls_ca_file: ca.pem }\n"}  # fmt: skip
        for name, text in wrong.items():
            (pathlib.Path(folder) / name).write_text(text)
        cases = [
            (command("cloud"), ["--cluster cloud", "local:4"]),
            (command("local:many"), ["local:many"]),
            (command("local:0"), ["at least one worker"]),
            ([sys.executable, str(ADAPTER), "--cluster", "local:1"], ["there is no model"]),
            (command("local:1", options=["--colour", "red"]), ["--colour"]),
            (command("local:1", options=["--batch", "0"]), ["--batch"]),
            (command("local:1", "no-such-program"), ["no-such-program", "cannot be started"]),
            (command("tcp://nowhere"), ["tcp://nowhere"]),
        ]
        if slurm.installed():
            cases += [
                (command("slurm", options=["--options", broken]), ["broken.yaml"]),
                (command("slurm", options=["--options", unknown]), ["`jbos`", "jobs"]),
                (command("slurm", options=["--options", "all.yaml"]), ["`adapt`", "{ minimum: 0, maximum: 8 }"]),
                (command("slurm", options=["--options", "more.yaml"]), ["`adapt`", "minimum 3", "maximum 2"]),
                (command("slurm", options=["--options", "least.yaml"]), ["`adapt`", "{ minimum: 0, maximum: 8 }"]),
                (command("slurm", options=["--options", "none.yaml"]), ["`jobs`", "1 or more", "0"]),
                (command("slurm", options=["--options", "open.yaml"]), ["`security`", "`true`", "tls_ca_file", "False"]),
                (command("slurm", options=["--options", "odd.yaml"]), ["`security` has no `tls_ca`", "tls_ca_file"]),
                (command("slurm", options=["--options", "gone.yaml"]), ["there is no file 'ca.pem'", "`tls_ca_file`"]),
            ]
        for argv, words in cases:
            with client(argv, folder, **hello()) as model:
                refused(model, *words)
    with asked("local:1", names=["twist"]) as model:
        refused(model, "`twist`", "gap")


def keepers_have_a_folder_of_their_own():
    """A folder in which another user may write is not believed: a keeper's words in it could be anybody's."""
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as elsewhere:
        place = pathlib.Path(folder) / f"sensitol-dask-{os.getuid()}"
        place.mkdir()
        place.chmod(0o777)
        with asked("local:1", env={"TMPDIR": folder}) as model:
            refused(model, str(place), "open to other users", "TMPDIR")
        place.rmdir()
        place.symlink_to(elsewhere)
        with asked("local:1", env={"TMPDIR": folder}) as model:
            refused(model, str(place), "is no folder")
        place.unlink()
        with asked("local:1", env={"TMPDIR": folder}) as model:
            send(model, [(10.0, 30.0, 2.0)])
            assert final(model, 1)[0]["y"] == closed(10.0, 30.0, 2.0)
            assert place.stat().st_mode & 0o777 == 0o700


SLURM_OPTIONS = "jobs: 2\ncores: 1\nprocesses: 1\nmemory: 500MB\nwalltime: '00:20:00'\ninterface: lo\n"


@contextlib.contextmanager
def on_slurm(environment, keys="verify = 0"):
    with study("slurm", options=["--options", "slurm.yaml", "--batch", "1"], keys=keys) as path:
        (path.parent / "slurm.yaml").write_text(SLURM_OPTIONS)
        os.environ.update(SLURM_CONF=environment["SLURM_CONF"], MODEL_SLEEP="0.05")
        try:
            yield path
        finally:
            del os.environ["SLURM_CONF"], os.environ["MODEL_SLEEP"]


def same_bits(environment, right, cancelled, samples=300):
    """A simulation on two jobs, of which one is cancelled half-way or none, has these values and leaves no job."""
    queued = lambda: slurm.jobs(environment)

    def disturb():
        if cancelled:
            subprocess.run(["scancel", queued()[0][0]], env=environment, check=True)

    with on_slurm(environment) as path:
        begun = time.monotonic()
        assert simulated(path, disturb, samples) == right, f"{'one cancelled' if cancelled else 'none cancelled'}: other values"
        print(f"        {'one job' if cancelled else 'no job'} cancelled: {time.monotonic() - begun:.1f} s", flush=True)
    until(lambda: not queued(), lambda: f"{queued()} are left in the queue", GONE_S)


def none_left(environment, how):
    """No job is left after the engine was killed, interrupted or out of time, and no process that works in the study's folder."""
    with on_slurm(environment) as path:
        arguments = [binary(), "simulate", str(path), "--samples", "5000", "--journal", "none"]
        arguments += ["--time", "10"] if how == "time" else []
        process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until(lambda: len(evaluated(path)) > 20 or process.poll() is not None, "some points are evaluated", 120)
        if how == "kill":
            process.kill()
        elif how == "interrupt":
            process.send_signal(signal.SIGINT)
        process.wait(timeout=60)
        until(lambda: not slurm.jobs(environment), lambda: f"{how}: {slurm.jobs(environment)}", GONE_S)
        until(lambda: not here(path.parent), lambda: f"{how}: {here(path.parent)} are left", GONE_S)


def slurm_starts():
    """Whether its daemons come up here: in a container of the gate they may not."""
    try:
        with slurm.running():
            return True
    except slurm.DoesNotStart as why:
        print(f"  skipped: Slurm does not start here: {why}", flush=True)
        return False


def jobs_of_slurm_have_the_same_bits():
    right = plain()
    with slurm.running() as environment:
        queued = lambda: slurm.jobs(environment)
        for cancelled in (False, True):
            same_bits(environment, right, cancelled)
        with on_slurm(environment) as path:
            (path.parent / "slurm.yaml").write_text(SLURM_OPTIONS + "queue: nowhere\n")
            _, errors = sensitol("analyze", path, "--journal", "none", code=2)
            assert "nowhere" in errors or "invalid partition" in errors, errors
        with on_slurm(environment) as path:
            # Scheduler, workers and client speak TLS alone, and the keys are gone afterwards.
            (path.parent / "slurm.yaml").write_text(SLURM_OPTIONS + "security: true\n")
            sensitol("analyze", path, "--journal", "none")
            left = pathlib.Path.home() / ".sensitol-dask"
            until(lambda: not any(left.iterdir()), "the keys of workers are removed", GONE_S)
        with on_slurm(environment) as path, tempfile.TemporaryDirectory() as folder:
            # Both nodes answer, and say so.
            pathlib.Path(folder, "model.py").write_text(MODEL)
            pathlib.Path(folder, "slurm.yaml").write_text(SLURM_OPTIONS)
            argv = command("slurm", options=["--options", "slurm.yaml", "--batch", "1", "--linger", "1"])
            with client(argv, folder, **hello()) as model:
                until(lambda: [job[2] for job in queued()] == ["R", "R"], "both jobs run", 60)
                time.sleep(3)
                send(model, spread(100))
                where = {answer["where"] for answer in final(model, 100).values()}
            assert where == {"n1/1", "n2/1"}, where
            until(lambda: not queued(), lambda: f"{queued()} are left in the queue", GONE_S)


def jobs_come_and_go_with_the_work():
    """With `adapt`: as many jobs as are allowed while points wait, the least again once all are answered, and new ones for new points."""
    with slurm.running() as environment:
        for least in (1, 0):
            with on_slurm(environment) as path, tempfile.TemporaryDirectory() as folder:
                os.environ["MODEL_SLEEP"] = "0.5"
                pathlib.Path(folder, "model.py").write_text(MODEL)
                options = SLURM_OPTIONS.replace("jobs: 2\n", f"adapt: {{ minimum: {least}, maximum: 2 }}\n")
                pathlib.Path(folder, "slurm.yaml").write_text(options)
                argv = command("slurm", options=["--options", "slurm.yaml", "--batch", "1", "--linger", "1"])
                running = lambda: [job[2] for job in slurm.jobs(environment)]

                def become(count):
                    until(lambda: running() == count * ["R"], lambda: f"{count} jobs are expected, not {running()}", 60)

                with client(argv, folder, **hello()) as model:
                    for _ in range(2):
                        send(model, spread(100))
                        become(2)
                        assert len(final(model, 100)) == 100
                        # Dask looks three times, a second each, before it ends a worker without work.
                        become(least)
                until(lambda: not slurm.jobs(environment), lambda: f"{slurm.jobs(environment)} are left in the queue", GONE_S)


def no_job_stays_behind():
    with slurm.running() as environment:
        for how in ("kill", "interrupt", "time"):
            none_left(environment, how)


def the_readme_shows_it():
    shown("stacked-blocks-dask")


if __name__ == "__main__":
    tests = [
        the_bits_are_those_without_it,
        a_function_goes_by_its_name,
        points_that_kill_the_model_are_errors_of_their_own,
        a_point_that_hangs_is_taken_back,
        nothing_is_lost_with_a_worker_its_nanny_or_the_scheduler,
        a_program_that_a_killed_adapter_left_is_ended,
        without_a_scheduler_it_gives_up,
        what_is_wrong_is_one_error,
        keepers_have_a_folder_of_their_own,
        nothing_stays_behind,
        the_readme_shows_it,
    ]
    with_slurm = [jobs_of_slurm_have_the_same_bits, jobs_come_and_go_with_the_work, no_job_stays_behind]
    if sys.argv[1:]:
        tests = [test for test in [*tests, *with_slurm] if test.__name__ in sys.argv[1:]]
    else:
        signal.signal(signal.SIGALRM, lambda *_: sys.exit(f"the tests of Dask and Slurm took longer than {MOST_S // 60} minutes"))
        signal.alarm(MOST_S)
        if slurm.installed():
            tests += with_slurm if slurm_starts() else []
        else:
            print("  skipped: Slurm; install with: apt-get install --no-install-recommends slurm-wlm munge, and be root")
            if "slurm" in os.environ.get("SENSITOL_ADAPTERS_REQUIRED", "").split():
                sys.exit("slurm is required here")
    run(tests)
