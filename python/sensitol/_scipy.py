"""Distributions of scipy as distributions of dimensions."""

from __future__ import annotations

from typing import Any

from ._errors import StudyError

#: What a study calls them.
KNOWN = "norm, uniform, triang, trapezoid, beta, truncnorm, lognorm, gamma, weibull_min, expon, rayleigh"


def is_frozen(value: Any) -> bool:
    """Whether this is a frozen distribution of scipy.stats."""
    return hasattr(value, "dist") and hasattr(value, "args") and hasattr(value, "kwds")


def keys(law: Any, nominal: float | None) -> dict[str, Any]:
    """The keys of a dimension that has this distribution. Where the nominal value is not given, it is the mean."""
    family = getattr(law.dist, "name", type(law.dist).__name__)
    if not hasattr(law.dist, "pdf"):
        raise StudyError(
            f"scipy's `{family}` is discrete, and a dimension is continuous", help=f"use one of {KNOWN}, or measured values"
        )
    shapes, location, scale = law.dist._parse_args(*law.args, **law.kwds)
    shapes = [float(shape) for shape in shapes]
    location, scale = float(location), float(scale)
    mean = float(law.mean())
    # The mean of a tailed kind is the nominal value and its shift, that of a band the middle and its shift.
    tailed = {"lognorm": "lognormal", "gamma": "gamma", "weibull_min": "weibull", "expon": "exponential", "rayleigh": "rayleigh"}
    if family == "norm":
        found: dict[str, Any] = {"nominal": mean if nominal is None else nominal, "sigma": scale}
        if nominal is not None and nominal != mean:
            found["shift"] = mean - nominal
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
    elif family == "beta":
        found["distribution"] = {"kind": "beta", "alpha": shapes[0], "beta": shapes[1]}
    elif family == "trapezoid" and abs(shapes[0] - (1.0 - shapes[1])) < 1e-12:
        found["distribution"] = {"kind": "trapezoidal", "top": shapes[1] - shapes[0]}
    elif family == "truncnorm" and lower > -1e308 and upper < 1e308:
        found["distribution"] = "truncated-normal"
        found["sigmas"] = (upper - lower) / 2 / scale
        middle = (lower + upper) / 2
        if location != middle:
            found["shift"] = location - middle
    else:
        what = {"trapezoid": "is not symmetric", "truncnorm": "has no end on one side"}.get(family, "is no distribution of studies")
        raise StudyError(
            f"scipy's `{family}` {what}",
            help=f"use one of {KNOWN}, or values drawn from it: distribution=law.rvs(10000, random_state=1)",
        )
    return found
