"""Checks tests/data/method-comparison.json by quadrature of its own, and computes the blocks with correlated dimensions.

The closed forms of the blocks and of the quick-return mechanism, written here from their geometry; tensor Gauss-Hermite quadrature of
five nodes over independent standard normals, to which correlated dimensions are led by the Cholesky factor. numpy alone.

    python3 method_comparison.py
"""

import itertools
import json
import os

import numpy as np

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")


def blocks(x):
    a, b, c, e, f, r, R, th = x
    th = np.radians(th)
    phi = np.arccos((R * np.sin(th) + r) / (R - r))
    height = c + e / np.cos(th) + (a - b) * np.tan(th) - R * np.sin(th) * np.tan(th)
    return [f - r - height + (R - r) * np.sin(phi)]


def quick_return(x):
    r, d, e, q, c, H, s = x
    delta, gamma = np.arctan2(e, d), np.arcsin((r + s / 2) / np.hypot(d, e))
    ram = lambda b: q * np.sin(b) + np.sqrt(c**2 - (H - q * np.cos(b)) ** 2)
    return [ram(delta + gamma) - ram(delta - gamma), (np.pi + 2 * gamma) / (np.pi - 2 * gamma)]


def moments(function, means, tolerances, correlation=None):
    nodes, weights = np.polynomial.hermite_e.hermegauss(5)
    weights = weights / weights.sum()
    n = len(means)
    u = np.array(list(itertools.product(nodes, repeat=n))).T
    w = np.prod(np.array(list(itertools.product(weights, repeat=n))), axis=1)
    if correlation is not None:
        u = np.linalg.cholesky(correlation) @ u
    x = np.array(means)[:, None] + np.array(tolerances)[:, None] / 3 * u
    found = []
    for y in function(x):
        mean = np.sum(w * y)
        m2, m3, m4 = (np.sum(w * (y - mean) ** k) for k in (2, 3, 4))
        found.append([mean, np.sqrt(m2), m3 / m2**1.5, m4 / m2**2])
    return found


BLOCKS = ([10, 30, 31.9, 55, 75, 10, 40, 17], [0.3, 0.3, 0.3, 0.3, 0.5, 0.1, 0.3, 1.0])
RETURN = ([56.6, 140, 8, 220, 180, 235, 0.05], [0.2, 0.2, 0.1, 0.3, 0.2, 0.2, 0.02])

if __name__ == "__main__":
    listed = json.load(open(os.path.join(HERE, "method-comparison.json")))["computed"]
    for case, found in [
        ("stacked_blocks", moments(blocks, *BLOCKS)[0]),
        ("quick_return_stroke", moments(quick_return, *RETURN)[0]),
        ("quick_return_time_ratio", moments(quick_return, *RETURN)[1]),
    ]:
        row = next(value for key, value in listed[case].items() if key.startswith("reference: tensor"))
        for key, value in zip(["mean", "sigma", "skewness", "kurtosis"], found):
            assert abs(value - row[key]) <= 2e-8 * max(abs(row[key]), 1), (case, key, value, row[key])
    # The two radii are turned in one setting: R and r by 0.8; a and b are one block: 0.6.
    correlation = np.eye(8)
    correlation[5, 6] = correlation[6, 5] = 0.8
    correlation[0, 1] = correlation[1, 0] = 0.6
    found = moments(blocks, *BLOCKS, correlation)[0]
    print(json.dumps({"correlated_blocks": dict(zip(["mean", "sigma", "skewness", "kurtosis"], found))}))
