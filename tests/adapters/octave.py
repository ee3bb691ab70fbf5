"""adapters/octave against closed form: a four-bar linkage by the crossing of two circles, which the model does not use."""

import json
import math
import pathlib
import random
import subprocess
import tempfile

from harness import EXAMPLES, ROOT, client, failed, journal, refused, report, run, sensitol, shown

ADAPTER = ROOT / "adapters/octave"
EXAMPLE = EXAMPLES / "four-bar-octave"
STUDY = EXAMPLE / "study.toml"
NOMINAL = {"crank": 40.0, "coupler": 120.0, "follower": 80.0, "ground": 100.0, "theta": 60.0}
UNITS = ["mm", "mm", "mm", "mm", "deg"]
NAMES = ["angle", "transmission"]
# Degrees. Some dozen roundings of angles of 1 rad, times 57, with room; acos and roots lose a digit near their ends.
CLOSE = 1e-11


def closed(crank, coupler, follower, ground, theta):
    """Where the circle of the coupler around the crank's pin meets that of the follower; None where they do not meet."""
    pin = complex(crank * math.cos(math.radians(theta)), crank * math.sin(math.radians(theta)))
    between = ground - pin
    distance = abs(between)
    along = (coupler**2 - follower**2 + distance**2) / (2 * distance)
    if abs(along) > coupler:
        return None
    joint = pin + between / distance * complex(along, math.sqrt(coupler**2 - along**2))
    of = lambda vector: math.degrees(math.atan2(vector.imag, vector.real))
    angle = of(joint - ground)
    return angle, angle - of(joint - pin)


def linkage(names=NAMES, units=UNITS, nominal=NOMINAL):
    return client(["octave-cli", "--quiet", "linkage.m"], EXAMPLE, units, nominal, names)


def written(folder, text):
    path = pathlib.Path(folder) / "model.m"
    path.write_text(f"addpath ('{ADAPTER}');\n{text}\n")
    return ["octave-cli", "--quiet", path]


def every_point_is_that_of_the_closed_form():
    with tempfile.TemporaryDirectory() as folder:
        for count, command in [(31, ["analyze", STUDY]), (2000, ["simulate", STUDY, "--samples", "2000"])]:
            kept = pathlib.Path(folder) / f"{count}.sqlite"
            sensitol(*command, "--journal", kept)
            rows = journal(kept)
            assert len(rows) >= count, len(rows)
            for row in rows:
                right = closed(**{name: row[name] for name in NOMINAL})
                assert max(abs(row[name] - value) for name, value in zip(NAMES, right)) < CLOSE, (row, right)


def the_moments_are_those_of_the_formulas():
    found, own = (
        report("analyze", path, "--method", "full", "--characteristic", "angle", "--derivatives", "difference", "--journal", "none")[0]
        for path in (STUDY, EXAMPLES / "four-bar/study.toml")
    )
    for key in ("mean", "sigma", "skewness", "kurtosis"):
        a, b = (one["characteristics"][0][key] for one in (found, own))
        # The other study solves two equations to 1e-12 and takes second differences over a sigma of 0.1 of them.
        assert abs(a - b) < 1e-9 * max(1.0, abs(b)), (key, a, b)


def it_passes_the_probe():
    sensitol("probe", STUDY)


