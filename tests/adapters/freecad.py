"""adapters/freecad against closed form: the stacked blocks, whose gap is a formula that neither sketch nor adapter knows."""

import json
import math
import pathlib
import random
import re
import subprocess
import tempfile
import zipfile

from harness import EXAMPLES, ROOT, client, failed, journal, refused, report, run, sensitol, shown

ADAPTER = ROOT / "adapters/freecad/sensitol_freecad.py"
EXAMPLE = EXAMPLES / "stacked-blocks-freecad"
STUDY = EXAMPLE / "study.toml"
NOMINAL = {"a": 10.0, "b": 30.0, "c": 31.9, "e": 55.0, "f": 75.0, "R": 40.0, "r": 10.0, "th": 17.0}
UNITS = ["mm"] * 7 + ["deg"]
# mm. FreeCAD's solver stops at a sum of squared residuals of 1e-20; 6e-10 is the worst seen within ±35 %.
CLOSE = 1e-8


def gap(a, b, c, e, f, R, r, th):
    """The formulas of examples/stacked-blocks; None where the cylinder does not touch the wall."""
    th = math.radians(th)
    if R * math.sin(th) + r >= R - r:
        return None
    yR = c + e / math.cos(th) + (a - b) * math.tan(th) - R * math.sin(th) * math.tan(th)
    return f - r - yR + (R - r) * math.sin(math.acos((R * math.sin(th) + r) / (R - r)))


def at(rows):
    """The worst difference to the formula."""
    return max(abs(row["gap"] - gap(**{name: row[name] for name in NOMINAL})) for row in rows)


def freecad(declaration=EXAMPLE / "blocks.toml", characteristics=("gap", "drawn"), units=UNITS):
    return client(["python3", ADAPTER, declaration], EXAMPLE, units, NOMINAL, list(characteristics))


def copy(folder, change):
    """The example in another folder, its declaration changed."""
    text = (EXAMPLE / "blocks.toml").read_text().replace('"blocks.FCStd"', json.dumps(str(EXAMPLE / "blocks.FCStd")))
    path = pathlib.Path(folder) / "blocks.toml"
    path.write_text(change(text))
    return path


def every_point_is_that_of_the_formula():
    with tempfile.TemporaryDirectory() as folder:
        for count, command in [
            (73, ["analyze", STUDY, "--method", "full"]),
            (49, ["analyze", STUDY, "--method", "six-n"]),
            (200, ["simulate", STUDY, "--samples", "200"]),
        ]:
            kept = pathlib.Path(folder) / f"{count}.sqlite"
            sensitol(*command, "--journal", kept)
            rows = journal(kept)
            assert len(rows) >= count, f"{len(rows)} points of {count}"
            assert at(rows) < CLOSE, at(rows)


