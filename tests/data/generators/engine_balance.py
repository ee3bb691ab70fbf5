"""Moments of engine-balance by tensor Gauss-Hermite quadrature: five nodes in every dimension (three for `a`, which
enters linearly), central moments summed about the mean. Independent of sensitol: numpy only.

    python3 engine_balance.py > ../engine-balance.json
"""
import json

import numpy as np
from numpy.polynomial.hermite_e import hermegauss

PI, OMEGA, MP, MR = np.pi, 628.3185, 0.427, 0.597
ANGLES = [0.0, 0.0, PI, 3 * PI, 2 * PI]


def rule(n):
    x, w = hermegauss(n)
    return x, w / w.sum()


def central(values, weights):
    mean = float(weights @ values)
    d = values - mean
    m2, m3, m4 = (float(weights @ d**k) for k in (2, 3, 4))
    return {"mean": mean, "sigma": m2**0.5, "skewness": m3 / m2**1.5, "kurtosis": m4 / m2**2}


def moments(lengths, tolerances):
    """lengths, tolerances: a R L hp hc; the angles keep theirs."""
    x, w = rule(5)
    # shares of the cylinders over the five angles
    grids = np.meshgrid(*[0.00872 / 3 * x] * 5, indexing="ij")
    t, phi = grids[0].ravel(), [ANGLES[n] + grids[n].ravel() for n in (1, 2, 3, 4)]
    wa = np.einsum("i,j,k,l,m->ijklm", w, w, w, w, w).ravel()
    one = [np.cos(t + p) for p in phi]
    two = [np.cos(2 * (t + p)) for p in phi]
    lever = [0, 1, 2, 3]
    x1, y1 = sum(one), sum(two)
    xm, ym = (sum(l * c for l, c in zip(lever, cs)) for cs in (one, two))
    # scale and ratio over the four lengths
    (a0, r0, l0, hp0, hc0), (ta, tr, tl, thp, thc) = lengths, tolerances
    r, l, hp, hc = (g.ravel() for g in np.meshgrid(
        r0 + tr / 3 * x, l0 + tl / 3 * x, hp0 + thp / 3 * x, hc0 + thc / 3 * x, indexing="ij"))
    wl = np.einsum("i,j,k,l->ijkl", w, w, w, w).ravel()
    scale, ratio = (MP + MR * hc / (hc + hp)) * r * OMEGA**2, r / l
    f = scale[:, None] * (x1[None, :] + ratio[:, None] * y1[None, :])
    both = wl[:, None] * wa[None, :]
    force = central(f.ravel(), both.ravel())
    xa, wn = rule(3)
    a = a0 + ta / 3 * xa
    m = scale[:, None] * (xm[None, :] + ratio[:, None] * ym[None, :])
    values = (a[:, None, None] * m[None]).reshape(-1)
    weights = (wn[:, None, None] * both[None]).reshape(-1)
    return {"F": force, "M": central(values, weights)}


if __name__ == "__main__":
    print(json.dumps({
        "table-3": moments((0.05, 0.0425, 0.1345, 0.0973, 0.0372), (1e-4, 4e-5, 4e-5, 4e-5, 4e-5)),
        "wide": moments((0.05, 0.042, 0.134, 0.097, 0.037), (1e-4, 1e-3, 1e-3, 1e-3, 1e-3)),
    }, indent=2))
