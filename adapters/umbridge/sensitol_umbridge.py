"""A UM-Bridge server as a model: `python3 sensitol_umbridge.py DECLARATION.toml`, see README.md.

Needs nothing but Python: UM-Bridge is JSON over HTTP (https://um-bridge-benchmarks.readthedocs.io).
"""

import http.client
import json
import pathlib
import queue
import sys
import time
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from sensitol_adapter import Adapter, NoValue, Settings

VERSION = "1"
PROTOCOL = 1.0
KEYS = ("servers", "model", "inputs", "outputs", "values", "config", "connections", "gradients", "timeout_s")
# How long a server that did not answer is left alone.
REST_S = 2.0
# Requests that wait in the window for each connection: the next one is there when an answer goes out.
AHEAD = 2


class Declared:
    """What the file says: where the servers are, and what the positions of inputs and outputs are called."""

    def __init__(self, path):
        file = Settings(path, KEYS)
        self.path, table = file.path, file.table
        self.servers = table.get("servers")
        if isinstance(self.servers, str):
            self.servers = [self.servers]
        if not self.servers or not all(isinstance(one, str) for one in self.servers):
            raise ValueError(f'{path}: `servers` is missing: a list of addresses such as "http://localhost:4242"')
        for server in self.servers:
            if urllib.parse.urlsplit(server).scheme not in ("http", "https"):
                raise ValueError(f'{path}: `{server}` in `servers` is not an address such as "http://localhost:4242"')
        self.inputs = self._names(path, table, "inputs")
        self.outputs = self._names(path, table, "outputs")
        self.model = table.get("model")
        self.values = table.get("values", {})
        self.config = table.get("config", {})
        self.gradients = table.get("gradients", False)
        self.timeout_s = table.get("timeout_s", 3600.0)
        self.connections = table.get("connections", 1)
        known = [name for vector in self.inputs for name in vector]
        for name, value in self.values.items():
            if name not in known:
                raise ValueError(f"{path}: `{name}` in [values] is not among `inputs`: {', '.join(known)}")
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise ValueError(f"{path}: `{name}` in [values] must be a number")
        if isinstance(self.connections, bool) or not isinstance(self.connections, int) or self.connections < 1:
            raise ValueError(f"{path}: `connections` must be a whole number above 0")

    @staticmethod
    def _names(path, table, key):
        vectors = table.get(key)
        if isinstance(vectors, list) and vectors and all(isinstance(name, str) for name in vectors):
            vectors = [vectors]
        if not isinstance(vectors, list) or not vectors or not all(isinstance(one, list) for one in vectors):
            raise ValueError(f'{path}: `{key}` is missing: the names in the shape of the model, such as [["a", "b"], ["c"]]')
        names = [name for vector in vectors for name in vector]
        for name in names:
            if not isinstance(name, str) or names.count(name) > 1:
                raise ValueError(f"{path}: `{key}` names {name!r} twice or not as text")
        return vectors


class Connection:
    """One kept-alive connection, used by one thread at a time."""

    def __init__(self, server, timeout_s):
        self.server = server
        parts = urllib.parse.urlsplit(server)
        kind = http.client.HTTPSConnection if parts.scheme == "https" else http.client.HTTPConnection
        self.http = kind(parts.hostname, parts.port, timeout=timeout_s)
        self.base = parts.path.rstrip("/")
        self.rests_until = 0.0

    def ask(self, path, body=None):
        """The JSON answer. `OSError` where there is no server, `NoValue` where it has no answer to this."""
        method, data, headers = "GET", None, {}
        if body is not None:
            method, data, headers = "POST", json.dumps(body).encode(), {"Content-Type": "application/json"}
        for attempt in (1, 2):
            opened = self.http.sock is None
            try:
                self.http.request(method, self.base + path, data, headers)
                response = self.http.getresponse()
                text = response.read()
                break
            except TimeoutError as error:
                self.http.close()
                raise NoValue(f"{self.server}{path} did not answer in {self.http.timeout:g} s", retry=True) from error
            except (http.client.HTTPException, OSError) as error:
                self.http.close()
                # A kept connection may have been closed by the server meanwhile: that is no failure.
                if opened or attempt == 2:
                    raise ConnectionError(f"{self.server} does not answer: {error or type(error).__name__}") from error
        try:
            answer = json.loads(text)
        except ValueError:
            shown = text[:120].decode("utf-8", "replace")
            raise NoValue(f"{self.server}{path} answered status {response.status} and no JSON: {shown!r}") from None
        if isinstance(answer, dict) and "error" in answer:
            error = answer["error"] if isinstance(answer["error"], dict) else {"message": answer["error"]}
            raise NoValue(f"{error.get('type', 'error')}: {error.get('message', 'no message')}")
        if response.status != 200:
            raise NoValue(f"{self.server}{path} answered status {response.status}")
        return answer


