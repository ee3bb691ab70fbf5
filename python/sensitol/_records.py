"""Objects over the JSON of reports: attributes by name, in tables and lists too."""

from __future__ import annotations

import csv
import io
import json
import keyword
import re
from typing import TYPE_CHECKING, Any, Iterator, Mapping

from ._distribution import Distribution

if TYPE_CHECKING:
    import os

    import pandas  # type: ignore[import-untyped,unused-ignore]

    from ._study import Study

__all__ = ["Fitted", "Record", "Result"]


class Record:
    """A part of a report. `r.to_dict()` is its JSON; a key that is a keyword has a `_`: `r.yield_`."""

    _inner: Mapping[str, type] = {}
    _data: dict[str, Any]

    def __init__(self, data: Mapping[str, Any]) -> None:
        self.__dict__["_data"] = dict(data)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        data = self.__dict__.get("_data", {})
        key = name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name
        if key not in data:
            if name in _fields(type(self)):
                return None
            known = ", ".join(_attribute(key) for key in data)
            raise AttributeError(f"{type(self).__name__} has no attribute {name!r}; there are {known}")
        # A table of names and numbers stays a dict; what no class describes is a record.
        cls = type(self)._inner.get(name, None if name in _fields(type(self)) else Record)
        value = data[key] if cls is None else _wrapped(data[key], cls)
        self.__dict__[name] = value
        return value

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"{type(self).__name__} cannot be changed")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(_attribute(key) for key in self._data)})

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self._data == other._data

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        parts = []
        for key, value in self._data.items():
            if isinstance(value, (dict, list)):
                value = f"<{len(value)}>"
                parts.append(f"{_attribute(key)}={value}")
            else:
                parts.append(f"{_attribute(key)}={value!r}")
        return f"{type(self).__name__}({', '.join(parts)})"

    def __reduce__(self) -> Any:
        return (type(self), (self._data,))

    def __format__(self, spec: str) -> str:
        """``format(result["gap"], "u")``: mean ± sigma with two digits of sigma and the unit, ``".3u"`` with three."""
        asked = re.fullmatch(r"(?:\.([1-9]\d?))?u", spec)
        if asked is None:
            return format(str(self), spec)
        mean, sigma = self._data.get("mean"), self._data.get("sigma")
        unit = self._data.get("unit")
        after = f" {unit}" if unit else ""
        if mean is None or sigma is None:
            return "unknown" + after
        digits = int(asked[1] or 2)
        # Rounded first: 0.0996 with two digits is 0.10, of one decimal less.
        places = digits - 1 - int(f"{sigma:.{digits - 1}e}".partition("e")[2])
        mean, sigma = round(mean, places), round(sigma, places)
        return f"{mean:.{max(places, 0)}f} ± {sigma:.{max(places, 0)}f}{after}"

    def to_dict(self) -> dict[str, Any]:
        """Its JSON: what is unknown is None."""
        copy: dict[str, Any] = json.loads(json.dumps(self._data))
        return copy


class Fitted(Record):
    """A characteristic with four moments."""

    @property
    def law(self) -> Distribution | None:
        """The Pearson distribution with its four moments, with `pdf`, `cdf`, `sf`, `ppf`, `isf` and `rvs`; None where no distribution has
        these moments, or nothing varies. The yield is that of a better law where there is one: `yield_source` says which."""
        distribution = self._data.get("distribution") or {}
        moments = tuple(self._data.get(name) for name in ("mean", "sigma", "skewness", "kurtosis"))
        if distribution.get("family") != "pearson" or None in moments:
            return None
        return Distribution("pearson", moments)  # type: ignore[arg-type]

    def cdf(self, x: Any) -> Any:
        """The probability of at most `x` by its :attr:`law`.

        Raises
        ------
        ValueError
            Where there is no such law.
        """
        law = self.law
        if law is None:
            raise ValueError(f"no Pearson distribution has the moments of `{self._data.get('name')}`")
        return law.cdf(x)


def _fields(cls: type) -> set[str]:
    return {name for one in cls.__mro__ for name in getattr(one, "__annotations__", {}) if not name.startswith("_")}


def _attribute(key: str) -> str:
    return key + "_" if keyword.iskeyword(key) else key


def _wrapped(value: Any, cls: type) -> Any:
    if isinstance(value, dict):
        return cls(value)
    if isinstance(value, list):
        return [_wrapped(one, cls) for one in value]
    return value


class Rendered:
    """What an outcome shows, kept: what is pickled of it."""

    def __init__(self, outcome: Any) -> None:
        self.study = outcome.study
        self.not_written = outcome.not_written
        self._text = {full: outcome.text(100, full) for full in (False, True)}
        self._html = outcome.html()
        self._svg = outcome.svg("")
        self._tables = outcome.tables()

    def text(self, width: int = 80, full: bool = False) -> str:
        return str(self._text[full])

    def html(self) -> str:
        return str(self._html)

    def svg(self, title: str) -> str:
        return str(self._svg)

    def tables(self) -> Any:
        return self._tables


