"""Studies."""

from __future__ import annotations

import json
import os
import sys
import warnings
from typing import TYPE_CHECKING, Any, Callable, Iterable, Mapping, Sequence, TypeVar, Union

from . import _core, _toml
from ._dimension import Characteristic, Dimension, Number, plain, rows
from ._distribution import Distribution
from ._errors import SensitolWarning, StudyError
from ._model import Model
from ._progress import Progress, Shown
from ._records import Record, Result
from ._run_options import Names, Path, RunOptions, names
from ._reports import (
    AllocationResult,
    AnalysisResult,
    ComparisonResult,
    RareResult,
    ReportedWarning,
    SimulationResult,
    SweepResult,
)

if TYPE_CHECKING:
    from typing import Literal

    Interrupt = Literal["raise", "partial"]
    Sampler = Literal["random", "sobol"]
    CostBasis = Literal["tolerance-unit", "constant-precision", "equal-shares"]

__all__ = ["Characteristic", "Dimension", "Study", "read"]

R = TypeVar("R", bound=Result)
# Options that count something, which may be written as 1e5.
_COUNTS = frozenset({"samples", "budget", "seed", "verify"})
#: A function, the name of a built-in model, or a program and its arguments.
ModelLike = Union[Model, Callable[..., Any], str, Sequence[str], Mapping[str, Any], None]
Entries = Mapping[str, Any]


