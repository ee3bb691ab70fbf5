"""Dimensions and characteristics as objects of Python."""

from __future__ import annotations

import csv
import io
from typing import Any, Iterable, Mapping, Sequence, Union

from ._errors import StudyError

__all__ = ["Characteristic", "Dimension"]

Number = Union[int, float]


class _Entry:
    """A line of a study: its keys."""

    _what = ""

    def __init__(self, keys: Mapping[str, Any]) -> None:
        self._keys = {key: value for key, value in keys.items() if value is not None}

    def __setattr__(self, name: str, value: Any) -> None:
        if name != "_keys" or hasattr(self, "_keys"):
            raise AttributeError(f"a {type(self).__name__} cannot be changed: make another one")
        object.__setattr__(self, name, value)

    def __reduce__(self) -> Any:
        return (_entry, (type(self), dict(self.__dict__)))

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other) and _plain(self.__dict__) == _plain(other.__dict__)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value!r}' for key, value in self._keys.items())})"

    def to_dict(self) -> dict[str, Any]:
        """Its keys, as in a study file."""
        return dict(self._keys)


def _plain(state: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value.tolist() if hasattr(value, "tolist") else value for key, value in state.items()}


def _entry(cls: type, state: Mapping[str, Any]) -> Any:
    entry: Any = object.__new__(cls)
    entry.__dict__.update(state)
    return entry


class Dimension(_Entry):
    """An input: nominal value, tolerance, distribution.

    Parameters
    ----------
    nominal
        The value on the drawing. With a distribution of scipy or measured values it may be left out.
    tolerance
        Half the tolerance band, `0.3`, or lower and upper deviation, `(-0.1, 0.3)`; `"2 %"` of the nominal. Without tolerance and
        sigma a dimension is constant.
    distribution
        The name of a kind, a dict with its parameters, a frozen distribution of scipy.stats, or a 1-D array of measured values.
    limits, fit, position, unit, sigma, sigmas, cp, cpk, side, drift, process, shift, rss_factor, mean_shift, degrees, moments,
    measured, column, model, step
        The keys of a study file.
    description, part, drawing, revision, feature
        Texts that reports show beside the name.
    """

    _measured: bytes | None

    def __init__(
        self,
        nominal: Number | Sequence[Number] | None = None,
        tolerance: Number | str | Sequence[Number | str] | None = None,
        *,
        unit: str | None = None,
        distribution: Any = None,
        limits: Sequence[Number] | None = None,
        fit: str | None = None,
        position: Number | None = None,
        sigma: Number | None = None,
        sigmas: Number | None = None,
        cp: Number | None = None,
        cpk: Number | None = None,
        side: str | None = None,
        drift: Number | None = None,
        process: str | None = None,
        shift: Number | None = None,
        rss_factor: Number | None = None,
        mean_shift: Number | None = None,
        degrees: Number | None = None,
        moments: Sequence[Number] | None = None,
        measured: str | None = None,
        column: str | None = None,
        model: str | None = None,
        step: Number | None = None,
        description: str | None = None,
        part: str | None = None,
        drawing: str | None = None,
        revision: str | None = None,
        feature: str | None = None,
    ) -> None:
        from . import _scipy

        keys: dict[str, Any] = {
            "nominal": nominal,
            "tolerance": tolerance,
            "limits": limits,
            "fit": fit,
            "position": position,
            "unit": unit,
            "sigma": sigma,
            "sigmas": sigmas,
            "cp": cp,
            "cpk": cpk,
            "side": side,
            "drift": drift,
            "process": process,
            "shift": shift,
            "rss_factor": rss_factor,
            "mean_shift": mean_shift,
            "degrees": degrees,
            "moments": moments,
            "measured": measured,
            "column": column,
            "model": model,
            "step": step,
            "description": description,
            "part": part,
            "drawing": drawing,
            "revision": revision,
            "feature": feature,
        }
        values: bytes | None = None
        if _scipy.is_frozen(distribution):
            own = _scipy.keys(distribution, None if nominal is None else float(nominal))  # type: ignore[arg-type]
            for key in own:
                if key != "nominal" and keys.get(key) is not None:
                    raise StudyError(f"`{key}` follows from the distribution of scipy: leave it out", key=key)
            if "limits" in own and tolerance is not None:
                raise StudyError("`tolerance` follows from the distribution of scipy: leave it out", key="tolerance")
            keys.update(own)
        elif distribution is not None and not isinstance(distribution, (str, Mapping)):
            values = _measured(distribution)
        else:
            keys["distribution"] = distribution
        object.__setattr__(self, "_measured", values)
        super().__init__(keys)

    def _values(self) -> bytes | None:
        """Measured values as a file of CSV."""
        return self._measured


