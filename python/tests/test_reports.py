"""Results: what the command line's JSON has, typed, shown, tabled."""

import contextlib
import io
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from conftest import REPOSITORY, shaft_and_bore

import sensitol as st
from sensitol._records import Record

COMMAND = [sys.executable, "-m", "sensitol._cli"]
EXAMPLES = os.path.join(REPOSITORY, "examples")
#: Measured values need minutes, or programs that may not be there.
LEFT_OUT = {"dual-mass-flywheel", "connecting-rod"}


def studies():
    for name in sorted(os.listdir(EXAMPLES)):
        path = os.path.join(EXAMPLES, name, "study.toml")
        if os.path.exists(path) and name not in LEFT_OUT:
            with open(path) as file:
                if "command =" not in file.read():
                    yield name


def timeless(report):
    """Without what differs from run to run."""
    return {key: value for key, value in report.items() if key not in ("wall_s", "in_model_s")}


@pytest.mark.parametrize("name", list(studies()))
def test_an_analysis_is_that_of_the_command_line(name):
    path = os.path.join(EXAMPLES, name, "study.toml")
    run = subprocess.run([*COMMAND, "analyze", path, "--json", "-v"], capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    assert timeless(st.read(path).analyze().to_dict()) == timeless(json.loads(run.stdout))


@pytest.mark.parametrize("costs", [True, False])
def test_an_allocation_is_that_of_the_command_line(costs, tmp_path):
    path = os.path.join(EXAMPLES, "shaft-and-housing", "study.toml")
    if not costs:
        # Its tolerances have relative costs then.
        path = str(tmp_path / "study.toml")
        shaft_and_bore().write(path)
    run = subprocess.run([*COMMAND, "allocate", path, "--json", "-v"], capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    assert timeless(st.read(path).allocate().to_dict()) == timeless(json.loads(run.stdout))


def test_nominal_values_move_within_their_bounds():
    study = st.read(os.path.join(EXAMPLES, "shaft-and-housing/study.toml"))
    found = study.allocate(recentre={"B": (7.99, 8.01)})
    assert 7.99 <= found.study.dimensions["B"].nominal <= 8.01
    with pytest.raises(st.StudyError, match="there is no dimension `X` to recentre; there are `B`|there is no dimension `X`"):
        study.allocate(recentre=["X"])


@pytest.mark.parametrize("goal", ["minimise=rejects", "maximise=cpk"])
def test_the_best_for_a_cost_is_that_of_the_command_line(goal):
    path = os.path.join(EXAMPLES, "shaft-and-housing", "study.toml")
    what, which = goal.split("=")
    command = [*COMMAND, "allocate", path, f"--{what}", which, "--cost-limit", "20", "--json", "-v"]
    run = subprocess.run(command, capture_output=True, text=True, timeout=300)
    # Without target, nothing is missed.
    assert run.returncode in (0, 1), run.stderr
    found = st.read(path).allocate(**{what: which}, cost_limit=20)
    assert timeless(found.to_dict()) == timeless(json.loads(run.stdout))
    # The limit holds to the precision at which costs are told apart.
    assert found.cost_after <= 20 * (1 + 1e-9)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"minimise": "cost"}, "minimise must be \"rejects\", got 'cost'"),
        ({"maximise": "yield"}, "maximise must be \"cpk\", got 'yield'"),
        ({"maximise": "cpk"}, 'maximise="cpk" needs cost_limit, what all tolerances together may cost'),
        ({"cost_limit": 3}, 'cost_limit is for minimise="rejects" or maximise="cpk": add one of them'),
        ({"minimise": "rejects", "cost_limit": -1}, "cost_limit must be a positive number, got -1"),
        ({"minimise": "rejects", "maximise": "cpk", "cost_limit": 1}, "minimise and maximise are two goals: leave one out"),
        ({"minimise": "rejects", "cost_limit": 1, "front": 3}, 'front is for the least cost: leave out front or minimise="rejects"'),
    ],
)
def test_goals_that_are_none(wrong, said):
    with pytest.raises(ValueError) as error:
        shaft_and_bore().allocate(**wrong)
    assert str(error.value) == said


def test_the_types_of_results_are_those_of_the_schema():
    schema = subprocess.run([*COMMAND, "schema", "--report"], capture_output=True, text=True, check=True).stdout
    tool = os.path.join(REPOSITORY, "python/tools/reports.py")
    made = subprocess.run([sys.executable, tool], input=schema, capture_output=True, text=True, check=True).stdout
    with open(os.path.join(os.path.dirname(st.__file__), "_reports.py"), encoding="utf-8") as file:
        assert file.read() == made, "write it anew: sensitol schema --report | python tools/reports.py > sensitol/_reports.py"


