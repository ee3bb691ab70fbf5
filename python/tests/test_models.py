"""Functions of Python as models: their forms, their faults, their exceptions."""

import math
import traceback

import numpy as np
import pytest
from conftest import shaft_and_bore

import models
import sensitol as st

try:
    from hypothesis import given, settings
    from hypothesis import strategies as some
except ImportError:
    given = None


def gap(model, dimensions=None, **more):
    dimensions = dimensions or {"a": st.Dimension(10, 0.3), "b": st.Dimension(5, 0.4)}
    characteristics = more.pop("characteristics", {"gap": st.Characteristic()})
    return st.Study(dimensions=dimensions, characteristics=characteristics, model=model, **more)


@pytest.mark.parametrize("model", [models.clearance, models.clearance_vectorized, models.plain])
def test_a_function_has_the_figures_of_the_formula(model, study):
    one, other = study.analyze("full")["clearance"], shaft_and_bore(model).analyze("full")["clearance"]
    # The same points; cosine of math, NumPy and the engine differ in the last bit, which differences divide by 1e-3 or so.
    for field in ("mean", "sigma", "skewness", "kurtosis"):
        assert getattr(other, field) == pytest.approx(getattr(one, field), rel=1e-7)
    # Sobol's points are the same too; random ones are drawn in larger portions for a function.
    drawn = study.simulate(4096, sampler="sobol", seed=5)["clearance"]
    of = shaft_and_bore(model).simulate(4096, sampler="sobol", seed=5)["clearance"]
    assert of.mean == pytest.approx(drawn.mean, rel=1e-12)


def test_formulas_stand_on_top_of_a_function():
    study = gap(lambda a, b: a - b, characteristics={"gap": st.Characteristic(), "microns": st.Characteristic("1000*gap")})
    found = study.analyze("full")
    assert found["microns"].sigma == pytest.approx(1000 * math.hypot(0.1, 0.4 / 3), rel=1e-9)


def test_constants_and_defaults_are_parameters():
    study = gap(lambda a, b, k, extra=2.0: k * (a - b) + extra, constants={"k": 3.0})
    assert study.analyze("full")["gap"].mean == pytest.approx(3 * 5 + 2, rel=1e-12)


def test_names_that_are_no_identifiers():
    dimensions = {"D5@Sketch1": st.Dimension(10, 0.3), "b": st.Dimension(5, 0.4)}
    by_dict = st.model(pass_="dict", vectorized=True)(lambda x: x["D5@Sketch1"] - x["b"])
    by_rest = lambda b, **x: x["D5@Sketch1"] - b  # noqa: E731
    for model in (by_dict, by_rest):
        assert gap(model, dimensions).analyze("full")["gap"].mean == pytest.approx(5, rel=1e-12)


@pytest.mark.parametrize("answer", [lambda a, b: (a - b, a * b), lambda a, b: {"force": a * b, "gap": a - b}])
@pytest.mark.parametrize("vectorized", [False, True])
def test_several_outputs(answer, vectorized):
    model = st.model(outputs=["gap", "force"], vectorized=vectorized)(answer)
    found = gap(model, characteristics={"force": st.Characteristic(), "gap": st.Characteristic()}).analyze("full")
    assert found["gap"].mean == pytest.approx(5, rel=1e-12)
    assert found["force"].mean == pytest.approx(50, rel=1e-12)
    one = gap(model, characteristics={"force": st.Characteristic()}).analyze("full")
    assert one["force"].mean == pytest.approx(50, rel=1e-12)


def test_a_study_s_program_is_answered_by_a_function(tmp_path):
    path = tmp_path / "gap.toml"
    path.write_text(
        "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 5, tolerance = 0.4 }\n"
        '[characteristics]\ngap = { lower = 4 }\n[model]\ncommand = ["no-such-program"]\n'
    )
    assert st.read(path, model=lambda a, b: a - b).analyze("full")["gap"].mean == pytest.approx(5, rel=1e-12)
    text = path.read_text().replace('command = ["no-such-program"]', 'builtin = "engine-balance"')
    path.write_text(text)
    with pytest.raises(st.StudyError, match="leave out \\[model\\], or the function"):
        st.read(path, model=lambda a, b: a - b)


def test_arrays_belong_to_the_model():
    kept = []

    @st.model(vectorized=True)
    def keeps(a, b):
        kept.append((a, a.copy()))
        return a - b

    gap(keeps).simulate(20_000)
    assert all(np.array_equal(one, copy) for one, copy in kept)

    @st.model(vectorized=True)
    def writes(a, b):
        a[:] = 0
        return a - b

    with pytest.raises(ValueError, match="read-only"):
        gap(writes).analyze("full")


