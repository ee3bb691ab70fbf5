"""Hands the points of a study to Dask: `sensitol-dask --cluster local:4 -- python3 model.py`, see README.md."""

import argparse
import collections
import contextlib
import fcntl
import hashlib
import json
import math
import os
import pathlib
import queue
import stat
import subprocess
import sys
import tempfile
import threading
import time
import uuid

VERSION = "1"
HERE = pathlib.Path(__file__).resolve().parent
WORKER = "sensitol_dask_worker"
# Tasks under way for each thread: one that runs, one that waits at the worker, one that is on its way.
AHEAD = 3
# Points of a task take this time together, and are no more than this.
TASK_S, LONGEST = 0.1, 64
# A task of several points that runs longer than this is taken apart: one of its points may hang.
STUCK_S, STUCK_TIMES = 10.0, 30.0
# A sign of life comes at least four times in the shortest timeout that makes sense here, 2 s.
TICK_S, ALIVE_S, LOOK_S = 0.1, 0.5, 1.0
# How often, and how many times after a connection, it looks for programs that another adapter left behind: its end takes a moment to be seen.
SWEEP_S, SWEEPS = 2.0, 5
SLURM_KEYS = ("jobs", "adapt", "queue", "account", "cores", "memory", "processes", "walltime", "interface", "python", "job_cpu", "job_mem",
              "job_extra_directives", "job_directives_skip", "job_script_prologue", "worker_extra_args", "scheduler_options",
              "local_directory", "log_directory", "shebang", "nanny", "worker_command", "security",
              "shared_temp_directory")  # fmt: skip
# Files of `security`: certificates and keys of TLS, by the names that `distributed.Security` gives them.
TLS_KEYS = ("tls_ca_file", "tls_client_cert", "tls_client_key", "tls_scheduler_cert", "tls_scheduler_key", "tls_worker_cert", "tls_worker_key")


class Fault(Exception):
    """What keeps the study from being served, in one line."""


def arguments(argv):
    """The command line. Its faults are lines of the protocol, so that the engine shows them."""

    class Parser(argparse.ArgumentParser):
        def error(self, message):
            raise Fault(f"sensitol-dask: {message}")

    parser = Parser(prog="sensitol-dask", description="Evaluates the points of a sensitol study on a Dask cluster.")
    parser.add_argument("--cluster", required=True, metavar="WHERE", help="local:WORKERS, local:WORKERSxTHREADS, slurm, or tcp://HOST:PORT")
    parser.add_argument("--options", metavar="FILE.yaml", help="options of dask_jobqueue.SLURMCluster, with jobs or adapt")
    parser.add_argument("--batch", type=int, default=LONGEST, metavar="N", help="most points in a task (%(default)s)")
    parser.add_argument("--linger", type=float, default=10.0, metavar="S", help="how long a cluster waits for the next model process (%(default)s)")
    parser.add_argument("--reconnect", type=float, default=60.0, metavar="S", help="how long a lost scheduler is waited for (%(default)s)")
    if "--" in argv:
        cut = argv.index("--")
        own, command = argv[:cut], argv[cut + 1 :]
    else:
        own, command = argv, []
    asked, rest = parser.parse_known_args(own)
    command = rest + command
    if not command:
        raise Fault("sensitol-dask: there is no model: end with `-- python3 model.py` or `-- module:function`")
    if command[0].startswith("-"):
        raise Fault(f"sensitol-dask: unknown option `{command[0]}`")
    if asked.batch < 1:
        raise Fault(f"sensitol-dask: --batch must be 1 or more, got {asked.batch}")
    return asked, command


def cluster_of(asked):
    """What to start, or the address of what runs."""
    where = asked.cluster
    kind, _, size = where.partition(":")
    if kind in ("tcp", "tls", "ucx"):
        return {"kind": "address", "address": where}
    if kind == "local":
        workers, _, threads = size.partition("x")
        try:
            counts = int(workers or os.cpu_count() or 1), int(threads or 1)
        except ValueError:
            raise Fault(f"sensitol-dask: --cluster {where}: local:4 or local:4x2 is expected") from None
        if min(counts) < 1:
            raise Fault(f"sensitol-dask: --cluster {where}: at least one worker is needed")
        return {"kind": "local", "workers": counts[0], "threads": counts[1]}
    if where == "slurm":
        options = slurm_options(asked.options)
        # A cluster that grows gets work for as many threads as it may have: it grows by what waits at the scheduler.
        adapt = options.get("adapt")
        return {"kind": "slurm", "options": options, "capacity": adapt.get("maximum", 1) * options.get("cores", 1) if adapt else 1}
    raise Fault(f"sensitol-dask: --cluster {where}: local:4, local:4x2, slurm or tcp://HOST:PORT is expected")


