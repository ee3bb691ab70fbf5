"""Results as plots of matplotlib.

Nothing of matplotlib's style is changed: colours are named where they mean something, and all else is the user's.
"""

from __future__ import annotations

from typing import Any

#: Colour of what the limits reject.
REJECTED = "tab:red"
#: Colours of a tolerance before and after an allocation. The first one is that of the mean too, because it is seen on light and dark.
BEFORE, AFTER = "tab:gray", "tab:blue"
#: Share of the assemblies beyond either end of a drawn density.
BEYOND = 1e-4
#: Points of a drawn density.
POINTS = 400
#: Farthest limit that a density is extended to, in widths of the density.
NEAR = 0.6
#: Most contributors that are drawn; the others are one bar together.
CONTRIBUTORS = 12
#: Verdicts as they are printed.
VERDICTS = {"met": "met", "missed": "MISSED", "inconclusive": "inconclusive"}


def plot(result: Any, characteristic: str | None, kind: str | None, ax: Any) -> Any:
    """Draws a result and returns the axes, or an array of two for both plots of an analysis."""
    try:
        import matplotlib.pyplot as pyplot
    except ImportError:
        raise ImportError('plot needs matplotlib: pip install "sensitol[plot]"') from None
    result_type = type(result).__name__
    drawings = {
        "AnalysisResult": {"density": density, "contributions": contributions},
        "SimulationResult": {"density": histogram},
        "SweepResult": {"band": band},
        "AllocationResult": {"tolerances": tolerances},
        "ComparisonResult": {"errors": errors},
    }.get(result_type)
    if drawings is None:
        raise TypeError(f"an {result_type} has no plot: result.to_svg() has its charts")
    kinds = [*drawings, "both"] if len(drawings) > 1 else [*drawings]
    if kind is None:
        kind = "both" if ax is None and len(drawings) > 1 else kinds[0]
    if kind not in kinds:
        raise ValueError(f"there is no plot {kind!r}; there are {', '.join(repr(one) for one in kinds)}")
    name = characteristic if characteristic is not None else next(iter(result), "")
    one = result[name]
    if kind == "both":
        if ax is not None:
            raise ValueError("both plots need two axes: leave out `ax`, or name one kind")
        figure, both = pyplot.subplots(1, 2, layout="constrained", figsize=_wide(pyplot))
        for place, draw in zip(both, drawings.values()):
            draw(place, result, one, _labelled(one, name))
        return both
    if ax is None:
        _, ax = pyplot.subplots(layout="constrained")
    drawings[kind](ax, result, one, _labelled(one, name))
    return ax


def _wide(pyplot: Any) -> tuple[float, float]:
    """The size of a figure with two plots beside each other."""
    width, height = pyplot.rcParams["figure.figsize"]
    return 2 * width, height


def _labelled(one: Any, name: str) -> str:
    unit = one._data.get("unit")
    return f"{name} [{unit}]" if unit else name


def verdict(one: Any, name: str) -> str:
    """Yield, target and verdict in one line; the name alone where there are no limits."""
    found = one._data
    if found.get("lower") is None and found.get("upper") is None:
        return name
    yield_ = found.get("yield")
    text = f"{name}: " + ("yield unknown" if yield_ is None else f"yield {_percent(yield_)}")
    if found.get("target_yield") is not None:
        text += f", target {100 * found['target_yield']:.10g} %"
    judged = VERDICTS.get(found.get("verdict") or "")
    return f"{text}: {judged}" if judged else text


def _percent(share: float) -> str:
    """A yield with three digits of what is rejected."""
    rejected = 100 * (1 - share)
    if rejected <= 0:
        return "100 %"
    import math

    places = min(max(2 - math.floor(math.log10(rejected)), 2), 9)
    return f"{100 - rejected:.{places}f} %"


def _rejects(one: Any) -> list[tuple[float, bool, str]]:
    """Each limit, whether it is the upper one, and its rejects in words."""
    found = one._data
    sides = [("lower", False, "below", "ppm_below"), ("upper", True, "above", "ppm_above")]
    rejects = []
    for key, upper, word, ppm in sides:
        limit = found.get(key)
        if limit is not None:
            share = found.get(ppm)
            # Rounded to three digits, and printed without an exponent.
            count = "rejects unknown" if share is None else f"{float(f'{share:.3g}'):.10g} ppm"
            rejects.append((limit, upper, f"{count} {word} {limit:.10g}"))
    return rejects


def density(ax: Any, result: Any, one: Any, label: str) -> None:
    """The density with the limits, what they reject, and the verdict."""
    import numpy

    law = one.law
    ax.set_title(verdict(one, one._data["name"]))
    ax.set_xlabel(label)
    ax.set_ylabel("density")
    if law is None:
        ax.text(0.5, 0.5, "no distribution has these moments", ha="center", transform=ax.transAxes)
        return
    low, high = float(law.ppf(BEYOND)), float(law.isf(BEYOND))
    reach = NEAR * (high - low)
    limits = [limit for limit, _, _ in _rejects(one) if low - reach < limit < high + reach]
    at = numpy.linspace(min([low, *limits]), max([high, *limits]), POINTS)
    # A limit is a point of the curve, so that what it rejects ends there.
    at = numpy.unique(numpy.concatenate([at, limits]))
    values = numpy.asarray(law.pdf(at))
    other = one._data.get("yield_source") not in (None, "pearson")
    ax.plot(at, values, label="Pearson fit" if other else "density")
    for limit, upper, words in _rejects(one):
        beyond = at >= limit if upper else at <= limit
        ax.fill_between(at[beyond], values[beyond], color=REJECTED, alpha=0.5, linewidth=0)
        ax.axvline(limit, linestyle="--", color=REJECTED, label=words)
    mean = one._data.get("mean")
    if mean is not None:
        ax.axvline(mean, linestyle=":", color=BEFORE, label=f"mean {mean:.6g}")
    ax.set_ylim(bottom=0)
    _legend(ax)


