"""Moments, recurrences and quantiles of distributions at ordinary and extreme parameters, in 150 digits.

Every parameter is the double that the tests use, taken exactly. Moments come from closed forms of the raw moments (the
digits make up for what their differences lose), recurrence coefficients from them by Chebyshev's algorithm, quantiles by
solving the distribution function.
"""

import json
import pathlib

import mpmath as mp

mp.mp.dps = 150
ORDER = 9


def truncated_normal(middle, half, shift, sigma):
    a, b = (-half - shift) / sigma, (half - shift) / sigma
    below = mp.ncdf(a) if a < 0 else -mp.ncdf(-a)
    total = (mp.ncdf(b) - mp.ncdf(a)) if a < 0 else mp.ncdf(-a) - mp.ncdf(-b)
    raw = [mp.mpf(1), -(mp.npdf(b) - mp.npdf(a)) / total]
    for n in range(2, 21):
        raw.append((n - 1) * raw[n - 2] - (b ** (n - 1) * mp.npdf(b) - a ** (n - 1) * mp.npdf(a)) / total)

    def cdf(x):
        z = (x - middle - shift) / sigma
        return (mp.ncdf(z) - mp.ncdf(a)) / total if a < 0 else (mp.ncdf(-a) - mp.ncdf(-z)) / total

    return raw, middle + shift, sigma, cdf, (middle - half, middle + half)


def polynomial_pieces(pieces, middle, half):
    """Density (c0 + c1 y) on intervals of y from -1 to 1."""

    def integral(power, lo, hi, c0, c1):
        one = lambda y: c0 * y ** (power + 1) / (power + 1) + c1 * y ** (power + 2) / (power + 2)
        return one(hi) - one(lo)

    raw = [sum(integral(n, *piece) for piece in pieces) for n in range(21)]

    def cdf(x):
        y = (x - middle) / half
        return sum(integral(0, lo, min(y, hi), c0, c1) for lo, hi, c0, c1 in pieces if y > lo)

    return raw, middle, half, cdf, (middle - half, middle + half)


def triangular(middle, half, lean):
    pieces = []
    if lean > -1:
        pieces.append((mp.mpf(-1), lean, 1 / (1 + lean), 1 / (1 + lean)))
    if lean < 1:
        pieces.append((lean, mp.mpf(1), 1 / (1 - lean), -1 / (1 - lean)))
    return polynomial_pieces(pieces, middle, half)


def trapezoidal(middle, half, top):
    h = 1 / (1 + top)
    pieces = [(-top, top, h, mp.mpf(0))] if top > 0 else []
    if top < 1:
        r = h / (1 - top)
        pieces += [(mp.mpf(-1), -top, r, r), (top, mp.mpf(1), r, -r)]
    return polynomial_pieces(sorted(pieces), middle, half)


def u_shaped(middle, half):
    raw = [mp.mpf(0) if n % 2 else mp.mpf(3) / (n + 3) for n in range(21)]
    cdf = lambda x: (1 + ((x - middle) / half) ** 3) / 2
    return raw, middle, half, cdf, (middle - half, middle + half)


def curvilinear_trapezoid(middle, half, inexactness):
    """A uniform variable whose half width is uniform itself (GUM Supplement 1, 6.4.3)."""
    w, d = half, inexactness
    raw = [mp.mpf(0) if n % 2 else ((w + d) ** (n + 1) - (w - d) ** (n + 1)) / (2 * d * (n + 1) ** 2) for n in range(21)]

    def upper(t):
        if t >= w - d:
            return ((w + d) - t - t * mp.log((w + d) / t)) / (4 * d)
        return upper(w - d) + (w - d - t) * mp.log((w + d) / (w - d)) / (4 * d)

    def cdf(x):
        t = x - middle
        return upper(-t) if t < 0 else 1 - upper(t)

    return raw, middle, mp.mpf(1), cdf, (middle - w - d, middle + w + d)


def octahedron(middle, half):
    raw = [mp.mpf(6) / ((n + 1) * (n + 2) * (n + 3)) if n % 2 == 0 else mp.mpf(0) for n in range(21)]
    tail = lambda y: (1 - y) ** 3 / 2
    cdf = lambda x: tail(-(x - middle) / half) if x < middle else 1 - tail((x - middle) / half)
    return raw, middle, half, cdf, (middle - half, middle + half)


