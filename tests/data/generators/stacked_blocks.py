"""Moments of the stacked-blocks gap by tensor Gauss-Hermite quadrature, and its derivatives with 40 digits.
Independent of sensitol: numpy and mpmath.

    python3 stacked_blocks.py > ../stacked-blocks.json
"""
import json

import mpmath
import numpy as np
from numpy.polynomial.hermite_e import hermegauss

MEAN = dict(a=10, b=30, c=31.9, e=55, f=75, r=10, R=40, th=17)
TOLERANCE = dict(a=0.3, b=0.3, c=0.3, e=0.3, f=0.5, r=0.1, R=0.3, th=1)
NODES = dict(a=3, b=3, c=3, e=3, f=3, r=9, R=9, th=9)  # the gap is linear in a, b, c, e and f for given r, R, th


def gap(m, *, a, b, c, e, f, r, R, th):
    t = th * (m.pi / 180)
    y = c + e / m.cos(t) + (a - b) * m.tan(t) - R * m.sin(t) * m.tan(t)
    q = (R * m.sin(t) + r) / (R - r)
    return f - r - y + (R - r) * m.sqrt(1 - q * q)


def moments():
    rules = {k: hermegauss(n) for k, n in NODES.items()}
    grids = np.meshgrid(*[MEAN[k] + TOLERANCE[k] / 3 * rules[k][0] for k in MEAN], indexing="ij")
    weights = np.ones(1)
    for k in MEAN:
        w = rules[k][1] / rules[k][1].sum()
        weights = np.multiply.outer(weights, w)
    weights = weights.ravel()
    values = gap(np, **{k: g.ravel() for k, g in zip(MEAN, grids)})
    mean = float(weights @ values)
    d = values - mean
    m2, m3, m4 = (float(weights @ d**k) for k in (2, 3, 4))
    return {"mean": mean, "sigma": m2**0.5, "skewness": m3 / m2**1.5, "kurtosis": m4 / m2**2}


def derivatives():
    mpmath.mp.dps = 40
    at = {k: mpmath.mpf(str(v)) for k, v in MEAN.items()}
    first, second = {}, {}
    for k in MEAN:
        along = lambda x: gap(mpmath, **{**at, k: x})
        first[k] = float(mpmath.diff(along, at[k]))
        second[k] = float(mpmath.diff(along, at[k], 2))
    return first, second, float(gap(mpmath, **at))


if __name__ == "__main__":
    first, second, nominal = derivatives()
    print(json.dumps({"nominal": nominal, "first": first, "second": second, "moments": moments()}, indent=2))
