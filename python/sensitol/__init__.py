"""Statistical tolerance analysis for anything you can compute.

>>> import sensitol as st
>>> study = st.Study(
...     dimensions={"bore": st.Dimension(25.02, 0.01), "shaft": st.Dimension(24.98, 0.01)},
...     characteristics={"gap": st.Characteristic("bore - shaft", lower=0.02, upper=0.06)},
... )
>>> r = study.analyze(method="full")
>>> round(r["gap"].sigma, 6)
0.004714
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ._core import __version__ as __version__
    from ._errors import AnalysisError, ModelError, NoValue, SensitolWarning, StudyError
    from ._model import Model, model
    from ._records import Record, Result
    from ._reports import (
        AllocationResult,
        AnalysisResult,
        CharacteristicResult,
        ComparisonResult,
        RareResult,
        SimulationResult,
        SweepResult,
    )
    from ._study import Characteristic, Dimension, Study, read

#: Where each name is: nothing is imported before it is used, so that the command starts at once.
_PLACES = {
    "AnalysisError": "_errors",
    "ModelError": "_errors",
    "NoValue": "_errors",
    "SensitolWarning": "_errors",
    "StudyError": "_errors",
    "Model": "_model",
    "model": "_model",
    "Record": "_records",
    "Result": "_records",
    "AllocationResult": "_reports",
    "AnalysisResult": "_reports",
    "CharacteristicResult": "_reports",
    "ComparisonResult": "_reports",
    "RareResult": "_reports",
    "SimulationResult": "_reports",
    "SweepResult": "_reports",
    "Characteristic": "_study",
    "Dimension": "_study",
    "Study": "_study",
    "read": "_study",
    "__version__": "_core",
}

__all__ = [
    "AllocationResult",
    "AnalysisError",
    "AnalysisResult",
    "Characteristic",
    "CharacteristicResult",
    "ComparisonResult",
    "Dimension",
    "Model",
    "ModelError",
    "NoValue",
    "RareResult",
    "Record",
    "Result",
    "SensitolWarning",
    "SimulationResult",
    "Study",
    "StudyError",
    "SweepResult",
    "model",
    "read",
]


def __getattr__(name: str) -> Any:
    place = _PLACES.get(name)
    if place is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module("." + place, __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
