"""Studies: made of objects, read from files and text, changed, written, refused."""

import json
import math
import os
import pickle

import numpy as np
import pytest

import sensitol as st
from conftest import REPOSITORY, shaft_and_bore


def test_the_readme_s_study_has_the_readme_s_figures(study):
    # The figures of README.md, printed with six to eight digits.
    found = study.analyze("full")["clearance"]
    assert found.mean == pytest.approx(0.0436467, abs=5e-8)
    assert found.sigma == pytest.approx(0.0047242, abs=5e-8)
    assert found.skewness == pytest.approx(-0.1007, abs=5e-5)


def test_an_object_and_a_file_say_the_same(study):
    read = st.read(os.path.join(REPOSITORY, "examples/shaft-and-bore/study.toml"))
    one, other = study.analyze("full")["clearance"], read.analyze("full")["clearance"]
    assert (one.mean, one.sigma) == (other.mean, other.sigma)
    again = st.Study.from_toml(study.to_toml())
    assert again.to_dict() == study.to_dict()
    assert st.Study.from_json(study.to_json()).to_dict() == study.to_dict()


def test_keywords_win_over_the_analysis_section():
    study = shaft_and_bore(analysis={"method": "six-n", "pairs": [["bore", "shaft"]], "seed": 7})
    assert study.analyze().method == "six-n"
    assert study.simulate(1000).seed == 7
    found = study.analyze(method="full", seed=8)
    assert (found.method, found.seed) == ("full", 8)


def test_seeds_make_the_same_numbers(study):
    one, other = study.simulate(4096, seed=3), study.simulate(4096, seed=3, threads=1)
    assert one["clearance"].to_dict() == other["clearance"].to_dict()
    assert study.simulate(4096, seed=4)["clearance"].mean != one["clearance"].mean


def test_replace_changes_one_entry_and_leaves_the_study_alone(study):
    tighter = study.replace(bore=st.Dimension(25.020, 0.006, unit="mm"), title="Tighter")
    assert study.dimensions["bore"].tolerance == [-0.010, 0.010]
    assert tighter.dimensions["bore"].tolerance == [-0.006, 0.006]
    assert (tighter.title, study.title) == ("Tighter", "Shaft and bore")
    # Only the variance of one normal dimension changes: sigma = tolerance/3.
    change = study.analyze("full")["clearance"].sigma ** 2 - tighter.analyze("full")["clearance"].sigma ** 2
    assert change == pytest.approx((0.010**2 - 0.006**2) / 9, rel=1e-9)
    with pytest.raises(st.StudyError, match="there is no dimension and no characteristic `boer`; there are `bore`"):
        study.replace(boer=st.Dimension(1))


def test_written_studies_are_read_again(study, tmp_path):
    for name in ("study.toml", "study.json"):
        study.write(tmp_path / name)
        assert st.read(tmp_path / name).analyze("full")["clearance"].sigma == study.analyze("full")["clearance"].sigma
    with pytest.raises(ValueError, match=r"a study is a .toml or a .json file, got '.*gap.txt'"):
        study.write(tmp_path / "gap.txt")


def test_toml_keeps_names_that_are_no_words():
    study = st.Study(
        dimensions={"D5@Sketch1": st.Dimension(10, 0.3), 'a "b" \\': st.Dimension(5, "2 %")},
        characteristics={"y": st.Characteristic("2*`D5@Sketch1`")},
        correlation={("D5@Sketch1", 'a "b" \\'): 0.5},
    )
    assert st.Study.from_toml(study.to_toml()).to_dict() == study.to_dict()