def _measured(values: Any) -> bytes:
    if hasattr(values, "rvs") or callable(values):
        raise TypeError(
            f"distribution must be a name, a dict, a frozen distribution of scipy.stats or measured values, got {type(values).__name__}"
        )
    import numpy

    try:
        array = numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(
            f"distribution must be a name, a dict, a frozen distribution of scipy.stats or measured values, got {type(values).__name__}"
        ) from None
    if array.ndim != 1:
        raise StudyError(f"measured values must be a 1-D array, got shape {array.shape}", key="distribution")
    if array.size < 2:
        raise StudyError(f"measured values must be two at least, got {array.size}", key="distribution")
    wrong = numpy.flatnonzero(~numpy.isfinite(array))
    if wrong.size:
        raise StudyError(
            f"measured values must be finite: value {int(wrong[0])} is {array[wrong[0]]}, and {wrong.size} are not finite",
            key="distribution",
        )
    return ("value\n" + "\n".join(repr(value) for value in array.tolist()) + "\n").encode()


def rows(values: Any, names: list[str], where: str) -> bytes:
    """Measured parts, one a row, as a file of CSV with these names in its first line."""
    import numpy

    try:
        array = numpy.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise TypeError(f"{where} must be an array of numbers or the name of a CSV file, got {type(values).__name__}") from None
    if array.ndim != 2 or array.shape[1] != len(names):
        raise StudyError(
            f"{where} must have a row for each part and a column for each of {', '.join(names)}: shape (parts, {len(names)}), got {array.shape}",
            key="joint",
        )
    wrong = numpy.argwhere(~numpy.isfinite(array))
    if wrong.size:
        row, column = (int(one) for one in wrong[0])
        raise StudyError(
            f"{where} must be finite: row {row}, {names[column]}, is {array[row, column]}; {len(wrong)} are not finite", key="joint"
        )
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(names)
    writer.writerows([repr(value) for value in row] for row in array.tolist())
    return file.getvalue().encode()


class Characteristic(_Entry):
    """An output: what is asked of the assembly.

    Without a formula it is the output of the model that has its name. `description`, `part`, `drawing`, `revision` and `feature` are
    texts that reports show beside its name.
    """

    def __init__(
        self,
        formula: str | None = None,
        *,
        unit: str | None = None,
        lower: Number | None = None,
        upper: Number | None = None,
        target_yield: Number | None = None,
        target_cpk: Number | None = None,
        require: Any = None,
        description: str | None = None,
        part: str | None = None,
        drawing: str | None = None,
        revision: str | None = None,
        feature: str | None = None,
    ) -> None:
        if formula is not None and not isinstance(formula, str):
            raise TypeError(f"a formula is text, got {type(formula).__name__}; a function goes to Study(model=...)")
        keys = {"formula": formula, "unit": unit, "lower": lower, "upper": upper, "target_yield": target_yield}
        labels = {"description": description, "part": part, "drawing": drawing, "revision": revision, "feature": feature}
        super().__init__({**keys, "target_cpk": target_cpk, "require": require, **labels})


def plain(value: Any, path: str) -> Any:
    """A value as JSON has it: NumPy's numbers as numbers, tuples as lists. Raises StudyError with the path of what is none."""
    if isinstance(value, _Entry):
        return plain(value._keys, path)
    if value is None or isinstance(value, (bool, str)):
        return value
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise StudyError(f"{path}: a name must be text, got {type(key).__name__} {key!r}", key=path)
        return {key: plain(one, f"{path}.{key}" if path else key) for key, one in value.items() if one is not None}
    if hasattr(value, "tolist") and not isinstance(value, (int, float)):
        value = value.tolist()
        if isinstance(value, bool):
            return value
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        if value != value or value in (float("inf"), float("-inf")):
            raise StudyError(
                f"{path}: invalid number {value} (write a finite number, or leave out a limit that does not exist)",
                key=path,
                fault=f"invalid number {value}",
                help="write a finite number, or leave out a limit that does not exist",
            )
        return value
    if isinstance(value, Iterable):
        return [plain(one, path) for one in value]
    raise StudyError(f"{path}: invalid value of type {type(value).__name__}", key=path)
