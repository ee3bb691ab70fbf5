"""The Dask adapter by itself: efficiency, overhead, many workers, many points. `python3 benches/cluster.py`; see README.md.

The model sleeps, so that workers do not compete for the processor.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
# Without the SDK: 64 programs start at once, and each is to be light.
MODEL = """
import json, sys, time
json.loads(sys.stdin.readline())
print('{"ready":true,"name":"sleeper"}', flush=True)
for line in sys.stdin:
    point = json.loads(line)
    time.sleep(float(sys.argv[1]))
    print(json.dumps({"id": point["id"], "y": [point["x"][0]]}), flush=True)
"""


def measure(title, cluster, count, seconds, threads, window=None):
    """Seconds from the first request to the last answer, and the adapter's memory at its peak."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "model.py").write_text(MODEL)
        adapter = [sys.executable, str(ROOT / "adapters/dask/sensitol_dask.py"), "--cluster", cluster, "--linger", "1", "--"]
        process = subprocess.Popen(
            [*adapter, sys.executable, "-S", "model.py", str(seconds)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=folder,
        )  # fmt: skip
        hello = {"sensitol": 1, "dimensions": ["a"], "units": [None], "nominal": [0.0], "constants": {}, "characteristics": ["a"], "optional": []}
        begun = time.monotonic()
        send(process, [hello])
        ready = json.loads(process.stdout.readline())
        assert ready.get("ready"), ready
        started = time.monotonic() - begun
        # Every program has one point first: 64 of them start on a machine with two cores.
        send(process, [{"id": k, "x": [float(k)]} for k in range(2 * threads)])
        answers(process, 2 * threads)
        memory = [peak(process.pid)]
        begun = time.monotonic()
        send(process, [{"id": 10**6 + k, "x": [float(k)]} for k in range(count)])
        answers(process, count)
        took = time.monotonic() - begun
        memory.append(peak(process.pid))
        process.stdin.close()
        process.wait()
    ideal = count * seconds / threads
    print(
        f"{title}: {count} points, ready after {started:.1f} s, {took:.2f} s where {ideal:.2f} s are ideal"
        + (f" ({100 * ideal / took:.0f} %)" if ideal else f" ({1e3 * took / count:.2f} ms a point)")
        + f", memory {memory[0]:.0f} and then {memory[1]:.0f} MB",
        flush=True,
    )


def send(process, lines):
    process.stdin.write("".join(json.dumps(line) + "\n" for line in lines))
    process.stdin.flush()


def answers(process, count):
    while count:
        count -= '"y"' in process.stdout.readline()


def peak(pid):
    """In MB."""
    text = pathlib.Path(f"/proc/{pid}/status").read_text()
    return next(int(line.split()[1]) for line in text.splitlines() if line.startswith("VmHWM")) / 1024


if __name__ == "__main__":
    measure("two workers, 50 ms", "local:2", 211, 0.05, 2)
    measure("two workers, no work", "local:2", 5000, 0.0, 2)
    measure("64 threads in 4 workers, 1 s", "local:4x16", 1280, 1.0, 64)
    measure("10,000 points queued, 2 ms", "local:2", 10_000, 0.002, 2)
