"""adapters/umbridge against the umbridge package on the other side: as server of a cantilever in closed form, and as client."""

import contextlib
import http.client
import json
import os
import pathlib
import random
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

from harness import EXAMPLES, ROOT, Client, binary, client, failed, journal, refused, report, run, sensitol, shown

CLIENT = ROOT / "adapters/umbridge/sensitol_umbridge.py"
SERVER = ROOT / "adapters/umbridge/sensitol_umbridge_server.py"
EXAMPLE = EXAMPLES / "cantilever-umbridge"
NOMINAL = {"F": 500.0, "E": 210000.0, "L": 400.0, "b": 20.0, "h": 30.0}
UNITS = ["N", "MPa", "mm", "mm", "mm"]
NAMES = ["deflection", "stress"]
# Relative. The same formulas in another order of operations.
CLOSE = 1e-14


def closed(F, E, L, b, h):
    """Deflection F L^3 / (3 E I) and stress M / W, by the second moment of area."""
    area_moment = b * h**3 / 12
    return F * L**3 / (3 * E * area_moment), F * L * (h / 2) / area_moment


def free_port():
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


@contextlib.contextmanager
def server(port=None, script=EXAMPLE / "server.py"):
    """The example's server by the umbridge package."""
    port = port or free_port()
    process = subprocess.Popen([sys.executable, script, str(port)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    try:
        for _ in range(300):
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{port}/Info", timeout=1).close()
                break
            except OSError:
                assert process.poll() is None, "the server ended"
                time.sleep(0.1)
        yield port, process
    finally:
        process.kill()
        process.wait()


def declared(folder, ports, **keys):
    text = (EXAMPLE / "server.toml").read_text()
    text = text.replace('"http://127.0.0.1:4242"', ", ".join(f'"http://127.0.0.1:{port}"' for port in ports))
    for key, value in keys.items():
        lines = [line for line in text.splitlines() if not line.startswith(f"{key} =")]
        text = "\n".join([f"{key} = {json.dumps(value)}", *lines]) if value is not None else "\n".join(lines)
    path = pathlib.Path(folder) / "server.toml"
    path.write_text(text)
    return path


def asked(path, names=NAMES, nominal=NOMINAL, units=UNITS):
    return client([sys.executable, CLIENT, path], path.parent, units, nominal, names)


def study(folder, path):
    """The example's study with this declaration."""
    text = (EXAMPLE / "study.toml").read_text().replace("../../adapters/umbridge/sensitol_umbridge.py", str(CLIENT))
    study = pathlib.Path(folder) / "study.toml"
    study.write_text(text)
    return study


def near(found, right):
    return all(abs(a - b) <= CLOSE * abs(b) for a, b in zip(found, right))


def every_point_is_that_of_the_closed_form():
    with tempfile.TemporaryDirectory() as folder, server() as (port, _):
        path = study(folder, declared(folder, [port]))
        sensitol("probe", path)
        for count, command in [(31, ["analyze", path]), (300, ["simulate", path, "--samples", "300"])]:
            kept = pathlib.Path(folder) / f"{count}.sqlite"
            sensitol(*command, "--journal", kept)
            rows = journal(kept)
            assert len(rows) >= count, len(rows)
            for row in rows:
                right = closed(**{name: row[name] for name in NOMINAL})
                assert near([row[name] for name in NAMES], right), (row, right)


def gradients_are_those_of_the_closed_form():
    with tempfile.TemporaryDirectory() as folder, server() as (port, _):
        with asked(declared(folder, [port], gradients=True)) as model:
            assert model.ready["gradients"], model.ready
            answer = model.point(**NOMINAL)
            while "y" not in answer:
                answer = json.loads(model.process.stdout.readline())
            values = closed(**NOMINAL)
            powers = [[1, -1, 3, -1, -3], [1, 0, 1, -1, -2]]
            for row, value, exponents in zip(answer["dy"], values, powers):
                assert near(row, [power * value / x for power, x in zip(exponents, NOMINAL.values())]), answer


def a_point_that_fails_is_an_error_of_its_own():
    with tempfile.TemporaryDirectory() as folder, server() as (port, _):
        with asked(declared(folder, [port])) as model:
            for _ in range(2):
                failed(final(model, **{**NOMINAL, "h": -1.0}))
                assert near(final(model, **NOMINAL)["y"], closed(**NOMINAL))


def final(model, **point):
    """The answer to a point, past signs of life and starts."""
    model.sent += 1
    model.process.stdin.write(json.dumps({"id": model.sent, "x": [point[name] for name in model.names]}) + "\n")
    model.process.stdin.flush()
    while True:
        line = json.loads(model.process.stdout.readline())
        if "y" in line or "error" in line:
            return line


def several_servers_share_the_work_and_one_may_end():
    chance = random.Random(2)
    with tempfile.TemporaryDirectory() as folder, server() as (first, one), server() as (second, _):
        with asked(declared(folder, [first, second])) as model:
            for index in range(40):
                point = {name: value * (1 + 0.1 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()}
                assert near(final(model, **point)["y"], closed(**point))
                if index == 20:
                    one.kill()
                    one.wait()


def a_server_that_starts_again_is_asked_again():
    with tempfile.TemporaryDirectory() as folder:
        with server() as (port, _):
            model = Client([sys.executable, CLIENT, declared(folder, [port])], folder, UNITS, NOMINAL, NAMES)
            assert near(final(model, **NOMINAL)["y"], closed(**NOMINAL))
        answer = final(model, **NOMINAL)
        failed(answer, "no server answers", str(port))
        assert answer["retry"], answer
        with server(port):
            assert near(final(model, **NOMINAL)["y"], closed(**NOMINAL))
        model.close()


def what_is_declared_wrongly_is_one_error():
    with tempfile.TemporaryDirectory() as folder, server() as (port, _):
        dead = free_port()
        for words, path in [
            (["`servers` is missing"], lambda: declared(folder, [port], servers=None)),
            (["no key `conections`", "`connections`"], lambda: declared(folder, [port], conections=2)),
            (["does not answer", str(dead)], lambda: declared(folder, [dead])),
            (["no model `beam`", "cantilever"], lambda: declared(folder, [port], model="beam")),
            (["inputs of sizes [2, 3]", "[1, 4]"], lambda: declared(folder, [port], inputs=[["F"], ["E", "L", "b", "h"]])),
            (["`t`", "[values]"], lambda: declared(folder, [port], inputs=[["F", "E"], ["L", "b", "t"]])),
        ]:
            with asked(path()) as model:
                refused(model, *words)
        with asked(declared(folder, [port]), names=["twist"]) as model:
            refused(model, "`twist`", "deflection")


@contextlib.contextmanager
def offered(path, *arguments):
    """The server of a study, and its address."""
    process = subprocess.Popen(
        [sys.executable, SERVER, path, "--port", "0", *arguments],
        stdout=subprocess.PIPE, text=True, env={**os.environ, "SENSITOL": binary()},
    )  # fmt: skip
    try:
        line = process.stdout.readline()
        assert "http://" in line, line
        yield line[line.index("http://") :].strip()
    finally:
        process.terminate()
        process.wait(timeout=20)
        process.stdout.close()


def a_study_is_a_model_of_the_umbridge_package():
    import umbridge

    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "fit.toml"
        path.write_text(FIT)
        with offered(path, "--name", "fit") as address:
            assert umbridge.supported_models(address) == ["fit"]
            model = umbridge.HTTPModel(address, "fit")
            assert model.supports_evaluate() and not model.supports_gradient()
            assert model.get_input_sizes() == [2] and model.get_output_sizes() == [2]
            for bore, shaft in [(25.01, 24.98), (25.3, 24.1), (24.0, 25.0)]:
                # One rounding each: the same everywhere.
                assert model([[bore, shaft]]) == [[bore - shaft, bore * shaft]]
            for wrong, words in [([[1.0]], "2 numbers"), ([[1.0], [2.0]], "one vector"), ([[1.0, "x"]], "finite number")]:
                raises(lambda: model(wrong), words)
            raises(lambda: umbridge.HTTPModel(address, "beam"), "fit")


FIT = """
[dimensions]
bore = { nominal = 25.02, tolerance = 0.02, unit = "mm" }
shaft = { nominal = 24.98, tolerance = 0.02, unit = "mm" }
[characteristics]
clearance = { formula = "bore - shaft" }
product = { formula = "bore * shaft" }
"""


def raises(action, *words):
    try:
        action()
    except Exception as error:
        assert all(word in str(error) for word in words), error
    else:
        raise AssertionError(f"no error with {words}")


def a_failing_point_is_the_servers_exception():
    import umbridge

    with offered(EXAMPLES / "stacked-blocks/study.toml") as address:
        model = umbridge.HTTPModel(address, "stacked-blocks")
        # 12 mm for R: the cylinder does not touch the wall.
        right = [10.0, 30.0, 31.9, 15.0, 55.0, 75.0, 10.0, 40.0, 10.0, 17.0]
        # Sadikhani and Hashemian 2018: 5.9974 at the nominal dimensions, to four decimals.
        assert abs(model([right])[0][0] - 5.9974) < 5.1e-5
        raises(lambda: model([[*right[:7], 12.0, *right[8:]]]), "ModelError", "gap")
        assert abs(model([right])[0][0] - 5.9974) < 5.1e-5


def both_directions_meet():
    """A study behind its own server, asked by the client of another study: the same report."""
    with tempfile.TemporaryDirectory() as folder, offered(EXAMPLES / "stacked-blocks/study.toml") as address:
        names = ["a", "b", "c", "d", "e", "f", "g", "R", "r", "th"]
        path = pathlib.Path(folder) / "server.toml"
        path.write_text(f'servers = "{address}"\ninputs = {json.dumps(names)}\noutputs = ["gap"]\n')
        text = (EXAMPLES / "stacked-blocks/study.toml").read_text()
        text = text[: text.index("[formulas]")] + text[text.index("[characteristics]") :]
        text = text.replace(text[text.index("formula =") : text.index("unit = \"mm\", lower")], "")
        there = pathlib.Path(folder) / "study.toml"
        there.write_text(text + f'\n[model]\ncommand = ["python3", "{CLIENT}", "server.toml"]\n')
        found, own = (
            report("analyze", study, "--method", "full", "--journal", "none", "--derivatives", "difference")[0]["characteristics"][0]
            for study in (there, EXAMPLES / "stacked-blocks/study.toml")
        )
        for key in ("mean", "sigma", "skewness", "kurtosis"):
            # Values travel as shortest decimals, bit for bit; differences of the same values are the same.
            assert found[key] == own[key], (key, found[key], own[key])


def spoken(port, body, **headers):
    """Status and error of a request with these headers."""
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.request("POST", "/Evaluate", body, headers)
    answer = connection.getresponse()
    found = json.loads(answer.read())
    connection.close()
    return answer.status, found.get("error", found)


def pages_are_not_answered():
    with offered(EXAMPLES / "stacked-blocks/study.toml", "--name", "blocks") as address:
        port = int(address.rpartition(":")[2])
        good = json.dumps({"name": "blocks", "input": [[10.0, 30.0, 31.9, 15.0, 55.0, 75.0, 10.0, 40.0, 10.0, 17.0]]})
        own = spoken(port, good)[1]
        # Sadikhani and Hashemian 2018, as above.
        assert abs(own["output"][0][0] - 5.9974) < 5.1e-5, own
        for host in (f"localhost:{port}", f"127.0.0.1:{port}", f"[::1]:{port}", "192.168.7.8"):
            assert spoken(port, good, Host=host)[1] == own, host
        for headers in ({"Host": "evil.example"}, {"Host": f"evil.example:{port}"}, {"Origin": "http://evil.example"}, {"Origin": "null"}):
            status, error = spoken(port, good, **headers)
            assert (status, error["type"]) == (403, "Forbidden"), (headers, status, error)


def what_python_cannot_read_is_one_error():
    with offered(EXAMPLES / "stacked-blocks/study.toml", "--name", "blocks") as address:
        port = int(address.rpartition(":")[2])
        deep, long = "[" * 200_000, "9" * 400
        for body, words in (
            (deep, "too deep"),
            (f'{{"name": "blocks", "input": [[{long}]]}}', "beyond every double"),
            (f'{{"name": "blocks", "input": [[-{"9" * 6000}]]}}', "beyond every double"),
        ):
            status, error = spoken(port, body)
            assert (status, error["type"]) == (500, "ModelError") and words in error["message"], (body[:60], status, error)
        for length in ("-1", "many", str(1 << 60)):
            status, error = spoken(port, "", **{"Content-Length": length})
            assert (status, error["type"]) == (400, "InvalidInput"), (length, status, error)
        # The server is as before.
        assert spoken(port, "no JSON")[1]["message"] == "the request is not JSON"


def the_command_line_of_the_server_refuses():
    for arguments, words in [
        ([EXAMPLES / "nowhere.toml"], "nowhere.toml"),
        ([EXAMPLES / "shaft-and-bore/study.toml", "--port", "70000"], "70000"),
        ([], "study"),
    ]:
        done = subprocess.run(
            [sys.executable, SERVER, *arguments], capture_output=True, text=True, timeout=60, check=False,
            env={**os.environ, "SENSITOL": binary()},
        )  # fmt: skip
        assert done.returncode != 0 and words in done.stderr and "Traceback" not in done.stderr, done.stderr


def a_program_that_ends_unasked_is_one_error():
    """The pipe to it may be broken before the first request."""
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "sensitol"
        program.write_text("#!/bin/sh\nexec 0<&-\necho 'error: it ends' >&2\nexit 3\n")
        program.chmod(0o755)
        done = subprocess.run(
            [sys.executable, SERVER, "study.toml"], capture_output=True, text=True, timeout=60, check=False,
            env={**os.environ, "SENSITOL": str(program)},
        )  # fmt: skip
    assert done.returncode != 0 and "it ends" in done.stderr and "Traceback" not in done.stderr, done.stderr


def the_readme_shows_it():
    with server(4242):
        shown("cantilever-umbridge")


if __name__ == "__main__":
    run([
        every_point_is_that_of_the_closed_form,
        gradients_are_those_of_the_closed_form,
        a_point_that_fails_is_an_error_of_its_own,
        several_servers_share_the_work_and_one_may_end,
        a_server_that_starts_again_is_asked_again,
        what_is_declared_wrongly_is_one_error,
        a_study_is_a_model_of_the_umbridge_package,
        a_failing_point_is_the_servers_exception,
        both_directions_meet,
        pages_are_not_answered,
        what_python_cannot_read_is_one_error,
        the_command_line_of_the_server_refuses,
        a_program_that_ends_unasked_is_one_error,
        the_readme_shows_it,
    ])  # fmt: skip
