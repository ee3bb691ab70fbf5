"""One function as a model: names from its signature, lines in, lines out."""

import hashlib
import inspect
import json
import logging
import math
import os
import queue
import socket
import sys
import threading
import time

VERSION = 1
# Answers that come within this time share a write.
TOGETHER_S = 0.01
_WRITING = threading.Lock()
log = logging.getLogger("sensitol")

_POSITIONAL = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)


class NoValue(Exception):
    """Raised by a model that has no value at a point; `retry=True` when another try may have one."""

    def __init__(self, message, retry=False):
        super().__init__(message)
        self.retry = retry


def adapter(function=None, **options):
    """Decorates a function of named dimensions and constants; see `Adapter` for the options."""
    if function is None:
        return lambda function: Adapter(function, **options)
    return Adapter(function, **options)


class Adapter:
    """A function as a model.

    The function's parameters are dimensions and constants by name (names that are no identifiers reach it through
    `names`, a dict from parameter to dimension, or through `**values`). It returns a number for a model with one
    characteristic, or a dict from characteristic to number; `None`, NaN or a missing entry is "no value". An exception is
    an error of that point alone.

    name, version   who answers; part of what kept answers are known by
    outputs         the characteristics it offers, so that a misspelt one is refused at once; by default the function's
                    name when it returns a number
    window          points that may be sent ahead; more than 1 hides the time between processes
    gradients       the function returns a pair: values, and derivatives as a dict from dimension to number, or for several
                    characteristics a dict of such dicts; a dimension that is left out has derivative 0
    batch           the function takes a list for every parameter and returns a list (or a dict of lists)
    inputs          what a function with `**values` takes; without it that takes every name. The study may leave these out
    units           a dict from dimension or output to unit; a study that states another one is refused
    isolated        points do not share the process's fate, as on a cluster: after a crash all of them go out again together
    threads         points evaluated side by side, where the function may be called by several threads: it waits for servers or
                    programs. Every answer is written as soon as it is there
    heartbeat       seconds between signs of life. Points that wait in the window are then not late, and each evaluation says when
                    it starts, on which host, and what it took. Without it the model must be silent between answers
    setup           called once, before the model is ready; with a parameter it is given the engine's first line. It may
                    still change name, version, inputs, outputs and units: a model often knows them once it is loaded
    """

    def __init__(
        self, function, *, name=None, version=None, outputs=None, window=64, batch=False, gradients=False, names=None,
        inputs=None, units=None, setup=None, isolated=False, heartbeat=None, threads=1,
    ):  # fmt: skip
        self.function = function
        self.name = name or function.__name__
        self.version = version
        self.outputs = list(outputs) if outputs is not None else None
        self.window = window
        self.batch = batch
        self.gradients = gradients
        if batch and gradients:
            raise ValueError("gradients are given point by point: not in a batch")
        self.isolated = isolated
        if heartbeat is not None and not heartbeat > 0:
            raise ValueError("heartbeat is a time in seconds, above 0")
        self.heartbeat = heartbeat
        if threads > 1 and batch:
            raise ValueError("a batch is one call: it has no threads")
        self.threads = threads
        self.inputs = list(inputs) if inputs is not None else None
        self.units = dict(units or {})
        self.setup = setup
        self._names = dict(names or {})
        parameters = inspect.signature(function).parameters.values()
        self._any = any(parameter.kind is inspect.Parameter.VAR_KEYWORD for parameter in parameters)
        self._parameters = {
            self._names.get(parameter.name, parameter.name): parameter
            for parameter in parameters
            if parameter.kind in _POSITIONAL
        }
        self.__doc__ = function.__doc__

    def __call__(self, *args, **kwargs):
        return self.function(*args, **kwargs)

    def serve(self):
        """Answers on stdin and stdout until stdin ends."""
        lines, answers = _own_pipes()
        try:
            first = lines.readline()
            if not first:
                return
            try:
                hello = json.loads(first)
                if self.setup is not None:
                    self.setup(*([hello] if _takes_one(self.setup) else []))
                session = _Session(self, hello)
            except Exception as error:
                _write(answers, [{"error": _words(error)}])
                return
            ready = {"ready": True, "name": self.name, "window": self.window}
            if self.gradients:
                ready["gradients"] = True
            parts = [str(self.version)] if self.version is not None else []
            modules = _own_modules()
            if modules:
                parts.append(f"modules {modules}")
            if parts:
                ready["version"] = "; ".join(parts)
            if self.isolated:
                ready["isolated"] = True
            if self.units:
                # The engine holds them against those of the study, whatever way they are written.
                ready["units"] = self.units
            if self.heartbeat is not None:
                ready["heartbeat"] = True
                session.started = lambda id: _write(answers, [{"id": id, "started": session.host}])
            _write(answers, [ready])
            if self.heartbeat is not None:
                threading.Thread(target=_beat, args=(answers, self.heartbeat), daemon=True).start()
            if self.threads > 1:
                _side_by_side(self.threads, session, lines, answers)
                return
            for requests in lines.batches():
                for done in session.answers(requests):
                    _write(answers, done)
        except (BrokenPipeError, KeyboardInterrupt):
            pass


