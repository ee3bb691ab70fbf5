"""A slow child that counts its evaluations in a file, the nominal point excepted: `counting.py FILE SECONDS WINDOW`."""

import json
import os
import sys
import time

counter = os.open(sys.argv[1], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
seconds, window = float(sys.argv[2]), int(sys.argv[3])
hello = json.loads(sys.stdin.readline())
print(json.dumps({"ready": True, "name": "counting", "version": "1", "window": window}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    time.sleep(seconds)
    x = request["x"]
    # The engine asks for the nominal point again and again, to see whether the answer is still the same.
    if x != hello["nominal"]:
        os.write(counter, b".")
    y = sum((index + 1) * value for index, value in enumerate(x)) + 0.01 * x[0] * x[1]
    print(json.dumps({"id": request["id"], "y": [y] * len(hello["characteristics"])}), flush=True)