def slurm_options(path):
    import importlib.util
    import shutil

    for program in ("sbatch", "scancel"):
        if shutil.which(program) is None:
            raise Fault(f"sensitol-dask: there is no `{program}` here: --cluster slurm needs a host that submits jobs")
    if importlib.util.find_spec("dask_jobqueue") is None:
        raise Fault("sensitol-dask: dask-jobqueue is not installed; pip install dask-jobqueue")
    if path is None:
        return {}
    import yaml

    try:
        found = yaml.safe_load(pathlib.Path(path).read_text()) or {}
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise Fault(f"sensitol-dask: {path} cannot be read: {' '.join(str(error).split())}") from None
    if not isinstance(found, dict):
        raise Fault(f"sensitol-dask: {path}: a table of options is expected")
    for key in found:
        if key not in SLURM_KEYS:
            raise Fault(f"sensitol-dask: {path}: there is no option `{key}`; there are {', '.join(SLURM_KEYS)}")
    jobs, adapt = found.get("jobs", 1), found.get("adapt", {})
    if not counts(jobs) or jobs < 1:
        raise Fault(f"sensitol-dask: {path}: `jobs` is a number of jobs, 1 or more; got {jobs!r}")
    if not isinstance(adapt, dict) or not set(adapt) <= {"minimum", "maximum"} or not all(map(counts, adapt.values())):
        raise Fault(f"sensitol-dask: {path}: `adapt` is a range of jobs, as {{ minimum: 0, maximum: 8 }}; got {adapt!r}")
    least, most = adapt.get("minimum", 0), adapt.get("maximum", 1)
    if not 0 <= least <= most or most < 1:
        raise Fault(f"sensitol-dask: {path}: `adapt` needs a maximum of 1 or more, and no greater minimum; got minimum {least}, maximum {most}")
    if "security" in found:
        checked_security(path, found["security"])
    return found


def checked_security(path, security):
    """`true` for credentials that are made for this cluster, or the files of one's own."""
    expected = f"`true` or a table of files is expected, of {', '.join(TLS_KEYS)}"
    if security is True:
        return
    if not isinstance(security, dict) or not security:
        raise Fault(f"sensitol-dask: {path}: `security`: {expected}; got {security!r}")
    for key, file in security.items():
        if key not in TLS_KEYS:
            raise Fault(f"sensitol-dask: {path}: `security` has no `{key}`: {expected}")
        if not isinstance(file, str) or not os.path.isfile(file):
            raise Fault(f"sensitol-dask: {path}: `security`: there is no file {file!r} for `{key}`")
    if "tls_ca_file" not in security:
        raise Fault(f"sensitol-dask: {path}: `security` needs `tls_ca_file`, by which each side knows the others")


def counts(value):
    return isinstance(value, int) and not isinstance(value, bool)


def private_folder():
    """The folder of this user's keepers. What stands in it is read as the word of a keeper, so that nobody else may write there."""
    folder = pathlib.Path(tempfile.gettempdir()) / f"sensitol-dask-{os.getuid()}"
    with contextlib.suppress(FileExistsError):
        folder.mkdir(mode=0o700)
    found = os.lstat(folder)
    if not stat.S_ISDIR(found.st_mode):
        raise Fault(f"sensitol-dask: {folder} is no folder: remove it, or set TMPDIR to another place")
    if found.st_uid != os.getuid() or found.st_mode & 0o077:
        raise Fault(f"sensitol-dask: {folder} is open to other users: remove it, or set TMPDIR to another place")
    return folder


