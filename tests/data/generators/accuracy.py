"""The test functions of docs/accuracy.md: a study of each, and its moments by another route than sensitol's.

Tensor Gauss quadrature in each dimension's own distribution (with two orders, whose difference is the stated error), sums of
independent groups by their cumulants, functions of a normal sum by one-dimensional quadrature, products by their raw moments
with 60 digits, quadratics by the traces of their matrices, kinks by adaptive quadrature on either side. numpy, scipy, mpmath.

    python3 accuracy.py        writes ../accuracy/*.toml and ../accuracy.json
"""
import itertools
import json
import math
import os
import re

import mpmath
import numpy as np
from numpy.polynomial.hermite_e import hermegauss
from numpy.polynomial.laguerre import laggauss
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad
from scipy.special import roots_jacobi
from scipy.stats import norm

HERE = os.path.dirname(os.path.abspath(__file__))
OUT = os.path.join(HERE, "..", "accuracy")
CASES = []


# ---- distributions: (mean, spread, kind); spread is sigma of a normal, half the width of a band, sigma of a tail ----
def N(mean, sigma):
    return ("normal", mean, sigma)


def U(mean, half):
    return ("uniform", mean, half)


def T(mean, half):
    return ("triangular", mean, half)


def E(mean):
    return ("exponential", mean, mean)


def LN(mean, sigma):
    return ("lognormal", mean, sigma)


def B(mean, half, a, b):
    return ("beta", mean, half, a, b)


def rule(d, m):
    kind, mean, spread = d[:3]
    if kind == "normal":
        x, w = hermegauss(m)
        x = mean + spread * x
    elif kind == "uniform":
        x, w = leggauss(m)
        x = mean + spread * x
    elif kind == "triangular":
        x, w = leggauss(m)
        left, right = -0.5 + 0.5 * x, 0.5 + 0.5 * x
        w = np.concatenate([w * (1 + left), w * (1 - right)])
        x = mean + spread * np.concatenate([left, right])
    elif kind == "exponential":
        x, w = laggauss(m)
        x = mean * x
    elif kind == "lognormal":
        x, w = hermegauss(m)
        s = math.sqrt(math.log1p((spread / mean) ** 2))
        x = np.exp(math.log(mean) - 0.5 * s * s + s * x)
    elif kind == "beta":
        x, w = roots_jacobi(m, d[4] - 1, d[3] - 1)
        x = mean + spread * x
    return x, w / w.sum()


def toml(d):
    kind, mean, spread = d[:3]
    if kind == "normal":
        return f"{{ nominal = {mean!r}, sigma = {spread!r} }}"
    if kind in ("uniform", "triangular"):
        return f'{{ nominal = {mean!r}, tolerance = {spread!r}, distribution = "{kind}" }}'
    if kind == "exponential":
        return f'{{ nominal = {mean!r}, distribution = "exponential", sigma = {spread!r} }}'
    if kind == "lognormal":
        return f'{{ nominal = {mean!r}, sigma = {spread!r}, distribution = "lognormal" }}'
    return f'{{ nominal = {mean!r}, tolerance = {spread!r}, distribution = {{ kind = "beta", alpha = {d[3]!r}, beta = {d[4]!r} }} }}'


# ---- formulas: the grammar of studies, evaluated by numpy ----
NAMES = {
    "sqrt": np.sqrt, "exp": np.exp, "ln": np.log, "log10": np.log10, "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin,
    "acos": np.arccos, "atan": np.arctan, "atan2": np.arctan2, "tanh": np.tanh, "sinh": np.sinh, "cosh": np.cosh, "abs": np.abs,
    "hypot": np.hypot, "min": lambda *a: np.minimum.reduce(np.broadcast_arrays(*a)),
    "max": lambda *a: np.maximum.reduce(np.broadcast_arrays(*a)), "pi": math.pi, "deg": math.pi / 180,
}


def function(formula):
    code = compile(formula.replace("^", "**"), formula, "eval")
    return lambda at: eval(code, {**NAMES, **at})


def used(formula, dims):
    words = set(re.findall(r"[A-Za-z_]\w*", formula))
    return {k: d for k, d in dims.items() if k in words}


def central(y, w):
    mean = float((w * y).sum())
    c = y - mean
    return [mean] + [float((w * c**r).sum()) for r in (2, 3, 4)]


