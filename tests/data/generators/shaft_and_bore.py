"""Moments of the clearance of examples/shaft-and-bore: bore - shaft/cos(tilt), from the exact moments of the three
factors in 40-digit arithmetic. Independent of sensitol: mpmath.

    python3 shaft_and_bore.py > ../shaft-and-bore.json
"""
import json

from mpmath import cos, mp, mpf, pi, quad

mp.dps = 40
BORE, BORE_SIGMA = mpf("25.020"), mpf("0.010") / 3
SHAFT, SHAFT_SIGMA = mpf("24.980") - mpf("0.0065"), mpf("0.0065") / 3
TILT = mpf("1.5") * pi / 180  # uniform over +- this


def normal(mean, sigma, order):
    """E[x^order] of a normal variable."""
    raw = [mpf(1), mean]
    for k in range(2, order + 1):
        raw.append(mean * raw[-1] + (k - 1) * sigma**2 * raw[-2])
    return raw[order]


def secant(order):
    return quad(lambda t: cos(t) ** -order, [-TILT, 0, TILT]) / (2 * TILT)


def raw(order):
    total = mpf(0)
    for k in range(order + 1):
        term = mp.binomial(order, k) * (-1) ** k
        total += term * normal(BORE, BORE_SIGMA, order - k) * normal(SHAFT, SHAFT_SIGMA, k) * secant(k)
    return total


m1, m2, m3, m4 = (raw(k) for k in (1, 2, 3, 4))
variance = m2 - m1**2
third = m3 - 3 * m1 * m2 + 2 * m1**3
fourth = m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
print(json.dumps({"mean": float(m1), "sigma": float(variance**0.5), "skewness": float(third / variance**1.5),
                  "kurtosis": float(fourth / variance**2)}, indent=2))
