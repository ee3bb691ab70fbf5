"""A child that answers a + b and a * b, and misbehaves in the way that its first argument says.

The point with a = 13 is the one at which it does, where a point matters. No SDK: what goes over the wire is under test.
"""

import json
import os
import pathlib
import subprocess
import sys
import time

mode = sys.argv[1]
extra = sys.argv[2:]
out = sys.stdout


def say(line):
    out.write(line if isinstance(line, str) else json.dumps(line))
    out.write("\n")
    out.flush()


def once():
    """True for the first child only: the second argument is a file that remembers."""
    path = pathlib.Path(extra[0])
    first = not path.exists()
    path.touch()
    return first


if mode == "crash-at-start":
    sys.stderr.write("licence server not found\n")
    sys.exit(7)
if mode == "silent-exit":
    sys.exit(0)
if mode == "never-ready":
    time.sleep(60)
if mode == "talks-first":
    say("Loading CAD kernel 7.3 ...")
if mode == "answers-first":
    say({"id": 0, "y": [1.0, 2.0]})

first = mode.startswith("first-lies") and once()
hello = json.loads(sys.stdin.readline())
if mode == "refuses":
    say({"error": "no dimension `b`; there are a, c"})
    sys.exit(0)
if mode == "other-version":
    say({"sensitol": 2, "ready": True})
if mode == "grandchild":
    subprocess.Popen(["sleep", extra[0]])
    subprocess.Popen(["sh", "-c", f"sleep {extra[0]} & wait"])
if mode == "escaped":
    # In a session of its own, in a group of its own, and with a parent that is gone.
    subprocess.Popen(["sleep", extra[0]], start_new_session=True)
    subprocess.Popen(["sh", "-c", f"sleep {extra[0]} & wait"], process_group=0)
    subprocess.Popen(["sh", "-c", f"sleep {extra[0]} &"], start_new_session=True).wait()

window = int(extra[-1]) if mode in ("out-of-order", "crash-in-window", "hang-in-window", "echo") else 1
say({"ready": True, "name": "test child", "version": 3, "window": window, "unknown key": None})
if mode == "closes-stdout":
    os.close(1)
    time.sleep(60)
if mode == "never-reads":
    time.sleep(60)
if mode == "dies-idle":
    sys.exit(3)

waiting = []
flipped = False
for line in sys.stdin:
    request = json.loads(line)
    id, (a, b) = request["id"], request["x"]
    answer = {"id": id, "y": [a + b, a * b][: len(hello["characteristics"])]}
    if mode == "slow":
        time.sleep(float(extra[0]))
    if mode == "out-of-order":
        # The last of a batch first.
        waiting.append(answer)
        if len(waiting) == window or a == 99:
            for answer in reversed(waiting):
                say(answer)
            waiting = []
        continue
    # A solver that settles in the mirrored assembly, and stays there; or one that drifts.
    if mode == "flips":
        flipped = flipped or a == 13
        if flipped:
            answer["y"][0] = -answer["y"][0]
    if mode == "always-flips" and len(waiting) > 0:
        answer["y"][0] += len(waiting)
    if mode == "always-flips":
        waiting.append(id)
    if mode == "misshapen-later":
        flipped = flipped or a == 13
        if flipped and request["x"] == hello["nominal"]:
            answer["y"] = []
    if mode == "poisoned-by-errors":
        flipped = flipped or a == 13
        if a == 13:
            answer = {"id": id, "error": "does not assemble"}
        elif flipped:
            answer["y"][1] += 1e-3
    # The first process of all says something else off the nominal point; or at the thirteenth only, and all are astray after the 99th.
    if mode == "first-lies" and first and request["x"] != hello["nominal"]:
        answer["y"] = [value + 7 for value in answer["y"]]
    if mode == "first-lies-once":
        flipped = flipped or a == 99
        if first and a == 13 or flipped and request["x"] == hello["nominal"]:
            answer["y"] = [value + 7 for value in answer["y"]]
    if a == 13:
        if mode == "crash" or mode == "crash-in-window":
            sys.stderr.write("Segmentation fault in sketch solver\n")
            os._exit(139)
        elif mode == "crash-once-and-for-all":
            os.remove(__file__)
            os._exit(1)
        elif mode == "crash-once":
            if once():
                os.kill(os.getpid(), 9)
        elif mode == "drip":
            # An answer without an end, a byte at a time.
            while True:
                out.write("1")
                out.flush()
                time.sleep(0.02)
        elif mode == "hang" or mode == "hang-in-window":
            time.sleep(60)
        elif mode == "garbage":
            say("warning: recompute failed")
        elif mode == "garbage-once" and once():
            say('{"id": ' + str(id) + ', "y": [1.0')
        elif mode == "huge-line":
            out.write("x" * (100 << 20))
            out.flush()
        elif mode == "nan-text":
            say('{"id": %d, "note": "a \\"NaN", "y": [-Infinity, 1.0]}' % id)
            continue
        elif mode == "wrong-length":
            answer["y"] = [1.0, 2.0, 3.0]
        elif mode == "wrong-gradients":
            answer["dy"] = [[1.0, 1.0]]
        elif mode == "no-answer":
            answer = {"id": id}
        elif mode == "wrong-id":
            answer["id"] = id + 1000
        elif mode == "twice":
            say(answer)
        elif mode == "partial":
            answer = {"id": id, "y": [a + b, None], "errors": {"product": "face 7 is gone"}}
        elif mode == "null":
            answer = {"id": id, "y": [None, a * b]}
        elif mode == "error":
            answer = {"id": id, "error": "sketch does not solve: redundant constraint 7", "retry": False}
        elif mode == "error-once":
            if once():
                answer = {"id": id, "error": "licence busy", "retry": True}
        elif mode == "error-always":
            answer = {"id": id, "error": "licence busy", "retry": True}
    say(answer)