def test_blocks_vary_together():
    zone = st.Study(
        dimensions={"x": st.Dimension(0, 0.5), "y": st.Dimension(0, 0.5)},
        characteristics={"r2": st.Characteristic("x^2 + y^2")},
        joint=[{"of": ["x", "y"], "law": "disc"}],
    )
    # The square of the distance is uniform from 0 to R^2: closed form, rounding apart.
    found = zone.analyze("full")["r2"]
    assert found.mean == pytest.approx(0.25 / 2, rel=1e-12)
    assert found.sigma == pytest.approx(0.25 / math.sqrt(12), rel=1e-12)
    parts = np.random.default_rng(1).multivariate_normal([3, 4], [[0.01, 0.008], [0.008, 0.01]], 200)
    measured = st.Study(
        dimensions={"x": st.Dimension(), "y": st.Dimension()},
        characteristics={"area": st.Characteristic("x*y")},
        joint=[{"of": ["x", "y"], "measured": parts}],
    )
    areas = parts[:, 0] * parts[:, 1]
    found = measured.analyze("full")["area"]
    assert found.mean == pytest.approx(areas.mean(), rel=1e-12)
    assert found.sigma == pytest.approx(areas.std(), rel=1e-10)
    assert pickle.loads(pickle.dumps(measured)) == measured
    half = measured.replace(joint=[{"of": ["x", "y"], "measured": parts[:100]}])
    assert half.analyze("full")["area"].mean == pytest.approx(areas[:100].mean(), rel=1e-12)


def test_sections_of_a_study_are_arguments():
    study = st.Study(
        dimensions={"a": st.Dimension(10, 0.3, unit="mm")},
        characteristics={"y": st.Characteristic("2*a", lower=19, upper=21, unit="mm")},
        units="check",
        about={"part": "pin", "drawing": "D-1"},
        loss={"y": {"k": 2.0}},
    )
    data = study.to_dict()
    assert (data["units"], data["about"]["part"], data["loss"]["y"]["k"]) == ("check", "pin", 2.0)
    with pytest.raises(st.StudyError, match="loss"):
        study.replace(loss={"z": {"k": 1.0}})


def test_parts_and_joints_are_arguments():
    # A plate on a table: the height of its corner is the thickness, and the place of a peg moves it along x.
    study = st.Study(
        dimensions={"t": st.Dimension(12, 0.1, unit="mm"), "p": st.Dimension(10, 0.05, unit="mm")},
        parts={
            "table": {"top": {"plane": [0, 0, 0], "normal": "z"}, "peg": {"axis": ["p", 10, 0], "along": "z"}, "zero": {"frame": [0, 0, 0], "z": "z", "x": "x"}},
            "plate": {"bottom": {"plane": [0, 0, 0], "normal": "-z"}, "hole": {"axis": [10, 10, 0], "along": "z"}, "lid": {"plane": [0, 0, "t"], "normal": "z"}},
        },
        joints={
            "seat": {"on": "table.top", "against": "plate.bottom"},
            "peg": {"hole": "plate.hole", "pin": "table.peg", "takes": 2},
        },
        characteristics={
            "height": {"of": "plate.lid", "from": "table.top", "unit": "mm", "lower": 11.9, "upper": 12.1},
            "x": {"of": "plate.hole", "from": "table.zero", "along": "x", "unit": "mm"},
        },
    )
    found = study.analyze("full")
    assert found["height"].mean == pytest.approx(12, abs=1e-12)
    assert found["height"].sigma == pytest.approx(0.1 / 3, rel=1e-9)
    assert found["x"].sigma == pytest.approx(0.05 / 3, rel=1e-9)
    again = st.Study.from_toml(study.to_toml())
    assert again.to_dict() == study.to_dict()
    with pytest.raises(st.StudyError, match="plate turns about"):
        study.replace(joints={"peg": {"hole": "plate.hole", "pin": "table.peg", "takes": 2}, "seat": {"on": "table.top", "against": "plate.bottom"}}, x={"of": "plate.lid", "from": "table.zero", "along": "x", "unit": "mm"})


def test_labels_are_texts_that_reports_show():
    labels = {"description": "bored", "part": "housing", "drawing": "4711", "revision": "B", "feature": "7"}
    study = st.Study(
        dimensions={"a": st.Dimension(10, 0.3, **labels)},
        characteristics={"y": st.Characteristic("2*a", description="twice")},
    )
    assert {**study.to_dict()["dimensions"]["a"]} == {"nominal": 10, "tolerance": 0.3, **labels}
    assert st.Study.from_toml(study.to_toml()).to_dict() == study.to_dict()
    assert study.analyze("full").to_dict()["dimensions"][0]["part"] == "housing"


