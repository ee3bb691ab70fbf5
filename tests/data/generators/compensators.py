"""Figures of the studies in tests/data/compensators: quadrature, and plain Monte Carlo with a stored seed.

Usage: python3 compensators.py > ../compensators.json
"""

import json

import numpy as np
from scipy import integrate, stats
from scipy.stats import multivariate_normal


def shim():
    """Quadrature over the needed thickness U, a normal variable with two uniform ones, between the borders of the stock."""
    normal = stats.norm(40.0 - 8.9, np.hypot(0.12, 0.05) / 3)
    half = 0.12

    # Twice integrated normal distribution, for the sum with two uniform variables over [14.88, 15].
    def second(x):
        z = (x - normal.mean()) / normal.std()
        return normal.std() ** 2 * 0.5 * ((z * z + 1) * stats.norm.cdf(z) + z * stats.norm.pdf(z))

    def first(x):
        z = (x - normal.mean()) / normal.std()
        return normal.std() * (z * stats.norm.cdf(z) + stats.norm.pdf(z))

    def spread(function, u):
        # U = N - B1 - B2 - 0.08, so that N lies above u + 0.08 by B1 + B2 from 29.76 to 30.
        at = u + 0.08 + 2 * 14.88
        return (function(at + 2 * half) - 2 * function(at + half) + function(at)) / half**2

    cdf = lambda u: spread(second, u)
    pdf = lambda u: spread(first, u)
    stock = 0.95 + 0.05 * np.arange(7)
    middles = 0.5 * (stock[1:] + stock[:-1])
    ends = np.concatenate([[-1.0], middles, [3.0]])
    share = np.diff([cdf(end) for end in ends])
    kept = sum(
        max(0.0, cdf(min(b, v + 0.04)) - cdf(max(a, v - 0.02))) for v, a, b in zip(stock, ends[:-1], ends[1:])
    )
    integral = lambda power, about: sum(
        integrate.quad(lambda u: (u - v + 0.08 - about) ** power * pdf(u), a, b, points=[v], epsabs=1e-13, limit=400)[0]
        for v, a, b in zip(stock, np.maximum(ends[:-1], 0.5), np.minimum(ends[1:], 1.8))
    )
    mean = integral(1, 0.0)
    sigma = np.sqrt(integral(2, mean))
    thick = float(share @ stock)
    return {
        "play": {"mean": mean, "sigma": sigma, "yield": kept, "total": integral(0, 0.0)},
        "thickness": {
            "mean": thick,
            "sigma": float(np.sqrt(share @ (stock - thick) ** 2)),
            "yield": float(share[:4].sum()),
        },
    }


def wedge(count=20_000_000, block=1_000_000, seed=20261128):
    rng = np.random.default_rng(seed)
    sums = np.zeros((2, 3))
    acts = lambda w: w * (1 + 0.2 * w)
    wedges = np.array([0.8, 1.0, 1.1, 1.2, 1.3])
    washers = np.array([0.4, 0.45, 0.5, 0.55, 0.6, 0.65])
    for _ in range(count // block):
        bore, shaft = rng.normal(12, 0.1, block), rng.uniform(9.8, 10.2, block)
        off = rng.uniform(-0.02, 0.02, block)
        rest = bore - shaft
        label = wedges[np.abs(rest[:, None] - acts(wedges) - 0.6).argmin(axis=1)]
        # The washer is chosen by the wedge's label, and the deviation comes after both choices.
        washer = washers[np.abs((rest - acts(label))[:, None] - washers - 0.1).argmin(axis=1)]
        room = rest - acts(label + off)
        for k, (values, low, high) in enumerate([(room, 0.4, 0.8), (room - washer, 0.02, 0.18)]):
            sums[k] += [values.sum(), (values**2).sum(), ((values >= low) & (values <= high)).sum()]
    result = {}
    for name, (total, squares, kept) in zip(["room", "play"], sums):
        mean, share = total / count, kept / count
        sigma = np.sqrt(squares / count - mean**2)
        result[name] = {
            "mean": mean,
            "sigma": sigma,
            "yield": share,
            "mean_error": sigma / np.sqrt(count),
            "sigma_error": sigma / np.sqrt(2 * count),
            "yield_error": np.sqrt(share * (1 - share) / count),
        }
    return result


def turn():
    """Radius of two normal variables by quadrature, with the room as a normal variable; the quarter by its two ends."""
    s, room = 0.02, 0.1 / 3
    density = lambda b, a: stats.norm.pdf(a, 0.3, s) * stats.norm.pdf(b, 0.2, s)
    over = lambda f: integrate.dblquad(
        lambda b, a: f(a, b) * density(b, a), 0.3 - 9 * s, 0.3 + 9 * s, 0.2 - 9 * s, 0.2 + 9 * s, epsabs=1e-12, epsrel=1e-12
    )[0]
    mean = over(np.hypot)
    square = over(lambda a, b: a * a + b * b)
    radius = np.sqrt(square - mean**2)
    beyond = over(lambda a, b: stats.norm.cdf((0.55 - 1.0 + np.hypot(a, b)) / room))
    # The least of a and b, whose difference is normal (Clark 1961).
    theta = np.hypot(s, s)
    alpha = (0.3 - 0.2) / theta
    least = 0.3 * stats.norm.cdf(-alpha) + 0.2 * stats.norm.cdf(alpha) - theta * stats.norm.pdf(alpha)
    return {
        "least": {"mean": 1 - mean, "sigma": np.hypot(radius, room), "yield": 1 - beyond},
        "most": {"mean": 1 + mean, "sigma": np.hypot(radius, room), "yield": 1 - beyond},
        "quarter": {"mean": 1 + least, "sigma": None, "yield": None},
    }


def given():
    both = multivariate_normal([0, 0], [[1, 0.6], [0.6, 1]]).cdf([1.0, 0.5])
    # By one quadrature as well, which has all digits.
    line = integrate.quad(lambda x: stats.norm.pdf(x) * stats.norm.cdf((0.5 - 0.6 * x) / 0.8), -12, 1, epsabs=1e-14)[0]
    assert abs(both - line) < 1e-6
    return {"a": line / stats.norm.cdf(0.5), "c": stats.norm.cdf(1.0), "plain": stats.norm.cdf(1.0)}


print(json.dumps({"shim": shim(), "wedge": wedge(), "turn": turn(), "given": given()}, indent=1))
