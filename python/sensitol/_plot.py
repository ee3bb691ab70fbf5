"""Results as plots of matplotlib."""

from __future__ import annotations

from typing import Any


def plot(result: Any, characteristic: str | None, ax: Any) -> Any:
    """Draws a result: contributions of an analysis, the histogram of a simulation, the band of a sweep."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError('plot needs matplotlib: pip install "sensitol[plot]"') from None
    name = characteristic if characteristic is not None else next(iter(result), "")
    one = result[name]
    kind = type(result).__name__
    draw = {"AnalysisResult": contributions, "SimulationResult": histogram, "SweepResult": band}.get(kind)
    if draw is None:
        raise TypeError(f"an {kind} has no plot: result.to_svg() has its charts")
    if ax is None:
        _, ax = pyplot.subplots()
    unit = one._data.get("unit")
    draw(ax, result, one, f"{name} [{unit}]" if unit else name)
    return ax


def contributions(ax: Any, result: Any, one: Any, label: str) -> None:
    """Contributions to the variance, whole: linear, by curvature, and half of each interaction."""
    shares: dict[str, list[float]] = {}
    for entry in one.sensitivities:
        shares[entry.dimension] = [entry.linear_share or 0.0, entry.curvature_share or 0.0, 0.0]
    for pair in one.interactions:
        for dimension in pair.dimensions:
            if dimension in shares and pair.share is not None:
                shares[dimension][2] += pair.share / 2
    ordered = sorted(shares.items(), key=lambda entry: sum(entry[1]))
    names = [name for name, _ in ordered]
    left = [0.0] * len(ordered)
    for part, title in enumerate(("linear", "curvature", "interactions")):
        widths = [100 * parts[part] for _, parts in ordered]
        ax.barh(names, widths, left=left, label=title)
        left = [a + b for a, b in zip(left, widths)]
    ax.set_xlabel(f"% of the variance of {label}")
    ax.legend()


def histogram(ax: Any, result: Any, one: Any, label: str) -> None:
    """The histogram of a simulation with its limits."""
    found = one.histogram
    if found is not None:
        ax.stairs(found.counts, found.edges, fill=True)
    limits(ax, one)
    ax.set_xlabel(label)
    ax.set_ylabel("points")


def band(ax: Any, result: Any, one: Any, label: str) -> None:
    """Mean and quantiles along the parameter."""
    points = [point for point in one.points if point.mean is not None]
    at = [point.at for point in points]
    ax.plot(at, [point.mean for point in points], label="mean")
    quantiles = [point.quantiles for point in points if point.quantiles]
    if len(quantiles) == len(points) and points:
        lower = [min(_numbers(found)) for found in quantiles]
        upper = [max(_numbers(found)) for found in quantiles]
        ax.fill_between(at, lower, upper, alpha=0.3, label="0.135 % to 99.865 %")
    for limit in (one.lower, one.upper):
        if limit is not None:
            ax.axhline(limit, linestyle="--", color="black")
    unit = result.parameter.unit
    ax.set_xlabel(f"{result.parameter.name} [{unit}]" if unit else result.parameter.name)
    ax.set_ylabel(label)
    ax.legend()


def _numbers(found: Any) -> list[float]:
    values = found.values() if isinstance(found, dict) else found
    pairs = [one[-1] if isinstance(one, (list, tuple)) else one for one in values]
    return [float(one) for one in pairs if one is not None]


def limits(ax: Any, one: Any) -> None:
    for limit in (one.lower, one.upper):
        if limit is not None:
            ax.axvline(limit, linestyle="--", color="black")