def contributions(ax: Any, result: Any, one: Any, label: str) -> None:
    """Contributions to the variance, whole: linear, by curvature, and half of each interaction."""
    shares: dict[str, list[float]] = {}
    for entry in one.sensitivities:
        shares[entry.dimension] = [entry.linear_share or 0.0, entry.curvature_share or 0.0, 0.0]
    for pair in one.interactions:
        for dimension in pair.dimensions:
            if dimension in shares and pair.share is not None:
                shares[dimension][2] += pair.share / 2
    ordered = sorted(shares.items(), key=lambda entry: -sum(entry[1]))
    rest = ordered[CONTRIBUTORS:]
    ordered = ordered[:CONTRIBUTORS]
    if rest:
        together = [sum(parts[part] for _, parts in rest) for part in range(3)]
        ordered.append((f"{len(rest)} others", together))
    ordered.reverse()
    names = [name for name, _ in ordered]
    left = [0.0] * len(ordered)
    for part, title in enumerate(("linear", "curvature", "interactions")):
        widths = [100 * parts[part] for _, parts in ordered]
        ax.barh(names, widths, left=left, label=title)
        left = [a + b for a, b in zip(left, widths)]
    ax.set_title(f"Contributions to {one._data['name']}")
    ax.set_xlabel(f"% of the variance of {label}")
    _legend(ax)


def histogram(ax: Any, result: Any, one: Any, label: str) -> None:
    """The histogram of a simulation as a density, with the limits, what they reject, and the verdict.

    The intervals have different widths, so the area of a bar is its share of the points.
    """
    import numpy
    from matplotlib.patches import Rectangle

    ax.set_title(verdict(one, one._data["name"]))
    ax.set_xlabel(label)
    ax.set_ylabel("density")
    found = one.histogram
    if found is not None:
        counts, edges = numpy.asarray(found.counts, float), numpy.asarray(found.edges, float)
        heights = counts / (counts.sum() * numpy.diff(edges))
        ax.stairs(heights, edges, fill=True, label=f"{int(counts.sum())} points")
        for limit, upper, _ in _rejects(one):
            from_, to = (limit, max(edges[-1], limit)) if upper else (min(edges[0], limit), limit)
            beyond = ax.stairs(heights, edges, fill=True, color=REJECTED)
            beyond.set_clip_path(Rectangle((from_, 0), to - from_, heights.max(), transform=ax.transData))
    for limit, _, words in _rejects(one):
        ax.axvline(limit, linestyle="--", color=REJECTED, label=words)
    _legend(ax)


def tolerances(ax: Any, result: Any, one: Any, label: str) -> None:
    """Each tolerance before and after the allocation, in % of the one before."""
    rows = list(reversed(result.tolerances))
    after = [100 * row.after / row.before for row in rows]
    height = 0.4
    places = range(len(rows))
    ax.barh([place + height / 2 for place in places], [100] * len(rows), height, color=BEFORE, label="before")
    ax.barh([place - height / 2 for place in places], after, height, color=AFTER, label="after")
    for place, (row, width) in enumerate(zip(rows, after)):
        unit = f" {row.unit}" if row.unit else ""
        for offset, at, value in ((height / 2, 100, row.before), (-height / 2, width, row.after)):
            ax.text(at, place + offset, f" ± {value:.4g}{unit}", va="center", ha="left", clip_on=True)
    ax.set_yticks(list(places), [row.dimension for row in rows])
    # Room for the numbers beyond the longest bar.
    ax.set_xlim(0, 1.35 * max([100, *after]))
    ax.set_xlabel("tolerance, % of the one before")
    before, found = result.cost_before, result.cost_after
    cost = "" if before is None or found is None else f": cost {before:.5g} → {found:.5g}"
    ax.set_title(f"{result.status}{cost}")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)


def errors(ax: Any, result: Any, one: Any, label: str) -> None:
    """The error of each method, the one with the fewest evaluations on top. Full points: no other method beats it."""
    rows = list(reversed(one.methods))
    known = [row.error_vs_reference.overall for row in rows if row.error_vs_reference.overall]
    least = min(known) if known else 1e-6
    for best, title in ((True, "no other method beats it"), (False, "others")):
        points = [(place, row) for place, row in enumerate(rows) if bool(row.pareto) is best]
        at = [row.error_vs_reference.overall or least for _, row in points]
        style = {} if best else {"markerfacecolor": "none"}
        ax.plot(at, [place for place, _ in points], "o", color=AFTER, label=title, **style)
    ax.set_yticks(range(len(rows)), [f"{row.method}: {row.evaluations}" for row in rows])
    ax.set_xscale("log")
    ax.set_xlabel("error of mean and sigma, in sigmas")
    ax.set_ylabel("method: evaluations")
    ax.set_title(f"{label} against a reference of {result.reference_samples} points")
    ax.legend()


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
            ax.axhline(limit, linestyle="--", color=REJECTED)
    parameter = result.parameter
    ax.set_title(f"{one._data['name']} over {parameter.name}")
    ax.set_xlabel(f"{parameter.name} [{parameter.unit}]" if parameter.unit else parameter.name)
    ax.set_ylabel(label)
    ax.legend()


def _legend(ax: Any) -> None:
    """A legend below the axes, where it covers nothing."""
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)


def _numbers(found: Any) -> list[float]:
    values = found.values() if isinstance(found, dict) else found
    pairs = [one[-1] if isinstance(one, (list, tuple)) else one for one in values]
    return [float(one) for one in pairs if one is not None]
