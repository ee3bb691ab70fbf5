"""Exact figures of the studies in tests/data/discrete: by counting whole numbers, and by closed forms.

Usage: python3 discrete.py > ../discrete.json
"""

import csv
import itertools
import json
import math
from fractions import Fraction
from pathlib import Path

FOLDER = Path(__file__).parent.parent / "discrete"


def share(values, lower, upper):
    """The share of whole numbers within limits, ends included."""
    return float(Fraction(sum(lower <= value <= upper for value in values), len(values)))


def two_windows():
    # Four parts of 9 or 11: all sixteen sums.
    sums = [sum(parts) for parts in itertools.product([9, 11], repeat=4)]
    both = [value for value in sums if 36 <= value <= 38 and 42 <= value <= 44]
    return {"yields": [share(sums, 36, 38), share(sums, 42, 44)], "joint_yield": len(both) / len(sums)}


def lot():
    # Hundredths as whole numbers, every housing with every bearing.
    with open(FOLDER / "joint-lot.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    column = lambda name: [int(Fraction(row[name]) * 100) for row in rows]
    gaps = [a - b for a in column("housing") for b in column("bearing")]
    return {"yields": [share(gaps, 717, 719), share(gaps, 717, 718)], "joint_yield": share(gaps, 717, 718)}


def two_point():
    # exp(2 x) is exp(2) or exp(-2), each for one half; y is normal with sigma 0.1/3.
    return {"mean": math.cosh(2), "sigma": math.hypot(math.sinh(2), 0.1 / 3)}


def one_sided():
    # a b^2 > 1/2 for uniform a and b: the integral over b > r of 1 - 1/(2 b^2), r = sqrt(1/2).
    r = math.sqrt(0.5)
    return {"ppm_below": 0.0, "ppm_above": 1e6 * ((1 - r) - 0.5 * (1 / r - 1))}


print(
    json.dumps(
        {
            "joint-two-windows": two_windows(),
            "joint-lot": lot(),
            "two-point-exact": two_point(),
            "one-sided-proof": one_sided(),
        },
        indent=2,
    )
)
