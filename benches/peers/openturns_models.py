"""Random points of five models in OpenTURNS, one thread: a symbolic function of a joint distribution, and the moments of its sample.

Blocks of 8192 points, as the other peers take them; mean, standard deviation, skewness and kurtosis of each block by OpenTURNS itself.
"""

import math

import openturns as ot

ot.TBB.Disable()
BLOCK = 8192


def sampled(law, function):
    """A function of a seed and a number of samples."""

    def run(seed, samples):
        ot.RandomGenerator.SetSeed(seed)
        for first in range(0, samples, BLOCK):
            y = function(law.getSample(min(BLOCK, samples - first)))
            y.computeMean(), y.computeStandardDeviation(), y.computeSkewness(), y.computeKurtosis()

    return run


def normals(named, formulas):
    """Of independent normal inputs by name, with mean and sigma."""
    law = ot.JointDistribution([ot.Normal(mean, sigma) for mean, sigma in named.values()])
    return sampled(law, ot.SymbolicFunction(list(named), formulas))


def engine():
    named = {"a": (0.05, 0.0001 / 3), "r": (0.0425, 0.00004 / 3), "l": (0.1345, 0.00004 / 3), "hp": (0.0973, 0.00004 / 3),
             "hc": (0.0372, 0.00004 / 3), "t": (0.0, 0.00872 / 3)}
    named |= {f"phi{n}": (phi, 0.00872 / 3) for n, phi in enumerate((0.0, math.pi, 3 * math.pi, 2 * math.pi))}
    scale = f"(0.427 + 0.597*hc/(hc + hp))*r*{628.3185**2!r}"
    shares = [f"(cos(t + phi{n}) + r/l*(2*cos(t + phi{n})^2 - 1))" for n in range(4)]
    moment = " + ".join(f"{n}*{share}" for n, share in enumerate(shares) if n)
    return normals(named, [f"{scale}*({' + '.join(shares)})", f"{scale}*a*({moment})"])


def clutch():
    named = {"hub": (55.29, 0.05 / 3), "roller": (22.86, 0.02 / 3), "cage": (101.69, 0.05 / 3)}
    return normals(named, ["acos((hub + roller)/(cage - roller))"])


def blocks():
    named = {"a": (10, 0.1), "b": (30, 0.1), "c": (31.9, 0.1), "e": (55, 0.1), "f": (75, 0.5 / 3), "big": (40, 0.1),
             "small": (10, 0.1 / 3), "th": (17 * math.pi / 180, math.pi / 540)}
    height = "(c + e/cos(th) + (a - b)*tan(th) - big*sin(th)*tan(th))"
    return normals(named, [f"f - small - {height} + (big - small)*cos(asin((big*sin(th) + small)/(big - small)))"])


def uniforms():
    names = [f"x{i}" for i in range(1000)]
    law = ot.JointDistribution([ot.Uniform(0.9, 1.1)] * len(names))
    return sampled(law, ot.SymbolicFunction(names, [" + ".join(names)]))


def correlated():
    together = ot.CorrelationMatrix(6)
    for i in range(6):
        for j in range(i):
            together[i, j] = 0.5
    names = [f"x{i}" for i in range(6)]
    law = ot.Normal([10.0] * 6, [0.1 / 3] * 6, together)
    return sampled(law, ot.SymbolicFunction(names, ["x0 - x1 + x2 - x3 + x4 - x5"]))


OPENTURNS = {"engine": engine, "clutch": clutch, "blocks": blocks, "uniforms": uniforms, "correlated": correlated}
