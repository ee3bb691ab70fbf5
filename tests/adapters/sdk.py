"""What the SDK does for adapters of documents; the suite's process tests have the rest of it."""

import json
import pathlib
import socket
import tempfile

from harness import ROOT, client, refused, run

MODEL = f"""
import os, sys, time
sys.path.insert(0, {str(ROOT / "adapters/python")!r})
from sensitol_adapter import Adapter

def setup(hello):
    served.outputs = ["sum"]
    served.inputs = ["a@b", "c"]
    served.units = {{"a@b": "mm"}}
    served.version = len(hello["dimensions"])

def total(**values):
    print("noise")
    time.sleep(0.05)
    for _ in range(400 if values["a@b"] == 2 else 0):
        if os.path.exists("go"):
            break
        time.sleep(0.05)
    else:
        if values["a@b"] == 2:
            raise RuntimeError("the first answer was held back")
    return {{"sum": sum(values.values())}}

served = Adapter(total, setup=setup)
served.serve()
"""


def asked(folder, units, nominal, names=("sum",)):
    path = pathlib.Path(folder) / "model.py"
    path.write_text(MODEL)
    return client(["python3", path], folder, units, nominal, list(names))


def setup_may_say_what_there_is():
    with tempfile.TemporaryDirectory() as folder:
        with asked(folder, ["mm", None], {"a@b": 1.0, "c": 2.0}) as model:
            assert model.ready["version"] == "2", model.ready
            assert model.point(**{"a@b": 1.5, "c": 2.0})["y"] == [3.5]
        with asked(folder, ["in"], {"a@b": 1.0}) as model:
            refused(model, "`a@b` is in `in` in the study and in `mm` here")
        with asked(folder, [None], {"d": 1.0}) as model:
            refused(model, "`d`", "a@b, c")
        with asked(folder, ["mm"], {"a@b": 1.0}, ["product"]) as model:
            refused(model, "`product`", "sum")


def a_slow_answer_does_not_wait_for_the_next():
    with tempfile.TemporaryDirectory() as folder, asked(folder, ["mm"], {"a@b": 1.0}) as model:
        model.process.stdin.write('{"id":1,"x":[1.0]}\n{"id":2,"x":[2.0]}\n')
        model.process.stdin.flush()
        assert json.loads(model.process.stdout.readline()) == {"id": 1, "y": [1.0]}
        # The second point waits for this file, and gives up after a while.
        pathlib.Path(folder, "go").touch()
        assert json.loads(model.process.stdout.readline()) == {"id": 2, "y": [2.0]}


def imported_modules_are_part_of_the_version():
    with tempfile.TemporaryDirectory() as folder:
        path, helper = pathlib.Path(folder) / "model.py", pathlib.Path(folder) / "helper.py"
        source = f"import sys\nsys.path[:0] = [{str(ROOT / 'adapters/python')!r}, '.']\nimport helper\n"
        path.write_text(source + "from sensitol_adapter import adapter\n@adapter(version=3)\ndef y(a):\n    return helper.f(a)\ny.serve()\n")
        versions = []
        for content in ("f = abs\n", "f = abs \n", "f = abs\n"):
            helper.write_text(content)
            with client(["python3", path], folder, [None], {"a": 1.0}, ["y"]) as model:
                versions.append(model.ready["version"])
        assert versions[0] == versions[2] != versions[1] and versions[0].startswith("3; modules "), versions


BEATING = f"""
import sys, time
sys.path.insert(0, {str(ROOT / "adapters/python")!r})
from sensitol_adapter import adapter

@adapter(heartbeat=0.02, isolated=True)
def sum(a, b):
    time.sleep(0.3)
    return a + b

sum.serve()
"""


def a_heartbeat_beats_while_the_model_works():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "model.py"
        path.write_text(BEATING)
        with client(["python3", path], folder, [None, None], {"a": 1.0, "b": 2.0}, ["sum"]) as model:
            assert model.ready["heartbeat"] and model.ready["isolated"], model.ready
            model.process.stdin.write('{"id":4,"x":[1.0,2.5]}\n{"cancel":[9]}\n')
            model.process.stdin.flush()
            lines = []
            while not lines or "y" not in lines[-1]:
                lines.append(json.loads(model.process.stdout.readline()))
            host = socket.gethostname()
            started = lines.index({"id": 4, "started": host})
            assert {"alive": True} in lines[started:], lines
            assert lines[-1]["y"] == [3.5] and lines[-1]["where"] == host and lines[-1]["cost_s"] >= 0.3, lines[-1]


SIDE_BY_SIDE = f"""
import sys, threading
sys.path.insert(0, {str(ROOT / "adapters/python")!r})
from sensitol_adapter import adapter

both = threading.Barrier(2, timeout=30)

@adapter(threads=2)
def twice(a):
    if a < 0:
        raise RuntimeError("negative")
    both.wait()
    return 2 * a

twice.serve()
"""


def threads_evaluate_side_by_side():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "model.py"
        path.write_text(SIDE_BY_SIDE)
        with client(["python3", path], folder, [None], {"a": 1.0}, ["twice"]) as model:
            # Neither of two points ends before the other has begun; the one that fails waits for none.
            model.process.stdin.write('{"id":1,"x":[1.0]}\n{"id":2,"x":[2.0]}\n{"id":3,"x":[-1.0]}\n')
            model.process.stdin.flush()
            answers = {answer["id"]: answer for answer in (json.loads(model.process.stdout.readline()) for _ in range(3))}
            assert answers[1]["y"] == [2.0] and answers[2]["y"] == [4.0] and "negative" in answers[3]["error"], answers


if __name__ == "__main__":
    run([threads_evaluate_side_by_side, imported_modules_are_part_of_the_version, a_heartbeat_beats_while_the_model_works, setup_may_say_what_there_is, a_slow_answer_does_not_wait_for_the_next])