def walk(record):
    """Reads every attribute of a result, and of what is in it."""
    for name in dir(record):
        if name.startswith("_") or callable(getattr(type(record), name, None)):
            continue
        value = getattr(record, name)
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, st.Record):
                assert type(one) is not st.Record, f"{type(record).__name__}.{name} has no type"
                walk(one)


@pytest.mark.parametrize("run", ["analyze", "worst_case", "simulate", "rare", "compare", "sweep", "allocate"])
def test_every_part_of_a_result_has_its_type(run):
    study = shaft_and_bore()
    if run == "allocate":
        study = st.read(os.path.join(EXAMPLES, "shaft-and-housing/study.toml"))
    found = getattr(study, run)(*(("tilt", [0.0, 1.0]) if run == "sweep" else ()))
    walk(found)
    assert found.characteristics
    for table in found.tables():
        columns = found.table(table)
        assert len({len(column) for column in columns.values()}) <= 1


def test_a_table_has_the_numbers_of_the_report(study):
    found = study.analyze("full")
    table = found.table("sensitivities")
    assert table["dimension"] == [one.dimension for one in found["clearance"].sensitivities]
    assert table["linear_share"] == [one.linear_share for one in found["clearance"].sensitivities]
    with pytest.raises(KeyError, match="there is no table `senses`; there are `dimensions`, `characteristics`"):
        found.table("senses")
    pandas = pytest.importorskip("pandas", reason="skipped: pandas is not installed; install with: pip install pandas")
    assert list(found.to_frame("sensitivities")["dimension"]) == table["dimension"]
    assert isinstance(found.to_frame("dimensions"), pandas.DataFrame)


def test_mean_and_sigma_are_written_with_digits_of_sigma():
    def written(spec, **data):
        return format(Record(data), spec)

    assert written("u", mean=0.0436467, sigma=0.0047242, unit="mm") == "0.0436 ± 0.0047 mm"
    assert written(".3u", mean=0.0436467, sigma=0.0047242, unit=None) == "0.04365 ± 0.00472"
    # Rounded, they have a digit more before the point, or none behind it.
    assert written("u", mean=3.14159, sigma=0.0996) == "3.14 ± 0.10"
    assert written("u", mean=123456.0, sigma=789.0, unit="N") == "123460 ± 790 N"
    assert written(".1u", mean=-2.0, sigma=0.96) == "-2 ± 1"
    assert written("u", mean=5.0, sigma=0.0) == "5.0 ± 0.0"
    assert written("u", mean=None, sigma=0.1, unit="mm") == "unknown mm"
    with pytest.raises(ValueError, match="Invalid format specifier|Unknown format code"):
        written("x", mean=1.0, sigma=0.1)


def test_names_that_are_none(study):
    found = study.analyze("full")
    with pytest.raises(KeyError, match="there is no characteristic `clearence`; there are `clearance`"):
        found["clearence"]
    with pytest.raises(AttributeError, match="CharacteristicResult has no attribute 'sigmas'; there are name, unit"):
        found["clearance"].sigmas


def test_a_result_shows_itself(study, tmp_path):
    found = study.analyze("full")
    assert "0.0436467" in str(found)
    assert repr(found) == "<AnalysisResult of clearance: 14 evaluations>"
    assert found.to_html(tmp_path / "page.html") == (tmp_path / "page.html").read_text(encoding="utf-8")
    bundle = found._repr_mimebundle_()
    assert bundle["text/html"].startswith("<iframe srcdoc=")
    assert 'sandbox="allow-scripts allow-downloads"' in bundle["text/html"]
    # A quote in the page would end the attribute.
    inner = bundle["text/html"].split('srcdoc="', 1)[1].split('" sandbox=', 1)[0]
    assert '"' not in inner and "<" not in inner
    assert found.to_svg().startswith("<svg")
    assert json.loads(found.to_json()) == found.to_dict()


def drawn_without_a_window():
    matplotlib = pytest.importorskip(
        "matplotlib", reason="skipped: matplotlib is not installed; install with: pip install matplotlib"
    )
    matplotlib.use("Agg")
    return matplotlib


def test_plots_show_the_whole_contribution(study):
    drawn_without_a_window()
    ax = study.analyze("full").plot("clearance", "contributions")
    widths = {}
    for container in ax.containers:
        for label, bar in zip([text.get_text() for text in ax.get_yticklabels()], container):
            widths[label] = widths.get(label, 0) + bar.get_width()
    # The tilt contributes by curvature alone: the table of the example shaft-and-bore.
    assert widths["tilt"] == pytest.approx(29.18, abs=0.005)
    assert sum(widths.values()) == pytest.approx(100, abs=1e-6)
    ax = study.sweep("tilt", np.linspace(-2, 2, 5)).plot()
    assert ax.get_xlabel() == "tilt [deg]"
    with pytest.raises(TypeError, match="an RareResult has no plot"):
        study.rare(1000).plot()


