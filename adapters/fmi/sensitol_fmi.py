"""An FMU as a model: `python3 sensitol_fmi.py MODEL.fmu` or `... DECLARATION.toml`, see README.md.

FMI 2 and 3, co-simulation and model exchange, by FMPy. `--list MODEL.fmu` prints a declaration of what it has.
"""

import atexit
import difflib
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))

from sensitol_adapter import Adapter, Declaration, NoValue, load
from trajectory import HOW, functional

VERSION = "1"
INSTALL = "pip install fmpy"
KEYS = ("document", "name", "version", "kind", "start", "stop", "step", "solver", "tolerance", "values", "dimensions", "characteristics")
KINDS = {"model-exchange": "ModelExchange", "co-simulation": "CoSimulation"}
SOLVERS = ("CVode", "Euler")
# The solver's relative tolerance is the noise of the answers: far below the steps that methods take.
TOLERANCE = 1e-9
# Output points of a simulation whose step is not stated.
POINTS = 1000
REAL = ("Real", "Float64", "Float32")


class Declared:
    """What the command line says: a declaration, or an FMU whose parameters and outputs say it all."""

    def __init__(self, path):
        path = pathlib.Path(path)
        self.table, self.dimensions, self.characteristics = {}, None, None
        self.path = path
        if path.suffix in (".toml", ".json"):
            declaration = Declaration(path, KEYS)
            self.table, self.document = declaration.table, declaration.document
            if "dimensions" in self.table:
                section = declaration.section("dimensions", ("variable",))
                self.dimensions = {name: self._text(declaration, name, one) for name, one in section.items()}
            if "characteristics" in self.table:
                section = declaration.section("characteristics", ("variable", "value", "level", "direction"))
                self.characteristics = {name: self._functional(declaration, name, one) for name, one in section.items()}
        elif not path.is_file():
            raise ValueError(f"there is no FMU {path}")
        else:
            self.document = path
        for key in ("start", "stop", "step", "tolerance"):
            value = self.table.get(key)
            if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float))):
                raise ValueError(f"{path}: `{key}` must be a number")
            if key in ("step", "tolerance") and value is not None and value <= 0:
                raise ValueError(f"{path}: `{key}` must be positive, got {value}")
        for key, known in (("kind", tuple(KINDS)), ("solver", SOLVERS)):
            if self.table.get(key, known[0]) not in known:
                raise ValueError(f"{path}: `{key}` must be one of {', '.join(known)}, got `{self.table[key]}`")

    @staticmethod
    def _text(declaration, name, entry):
        if not isinstance(entry.get("variable"), str):
            raise declaration.fault(name, "`variable` is missing: the name in the FMU")
        return entry["variable"]

    def _functional(self, declaration, name, entry):
        variable, value = self._text(declaration, name, entry), entry.get("value", "final")
        if value not in HOW:
            raise declaration.fault(name, f"`value` must be one of {', '.join(HOW)}, got `{value}`")
        if (value == "crossing") != ("level" in entry):
            raise declaration.fault(name, "`level` belongs to `value = \"crossing\"`, which needs it")
        if entry.get("direction", "any") not in ("up", "down", "any"):
            raise declaration.fault(name, "`direction` must be up, down or any")
        return variable, value, entry.get("level"), entry.get("direction", "any")


def _kinds(description):
    """What the FMU offers; model exchange first, whose solver has a tolerance that can be stated."""
    offered = {"model-exchange": description.modelExchange, "co-simulation": description.coSimulation}
    return [kind for kind, found in offered.items() if found]