class Kept:
    """The keeper of the cluster that this engine uses: found, or started."""

    def __init__(self, what, linger):
        from sensitol_dask_keeper import alive, birth

        self.alive, engine = alive, os.getppid()
        self.security = None
        text = json.dumps(what, sort_keys=True)
        begun = birth(engine)
        token = hashlib.sha256(f"{text} {engine} {begun} {os.getcwd()}".encode()).hexdigest()[:12]
        self.folder = private_folder() / token
        self.asked = {**what, "engine": engine, "engine_birth": begun, "linger": linger, "token": f"sensitol-{token}"}

    def address(self, beat):
        """Where the scheduler is. `beat` is called while it starts."""
        with open(f"{self.folder}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            try:
                said = self._said()
                if said is None or "error" in said or not self.alive(said["pid"], said["birth"]):
                    self._start()
                while True:
                    said = self._said()
                    if said is not None and "error" in said:
                        raise Fault(f"sensitol-dask: the cluster cannot be started: {said['error']}")
                    if said is not None:
                        self.security = said.get("security")
                        return said["scheduler"]
                    if self.process.poll() is not None:
                        raise Fault(f"sensitol-dask: the cluster's process ended with code {self.process.returncode}")
                    time.sleep(0.02)
                    beat()
            finally:
                os.unlink(lock.name)

    def log(self):
        """What the keeper and its cluster wrote."""
        try:
            return (self.folder / "log").read_text(errors="replace").splitlines()
        except OSError:
            return []

    def _said(self):
        try:
            return json.loads((self.folder / "said.json").read_text())
        except (OSError, ValueError):
            return None

    def _start(self):
        import shutil

        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(mode=0o700)
        (self.folder / "asked.json").write_text(json.dumps(self.asked))
        with open(self.folder / "log", "w") as log:
            self.process = subprocess.Popen(
                [sys.executable, str(HERE / "sensitol_dask_keeper.py"), str(self.folder)],
                stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
                # Without the mark by which the engine ends what a model process leaves behind: the cluster stays for the next one.
                env={name: value for name, value in os.environ.items() if name != "SENSITOL_PROCESS"},
            )  # fmt: skip


class Task:
    """Points that go to a worker together."""

    def __init__(self, points, place=None):
        self.key = f"sensitol-{uuid.uuid4().hex}"
        self.points, self.place = points, place
        self.future, self.started, self.worker, self.stuck = None, None, None, False


def end_left(client, own):
    """Ends the programs of sessions that have no client any more."""
    import sensitol_dask_worker as worker

    try:
        found = client.run(worker.sessions, on_error="ignore")
        seen = {session for sessions in found.values() if sessions for session in sessions} - {own}
        # In this order: a session with a program had a client before, so that it is gone where it has none now.
        present = client.run_on_scheduler(worker.clients) if seen else []
        for session in seen:
            if not any(session in name for name in present):
                client.run(worker.end, session, on_error="ignore")
    except Exception:
        # It is lost, which `watch` sees, or its workers have another version of the module.
        return


class Bridge:
    """The engine on one side, Dask on the other. All of its state belongs to the thread that runs `run`."""

    def __init__(self, argv, lines, say):
        self.lines, self.say = lines, say
        self.asked, self.command = arguments(argv)
        self.what = cluster_of(self.asked)
        self.session = uuid.uuid4().hex[:12]
        self.events = queue.SimpleQueue()
        self.waiting, self.tasks = collections.deque(), {}
        self.client, self.address, self.kept = None, None, None
        self.cost, self.threads, self.names, self.last = None, {}, {}, None
        self.said_alive = self.looked = time.monotonic()
        self.sweeps, self.swept = 0, -math.inf
        self.finished = self.told = False

    # The cluster

    def connect(self):
        """A client of the scheduler that there is. Fails with `OSError` where there is none."""
        from distributed import Client

        if self.what["kind"] == "address":
            self.address = self.what["address"]
        else:
            self.kept = self.kept or Kept(self.what, self.asked.linger)
            self.address = self.kept.address(self.beat)
        try:
            security = self._security()
            self.client = Client(self.address, timeout=5, set_as_default=False, name=f"sensitol-{self.session}", security=security)
        except ValueError as error:
            raise Fault(f"sensitol-dask: --cluster {self.asked.cluster}: {error}") from None
        if self.what["kind"] == "address":
            self._bring()
        self.client.subscribe_topic(f"sensitol-{self.session}", lambda event: self.events.put(("started", event[1])))
        self.sweeps, self.swept = SWEEPS, -math.inf
        self.look()
        self.sweep()

    def _security(self):
        """What a client needs for a scheduler of the keeper that speaks TLS."""
        from distributed.security import Security

        found = self.kept.security if self.kept else None
        return Security(**found, require_encryption=True) if found else None

    def _bring(self):
        """Workers of a cluster that was there before may not have the module that tasks name."""
        probe = f"__import__('importlib.util').util.find_spec('{WORKER}') is not None"
        known = [*self.client.run(eval, probe).values(), self.client.run_on_scheduler(eval, probe)]
        if not all(known) or len(known) == 1:
            self.client.upload_file(str(HERE / f"{WORKER}.py"))

    def sweep(self):
        """Ends programs whose adapter is gone, some times after a connection. One that hangs would keep its worker from every later point."""
        if self.sweeps > 0 and time.monotonic() - self.swept > SWEEP_S and self.threads:
            self.sweeps, self.swept = self.sweeps - 1, time.monotonic()
            # A worker that does not answer must not hold up the others.
            threading.Thread(target=end_left, args=(self.client, self.session), daemon=True).start()

    def look(self):
        """Which workers there are, and how many threads they have."""
        self.looked = time.monotonic()
        found = dict(self.client.nthreads())
        for gone in self.threads.keys() - found.keys():
            self.say({"alive": True, "note": f"{self.names.pop(gone, gone)} is lost"})
        if sum(found.values()) != sum(self.threads.values()) and self.finished:
            self.say({"window": self.window(found)})
        self.threads = found

    def window(self, threads):
        return max(64, LONGEST * AHEAD * max(1, sum(threads.values())))

    def reconnect(self):
        """A scheduler that is gone comes again, or its place is taken by a new one. All points under way go out again."""
        import distributed

        self.say({"alive": True, "note": f"the scheduler at {self.address} is lost: its points go out again"})
        for task in self.tasks.values():
            self.waiting.extendleft(reversed(task.points))
        self.tasks, self.threads, self.names, self.last = {}, {}, {}, None
        # The next connection ends the programs of the lost one.
        self.session = uuid.uuid4().hex[:12]
        until = time.monotonic() + self.asked.reconnect
        while True:
            try:
                self.client.close(timeout=1)
            except Exception:
                pass
            try:
                self.connect()
                self.say({"alive": True, "note": f"connected to the scheduler at {self.address}"})
                return
            except (OSError, TimeoutError, distributed.CommClosedError) as error:
                if time.monotonic() > until:
                    raise Fault(f"no scheduler at {self.address} for {self.asked.reconnect:g} s: {error}") from None
            for _ in range(10):
                self.beat()
                time.sleep(0.1)
            self.read(wait=False)

    # Points

    def greet(self, hello):
        """What the model says of itself: the first program on the first worker."""
        import sensitol_dask_worker as worker

        try:
            self.connect()
        except OSError as error:
            raise Fault(f"sensitol-dask: no scheduler answers at {self.address}: {error}") from None
        name = self.command[0]
        function = len(self.command) == 1 and ":" in name and not os.path.exists(name) and all(part.replace(".", "_").isidentifier() for part in name.split(":", 1))
        self.spec = {"command": self.command, "function": name if function else None, "folder": os.getcwd(), "hello": hello}
        while True:
            future = self.client.submit(worker.greet, self.session, self.spec, pure=False, key=f"sensitol-{uuid.uuid4().hex}")
            done = threading.Event()
            future.add_done_callback(lambda _: done.set())
            while not done.wait(0.2):
                if self.client.status != "running":
                    break
                self.read(wait=False)
                self.wait_for_workers()
                self.sweep()
            if future.status == "finished":
                break
            if future.status == "error":
                raise Fault(f"the model cannot be started on the cluster: {future.exception()}")
            self.reconnect()
        ready = future.result()
        if "error" in ready:
            raise Fault(ready["error"])
        self.spec["identity"] = worker.identity(ready)
        parts = [str(ready["version"])] if ready.get("version") is not None else []
        digest = hashed(self.command)
        self.look()
        said = {
            "ready": True, "name": ready.get("name") or " ".join(self.command), "version": "; ".join([*parts, *digest]) or VERSION,
            "window": self.window(self.threads), "heartbeat": True, "isolated": True, "cancel": True, "places": max(1, sum(self.threads.values())),
        }  # fmt: skip
        if ready.get("gradients"):
            said["gradients"] = True
        self.finished = True
        self.say(said)

    def wait_for_workers(self):
        """Says why nothing happens before the first worker is there: the engine shows it when it has waited long enough."""
        if self.threads or time.monotonic() - self.looked < LOOK_S:
            return
        self.look()
        for line in self.kept.log() if self.kept else []:
            if "sbatch: error" in line:
                # The log quotes it as Python does.
                raise Fault(f"sensitol-dask: {line[line.index('sbatch: error') :].split(chr(92))[0].strip()}")
        if not self.threads and not self.told:
            self.told = True
            print(f"sensitol-dask: waiting for a worker of {self.asked.cluster}", file=sys.stderr, flush=True)

    def read(self, wait=True):
        """Hears the engine and the cluster; raises EOFError when the engine is gone."""
        try:
            kind, what = self.events.get(timeout=TICK_S) if wait else self.events.get_nowait()
            while True:
                getattr(self, f"on_{kind}")(what)
                kind, what = self.events.get_nowait()
        except queue.Empty:
            pass

    def on_end(self, _):
        raise EOFError

    def on_line(self, line):
        if "cancel" in line:
            self.call_off(set(line["cancel"]))
        elif "x" in line:
            self.waiting.append((line["id"], line["x"], line.get("place")))

    def on_started(self, event):
        task = self.tasks.get(event["task"])
        if task is not None:
            task.started, task.worker = time.monotonic(), event["worker"]
            if len(task.points) == 1:
                self.say({"id": task.points[0][0], "started": self.place(event)})

    def on_done(self, task):
        if self.tasks.get(task.key) is not task:
            return
        status = task.future.status
        if status == "cancelled":
            # The scheduler is gone: `run` sees that too.
            return
        del self.tasks[task.key]
        if status == "error":
            self.broken(task, task.future.exception())
            return
        found = task.future.result()
        self.last = found["worker"]
        where = self.place(found)
        costs = [answer["cost_s"] for answer in found["answers"] if answer and "cost_s" in answer]
        if costs:
            mean = found["spent"] / len(costs)
            self.cost = mean if self.cost is None else 0.7 * self.cost + 0.3 * mean
        lines = []
        for point, answer in zip(task.points, found["answers"]):
            if answer is None:
                # Its task was taken apart before it came to this point: now it goes alone.
                self.waiting.appendleft((point[0], point[1], point[2] or "alone"))
                continue
            if "error" in answer and "retry" in answer and answer["retry"]:
                answer = {**answer, "error": f"{answer['error']} (worker {where})"}
            lines.append({"id": point[0], **answer, "where": where})
        self.say(*lines)

    def broken(self, task, error):
        """A task that Dask gave up, such as one during which several workers died."""
        if len(task.points) > 1:
            self.waiting.extendleft((id, x, place or "alone") for id, x, place in reversed(task.points))
            return
        text = " ".join(f"{type(error).__name__}: {error}".split())
        self.say({"id": task.points[0][0], "error": text[:400], "retry": True})

    def place(self, found):
        """A node and a number on it: a worker that takes the place of a lost one gets its number."""
        address = found["worker"]
        if address not in self.names:
            taken = set(self.names.values())
            number = next(k for k in range(1, len(taken) + 2) if f"{found['node']}/{k}" not in taken)
            self.names[address] = f"{found['node']}/{number}"
        return self.names[address]

    def send(self):
        """Submits as many tasks as keep every thread at work, those too that a growing cluster can have."""
        import sensitol_dask_worker as worker

        threads = max(sum(self.threads.values()), self.what.get("capacity", 1))
        while self.waiting and len(self.tasks) < AHEAD * threads:
            room = 1
            if self.cost is not None:
                room = int(TASK_S / max(self.cost, 1e-6))
            # The last points are shared out.
            room = max(1, min(room, self.asked.batch, len(self.waiting) // (2 * threads)))
            place = self.waiting[0][2]
            points = [self.waiting.popleft()]
            while len(points) < room and place is None and self.waiting and self.waiting[0][2] is None:
                points.append(self.waiting.popleft())
            task = Task(points, place)
            only = None
            if place is not None:
                only = [address for address, name in self.names.items() if name == place and address in self.threads] or None
            elif not self.tasks and not self.waiting and len(points) == 1 and self.last in self.threads:
                # A point by itself goes where the last one went: single points in a row are a way that one program goes.
                only = [self.last]
            self.tasks[task.key] = task
            task.future = self.client.submit(
                worker.evaluate, self.session, self.spec, task.key, [x for _, x, _ in points],
                key=task.key, pure=False, workers=only, allow_other_workers=only is not None, retries=0,
            )  # fmt: skip
            task.future.add_done_callback(lambda _, task=task: self.events.put(("done", task)))

    def call_off(self, ids):
        """Takes points back: those that wait are forgotten, and a program that works for one is ended."""
        self.waiting = collections.deque(one for one in self.waiting if one[0] not in ids)
        for task in list(self.tasks.values()):
            if all(point[0] in ids for point in task.points):
                del self.tasks[task.key]
                task.future.cancel()
                self.interrupt(task)

    def interrupt(self, task):
        import sensitol_dask_worker as worker

        if task.worker in self.threads:
            # A worker that does not answer must not hold up the others.
            run = lambda: self.client.run(worker.interrupt, task.key, workers=[task.worker], on_error="ignore")
            threading.Thread(target=run, daemon=True).start()

    def beat(self):
        now = time.monotonic()
        if self.finished and now - self.said_alive > ALIVE_S:
            self.said_alive = now
            running = sum(1 for task in self.tasks.values() if task.started)
            self.say({"alive": True, "running": running, "queued": len(self.waiting) + len(self.tasks) - running})

    def watch(self):
        """Looks after the cluster, and takes tasks apart that take far longer than they should."""
        now = time.monotonic()
        if self.client.status != "running":
            return self.reconnect()
        if now - self.looked > LOOK_S:
            try:
                self.look()
            except Exception:
                # A scheduler that does not answer is lost, whatever the client thinks.
                return self.reconnect()
        self.sweep()
        for task in self.tasks.values():
            expected = STUCK_S + STUCK_TIMES * (self.cost or 0.0) * len(task.points)
            if len(task.points) > 1 and task.started and not task.stuck and now - task.started > expected:
                task.stuck = True
                self.interrupt(task)
        return None

    def run(self):
        """Until the engine is gone."""
        first = self.lines.readline()
        if not first:
            return
        threading.Thread(target=self._listen, daemon=True).start()
        try:
            self.greet(json.loads(first))
            while True:
                self.send()
                self.read()
                self.watch()
                self.beat()
        except EOFError:
            pass
        finally:
            self.close()

    def _listen(self):
        for line in self.lines:
            if line.strip():
                self.events.put(("line", json.loads(line)))
        self.events.put(("end", None))

    def close(self):
        """Ends the programs of this session. Programs that cannot be reached end when their worker does."""
        import sensitol_dask_worker as worker

        if self.client is None or self.client.status != "running":
            return
        waiter = threading.Thread(target=lambda: self._close(worker), daemon=True)
        waiter.start()
        waiter.join(1.2)

    def _close(self, worker):
        try:
            for task in self.tasks.values():
                task.future.cancel(force=True)
            self.client.run(worker.end, self.session, on_error="ignore")
            self.client.close(timeout=1)
        except Exception:
            pass


def hashed(command):
    """The contents of the files that the command names: a changed model is another one. The engine knows the first file only."""
    digest, found = hashlib.sha256(), False
    for part in command:
        if os.path.isfile(part):
            found = True
            digest.update(pathlib.Path(part).read_bytes() + b"\0")
    return [f"files {digest.hexdigest()[:16]}"] if found else []


def main():
    # Descriptor 1 belongs to the protocol; libraries that print do so to stderr.
    answers = os.dup(1)
    os.dup2(2, 1)
    lock = threading.Lock()

    def say(*lines):
        data = "".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines).encode()
        with lock:
            while data:
                data = data[os.write(answers, data) :]

    code, bridge = 0, None
    sys.path.insert(0, str(HERE))
    import logging

    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    lines = sys.stdin.buffer
    if sys.argv[1:] in (["--help"], ["-h"]):
        os.dup2(answers, 1)
    try:
        bridge = Bridge(sys.argv[1:], lines, say)
        bridge.run()
    except Fault as fault:
        if bridge is None:
            lines.readline()
        if bridge is None or not bridge.finished:
            say({"error": str(fault)})
        else:
            print(f"sensitol-dask: {fault}", file=sys.stderr, flush=True)
            code = 1
    except (BrokenPipeError, KeyboardInterrupt):
        pass
    sys.stderr.flush()
    # Threads of Dask would wait for a cluster that may be gone.
    os._exit(code)


if __name__ == "__main__":
    main()
