"""The same problem in other packages of Python, each in an environment of its own; writes docs/python-packages.md.

    target/python-venv/bin/python python/tools/peers.py [PACKAGE ...]

Every package is installed from the package registry; what cannot be installed or fails is named with its reason. The exact
values are computed here by quadrature.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import time

import numpy

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PLACE = os.path.join(os.environ.get("CARGO_TARGET_DIR", os.path.join(REPOSITORY, "target")), "peers")
PAGE = os.path.join(REPOSITORY, "docs", "python-packages.md")

#: Each prints a dict: mean, sigma, skewness, kurtosis, evaluations; what it does not have is left out.
PEERS = {
    "sensitol": (
        None,
        "sensitol",
        """
import numpy as np, sensitol as st
@st.model(vectorized=True)
def clearance(bore, shaft, tilt): return bore - shaft/np.cos(np.deg2rad(tilt))
study = st.Study(
    dimensions={"bore": st.Dimension(25.020, 0.010), "shaft": st.Dimension(24.980, (-0.013, 0.0)),
                "tilt": st.Dimension(0.0, 1.5, distribution="uniform")},
    characteristics={"clearance": st.Characteristic(lower=0.02, upper=0.07)}, model=clearance)
r = study.analyze("full")
c = r["clearance"]
print(dict(mean=c.mean, sigma=c.sigma, skewness=c.skewness, kurtosis=c.kurtosis, evaluations=r.evaluations))
""",
        "an error estimate for each; check points of the model among the evaluations; tilt 29 % of the variance, by curvature",
    ),
    "openturns": (
        "openturns==1.27",
        "openturns",
        """
import openturns as ot, math
f = ot.SymbolicFunction(["bore", "shaft", "tilt"], ["bore - shaft/cos(tilt*0.017453292519943295)"])
d = ot.JointDistribution([ot.Normal(25.02, 0.01/3), ot.Normal(24.9735, 0.0065/3), ot.Uniform(-1.5, 1.5)])
t = ot.TaylorExpansionMoments(ot.CompositeRandomVector(f, ot.RandomVector(d)))
print(dict(mean=t.getMeanSecondOrder()[0], sigma=math.sqrt(t.getCovariance()[0, 0])))
""",
        "`TaylorExpansionMoments`: second-order mean, first-order sigma; importance of tilt 0",
    ),
    "soerp": (
        "soerp==1.0.1",
        "soerp",
        """
import math
from soerp import N, U, umath
c = N(25.02, 0.01/3) - N(24.9735, 0.0065/3)/umath.cos(U(-1.5, 1.5)*math.pi/180)
print(dict(mean=c.mean, sigma=math.sqrt(c.var), skewness=c.skew, kurtosis=c.kurt))
""",
        "second order by operator overloading: the function must be written with its own `umath`, a black box cannot be analysed",
    ),
    "mcerp": (
        "mcerp==1.1.1",
        "mcerp",
        """
import math, numpy
numpy.random.seed(1)
from mcerp import N, U, umath
c = N(25.02, 0.01/3) - N(24.9735, 0.0065/3)/umath.cos(U(-1.5, 1.5)*math.pi/180)
print(dict(mean=c.mean, sigma=math.sqrt(c.var), skewness=c.skew, kurtosis=c.kurt, evaluations=10000))
""",
        "10 000 points of a Latin hypercube, without a standard error",
    ),
    "uncertainties": (
        "uncertainties==3.2.3",
        "uncertainties",
        """
import math
from uncertainties import ufloat, umath
c = ufloat(25.02, 0.01/3) - ufloat(24.9735, 0.0065/3)/umath.cos(ufloat(0, 1.5/math.sqrt(3))*math.pi/180)
print(dict(mean=c.n, sigma=c.s))
""",
        "first order: the mean shift and the share of tilt are missing",
    ),
    "chaospy": (
        "chaospy==4.3.21",
        "chaospy",
        """
import chaospy, numpy
J = chaospy.J(chaospy.Normal(25.02, 0.01/3), chaospy.Normal(24.9735, 0.0065/3), chaospy.Uniform(-1.5, 1.5))
nodes, weights = chaospy.generate_quadrature(2, J, rule="gaussian")
y = nodes[0] - nodes[1]/numpy.cos(numpy.deg2rad(nodes[2]))
p = chaospy.fit_quadrature(chaospy.generate_expansion(2, J), nodes, weights, y)
print(dict(mean=float(chaospy.E(p, J)), sigma=float(chaospy.Std(p, J)), skewness=float(chaospy.Skew(p, J)),
           evaluations=nodes.shape[1]))
