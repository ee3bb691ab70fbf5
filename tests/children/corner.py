"""A child that answers a + b - c, and has no value in a corner of the bands: `corner.py EDGE`, with (a - 10) + (b - 10) above EDGE."""

import json
import sys

edge = float(sys.argv[1])
hello = json.loads(sys.stdin.readline())
print(json.dumps({"ready": True, "name": "corner", "version": "1"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    a, b, c = request["x"]
    y = None if (a - 10) + (b - 10) > edge else a + b - c
    print(json.dumps({"id": request["id"], "y": [y]}), flush=True)