class Result(Record):
    """The result of a run: the report's fields as attributes, and the report as text, page, tables and plots."""

    def __init__(self, outcome: Any, study: Any = None, data: Mapping[str, Any] | None = None) -> None:
        super().__init__(json.loads(outcome.json()) if data is None else data)
        self.__dict__["_outcome"] = outcome
        self.__dict__["_study"] = study

    def __reduce__(self) -> Any:
        outcome = self.__dict__["_outcome"]
        shown = outcome if isinstance(outcome, Rendered) else Rendered(outcome)
        return (type(self), (shown, self.__dict__["_study"], self._data))

    def _named(self, name: str) -> Any:
        characteristics = getattr(self, "characteristics", [])
        for one in characteristics:
            if one._data.get("name") == name:
                return one
        known = ", ".join(f"`{one._data.get('name')}`" for one in characteristics)
        raise KeyError(f"there is no characteristic `{name}`; there are {known}")

    def __iter__(self) -> Iterator[str]:
        return iter([str(one["name"]) for one in self._data.get("characteristics", [])])

    def keys(self) -> list[str]:
        """The names of the characteristics."""
        return list(self)

    @property
    def study(self) -> Study:
        """The study that was asked. Of an allocation, the one with the tolerances found."""
        study: Study = self.__dict__["_study"]
        return study

    @property
    def met(self) -> bool | None:
        """Whether every requirement is met; None where that is inconclusive, or nothing is required."""
        found = [one.get("met") for one in self._data.get("characteristics", [])]
        judged = [one for one in found if one is not None]
        unknown = any(
            one.get("met") is None and (one.get("requirements") or one.get("target_yield") is not None)
            for one in self._data.get("characteristics", [])
        )
        if False in judged:
            return False
        return None if unknown or not judged else True

    def __str__(self) -> str:
        return str(self._outcome_().text(100, False)).rstrip("\n")

    def __repr__(self) -> str:
        names = ", ".join(self)
        return f"<{type(self).__name__} of {names}: {self._data.get('evaluations')} evaluations>"

    def _outcome_(self) -> Any:
        return self.__dict__["_outcome"]

    def text(self, *, width: int = 80, full: bool = False) -> str:
        """The report as the command line prints it, `full` as with all details."""
        return str(self._outcome_().text(width, full))

    def to_html(self, path: str | os.PathLike[str] | None = None) -> str:
        """The report as one page that needs no network; written to `path`, where there is one."""
        page = str(self._outcome_().html())
        if path is not None:
            with open(path, "w", encoding="utf-8") as file:
                file.write(page)
        return page

    def to_json(self) -> str:
        """The report as JSON."""
        return json.dumps(self._data)

    def tables(self) -> list[str]:
        """The names of the tables."""
        return [name[:-4] for name, _ in self._outcome_().tables()]

    def table(self, name: str) -> dict[str, list[Any]]:
        """A table of the report: a list for each column, None where a cell is unknown."""
        tables = {file[:-4]: text for file, text in self._outcome_().tables()}
        if name not in tables:
            known = ", ".join(f"`{one}`" for one in tables)
            raise KeyError(f"there is no table `{name}`; there are {known}")
        rows = list(csv.reader(io.StringIO(tables[name])))
        columns: dict[str, list[Any]] = {heading: [] for heading in (rows[0] if rows else [])}
        for row in rows[1:]:
            for heading, cell in zip(columns, row):
                columns[heading].append(_cell(cell))
        return columns

    def to_frame(self, name: str | None = None) -> pandas.DataFrame:
        """A table of the report as a DataFrame of pandas. `tables()` names the tables."""
        if name is None:
            choices = ", ".join(repr(one) for one in self.tables())
            raise TypeError(f"to_frame needs the name of a table: {choices}")
        try:
            import pandas
        except ImportError:
            raise ImportError('to_frame needs pandas: pip install "sensitol[frames]"') from None
        return pandas.DataFrame(self.table(name))

    def to_svg(self, title: str = "") -> str:
        """The charts of the report."""
        return str(self._outcome_().svg(title))

    def plot(self, characteristic: str | None = None, kind: str | None = None, *, ax: Any = None) -> Any:
        """Draws the result with matplotlib, and returns the axes.

        An analysis has the kinds `"density"` (limits, rejects, verdict), `"contributions"`, and `"both"`, which returns an array of two
        axes and is drawn without `ax` unless another kind is named. A simulation shows its sample as a density, a sweep its band, an
        allocation the tolerances before and after, a comparison the error of each method.
        """
        from ._plot import plot

        return plot(self, characteristic, kind, ax)

    def _repr_html_(self) -> str:
        from ._notebook import frame

        return frame(self.to_html())

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        return {"text/plain": str(self), "text/html": self._repr_html_()}


def _cell(text: str) -> Any:
    if text == "":
        return None
    if text in ("true", "false"):
        return text == "true"
    for number in (int, float):
        try:
            return number(text)
        except ValueError:
            pass
    return text