TWO = {"gap": st.Characteristic(), "force": st.Characteristic()}
FAULTS = [
    (lambda a, b: "x", {}, "<lambda>() answered str 'x' for one point: return a number, or use @model(vectorized=True)"),
    (lambda a, b: 1j, {}, "<lambda>() answered the complex number 1j: return a real number"),
    (lambda a, b: object, {}, "<lambda>() answered type <class 'object'>: return a number"),
    (
        lambda a, b: np.zeros(3),
        {},
        "<lambda>() answered an array of shape (3,) for one point: return a number, or use @model(vectorized=True)",
    ),
    (lambda a, b: {"g": 1.0}, {}, "<lambda>() answered `g`, not `gap`"),
    (
        lambda a, b: 1.0,
        {"characteristics": TWO},
        "<lambda>() answered float 1.0 and is asked for `gap`, `force`: return a dict by name, or say which with "
        "@model(outputs=[...])",
    ),
    (
        st.model(outputs=["gap", "force"])(lambda a, b: (1.0,)),
        {"characteristics": TWO},
        "<lambda>() answered 1 values, and has 2 outputs: `gap`, `force`",
    ),
    (
        st.model(outputs=["gap", "force"])(lambda a, b: 1.0),
        {"characteristics": TWO},
        "<lambda>() answered float 1.0, and has 2 outputs: return a tuple in the order of outputs, or a dict by name",
    ),
    (
        st.model(outputs=["gap"])(lambda a, b: 1.0),
        {"characteristics": TWO},
        "<lambda>() has the outputs `gap`, and the study asks for `force`",
    ),
    (
        lambda a, c: a,
        {},
        "<lambda>() needs `c`, which is no dimension and no constant of the study: there are `a`, `b`",
    ),
    (
        lambda a: a,
        {},
        "<lambda>() has no parameter `b`, and no formula uses this dimension: add the parameter, or **rest",
    ),
    (
        lambda *x: x[0],
        {},
        '<lambda>(*x) takes parameters by position, and a model gets them by name: name the dimensions, or use '
        '@model(pass_="dict")',
    ),
    (
        st.model(vectorized=True)(lambda a, b: 3.0),
        {},
        "<lambda>() answered a scalar for 7 points: a vectorized function returns an array of shape (7,)",
    ),
    (
        st.model(vectorized=True)(lambda a, b: np.zeros((2, len(a)))),
        {},
        "<lambda>() answered an array of shape (2, 7) for 7 points: a vectorized function returns an array of shape (7,)",
    ),
    (
        st.model(vectorized=True)(lambda a, b: a * 1j),
        {},
        "<lambda>() answered an array of complex128: return real numbers",
    ),
]


@pytest.mark.parametrize("model, more, message", FAULTS, ids=range(len(FAULTS)))
def test_answers_that_are_none(model, more, message):
    with pytest.raises(st.ModelError) as error:
        gap(model, **more).analyze("full", verify=0)
    assert str(error.value).replace("1 points", "7 points").replace("(1,)", "(7,)").replace("(2, 1)", "(2, 7)") == message


def test_a_function_of_whole_arrays_is_found_out():
    @st.model(vectorized=True)
    def whole(a, b):
        return np.max([a, b]) + 0 * a

    with pytest.raises(st.ModelError, match=r"whole\(\) answers `gap` .* in a block of \d+ points and .* alone: each answer"):
        gap(whole).analyze("full")


def test_settings_of_a_model_that_are_none():
    with pytest.raises(ValueError, match='pass_ must be "names" or "dict", got \'rows\''):
        st.model(pass_="rows")(lambda a: a)
    with pytest.raises(TypeError, match=r"outputs must be a list of names: outputs=\['gap'\]"):
        st.model(outputs="gap")(lambda a: a)
    with pytest.raises(ValueError, match='errors must be "raise" or "point", got \'skip\''):
        st.model(errors="skip")(lambda a: a)
    with pytest.raises(TypeError, match="a model is a function, got <class 'dict'>"):
        shaft_and_bore().replace(model=dict)


def test_an_exception_is_the_user_s_own():
    def wrong(a, b):
        return a - undefined_name  # noqa: F821

    with pytest.raises(NameError) as error:
        gap(wrong).analyze("full")
    assert traceback.extract_tb(error.value.__traceback__)[-1].name == "wrong"


@pytest.mark.parametrize("vectorized", [False, True])
@pytest.mark.parametrize("kind", [st.NoValue, ZeroDivisionError])
def test_a_point_without_value_fails_alone(vectorized, kind):
    def holes(a, b):
        if np.any(np.asarray(a) > 10.2):
            raise kind("too large")
        return a - b

    found = gap(st.model(vectorized=vectorized)(holes)).simulate(2000, seed=1)["gap"]
    # A normal of sigma 0.1 is above two sigmas in 2.275 % of 2000 points; four standard errors are 27 points.
    assert abs(found.failed - 45.5) < 27
    assert "too large" in found.error


def test_nan_fails_its_point_and_errors_point_all():
    found = gap(lambda a, b: math.nan if a > 10 else a - b).simulate(1000)["gap"]
    assert 400 < found.failed < 600

    @st.model(errors="point")
    def raising(a, b):
        raise LookupError("no such part")

    with pytest.warns(st.SensitolWarning):
        found = gap(raising).analyze("full")
    assert found["gap"].sigma is None


def test_a_model_may_analyse_another_study(study):
    @st.model
    def outer(a, b):
        inner = study.analyze("rss", threads=1)
        return a - b + 0 * inner["clearance"].mean

    assert gap(outer).analyze("second-order", threads=1, verify=0)["gap"].mean == pytest.approx(5, rel=1e-12)


def test_a_cheap_model_is_verified_by_a_sample():
    cheap = st.model(vectorized=True, cheap=True)(lambda a, b: a * b)
    assert gap(cheap).analyze("full")["gap"].verification is not None


if given is not None:

    @settings(max_examples=20, deadline=None)
    @given(some.floats(-2, 2), some.floats(0.1, 3), some.floats(-1, 1))
    def test_scalar_and_vectorized_forms_agree(linear, power, mixed):
        def either(a, b):
            return linear * a + mixed * a * b + abs(b) ** power

        one = gap(either).analyze("full", verify=0)["gap"]
        other = gap(st.model(vectorized=True)(either)).analyze("full", verify=0)["gap"]
        # NumPy's power is another than C's in its last bits.
        assert other.mean == pytest.approx(one.mean, rel=1e-9, abs=1e-12)
        assert other.sigma == pytest.approx(one.sigma, rel=1e-6, abs=1e-9)
