"""Statistics of a lot by SciPy and statsmodels: tests/data/lot.json.

Runs with numpy, scipy 1.17 and statsmodels 0.15. The samples are drawn here and stored with their figures.
"""

import json
from pathlib import Path

import numpy as np
from scipy import integrate, stats
from statsmodels.stats.diagnostic import normal_ad
from statsmodels.stats.multitest import multipletests

rng = np.random.default_rng(20261128)


def column(values, mean, sigma):
    n = len(values)
    s = values.std(ddof=1)
    chi = (n - 1) * s**2 / sigma**2
    low, high = stats.t.interval(0.95, n - 1, values.mean(), stats.sem(values))
    statistic, p = normal_ad(values)
    line = stats.linregress(np.arange(n), values)
    half = stats.t.ppf(0.975, n - 2) * line.stderr
    return {
        "values": values.tolist(), "assumed": [mean, sigma], "mean": [low, high],
        "mean_p": stats.ttest_1samp(values, mean).pvalue,
        "sigma": [s * np.sqrt((n - 1) / stats.chi2.ppf(q, n - 1)) for q in (0.975, 0.025)],
        "sigma_p": min(1.0, 2 * min(stats.chi2.cdf(chi, n - 1), stats.chi2.sf(chi, n - 1))),
        "anderson": [statistic, p],
        "trend": [line.slope * (n - 1), (line.slope - half) * (n - 1), (line.slope + half) * (n - 1), line.pvalue],
    }


def pair(n, rho):
    x = rng.normal(size=n)
    y = rho * x + np.sqrt(1 - rho**2) * rng.normal(size=n)
    found = stats.pearsonr(x, y)
    ends = found.confidence_interval(0.95)
    z = (np.arctanh(found.statistic) - np.arctanh(0.3)) * np.sqrt(n - 3)
    return {"rows": np.stack([x, y], 1).tolist(), "r": found.statistic, "ends": [ends.low, ends.high],
            "p_against_0.3": 2 * stats.norm.sf(abs(z))}


def groups(sizes, between):
    parts = [(f"lot {i}", 10 + shift + rng.normal(0, 0.5, size)) for i, (size, shift) in
             enumerate(zip(sizes, rng.normal(0, between, len(sizes))))]
    f, p = stats.f_oneway(*(values for _, values in parts))
    inside = sum(((v - v.mean()) ** 2).sum() for _, v in parts)
    freedom = sum(sizes) - len(sizes)
    return {"parts": [[name, value] for name, values in parts for value in values], "f": f, "p": p,
            "within": [np.sqrt(inside / stats.chi2.ppf(q, freedom)) for q in (0.975, 0.025)]}


def posterior(values, mean, sigma, weight):
    """Mean and sigma by integration over a grid, without the conjugate formulas."""
    m = np.linspace(mean - 8 * sigma, mean + 8 * sigma, 4001)
    s = np.geomspace(sigma / 8, 16 * sigma, 3001)
    M, S = np.meshgrid(m, s, indexing="ij")
    log = stats.norm.logpdf(M, mean, S / np.sqrt(weight))
    log += stats.invgamma.logpdf(S**2, (weight - 1) / 2, scale=(weight - 1) * sigma**2 / 2) + np.log(2 * S)
    log += sum(stats.norm.logpdf(v, M, S) for v in values)
    density = np.exp(log - log.max())
    of_mean, of_sigma = integrate.trapezoid(density, s, axis=1), integrate.trapezoid(density, m, axis=0)

    def ends(x, d):
        cdf = integrate.cumulative_trapezoid(d, x, initial=0)
        return [float(np.interp(q * cdf[-1], cdf, x)) for q in (0.025, 0.975)]

    return {"values": values.tolist(), "prior": [mean, sigma, weight],
            "mean": integrate.trapezoid(m * of_mean, m) / integrate.trapezoid(of_mean, m),
            "mean_ends": ends(m, of_mean), "sigma_ends": ends(s, of_sigma)}


def uniform_shape(values):
    """P-value of a uniform shape with mean and sigma of the values, by 200,000 samples."""
    def statistic(rows):
        u = np.sort((rows - rows.mean(1, keepdims=True)) / rows.std(1, ddof=1, keepdims=True), axis=1)
        cdf = ((u + np.sqrt(3)) / (2 * np.sqrt(3))).clip(0, 1)
        n = rows.shape[1]
        return 1 / (12 * n) + ((cdf - (2 * np.arange(n) + 1) / (2 * n)) ** 2).sum(1)

    drawn = statistic(rng.uniform(size=(200_000, len(values))))
    found = statistic(values[None, :])[0]
    return {"values": values.tolist(), "p": float((drawn >= found).mean())}


columns = [
    column(rng.normal(10.02, 0.09, 60), 10, 0.1), column(rng.normal(0, 1, 12), 0, 1),
    column(rng.uniform(-1, 1, 80), 0, 0.5), column(5 + rng.exponential(0.2, 40), 5, 0.2),
    column(1e6 + rng.normal(0, 1e-3, 30) + np.arange(30) * 1e-4, 1e6, 1e-3),
]
n, part, own = 25, rng.normal(2, 1, 25), rng.normal(2.4, 1.3, 40)
welch = stats.ttest_ind_from_stats(part.mean(), part.std(ddof=1), n, own.mean(), own.std(ddof=1), 40, equal_var=False)
ratio = (own.std(ddof=1) / part.std(ddof=1)) ** 2
raw = [0.001, 0.04, 0.03, 0.5, 0.012, 0.0123]
found = {
    "columns": columns, "pairs": [pair(30, 0.6), pair(8, 0.0)],
    "groups": [groups([5, 5, 5, 5], 0.6), groups([12, 3, 7], 0.0), groups([4, 9, 6, 11, 3], 1.0)],
    "holm": [raw, multipletests(raw, method="holm")[1].tolist()],
    "prediction": {"part": part.tolist(), "own": own.tolist(), "welch": welch.pvalue,
                   "fisher": 2 * min(stats.f.sf(ratio, 39, 24), stats.f.cdf(ratio, 39, 24))},
    "posteriors": [posterior(rng.normal(10.05, 0.08, 20), 10, 0.1, 30), posterior(rng.normal(0.5, 1.5, 8), 0, 1, 5)],
    "uniform_shapes": [uniform_shape(rng.uniform(size=40)), uniform_shape(rng.beta(2, 2, size=40))],
    "fisher": [[q, a, b, stats.f.ppf(q, a, b), stats.f.sf(stats.f.ppf(q, a, b), a, b)]
               for q in (0.025, 0.5, 0.975) for a, b in ((3, 16), (1, 100), (7.5, 2.3), (40, 1e6))],
}
Path(__file__).parents[1].joinpath("lot.json").write_text(json.dumps(found, indent=1) + "\n")
