"""What evaluates the points of one run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._evaluate import Hello, Scalar, Vectorized
from ._model import Model

if TYPE_CHECKING:
    from ._study import _Run


def evaluator(model: Model, hello: Hello, how: _Run) -> Any:
    """The evaluator of a run: by an executor where there is one, and with kept answers where they are wanted."""
    return Vectorized(model, hello) if model.vectorized else Scalar(model, hello)
