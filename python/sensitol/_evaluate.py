"""Evaluates the engine's blocks of points by a function of Python."""

from __future__ import annotations

import array
import math
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

from ._errors import ModelError, NoValue
from ._model import Model, _listed

if TYPE_CHECKING:
    import numpy as np

#: How far a vectorized function may be off its answer to a point alone, relative.
ALONE = 1e-9


class Hello:
    """What the engine tells a model first."""

    def __init__(self, told: Mapping[str, Any]) -> None:
        self.inputs: list[str] = list(told["inputs"])
        self.outputs: list[str] = list(told["outputs"])
        self.nominal: list[float] = list(told["nominal"])
        self.constants: dict[str, float] = dict(told["constants"])
        self.optional: list[str] = list(told["optional"])


class Call:
    """A function with its arguments for one point, or for arrays of points. It can be pickled where the function can."""

    def __init__(self, model: Model, hello: Hello) -> None:
        self.model = model
        taken, constants = model.arguments(hello.inputs, list(hello.constants), hello.optional)
        self.inputs = hello.inputs
        self.places = [(name, hello.inputs.index(name)) for name in taken]
        self.constants = {name: hello.constants[name] for name in constants}

    def __call__(self, point: Sequence[Any]) -> Any:
        arguments = {name: point[place] for name, place in self.places}
        arguments.update(self.constants)
        if self.model.pass_ == "dict":
            return self.model.function(arguments)
        return self.model.function(**arguments)


class Answer:
    """Takes what a function returns apart."""

    def __init__(self, model: Model, outputs: list[str]) -> None:
        self.model = model
        self.outputs = outputs
        if model.outputs is not None:
            for name in outputs:
                if name not in model.outputs:
                    raise ModelError(
                        f"{model.name}() has the outputs {_listed(list(model.outputs))}, and the study asks for `{name}`"
                    )

    def parts(self, answer: Any, wanted: Sequence[int]) -> list[Any]:
        """The values of the wanted outputs."""
        name = self.model.name
        if isinstance(answer, Mapping):
            missing = [self.outputs[output] for output in wanted if self.outputs[output] not in answer]
            if missing:
                raise ModelError(f"{name}() answered {_listed(list(answer))}, not `{missing[0]}`")
            return [answer[self.outputs[output]] for output in wanted]
        if self.model.outputs is not None and len(self.model.outputs) > 1:
            if not isinstance(answer, (tuple, list)) and not (
                hasattr(answer, "__len__") and len(answer) == len(self.model.outputs)
            ):
                raise ModelError(
                    f"{name}() answered {_kind(answer)}, and has {len(self.model.outputs)} outputs: "
                    f"return a tuple in the order of outputs, or a dict by name"
                )
            if len(answer) != len(self.model.outputs):
                raise ModelError(
                    f"{name}() answered {len(answer)} values, and has {len(self.model.outputs)} outputs: "
                    + _listed(list(self.model.outputs))
                )
            return [answer[self.model.outputs.index(self.outputs[output])] for output in wanted]
        if len(self.outputs) > 1:
            raise ModelError(
                f"{name}() answered {_kind(answer)} and is asked for {_listed(self.outputs)}: return a dict by name, or say "
                f"which with @model(outputs=[...])"
            )
        if isinstance(answer, (tuple, list)) and len(answer) == 1 and self.model.outputs is not None:
            return [answer[0]]
        return [answer]

    def numbers(self, answer: Any, wanted: Sequence[int]) -> list[float]:
        """The same as floats: of one point."""
        return [self.number(part) for part in self.parts(answer, wanted)]

    def number(self, part: Any) -> float:
        if type(part) is float:
            return part
        if part is None:
            return math.nan
        if getattr(part, "ndim", 0) or isinstance(part, (str, bytes, list, tuple)):
            raise ModelError(
                f"{self.model.name}() answered {_kind(part)} for one point: return a number, or use @model(vectorized=True)"
            )
        if isinstance(part, complex):
            raise ModelError(f"{self.model.name}() answered the complex number {part}: return a real number")
        try:
            return float(part)
        except (TypeError, ValueError):
            raise ModelError(f"{self.model.name}() answered {_kind(part)}: return a number") from None


def _kind(value: Any) -> str:
    shape = getattr(value, "shape", None)
    if shape is not None and shape != ():
        return f"an array of shape {tuple(shape)}"
    if isinstance(value, (list, tuple)):
        return f"a {type(value).__name__} of {len(value)}"
    if value is None:
        return "None"
    return f"{type(value).__name__} {value!r}"


def fails_point(model: Model, error: BaseException) -> bool:
    """Whether this exception is an answer: there is no value here."""
    if isinstance(error, (NoValue, ArithmeticError)):
        return True
    return model.errors == "point" and isinstance(error, Exception) and not isinstance(error, ModelError)


