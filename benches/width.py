"""Width of replays: wall time of an external model with them and with `verify = 0`. `python3 benches/width.py BINARY`; see README.md.

The model sleeps, so that workers do not compete for the processor. `full` of 14 dimensions takes 211 points, in one process for each place
or in one process with as many threads, each of which is a place of its own.
"""

import json
import pathlib
import subprocess
import sys
import tempfile

# Without the SDK: 64 programs start at once, and each is to be light.
MODEL = """
import json, os, queue, sys, threading, time
pause, places = float(sys.argv[1]), int(sys.argv[2])
json.loads(sys.stdin.readline())
lock = threading.Lock()
def say(message):
    with lock:
        sys.stdout.write(json.dumps(message) + "\\n")
        sys.stdout.flush()
say({"ready": True, "name": "sleeper", "window": places, "isolated": places > 1, "places": places})
def work(own, place):
    for point in iter(own.get, None):
        time.sleep(pause)
        answer = {"id": point["id"], "y": [sum(x * (1 + 0.01 * x) for x in point["x"])]}
        say({**answer, "where": place} if places > 1 else answer)
free = queue.Queue()
each = {f"p{k}": free if places == 1 else queue.Queue() for k in range(places)}
for place, own in each.items():
    threading.Thread(target=work, args=(own, place), daemon=True).start()
turn = 0
for line in sys.stdin:
    point = json.loads(line)
    names = list(each)
    each[point.get("place") or names[turn % len(names)]].put(point)
    turn += 1
"""
DIMENSIONS = 14


def measure(binary, pause, workers, places, verify):
    """Wall time in seconds and evaluations of `full`."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        (folder / "model.py").write_text(MODEL)
        command = [sys.executable, "-S", "model.py", str(pause), str(places)]
        lines = ["[model]", f"command = {json.dumps(command)}", f"workers = {workers}"]
        lines += ["verify = 0"] if not verify else []
        lines += ["[dimensions]", *(f"x{j} = {{ nominal = 1.0, sigma = 0.1 }}" for j in range(DIMENSIONS)), "[characteristics]", "y = {}"]
        (folder / "study.toml").write_text("\n".join(lines) + "\n")
        done = subprocess.run(
            [binary, "analyze", str(folder / "study.toml"), "--method", "full", "--journal", "none", "--json"],
            capture_output=True, text=True, check=False,
        )  # fmt: skip
        if done.returncode not in (0, 3):
            sys.exit(done.stderr)
        found = json.loads(done.stdout)
        return found["wall_s"], found["evaluations"]


def main():
    binary = sys.argv[1]
    print("| width | a point | `verify = 0` | with replays | ratio | allowed |\n|---|--:|--:|--:|--:|--:|")
    for title, workers, places in (("8 processes", 8, 1), ("64 processes", 64, 1), ("64 places of one process", 1, 64)):
        for pause in (0.05, 0.2):
            plain, _ = measure(binary, pause, workers, places, False)
            replayed, evaluations = measure(binary, pause, workers, places, True)
            # One walk: the nominal point and three steps. The start of a process is a part of both times.
            allowed = 1.15 * plain + 4 * pause
            print(
                f"| {title} | {1e3 * pause:.0f} ms | {plain:.2f} s | {replayed:.2f} s, {evaluations} evaluations "
                f"| {replayed / plain:.2f} | {allowed:.2f} s |",
                flush=True,
            )


if __name__ == "__main__":
    main()