""",
        "polynomial chaos of an order that is chosen by hand, without an error estimate",
    ),
    "dimstack": ("dimstack==0.9.0", "dimstack", "print({})", "linear stacks only: an angle cannot be stated"),
}


def exact() -> dict[str, float]:
    """The moments of bore - shaft/cos(tilt) by quadrature over tilt; bore and shaft are linear and normal given tilt."""
    nodes, weights = numpy.polynomial.legendre.leggauss(64)
    secant = 1 / numpy.cos(numpy.deg2rad(1.5 * nodes))
    weights = weights / 2
    bore, shaft, mean_bore, mean_shaft = 0.01 / 3, 0.0065 / 3, 25.02, 24.9735
    mean_given = mean_bore - mean_shaft * secant
    variance_given = bore**2 + (shaft * secant) ** 2
    mean = float(weights @ mean_given)
    off = mean_given - mean
    second = float(weights @ (off**2 + variance_given))
    third = float(weights @ (off**3 + 3 * off * variance_given))
    fourth = float(weights @ (off**4 + 6 * off**2 * variance_given + 3 * variance_given**2))
    return {"mean": mean, "sigma": math.sqrt(second), "skewness": third / second**1.5, "kurtosis": fourth / second**2}


def environment(name: str, package: str | None) -> tuple[str, str | None]:
    """A Python that has the package, and why there is none."""
    if package is None:
        return sys.executable, None
    folder = os.path.join(PLACE, name)
    python = os.path.join(folder, "bin", "python")
    mark = os.path.join(folder, "installed")
    if not os.path.exists(mark):
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        # The oldest of them import what setuptools brought.
        pip = [python, "-m", "pip", "install", "-q", "--disable-pip-version-check", package, "setuptools<81"]
        run = subprocess.run(pip, capture_output=True, text=True)
        if run.returncode:
            lines = run.stderr.strip().splitlines()
            return "", next((line for line in lines if "error" in line.lower()), lines[-1] if lines else "no reason given")
        open(mark, "w").close()
    return python, None


def seconds(python: str, code: str, least: int = 3) -> float:
    """The shortest of several runs, in a new process each."""
    best = math.inf
    for _ in range(least):
        begun = time.perf_counter()
        subprocess.run([python, "-W", "ignore", "-c", code], capture_output=True, check=True)
        best = min(best, time.perf_counter() - begun)
    return best


def main() -> None:
    true = exact()
    rows, lost = [], []
    chosen = sys.argv[1:] or list(PEERS)
    for name in chosen:
        package, module, code, said = PEERS[name]
        python, why = environment(name, package)
        shown = (package or "sensitol").replace("==", " ")
        if why is not None:
            lost.append(f"- {shown} cannot be installed here: {why}")
            continue
        run = subprocess.run([python, "-W", "ignore", "-c", code], capture_output=True, text=True, timeout=300)
        if run.returncode:
            lost.append(f"- {shown} fails: {run.stderr.strip().splitlines()[-1]}")
            continue
        found = eval(run.stdout.strip().splitlines()[-1], {"nan": math.nan, "np": numpy})
        start = seconds(python, f"import {module}" + ("; import sensitol as st; st.Study" if package is None else "")) - seconds(python, "pass")

        def cell(key: str, digits: int) -> str:
            return f"{found[key]:.{digits}f}" if key in found else "—"

        off = f"{100 * (found['sigma'] / true['sigma'] - 1):+.2g} %" if "sigma" in found else "—"
        rows.append(
            f"| {shown} | {cell('mean', 7)} | {cell('sigma', 7)} | {off} | {cell('skewness', 4)} | {cell('kurtosis', 4)} "
            f"| {found.get('evaluations', '—')} | {start:.1f} s | {said} |"
        )
        print(rows[-1], flush=True)
    page = [
        "# The same problem in other packages of Python",
        "",
        "The [shaft and bore](../examples/shaft-and-bore/README.md): `clearance = bore - shaft/cos(tilt)`, bore and shaft normal,",
        "tilt uniform within ± 1.5°. At the nominal tilt the slope is 0, so tilt acts through its curvature alone.",
        "`python/tools/peers.py` installs each package in an environment of its own and writes this page.",
        "",
        "| package | mean | sigma | off | skewness | kurtosis | evaluations | import | what it says |",
        "|---|--:|--:|--:|--:|--:|--:|--:|---|",
        f"| exact (quadrature) | {true['mean']:.7f} | {true['sigma']:.7f} | | {true['skewness']:.4f} | {true['kurtosis']:.4f} | | | |",
        *rows,
        "",
        "Imports are the shortest of three new processes, beyond that of an empty Python.",
        "",
    ]
    if lost:
        page += ["Not in the table:", "", *lost, ""]
    if set(chosen) == set(PEERS):
        with open(PAGE, "w", encoding="utf-8") as file:
            file.write("\n".join(page))
    else:
        print(json.dumps(true))
        print("\n".join(lost))


if __name__ == "__main__":
    main()