def test_numbers_of_numpy_are_numbers():
    study = st.Study(
        dimensions={"a": st.Dimension(np.float32(10), np.array([-0.25, 0.5])), "b": st.Dimension(np.int64(3))},
        characteristics={"y": st.Characteristic("a + b", lower=np.float64(12))},
    )
    assert study.to_dict()["dimensions"]["a"] == {"nominal": 10.0, "tolerance": [-0.25, 0.5]}


def test_measured_values_are_an_array():
    values = np.random.default_rng(1).normal(8.0, 0.01, 400)
    study = st.Study(
        dimensions={"pin": st.Dimension(distribution=values), "bore": st.Dimension(8.1, 0.03)},
        characteristics={"gap": st.Characteristic("bore - pin")},
    )
    # The engine's empirical distribution has the moments of the values; the bore adds its own sigma of 0.01.
    assert study.dimensions["pin"].mean == pytest.approx(values.mean(), rel=1e-12)
    sigma = math.hypot(values.std(), 0.01)
    assert study.analyze("full")["gap"].sigma == pytest.approx(sigma, rel=2e-3)  # n or n - 1: 0.13 % at 400


def test_a_study_that_was_read_stays_where_it_was(tmp_path, monkeypatch):
    monkeypatch.chdir(os.path.join(REPOSITORY, "examples/measured-pin"))
    study = st.read("study.toml")
    monkeypatch.chdir(tmp_path)
    assert study.analyze("full")["clearance"].sigma > 0


def test_an_array_beside_a_file_of_measured_values():
    study = st.read(os.path.join(REPOSITORY, "examples/measured-pin/study.toml"))
    changed = study.replace(hole=st.Dimension(distribution=np.linspace(10.0, 10.1, 50)))
    assert changed.dimensions["pin"] == study.dimensions["pin"]
    assert changed.dimensions["hole"].mean == pytest.approx(10.05, rel=1e-12)


@pytest.mark.parametrize(
    "values, message",
    [
        ([[1.0, 2.0]], "measured values must be a 1-D array, got shape (1, 2)"),
        ([1.0], "measured values must be two at least, got 1"),
        ([1.0, math.nan, 3.0], "measured values must be finite: value 1 is nan, and 1 are not finite"),
    ],
)
def test_measured_values_that_are_none(values, message):
    with pytest.raises(st.StudyError) as error:
        st.Dimension(distribution=np.array(values))
    assert str(error.value) == message


def test_a_fault_of_a_study_of_objects_has_the_path_and_no_line():
    with pytest.raises(st.StudyError) as error:
        st.Study(dimensions={"a": st.Dimension(10, -0.3)}, characteristics={"y": st.Characteristic("a")})
    found = error.value
    assert (found.file, found.line, found.column, found.key) == (None, None, None, "dimensions.a.tolerance")
    assert str(found) == (
        "dimensions.a.tolerance: the tolerance must not be negative, but is -0.3 (write 0.3 for a band on both sides, [-0.3, 0] for one below)"
    )


def test_a_fault_of_a_file_has_its_place(tmp_path):
    path = tmp_path / "gap.toml"
    path.write_text("[dimensions]\na = { nominal = 1, tolerance = -2 }\n[characteristics]\ny = { formula = \"a\" }\n")
    with pytest.raises(st.StudyError) as error:
        st.read(path)
    found = error.value
    assert (found.file, found.line, found.column, found.key) == (str(path), 2, 32, "dimensions.a.tolerance")
    with pytest.raises(st.StudyError, match="the file cannot be read"):
        st.read(tmp_path / "none.toml")
    with pytest.raises(st.StudyError, match="this is a folder, not a study"):
        st.read(tmp_path)


def test_every_fault_is_told_at_once():
    with pytest.raises(st.StudyError) as error:
        st.Study(
            dimensions={"a": st.Dimension(10, -0.3), "b": st.Dimension(1, -1)},
            characteristics={"y": st.Characteristic("a")},
        )
    assert [one["key"] for one in error.value.more] == ["dimensions.b.tolerance"]
    assert len(str(error.value).splitlines()) == 2


