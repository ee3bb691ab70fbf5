"""adapters/fmi against closed form: a damped oscillator in C, built as FMI 2 and 3, and a decay by PythonFMU."""

import contextlib
import math
import pathlib
import random
import subprocess
import sys
import tempfile

from harness import EXAMPLES, ROOT, client, failed, journal, refused, run, sensitol, shown

ADAPTER = ROOT / "adapters/fmi/sensitol_fmi.py"
EXAMPLE = EXAMPLES / "oscillator-fmi"
STUDY = EXAMPLE / "study.toml"
NOMINAL = {"mass": 2.0, "damping": 1.5, "stiffness": 800.0, "release": 10.0}
UNITS = ["kg", "N.s/m", "N/m", "mm"]
NAMES = ["overshoot", "passage", "rest", "average", "back"]
STOP = 1.0
# Relative to amplitudes of 10 and times of 1. The solver's tolerance of 1e-10 grows over some 1000 steps; the parabola and the cubic
# through samples 0.002 s apart leave (omega h)^4 / 100 = 3e-8 of the amplitude, the trapezoids of a mean (omega h)^2 / 12 = 1.3e-4.
CLOSE = {"overshoot": 1e-6, "passage": 1e-8, "rest": 1e-6, "average": 2e-3, "back": 1e-7}


def make(path, version=2):
    subprocess.run([sys.executable, EXAMPLE / "make.py", path, str(version)], check=True, capture_output=True)


def closed(mass, damping, stiffness, release):
    """x = x0 exp(-z w t) (cos d t + z w/d sin d t): its first minimum, first and second zero, end and mean."""
    w = math.sqrt(stiffness / mass)
    z = damping / (2 * math.sqrt(stiffness * mass))
    d = w * math.sqrt(1 - z * z)
    fading = math.exp(-z * w * STOP)
    end = release * fading * (math.cos(d * STOP) + z * w / d * math.sin(d * STOP))
    speed = -release * fading * w * w / d * math.sin(d * STOP)
    first = (math.pi - math.acos(z)) / d
    # The integral of the equation of motion gives that of x.
    mean = -(mass * speed + damping * (end - release)) / stiffness / STOP
    return {
        "overshoot": -release * math.exp(-z * w * math.pi / d), "passage": first, "rest": end, "average": mean,
        "back": first + math.pi / d,
    }  # fmt: skip


def declared(folder, **keys):
    text = (EXAMPLE / "oscillator.toml").read_text()
    text += 'average = { variable = "x", value = "mean" }\n'
    text += 'back = { variable = "x", value = "crossing", level = 0.0, direction = "up" }\n'
    for key, value in keys.items():
        text = "\n".join(f"{key} = {value}" if line.startswith(f"{key} =") else line for line in text.splitlines()) + "\n"
    path = pathlib.Path(folder) / "oscillator.toml"
    path.write_text(text)
    return path


@contextlib.contextmanager
def oscillator(version=2, names=NAMES, units=UNITS, nominal=NOMINAL, **keys):
    with tempfile.TemporaryDirectory() as folder:
        make(f"{folder}/oscillator.fmu", version)
        with client([sys.executable, ADAPTER, declared(folder, **keys)], folder, units, nominal, list(names)) as model:
            yield model


def check(answer, point):
    right = closed(**point)
    for name, value in zip(NAMES, answer["y"]):
        assert abs(value - right[name]) < CLOSE[name] * max(1.0, abs(right[name])), (name, value, right[name], point)


def every_kind_is_that_of_the_closed_form():
    for version in (2, 3):
        for kind in ("model-exchange", "co-simulation"):
            chance = random.Random(4)
            with oscillator(version, kind=f'"{kind}"') as model:
                for _ in range(12):
                    point = {name: value * (1 + 0.2 * chance.uniform(-1, 1)) for name, value in NOMINAL.items()}
                    check(model.point(**point), point)


def the_analysis_is_that_of_the_closed_form():
    sensitol("probe", STUDY)
    with tempfile.TemporaryDirectory() as folder:
        kept = pathlib.Path(folder) / "kept.sqlite"
        sensitol("analyze", STUDY, "--journal", kept)
        rows = journal(kept)
        assert len(rows) >= 21
        for row in rows:
            check({"y": [row[name] for name in NAMES[:3]]}, {name: row[name] for name in NOMINAL})


def one_instance_is_reset_and_replaced_after_an_error():
    with oscillator() as model:
        right = model.point(**NOMINAL)["y"]
        for wrong in ({"mass": -1.0}, {"mass": 0.0}):
            failed(model.point(**{**NOMINAL, **wrong}), "does not simulate")
            assert model.point(**NOMINAL)["y"] == right
        other = {**NOMINAL, "mass": 2.5, "release": 9.0}
        first = model.point(**other)["y"]
        assert model.point(**NOMINAL)["y"] == right and model.point(**other)["y"] == first


def an_overdamped_one_never_passes():
    with oscillator() as model:
        answer = model.point(**{**NOMINAL, "damping": 120.0})
        assert answer["y"][1] is None and answer["errors"]["passage"], answer
        assert answer["y"][2] is not None, answer


def dimensions_that_the_study_leaves_out_keep_their_start():
    with oscillator(nominal={"mass": 2.0}, units=["kg"]) as model:
        answer = model.point(mass=2.1)
        check(answer, {**NOMINAL, "mass": 2.1})