def bicone(middle, half):
    """A coordinate across a double cone: the radius of density 6 r (1 - r) times a cosine."""
    cosine = lambda n: mp.fac2(n - 1) / mp.fac2(n) if n else mp.mpf(1)
    raw = [cosine(n) * 6 / ((n + 2) * mp.mpf(n + 3)) if n % 2 == 0 else mp.mpf(0) for n in range(21)]
    tail = lambda y: (mp.acos(y) - 2 * y * mp.sqrt(1 - y * y) + (y**3 * mp.acosh(1 / y) if y else 0)) / mp.pi
    cdf = lambda x: tail(-(x - middle) / half) if x < middle else 1 - tail((x - middle) / half)
    return raw, middle, half, cdf, (middle - half, middle + half)


def beta(middle, half, a, b):
    raw = [mp.beta(a + n, b) / mp.beta(a, b) for n in range(21)]
    cdf = lambda x: mp.betainc(a, b, 0, (x - middle + half) / (2 * half), regularized=True)
    return raw, middle - half, 2 * half, cdf, (middle - half, middle + half)


def gamma(origin, mean, sigma):
    k = ((mean - origin) / sigma) ** 2
    scale = sigma**2 / (mean - origin)
    raw = [mp.rf(k, n) for n in range(21)]
    cdf = lambda x: mp.gammainc(k, 0, (x - origin) / scale, regularized=True)
    return raw, origin, scale, cdf, (origin, mp.inf)


def lognormal(origin, mean, sigma):
    w = 1 + (sigma / (mean - origin)) ** 2
    tau = mp.sqrt(mp.log(w))
    raw = [w ** (mp.mpf(n * (n - 1)) / 2) for n in range(21)]
    cdf = lambda x: mp.ncdf(mp.log((x - origin) / (mean - origin)) / tau + tau / 2)
    return raw, origin, mean - origin, cdf, (origin, mp.inf)


def weibull(origin, mean, sigma, power=None):
    ratio = sigma / (mean - origin)
    if power is None:
        spread = lambda e: mp.log(mp.gamma(1 + 2 * e) / mp.gamma(1 + e) ** 2) - mp.log1p(ratio**2)
        low, high = ratio / 4, max(ratio, 4 * mp.log1p(ratio**2))
        power = mp.findroot(spread, (low, high), solver="anderson", tol=mp.mpf(10) ** -140, maxsteps=400)
    scale = (mean - origin) / mp.gamma(1 + power)
    raw = [mp.gamma(1 + n * power) for n in range(21)]
    cdf = lambda x: -mp.expm1(-(((x - origin) / scale) ** (1 / power)))
    return raw, origin, scale, cdf, (origin, mp.inf)


def exponential(origin, mean):
    return weibull(origin, mean, mean - origin, power=mp.mpf(1))


def rayleigh(origin, mean):
    return weibull(origin, mean, mean - origin, power=mp.mpf(1) / 2)


def chebyshev(moments):
    alpha, beta = [moments[1]], []
    before, current = [mp.mpf(0)] * len(moments), list(moments)
    for n in range(1, ORDER + 1):
        after = [mp.mpf(0)] * len(moments)
        for l in range(n, 2 * ORDER - n + 1):
            after[l] = current[l + 1] - alpha[n - 1] * current[l] - (beta[-1] if beta else 0) * before[l]
        beta.append(after[n] / current[n - 1])
        if n < ORDER:
            alpha.append(after[n + 1] / after[n] - current[n] / current[n - 1])
        before, current = current, after
    return alpha, beta


def quantile(cdf, support, p, upper, mean, sigma):
    """Bisection in the distance from the nearer end, or from the mean, then the secant method."""
    low, high = support
    tail = (lambda x: 1 - cdf(x)) if upper else cdf
    with mp.workdps(60):
        lo, hi = low, mean if mp.isinf(high) else high
        while mp.isinf(high) and tail(hi) > p if upper else mp.isinf(high) and tail(hi) < p:
            hi = mean + 2 * (hi - mean) + sigma
        at = lambda t: low + mp.exp(t) if not upper or mp.isinf(high) else high - mp.exp(t)
        a, b = mp.log(hi - lo) - 10**6, mp.log(hi - lo)
        rising = (tail(at(a)) - p) < 0
        for _ in range(170):
            middle = (a + b) / 2
            if (tail(at(middle)) < p) == rising:
                a = middle
            else:
                b = middle
        return at((a + b) / 2)