def test_a_density_has_the_area_of_all_assemblies(study):
    drawn_without_a_window()
    found = study.analyze("full")
    both = found.plot()
    assert len(both) == 2 and both[1].get_title() == "Contributions to clearance"
    ax = found.plot(kind="density")
    curve = ax.get_lines()[0]
    x, y = curve.get_data()
    # All but 1e-4 at either end, by the trapezoidal rule on 400 points.
    assert np.sum(np.diff(x) * (y[1:] + y[:-1]) / 2) == pytest.approx(1, abs=1e-3)
    one = found["clearance"]
    name, _, rest = ax.get_title().partition(": yield ")
    assert name == "clearance" and rest.endswith(" %, target 99.9 %: met")
    # Printed with three digits of the rejects.
    assert 100 - float(rest.split()[0]) == pytest.approx(100 * (1 - one.yield_), rel=5e-3)
    assert [line.get_xdata()[0] for line in ax.get_lines()[1:3]] == [one.lower, one.upper]
    assert ax.get_xlabel() == "clearance [mm]"
    with pytest.raises(ValueError, match="there is no plot 'pie'; there are 'density', 'contributions', 'both'"):
        found.plot(kind="pie")
    with pytest.raises(ValueError, match="two axes"):
        found.plot(kind="both", ax=ax)


def test_a_histogram_of_unequal_intervals_is_a_density(study):
    drawn_without_a_window()
    # A number of points may be a float, as 1e5 is one.
    found = study.simulate(2e3)
    steps = found["clearance"].histogram
    assert len(set(np.round(np.diff(steps.edges), 9))) > 1 and sum(steps.counts) == 2000
    drawn = found.plot().patches[0].get_data()
    assert np.sum(drawn.values * np.diff(drawn.edges)) == pytest.approx(1, abs=1e-12)
    # The height of the first interval by hand.
    width = steps.edges[1] - steps.edges[0]
    assert drawn.values[0] == pytest.approx(steps.counts[0] / 2000 / width, rel=1e-12)


def test_allocations_and_comparisons_are_drawn(study):
    matplotlib = drawn_without_a_window()
    style = dict(matplotlib.rcParams)
    found = study.compare(samples=4096)
    ax = found.plot()
    labels = [text.get_text() for text in ax.get_yticklabels()]
    assert labels == [f"{one.method}: {one.evaluations}" for one in reversed(found["clearance"].methods)]
    ax.figure.canvas.draw()
    boxes = [text.get_window_extent() for text in ax.get_yticklabels()]
    assert not any(one.overlaps(other) for one, other in zip(boxes, boxes[1:]))
    allocated = study.allocate(confirm=0)
    ax = allocated.plot()
    before, after = ax.containers
    assert {bar.get_width() for bar in before} == {100}
    expected = [100 * one.after / one.before for one in reversed(allocated.tolerances)]
    assert [bar.get_width() for bar in after] == pytest.approx(expected, rel=1e-12)
    assert before[0].get_facecolor() != after[0].get_facecolor()
    assert dict(matplotlib.rcParams) == style


def test_names_are_those_of_the_users():
    names = dir(st)
    assert set(st.__all__) < set(names)
    assert [name for name in names if name.startswith("_") or name not in st.__all__] == ["__version__"]


def test_a_frame_names_the_choices(study):
    with pytest.raises(TypeError, match="'dimensions', 'characteristics', 'sensitivities'"):
        study.analyze("rss").to_frame()


@pytest.mark.parametrize(
    "module, call, message",
    [
        ("pandas", lambda found: found.to_frame("dimensions"), r'to_frame needs pandas: pip install "sensitol\[frames\]"'),
        ("matplotlib", lambda found: found.plot(), r'plot needs matplotlib: pip install "sensitol\[plot\]"'),
    ],
)
def test_without_an_extra_it_says_which(study, monkeypatch, module, call, message):
    for name in [one for one in sys.modules if one.split(".")[0] == module]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ImportError, match=message):
        call(study.analyze("rss"))


def test_progress_without_tqdm_is_a_line(study, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    told = io.StringIO()
    with contextlib.redirect_stderr(told):
        shaft_and_bore(lambda bore, shaft, tilt: bore - shaft).analyze("full", progress=True)
    assert told.getvalue().rstrip().endswith("points")