@pytest.mark.parametrize(
    "make, kind, message",
    [
        (
            lambda: st.Study(dimensions={"a": 10}, characteristics={}),
            TypeError,
            "dimensions['a'] must be a Dimension, got int: write Dimension(10)",
        ),
        (
            lambda: st.Study(dimensions=[1], characteristics={}),
            TypeError,
            "dimensions must be a mapping of names, got list",
        ),
        (
            lambda: st.Characteristic(lambda a: a),
            TypeError,
            "a formula is text, got function; a function goes to Study(model=...)",
        ),
        (
            lambda: st.Study(dimensions={"a": st.Dimension(math.nan)}, characteristics={"y": st.Characteristic("a")}),
            st.StudyError,
            "dimensions.a.nominal: invalid number nan (write a finite number, or leave out a limit that does not exist)",
        ),
        (
            lambda: shaft_and_bore(correlation={"bore": 0.3}),
            TypeError,
            "correlation is by pairs of names, such as {('bore', 'shaft'): 0.3}, got 'bore'",
        ),
        (
            lambda: shaft_and_bore(joint={"of": ["bore", "shaft"]}),
            TypeError,
            "joint must be a list of blocks such as [{'of': ['x', 'y'], 'law': 'disc'}], got dict",
        ),
        (
            lambda: shaft_and_bore(joint=["bore"]),
            TypeError,
            "joint[0] must be a mapping such as {'of': ['x', 'y'], 'law': 'disc'}, got str",
        ),
        (
            lambda: shaft_and_bore(joint=[{"of": ["bore", "shaft"], "measured": [1.0, 2.0]}]),
            st.StudyError,
            "joint[0]['measured'] must have a row for each part and a column for each of bore, shaft: shape (parts, 2), got (2,)",
        ),
        (
            lambda: shaft_and_bore(joint=[{"of": ["bore", "shaft"], "measured": [[1.0, math.nan], [2.0, 1.0]]}]),
            st.StudyError,
            "joint[0]['measured'] must be finite: row 0, shaft, is nan; 1 are not finite",
        ),
        (lambda: shaft_and_bore().analyze(threads=0), ValueError, "threads must be 1 or more, got 0"),
        (lambda: shaft_and_bore().analyze(time=-1), ValueError, "time must be positive, in seconds, got -1"),
        (
            lambda: shaft_and_bore().analyze(executor=3),
            TypeError,
            "an executor has a method submit, and int has none",
        ),
        (
            lambda: shaft_and_bore().analyze(on_interrupt="stop"),
            ValueError,
            'on_interrupt must be "raise" or "partial", got \'stop\'',
        ),
        (lambda: shaft_and_bore().analyze(chunksize=0), ValueError, 'chunksize must be "auto" or 1 or more, got 0'),
        (lambda: shaft_and_bore().sweep("tilt", ["a"]), TypeError, "values must be a sequence of numbers"),
    ],
)
def test_arguments_that_are_none(make, kind, message):
    with pytest.raises(kind) as error:
        make()
    assert type(error.value) is kind
    assert str(error.value) == message


def test_options_that_are_none(study):
    with pytest.raises(st.StudyError) as error:
        study.analyze(method="ful")
    assert error.value.key == "analysis.method"
    assert "full" in str(error.value)
    with pytest.raises(st.AnalysisError) as error:
        study.analyze(method="full", budget=3)
    assert error.value.advice
    assert "--" not in str(error.value)
    with pytest.raises(ValueError, match="clearence"):
        study.analyze(characteristics="clearence")
    with pytest.raises(st.StudyError, match="tlt"):
        study.sweep("tlt", [1.0])


def test_warnings_are_data_and_are_issued_at_the_caller_s_line():
    study = st.Study(
        dimensions={"a": st.Dimension(0, 1)},
        constants={"unused": 3.0},
        characteristics={"y": st.Characteristic("a^2", lower=-1, upper=1)},
    )
    assert [one.code for one in study.check()] == ["unused-name"]
    with pytest.warns(st.SensitolWarning) as told:
        found = study.analyze("rss")
    assert {one.code for one in found.warnings} == {one.message.code for one in told}
    assert all(one.filename == __file__ for one in told)
    assert not any("--" in str(one.message) for one in told)


