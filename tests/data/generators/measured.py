"""Moments and quantiles of samples, from the doubles as exact rationals; square roots in 60 digits. Independent of
sensitol: fractions, mpmath, and numpy for the quantiles. BCa intervals of the first two by scipy.stats.bootstrap.

    python3 measured.py > ../measured.json
"""
import json
import random
from fractions import Fraction

import numpy
import scipy.stats
from mpmath import mp, mpf, sqrt

mp.dps = 60


def rational(x):
    return mpf(x.numerator) / mpf(x.denominator)


def case(name, values):
    exact = [Fraction(v) for v in values]
    n = len(exact)
    mean = sum(exact) / n
    central = [sum((x - mean) ** r for x in exact) / n for r in range(9)]
    sigma = sqrt(rational(central[2]))
    probabilities = [0.003, 0.0171, 0.11, 0.26, 0.5, 0.77, 0.913, 0.9991]
    return {
        "name": name,
        "values": values,
        "mean": float(rational(mean)),
        "sigma": float(sigma),
        "moments": [float(rational(central[r]) / sigma**r) for r in range(3, 9)],
        "quantiles": [[p, float(numpy.quantile(values, p, method="inverted_cdf"))] for p in probabilities],
    }


rng = random.Random(20)
cases = [
    case("normal", [rng.gauss(25.0, 0.004) for _ in range(50)]),
    case("gamma", [10.0 + 0.01 * rng.gammavariate(2.0, 1.0) for _ in range(200)]),
    case("offset", [1e6 + 1e-3 * rng.gauss(0.0, 1.0) for _ in range(120)]),
    case("rounded", [round(rng.gauss(8.0, 0.02), 2) for _ in range(80)]),
    case("two values", [1.0] * 7 + [2.0] * 3),
    case("five values", [-3.0, 0.5, 1.25, 2.0, 7.0]),
    case("huge", [1e200 * (1 + 0.1 * rng.random()) for _ in range(30)]),
    case("tiny", [1e-250 * rng.random() for _ in range(30)]),
]


def bca(values, statistic):
    draws = {"n_resamples": 100000, "batch": 1000, "method": "BCa", "rng": numpy.random.default_rng(1)}
    found = scipy.stats.bootstrap((numpy.array(values),), statistic, vectorized=True, **draws)
    return [float(found.confidence_interval.low), float(found.confidence_interval.high)]


for one in cases[:2]:
    one["bca"] = {
        "mean": bca(one["values"], numpy.mean),
        "sigma": bca(one["values"], numpy.std),
        "skewness": bca(one["values"], scipy.stats.skew),
        "kurtosis": bca(one["values"], lambda x, axis: scipy.stats.kurtosis(x, axis=axis, fisher=False)),
    }
print(json.dumps(cases, indent=1))
