"""The gap of the stacked blocks, with a pause for what a CAD system would take: `python3 gap.py [SECONDS]`."""

import pathlib
import sys
import time
from math import acos, cos, radians, sin, tan

# From this repository; `pip install adapters/python` makes the line unnecessary.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "adapters" / "python"))

from sensitol_adapter import NoValue, adapter

SECONDS = float(sys.argv[1]) if len(sys.argv) > 1 else 0.0


@adapter(version="1")
def gap(a, b, c, e, f, R, r, th):
    time.sleep(SECONDS)
    th = radians(th)
    if R * sin(th) + r >= R - r:
        raise NoValue("the cylinder does not touch the side wall")
    yR = c + e / cos(th) + (a - b) * tan(th) - R * sin(th) * tan(th)
    phi = acos((R * sin(th) + r) / (R - r))
    return f - r - yR + (R - r) * sin(phi)


if __name__ == "__main__":
    gap.serve()
