"""Offers the characteristics of a sensitol study as a UM-Bridge model: `python3 sensitol_umbridge_server.py STUDY.toml`.

One input vector holds all dimensions in the study's order, one output vector all characteristics. Needs `sensitol` in the PATH,
or SENSITOL with its path, and nothing but Python.
"""

import argparse
import contextlib
import http.server
import ipaddress
import json
import math
import os
import pathlib
import signal
import socket
import subprocess
import sys
import threading

PROTOCOL = 1.0
# The longest request that is read, in bytes: a million inputs fit into it.
LONGEST = 32 << 20


class Fault(Exception):
    """An answer with an error: what UM-Bridge calls it, a message, and the status of the response."""

    def __init__(self, kind, message, status=400):
        super().__init__(message)
        self.kind, self.status = kind, status


class Study:
    """`sensitol evaluate` as a long-lived process. Requests of several threads share it, and every answer wakes its own."""

    def __init__(self, path):
        program = os.environ.get("SENSITOL", "sensitol")
        try:
            self.process = subprocess.Popen([program, "evaluate", str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        except OSError as error:
            raise SystemExit(f"error: {program} cannot be started: {error}") from None
        self.writing = threading.Lock()
        self.waiting, self.sent, self.ended = {}, 0, None
        # One that ends at once may be gone before it is asked: it has said why.
        with contextlib.suppress(OSError):
            self._write({"sensitol": 1, "dimensions": [], "characteristics": []})
        line = self.process.stdout.readline()
        self.ready = json.loads(line) if line else {"error": "sensitol ended before it was ready"}
        if "error" in self.ready:
            self.process.wait()
            raise SystemExit(f"error: {path}: {self.ready['error']}")
        threading.Thread(target=self._read, daemon=True).start()

    def _write(self, line):
        self.process.stdin.write(json.dumps(line).encode() + b"\n")
        self.process.stdin.flush()

    def _read(self):
        for line in self.process.stdout:
            answer = json.loads(line)
            slot = self.waiting.pop(answer["id"], None)
            if slot is not None:
                slot["answer"] = answer
                slot["there"].set()
        self.ended = f"sensitol ended with status {self.process.wait()}"
        for slot in list(self.waiting.values()):
            slot["there"].set()

    def evaluate(self, x):
        slot = {"there": threading.Event(), "answer": None}
        with self.writing:
            if self.ended:
                raise Fault("ModelError", self.ended, 500)
            self.sent += 1
            self.waiting[self.sent] = slot
            try:
                self._write({"id": self.sent, "x": x})
            except OSError as error:
                raise Fault("ModelError", f"sensitol is gone: {error}", 500) from None
        slot["there"].wait()
        answer = slot["answer"]
        if answer is None:
            raise Fault("ModelError", self.ended or "sensitol is gone", 500)
        faults = [answer["error"]] if "error" in answer else [f"{name}: {text}" for name, text in answer.get("errors", {}).items()]
        if faults:
            raise Fault("ModelError", "; ".join(faults), 500)
        return answer["y"]


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    # Small answers in two parts would wait for each other.
    disable_nagle_algorithm = True
    study, name, hosts = None, None, frozenset()

    def log_message(self, *_):
        pass

    def _is_foreign(self):
        """Whether a page of a browser asks, which has no business here: it says its origin, or a name that its owner points at this machine."""
        host = self.headers.get("Host", "").strip().lower()
        host = host[1:].partition("]")[0] if host.startswith("[") else host.partition(":")[0]
        if self.headers.get("Origin") is None and (host in self.hosts or _is_address(host)):
            return False
        self.close_connection = True
        self._send(403, _fault("Forbidden", "requests of pages, and for another host than this one, are not answered"))
        return True

    def do_GET(self):
        if self._is_foreign():
            return None
        if self.path != "/Info":
            return self._send(404, _fault("NotFound", f"there is no {self.path}"))
        return self._send(200, {"protocolVersion": PROTOCOL, "models": [self.name]})

    def do_POST(self):
        if self._is_foreign():
            return
        try:
            self._send(200, self._answer(self._body()))
        except Fault as fault:
            self._send(fault.status, _fault(fault.kind, str(fault)))

    def _body(self):
        length = self.headers.get("Content-Length", "0").strip()
        if not (length.isascii() and length.isdigit()) or len(length) > 12 or int(length) > LONGEST:
            # What follows on this connection is no request.
            self.close_connection = True
            raise Fault("InvalidInput", f"the length of the request must be a number up to {LONGEST}")
        return self.rfile.read(int(length))

    def _answer(self, body):
        try:
            asked = json.loads(body, parse_int=_integer)
        except RecursionError:
            raise Fault("ModelError", "the request is nested too deep", 500) from None
        except OverflowError:
            raise Fault("ModelError", "an integer of the request is beyond every double", 500) from None
        except ValueError:
            raise Fault("InvalidInput", "the request is not JSON") from None
        if not isinstance(asked, dict) or asked.get("name") != self.name:
            raise Fault("ModelNotFound", f"there is no such model; there is {self.name}")
        ready = self.study.ready
        if self.path == "/ModelInfo":
            support = {"Evaluate": True, "Gradient": False, "ApplyJacobian": False, "ApplyHessian": False}
            names = {key: ready[key] for key in ("dimensions", "units", "nominal", "characteristics")}
            return {"support": support, **names}
        if self.path == "/InputSizes":
            return {"inputSizes": [len(ready["dimensions"])]}
        if self.path == "/OutputSizes":
            return {"outputSizes": [len(ready["characteristics"])]}
        if self.path != "/Evaluate":
            raise Fault("UnsupportedFeature", f"{self.path[1:]} is not supported")
        given = asked.get("input")
        size = len(ready["dimensions"])
        if not isinstance(given, list) or len(given) != 1 or not isinstance(given[0], list) or len(given[0]) != size:
            raise Fault("InvalidInput", f"the input must be one vector of {size} numbers: {', '.join(ready['dimensions'])}")
        number = lambda value: isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
        if not all(map(number, given[0])):
            raise Fault("InvalidInput", "every value of the input must be a finite number")
        return {"output": [self.study.evaluate([float(value) for value in given[0]])]}

    def _send(self, status, answer):
        data = json.dumps(answer).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(data)))
        self.end_headers()
        self.wfile.write(data)


