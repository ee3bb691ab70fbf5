"""Frozen distributions of scipy: the engine's own kinds have their moments."""

import math
import pickle

import numpy as np
import pytest

import sensitol as st

ss = pytest.importorskip("scipy.stats", reason="skipped: scipy is not installed; install with: pip install scipy")

LAWS = {
    "norm": lambda: ss.norm(3, 0.2),
    "t": lambda: ss.t(9, 3, 0.2),
    "uniform": lambda: ss.uniform(2, 0.5),
    "triang": lambda: ss.triang(0.3, 1, 2),
    "trapezoid": lambda: ss.trapezoid(0.25, 0.75, 1, 2),
    "beta": lambda: ss.beta(2, 5, 1, 2),
    "truncnorm": lambda: ss.truncnorm(-1.5, 2.5, 3, 0.2),
    "lognorm": lambda: ss.lognorm(0.4, loc=0.001, scale=0.002),
    "gamma": lambda: ss.gamma(3.5, loc=1, scale=0.2),
    "weibull_min": lambda: ss.weibull_min(1.7, loc=1, scale=0.3),
    "expon": lambda: ss.expon(1, 0.2),
    "rayleigh": lambda: ss.rayleigh(loc=1, scale=0.2),
    "arcsine": lambda: ss.arcsine(1, 2),
    "powerlaw": lambda: ss.powerlaw(2.5, 1, 2),
    "rdist": lambda: ss.rdist(3, 1, 2),
    "semicircular": lambda: ss.semicircular(1, 2),
    "chi2": lambda: ss.chi2(4, 1, 2),
    "erlang": lambda: ss.erlang(3, 1, 0.2),
    "pearson3": lambda: ss.pearson3(0.7, 3, 0.2),
    "pearson3-without-skewness": lambda: ss.pearson3(0.0, 3, 0.2),
}

