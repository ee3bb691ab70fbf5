"""A quick child that says who it is: `storm.py FOLDER SECONDS` leaves a file in FOLDER named after its process, and answers sums."""

import json
import os
import pathlib
import sys
import time

pathlib.Path(sys.argv[1], str(os.getpid())).touch()
seconds = float(sys.argv[2])
hello = json.loads(sys.stdin.readline())
print(json.dumps({"ready": True, "name": "storm", "version": "1", "window": 2}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    time.sleep(seconds)
    x = request["x"]
    y = sum((index + 1) * value for index, value in enumerate(x)) + 0.01 * x[0] * x[1]
    print(json.dumps({"id": request["id"], "y": [y] * len(hello["characteristics"])}), flush=True)
