"""Functions of Python as assembly functions."""

from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, Iterable, Literal, overload

from ._errors import ModelError

__all__ = ["Model", "model"]

Errors = Literal["raise", "point"]


class Model:
    """A function as assembly function. :func:`model` makes it; it is still called as the function is."""

    def __init__(
        self,
        function: Callable[..., Any],
        *,
        vectorized: bool = False,
        pass_: Literal["names", "dict"] = "names",
        outputs: Iterable[str] | None = None,
        cheap: bool = False,
        errors: Errors = "raise",
        version: str = "",
    ) -> None:
        function = getattr(function, "function", function) if isinstance(function, Model) else function
        if not callable(function):
            raise TypeError(f"a model is a function, got {type(function).__name__}")
        if pass_ not in ("names", "dict"):
            raise ValueError(f'pass_ must be "names" or "dict", got {pass_!r}')
        if errors not in ("raise", "point"):
            raise ValueError(f'errors must be "raise" or "point", got {errors!r}')
        if isinstance(outputs, str):
            raise TypeError(f"outputs must be a list of names: outputs=[{outputs!r}]")
        self.function: Callable[..., Any] = function
        self.vectorized = bool(vectorized)
        self.pass_ = pass_
        self.outputs = None if outputs is None else tuple(outputs)
        self.cheap = bool(cheap)
        self.errors = errors
        self.version = version
        functools.update_wrapper(self, function, updated=())

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self.function(*args, **kwargs)

    def __repr__(self) -> str:
        return f"<sensitol.Model {self.name}>"

    @property
    def name(self) -> str:
        """The function's name, for messages."""
        return getattr(self.function, "__name__", type(self.function).__name__)

    # A decorated function of a module is pickled by its name, as the function itself would be.
    def __reduce_ex__(self, protocol: Any) -> Any:
        name = getattr(self.function, "__qualname__", "")
        module = getattr(self.function, "__module__", None)
        if module and name and "<" not in name:
            import sys

            found: Any = sys.modules.get(module)
            for part in name.split("."):
                found = getattr(found, part, None)
            if found is self:
                return name
        settings = (self.vectorized, self.pass_, self.outputs, self.cheap, self.errors, self.version)
        return (_model, (self.function, *settings))

    def arguments(self, inputs: list[str], constants: list[str], optional: list[str]) -> tuple[list[str], list[str]]:
        """The names of dimensions and of constants that the function takes.

        Raises ModelError where a parameter has no value, or a dimension that no formula uses has no parameter.
        """
        known = [*inputs, *constants]
        if self.pass_ == "dict":
            return inputs, constants
        try:
            parameters = inspect.signature(self.function).parameters.values()
        except (TypeError, ValueError):
            return inputs, constants
        named = [p for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
        for parameter in parameters:
            if parameter.kind in (parameter.POSITIONAL_ONLY, parameter.VAR_POSITIONAL):
                raise ModelError(
                    f"{self.name}{inspect.signature(self.function)} takes parameters by position, and a model gets them by "
                    f'name: name the dimensions, or use @model(pass_="dict")'
                )
        for parameter in named:
            if parameter.name not in known and parameter.default is parameter.empty:
                raise ModelError(
                    f"{self.name}() needs `{parameter.name}`, which is no dimension and no constant of the study: there are "
                    + _listed(known)
                )
        if any(parameter.kind is parameter.VAR_KEYWORD for parameter in parameters):
            return inputs, constants
        names = {parameter.name for parameter in named}
        for name in inputs:
            if name not in names and name not in optional:
                raise ModelError(
                    f"{self.name}() has no parameter `{name}`, and no formula uses this dimension: add the parameter, or **rest"
                )
        return [name for name in inputs if name in names], [name for name in constants if name in names]


def _model(function: Callable[..., Any], vectorized: bool, pass_: Any, outputs: Any, cheap: bool, errors: Any, version: str) -> Model:
    return Model(
        function, vectorized=vectorized, pass_=pass_, outputs=outputs, cheap=cheap, errors=errors, version=version
    )


def _listed(names: list[str]) -> str:
    return ", ".join(f"`{name}`" for name in names) or "none"


@overload
def model(function: Callable[..., Any], /) -> Model: ...


@overload
def model(
    *,
    vectorized: bool = ...,
    pass_: Literal["names", "dict"] = ...,
    outputs: Iterable[str] | None = ...,
    cheap: bool = ...,
    errors: Errors = ...,
    version: str = ...,
) -> Callable[[Callable[..., Any]], Model]: ...


def model(function: Callable[..., Any] | None = None, /, **settings: Any) -> Any:
    """Makes an assembly function of a function of named dimensions.

    Parameters
    ----------
    vectorized
        Each parameter is a 1-D array, a value for each point, and so is each answer. Otherwise the function gets one point.
    pass_
        ``"dict"``: the function gets one dict of names and values, for names that are no identifiers.
    outputs
        The names of several answers: the function returns a tuple in this order, or a dict by name.
    cheap
        Tens of thousands of evaluations go unnoticed: results are then verified by a sample of the function itself.
    errors
        ``"raise"``: an exception of the function ends the run and is raised as it is, but for `NoValue` and ArithmeticError,
        which fail the point. ``"point"``: every exception fails its point alone.
    version
        A part of what kept answers (`cache=`) are known by: raise it where the function's own text does not tell that it changed.

    >>> import sensitol as st
    >>> @st.model
    ... def gap(bore, shaft): return bore - shaft
    >>> gap(3, 1)
    2
    """
    if function is not None:
        return Model(function)
    return lambda function: Model(function, **settings)
