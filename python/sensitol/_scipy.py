"""Distributions of scipy as distributions of dimensions."""

from __future__ import annotations

import math
import statistics
from typing import Any, Callable

from ._errors import StudyError

#: How far the table of another law goes, in normal scores, and its lines by score: probabilities of 6e-16, cubics to some 1e-8.
FARTHEST, LINES = 8.0, 32
#: Families that are others under another name: shapes of the beta distribution over their support.
BETAS: dict[str, Callable[[list[float]], tuple[float, float]]] = {
    "beta": lambda shapes: (shapes[0], shapes[1]),
    "arcsine": lambda _: (0.5, 0.5),
    "powerlaw": lambda shapes: (shapes[0], 1.0),
    "rdist": lambda shapes: (0.5 * shapes[0], 0.5 * shapes[0]),
    "semicircular": lambda _: (1.5, 1.5),
}


def is_frozen(value: Any) -> bool:
    """Whether this is a frozen distribution of scipy.stats."""
    return hasattr(value, "dist") and hasattr(value, "args") and hasattr(value, "kwds")


def keys(law: Any, nominal: float | None) -> dict[str, Any]:
    """The keys of a dimension that has this distribution. Where the nominal value is not given, it is the mean."""
    family = getattr(law.dist, "name", type(law.dist).__name__)
    if not hasattr(law.dist, "pdf"):
        raise StudyError(
            f"scipy's `{family}` is discrete, and a dimension is continuous", help="use a continuous distribution, or measured values"
        )
    shapes, location, scale = law.dist._parse_args(*law.args, **law.kwds)
    shapes = [float(shape) for shape in shapes]
    location, scale = float(location), float(scale)
    mean = float(law.mean())
    # The mean of a tailed kind is the nominal value and its shift, that of a band the middle and its shift.
    tailed = {"lognorm": "lognormal", "gamma": "gamma", "chi2": "gamma", "erlang": "gamma", "weibull_min": "weibull", "expon": "exponential", "rayleigh": "rayleigh"}
    if family == "pearson3":
        # A gamma distribution from its lower end on; without skewness a normal one.
        if shapes[0] > 0.0:
            family, location = "gamma", location - 2.0 * scale / shapes[0]
        elif shapes[0] == 0.0:
            family = "norm"
    if family == "norm":
        found: dict[str, Any] = {"nominal": mean if nominal is None else nominal, "sigma": scale}
        if nominal is not None and nominal != mean:
            found["shift"] = mean - nominal
        return found
    if family == "t":
        if shapes[0] <= 2.0:
            raise StudyError(
                f"scipy's `{family}` has no sigma with {shapes[0]:g} degrees of freedom", help="use more than 2, or measured values"
            )
        found = {
            "nominal": location if nominal is None else nominal,
            "distribution": {"kind": "student", "degrees": shapes[0], "scale": scale},
        }
        if nominal is not None and nominal != location:
            found["shift"] = location - nominal
        return found
    if family in tailed:
        found = {"nominal": mean if nominal is None else nominal, "distribution": {"kind": tailed[family], "origin": location}}
        if family not in ("expon", "rayleigh"):
            found["sigma"] = float(law.std())
        if nominal is not None and nominal != mean:
            found["shift"] = mean - nominal
        return found
    lower, upper = (float(end) for end in law.support())
    found = {"nominal": mean if nominal is None else nominal, "limits": [lower, upper]}
    if family == "uniform":
        found["distribution"] = "uniform"
    elif family == "triang":
        found["distribution"] = {"kind": "triangular", "mode": location + shapes[0] * scale}
    elif family in BETAS:
        alpha, beta = BETAS[family](shapes)
        found["distribution"] = {"kind": "beta", "alpha": alpha, "beta": beta}
    elif family == "trapezoid" and abs(shapes[0] - (1.0 - shapes[1])) < 1e-12:
        found["distribution"] = {"kind": "trapezoidal", "top": shapes[1] - shapes[0]}
    elif family == "truncnorm" and lower > -1e308 and upper < 1e308:
        found["distribution"] = "truncated-normal"
        found["sigmas"] = (upper - lower) / 2 / scale
        middle = (lower + upper) / 2
        if location != middle:
            found["shift"] = location - middle
    else:
        found = {"nominal": mean if nominal is None else nominal, "distribution": _table(law, family)}
    return found


def _table(law: Any, family: str) -> dict[str, Any]:
    """Any other law as a table of its quantiles over normal scores, made once: the engine never calls back."""
    import numpy

    moments = [float(one) for one in law.stats("mvsk")]
    if not all(math.isfinite(one) for one in moments):
        names = ("mean", "variance", "skewness", "kurtosis")
        infinite = next(name for name, one in zip(names, moments) if not math.isfinite(one))
        raise StudyError(
            f"scipy's `{family}` has no finite {infinite}, and a study computes with the first four moments",
            help="use a distribution with lighter tails, or measured values",
        )
    scores = numpy.arange(-FARTHEST, FARTHEST + 0.5 / LINES, 1.0 / LINES)
    normal = statistics.NormalDist()
    tail = numpy.array([normal.cdf(-abs(score)) for score in scores])
    # Either tail from its own end: 1 - p has lost the digits of a small one.
    values = numpy.where(scores < 0.0, law.ppf(tail), law.isf(tail)).astype(float)
    middle = int(numpy.searchsorted(scores, 0.0))
    if not math.isfinite(values[middle]):
        raise StudyError(f"scipy's `{family}` has no median: its ppf gives {values[middle]}", help="use measured values")
    # Far out numbers of a bounded law run together, and some laws have no digits there: the table ends before.
    kept = [middle]
    for index in range(middle + 1, len(scores)):
        if not (math.isfinite(values[index]) and values[index] > values[kept[-1]]):
            break
        kept.append(index)
    for index in range(middle - 1, -1, -1):
        if not (math.isfinite(values[index]) and values[index] < values[kept[0]]):
            break
        kept.insert(0, index)
    return {"kind": "tabulated", "scores": scores[kept].tolist(), "values": values[kept].tolist()}