def reason(error: BaseException) -> str:
    """An exception as the reason of a failed point."""
    if isinstance(error, NoValue) and str(error):
        return str(error)
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


class Scalar:
    """Calls the function once for each point."""

    def __init__(self, model: Model, hello: Hello) -> None:
        self.model = model
        self.call = Call(model, hello)
        self.answer = Answer(model, hello.outputs)

    def rows(self, points: bytes, rows: int) -> list[tuple[float, ...]]:
        values = memoryview(points).cast("d").tolist()
        if not rows:
            return []
        columns = [values[start : start + rows] for start in range(0, len(values), rows)]
        return list(zip(*columns)) if columns else [()] * rows

    def __call__(self, points: bytes, rows: int, outputs: list[int]) -> tuple[bytes, list[tuple[int, str]], int]:
        answers = array.array("d", bytes(8 * rows * len(outputs)))
        failed: list[tuple[int, str]] = []
        call, numbers = self.call, self.answer.numbers
        for row, point in enumerate(self.rows(points, rows)):
            try:
                found = numbers(call(point), outputs)
            except Exception as error:
                if not fails_point(self.model, error):
                    raise
                failed.append((row, reason(error)))
                found = [math.nan] * len(outputs)
            for column, value in enumerate(found):
                answers[column * rows + row] = value
        return answers.tobytes(), failed, 0


class Vectorized:
    """Calls the function once for a block of points."""

    def __init__(self, model: Model, hello: Hello) -> None:
        import numpy

        self.numpy = numpy
        self.model = model
        self.call = Call(model, hello)
        self.answer = Answer(model, hello.outputs)
        self.checked = False

    def block(self, columns: Any, rows: int, outputs: list[int]) -> np.ndarray:
        """The values at these columns, an output in a row."""
        parts = self.answer.parts(self.call(columns), outputs)
        found = self.numpy.empty((len(outputs), rows))
        for column, part in enumerate(parts):
            values = self.numpy.asarray(part)
            if values.shape != (rows,):
                raise ModelError(
                    f"{self.model.name}() answered {'a scalar' if values.shape == () else f'an array of shape {values.shape}'} "
                    f"for {rows} points: a vectorized function returns an array of shape ({rows},)"
                )
            if values.dtype.kind not in "fiub":
                raise ModelError(f"{self.model.name}() answered an array of {values.dtype}: return real numbers")
            found[column] = values
        return found

    def __call__(self, points: bytes, rows: int, outputs: list[int]) -> tuple[bytes, list[tuple[int, str]], int]:
        # The bytes are nobody else's: a function may keep its arrays, and cannot write into them.
        columns = self.numpy.frombuffer(points).reshape(-1, rows)
        failed: list[tuple[int, str]] = []
        try:
            found = self.block(columns, rows, outputs)
        except Exception as error:
            if not fails_point(self.model, error):
                raise
            found, failed = self.one_by_one(columns, rows, outputs)
        else:
            if not self.checked and rows > 1:
                self.checked = True
                self.check(columns, rows, outputs, found)
        return found.tobytes(), failed, 0

    def one_by_one(self, columns: Any, rows: int, outputs: list[int]) -> Any:
        """A block in which some point fails."""
        found = self.numpy.full((len(outputs), rows), math.nan)
        failed: list[tuple[int, str]] = []
        for row in range(rows):
            try:
                found[:, row] = self.block(columns[:, row : row + 1], 1, outputs)[:, 0]
            except Exception as error:
                if not fails_point(self.model, error):
                    raise
                failed.append((row, reason(error)))
        return found, failed

    def check(self, columns: Any, rows: int, outputs: list[int], found: Any) -> None:
        """The last point alone must have the answer that it has in the block: a function of whole arrays, such as max, has not."""
        last = self.numpy.ascontiguousarray(columns[:, -1:])
        last.flags.writeable = False
        try:
            alone = self.block(last, 1, outputs)[:, 0]
        except Exception as error:
            if not fails_point(self.model, error):
                raise
            return
        block = found[:, -1]
        for column, (one, other) in enumerate(zip(alone.tolist(), block.tolist())):
            scale = max(abs(one), abs(other), float(self.numpy.ptp(found[column])) if math.isfinite(other) else 0.0)
            same = one == other or (math.isnan(one) and math.isnan(other)) or abs(one - other) <= ALONE * scale
            if not same:
                raise ModelError(
                    f"{self.model.name}() answers `{self.answer.outputs[outputs[column]]}` {other:.9g} in a block of {rows} points and "
                    f"{one:.9g} for the same point alone: each answer must depend on its own point only; write np.maximum(a, b) "
                    f"rather than max, or leave out vectorized=True"
                )


