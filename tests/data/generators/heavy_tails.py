"""Functions whose moments have closed forms, from light tails to heavy ones: mean, sigma, skewness, kurtosis.

None of them was used to choose from which share of its largest points on a moment of a sample has not settled (crates/numeric/src/sampling/largest.rs).
Raw moments 1 to 4 are exact (fractions, or exponentials in 40 digits) for products and powers; cumulants add up for sums. A moment that is
infinite is null. Needs mpmath.
"""

import json
import pathlib
from math import factorial

import mpmath as mp

mp.mp.dps = 40


def figures(raw):
    """Of raw moments 1 to 4."""
    m1, m2, m3, m4 = [mp.mpf(m) for m in raw]
    v = m2 - m1**2
    t = m3 - 3 * m1 * m2 + 2 * m1**3
    q = m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
    return [m1, mp.sqrt(v), t / v**mp.mpf("1.5"), q / v**2]


def cumulants(of):
    m, s, g, k = of
    return [m, s**2, g * s**3, (k - 3) * s**4]


def total(parts):
    """Figures of a sum of independent variables, each times its factor."""
    sums = [mp.mpf(0)] * 4
    for factor, of in parts:
        for order, cumulant in enumerate(cumulants(of)):
            sums[order] += mp.mpf(factor) ** (order + 1) * cumulant
    m, v, t, q = sums
    s = mp.sqrt(v)
    return [m, s, t / s**3, 3 + q / v**2]


def lognormal(s):
    return figures([mp.exp(mp.mpf(k * k) * mp.mpf(s) ** 2 / 2) for k in range(1, 5)])


def normal_power(p):
    """Of z^p."""
    return figures([mp.fac2(p * k - 1) if p * k % 2 == 0 else 0 for k in range(1, 5)])


def product(n, s):
    """Of n factors 1 + s z."""
    one = [1, 1 + s**2, 1 + 3 * s**2, 1 + 6 * s**2 + 3 * s**4]
    return figures([mp.mpf(m) ** n for m in one])


def products_of_normals(n):
    return figures([0, 1, 0, mp.mpf(3) ** n])


def student(degrees):
    return [mp.mpf(0), mp.mpf(1), mp.mpf(0), 3 + mp.mpf(6) / (degrees - 4)]


def over(low, high):
    """Of 1/u, u uniform."""
    low, high = mp.mpf(low), mp.mpf(high)
    raw = [(mp.log(high) - mp.log(low)) / (high - low)]
    raw += [(low ** (1 - k) - high ** (1 - k)) / ((k - 1) * (high - low)) for k in (2, 3, 4)]
    return figures(raw)


NORMAL = [mp.mpf(0), mp.mpf(1), mp.mpf(0), mp.mpf(3)]
UNIFORM = [mp.mpf(0), mp.sqrt(mp.mpf(1) / 3), mp.mpf(0), mp.mpf("1.8")]
EXPONENTIAL = figures([factorial(k) for k in range(1, 5)])
Z = "{ nominal = 0.0, sigma = 1.0 }"
U = '{ nominal = 0.0, tolerance = 1.0, distribution = "uniform" }'
E = '{ nominal = 1.0, distribution = "exponential" }'


def names(n):
    return [f"x{i}" for i in range(n)]


def case(name, light, dimensions, formula, of):
    lines = "".join(f"{key} = {value}\n" for key, value in dimensions.items())
    study = f"[dimensions]\n{lines}[characteristics]\ny = {{ formula = \"{formula}\" }}\n"
    return {"name": name, "light": light, "study": study, "figures": [None if m is None else float(m) for m in of]}


def sums(n, one):
    return dict.fromkeys(names(n), one)


cases = [
    case("sum of normals", True, sums(5, Z), "x0 + x1 + x2 + x3 + x4", total([(1, NORMAL)] * 5)),
    case("sum of uniforms", True, sums(4, U), "x0 + x1 + x2 - x3", total([(1, UNIFORM)] * 4)),
    case("bent a little", True, sums(2, Z), "x0 + 0.05*x1^2 + x1", total([(1, NORMAL), (1, figures([mp.mpf("0.05"), 1 + 3 * mp.mpf("0.05") ** 2, 3 * mp.mpf("0.05") * 3 + 15 * mp.mpf("0.05") ** 3, 3 + 6 * 15 * mp.mpf("0.05") ** 2 + 105 * mp.mpf("0.05") ** 4]))])),
    case("product of two", True, sums(2, Z), "(1 + 0.05*x0)*(1 + 0.05*x1)", product(2, mp.mpf("0.05"))),
    case("sum of nine exponentials", False, sums(9, E), " + ".join(names(9)), total([(1, EXPONENTIAL)] * 9)),
    case("lognormal 0.7", False, sums(2, Z), "exp(0.42*x0 + 0.56*x1)", lognormal("0.7")),
    case("lognormal 1.1", False, sums(1, Z), "exp(1.1*x0)", lognormal("1.1")),
    case("lognormal 1.4", False, sums(1, Z), "exp(1.4*x0)", lognormal("1.4")),
    case("sum of lognormals", False, sums(5, Z), "exp(0.4*x0) + exp(0.5*x1) + exp(0.6*x2) + exp(0.7*x3) + exp(0.9*x4)", total([(1, lognormal(s)) for s in ("0.4", "0.5", "0.6", "0.7", "0.9")])),
    case("lognormal in a normal sum", False, sums(2, Z), "6*x0 + exp(1.2*x1)", total([(6, NORMAL), (1, lognormal("1.2"))])),
    case("eight factors", False, sums(8, Z), "*".join(f"(1 + 0.25*{x})" for x in names(8)), product(8, mp.mpf("0.25"))),
    case("three normal factors", False, sums(3, Z), "x0*x1*x2", products_of_normals(3)),
    case("fourth power", False, sums(1, Z), "x0^4", normal_power(4)),
    case("square of an exponential", False, sums(1, E), "x0^2", figures([factorial(2 * k) for k in range(1, 5)])),
    case("student 7", False, {"x0": '{ nominal = 0.0, sigma = 1.0, distribution = { kind = "student", degrees = 7.0 } }'}, "2*x0", [2 * m if i == 1 else m for i, m in enumerate(student(7))]),
    case("student 5 and normals", False, {"x0": '{ nominal = 0.0, sigma = 1.0, distribution = { kind = "student", degrees = 5.0 } }', "x1": Z}, "x0 + x1", total([(1, student(5)), (1, NORMAL)])),
    case("student 3.5", False, {"x0": '{ nominal = 0.0, sigma = 1.0, distribution = { kind = "student", degrees = 3.5 } }', "x1": Z}, "x0 + 0*x1", [mp.mpf(0), mp.mpf(1), mp.mpf(0), None]),
    case("divisor near zero", False, {"x0": '{ nominal = 0.505, tolerance = 0.495, distribution = "uniform" }'}, "1/x0", over("0.01", "1")),
    case("divisor nearer zero", False, {"x0": '{ nominal = 0.5005, tolerance = 0.4995, distribution = "uniform" }', "x1": Z}, "1/x0 + 0.1*x1", total([(1, over("0.001", "1")), (mp.mpf("0.1"), NORMAL)])),
]
lines = ",\n".join(json.dumps(one) for one in cases)
pathlib.Path(__file__).parents[1].joinpath("heavy-tails.json").write_text(f"[\n{lines}\n]\n")
