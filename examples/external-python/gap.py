"""The gap of the stacked blocks, as a geometry evaluator that sensitol asks over JSON lines."""

import pathlib
import sys
from math import acos, cos, radians, sin, tan

# From this repository; `pip install adapters/python` makes the line unnecessary.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "adapters" / "python"))

from sensitol_adapter import NoValue, adapter


@adapter(version="1")
def gap(a, b, c, e, f, R, r, th):
    th = radians(th)
    if R * sin(th) + r >= R - r:
        raise NoValue("the cylinder does not touch the side wall")
    yR = c + e / cos(th) + (a - b) * tan(th) - R * sin(th) * tan(th)
    phi = acos((R * sin(th) + r) / (R - r))
    return f - r - yR + (R - r) * sin(phi)


if __name__ == "__main__":
    gap.serve()