def _side_by_side(threads, session, lines, answers):
    """Points of the window on several threads. When the engine is gone, nobody waits for what is under way."""
    waiting = queue.SimpleQueue()

    def work():
        while True:
            for done in session.answers([waiting.get()]):
                try:
                    _write(answers, done)
                except OSError:
                    return

    for _ in range(threads):
        threading.Thread(target=work, daemon=True).start()
    for requests in lines.batches():
        for request in requests:
            waiting.put(request)


def _own_modules():
    """A hash of the imported modules below the working folder, which is the study's: a changed one is another model. The script itself
    is known to the engine. None where there are none."""
    folder = os.path.realpath(os.getcwd()) + os.sep
    own = os.path.dirname(os.path.realpath(__file__)) + os.sep
    files = set()
    for name, module in list(sys.modules.items()):
        path = getattr(module, "__file__", None)
        path = os.path.realpath(path) if path and name != "__main__" else ""
        if path.startswith(folder) and not path.startswith(own) and "site-packages" not in path:
            files.add(path)
    digest = hashlib.sha256()
    for path in sorted(files):
        try:
            with open(path, "rb") as file:
                digest.update(os.path.relpath(path, folder).encode() + b"\0" + file.read() + b"\0")
        except OSError:
            digest.update(path.encode())
    return digest.hexdigest()[:16] if files else None


def _takes_one(function):
    """Whether it cannot be called without an argument."""
    parameters = inspect.signature(function).parameters.values()
    return any(one.kind in _POSITIONAL and one.default is inspect.Parameter.empty for one in parameters)


