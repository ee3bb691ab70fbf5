"""adapters/opencascade against closed form: the spot-welding gun, whose chain of rotations is planar in each arm."""

import math
import pathlib
import os
import random
import subprocess
import tempfile

from harness import EXAMPLES, ROOT, client, failed, journal, refused, report, run, sensitol, shown

EXAMPLE = EXAMPLES / "spot-weld-opencascade"
STUDY = EXAMPLE / "study.toml"
ARM = {"x": 0.0, "y": 0.0, "z": 150.0, "tilt_x": 0.0, "tilt_z": 0.0, "swing": 0.0, "inner": 300.0, "bend": 30.0, "outer": 200.0, "electrode": 45.0}  # fmt: skip
NOMINAL = {f"{side}_{name}": value for side in ("upper", "lower") for name, value in ARM.items()}
NOMINAL["lower_z"] = -150.0
UNITS = ["deg" if "tilt" in name or "swing" in name or "bend" in name else "mm" for name in NOMINAL]
NAMES = ["gap", "flush_x", "flush_y"]
# mm, at lengths of 500: a dozen transformations, and the kernel's integration over a face.
CLOSE = 1e-9


def closed(**d):
    """Gap and flushes: each arm lies in a plane that is tilted about x and then about z."""

    def arm(side, name):
        angle = {key: math.radians(d[f"{name}_{key}"]) for key in ("tilt_x", "tilt_z", "swing", "bend")}
        first = side * angle["swing"]
        second = first + side * angle["bend"]
        last = second - side * math.radians(30)

        def out(x, y, z):
            y, z = y * math.cos(angle["tilt_x"]) - z * math.sin(angle["tilt_x"]), y * math.sin(angle["tilt_x"]) + z * math.cos(angle["tilt_x"])
            return x * math.cos(angle["tilt_z"]) - y * math.sin(angle["tilt_z"]), x * math.sin(angle["tilt_z"]) + y * math.cos(angle["tilt_z"]), z

        inner, outer, rod = (d[f"{name}_{key}"] for key in ("inner", "outer", "electrode"))
        x = inner * math.cos(first) + outer * math.cos(second) - side * rod * math.sin(last)
        z = -inner * math.sin(first) - outer * math.sin(second) - side * rod * math.cos(last)
        tip = [a + d[f"{name}_{key}"] for a, key in zip(out(x, 0.0, z), "xyz")]
        axes = out(math.sin(last), 0, math.cos(last)), out(math.cos(last), 0, -math.sin(last)), out(0, 1, 0)
        return tip, axes

    end, _ = arm(1, "upper")
    start, axes = arm(-1, "lower")
    return [sum((b - a) * c for a, b, c in zip(start, end, axis)) for axis in axes]


def gun(names=NAMES, units=UNITS):
    return client(["python3", "gun.py"], EXAMPLE, units, NOMINAL, names)


def it_passes_the_probe():
    sensitol("probe", STUDY)


def every_point_is_that_of_the_closed_form():
    with tempfile.TemporaryDirectory() as folder:
        for command in (["analyze", STUDY], ["simulate", STUDY, "--samples", "200"]):
            kept = pathlib.Path(folder) / f"{command[0]}.sqlite"
            sensitol(*command, "--journal", kept)
            rows = journal(kept)
            assert len(rows) >= 41
            for row in rows:
                expected = closed(**{name: row[name] for name in NOMINAL})
                worst = max(abs(row[name] - value) for name, value in zip(NAMES, expected))
                assert worst < CLOSE, (worst, row)


def far_points_too():
    chance = random.Random(11)
    with gun() as model:
        assert max(abs(a - b) for a, b in zip(model.point(**NOMINAL)["y"], (10.0, 0.0, 0.0))) < CLOSE
        for _ in range(40):
            point = {
                name: value + chance.uniform(-1, 1) * (20.0 if unit == "mm" else 15.0)
                for (name, value), unit in zip(NOMINAL.items(), UNITS)
            }
            answer = model.point(**point)
            assert max(abs(a - b) for a, b in zip(answer["y"], closed(**point))) < CLOSE, (point, answer)


def interference_is_a_negative_gap():
    with gun() as model:
        for electrode in (49.0, 51.0, 60.0):
            point = {**NOMINAL, "upper_electrode": electrode, "lower_electrode": electrode}
            gap = model.point(**point)["y"][0]
            assert abs(gap - (100.0 - 2 * electrode)) < CLOSE, gap
    # The kernel's least distance of the same two electrodes says 0.
    script = """
from sensitol_opencascade import *
from gun import arm
arms = [arm(side, 0, 0, 150 * side, 0, 0, 0, 300, 30, 200, 60) for side in (1, -1)]
rods = [solids[2] for solids, _, _ in arms]
assert rods[0].distance_to(rods[1]) == 0 and (rods[0] & rods[1]).volume > 1000
"""
    subprocess.run(["python3", "-c", script], cwd=EXAMPLE, check=True, env={**os.environ, "PYTHONPATH": str(ROOT / "adapters/opencascade")})


def a_pin_that_binds_has_negative_play():
    script = """
from sensitol_opencascade import *
plate = b3d.Box(40, 40, 10) - b3d.Cylinder(5, 10)
pin = b3d.Pos(0.2, 0, 3) * b3d.Cylinder(4.9, 30)
round = lambda solid: one(solid.faces().filter_by(b3d.GeomType.CYLINDER), "a round face")
assert abs(play(round(plate), round(pin)) + 0.1) < 1e-9, play(round(plate), round(pin))
assert abs(play(round(plate), round(b3d.Pos(0, 0.05, 0) * b3d.Cylinder(4.9, 30))) - 0.05) < 1e-9
try:
    normal(round(pin))
except NoValue as error:
    assert "cylinder" in str(error)
else:
    raise AssertionError
try:
    one(plate.faces(), "a face")
except NoValue as error:
    assert "7 of a face" in str(error)
else:
    raise AssertionError
"""
    subprocess.run(["python3", "-c", script], check=True, env={**os.environ, "PYTHONPATH": str(ROOT / "adapters/opencascade")})


def what_the_kernel_refuses_is_an_error_of_its_point():
    with gun() as model:
        right = model.point(**NOMINAL)["y"]
        for absurd in ({"upper_inner": 0.0}, {"lower_electrode": -3.0}):
            failed(model.point(**{**NOMINAL, **absurd}))
            assert model.point(**NOMINAL)["y"] == right
    with gun(names=["flush"]) as model:
        refused(model, "`flush`", "flush_x")


def the_report_is_that_of_the_closed_form():
    found = report("analyze", STUDY, "--method", "rss", "--journal", "none")[0]["characteristics"]
    for one, index in zip(found, range(3)):
        for sensitivity in one["sensitivities"]:
            name, step = sensitivity["dimension"], 1e-4
            low, high = (closed(**{**NOMINAL, name: NOMINAL[name] + sign * step})[index] for sign in (-1, 1))
            # The report's difference spans a sigma or so; third derivatives of a degree are below 1e-5 of the slope.
            assert abs(sensitivity["first"] - (high - low) / 2 / step) < 1e-3, (one["name"], name, sensitivity)


def the_readme_shows_it():
    shown("spot-weld-opencascade")


if __name__ == "__main__":
    run([
        it_passes_the_probe,
        every_point_is_that_of_the_closed_form,
        far_points_too,
        interference_is_a_negative_gap,
        a_pin_that_binds_has_negative_play,
        what_the_kernel_refuses_is_an_error_of_its_point,
        the_report_is_that_of_the_closed_form,
        the_readme_shows_it,
    ])  # fmt: skip
