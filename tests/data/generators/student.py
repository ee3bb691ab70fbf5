"""Student's t distribution from a few degrees of freedom to many: density, tails and quantiles in 40 digits, moments as fractions.

Tails by the incomplete beta function, whose arguments need no series of their own; quantiles by solving for them.
"""

import json
import pathlib
from fractions import Fraction

import mpmath as mp

mp.mp.dps = 40
DEGREES = [2.01, 2.5, 3.0, 4.0, 4.01, 5.0, 8.0, 18.0, 1000.0]


def tail(t, n):
    """Probability above t >= 0."""
    if t * t < n:
        return mp.mpf(1) / 2 - mp.betainc(mp.mpf(1) / 2, n / 2, 0, t * t / (n + t * t), regularized=True) / 2
    return mp.betainc(n / 2, mp.mpf(1) / 2, 0, n / (n + t * t), regularized=True) / 2


def density(t, n):
    return (1 + t * t / n) ** (-(n + 1) / 2) / (mp.sqrt(n) * mp.beta(n / 2, mp.mpf(1) / 2))


def quantile(p, n):
    low, high = mp.mpf(-40), mp.mpf(120)  # of the logarithm of t
    for _ in range(150):
        middle = (low + high) / 2
        low, high = (middle, high) if tail(mp.exp(middle), n) > p else (low, middle)
    return mp.exp((low + high) / 2)


def moment(order, degrees):
    """Of the variable in units of its sigma, exactly; null where there is none."""
    n, found = Fraction(degrees), Fraction(1)
    if n <= order:
        return None
    for k in range(2, order // 2 + 1):
        found *= (2 * k - 1) * (n - 2) / (n - 2 * k)
    return float(found)


cases = []
for degrees in DEGREES:
    n = mp.mpf(degrees)
    sigma = mp.sqrt(n / (n - 2))
    cases.append({
        "degrees": degrees,
        "sigma": float(sigma),
        "even": [moment(order, degrees) for order in (4, 6, 8)],
        # At t = u sigma: u, density per sigma, probability above.
        "at": [[u, float(sigma * density(mp.mpf(u) * sigma, n)), float(tail(mp.mpf(u) * sigma, n))] for u in (0.0, 0.3, 1.0, 2.5, 8.0, 50.0)],
        # p, and the quantile in sigmas.
        "quantiles": [[p, float(quantile(mp.mpf(p), n) / sigma)] for p in (1e-12, 1e-6, 1e-3, 0.05, 0.3, 0.49)],
    })
    print(degrees, flush=True)
lines = ",\n".join(json.dumps(case) for case in cases)
pathlib.Path(__file__).parents[1].joinpath("student.json").write_text(f"[\n{lines}\n]\n")
