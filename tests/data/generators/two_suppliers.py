"""The gap of examples/two-suppliers by product quadrature: the depth, a mixture of two normals, is integrated out in closed
form; ring, paint and tilt by Gauss-Legendre with 80 nodes each (paint in pieces up to 60 of its sigmas).

    python3 two_suppliers.py > ../two-suppliers.json
"""
import json

import numpy as np
from scipy.special import ndtr

NODES, WEIGHTS = np.polynomial.legendre.leggauss(80)


def rule(ends, density):
    points, weights = [], []
    for low, high in zip(ends[:-1], ends[1:]):
        x = 0.5 * (low + high) + 0.5 * (high - low) * NODES
        points.append(x)
        weights.append(0.5 * (high - low) * WEIGHTS * density(x))
    weights = np.concatenate(weights)
    return np.concatenate(points), weights / weights.sum()


ring, ring_weight = rule([19.82, 19.88], lambda x: np.exp(-0.5 * ((x - 19.85) / 0.015) ** 2))
paint, paint_weight = rule([0, 0.1, 0.6], lambda x: np.exp(-x / 0.01))
tilt, tilt_weight = rule([-0.4, 0.0, 0.4], lambda x: 0.4 - np.abs(x))
cosine = np.cos(np.radians(tilt))[:, None, None]
rest = ring[None, :, None] + paint[None, None, :]
weight = tilt_weight[:, None, None] * ring_weight[None, :, None] * paint_weight[None, None, :]
SUPPLIERS = [(0.7, 20.0, 0.06 / 4), (0.3, 20.03, 0.06 / 3)]


def expectation(of):
    """Of a function of the normal gap's mean and sigma."""
    return sum(share * np.sum(weight * of(mean * cosine - rest, sigma * cosine)) for share, mean, sigma in SUPPLIERS)


mean = expectation(lambda m, s: m)
variance = expectation(lambda m, s: (m - mean) ** 2 + s**2)
third = expectation(lambda m, s: (m - mean) ** 3 + 3 * (m - mean) * s**2)
fourth = expectation(lambda m, s: (m - mean) ** 4 + 6 * (m - mean) ** 2 * s**2 + 3 * s**4)
found = {
    "mean": mean,
    "sigma": variance**0.5,
    "skewness": third / variance**1.5,
    "kurtosis": fourth / variance**2,
    "ppm_below": 1e6 * expectation(lambda m, s: ndtr((0.05 - m) / s)),
    "ppm_above": 1e6 * expectation(lambda m, s: ndtr((m - 0.25) / s)),
}
print(json.dumps({name: float(value) for name, value in found.items()}, indent=2))
