"""What runs on the workers: external models as long-lived programs, one for each task that runs at a time.

Tasks name `evaluate` of this module. A function that travelled by value would be another one in every task, with a cache of its own,
and every task would start a program anew.
"""

import collections
import importlib
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading
import time

# Lines of stderr that an error quotes.
TAIL = 5
# After this time without a point a program is ended: its engine is gone and could not say so.
IDLE_S = 600.0

_LOCK = threading.Lock()
# Idle programs of every session. The one used last is used next: a walk of single points stays in one program.
_IDLE = collections.defaultdict(list)
# Programs by the task that they work for, and tasks that were called off.
_BUSY = {}
_INTERRUPTED = set()
_ENDED = set()


class Ended(Exception):
    """A program that is gone, or said something that is not an answer."""


class Program:
    """One process that speaks the protocol. It has a process group of its own, which a guard ends when this process is gone."""

    def __init__(self, session, spec):
        self.session = session
        command = spec["command"]
        if spec.get("function"):
            command = [sys.executable, os.path.abspath(__file__), "--serve", spec["function"]]
        folder = spec["folder"]
        if not os.path.isdir(folder):
            raise Ended(f"there is no folder {folder} on {node()}")
        try:
            self.process = subprocess.Popen(
                command, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True,
            )  # fmt: skip
        except OSError as error:
            raise Ended(f"`{command[0]}` cannot be started on {node()}: {error}") from None
        script = 'read -r line; kill -s KILL -- "-$1"'
        self.guard = subprocess.Popen(
            ["/bin/sh", "-c", script, "sensitol-guard", str(self.process.pid)],
            stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        )  # fmt: skip
        self.tail = collections.deque(maxlen=TAIL)
        self.reader = threading.Thread(target=self._listen, daemon=True)
        self.reader.start()
        self.next, self.used = 0, time.monotonic()
        try:
            self._write(spec["hello"])
            self.ready = self._read()
        except BaseException:
            self.close()
            raise
        self.window = max(1, int(self.ready.get("window", 1)))

    def _listen(self):
        for line in self.process.stderr:
            self.tail.append(line.decode("utf-8", "replace").rstrip())

    def _write(self, line):
        try:
            self.process.stdin.write(json.dumps(line).encode() + b"\n")
            self.process.stdin.flush()
        except OSError:
            # Why it is gone is found when its answer is read.
            pass

    def _read(self):
        line = self.process.stdout.readline()
        if not line:
            code = self.process.wait()
            self.reader.join(0.5)
            how = f"was ended by signal {-code}" if code < 0 else f"ended with code {code}"
            quoted = "; ".join(self.tail)
            raise Ended(f"the program {how} on {node()}" + (f": {quoted}" if quoted else ""))
        try:
            found = json.loads(line)
        except ValueError:
            found = None
        if not isinstance(found, dict):
            raise Ended(f"the program wrote a line that is not an answer: {line[:80].decode('utf-8', 'replace')!r}")
        return found

    def ask(self, points):
        """Answers to points, each as soon as it is there, with its place among them and the seconds since the one before."""
        sent, waiting, last = 0, {}, time.monotonic()
        while sent < len(points) or waiting:
            while sent < len(points) and len(waiting) < self.window:
                self.next += 1
                waiting[self.next] = sent
                self._write({"id": self.next, "x": points[sent]})
                sent += 1
            answer = self._read()
            if "y" not in answer and "error" not in answer:
                continue
            place = waiting.pop(answer.pop("id", None), None)
            if place is None:
                raise Ended("the program answered a point that it was not asked for")
            now = time.monotonic()
            yield place, answer, now - last
            last = now
        self.used = time.monotonic()

    def kill(self):
        """Ends the program and whatever it started; who works with it sees that it is gone."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except OSError:
            pass

    def close(self):
        """Ends it, and what watches it."""
        self.kill()
        self.process.wait()
        # Its work is done: it must not see its pipe close, when the group's number may be another's.
        self.guard.kill()
        self.guard.wait()
        for pipe in (self.process.stdin, self.process.stdout, self.guard.stdin):
            try:
                pipe.close()
            except OSError:
                pass


def node():
    """The node as Slurm calls it, or the host."""
    return os.environ.get("SLURMD_NODENAME") or socket.gethostname()


def _address():
    from distributed import get_worker

    try:
        return get_worker().address
    except ValueError:
        return None


def _tell(session, event):
    """Tells the front end that something has begun."""
    from distributed import get_worker

    try:
        get_worker().log_event(f"sensitol-{session}", event)
    except ValueError:
        pass


def _taken(session, spec):
    """A program that is free, or a new one."""
    with _LOCK:
        for other, programs in list(_IDLE.items()):
            for program in [one for one in programs if time.monotonic() - one.used > IDLE_S]:
                programs.remove(program)
                threading.Thread(target=program.close, daemon=True).start()
            if not programs:
                del _IDLE[other]
        if _IDLE.get(session):
            return _IDLE[session].pop()
    program = Program(session, spec)
    if "error" in program.ready or not program.ready.get("ready"):
        program.close()
        raise Ended(str(program.ready.get("error", "the program's first line is not that it is ready")))
    expected = spec.get("identity")
    found = identity(program.ready)
    if expected is not None and found != expected:
        program.close()
        raise Ended(f"the model on {node()} is {found}, and elsewhere {expected}: install the same one on every node")
    return program


def identity(ready):
    """Name and version, by which answers are kept."""
    return [ready.get("name"), ready.get("version")]


def greet(session, spec):
    """What the program says of itself, or why it cannot serve the study."""
    try:
        program = _taken(session, spec)
    except Ended as error:
        return {"error": str(error)}
    _back(session, program)
    return program.ready


def _back(session, program):
    with _LOCK:
        if session not in _ENDED:
            _IDLE[session].append(program)
            return
    program.close()


def evaluate(session, spec, task, points):
    """Answers to points, with the node and the worker. A program that dies costs its point only; others are asked again one by one."""
    where = {"node": node(), "worker": _address()}
    _tell(session, {"task": task, **where})
    answers = [None] * len(points)
    begun = time.monotonic()
    _ask(session, spec, task, points, range(len(points)), answers)
    for place in range(len(points)):
        if answers[place] is None and task not in _INTERRUPTED and session not in _ENDED:
            _ask(session, spec, task, points, [place], answers)
    with _LOCK:
        _INTERRUPTED.discard(task)
    return {**where, "answers": answers, "spent": time.monotonic() - begun}


def _ask(session, spec, task, points, places, answers):
    places = list(places)
    program = None
    try:
        program = _taken(session, spec)
        with _LOCK:
            _BUSY[task] = program
            if task in _INTERRUPTED:
                raise Ended("called off")
        for index, answer, cost in program.ask([points[place] for place in places]):
            answers[places[index]] = {**answer, "cost_s": round(cost, 6)}
    except Ended as error:
        if program is not None:
            program.close()
            program = None
        if len(places) == 1 and task not in _INTERRUPTED and session not in _ENDED:
            answers[places[0]] = {"error": str(error), "retry": True}
    finally:
        with _LOCK:
            _BUSY.pop(task, None)
        if program is not None:
            _back(session, program)


def interrupt(task):
    """Ends the program that works for this task; its answers so far are kept."""
    with _LOCK:
        program = _BUSY.get(task)
        _INTERRUPTED.add(task)
    if program is not None:
        program.kill()


def end(session):
    """Ends the programs of a session, busy ones too."""
    with _LOCK:
        _ENDED.add(session)
        programs = _IDLE.pop(session, [])
        busy = [program for program in _BUSY.values() if program.session == session]
    for program in busy:
        program.kill()
    for program in programs:
        program.close()


def sessions():
    """The sessions that have programs here."""
    with _LOCK:
        return sorted({*_IDLE, *(program.session for program in _BUSY.values())})


def clients(dask_scheduler):
    """The names of all clients of the scheduler, each with the session that it serves."""
    return list(dask_scheduler.clients)


def serve(name):
    """A function `module:function` as a program, in the study's folder."""
    try:
        from sensitol_adapter import Adapter
    except ImportError:
        sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
        try:
            from sensitol_adapter import Adapter
        except ImportError:
            Adapter = None
    if Adapter is None:
        print(json.dumps({"error": f"`sensitol_adapter` is not installed on {node()}; pip install adapters/python"}), flush=True)
        return
    sys.path.insert(0, os.getcwd())
    module, _, function = name.partition(":")
    try:
        found = getattr(importlib.import_module(module), function)
    except Exception as error:
        fault = ValueError(f"`{name}` cannot be imported on {node()}: {type(error).__name__}: {error}")

        def refuse():
            raise fault

        Adapter(lambda **_: None, name=name, setup=refuse).serve()
        return
    adapter = found if isinstance(found, Adapter) else Adapter(found, name=name)
    adapter.serve()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--serve"] and len(sys.argv) == 3:
        serve(sys.argv[2])
    else:
        raise SystemExit("usage: sensitol_dask_worker.py --serve module:function")