def tensor_moments(f, dims, order):
    rules = [rule(d, order[k] if isinstance(order, dict) else order) for k, d in dims.items()]
    grids = np.meshgrid(*[r[0] for r in rules], indexing="ij", sparse=True)
    w = np.ones(1)
    for r in rules:
        w = np.multiply.outer(w, r[1])
    y = np.broadcast_to(f(dict(zip(dims, grids))), w.shape[1:] if w.ndim > len(rules) else w.shape)
    return central(y.ravel(), w.ravel())


def cumulants(c):
    return [c[0], c[1], c[2], c[3] - 3 * c[1] ** 2]


def of_cumulants(k):
    return dict(mean=k[0], sigma=math.sqrt(k[1]), skewness=k[2] / k[1] ** 1.5, kurtosis=3 + k[3] / k[1] ** 2)


def by_groups(groups, dims, order):
    """Sum of independent groups; the order is for all dimensions of a group."""
    total = np.zeros(4)
    for formula in groups:
        total += np.array(cumulants(tensor_moments(function(formula), used(formula, dims), order)))
    return of_cumulants(total)


def order_for(n):
    return {1: 64, 2: 48, 3: 32, 4: 24, 5: 14, 6: 11, 7: 8, 8: 7}[n]


def add(name, source, dims, formula, reference, method, smooth=True, error=None, extra=""):
    CASES.append(dict(name=name, source=source, dims=dims, formula=formula, reference=reference, method=method,
                      smooth=smooth, error=error, extra=extra))


def grouped(name, source, dims, groups, smooth=True, order=None):
    most = max(len(used(g, dims)) for g in groups)
    hi = order or order_for(most)
    lo = hi - 2
    a, b = by_groups(groups, dims, hi), by_groups(groups, dims, lo)
    error = max(abs(a["sigma"] / b["sigma"] - 1), 1e-14)
    method = f"tensor Gauss quadrature, {hi} nodes" + (", sum of cumulants" if len(groups) > 1 else "")
    add(name, source, dims, " + ".join(groups), a, method, smooth, error)


def of_sum(name, source, dims, weights, outer, smooth=True):
    """outer(t) of t = sum of weights times normal dimensions."""
    mean = sum(weights[k] * d[1] for k, d in dims.items())
    sigma = math.sqrt(sum((weights[k] * d[2]) ** 2 for k, d in dims.items()))
    t = " + ".join(f"{weights[k]!r}*{k}" for k in dims)
    f = function(outer)
    a = of_cumulants(cumulants(tensor_moments(f, {"t": N(mean, sigma)}, 64)))
    b = of_cumulants(cumulants(tensor_moments(f, {"t": N(mean, sigma)}, 48)))
    error = max(abs(a["sigma"] / b["sigma"] - 1), 1e-14)
    formula = re.sub(r"\bt\b", f"({t})", outer)
    add(name, source, dims, formula, a, "Gauss quadrature, 64 nodes, of the normal sum", smooth, error)


def product(name, source, dims):
    """Product of all dimensions, by raw moments with 60 digits."""
    mpmath.mp.dps = 60
    raw = [mpmath.mpf(1)] * 4
    for kind, mean, spread in dims.values():
        m, s = mpmath.mpf(mean), mpmath.mpf(spread)
        v = s * s if kind == "normal" else s * s / 3
        f = 3 * v * v if kind == "normal" else s**4 / 5
        one = [m, m**2 + v, m**3 + 3 * m * v, m**4 + 6 * m * m * v + f]
        raw = [a * b for a, b in zip(raw, one)]
    m1, m2, m3, m4 = raw
    c2, c3, c4 = m2 - m1**2, m3 - 3 * m1 * m2 + 2 * m1**3, m4 - 4 * m1 * m3 + 6 * m1**2 * m2 - 3 * m1**4
    reference = dict(mean=float(m1), sigma=float(mpmath.sqrt(c2)), skewness=float(c3 / c2**1.5), kurtosis=float(c4 / c2**2))
    add(name, source, dims, "*".join(dims), reference, "raw moments with 60 digits", error=1e-15)