#: Without a kind of their own in the engine: tables of quantiles.
TABLES = {
    "skewnorm": lambda: ss.skewnorm(4, 3, 0.2),
    "gumbel_r": lambda: ss.gumbel_r(3, 0.2),
    "logistic": lambda: ss.logistic(3, 0.2),
    "laplace": lambda: ss.laplace(3, 0.2),
    "cosine": lambda: ss.cosine(3, 0.2),
    "bradford": lambda: ss.bradford(2.0, 1, 2),
    "exponnorm": lambda: ss.exponnorm(1.5, 3, 0.2),
    "johnsonsu": lambda: ss.johnsonsu(0.5, 2.0, 3, 0.2),
    "trapezoid": lambda: ss.trapezoid(0.1, 0.5, 0, 1),
    "truncnorm": lambda: ss.truncnorm(-1, np.inf, 3, 0.2),
    "pearson3": lambda: ss.pearson3(-0.5, 3, 0.2),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("own_nominal", [False, True])
def test_moments_are_scipy_s(name, own_nominal):
    law = LAWS[name]()
    nominal = float(law.mean()) + 0.01 * float(law.std()) if own_nominal else None
    study = st.Study(
        dimensions={"x": st.Dimension(nominal, distribution=law)}, characteristics={"y": st.Characteristic("x")}
    )
    if own_nominal:
        assert study.dimensions["x"].nominal == pytest.approx(nominal, rel=1e-15)
    found = study.analyze("full")["y"]
    mean, variance, skewness, excess = (float(one) for one in law.stats("mvsk"))
    # scipy's own series for the moments of truncnorm has nine digits of kurtosis.
    loose = 1e-6 if name == "truncnorm" else 1e-9
    assert found.mean == pytest.approx(mean, rel=1e-12)
    assert found.sigma == pytest.approx(math.sqrt(variance), rel=max(1e-12, loose * 1e-3))
    assert found.skewness == pytest.approx(skewness, rel=loose, abs=loose)
    assert found.kurtosis == pytest.approx(excess + 3, rel=loose)


@pytest.mark.parametrize("name", LAWS)
def test_draws_are_scipy_s(name):
    law = LAWS[name]()
    study = st.Study(dimensions={"x": st.Dimension(distribution=law)}, characteristics={"y": st.Characteristic("x")})
    found = study.simulate(2**16, sampler="sobol", seed=1)["y"].distribution.quantiles
    for share, value in found.items():
        if value is None or not 0.01 <= float(share) <= 0.99:
            continue
        if name == "arcsine":
            # Its density is infinite at the ends: a share of 0.001 is less there than an interval in which points are counted.
            assert value == pytest.approx(law.ppf(float(share)), abs=2e-3 * law.std())
            continue
        # 65 536 points of Sobol' leave an error of shares of some 1e-4.
        assert float(law.cdf(value)) == pytest.approx(float(share), abs=1e-3)


@pytest.mark.parametrize("name", LAWS)
def test_functions_are_scipy_s(name):
    law = LAWS[name]()
    study = st.Study(dimensions={"x": st.Dimension(distribution=law)}, characteristics={"y": st.Characteristic("x")})
    mine = study.dimensions["x"].distribution
    shares = np.array([[1e-6, 1e-3, 0.1], [0.5, 0.9, 0.999]])
    values = law.ppf(shares)
    # scipy's own functions are good to some 1e-10; near an end of a law the digits of the distance to it are lost.
    assert mine.ppf(shares) == pytest.approx(values, rel=1e-9)
    assert mine.isf(shares) == pytest.approx(law.isf(shares), rel=1e-9)
    for what in ("pdf", "cdf", "sf"):
        found = getattr(mine, what)(values[:, 1:])
        assert found.shape == (2, 2)
        assert found == pytest.approx(getattr(law, what)(values[:, 1:]), rel=1e-7), what
    assert mine.sf(float(values[1, 1])) == pytest.approx(0.1, rel=1e-9)
    draws = mine.rvs(20_000, random_state=1)
    # The largest distance from the law is above 2.23/sqrt(n) once in ten thousand times (Kolmogorov).
    assert ss.kstest(draws, law.cdf).statistic < 2.23 / math.sqrt(20_000)


def test_a_fit_is_the_member_of_pearson_s_system():
    # A gamma law is of type III: the fit of its four moments is the law itself.
    law = ss.gamma(3.5, loc=1, scale=0.2)
    study = st.Study(
        dimensions={"x": st.Dimension(distribution=law), "fixed": st.Dimension(1.0)},
        characteristics={"y": st.Characteristic("x"), "one": st.Characteristic("fixed")},
    )
    found = study.analyze("full")
    fit = found["y"].law
    values = law.ppf([1e-6, 0.01, 0.5, 0.99, 1 - 1e-6])
    for what in ("pdf", "cdf", "sf"):
        assert getattr(fit, what)(values) == pytest.approx(getattr(law, what)(values), rel=1e-9), what
    assert fit.isf(1e-9) == pytest.approx(law.isf(1e-9), rel=1e-9)
    assert found["y"].cdf(1.5) == pytest.approx(law.cdf(1.5), rel=1e-9)
    assert fit == "pearson" and math.isnan(fit.ppf(2))
    assert found["one"].law is None and study.dimensions["fixed"].distribution is None
    with pytest.raises(ValueError, match="no Pearson distribution has the moments of `one`"):
        found["one"].cdf(1)


def test_what_a_law_cannot_say():
    study = st.Study(
        dimensions={"x": st.Dimension(distribution=np.linspace(1, 2, 7))}, characteristics={"y": st.Characteristic("x")}
    )
    law = study.dimensions["x"].distribution
    assert law.cdf(1.5) == pytest.approx(4 / 7, rel=1e-12) and law.ppf(0.5) == 1.5
    with pytest.raises(ValueError, match="`x` has values with probabilities of their own, and no density"):
        law.pdf(1.5)
    with pytest.raises((TypeError, ValueError)):
        law.cdf("wide")
    again = pickle.loads(pickle.dumps(law))
    assert again == law and again.cdf(1.5) == law.cdf(1.5)


@pytest.mark.parametrize("name", TABLES)
def test_other_laws_are_tables(name):
    law = TABLES[name]()
    study = st.Study(dimensions={"x": st.Dimension(distribution=law)}, characteristics={"y": st.Characteristic("x", upper=law.isf(1e-3))})
    assert study.dimensions["x"].distribution == "tabulated"
    found = study.analyze("full")["y"]
    mean, variance, skewness, excess = (float(one) for one in law.stats("mvsk"))
    # Cubics over scores 1/32 apart: h^4/384 = 2.5e-9 of the fourth derivative, some tens in sigmas at a corner or an end of a law.
    assert found.mean == pytest.approx(mean, abs=1e-6 * math.sqrt(variance))
    assert found.sigma == pytest.approx(math.sqrt(variance), rel=1e-5)
    assert found.skewness == pytest.approx(skewness, abs=1e-4)
    assert found.kurtosis == pytest.approx(excess + 3, abs=1e-3)
    assert found.yield_ == pytest.approx(1 - 1e-3, abs=1e-7)


def test_a_table_is_its_quantiles():
    # Printed quantiles of the standard normal distribution, and of its exponential: no route of the engine made them.
    scores = [-3, -2, -1, 0, 1, 2, 3]
    law = {"kind": "tabulated", "scores": scores, "values": [math.exp(score) for score in scores]}
    study = st.Study(
        dimensions={"x": st.Dimension(1.0, distribution=law)}, characteristics={"y": st.Characteristic("x", upper=math.e)}
    )
    # P(x < e) is P(z < 1) of a normal distribution between -3 and 3: 0.84134 less 0.00135 by 0.9973.
    share = (ss.norm.cdf(1) - ss.norm.cdf(-3)) / (ss.norm.cdf(3) - ss.norm.cdf(-3))
    assert study.analyze("full")["y"].yield_ == pytest.approx(share, abs=1e-12)


def test_laws_that_are_none():
    with pytest.raises(st.StudyError) as error:
        st.Dimension(distribution=ss.cauchy(0, 1))
    assert str(error.value) == "scipy's `cauchy` has no finite mean, and a study computes with the first four moments"
    assert "lighter tails" in error.value.help
    with pytest.raises(st.StudyError, match="scipy's `poisson` is discrete, and a dimension is continuous"):
        st.Dimension(distribution=ss.poisson(3))
    for table, said in [
        ({"scores": [0, 1], "values": [1, 2, 3]}, "as many scores as values"),
        ({"scores": [0, 1, 1], "values": [1, 2, 3]}, "every score of a table must be above that before it, and 1 follows 1"),
        ({"scores": [0, 1, 2], "values": [1, 2, 1.5]}, "every value of a table must be above that before it, and 1.5 follows 2"),
        ({"scores": [0, 1]}, "missing `values`|`values`"),
        ({"scores": [0, 50], "values": [1, 2]}, "not 50"),
    ]:
        with pytest.raises(st.StudyError, match=said):
            st.Study(
                dimensions={"x": st.Dimension(1.0, distribution={"kind": "tabulated", **table})},
                characteristics={"y": st.Characteristic("x")},
            )
    with pytest.raises(st.StudyError, match="scipy's `t` has no sigma with 2 degrees of freedom"):
        st.Dimension(distribution=ss.t(2, 0, 1))
    with pytest.raises(st.StudyError, match="`sigma` follows from the distribution of scipy: leave it out"):
        st.Dimension(sigma=3, distribution=ss.norm(0, 1))
    with pytest.raises(st.StudyError, match="`tolerance` follows from the distribution of scipy: leave it out"):
        st.Dimension(0, 3, distribution=ss.uniform(0, 1))
    with pytest.raises(TypeError, match="distribution must be a name, a dict, a frozen distribution"):
        st.Dimension(distribution=ss.norm)
    with pytest.raises(TypeError, match="distribution must be a name, a dict, a frozen distribution"):
        st.Dimension(distribution=object())
