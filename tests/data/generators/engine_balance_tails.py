"""Probabilities of F of engine-balance beyond 4.5 sigma, by importance sampling with shifted normals.

Run: python engine_balance_tails.py > ../engine-balance-tails.json
"""
import json
import math
import os

import numpy as np

MP, MR, OMEGA = 0.427, 0.597, 628.3185
NOMINAL = np.array([0.0425, 0.1345, 0.0973, 0.0372, 0.0, 0.0, math.pi, 3 * math.pi, 2 * math.pi])
SIGMA = np.array([0.00004] * 4 + [0.00872] * 5) / 3


def force(x):
    r, l, hp, hc, t = x[:5]
    mass = MP + MR * hc / (hc + hp)
    shares = sum(np.cos(t + phi) + r / l * np.cos(2 * (t + phi)) for phi in x[5:])
    return mass * r * OMEGA**2 * shares


here = os.path.dirname(os.path.abspath(__file__))
exact = json.load(open(os.path.join(here, "..", "engine-balance.json")))["table-3"]["F"]
rng = np.random.default_rng(20261121)


def standard(z):
    return force(NOMINAL[:, None] + SIGMA[:, None] * z)


def shift(sign, limit):
    """The most likely point at the limit: Hasofer and Lind's iteration with differences."""
    z = np.zeros(9)
    for _ in range(50):
        step = 1e-3
        around = np.concatenate([z[:, None] + step * np.eye(9), z[:, None] - step * np.eye(9)], axis=1)
        values = standard(around)
        gradient = (values[:9] - values[9:]) / (2 * step)
        margin = standard(z[:, None])[0] - limit
        z = (gradient @ z - margin) / (gradient @ gradient) * gradient
    return z


found = {}
for name, sign in (("below", -1), ("above", 1)):
    limit = exact["mean"] + sign * 4.5 * exact["sigma"]
    centre = shift(sign, limit)
    total, squares, n = 0.0, 0.0, 0
    for _ in range(100):
        z = rng.standard_normal((9, 200_000)) + centre[:, None]
        weight = np.exp(-centre @ z + 0.5 * centre @ centre) * (sign * (standard(z) - limit) > 0)
        total, squares, n = total + weight.sum(), squares + (weight**2).sum(), n + weight.size
    mean = total / n
    found[name] = {"probability": mean, "standard_error": math.sqrt((squares / n - mean**2) / n)}
print(json.dumps(found, indent=2))
