"""Figures of four quadratics of which a screening once estimated interactions that are not there. Independent of sensitol: given the
dimensions that multiply others, each is normal, so that moments and tails are integrals over those alone. Standard library only.

    python3 proofs.py > ../proofs.json
"""
import json
import math


def beyond(t):
    return 0.5 * math.erfc(t / math.sqrt(2))


def legendre(n):
    """Nodes in (-1, 1) and weights that sum to 1, by Newton's method."""
    rule = []
    for i in range(n):
        x = math.cos(math.pi * (i + 0.75) / (n + 0.5))
        for _ in range(100):
            p, q = 1.0, 0.0
            for k in range(n):
                p, q = ((2 * k + 1) * x * p - k * q) / (k + 1), p
            slope = n * (q - x * p) / (1 - x * x)
            x -= p / slope
            if abs(p / slope) < 1e-16:
                break
        rule.append((x, 1 / ((1 - x * x) * slope * slope)))
    return rule


UNIFORM = legendre(80)
# The trapezoidal rule converges faster than any power for what falls off so.
STEP = 18 / 4000
NORMAL = [(z, math.exp(-z * z / 2) / math.sqrt(2 * math.pi) * STEP) for z in (-9 + STEP * i for i in range(4001))]


def figures(parts, lower=None, upper=None):
    """Of a mixture of normal distributions: weight, mean and variance of each."""
    mean = math.fsum(w * m for w, m, _ in parts)
    central = [
        math.fsum(w * power(m - mean, v) for w, m, v in parts)
        for power in (
            lambda d, v: v + d**2,
            lambda d, v: d**3 + 3 * d * v,
            lambda d, v: d**4 + 6 * d**2 * v + 3 * v * v,
        )
    ]
    sigma = math.sqrt(central[0])
    found = dict(mean=mean, sigma=sigma, skewness=central[1] / sigma**3, kurtosis=central[2] / sigma**4)
    if lower is not None:
        found["below"] = math.fsum(w * beyond((m - lower) / math.sqrt(v)) for w, m, v in parts)
    if upper is not None:
        found["above"] = math.fsum(w * beyond((upper - m) / math.sqrt(v)) for w, m, v in parts)
    return found


def band(tolerance, distribution=None):
    entry = dict(nominal=0.0, tolerance=tolerance)
    return entry if distribution is None else dict(entry, distribution=distribution)


def case(name, dimensions, formula, parts, **limits):
    return dict(name=name, dimensions=dimensions, formula=formula, **limits, figures=figures(parts, **limits))


cases = [
    # Given b: a and c are alike.
    case(
        "three-normal", dict(a=band(3.0), b=band(3.0), c=band(3.0)), "a + b + c + 0.1*a*b + 0.1*b*c",
        [(w, z, 2 * (1 + 0.1 * z) ** 2) for z, w in NORMAL], lower=-3.0,
    ),
    # Given p with a sigma of 0.06.
    case(
        "proof-normal", dict(p=band(0.18), q=band(0.12), r=band(0.3)), "p - q - r + 0.4*p*q",
        [(w, 0.06 * z, (0.4 * 0.06 * z - 1) ** 2 * 0.04**2 + 0.1**2) for z, w in NORMAL], lower=-0.4, upper=0.4,
    ),
    # Given w within 0.15.
    case(
        "proof-uniform", dict(a=band(0.2), w=band(0.15, "uniform"), b=band(0.3)),
        "1.5*a + 0.6*w - 1.6*b + 0.4*w*a + 1.4*b*w",
        [
            (v, 0.6 * x, (1.5 + 0.4 * x) ** 2 * (0.2 / 3) ** 2 + (1.4 * x - 1.6) ** 2 * 0.1**2)
            for x, v in ((0.15 * u, v) for u, v in UNIFORM)
        ],
        lower=-0.6, upper=0.6,
    ),
    # Given a within 0.17 and c within 0.33.
    case(
        "proof-four", dict(a=band(0.17, "uniform"), b=band(0.19), c=band(0.33, "uniform"), d=band(0.16)),
        "0.9*a + 0.9*b + 1.2*c + 0.7*d + 0.9*c*a",
        [
            (v * w, 0.9 * x + 1.2 * y + 0.9 * x * y, (0.9 * 0.19 / 3) ** 2 + (0.7 * 0.16 / 3) ** 2)
            for x, v in ((0.17 * u, v) for u, v in UNIFORM)
            for y, w in ((0.33 * u, w) for u, w in UNIFORM)
        ],
        lower=-0.7, upper=0.8,
    ),
]
print(json.dumps(cases, indent=1))