class Study:
    """An assembly: dimensions with tolerances, what is asked of it, and how that follows from the dimensions.

    Parameters
    ----------
    title
        Its subject, in one line.
    dimensions
        A :class:`Dimension` by name.
    characteristics
        A :class:`Characteristic` by name.
    model
        A function of named dimensions (see :func:`sensitol.model`), the name of a built-in model, or a program and its arguments.
    constants, formulas, unknowns, equations, loops, costs, analysis
        The sections of a study file.
    configurations
        Nominal values and constants by name of a configuration: ``{"long": {"bore": 40.0}}``.
    correlation
        The coefficient of correlation by pairs of names: ``{("bore", "shaft"): 0.3}``.
    joint
        Blocks of dimensions that vary together as a whole: ``{"of": ["x", "y"], "law": "disc"}``, or measured parts, one a row:
        ``{"of": ["x", "y"], "measured": array}`` with an array of shape (parts, dimensions) or the name of a CSV file.
    parts, joints
        Rigid parts with features, and their joints in the order of assembly, as in the sections of a study file of these names.
    processes
        Capabilities of processes, by name: ``{"turning": {"cp": 1.33, "cpk": 1.0}}``, or the name of a file with such lines.
    loss, setup, about, units
        The sections of a study file of these names.

    Raises
    ------
    StudyError
        With the key of what is wrong, and what to write instead.
    """

    _core: _core.Study

    def __init__(
        self,
        title: str | None = None,
        *,
        dimensions: Mapping[str, Dimension | Mapping[str, Any]],
        characteristics: Mapping[str, Characteristic | Mapping[str, Any]],
        model: ModelLike = None,
        constants: Entries | None = None,
        formulas: Mapping[str, str] | None = None,
        unknowns: Entries | None = None,
        equations: Mapping[str, str] | None = None,
        loops: Entries | None = None,
        correlation: Mapping[tuple[str, str], Number] | Iterable[Mapping[str, Any]] | None = None,
        costs: Entries | None = None,
        analysis: Entries | None = None,
        configurations: Entries | None = None,
        joint: Iterable[Mapping[str, Any]] | None = None,
        parts: Entries | None = None,
        joints: Entries | None = None,
        processes: Entries | str | None = None,
        loss: Entries | None = None,
        setup: Entries | None = None,
        about: Entries | None = None,
        units: str | None = None,
    ) -> None:
        if title is not None and not isinstance(title, str):
            raise TypeError(f"the title must be text, got {type(title).__name__}")
        files: dict[str, bytes] = {}
        data: dict[str, Any] = {"title": title}
        data["dimensions"] = _entries(dimensions, "dimensions", Dimension, files)
        data["constants"] = constants
        data["formulas"] = formulas
        data["unknowns"], data["equations"], data["loops"] = unknowns, equations, loops
        data["parts"], data["joints"] = parts, joints
        data["characteristics"] = _entries(characteristics, "characteristics", Characteristic, files)
        data["correlation"] = _correlation(correlation)
        data["joint"] = _joint(joint, files)
        data["processes"] = processes
        data["costs"], data["loss"], data["setup"] = costs, loss, setup
        data["about"], data["units"] = about, units
        host: Model | None = None
        if isinstance(model, str):
            data["model"] = {"builtin": model}
        elif isinstance(model, Mapping):
            data["model"] = model
        elif callable(model):
            host = _host(model)
        elif model is not None:
            data["model"] = {"command": [str(word) for word in model]}
        data["analysis"] = analysis
        data["configurations"] = configurations
        kept = {key: value for key, value in data.items() if value}
        # They are asked for even where they are empty: the engine says what belongs there.
        kept.setdefault("dimensions", {})
        kept.setdefault("characteristics", {})
        text = json.dumps(plain(kept, ""), ensure_ascii=False)
        _on_disk(kept, ".", files)
        self._set(text, False, "study", ".", files, True, host, None)

    def _set(
        self,
        text: str,
        toml: bool,
        name: str,
        folder: Path,
        files: dict[str, bytes],
        made: bool,
        model: Model | None,
        configuration: str | None,
    ) -> None:
        if configuration is not None and not isinstance(configuration, str):
            raise TypeError(f"a configuration is named by text, got {type(configuration).__name__}")
        self._state = (text, toml, name, os.fspath(folder), files, made)
        self._configuration = configuration
        self._model = model
        self._core = _core.Study.from_text(text, toml, name, folder, files, made, _hosted(model), configuration)
        self._about: dict[str, Any] = json.loads(self._core.described)
        if model is not None and self._about["model"] is not None:
            # A model that does not fit is reported before anything is evaluated.
            from ._evaluate import Answer, Call, Hello

            hello = Hello(self._about["model"])
            Call(model, hello)
            Answer(model, hello.outputs)

    @classmethod
    def _of(
        cls,
        text: str,
        toml: bool,
        name: str,
        folder: Path,
        files: dict[str, bytes],
        made: bool,
        model: Model | None,
        configuration: str | None,
    ) -> Study:
        study: Study = object.__new__(cls)
        study._set(text, toml, name, folder, files, made, model, configuration)
        return study

    @classmethod
    def from_toml(
        cls,
        text: str,
        *,
        model: ModelLike = None,
        files: Mapping[str, bytes] | None = None,
        configuration: str | None = None,
    ) -> Study:
        """A study from the text of a TOML file; `files` has the measured files that it names."""
        host = _host(model) if model is not None else None
        return cls._of(text, True, "<text>", ".", dict(files or {}), False, host, configuration)

    @classmethod
    def from_json(
        cls,
        text: str,
        *,
        model: ModelLike = None,
        files: Mapping[str, bytes] | None = None,
        configuration: str | None = None,
    ) -> Study:
        """The same of JSON."""
        host = _host(model) if model is not None else None
        return cls._of(text, False, "<text>", ".", dict(files or {}), False, host, configuration)

    def __reduce__(self) -> Any:
        return (_study, (*self._state, self._model, self._configuration))

    def __copy__(self) -> Study:
        return self

    def __deepcopy__(self, memo: Any) -> Study:
        return self

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Study)
            and self._state == other._state
            and self._model is other._model
            and self._configuration == other._configuration
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        title = f"{self.title!r}: " if self.title else ""
        return f"<Study {title}{', '.join(self._about['characteristics'])} of {len(self._about['dimensions'])} dimensions>"

    @property
    def title(self) -> str | None:
        """What it is about, in one line."""
        title: str | None = self._about["title"]
        return title

    @property
    def dimensions(self) -> dict[str, Record]:
        """What the engine made of each dimension: nominal, tolerance, mean, sigma, distribution, unit.

        The distribution is its name, and has the functions of scipy's frozen distributions: `pdf`, `cdf`, `sf`, `ppf`, `isf`, `rvs`.
        """

        def law(one: Mapping[str, Any]) -> Distribution | None:
            return Distribution(one["distribution"], (self, one["name"])) if one["distribution"] else None

        return {one["name"]: Record({**one, "distribution": law(one)}) for one in self._about["dimensions"]}

    def _about_dimensions(self) -> list[str]:
        return [str(one["name"]) for one in self._about["dimensions"]]

    @property
    def characteristics(self) -> list[str]:
        """The names of the characteristics."""
        return list(self._about["characteristics"])

    @property
    def configurations(self) -> list[str]:
        """The names of its configurations."""
        return list(self._about["configurations"])

    @property
    def configuration(self) -> str | None:
        """The configuration that is meant; None for the study as written."""
        return self._configuration

    def configured(self, name: str | None) -> Study:
        """The study with nominal values and constants of one of its configurations; as written with None.

        Raises
        ------
        StudyError
            Where there is no configuration of this name, with those that there are.
        """
        return type(self)._of(*self._state, self._model, name)

    @property
    def model(self) -> Model | None:
        """The function that is its model, where there is one."""
        return self._model

    @property
    def sha256(self) -> str:
        """What reports call it: the hash of its text and the measured values."""
        return str(self._about["sha256"])

    def to_dict(self) -> dict[str, Any]:
        """The study as a study file of JSON has it."""
        data: dict[str, Any] = json.loads(self._core.as_json())
        return data

    def to_json(self) -> str:
        """The same as text."""
        return json.dumps(self.to_dict(), ensure_ascii=False, indent=2) + "\n"

    def to_toml(self) -> str:
        """The study as TOML: its own text, comments included, where it was read from TOML."""
        text, toml = self._state[:2]
        return text if toml else _toml.text(self.to_dict())

    def write(self, path: Path) -> None:
        """Writes the study as a .toml or .json file. A function that is its model, and arrays of measured values, are not written."""
        ending = os.path.splitext(os.fspath(path))[1].lower()
        if ending not in (".toml", ".json"):
            raise ValueError(f"a study is a .toml or a .json file, got {os.fspath(path)!r}")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.to_toml() if ending == ".toml" else self.to_json())

    def replace(self, entries: Mapping[str, Any] | None = None, /, **more: Any) -> Study:
        """The study with other entries: dimensions and characteristics by name, or whole sections.

        >>> import sensitol as st
        >>> study = st.Study(dimensions={"a": st.Dimension(10, 0.3)}, characteristics={"y": st.Characteristic("2*a")})
        >>> study.replace(a=st.Dimension(10, 0.1)).dimensions["a"].tolerance
        [-0.1, 0.1]
        """
        data = self.to_dict()
        _, _, name, folder, files, _ = self._state
        files = dict(files)
        model = self._model
        sections = (
            *("title", "constants", "formulas", "unknowns", "equations", "loops", "costs", "loss", "setup"),
            *("about", "units", "analysis", "configurations", "processes", "parts", "joints"),
        )
        for key, value in {**(entries or {}), **more}.items():
            if key in data.get("dimensions", {}):
                data["dimensions"].update(_entries({key: value}, "dimensions", Dimension, files))
            elif key in data.get("characteristics", {}):
                data["characteristics"].update(_entries({key: value}, "characteristics", Characteristic, files))
            elif key == "dimensions":
                data[key] = _entries(value, key, Dimension, files)
            elif key == "characteristics":
                data[key] = _entries(value, key, Characteristic, files)
            elif key == "correlation":
                data[key] = _correlation(value)
            elif key == "joint":
                data[key] = _joint(value, files)
            elif key == "model":
                data.pop("model", None)
                model = _host(value)
            elif key in sections:
                data[key] = value
            else:
                known = ", ".join(f"`{one}`" for one in [*data.get("dimensions", {}), *data.get("characteristics", {})])
                raise StudyError(f"there is no dimension and no characteristic `{key}`; there are {known}", key=key)
        text = json.dumps(plain({key: value for key, value in data.items() if value is not None}, ""), ensure_ascii=False)
        _on_disk(data, folder, files)
        return type(self)._of(text, False, name, folder, files, True, model, self._configuration)

    def check(self) -> list[ReportedWarning]:
        """What is legal in the study but most likely not meant. Nothing is evaluated; what is wrong was raised before."""
        return [ReportedWarning(one) for one in self._about["warnings"]]

    def analyze(
        self,
        method: str | None = None,
        *,
        accuracy: float | None = None,
        accuracy_skewness: float | None = None,
        accuracy_kurtosis: float | None = None,
        accuracy_yield: float | None = None,
        budget: int | None = None,
        step: float | None = None,
        pairs: str | Sequence[tuple[str, str]] | None = None,
        stencil: str | None = None,
        nodes: int | None = None,
        sensitivities: str | None = None,
        derivatives: str | None = None,
        extremes: bool | None = None,
        seed: int | None = None,
        verify: int | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> AnalysisResult:
        """Moments, yield, capability, worst case, sensitivities and contributions, each with an error estimate.

        The keywords to `verify` are the keys of `[analysis]` in a study file, and win over it.
        """
        keys = {
            "method": method,
            "accuracy": accuracy,
            "accuracy_skewness": accuracy_skewness,
            "accuracy_kurtosis": accuracy_kurtosis,
            "accuracy_yield": accuracy_yield,
            "budget": budget,
            "step": step,
            "pairs": pairs,
            "stencil": stencil,
            "nodes": nodes,
            "sensitivities": sensitivities,
            "derivatives": derivatives,
            "extremes": extremes,
            "seed": seed,
            "verify": verify,
        }
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(AnalysisResult, {"command": "analyze"}, keys, run)

    def worst_case(
        self,
        method: str | None = None,
        *,
        budget: int | None = None,
        seed: int | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> AnalysisResult:
        """The analysis with the true extremes in the box of the tolerance bands: `r["gap"].worst_case`."""
        keys = {"method": method, "budget": budget, "seed": seed, "extremes": True}
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(AnalysisResult, {"command": "analyze"}, keys, run)

    def simulate(
        self,
        samples: float | None = None,
        *,
        sampler: Sampler = "random",
        seed: int | None = None,
        until: float | None = None,
        until_yield: float | None = None,
        control_variate: bool = False,
        method: str | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> SimulationResult:
        """The model itself at many points: moments, quantiles and yield with standard errors.

        100 000 points unless `samples` says otherwise; with `until` (relative error of sigma) or `until_yield` as many as that takes.
        """
        asked = {
            "command": "simulate",
            "samples": samples,
            "sampler": sampler,
            "until": until,
            "until_yield": until_yield,
            "control_variate": control_variate,
        }
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(SimulationResult, asked, {"seed": seed, "method": method}, run)

    def rare(
        self,
        samples: float | None = None,
        *,
        seed: int | None = None,
        until: float | None = None,
        method: str | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> RareResult:
        """Small reject rates by importance sampling, with confidence intervals."""
        asked = {"command": "rare", "samples": samples, "until": until}
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(RareResult, asked, {"seed": seed, "method": method}, run)

    def compare(
        self,
        *,
        budget: int | None = None,
        samples: int | None = None,
        seed: int | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> ComparisonResult:
        """Every method beside a reference of `samples` points: what each costs, and how far it is off."""
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(ComparisonResult, {"command": "compare", "samples": samples}, {"budget": budget, "seed": seed}, run)

    def sweep(
        self,
        over: str,
        values: Iterable[float],
        *,
        method: str | None = None,
        accuracy: float | None = None,
        budget: int | None = None,
        seed: int | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> SweepResult:
        """Mean and quantile band along a parameter: a dimension, a constant, or an input of a built-in model."""
        found = plain(values, "values")
        if not isinstance(found, list) or any(isinstance(one, (str, list, dict)) for one in found):
            raise TypeError("values must be a sequence of numbers")
        asked = {"command": "sweep", "over": over, "values": [float(one) for one in found]}
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(SweepResult, asked, {"method": method, "accuracy": accuracy, "budget": budget, "seed": seed}, run)

    def allocate(
        self,
        *,
        recentre: Iterable[str] | Mapping[str, tuple[float, float] | None] = (),
        cost: CostBasis | None = None,
        minimise: Literal["rejects"] | None = None,
        maximise: Literal["cpk"] | None = None,
        cost_limit: float | None = None,
        front: int | None = None,
        confirm: int | None = None,
        method: str | None = None,
        budget: int | None = None,
        seed: int | None = None,
        characteristics: Names = None,
        threads: int | None = None,
        time: float | None = None,
        executor: Any = None,
        chunksize: int | str = "auto",
        cache: Path | bool | None = None,
        progress: Progress = None,
        on_interrupt: Interrupt = "raise",
    ) -> AllocationResult:
        """The cheapest tolerances that keep the requirements; `r.study` is the study with them.

        `recentre` names dimensions whose nominal values may move, as a mapping with least and greatest values. `cost` takes relative
        costs in place of the study's own. `minimise="rejects"` or `maximise="cpk"` seeks the best that `cost_limit` pays for, in
        place of the least cost.
        """
        asked: dict[str, Any] = {"command": "allocate", "recentre": names(recentre), "front": front, "confirm": confirm}
        asked["cost"] = cost
        asked["goal"], asked["cost_limit"] = _goal(minimise, maximise, cost_limit, front), cost_limit
        if isinstance(recentre, Mapping):
            asked["nominal_bounds"] = [[name, list(ends)] for name, ends in recentre.items() if ends is not None]
        for name in names(recentre):
            if name not in self._about_dimensions():
                known = ", ".join(f"`{one}`" for one in self._about_dimensions())
                raise StudyError(f"there is no dimension `{name}` to recentre; there are {known}", key="recentre")
        run = RunOptions(characteristics, threads, time, executor, chunksize, cache, progress, on_interrupt)
        return self._run(AllocationResult, asked, {"method": method, "budget": budget, "seed": seed}, run)

    def _run(self, cls: type[R], asked: Mapping[str, Any], analysis: Mapping[str, Any], how: RunOptions) -> R:
        analysis = {key: value for key, value in analysis.items() if value is not None}
        asked = {key: _whole(value) if key in _COUNTS else value for key, value in asked.items() if value is not None}
        analysis = {key: _whole(value) if key in _COUNTS else value for key, value in analysis.items()}
        evaluators: list[Any] = []

        def make(told: str) -> Any:
            from ._evaluate import Hello
            from ._running import evaluator

            assert self._model is not None
            evaluators.append(evaluator(self._model, Hello(json.loads(told)), how))
            return evaluators[-1]

        if self._model is None and how.executor is not None:
            raise TypeError("executor is for models that are functions of Python, and this study has none")
        with Shown(how.progress) as shown:
            try:
                outcome = self._core.run(
                    json.dumps(plain(asked, "")),
                    json.dumps(plain(analysis, "analysis")),
                    how.characteristics,
                    make if self._model is not None else None,
                    shown.told,
                    how.threads,
                    how.time,
                    self._journal(how.cache),
                    how.partial,
                    self._model is None or self._model.vectorized or how.executor is not None,
                )
            finally:
                for one in evaluators:
                    close = getattr(one, "close", None)
                    if close is not None:
                        close()
        study: Study = self
        if outcome.study is not None:
            _, toml, name, folder, files, made = self._state
            study = type(self)._of(outcome.study, toml, name, folder, files, made, self._model, self._configuration)
        result = cls(outcome, study)
        _warn(result)
        if outcome.not_written is not None:
            _issue(f"The study with the tolerances found cannot be written: {outcome.not_written}", "not-written", None)
        return result

    def _journal(self, cache: Path | bool | None) -> Path | None:
        """Where answers of an external program are kept: as on the command line beside a study that is a file."""
        if self._model is not None or cache is False:
            return None
        if cache is None or cache is True:
            _, _, name, folder, _, made = self._state
            stem = os.path.splitext(os.path.basename(name))[0]
            return None if made or name == "<text>" else os.path.join(folder, stem + ".journal.sqlite")
        return cache


def _whole(value: Any) -> Any:
    """A whole number written as 1e5 as an integer, and anything else as it is."""
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _on_disk(data: Mapping[str, Any], folder: Path, files: dict[str, bytes]) -> None:
    """Beside files in memory the engine looks for none in the folder: those that the study names there are read."""
    entries = [*data.get("dimensions", {}).values(), *(data.get("joint") or ())]
    measured = [entry.get("measured") for entry in entries if isinstance(entry, Mapping)]
    for name in [*measured, data.get("processes")] if files else ():
        if isinstance(name, str) and name not in files and os.path.isfile(os.path.join(folder, name)):
            with open(os.path.join(folder, name), "rb") as file:
                files[name] = file.read()


def _goal(minimise: Any, maximise: Any, cost_limit: Any, front: Any) -> str | None:
    """What an allocation seeks in place of the least cost."""
    if minimise not in (None, "rejects"):
        raise ValueError(f'minimise must be "rejects", got {minimise!r}')
    if maximise not in (None, "cpk"):
        raise ValueError(f'maximise must be "cpk", got {maximise!r}')
    if minimise and maximise:
        raise ValueError("minimise and maximise are two goals: leave one out")
    if not (minimise or maximise):
        if cost_limit is not None:
            raise ValueError('cost_limit is for minimise="rejects" or maximise="cpk": add one of them')
        return None
    said = 'minimise="rejects"' if minimise else 'maximise="cpk"'
    if cost_limit is None:
        raise ValueError(f"{said} needs cost_limit, what all tolerances together may cost")
    if isinstance(cost_limit, (bool, str)) or not 0 < float(cost_limit) < float("inf"):
        raise ValueError(f"cost_limit must be a positive number, got {cost_limit!r}")
    if front is not None:
        raise ValueError(f"front is for the least cost: leave out front or {said}")
    return "fewest-rejects" if minimise else "most-cpk"


def _hosted(model: Model | None) -> bool | None:
    return None if model is None else model.cheap


def _host(model: Any) -> Model:
    if isinstance(model, Model):
        return model
    if isinstance(model, type) or not callable(model):
        raise TypeError(f"a model is a function, got {model!r}")
    return Model(model)


def _study(
    text: str,
    toml: bool,
    name: str,
    folder: str,
    files: dict[str, bytes],
    made: bool,
    model: Model | None,
    configuration: str | None = None,
) -> Study:
    return Study._of(text, toml, name, folder, files, made, model, configuration)


def _entries(entries: Any, section: str, cls: Any, files: dict[str, bytes]) -> dict[str, Any]:
    if not isinstance(entries, Mapping):
        raise TypeError(f"{section} must be a mapping of names, got {type(entries).__name__}")
    found: dict[str, Any] = {}
    for name, entry in entries.items():
        if not isinstance(entry, (cls, Mapping)):
            raise TypeError(
                f"{section}[{name!r}] must be a {cls.__name__}, got {type(entry).__name__}: write {cls.__name__}({entry!r})"
            )
        keys: dict[str, Any] = entry.to_dict() if isinstance(entry, (Dimension, Characteristic)) else dict(entry)
        values = entry._values() if isinstance(entry, Dimension) else None
        if values is not None:
            file = f"{name}.csv"
            files[file] = values
            keys["measured"] = file
        found[name] = keys
    return found


def _correlation(pairs: Any) -> list[Any]:
    if pairs is None:
        return []
    if isinstance(pairs, Mapping):
        for pair in pairs:
            if not isinstance(pair, tuple) or len(pair) != 2:
                raise TypeError(f"correlation is by pairs of names, such as {{('bore', 'shaft'): 0.3}}, got {pair!r}")
        return [{"between": list(pair), "value": value} for pair, value in pairs.items()]
    return list(pairs)


def _joint(blocks: Any, files: dict[str, bytes]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = []
    if blocks is None:
        return found
    if isinstance(blocks, Mapping) or isinstance(blocks, str) or not isinstance(blocks, Iterable):
        raise TypeError(f"joint must be a list of blocks such as [{{'of': ['x', 'y'], 'law': 'disc'}}], got {type(blocks).__name__}")
    for place, block in enumerate(blocks):
        if not isinstance(block, Mapping):
            raise TypeError(f"joint[{place}] must be a mapping such as {{'of': ['x', 'y'], 'law': 'disc'}}, got {type(block).__name__}")
        keys = dict(block)
        of, measured = keys.get("of"), keys.get("measured")
        if measured is not None and not isinstance(measured, (str, os.PathLike)):
            if isinstance(of, str) or not isinstance(of, Iterable):
                raise TypeError(f"joint[{place}]['of'] must be a list of names, one for each column, got {type(of).__name__}")
            file = f"joint-{place + 1}.csv"
            files[file] = rows(measured, [str(name) for name in of], f"joint[{place}]['measured']")
            keys["measured"] = file
        elif isinstance(measured, os.PathLike):
            keys["measured"] = os.fspath(measured)
        found.append(keys)
    return found


#: Codes of warnings that ask for nothing: they stay in `result.warnings`, and are not issued.
_SILENT = frozenset({"pearson-differs"})


def _warn(result: Result) -> None:
    told = set()
    for warning in result._data.get("warnings", ()):
        key = (warning["code"], warning.get("characteristic"), warning.get("dimension"))
        if key not in told and warning["code"] not in _SILENT:
            told.add(key)
            advice = "".join(f" {one}" for one in _advice(warning))
            _issue(warning["message"] + advice, warning["code"], warning.get("characteristic"))


def _advice(warning: Mapping[str, Any]) -> list[str]:
    """What to do, in words of this package."""
    said = []
    for one in warning.get("advice", ()):
        action = one.get("action")
        if action == "use-method" and one.get("methods"):
            said.append("Use " + " or ".join(f"method={name!r}" for name in one["methods"]) + ".")
        elif action == "sample":
            points = one.get("points")
            said.append(f"Run study.simulate({points or ''}).")
        elif action == "sample-rare-events":
            said.append("Run study.rare() where few are rejected.")
        elif action in ("raise-budget", "set-budget"):
            said.append("Raise budget=." if action == "raise-budget" else "Allow that many with budget=.")
        elif action in ("raise-time-limit", "limit-time"):
            said.append("Raise time=." if action == "raise-time-limit" else "Set a limit with time=.")
    return said[:1]


def _issue(message: str, code: str, characteristic: str | None) -> None:
    """Warns at the caller's line: the first outside this package."""
    depth, frame = 1, sys._getframe(0)
    here = os.path.dirname(__file__)
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == here:
        depth, frame = depth + 1, frame.f_back
    warnings.warn(SensitolWarning(message, code, characteristic), stacklevel=depth)


def read(path: Path, *, model: ModelLike = None, configuration: str | None = None) -> Study:
    """Reads a study file, .toml or .json. `model` is a function that answers in place of the program that its `[model]` names.

    `configuration` is one of the names in its `[configurations]`.

    Raises
    ------
    StudyError
        With file, line, column and key of what is wrong, and what to write instead.
    """
    host = None if model is None else _host(model)
    path = os.fspath(path)
    if configuration is not None and not isinstance(configuration, str):
        raise TypeError(f"a configuration is named by text, got {type(configuration).__name__}")
    found = _core.Study.read(path, _hosted(host), configuration)
    # The working folder may change before the study is asked.
    folder = os.path.dirname(os.path.abspath(path))
    return Study._of(found.text, path.endswith(".toml"), path, folder, {}, False, host, configuration)


for _class in (Study, Dimension, Characteristic):
    _class.__module__ = "sensitol"