def quadratic(name, source, dims, pairs, slopes):
    """Sum of slopes times standardised normal dimensions and products of two of them."""
    keys = list(dims)
    n = len(keys)
    b, h = np.array(slopes, float), np.zeros((n, n))
    for (j, k), v in pairs.items():
        h[j, k] = h[k, j] = 0.5 * v
    h2 = h @ h
    var = b @ b + 2 * np.trace(h2)
    k3 = 6 * b @ h @ b + 8 * np.trace(h2 @ h)
    k4 = 48 * b @ h2 @ b + 48 * np.trace(h2 @ h2)
    formula = " + ".join([f"{s!r}*{k}" for s, k in zip(slopes, keys)] + [f"{v!r}*{keys[j]}*{keys[k]}" for (j, k), v in pairs.items()])
    add(name, source, dims, formula, of_cumulants([0.0, var, k3, k4]), "traces of the matrix of a normal quadratic", error=1e-14)


def closed(name, source, dims, formula, reference, method, smooth=False, error=1e-10, extra=""):
    add(name, source, dims, formula, reference, method, smooth, error, extra)


def by_density(density, points, g=lambda y: y):
    """Moments of g(t) where t has this density: adaptive quadrature between the points."""
    def integral(f):
        return sum(quad(lambda t: f(g(t)) * density(t), a, b, epsabs=1e-13, epsrel=1e-12, limit=400)[0]
                   for a, b in zip(points, points[1:]))
    mean = integral(lambda y: y)
    c = [integral(lambda y, r=r: (y - mean) ** r) for r in (2, 3, 4)]
    return of_cumulants([mean, c[0], c[1], c[2] - 3 * c[0] ** 2])


def names(prefix, n):
    return [f"{prefix}{i + 1}" for i in range(n)]


