"""Moments by dimension reduction and by three-point products, from brute-force sums over whole grids in 60 digits.

Gauss rules come from the exact moments of each input: the roots of the orthogonal polynomial are those of a determinant of
moments, the weights solve the moment equations. The reduced function is then evaluated at every point of the full product of the
rules, and its moments are weighted sums over that product: no cumulants, no decomposition.
"""

import itertools
import json
import pathlib

import mpmath as mp

mp.mp.dps = 60
F = mp.mpf


def normal(mean, sigma):
    central = lambda n: mp.fac2(n - 1) * sigma**n if n % 2 == 0 else F(0)
    return lambda n: sum(mp.binomial(n, k) * mean ** (n - k) * central(k) for k in range(n + 1))


def uniform(lower, upper):
    return lambda n: (upper ** (n + 1) - lower ** (n + 1)) / (n + 1) / (upper - lower)


def exponential(mean):
    return lambda n: mp.factorial(n) * mean**n


def triangular(lower, mode, upper):
    height = 2 / (upper - lower)

    def piece(a, b, n):
        """Density height (x - a)/(b - a) between a and b, whichever is larger."""
        power = lambda p: (max(a, b) ** (p + 1) - min(a, b) ** (p + 1)) / (p + 1)
        return height * (power(n + 1) - a * power(n)) / (b - a)

    return lambda n: piece(lower, mode, n) + piece(upper, mode, n)


INPUTS = {
    "a": normal(F("0.5"), F("0.4")),
    "b": uniform(F("0.3"), F("1.7")),
    "c": exponential(F("0.8")),
    "d": triangular(F("0"), F("0.25"), F("1")),
}


def function(a, b, c, d):
    return mp.exp(F("0.3") * a) * mp.sin(b + F("0.2") * c) + a * b * d / 5 + mp.sqrt(1 + c * c + d) + b * c * d / 4


def gauss(moment, m):
    """Nodes and weights of m points that integrate up to degree 2 m - 1."""
    hankel = mp.matrix(m, m)
    right = mp.matrix(m, 1)
    for i in range(m):
        right[i] = -moment(m + i)
        for j in range(m):
            hankel[i, j] = moment(i + j)
    coefficients = mp.lu_solve(hankel, right)
    monic = [F(1)] + [coefficients[m - 1 - i] for i in range(m)]
    nodes = sorted(mp.re(root) for root in mp.polyroots(monic, maxsteps=500, extraprec=400))
    return weights(nodes, moment)


def weights(nodes, moment):
    m = len(nodes)
    vandermonde = mp.matrix(m, m)
    right = mp.matrix(m, 1)
    for i in range(m):
        right[i] = moment(i)
        for j in range(m):
            vandermonde[i, j] = nodes[j] ** i
    solved = mp.lu_solve(vandermonde, right)
    return nodes, [solved[i] for i in range(m)]


def matched(moment, lower):
    """The mean and two levels that match four moments; a Gauss rule of three where a level would lie below the support."""
    mean = moment(1)
    central = lambda n: sum(mp.binomial(n, k) * moment(k) * (-mean) ** (n - k) for k in range(n + 1))
    sigma = mp.sqrt(central(2))
    skewness, kurtosis = central(3) / sigma**3, central(4) / sigma**4
    half = mp.sqrt(kurtosis - F(3) / 4 * skewness**2)
    levels = [mean + sigma * (skewness / 2 - half), mean, mean + sigma * (skewness / 2 + half)]
    return gauss(moment, 3) if lower is not None and levels[0] < lower else weights(levels, moment)


def summed(rules, value):
    """Mean, sigma, skewness and kurtosis over the full product of these rules."""
    places = [list(zip(*rule)) for rule in rules]
    grid = []
    for point in itertools.product(*places):
        weight = mp.mpf(1)
        for _, one in point:
            weight *= one
        grid.append((weight, value(*[x for x, _ in point])))
    mean = sum(w * y for w, y in grid)
    central = lambda n: sum(w * (y - mean) ** n for w, y in grid)
    sigma = mp.sqrt(central(2))
    return {
        "mean": mp.nstr(mean, 20),
        "sigma": mp.nstr(sigma, 20),
        "skewness": mp.nstr(central(3) / sigma**3, 20),
        "kurtosis": mp.nstr(central(4) / sigma**4, 20),
    }


def main():
    moments = list(INPUTS.values())
    means = [moment(1) for moment in moments]
    cache = {}

    def at(moved):
        """The function with these inputs elsewhere and all others at their means."""
        if moved not in cache:
            point = list(means)
            for j, x in moved:
                point[j] = x
            cache[moved] = function(*point)
        return cache[moved]

    def univariate(*x):
        return sum(at(((j, x[j]),)) for j in range(4)) - 3 * at(())

    def bivariate(*x):
        planes = sum(at(((j, x[j]), (k, x[k]))) for j in range(4) for k in range(j + 1, 4))
        return planes - 2 * sum(at(((j, x[j]),)) for j in range(4)) + 3 * at(())

    found = {"univariate": {}, "bivariate": {}}
    for m in (3, 5):
        rules = [gauss(moment, m) for moment in moments]
        found["univariate"][str(m)] = summed(rules, univariate)
        found["bivariate"][str(m)] = summed(rules, bivariate)
    seven = [gauss(moment, 7) for moment in moments]
    found["univariate"]["7"] = summed(seven, univariate)
    lowest = [None, F("0.3"), F(0), F(0)]
    found["three-point"] = summed([matched(m, low) for m, low in zip(moments, lowest)], function)
    path = pathlib.Path(__file__).parent.parent / "dimension-reduction.json"
    path.write_text(json.dumps(found, indent=2) + "\n")
    info = {
        "what": "Mean, sigma, skewness and kurtosis of a function of four inputs (normal, uniform, exponential, triangular) by univariate"
        " and bivariate dimension reduction with 3, 5 and 7 nodes, and by the product of three-point rules",
        "method": "sums over the full product of Gauss rules in 60 digits, rules from exact moments by determinants and moment equations;"
        " no cumulants, no decomposition",
        "origin": "computed for this project by generators/dimension_reduction.py (mpmath)",
        "tolerance": "1e-11: the rules of the engine are good to some units in the last place, a fourth moment to four times as many",
    }
    path.with_suffix(".info.json").write_text(json.dumps(info, indent=2) + "\n")


main()