def _integer(text):
    """An integer of the request. Fails with `OverflowError` where no double is near it."""
    if math.isinf(float(text)):
        raise OverflowError(text[:20])
    # Python limits the digits of integers; those that a double holds are within that limit.
    return int(text)


def _is_address(host):
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def _fault(kind, message):
    return {"error": {"type": kind, "message": message}}


class Server(http.server.ThreadingHTTPServer):
    daemon_threads = True
    # The wait queue of connections; the default of 5 is short for a sampler with many threads.
    request_queue_size = 128


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("study", type=pathlib.Path, help="a study of sensitol, .toml or .json")
    parser.add_argument("--name", default=None, help="the name of the model (that of the study's folder)")
    parser.add_argument("--host", default="127.0.0.1", help="the address to listen at (%(default)s)")
    parser.add_argument("--port", type=int, default=4242, help="the port; 0 takes a free one (%(default)s)")
    asked = parser.parse_args()
    Handler.study = Study(asked.study)
    # A number is no name that could be pointed elsewhere, so that every one is taken.
    Handler.hosts = frozenset({"localhost", asked.host.lower(), socket.gethostname().lower(), socket.getfqdn().lower()})
    Handler.name = asked.name or asked.study.resolve().parent.name
    try:
        server = Server((asked.host, asked.port), Handler)
    except (OSError, OverflowError) as error:
        raise SystemExit(f"error: cannot listen at {asked.host}:{asked.port}: {error}") from None
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    print(f"{Handler.name}: UM-Bridge at http://{asked.host}:{server.server_address[1]}", flush=True)
    try:
        server.serve_forever()
    except KeyboardInterrupt:
        pass
    finally:
        Handler.study.process.stdin.close()


if __name__ == "__main__":
    main()
