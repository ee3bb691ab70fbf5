"""What this package raises, and what it warns of."""

from __future__ import annotations

from typing import Any, Sequence

__all__ = ["AnalysisError", "ModelError", "NoValue", "SensitolWarning", "StudyError"]


class StudyError(ValueError):
    """A study that cannot be used: what is wrong, where, and what to write instead.

    A study made of Python objects has no file, line or column; `key` is the path of what is wrong,
    such as ``dimensions.bore.tolerance``.
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        line: int | None = None,
        column: int | None = None,
        key: str = "",
        fault: str | None = None,
        help: str | None = None,
        more: Sequence[dict[str, Any]] = (),
    ) -> None:
        super().__init__(message)
        self.file = file
        self.line = line
        self.column = column
        self.key = key
        self.fault = message if fault is None else fault
        self.help = help
        #: The other faults of the same study, each with the same keys and its `message`.
        self.more = list(more)

    def __str__(self) -> str:
        rest = "".join("\n" + str(other["message"]) for other in self.more)
        return f"{self.args[0]}{rest}"

    def __reduce__(self) -> Any:
        return (_study_error, (self.args[0], dict(self.__dict__)))


def _study_error(message: str, attributes: dict[str, Any]) -> StudyError:
    error = StudyError(message)
    error.__dict__.update(attributes)
    return error


class AnalysisError(ValueError):
    """What is asked of a study cannot be done; `advice` says what to do instead."""

    def __init__(self, message: str, *, advice: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.advice = list(advice)

    def __reduce__(self) -> Any:
        return (_analysis_error, (self.args[0], self.advice))


def _analysis_error(message: str, advice: list[str]) -> AnalysisError:
    return AnalysisError(message, advice=advice)


class ModelError(ValueError):
    """A function does not fit the study, or answers with something that is not an answer."""


class NoValue(Exception):
    """Raised by a model: it has no value at this point. The point fails, and the run goes on."""


class SensitolWarning(UserWarning):
    """Where an assumption fails. `code` names the warning, as on the page of warnings."""

    def __init__(self, message: str, code: str = "", characteristic: str | None = None) -> None:
        super().__init__(message)
        self.code = code
        self.characteristic = characteristic


# Tracebacks show them under the name that users write.
for _class in (StudyError, AnalysisError, ModelError, NoValue, SensitolWarning):
    _class.__module__ = "sensitol"
