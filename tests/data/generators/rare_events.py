"""Probabilities of published reliability problems, and of some functions whose rejects a surrogate does not know: no sampling.

Each is an integral over one variable of what the normal distribution says of the other (Simpson's rule), a closed form, or a convolution.
Only the standard library. Run: python rare_events.py > ../rare-events.json
"""
import json
import math


def cdf(z):
    return 0.5 * math.erfc(-z / math.sqrt(2))


def density(z):
    return math.exp(-0.5 * z * z) / math.sqrt(2 * math.pi)


def mean(f, low=-10.0, high=10.0, cells=200_000):
    """The integral of f times the normal density, by Simpson's rule."""
    step = (high - low) / cells
    total = 0.0
    for i in range(cells + 1):
        z = low + i * step
        total += (1 if i in (0, cells) else 4 if i % 2 else 2) * f(z) * density(z)
    return total * step / 3


def four_branches():
    # With u = (x1 + x2)/sqrt 2 and v = (x1 - x2)/sqrt 2 the branches are u = +-(3 + 0.2 v^2) and v = +-3.5.
    inner = mean(lambda v: 2 * cdf(-(3 + 0.2 * v * v)), -3.5, 3.5)
    return 2 * cdf(-3.5) + inner


def rp8():
    # x1 + 2 x2 + 2 x3 + x4 < 5 (x5 + x6): both sides convolved on a grid.
    def lognormal(m, s, factor):
        square = math.log(1 + (s / m) ** 2)
        return math.log(m * factor) - 0.5 * square, math.sqrt(square)

    step = 0.75

    def masses(law, last):
        mu, sigma = law
        def below(x):
            return cdf((math.log(x) - mu) / sigma) if x > 0 else 0.0
        return [below((i + 0.5) * step) - below((i - 0.5) * step) for i in range(int(last / step) + 1)]

    def convolved(a, b, last):
        size = int(last / step) + 1
        out = [0.0] * size
        for i, p in enumerate(a):
            if p > 1e-18:
                for j, q in enumerate(b[: size - i]):
                    out[i + j] += p * q
        return out

    single, double = lognormal(120, 12, 1), lognormal(120, 12, 2)
    left = convolved(masses(single, 300), masses(single, 300), 1100)
    left = convolved(left, convolved(masses(double, 600), masses(double, 600), 1100), 1600)
    right = convolved(masses(lognormal(50, 10, 5), 2500), masses(lognormal(40, 8, 5), 2500), 3000)
    # Beyond the right grid lies less than 1e-12.
    beyond, tail = [0.0] * len(right), 0.0
    for j in reversed(range(len(right))):
        beyond[j] = tail + 0.5 * right[j]
        tail += right[j]
    return sum(p * beyond[i] for i, p in enumerate(left))


def rp25():
    def given(x):
        low = (x * x + 16) / 8
        high = math.sqrt(max(0.0, 16 * x - 32))
        return cdf(-low) - cdf(-high) if high > low else 0.0
    # From 2 on both can be negative; the ends are roots of a quartic, which Simpson's rule meets to 1e-5 of a cell.
    return mean(given, 2.0, 10.0, 800_000)


def rp28():
    # x1 x2 < 146.14.
    return mean(lambda z: cdf((146.14 / (0.0104 + 0.00156 * z) - 78064.4) / 11709.7), -6.5, 10.0)


def rp35():
    def given(x):
        first = 2 + math.exp(-0.1 * x * x) + (0.2 * x) ** 4
        if x > 0:
            return cdf(-min(first, 4.5 / x))
        return cdf(-first) + (cdf(4.5 / x) if x < 0 else 0.0)
    return mean(given)


problems = {
    "four-branches": (four_branches(), 2.22e-3, "Waarts 2000, with 7/sqrt 2"),
    "rp8": (rp8(), 7.84e-4, "Rozsas and Slobbe 2019, RP8"),
    "rp22": (mean(lambda v: cdf(-(2.5 + 0.2 * v * v))), 4.16e-3, "RP22"),
    "rp24": (mean(lambda u: cdf(-(2.5 + 0.00463 * 324 * u**4) / (0.2357 * 3 * math.sqrt(2)))), 2.86e-3, "RP24"),
    "rp25": (rp25(), 6.14e-6, "RP25"),
    "rp28": (rp28(), 1.46e-7, "RP28"),
    "rp33": (cdf(-3) + mean(lambda x: cdf((x - 3 * math.sqrt(3)) / math.sqrt(2)), -10.0, 3.0), 2.57e-3, "RP33"),
    "rp35": (rp35(), 3.48e-3, "RP35"),
    "rp107": (cdf(-5), 2.92e-7, "RP107"),
    "rp110": (1 - (1 - cdf(-4)) * (1 - cdf(-5)), 3.19e-5, "RP110"),
    "wrap-far": (cdf(-4.2), None, "atan2(4.2 + q, -50 + p/2) below 160 degrees: q crosses the cut"),
    "step-rare": (cdf(-3.9) * cdf(4) + (1 - cdf(-3.9)) * cdf(-8), None, "a + 12 [b > 3.9] above 8"),
    "max-rare": (mean(lambda b: cdf(3 * max(0.0, b - 3.8) - 4.5), -10, 3.8) + mean(lambda b: cdf(3 * (b - 3.8) - 4.5), 3.8, 12),
                 None, "a + 3 max(0, b - 3.8) above 4.5"),
    "two-sides": (cdf(-4.6) + cdf(-4.5) - cdf(-4.6) * cdf(-4.5), None, "min(4.6 - a, 4.5 + b) below 0"),
}
print(json.dumps({name: {"probability": p, "published": published, "what": what}
                  for name, (p, published, what) in problems.items()}, indent=2))
