"""What the tests of the adapters share: the command line, a client of the protocol without the engine, assertions."""

import contextlib
import csv
import io
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"


def binary():
    """The program under test: SENSITOL, or the newest that was built here."""
    if "SENSITOL" in os.environ:
        return os.environ["SENSITOL"]
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    built = [path for path in (target / "debug/sensitol", target / "release/sensitol") if path.exists()]
    if not built:
        sys.exit("tests/adapters: there is no sensitol; `cargo build` makes one, or SENSITOL names it")
    return str(max(built, key=lambda path: path.stat().st_mtime))


def sensitol(*arguments, code=0, timeout=300):
    """Runs it and returns (stdout, stderr); any other exit code than this one is an error."""
    command = [binary(), *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout, cwd=ROOT, check=False)
    assert done.returncode == code, f"{command} ended with {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return done.stdout, done.stderr


def report(*arguments, **options):
    """Its JSON report, and what it says to stderr."""
    text, errors = sensitol(*arguments, "--json", **options)
    return json.loads(text), errors


def journal(path):
    """The points of a journal as dicts of numbers; what has no value is left out."""
    rows = csv.DictReader(io.StringIO(sensitol("journal", "export", path)[0]))
    return [{key: float(value) for key, value in row.items() if value and not key.endswith("error")} for row in rows]


class Client:
    """An adapter, asked line by line."""

    def __init__(self, command, folder, units, nominal, characteristics, env=None):
        self.names = list(nominal)
        self.process = subprocess.Popen(
            [str(part) for part in command],
            cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            env={**os.environ, **(env or {})}, start_new_session=True,
        )  # fmt: skip
        hello = {
            "sensitol": 1, "dimensions": self.names, "units": units, "nominal": list(nominal.values()),
            "constants": {}, "characteristics": characteristics,
        }  # fmt: skip
        self.ready = self.say(hello)
        self.sent = 0

    def say(self, line):
        self.process.stdin.write(json.dumps(line) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        assert answer, f"no answer to {line}: {self.process.stderr.read()}"
        return json.loads(answer)

    def point(self, **values):
        self.sent += 1
        answer = self.say({"id": self.sent, "x": [values[name] for name in self.names]})
        assert answer["id"] == self.sent, answer
        return answer

    def close(self):
        self.process.stdin.close()
        self.process.wait(timeout=20)
        self.process.stdout.close()
        self.process.stderr.close()


@contextlib.contextmanager
def client(*arguments, **options):
    found = Client(*arguments, **options)
    try:
        yield found
    finally:
        found.close()


def refused(found, *words):
    """The handshake ended in one error with all of these words."""
    assert set(found.ready) == {"error"}, found.ready
    for word in words:
        assert word in found.ready["error"], f"{word!r} is not in {found.ready['error']!r}"


def failed(answer, *words):
    """A point without values, for a reason with all of these words."""
    text = answer.get("error") or " ".join(answer.get("errors", {}).values())
    assert text, answer
    for word in words:
        assert word in text, f"{word!r} is not in {text!r}"


def shown(example):
    """The README of an example shows what the program prints: each console block is run again.

    Lines may change places (rows of equal shares do), the last digits of a kernel's numbers are its own, an error or a
    bound that is estimated from them is alike within a factor of two, a figure is alike in the decimals that both have,
    and how many sentinels there are depends on which process was free. With SENSITOL_UPDATE_DOCS=1 a block that differs is renewed.
    """
    readme = EXAMPLES / example / "README.md"
    text = readme.read_text(encoding="utf-8")
    blocks = [part.split("```", 1)[0] for part in text.split("```console\n")[1:]]
    assert blocks, f"{example} shows nothing"
    for block in blocks:
        command, expected = block.split("\n", 1)
        assert command.startswith("$ sensitol "), command
        out, errors = sensitol(*command.split()[2:])
        difference = _difference(expected, out + errors)
        if difference and os.environ.get("SENSITOL_UPDATE_DOCS"):
            text = text.replace(block, f"{command}\n{out}{errors}")
            readme.write_text(text, encoding="utf-8")
            difference = None
        assert difference is None, f"{example}: `{command}` {difference}"


def _difference(expected, printed):
    lines = [sorted(line.split() for line in text.splitlines() if line.strip()) for text in (expected, printed)]
    if len(lines[0]) != len(lines[1]):
        return f"prints\n{printed}"
    for kept, found in zip(*lines):
        before = [None, *kept]
        if len(kept) != len(found) or not all(map(_alike, kept, found, before, [kept] * len(kept))):
            return f"prints\n{' '.join(found)}\nand the README has\n{' '.join(kept)}"
    return None


def _alike(kept, found, before, line):
    kept, found = kept.strip("(),;:"), found.strip("(),;:")
    if kept == found:
        return True
    decimals = [len(text.partition(".")[2]) if text.replace(".", "", 1).isdigit() else None for text in (kept, found)]
    try:
        kept, found = float(kept), float(found)
    except ValueError:
        return False
    if before in ("±", "<"):
        return kept / 2 <= found <= 2 * kept
    if decimals[0] != decimals[1] and None not in decimals:
        # The error says how many are printed.
        return abs(kept - found) < 10 ** -min(decimals)
    counted = any(word.startswith("evaluation") for word in line)
    return abs(kept - found) <= (4 if counted else 1e-7 + 1e-5 * abs(kept))


def run(tests):
    """Runs these functions and names them."""
    for test in tests:
        test()
        print(f"  ok    {test.__name__.replace('_', ' ')}", flush=True)