class _Session:
    """What one study asks of an adapter."""

    def __init__(self, adapter, hello):
        self.adapter = adapter
        if hello.get("sensitol") != VERSION:
            raise ValueError(f"this adapter speaks version {VERSION} of the protocol, not {hello.get('sensitol')}")
        self.characteristics = hello["characteristics"]
        optional = set(hello.get("optional", ()))
        dimensions, constants = hello["dimensions"], hello.get("constants", {})
        known = adapter._parameters
        anything = adapter._any and adapter.inputs is None
        taken = [*known, *(adapter.inputs or ())]
        unknown = [name for name in [*dimensions, *constants] if name not in taken and name not in optional]
        if unknown and not anything:
            raise ValueError(f"no dimension or constant `{unknown[0]}`; there are {', '.join(taken)}")
        for name, unit in zip(dimensions, hello.get("units", ())):
            expected = adapter.units.get(name)
            if None not in (unit, expected) and unit != expected:
                raise ValueError(f"`{name}` is in `{unit}` in the study and in `{expected}` here; state one of them otherwise")
        self.dimensions = dimensions
        # Set where the program says when it starts a point.
        self.started, self.host = None, socket.gethostname()
        given = {*dimensions, *constants}
        missing = [
            name for name, parameter in known.items() if name not in given and parameter.default is inspect.Parameter.empty
        ]
        if missing:
            raise ValueError(f"`{missing[0]}` is needed and the study does not have it")
        offered = adapter.outputs
        for name in self.characteristics:
            if offered is not None and name not in offered:
                raise ValueError(f"no characteristic `{name}`; there are {', '.join(offered)}")
        back = {dimension: parameter for parameter, dimension in adapter._names.items()}
        self.columns = [(back.get(name, name), index) for index, name in enumerate(dimensions) if anything or name in taken]
        self.constants = {back.get(name, name): value for name, value in constants.items() if anything or name in taken}

    def answers(self, requests):
        """Lists of answers: fast ones together, slow ones as soon as they are there, since the engine's clock runs."""
        if self.adapter.batch:
            yield self._together(requests)
            return
        done, since = [], time.monotonic()
        for request in requests:
            if "x" not in request:
                continue
            if self.started is None:
                done.append(self._one(request))
            else:
                self.started(request["id"])
                begun = time.monotonic()
                answer = self._one(request)
                done.append({**answer, "where": self.host, "cost_s": round(time.monotonic() - begun, 6)})
            if time.monotonic() - since > TOGETHER_S:
                yield done
                done, since = [], time.monotonic()
        yield done

    def _one(self, request):
        x = request["x"]
        values = {name: x[index] for name, index in self.columns}
        try:
            result = self.adapter.function(**values, **self.constants)
            if not self.adapter.gradients:
                return self._values(request["id"], result)
            values, derivatives = result
            answer = self._values(request["id"], values)
            answer["dy"] = self._gradients(derivatives)
            return answer
        except Exception as error:
            return self._failed(request["id"], error)

    def _gradients(self, derivatives):
        if len(self.characteristics) == 1 and self.characteristics[0] not in derivatives:
            derivatives = {self.characteristics[0]: derivatives}
        back = {parameter: dimension for parameter, dimension in self.adapter._names.items()}
        rows = []
        for characteristic in self.characteristics:
            by_name = {back.get(name, name): float(value) for name, value in derivatives[characteristic].items()}
            unknown = by_name.keys() - set(self.dimensions)
            if unknown:
                raise ValueError(f"a derivative by `{sorted(unknown)[0]}`, which is no dimension")
            rows.append([by_name.get(name, 0.0) for name in self.dimensions])
        if not all(math.isfinite(value) for row in rows for value in row):
            raise ValueError("a derivative is not finite")
        return rows

    def _together(self, requests):
        requests = [request for request in requests if "x" in request]
        if not requests:
            return []
        columns = {name: [request["x"][index] for request in requests] for name, index in self.columns}
        try:
            result = self.adapter.function(**columns, **self.constants)
        except Exception as error:
            if len(requests) == 1:
                return [self._failed(requests[0]["id"], error)]
            # One bad point must not take the others with it.
            return [answer for request in requests for answer in self._together([request])]
        if isinstance(result, dict):
            rows = [{name: column[row] for name, column in result.items()} for row in range(len(requests))]
        else:
            rows = list(result)
        return [self._checked(request["id"], row) for request, row in zip(requests, rows)]

    def _checked(self, id, row):
        try:
            return self._values(id, row)
        except Exception as error:
            return self._failed(id, error)

    def _values(self, id, result):
        if not isinstance(result, dict):
            if len(self.characteristics) != 1:
                raise TypeError(f"a dict with {', '.join(self.characteristics)} is asked for, not {type(result).__name__}")
            result = {self.characteristics[0]: result}
        y, errors = [], {}
        for name in self.characteristics:
            value = result.get(name)
            if isinstance(value, Exception):
                errors[name] = _words(value)
                value = None
            elif value is None:
                errors[name] = "no value" if name in result else f"the model returned no `{name}`"
            else:
                value = float(value)
                if not math.isfinite(value):
                    errors[name] = f"the model returned {value}"
                    value = None
            y.append(value)
        answer = {"id": id, "y": y}
        if errors:
            answer["errors"] = errors
        return answer

    @staticmethod
    def _failed(id, error):
        if not isinstance(error, NoValue):
            log.debug("point %s", id, exc_info=error)
        return {"id": id, "error": _words(error), "retry": bool(getattr(error, "retry", False))}


def _words(error):
    text = str(error) or type(error).__name__
    plain = isinstance(error, (NoValue, ValueError))
    return text if plain else f"{type(error).__name__}: {text}"


class _Lines:
    """Lines of a descriptor, with everything that is there at once."""

    def __init__(self, descriptor):
        self._descriptor = descriptor
        self._rest = b""

    def readline(self):
        while b"\n" not in self._rest:
            chunk = os.read(self._descriptor, 1 << 16)
            if not chunk:
                return b""
            self._rest += chunk
        line, self._rest = self._rest.split(b"\n", 1)
        return line

    def batches(self):
        """Requests that arrived together, as soon as there is one."""
        while True:
            *lines, rest = self._rest.split(b"\n")
            requests = [json.loads(line) for line in lines if line.strip()]
            self._rest = rest
            if requests:
                yield requests
            chunk = os.read(self._descriptor, 1 << 16)
            if not chunk:
                return
            self._rest += chunk


def _own_pipes():
    """Takes descriptors 0 and 1 for the protocol: native libraries that print to stdout print to stderr from now on."""
    sys.stdout.flush()
    requests, answers = os.dup(0), os.dup(1)
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.close(null)
    os.dup2(2, 1)
    sys.stdout = sys.stderr
    return _Lines(requests), answers


def _beat(descriptor, seconds):
    """Signs of life, until the engine is gone."""
    try:
        while True:
            time.sleep(seconds)
            _write(descriptor, [{"alive": True}])
    except OSError:
        pass


def _write(descriptor, answers):
    dump = json.JSONEncoder(separators=(",", ":"), ensure_ascii=True, allow_nan=False).encode
    data = "".join(dump(answer) + "\n" for answer in answers).encode()
    # Lines of the heartbeat must not come between parts of an answer.
    with _WRITING:
        while data:
            data = data[os.write(descriptor, data):]