def case(kind, parameters, build, quantiles=True):
    raw, origin, scale, cdf, support = build(*[mp.mpf(parameter) for parameter in parameters])
    m = raw[1]
    central = [sum(mp.binomial(n, j) * raw[j] * (-m) ** (n - j) for j in range(n + 1)) for n in range(21)]
    s = mp.sqrt(central[2])
    u = [central[n] / s**n for n in range(21)]
    mean, sigma = origin + scale * m, scale * s
    alpha, beta = chebyshev(u)
    digits = lambda x: float(x)
    found = {
        "kind": kind,
        "parameters": parameters,
        "mean": digits(mean),
        "sigma": digits(sigma),
        "moments": [digits(x) for x in [u[3], u[4] - 3, u[5], u[6], u[7], u[8]]],
        "h": [
            digits(u[6] - 3 * u[4] + 2 - 2 * u[3] ** 2),
            digits(u[7] - 3 * u[5] + 6 * u[3] - 3 * u[3] * u[4]),
            digits(u[8] - 4 * u[6] + 6 * u[4] - 3 - 3 * (u[4] - 1) ** 2),
        ],
        "alpha": [digits(x) for x in alpha],
        "beta": [digits(x) for x in beta],
    }
    if quantiles:
        tails = [(p, upper) for p in [1e-12, 1e-6, 1e-2, 0.5] for upper in [False, True]]
        found["quantiles"] = [
            # In sigmas from the mean, which has more digits than the value itself.
            [p, upper, digits((quantile(cdf, support, mp.mpf(p), upper, mean, sigma) - mean) / sigma)]
            for p, upper in tails
        ]
    return found


CASES = [
    *[("triangular", [2.0, 0.5, lean], triangular) for lean in [0.0, 0.3, 1.0, -1.0, 0.999]],
    *[("trapezoidal", [2.0, 0.5, top], trapezoidal) for top in [0.0, 0.3, 0.999, 1.0]],
    *[
        ("truncated-normal", [0.0, 1.0, shift, sigma], truncated_normal)
        for shift, sigma in [
            (0.0, 1e3), (0.0, 1.0), (0.0, 1 / 3), (0.0, 0.125), (0.5, 1 / 3), (0.5, 1e3), (3.0, 0.5), (-1.5, 0.125), (6.0, 0.25),
        ]
    ],
    *[
        ("beta", [0.0, 1.0, a, b], beta)
        for a, b in [(1e6, 1e6), (0.5, 0.5), (0.5, 3.0), (2.0, 5.0), (1.0, 1.0), (3.0, 1e5), (0.01, 0.02), (150.0, 0.7)]
    ],
    ("u-shaped", [2.0, 0.5], u_shaped),
    ("octahedron", [2.0, 0.5], octahedron),
    ("bicone", [2.0, 0.5], bicone),
    *[("curvilinear-trapezoid", [2.0, 0.5, d], curvilinear_trapezoid) for d in [1e-6, 0.1, 0.3, 0.499]],
    *[("gamma", [0.0, 1.0, sigma], gamma) for sigma in [1e-4, 0.02, 0.3, 1.0, 3.0, 20.0]],
    *[("lognormal", [0.0, 1.0, sigma], lognormal) for sigma in [1e-4, 0.02, 0.3, 1.0, 90.0]],
    *[("weibull", [0.0, 1.0, sigma], weibull) for sigma in [1e-4, 0.02, 0.27, 0.5, 1.0, 3.0, 30.0]],
    ("exponential", [0.5, 2.0], exponential),
    ("rayleigh", [0.5, 2.0], rayleigh),
]

# Incomplete beta and gamma functions with such parameters take mpmath too long.
SLOW = [("beta", 1e6), ("beta", 1e5), ("gamma", 1e-4)]

cases = []
for kind, parameters, build in CASES:
    slow = any(kind == of and value in parameters for of, value in SLOW)
    cases.append(case(kind, parameters, build, quantiles=not slow))
    print(kind, parameters, flush=True)
lines = ",\n".join(json.dumps(one) for one in cases)
pathlib.Path(__file__).parents[1].joinpath("distributions.json").write_text(f"[\n{lines}\n]\n")
