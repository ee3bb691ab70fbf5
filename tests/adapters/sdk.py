"""What the SDK does for adapters of documents; the suite's process tests have the rest of it."""

import pathlib
import tempfile
import time

from harness import ROOT, client, refused, run

MODEL = f"""
import sys, time
sys.path.insert(0, {str(ROOT / "adapters/python")!r})
from sensitol_adapter import Adapter

def setup(hello):
    served.outputs = ["sum"]
    served.inputs = ["a@b", "c"]
    served.units = {{"a@b": "mm"}}
    served.version = len(hello["dimensions"])

def total(**values):
    print("noise")
    time.sleep(0.3)
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


def slow_answers_do_not_wait_for_each_other():
    with tempfile.TemporaryDirectory() as folder, asked(folder, ["mm"], {"a@b": 1.0}) as model:
        lines = "".join(f'{{"id":{id},"x":[{id}.0]}}\n' for id in range(4))
        model.process.stdin.write(lines)
        model.process.stdin.flush()
        came = []
        for _ in range(4):
            model.process.stdout.readline()
            came.append(time.monotonic())
        # Together they would come at once; a third of the sleep is a margin for a busy machine.
        assert came[-1] - came[0] > 0.3, came


if __name__ == "__main__":
    run([setup_may_say_what_there_is, slow_answers_do_not_wait_for_each_other])