def a_plain_fmu_offers_parameters_and_outputs():
    with tempfile.TemporaryDirectory() as folder:
        make(f"{folder}/plain.fmu", 3)
        nominal = {"m": 2.0, "c": 1.5, "k": 800.0, "x0": 10.0}
        with client([sys.executable, ADAPTER, "plain.fmu"], folder, UNITS, nominal, ["x"]) as model:
            found = model.point(**nominal)["y"][0]
            # The default is model exchange with a tolerance of 1e-9.
            assert abs(found - closed(**NOMINAL)["rest"]) < 1e-5, found


DECAY = '''
import math
from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

class Decay(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.rate = 2.0
        self.level = 3.0
        self.amount = 3.0
        self.register_variable(Real("rate", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.register_variable(Real("level", causality=Fmi2Causality.parameter, variability=Fmi2Variability.tunable))
        self.register_variable(Real("amount", causality=Fmi2Causality.output))

    def exit_initialization_mode(self):
        self.amount = self.level

    def do_step(self, current_time, step_size):
        if self.rate > 100:
            raise RuntimeError("too fast")
        self.amount *= math.exp(-self.rate * step_size)
        return True
'''


def a_slave_in_python_is_that_of_the_closed_form():
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "decay.py").write_text(DECAY)
        build = [sys.executable, "-m", "pythonfmu", "build", "-f", "decay.py", "-d", "."]
        subprocess.run(build, cwd=folder, check=True, capture_output=True)
        (path / "decay.toml").write_text(
            'document = "Decay.fmu"\nstop = 2.0\nstep = 0.01\n[dimensions]\nrate = "rate"\nlevel = "level"\n'
            '[characteristics]\nend = "amount"\nhalf = { variable = "amount", value = "crossing", level = 1.5 }\n'
            'top = { variable = "amount", value = "max" }\n'
        )
        chance = random.Random(8)
        with client([sys.executable, ADAPTER, "decay.toml"], folder, [None, None], {"rate": 2.0, "level": 3.0}, ["end", "half", "top"]) as model:
            for _ in range(10):
                rate, level = 2.0 + chance.uniform(-1, 1), 3.0 + chance.uniform(-1, 1)
                end, half, top = model.point(rate=rate, level=level)["y"]
                # 200 products; a cubic through samples of an exponential 0.01 apart leaves (0.03)^4 / 100 of it.
                assert abs(end - level * math.exp(-2 * rate)) < 1e-13, (end, rate, level)
                assert abs(half - math.log(level / 1.5) / rate) < 1e-8 and top == level, (half, top, rate, level)
            failed(model.point(rate=200.0, level=3.0), "does not simulate")
            assert abs(model.point(rate=2.0, level=3.0)["y"][0] - 3 * math.exp(-4)) < 1e-13


def what_is_declared_wrongly_is_one_error():
    for words, options in [
        (["`kind`", "model-exchange", "`magic`"], {"kind": '"magic"'}),
        (["`step` must be positive", "-1"], {"step": "-1"}),
        (["`stop` must be after `start`"], {"stop": "0.0"}),
        (["`mass`", "no variable `mm`"], {"mass": '"mm"'}),
        (["`mass`", "cannot be set", "output"], {"mass": '"x"'}),
        (["`passage`", "`level`"], {"passage": '{ variable = "x", value = "crossing" }'}),
        (["`rest`", "final, max", "`last`"], {"rest": '{ variable = "x", value = "last" }'}),
    ]:
        with oscillator(**options) as model:
            refused(model, *words)
    with oscillator(units=["g", *UNITS[1:]]) as model:
        refused(model, "`mass`", "`g`", "`kg`")
    with oscillator(names=["swing"]) as model:
        refused(model, "`swing`", "overshoot")
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "text.fmu").write_text("no zip")
        for name, word in (("text.fmu", "cannot be read as an FMU"), ("nowhere.fmu", "there is no FMU")):
            with client([sys.executable, ADAPTER, name], folder, UNITS, NOMINAL, ["x"]) as model:
                refused(model, name, word)


def a_list_is_a_ready_declaration():
    with tempfile.TemporaryDirectory() as folder:
        make(f"{folder}/oscillator.fmu")
        done = subprocess.run([sys.executable, ADAPTER, "--list", "oscillator.fmu"], cwd=folder, capture_output=True, text=True, check=True)
        for words in ['m = "m"   # = 2.0 kg', 'x = "x"   # mm', "or co-simulation"]:
            assert words in done.stdout, done.stdout
        (pathlib.Path(folder) / "listed.toml").write_text(done.stdout)
        nominal = {"m": 2.0, "c": 1.5, "k": 800.0, "x0": 10.0}
        with client([sys.executable, ADAPTER, "listed.toml"], folder, UNITS, nominal, ["x"]) as model:
            assert abs(model.point(**nominal)["y"][0] - closed(**NOMINAL)["rest"]) < 1e-5
        wrong = subprocess.run([sys.executable, ADAPTER, "--list", "no.fmu"], cwd=folder, capture_output=True, text=True, check=False)
        assert wrong.returncode == 1 and wrong.stderr.startswith("error: there is no FMU"), wrong


def the_readme_shows_it():
    shown("oscillator-fmi")


if __name__ == "__main__":
    make(EXAMPLE / "oscillator.fmu")
    run([
        every_kind_is_that_of_the_closed_form,
        the_analysis_is_that_of_the_closed_form,
        one_instance_is_reset_and_replaced_after_an_error,
        an_overdamped_one_never_passes,
        dimensions_that_the_study_leaves_out_keep_their_start,
        a_plain_fmu_offers_parameters_and_outputs,
        a_slave_in_python_is_that_of_the_closed_form,
        what_is_declared_wrongly_is_one_error,
        a_list_is_a_ready_declaration,
        the_readme_shows_it,
    ])  # fmt: skip