def points_of_a_window_are_one_call_and_errors_are_their_own():
    chance = random.Random(5)
    points = [{name: value * (1 + 0.4 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()} for _ in range(200)]
    with linkage() as model:
        text = "".join(json.dumps({"id": index, "x": list(point.values())}) + "\n" for index, point in enumerate(points))
        model.process.stdin.write(text)
        model.process.stdin.flush()
        none = 0
        for _ in points:
            answer = json.loads(model.process.stdout.readline())
            right = closed(**points[answer["id"]])
            if right is None:
                none += 1
                assert answer["y"] == [None, None] and "NaN" in answer["errors"]["angle"], answer
            else:
                # Far from the nominal linkage the roots have fewer digits.
                assert max(abs(a - b) for a, b in zip(answer["y"], right)) < 1e-9, (answer, right)
        assert 5 < none < 150, none


def a_raised_error_is_that_of_its_point_alone():
    text = """
function y = f (p)
  disp ('noise that is not an answer');
  if (any (p.a < 0))
    error ('a is negative');
  end
  y = sqrt (p.a - 1) + p.g;
end
sensitol_octave (@f, 'version', 2);
"""
    with tempfile.TemporaryDirectory() as folder:
        command = written(folder, text)
        hello = {
            "sensitol": 1, "dimensions": ["a"], "units": ["mm"], "nominal": [4.0], "constants": {"g": 0.5},
            "characteristics": ["y"], "optional": [],
        }  # fmt: skip
        lines = [hello, *({"id": index, "x": [a]} for index, a in enumerate([5.0, -1.0, 0.5, 10.0]))]
        done = subprocess.run(
            [str(part) for part in command], cwd=folder, capture_output=True, text=True, timeout=60, check=True,
            input="".join(json.dumps(line) + "\n" for line in lines),
        )  # fmt: skip
        ready, *answers = map(json.loads, done.stdout.splitlines())
        assert [answer["id"] for answer in answers] == [0, 1, 2, 3], answers
        assert answers[0]["y"] == [2.5] and answers[3]["y"] == [3.5], answers
        failed(answers[1], "a is negative")
        assert answers[2]["y"] == [None] and ready["version"] == "2", (ready, answers)
        assert "noise that is not an answer" in done.stderr


def names_that_are_no_identifiers_have_a_field():
    text = "sensitol_octave (@(p) 2 * p.crank, 'fields', {'crank', 'D5@Sketch1'});"
    with tempfile.TemporaryDirectory() as folder:
        with client(written(folder, text), folder, [None], {"D5@Sketch1": 4.0}, ["y"]) as model:
            assert model.point(**{"D5@Sketch1": 4.5})["y"] == [9.0]
        with client(written(folder, text), folder, [None], {"D6@Sketch1": 4.0}, ["y"]) as model:
            refused(model, "`D6@Sketch1`", "fields")


def what_is_wrong_is_one_error():
    with linkage(names=["twist"]) as model:
        refused(model, "`twist`", "angle, transmission")
    with linkage(units=["mm", "mm", "mm", "mm", "rad"]) as model:
        refused(model, "`theta`", "`rad`", "`deg`")
    with linkage(nominal={**NOMINAL, "pin": 3.0}, units=[*UNITS, "mm"]) as model:
        refused(model, "`pin`", "crank, coupler")
    with linkage(nominal={"crank": 40.0}, units=["mm"]) as model:
        refused(model, "`coupler` is needed")
    for text, words in [
        ("sensitol_octave (@(p) p.a, 'colour', 3);", ["option 1", "window"]),
        ("sensitol_octave (@(p) p.a);", []),
        ("sensitol_octave (@(p) [p.a; p.a]);", ["returned 2 values", "1 points"]),
        ("sensitol_octave (@(p) struct ('z', p.a));", ["no `y`"]),
    ]:
        with tempfile.TemporaryDirectory() as folder:
            with client(written(folder, text), folder, [None], {"a": 4.0}, ["y"]) as model:
                if "error" in model.ready:
                    refused(model, *words)
                elif words:
                    failed(model.point(a=1.0), *words)
                else:
                    assert model.point(a=1.5)["y"] == [1.5]


def the_readme_shows_it():
    shown("four-bar-octave")


if __name__ == "__main__":
    run([
        it_passes_the_probe,
        every_point_is_that_of_the_closed_form,
        the_moments_are_those_of_the_formulas,
        points_of_a_window_are_one_call_and_errors_are_their_own,
        a_raised_error_is_that_of_its_point_alone,
        names_that_are_no_identifiers_have_a_field,
        what_is_wrong_is_one_error,
        the_readme_shows_it,
    ])  # fmt: skip