def the_order_does_not_matter():
    chance = random.Random(7)
    points = [
        {name: value * (1 + 0.35 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()} for _ in range(60)
    ]
    found = []
    with freecad() as model:
        for order in (points, points[::-1]):
            found.append({id(point): model.point(**point) for point in order})
    values = 0
    for point in points:
        first, second = (answers[id(point)] for answers in found)
        assert ("y" in first) == ("y" in second), (first, second)
        if "y" in first:
            values += 1
            # The solver repeats itself to some units in the last place, not to the last bit. A flip or a warm start is far more.
            assert max(abs(a - b) for a, b in zip(first["y"], second["y"])) < 1e-11, (first, second)
            # The signed distance and the sketch's own reference dimension.
            for value in first["y"]:
                assert abs(value - gap(**point)) < CLOSE, (point, first)
        else:
            failed(first, "Blocks")
    assert values > 40, values


def the_moments_are_the_published_ones():
    found = report("analyze", STUDY, "--method", "full", "--journal", "none")[0]["characteristics"][0]
    # Sadikhani and Hashemian 2018, Table 3, second order: four decimals.
    assert abs(found["mean"] - 5.9954) < 5.1e-5 and abs(found["sigma"] - 0.2892) < 5.1e-5, found
    same = report("analyze", EXAMPLES / "stacked-blocks/study.toml", "--method", "full", "--characteristic", "gap")[0]
    same = same["characteristics"][0]
    for key in ("mean", "sigma", "skewness", "kurtosis"):
        # Second differences of noise of 1e-10 over steps of sigma.
        assert abs(found[key] - same[key]) < 1e-6, (key, found[key], same[key])


def interference_is_negative():
    with freecad() as model:
        low = {**NOMINAL, "f": 68.0}
        answer = model.point(**low)
        assert abs(answer["y"][0] - gap(**low)) < CLOSE and answer["y"][0] < -1.0, answer


def an_absurd_point_is_an_error_of_its_own():
    with freecad() as model:
        right = model.point(**NOMINAL)["y"]
        for absurd in ({"R": 12.0}, {"th": 89.0}, {"r": 60.0}, {"R": -40.0}):
            failed(model.point(**{**NOMINAL, **absurd}), "Blocks")
            assert model.point(**NOMINAL)["y"] == right


def a_mirrored_assembly_is_an_error():
    # 60 % are far outside what the drawing stands for; some of it still solves, in another way.
    chance = random.Random(3)
    guarded = 0
    with freecad() as model:
        for _ in range(200):
            point = {name: value * (1 + 0.6 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()}
            answer = model.point(**point)
            if "y" in answer:
                assert abs(answer["y"][0] - gap(**point)) < CLOSE, (point, answer)
            guarded += "guard" in answer.get("error", "")
    assert guarded > 0


def without_the_reset_the_engine_notices():
    with tempfile.TemporaryDirectory() as folder:
        copy(folder, lambda text: "reset = false\n" + text[: text.index("[guards]")])
        text = STUDY.read_text().replace("../../adapters/freecad/sensitol_freecad.py", str(ADAPTER))
        text = text.replace("workers = 2 ", "workers = 1 ").replace(', "blocks.FCStd"', "")
        wide = lambda m: f"nominal = {m[1]}, tolerance = {0.3 * float(m[1])}, distribution = \"uniform\""
        path = pathlib.Path(folder) / "study.toml"
        path.write_text(re.sub(r"nominal = ([\d.]+), tolerance = [\d.]+", wide, text))
        found, _ = report("analyze", path, "--method", "full", "--journal", "none")
        assert "branch-flip" in [one["code"] for one in found["warnings"]], found["warnings"]
        assert "FAIL" in sensitol("probe", path, code=1)[0]


def it_passes_the_probe():
    sensitol("probe", STUDY)


def the_script_makes_the_document():
    with tempfile.TemporaryDirectory() as folder:
        made = pathlib.Path(folder) / "made.FCStd"
        subprocess.run(["/usr/bin/python3", EXAMPLE / "make.py", made], check=True, capture_output=True)
        path = copy(folder, lambda text: text.replace(str(EXAMPLE / "blocks.FCStd"), str(made)))
        with freecad(path) as model, freecad() as kept:
            for value in (74.5, 75.0):
                here, there = (one.point(**{**NOMINAL, "f": value})["y"][0] for one in (model, kept))
                assert abs(here - there) < CLOSE and abs(here - gap(**{**NOMINAL, "f": value})) < CLOSE, (here, there)


def cells_and_properties_are_set_and_read():
    """A box whose sides come from a cell with an alias and from a property, its volume and its faces."""
    script = """
import sys
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part
document = FreeCAD.newDocument("box")
sheet = document.addObject("Spreadsheet::Sheet", "Sizes")
sheet.set("A1", "=20 mm"); sheet.setAlias("A1", "wide")
sheet.set("A2", "=wide * 2"); sheet.setAlias("A2", "twice")
sheet.set("A3", "=1 / (wide - 5 mm)"); sheet.setAlias("A3", "pole")
box = document.addObject("Part::Box", "Box")
box.setExpression("Length", "Sizes.wide")
other = document.addObject("Part::Box", "Other")
document.recompute()
document.saveAs(sys.argv[1])
"""
    declaration = """
document = "box.FCStd"
restore = ["Other.Placement"]
[dimensions]
wide = { cell = "Sizes.wide" }
high = { property = "Box.Height" }
inch = { property = "Box.Width", unit = "in" }
away = { property = "Other.Placement.Base.x" }
[characteristics]
twice = "Sizes.twice"
length = { property = "Box.Length" }
volume = { property = "Box.Shape.Volume" }
gap = { from = "Box.Face2", to = "Other.Face1", along = "Box.Face2" }
pole = { cell = "Sizes.pole" }
""".replace('twice = "Sizes.twice"', 'twice = { cell = "Sizes.twice" }')
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["/usr/bin/python3", "-c", script, f"{folder}/box.FCStd"], check=True, capture_output=True)
        path = pathlib.Path(folder) / "box.toml"
        path.write_text(declaration)
        nominal = {"wide": 20.0, "high": 10.0, "inch": 1.0, "away": 30.0}
        names = ["twice", "length", "volume", "gap", "pole"]
        with client(["python3", ADAPTER, path], folder, ["mm", "mm", "in", "mm"], nominal, names) as model:
            # 2 m is shown in other words than 20 mm.
            for wide, away in ((20.0, 30.0), (2000.0, 5.0), (7.0, 5.0), (20.0, 30.0)):
                answer = model.point(wide=wide, high=3.0, inch=1.0, away=away)["y"]
                expected = [2 * wide, wide, wide * 3 * 25.4, away - wide, 1 / (wide - 5)]
                # Faces are located by FreeCAD's integration of their area.
                assert all(abs(a - b) < 1e-9 * max(1, abs(b)) for a, b in zip(answer, expected)), (answer, expected)
            answer = model.point(wide=5.0, high=3.0, inch=1.0, away=30.0)
            failed(answer)
            assert model.point(wide=20.0, high=3.0, inch=1.0, away=30.0)["y"][0] == 40.0


def bracket(a=60.0, b=30.0, t=10.0, r=4.0, depth=6.0, height=5.0):
    """Volume of a plate with a row of three blind holes, and that of a ring from radius 20 to 23."""
    return a * b * t - 3 * math.pi * r * r * depth, math.pi * (23.0**2 - 20.0**2) * height


BRACKET = {"a": 60.0, "b": 30.0, "t": 10.0, "r": 4.0, "depth": 6.0, "span": 30.0, "height": 5.0}
DECLARED = """
document = "bracket.FCStd"
[dimensions]
a = "Outline.Constraints[10]"
b = { constraint = "Outline.Constraints[11]" }
t = { property = "Pad.Length" }
r = { constraint = "Hole.Constraints[0]" }
depth = { property = "Pocket.Length" }
span = { property = "LinearPattern.Length" }
height = { constraint = "Profile.Constraints[11]" }
[characteristics]
plate = { property = "Plate.Shape.Volume" }
ring = { property = "Ring.Shape.Volume" }
wall = { from = "Plate.Face1", to = "Plate.Face6", along = [0, 1, 0] }
last = { from = "Plate.Face7", to = "Plate.Face9", along = [1, 0, 0] }
"""


def part_design(folder):
    """A PartDesign document that FreeCAD makes: pad, pocket, pattern and revolution, no constraint with a name."""
    path = pathlib.Path(folder) / "bracket.FCStd"
    maker = pathlib.Path(__file__).with_name("freecad_bracket.py")
    subprocess.run(["/usr/bin/python3", maker, path], check=True, capture_output=True)
    return path


def part_design_documents_open():
    names = ["plate", "ring", "wall", "last"]
    with tempfile.TemporaryDirectory() as folder:
        part_design(folder)
        path = pathlib.Path(folder) / "bracket.toml"
        path.write_text(DECLARED)
        chance = random.Random(11)
        points = [{key: value * (1 + 0.1 * chance.uniform(-1, 1)) for key, value in BRACKET.items()} for _ in range(8)]
        with client(["python3", ADAPTER, path], folder, ["mm"] * 7, BRACKET, names) as model:
            for point in [BRACKET, *points, *points[::-1], BRACKET]:
                answer = model.point(**point)
                assert "y" in answer, answer
                sizes = {key: value for key, value in point.items() if key != "span"}
                expected = [*bracket(**sizes), point["b"], point["span"]]
                # OpenCASCADE integrates planes and cylinders exactly; 1e-9 is the rounding of its sums, with room.
                for found, right in zip(answer["y"], expected):
                    assert abs(found - right) < 1e-9 * abs(right), (names, answer, expected)
            # FreeCAD makes no pad without height; the next point is not spoilt by it.
            failed(model.point(**{**BRACKET, "t": 0.0}), "Pad")
            assert abs(model.point(**BRACKET)["y"][0] - bracket()[0]) < 1e-9 * bracket()[0]


def what_freecad_drops_is_named():
    with tempfile.TemporaryDirectory() as folder:
        path = part_design(folder)
        (pathlib.Path(folder) / "bracket.toml").write_text(DECLARED)
        changes = [
            (b'type="PartDesign::Pocket"', b'type="NoSuchBench::Pocket"', ["drops 1 of 23", "`Pocket` (NoSuchBench::Pocket)"]),
            (b'type="PartDesign::', b'type="NoSuchBench::', ["drops 6 of 23", "`Plate` (NoSuchBench::Body)", "`Revolution`"]),
        ]
        with zipfile.ZipFile(path) as archive:
            files = {name: archive.read(name) for name in archive.namelist()}
        for before, after, words in changes:
            with zipfile.ZipFile(path, "w") as archive:
                for name, content in files.items():
                    archive.writestr(name, content.replace(before, after) if name == "Document.xml" else content)
            with client(["python3", ADAPTER, "bracket.toml"], folder, ["mm"] * 7, BRACKET, ["plate"]) as model:
                refused(model, "bracket.FCStd", *words)


def listed(path):
    done = subprocess.run(["python3", ADAPTER, "--list", path], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def a_list_is_a_ready_declaration():
    with tempfile.TemporaryDirectory() as folder:
        code, text, errors = listed(part_design(folder))
        assert code == 0, errors
        for words in [
            'Outline_10 = { constraint = "Outline.Constraints[10]" }  # DistanceX 60 mm',
            'Pad_Length = { property = "Pad.Length" }  # 10.00 mm',
            "# Plate.Face5: Plane, centre (35, 20, 10), area 1800 mm^2",
        ]:
            assert words in text, f"{words!r} is not in\n{text}"
        path = pathlib.Path(folder) / "listed.toml"
        path.write_text(text)
        # Every entry that it lists can be asked for; the values beside them are those of the document.
        values = dict(re.findall(r"^(\w+) = .*# [A-Za-z]* ?([\d.e+-]+)", text, re.M))
        below = text[text.index("[characteristics]") :]
        names = re.findall(r"^(\w+) = ", below, re.M)
        nominal = {key: float(value) for key, value in values.items() if key not in names}
        assert set(names) == {"Plate_volume", "Ring_volume"} and len(nominal) == 15, (names, nominal)
        units = ["deg" if "Angle" in key else "mm" for key in nominal]
        units = [None if key.endswith(("_Length", "_Angle")) else unit for key, unit in zip(nominal, units)]
        with client(["python3", ADAPTER, path], folder, units, nominal, names) as model:
            answer = model.point(**nominal)["y"]
            assert all(abs(a - b) < 1e-9 * b for a, b in zip(answer, bracket())), answer
        code, text, errors = listed(pathlib.Path(folder) / "missing.FCStd")
        assert code == 1 and "missing.FCStd" in errors and "Traceback" not in errors, errors
        code, text, errors = listed(path)
        assert code == 1 and "listed.toml" in errors and "Traceback" not in errors, errors
    code, text, errors = listed(EXAMPLE / "blocks.FCStd")
    assert code == 0 and 'a = { constraint = "Blocks.a" }  # DistanceX 10 mm' in text, text + errors
    assert 'gap = { constraint = "Blocks.gap" }' in text[text.index("[characteristics]") :], text


def cells_are_listed_by_what_they_are():
    script = """
import sys
sys.path += ["/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib"]
import FreeCAD, Part
document = FreeCAD.newDocument("cells")
sheet = document.addObject("Spreadsheet::Sheet", "Sizes")
sheet.set("A1", "=20 mm"); sheet.setAlias("A1", "wide")
sheet.set("A2", "=wide * 2"); sheet.setAlias("A2", "twice")
sheet.set("B1", "2e3"); sheet.set("B2", "=B1 + 1"); sheet.set("B3", "words")
box = document.addObject("Part::Box", "Box")
box.setExpression("Length", "Sizes.wide")
document.recompute()
document.saveAs(sys.argv[1])
"""
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/cells.FCStd"
        subprocess.run(["/usr/bin/python3", "-c", script, path], check=True, capture_output=True)
        code, text, errors = listed(path)
        assert code == 0, errors
        above, below = text.split("[characteristics]")
        assert '"Sizes.A1" }' in above and '"Sizes.B1" }' in above and '"Box.Width" }' in above, text
        assert '"Sizes.A2" }' in below and '"Sizes.B2" }' in below and "B3" not in text, text
        assert "# Box.Length follows an expression: 20.00 mm" in text, text
        (pathlib.Path(folder) / "cells.toml").write_text(text.replace('"Box.Width"', '"Box.Length"'))
        with client(["python3", ADAPTER, "cells.toml"], folder, ["mm"], {"wide": 20.0}, ["twice"]) as model:
            refused(model, "Box.Length follows an expression")


def what_is_declared_wrongly_is_said_once():
    faults = [
        (lambda t: t.replace('"Blocks.a"', '"Blocks.A1"'), ["`a`", "A1", "there are"]),
        (lambda t: t.replace('"Blocks.a"', '"Blocks.Constraints[0]"'), ["`a`", "Vertical", "no value", "a (DistanceX 10 mm)"]),
        (lambda t: t.replace('"Blocks.a"', '"Blocks.Constraints[99]"'), ["`a`", "Constraints[99]", "there are"]),
        (lambda t: t.replace('"Blocks.a"', '"Sketch7.a"'), ["Sketch7", "Blocks"]),
        (lambda t: t.replace("a  = { constraint", "a  = { constrain"), ["constrain", "did you mean `constraint`"]),
        (lambda t: t.replace('{ constraint = "Blocks.a" }', '{ constraint = "Blocks.gap" }'), ["`a`", "reference"]),
        (lambda t: t.replace("Geometry[6]", "Geometry[66]"), ["`gap`", "Geometry[66]"]),
        (lambda t: t.replace("blocks.FCStd", "missing.FCStd"), ["no document", "missing.FCStd"]),
        (lambda t: t.replace("along = [0, 1] }\n# The", "along = [0, 0] }\n# The"), ["`gap`", "along"]),
        (lambda t: t + "[", ["blocks.toml", "nvalid"]),
    ]
    with tempfile.TemporaryDirectory() as folder:
        for change, words in faults:
            with freecad(copy(folder, change)) as model:
                refused(model, *words)
    with freecad(units=["in"] + UNITS[1:]) as model:
        refused(model, "`a` is in `in` in the study and in `mm` here")
    with freecad(characteristics=["flush"]) as model:
        refused(model, "`flush`", "gap, drawn")


def the_readme_shows_it():
    shown("stacked-blocks-freecad")


if __name__ == "__main__":
    run([
        it_passes_the_probe,
        every_point_is_that_of_the_formula,
        the_order_does_not_matter,
        the_moments_are_the_published_ones,
        interference_is_negative,
        an_absurd_point_is_an_error_of_its_own,
        a_mirrored_assembly_is_an_error,
        without_the_reset_the_engine_notices,
        the_script_makes_the_document,
        cells_and_properties_are_set_and_read,
        part_design_documents_open,
        what_freecad_drops_is_named,
        a_list_is_a_ready_declaration,
        cells_are_listed_by_what_they_are,
        what_is_declared_wrongly_is_said_once,
        the_readme_shows_it,
    ])  # fmt: skip