def build():
    own = "own"
    # linear
    d = {"bore": N(25.02, 0.0033), "shaft": N(24.98, 0.002), "shim": U(0.01, 0.003)}
    grouped("linear-3", own + ": a clearance", d, ["bore", "-shaft", "-shim"])
    scales = [1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12]
    d = {f"x{i + 1}": N(5 * s, 0.1 * s) for i, s in enumerate(scales)}
    grouped("linear-scales-8", own + ": units from 1e-12 to 1e12", d, [f"{1 / s!r}*x{i + 1}" for i, s in enumerate(scales)])
    d = {k: (U if i % 2 else N)(10.0 + i, 0.1) for i, k in enumerate(names("x", 20))}
    grouped("linear-20", own + ": a stack of plates", d, list(d))
    d = {k: (T if i % 3 else N)(5.0, 0.05 + 0.001 * i) for i, k in enumerate(names("x", 200))}
    grouped("linear-200", own + ": a long stack", d, [f"{1 + 0.01 * i!r}*{k}" for i, k in enumerate(d)])
    # separable
    grouped("cosine-1", own + ": a projected length", {"th": N(0.0, 2.0)}, ["100*cos(th*deg)"])
    grouped("reciprocal-1", own + ": a resistor's current", {"R": N(10.0, 0.5)}, ["12/R"])
    grouped("wide-exponential-1", own + ": a doping profile", {"x": N(0.0, 0.4)}, ["exp(x)"])
    d = {k: U(10.0 * i, 3.0) for i, k in enumerate(names("th", 4), 1)}
    grouped("separable-cosines-4", own + ": a folded sheet of four flanges", d, [f"{20 + i!r}*cos({k}*deg)" for i, k in enumerate(d)])
    d = {k: N(0.0, 0.5) for k in names("x", 5)}
    grouped("separable-sines-5", own + ": odd functions, no curvature at the means", d, [f"{1 + 0.2 * i!r}*sin({k})" for i, k in enumerate(d)])
    d = {k: N(0.2 * i, 0.2) for i, k in enumerate(names("x", 6))}
    grouped("separable-exponentials-6", own, d, [f"exp({k})" for k in d])
    d = {k: N(0.3, 0.2 + 0.02 * i) for i, k in enumerate(names("x", 10))}
    grouped("separable-cubics-10", own, d, [f"({k} + 0.5*{k}^3)" for k in d])
    d = {k: LN(4.0, 0.5) for k in names("x", 12)}
    grouped("separable-roots-12", own + ": lognormal areas", d, [f"sqrt({k})" for k in d])
    d = {k: N(1.0, 0.1) for k in names("x", 40)}
    forms = ["cos({0})", "exp(0.5*{0})", "3*{0}", "{0}^2", "1/{0}"]
    grouped("separable-40", own, d, [forms[i % 5].format(k) for i, k in enumerate(d)])
    d = {k: (N if i % 2 else U)(0.0, 1.0) for i, k in enumerate(names("x", 30))}
    grouped("separable-parabolas-30", own, d, [f"({k} + {0.02 * i!r}*{k}^2)" for i, k in enumerate(d)])
    # products
    product("area-2", own, {"w": N(20.0, 0.1), "h": N(10.0, 0.1)})
    product("volume-3", own + ": 5 % of each edge", {"a": N(2.0, 0.1), "b": N(3.0, 0.15), "c": U(4.0, 0.3)})
    product("product-of-zero-means-2", own + ": no slope at all", {"x": N(0.0, 1.0), "y": N(0.0, 2.0)})
    product("gear-train-8", own + ": ratios", {k: N(1.0 + 0.1 * i, 0.02) for i, k in enumerate(names("r", 8))})
    product("product-20", own, {k: N(1.0, 0.02) for k in names("x", 20)})
    product("product-200", own + ": as the yield of 200 steps", {k: N(1.0, 0.005) for k in names("x", 200)})
    grouped("ratio-2", own + ": a stress", {"F": N(1000.0, 50.0), "A": N(20.0, 0.6)}, ["F/A"])
    # mechanics
    d = {"F": N(500.0, 25.0), "L": N(800.0, 2.0), "Em": N(2.1e5, 4000.0), "b": N(30.0, 0.3), "h": N(40.0, 0.3)}
    grouped("cantilever-5", "Timoshenko, Strength of Materials (1930): end load on a cantilever", d, ["4*F*L^3/(Em*b*h^3)"])
    d = {"G": N(79300.0, 1000.0), "d": N(2.0, 0.02), "D": N(20.0, 0.15), "n": U(10.0, 0.25)}
    grouped("spring-rate-4", "Wahl, Mechanical Springs (1944)", d, ["G*d^4/(8*D^3*n)"])
    d = {"p": N(20.0, 0.5), "D": N(50.0, 0.05), "d": N(28.0, 0.05), "mu": U(0.05, 0.03)}
    grouped("cylinder-force-4", own + ": hydraulic cylinder with friction", d, ["p*pi/4*(D^2 - d^2)*(1 - mu)"])
    d = {"Cd": U(0.61, 0.02), "d": N(5.0, 0.03), "dp": N(1.0, 0.1), "rho": N(870.0, 8.0)}
    grouped("orifice-4", own + ": flow through an orifice", d, ["Cd*pi/4*d^2*sqrt(2*dp*1000/rho)"])
    d = {"L": N(10.0, 0.3), "C": LN(2.0, 0.1)}
    grouped("resonance-2", own + ": an LC circuit", d, ["1000/(2*pi*sqrt(L*C))"])
    d = {"a": N(55.29, 0.0422), "c1": N(22.86, 0.0042), "c2": N(22.86, 0.0042), "e": N(101.69, 0.0422)}
    grouped("one-way-clutch-4", "Fortini, Dimensioning for Interchangeable Manufacture (1967): contact angle of the clutch", d,
            ["acos((a + 0.5*(c1 + c2))/(e - 0.5*(c1 + c2)))/deg"], order=10)
    d = {"Rb1": U(100.0, 5.0), "Rb2": U(47.5, 2.0), "Rf": U(1.75, 0.1), "Rc1": U(1.85, 0.1), "Rc2": U(0.725, 0.05), "be": U(175.0, 25.0)}
    otl = "((12*Rb2/(Rb1 + Rb2) + 0.74)*be*(Rc2 + 9)/(be*(Rc2 + 9) + Rf) + 11.35*Rf/(be*(Rc2 + 9) + Rf) + 0.74*Rf*be*(Rc2 + 9)/((be*(Rc2 + 9) + Rf)*Rc1))"
    grouped("otl-circuit-6", "Ben-Ari and Steinberg (2007), push-pull circuit, a tenth of the ranges", d, [otl])
    d = {"M": U(45.0, 1.5), "S": U(0.0125, 0.0005), "V0": U(0.006, 0.0003), "k": U(3000.0, 150.0), "P0": U(1.0e5, 2000.0), "Ta": U(293.0, 2.0), "T0": U(350.0, 3.0)}
    A = "(P0*S + 19.62*M - k*V0/S)"
    V = f"(S/(2*k)*(sqrt({A}^2 + 4*k*P0*V0*Ta/T0) - {A}))"
    grouped("piston-7", "Kenett and Zacks, Modern Industrial Statistics (1998): cycle time of a piston", d, [f"2*pi*sqrt(M/(k + S^2*P0*V0*Ta/(T0*{V}^2)))"])
    d = {"rw": N(0.1, 0.005), "r": LN(2500.0, 300.0), "Tu": U(89335.0, 5000.0), "Hu": U(1050.0, 20.0), "Tl": U(89.55, 4.0), "Hl": U(760.0, 20.0), "L": U(1400.0, 60.0), "Kw": U(10950.0, 300.0)}
    grouped("borehole-8", "Harper and Gupta (1983), narrower ranges", d, ["2*pi*Tu*(Hu - Hl)/(ln(r/rw)*(1 + 2*L*Tu/(ln(r/rw)*rw^2*Kw) + Tu/Tl))"])
    # norms
    grouped("position-2", own + ": true position off the nominal", {"x": N(0.2, 0.05), "y": N(0.1, 0.05)}, ["2*sqrt(x^2 + y^2)"])
    grouped("distance-4", own + ": between two holes", {"x1": N(0.0, 0.1), "y1": N(0.0, 0.1), "x2": N(3.0, 0.1), "y2": N(4.0, 0.1)},
            ["hypot(x2 - x1, y2 - y1)"])
    grouped("diagonal-3", own, {"a": N(3.0, 0.2), "b": N(4.0, 0.2), "c": N(12.0, 0.2)}, ["sqrt(a^2 + b^2 + c^2)"])
    # linkages
    d = {"r": N(40.0, 0.05), "l": N(120.0, 0.05), "th": N(60.0, 1.0), "o": N(5.0, 0.05)}
    grouped("slider-crank-4", own + ": offset slider-crank", d, ["r*cos(th*deg) + sqrt(l^2 - (r*sin(th*deg) - o)^2)"])
    d = {"crank": N(40.0, 0.1), "coupler": N(120.0, 0.1), "follower": N(80.0, 0.1), "ground": N(100.0, 0.1), "th": N(60.0, 0.8)}
    s2 = "(crank^2 + ground^2 - 2*crank*ground*cos(th*deg))"
    grouped("four-bar-5", "Freudenstein (1955): angle between coupler and follower", d,
            [f"acos((coupler^2 + follower^2 - {s2})/(2*coupler*follower))/deg"])
    extra = """
[unknowns]
beta  = { start = 0.4, lower = -1.57, upper = 1.57 }
gamma = { start = 1.5, lower = 0.0, upper = 3.14 }

[loops]
linkage = [ { length = "crank", angle = "th*deg" }, { length = "coupler", angle = "beta" }, { length = "follower", angle = "gamma + pi" }, { length = "ground", angle = "pi" } ]
"""
    f = function(f"pi - acos((ground - crank*cos(th*deg))/sqrt({s2})) - 0")
    def gamma(at):
        cx, cy = at["crank"] * np.cos(at["th"] * math.pi / 180), at["crank"] * np.sin(at["th"] * math.pi / 180)
        dx, dy = cx - at["ground"], cy
        dd = np.hypot(dx, dy)
        al = np.arccos((at["follower"] ** 2 + dd**2 - at["coupler"] ** 2) / (2 * at["follower"] * dd))
        return (np.arctan2(dy, dx) - al) * 180 / math.pi
    a, b = (of_cumulants(cumulants(tensor_moments(gamma, d, m))) for m in (14, 12))
    closed("four-bar-implicit-5", "own: the follower's angle by its closed loop", d, "gamma/deg", a, "tensor Gauss quadrature, 14 nodes, of the closed form",
           True, max(abs(a["sigma"] / b["sigma"] - 1), 1e-12), extra)
    d = {"a": N(10.0, 0.1), "b": N(30.0, 0.1), "c": N(31.9, 0.1), "e": N(55.0, 0.1), "f": N(75.0, 0.5 / 3), "R": N(40.0, 0.1), "r": N(10.0, 0.1 / 3), "th": N(17.0, 1 / 3)}
    blocks = "f - r - (c + e/cos(th*deg) + (a - b)*tan(th*deg) - R*sin(th*deg)*tan(th*deg)) + (R - r)*sqrt(1 - ((R*sin(th*deg) + r)/(R - r))^2)"
    grouped("stacked-blocks-8", "Gao, Chase and Magleby (1998): stacked blocks", d, [blocks])
    d = {"th": N(30.0, 4.0), "l": N(100.0, 0.2)}
    grouped("toggle-2", own + ": a toggle near its dead centre", d, ["l*sin(th*deg)*tan(th*deg)"])
    # functions of a sum
    d = {k: N(0.1, 0.02) for k in names("x", 10)}
    of_sum("exponential-of-sum-10", own, d, {k: 1.0 + 0.1 * i for i, k in enumerate(d)}, "exp(t)")
    d = {k: N(1.0, 0.1) for k in names("x", 16)}
    of_sum("root-of-sum-16", own, d, {k: 1.0 for k in d}, "sqrt(t)")
    d = {k: N(1.0, 0.15) for k in names("x", 60)}
    of_sum("logarithm-of-sum-60", own, d, {k: 1.0 + 0.02 * i for i, k in enumerate(d)}, "ln(t)")
    d = {k: N(0.0, 1.0) for k in names("x", 50)}
    of_sum("square-of-sum-50", own, d, {k: 0.01 for k in d}, "(3 + t)^2")
    # sparse interactions
    d = {k: N(0.0, 1.0) for k in names("x", 50)}
    quadratic("sparse-25-of-50", own + ": 25 pairs of 1225", d, {(2 * i, 2 * i + 1): 0.5 for i in range(25)}, [1.0 + 0.02 * i for i in range(50)])
    d = {k: N(0.0, 1.0) for k in names("x", 100)}
    quadratic("sparse-ring-100", own + ": 100 neighbours of 4950 pairs", d, {(min(i, (i + 1) % 100), max(i, (i + 1) % 100)): 0.4 for i in range(100)}, [1.0] * 100)
    d = {k: (U if i % 2 else N)(1.0, 0.1) for i, k in enumerate(names("x", 60))}
    grouped("sparse-groups-60", own + ": twelve of sixty interact, three by three", d,
            [f"x{i + 1}*x{i + 2}*x{i + 3}" for i in range(0, 12, 3)] + [f"x{i + 1}" for i in range(12, 60)])
    d = {k: N(1.0, 0.05) for k in names("x", 80)}
    grouped("sparse-ratios-80", own + ": ten ratios among eighty", d, [f"2*x{i + 1}/x{i + 2}" for i in range(0, 20, 2)] + [f"x{i + 1}" for i in range(20, 80)])
    d = {k: N(0.0, 1.0) for k in names("x", 10)}
    quadratic("dense-quadratic-10", own + ": every pair", d, {(j, k): 0.1 + 0.02 * ((3 * j + 5 * k) % 7) for j, k in itertools.combinations(range(10), 2)}, [1.0] * 10)
    d = {k: N(0.0, 1.0) for k in names("x", 24)}
    quadratic("dense-quadratic-24", own + ": every pair, without a pattern", d,
              {(j, k): round(0.12 * math.sin(1.7 * j * k + 0.9 * j + 2.3 * k), 4) for j, k in itertools.combinations(range(24), 2)}, [1.0] * 24)
    # long tails and edges
    grouped("exponential-input-2", own + ": a film of exponential thickness", {"oil": E(0.5), "gap": N(10.0, 0.3)}, ["sqrt(gap)", "oil^1.5"])
    grouped("exponential-inputs-3", own, {"x": E(1.0), "y": E(1.0), "z": N(2.0, 0.2)}, ["x", "0.5*y^2", "z"])
    grouped("beta-2", own, {"x": B(1.0, 0.3, 2.0, 5.0), "y": T(2.0, 0.4)}, ["x^2*y"])
    # kinks
    both = "closed form of the normals' minimum (Clark 1961), higher moments by adaptive quadrature of its density"
    def minimum(m1, s1, m2, s2):
        density = lambda t: norm.pdf(t, m1, s1) * norm.sf(t, m2, s2) + norm.pdf(t, m2, s2) * norm.sf(t, m1, s1)
        lo, hi = min(m1 - 12 * s1, m2 - 12 * s2), max(m1 + 12 * s1, m2 + 12 * s2)
        return by_density(density, list(np.linspace(lo, hi, 41)))
    s = math.hypot(0.05, 0.05)
    d = {"a": N(10.0, 0.05), "b": N(9.0, 0.05), "c": N(12.0, 0.05), "e": N(11.0, 0.05)}
    closed("tied-gaps-4", own + ": the smaller of two equal gaps", d, "min(a - b, c - e)", minimum(1.0, s, 1.0, s), both)
    d = {"a": N(10.0, 0.05), "b": N(9.0, 0.05), "c": N(12.2, 0.05), "e": N(11.0, 0.05)}
    closed("unequal-gaps-4", own + ": the smaller of two gaps, three sigma apart", d, "min(a - b, c - e)", minimum(1.0, s, 1.2, s), both)
    m = 0.06
    closed("contact-2", own + ": a clearance that ends at contact", {"a": N(10.03, 0.036), "b": N(10.0, 0.048)}, "max(a - b, 0)",
           (lambda den: by_density(lambda t: norm.pdf(t, 0.03, m), [0.03 - 12 * m, 0.0, 0.03 + 12 * m], lambda t: max(t, 0.0)))(None),
           "adaptive quadrature on either side of the kink")
    closed("kink-at-the-mean-1", own + ": a size error without sign", {"x": N(0.0, 1.0)}, "abs(x)",
           dict(mean=math.sqrt(2 / math.pi), sigma=math.sqrt(1 - 2 / math.pi),
                skewness=math.sqrt(2) * (4 - math.pi) / (math.pi - 2) ** 1.5, kurtosis=3 + 8 * (math.pi - 3) / (math.pi - 2) ** 2),
           "closed form of the half-normal distribution", error=1e-15)
    sig = 0.05
    closed("position-at-zero-2", own + ": true position about the nominal, no slope and no curvature", {"x": N(0.0, sig), "y": N(0.0, sig)}, "hypot(x, y)",
           dict(mean=sig * math.sqrt(math.pi / 2), sigma=sig * math.sqrt(2 - math.pi / 2),
                skewness=2 * math.sqrt(math.pi) * (math.pi - 3) / (4 - math.pi) ** 1.5,
                kurtosis=3 - (6 * math.pi**2 - 24 * math.pi + 16) / (4 - math.pi) ** 2),
           "closed form of the Rayleigh distribution", error=1e-15)
    # saturating and wide
    grouped("saturating-3", own + ": smooth steps", {"x": N(0.5, 0.8), "y": N(0.0, 0.8), "z": N(-0.5, 0.8)}, ["tanh(x)", "tanh(y)", "tanh(z)"])
    grouped("gaussian-beam-2", own + ": coupling of two fibres", {"x": N(0.0, 0.4), "y": N(0.0, 0.4)}, ["exp(-x^2 - y^2)"])


def main():
    build()
    os.makedirs(OUT, exist_ok=True)
    references = {}
    for case in CASES:
        lines = [f'title = "{case["source"]}"', "", "[dimensions]"]
        lines += [f"{k} = {toml(d)}" for k, d in case["dims"].items()]
        if case["extra"]:
            lines += [case["extra"].strip("\n")]
        lines += ["", "[characteristics]", f'kc = {{ formula = "{case["formula"]}" }}', ""]
        with open(os.path.join(OUT, case["name"] + ".toml"), "w") as out:
            out.write("\n".join(lines))
        references[case["name"]] = dict(case["reference"], source=case["source"], dimensions=len(case["dims"]), smooth=case["smooth"],
                                        reference=case["method"], relative_error_of_sigma=case["error"])
        assert case["error"] < 2e-5, (case["name"], case["error"])
    with open(os.path.join(HERE, "..", "accuracy.json"), "w") as out:
        json.dump(references, out, indent=1)
        out.write("\n")
    print(len(CASES), "cases;", "largest error", max((c["error"], c["name"]) for c in CASES))


main()