def test_a_built_in_model_and_a_sweep_of_its_inputs():
    read = st.read(os.path.join(REPOSITORY, "examples/engine-balance/study.toml"))
    model = read.to_dict()["model"]["builtin"]
    made = st.Study(
        dimensions=read.to_dict()["dimensions"], characteristics=read.to_dict()["characteristics"], model=model
    )
    name = made.characteristics[0]
    assert made.analyze("full")[name].sigma == read.analyze("full")[name].sigma


def test_a_program_is_a_model():
    study = st.read(os.path.join(REPOSITORY, "examples/external-python/study.toml"))
    found = study.analyze("second-order", cache=False)
    assert all(one.sigma > 0 for one in found.characteristics)
    assert found.evaluator is not None


def test_a_result_tells_what_was_required(study):
    assert study.analyze("full").met is True
    strict = study.replace(clearance=st.Characteristic("bore - shaft", lower=0.0399, upper=0.0401, target_yield=0.99))
    assert strict.analyze("full").met is False
    assert study.replace(clearance=st.Characteristic("bore - shaft")).analyze("full").met is None


def test_an_allocation_has_the_study_that_it_found(tmp_path):
    study = st.read(os.path.join(REPOSITORY, "examples/shaft-and-housing/study.toml"))
    found = study.allocate()
    # The cost of the published optimum in docs/validation.md.
    assert found.cost_after == pytest.approx(8.0536, abs=5e-5)
    assert found.study.dimensions["B"].tolerance[1] == pytest.approx(0.00811423, rel=1e-5)
    found.study.write(tmp_path / "tighter.toml")
    again = st.read(tmp_path / "tighter.toml").analyze()
    assert again["gap"].sigma == found.study.analyze()["gap"].sigma
    assert study.dimensions["B"].tolerance[1] == 0.008


def test_worst_case_rare_sweep_and_compare(study):
    worst = study.worst_case("full")["clearance"].worst_case
    # The model is monotonic in bore and shaft, and least at the end of the band of tilt.
    least = 25.010 - 24.980 / math.cos(math.radians(1.5))
    assert worst.extremes[0] == pytest.approx(least, rel=1e-9)
    rare = study.rare(2000)["clearance"]
    assert 0.999 < rare.yield_ <= 1
    sweep = study.sweep("tilt", np.linspace(-2, 2, 5))
    assert [point.at for point in sweep["clearance"].points] == [-2, -1, 0, 1, 2]
    comparison = study.compare(samples=2000)
    assert {one.method for one in comparison["clearance"].methods} >= {"full", "rss"}
    assert json.loads(json.dumps(comparison.to_dict())) == comparison.to_dict()


CONFIGURED = """[dimensions]
a = { nominal = 10, tolerance = 0.1 }
[constants]
k = 2
[configurations]
long = { a = 20 }
wide = { k = 3 }
[characteristics]
y = { formula = "a*k" }
"""


def test_configurations(tmp_path):
    study = st.Study.from_toml(CONFIGURED)
    assert study.configurations == ["long", "wide"]
    means = [study.configured(name).analyze()["y"].mean for name in (None, "long", "wide")]
    # The middle of a band of 10, 20 and 10, times 2, 2 and 3.
    assert means == pytest.approx([20, 40, 30], rel=1e-12)
    (tmp_path / "study.toml").write_text(CONFIGURED)
    read = st.read(tmp_path / "study.toml", configuration="long")
    assert (read.configuration, read.dimensions["a"].nominal) == ("long", 20)
    assert pickle.loads(pickle.dumps(read)) == read
    assert read.replace(a=st.Dimension(30, 0.1)).configuration == "long"
    made = st.Study(
        dimensions={"a": st.Dimension(10, 0.1)},
        characteristics={"y": st.Characteristic("2*a")},
        configurations={"long": {"a": 40.0}},
    )
    assert made.configured("long").analyze()["y"].mean == pytest.approx(80, rel=1e-12)
    with pytest.raises(st.StudyError, match="lng"):
        study.configured("lng")
    with pytest.raises(TypeError, match="a configuration is named by text, got int"):
        study.configured(3)
    with pytest.raises(st.StudyError, match="the study has no \\[configurations\\]"):
        shaft_and_bore().configured("long")