class Fmu:
    """One instance, reset before every simulation; a new one after an error, or where it cannot be reset."""

    def __init__(self, declared):
        self.declared, table = declared, declared.table
        self.fmpy = load("fmpy", places=[], install=INSTALL)
        try:
            self.folder = self.fmpy.extract(str(declared.document))
            atexit.register(shutil.rmtree, self.folder, ignore_errors=True)
            self.description = self.fmpy.read_model_description(self.folder)
        except Exception as error:
            raise ValueError(f"{declared.document} cannot be read as an FMU: {error}") from None
        version = self.description.fmiVersion
        if not version.startswith(("2.", "3.")):
            raise ValueError(f"{declared.document} is of FMI {version}; this adapter takes FMI 2 and 3")
        self.offered = offered = _kinds(self.description)
        kind = table.get("kind", offered[0] if offered else None)
        if kind not in offered:
            raise ValueError(f"{declared.document} offers {', '.join(offered) or 'neither co-simulation nor model exchange'}, not {kind}")
        self.kind = KINDS[kind]
        self.variables = {one.name: one for one in self.description.modelVariables}
        experiment = self.description.defaultExperiment
        of = lambda key, fallback: float(table.get(key, getattr(experiment, f"{key}Time", None) or fallback))
        self.start = of("start", 0.0)
        self.stop = of("stop", self.start + 1.0)
        if self.stop <= self.start:
            raise ValueError(f"{declared.path}: `stop` must be after `start`: {self.stop} and {self.start}")
        step = table.get("step") or getattr(experiment, "stepSize", None) or (self.stop - self.start) / POINTS
        self.step = float(step)
        self.tolerance = float(table.get("tolerance", TOLERANCE))
        self.instance = None
        self._choose()

    def _choose(self):
        """Which variables are dimensions and characteristics: those declared, or all parameters and outputs."""
        declared = self.declared
        real = lambda one: one.type in REAL and not one.dimensions
        given = declared.dimensions
        if given is None:
            given = {name: name for name, one in self.variables.items() if real(one) and one.causality == "parameter"}
        found = declared.characteristics
        if found is None:
            found = {name: (name, "final", None, "any") for name, one in self.variables.items() if real(one) and one.causality == "output"}
        for name, variable in [*given.items(), *((name, one[0]) for name, one in found.items())]:
            if variable not in self.variables:
                raise ValueError(f"{declared.path}: `{name}`: {self._unknown(variable)}")
            if not real(self.variables[variable]):
                raise ValueError(f"{declared.path}: `{name}`: `{variable}` is not one real number")
        for name, variable in given.items():
            self._settable(name, self.variables[variable])
        self.values = declared.table.get("values", {})
        for name in self.values:
            if name not in self.variables:
                raise ValueError(f"{declared.path}: [values]: {self._unknown(name)}")
        self.dimensions, self.characteristics = given, found
        # One that is computed from others, or an output, has its unit too.
        self.units = {name: unit for name, variable in given.items() if (unit := self.unit(variable))}

    def _unknown(self, name):
        near = difflib.get_close_matches(name, self.variables, n=1)
        hint = f"did you mean `{near[0]}`?" if near else f"--list {self.declared.document.name} shows them"
        return f"the FMU has no variable `{name}`; {hint}"

    def _settable(self, name, variable):
        start = variable.initial in ("exact", "approx") and variable.variability != "constant"
        if not (variable.causality in ("parameter", "input") or start):
            raise ValueError(
                f"{self.declared.path}: `{name}`: `{variable.name}` cannot be set before initialisation: its causality is "
                f"{variable.causality}, its variability {variable.variability}"
            )

    def unit(self, name):
        """The unit in the FMU's description, where it states one."""
        variable = self.variables[name]
        return variable.unit or (variable.declaredType.unit if variable.declaredType is not None else None)

    def simulate(self, **given):
        """The characteristics at a point."""
        values = {**self.values, **{self.dimensions[name]: value for name, value in given.items()}}
        variables = list(dict.fromkeys(one[0] for one in self.characteristics.values()))
        fresh = self.instance is None
        try:
            if fresh:
                self.instance = self.fmpy.instantiate_fmu(self.folder, self.description, self.kind)
            else:
                self.instance.reset()
            result = self.fmpy.simulate_fmu(
                self.folder, validate=False, start_time=self.start, stop_time=self.stop, output_interval=self.step,
                step_size=self.step, solver=self.declared.table.get("solver", "CVode"), relative_tolerance=self.tolerance,
                fmi_type=self.kind, start_values=values, output=variables, model_description=self.description,
                fmu_instance=self.instance,
            )  # fmt: skip
        except Exception as error:
            self._forget()
            raise NoValue(f"the FMU does not simulate: {' '.join(str(error).split()) or type(error).__name__}") from None
        time = result["time"]
        if time[-1] < self.stop - 1e-9 * max(abs(self.stop), self.step):
            self._forget()
            raise NoValue(f"the FMU ended its simulation at {time[-1]:.6g}, before {self.stop:.6g}")
        return {name: functional(time, result[one[0]], *one[1:]) for name, one in self.characteristics.items()}

    def _forget(self):
        instance, self.instance = self.instance, None
        if instance is not None:
            try:
                instance.freeInstance()
            except Exception:
                # It is broken already; what matters is that the next point has another one.
                pass


def show(arguments):
    """Prints a declaration of everything that the FMU has."""
    if len(arguments) != 1:
        raise SystemExit("error: --list needs one FMU")
    try:
        fmu = Fmu(Declared(arguments[0]))
    except ValueError as error:
        raise SystemExit(f"error: {error}") from None
    description = fmu.description
    kinds = fmu.offered
    lines = [
        f'document = "{pathlib.Path(arguments[0]).name}"   # {description.modelName}, FMI {description.fmiVersion}',
        f'kind = "{kinds[0]}"{f"   # or {kinds[1]}" if len(kinds) > 1 else ""}',
        f"start = {fmu.start}\nstop = {fmu.stop}\nstep = {fmu.step}\ntolerance = {fmu.tolerance}",
    ]
    for title, names in (("dimensions", fmu.dimensions), ("characteristics", fmu.characteristics)):
        lines.append(f"[{title}]")
        for name in names:
            variable, unit = fmu.variables[name], fmu.unit(name)
            start = f" = {variable.start}" if variable.start is not None and title == "dimensions" else ""
            about = " ".join(filter(None, [f"{start.strip()} {unit or ''}".strip(), variable.description]))
            key = name if name.replace("_", "").replace("-", "").isalnum() and name.isascii() else f'"{name}"'
            lines.append(f'{key} = "{name}"' + (f"   # {about}" if about else ""))
    print("\n".join(lines))


def main():
    """Everything is read in `setup`, so that every fault reaches the engine as one line."""

    def setup():
        if len(sys.argv) != 2:
            raise ValueError(f"the command needs one argument, an FMU or a declaration; it has {len(sys.argv) - 1}")
        fmu = Fmu(Declared(sys.argv[1]))
        fmus.append(fmu)
        table = fmu.declared.table
        adapter.name = table.get("name", fmu.declared.document.name)
        own = table.get("version", fmu.description.version or "1")
        adapter.version = f"{VERSION}; {own}; {fmu.description.guid}; FMPy {fmu.fmpy.__version__}"
        adapter.inputs, adapter.outputs, adapter.units = list(fmu.dimensions), list(fmu.characteristics), fmu.units

    fmus = []
    adapter = Adapter(lambda **values: fmus[0].simulate(**values), name="FMU", window=8, setup=setup)
    adapter.serve()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--list"]:
        show(sys.argv[2:])
    else:
        main()