class Servers:
    """All connections; a point goes to one that is free and whose server answers."""

    def __init__(self, declared):
        self.declared = declared
        self.free = queue.SimpleQueue()
        self.all = [Connection(one, declared.timeout_s) for _ in range(declared.connections) for one in declared.servers]

    def start(self):
        """Checks every server: version, model, sizes of inputs and outputs."""
        declared = self.declared
        for connection in self.all[: len(declared.servers)]:
            info = connection.ask("/Info")
            if info.get("protocolVersion") != PROTOCOL:
                raise ValueError(f"{connection.server} speaks UM-Bridge {info.get('protocolVersion')}; this adapter speaks {PROTOCOL}")
            models = info.get("models", [])
            if declared.model is None and len(models) == 1:
                declared.model = models[0]
            if declared.model not in models:
                wanted = "`model` must be stated" if declared.model is None else f"no model `{declared.model}`"
                raise ValueError(f"{wanted}; {connection.server} has {', '.join(models) or 'none'}")
            named = {"name": declared.model, "config": declared.config}
            support = connection.ask("/ModelInfo", named).get("support", {})
            for feature, needed in (("Evaluate", True), ("Gradient", declared.gradients)):
                if needed and not support.get(feature):
                    raise ValueError(f"model `{declared.model}` of {connection.server} does not support {feature}")
            for key, path, names in (("inputSizes", "/InputSizes", declared.inputs), ("outputSizes", "/OutputSizes", declared.outputs)):
                sizes = connection.ask(path, named).get(key)
                if sizes != [len(vector) for vector in names]:
                    kind = path[1:-5].lower()
                    raise ValueError(
                        f"model `{declared.model}` has {kind}s of sizes {sizes}, and `{kind}s` of the declaration "
                        f"{[len(vector) for vector in names]}"
                    )
        for connection in self.all:
            self.free.put(connection)

    def ask(self, path, body):
        """From the first server that answers; a server that does not is left alone for a while."""
        last = None
        for attempt in range(2 * len(self.all)):
            connection = self.free.get()
            try:
                pause = connection.rests_until - time.monotonic()
                if pause > 0:
                    # Another one first; where there is none, this one once more.
                    if attempt < len(self.all):
                        continue
                    time.sleep(pause)
                return connection.ask(path, body)
            except ConnectionError as error:
                connection.rests_until = time.monotonic() + REST_S
                last = error
            finally:
                self.free.put(connection)
        raise NoValue(f"no server answers; {last}", retry=True)

    def evaluate(self, **given):
        """The values at a point, and its derivatives where they are wanted."""
        declared = self.declared
        point = [[given.get(name, declared.values.get(name)) for name in vector] for vector in declared.inputs]
        body = {"name": declared.model, "input": point, "config": declared.config}
        output = self.ask("/Evaluate", body).get("output")
        shape = [len(vector) for vector in declared.outputs]
        if not isinstance(output, list) or [len(vector) if isinstance(vector, list) else 1 for vector in output] != shape:
            raise NoValue(f"the answer has not the sizes {shape} of the model's outputs")
        values = {name: value for names, vector in zip(declared.outputs, output) for name, value in zip(names, vector)}
        if not declared.gradients:
            return values
        derivatives = {}
        for row, names in enumerate(declared.outputs):
            for place, name in enumerate(names):
                sens = [1.0 if index == place else 0.0 for index in range(len(names))]
                found = {}
                for column, inputs in enumerate(declared.inputs):
                    asked = {**body, "outWrt": row, "inWrt": column, "sens": sens}
                    gradient = self.ask("/Gradient", asked).get("output")
                    if not isinstance(gradient, list) or len(gradient) != len(inputs):
                        raise NoValue(f"the gradient of `{name}` by input {column} has not {len(inputs)} values")
                    found.update((one, value) for one, value in zip(inputs, gradient) if one in given)
                derivatives[name] = found
        return values, derivatives


def main():
    """Everything is read in `setup`, so that every fault reaches the engine as one line."""

    def setup(hello):
        if len(sys.argv) != 2:
            raise ValueError(f"the command needs one argument, a declaration such as server.toml; it has {len(sys.argv) - 1}")
        declared = Declared(sys.argv[1])
        inputs = [name for vector in declared.inputs for name in vector]
        given = [*hello["dimensions"], *hello.get("constants", {})]
        for name in inputs:
            if name not in given and name not in declared.values:
                raise ValueError(f"input `{name}` is neither in the study nor in [values] of {declared.path}")
        servers.append(Servers(declared))
        servers[0].start()
        adapter.name, adapter.version = declared.model, f"{VERSION}; UM-Bridge {PROTOCOL}"
        adapter.inputs, adapter.outputs = inputs, [name for vector in declared.outputs for name in vector]
        adapter.gradients = declared.gradients
        threads = len(servers[0].all)
        adapter.threads, adapter.window = max(threads, 2), AHEAD * threads

    def evaluate(**values):
        return servers[0].evaluate(**values)

    servers = []
    adapter = Adapter(evaluate, name="UM-Bridge", heartbeat=5, isolated=True, setup=setup)
    adapter.serve()


if __name__ == "__main__":
    main()
