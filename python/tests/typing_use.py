"""How users write it, for type checkers: mypy --strict and pyright look at this file; nothing runs it."""

from __future__ import annotations

import sys
from typing import Any, Dict, List, Optional

if sys.version_info >= (3, 11):
    from typing import assert_type
else:
    from typing_extensions import assert_type

import sensitol as st


@st.model
def scalar(bore: float, shaft: float) -> float:
    return bore - shaft


@st.model(vectorized=True, outputs=["gap"])
def vectorized(bore: Any, shaft: Any) -> Any:
    return bore - shaft


study = st.Study(
    dimensions={"bore": st.Dimension(25.02, 0.01, unit="mm"), "shaft": st.Dimension(24.98, (-0.013, 0.0))},
    characteristics={"gap": st.Characteristic(lower=0.02)},
    model=vectorized,
    correlation={("bore", "shaft"): 0.3},
)
assert_type(scalar, st.Model)
result = study.analyze("full", seed=1)
assert_type(result, st.AnalysisResult)
assert_type(result["gap"], st.CharacteristicResult)
assert_type(result["gap"].sigma, Optional[float])
assert_type(result["gap"].yield_, Optional[float])
law = result["gap"].law
assert law is None or isinstance(law, str)
assert_type(result.evaluations, int)
assert_type(result.met, Optional[bool])
assert_type(result["gap"].sensitivities[0].dimension, str)
assert_type(result.to_dict(), Dict[str, Any])
assert_type(result.table("sensitivities"), Dict[str, List[Any]])
assert_type(study.simulate(1000, sampler="sobol"), st.SimulationResult)
assert_type(study.sweep("bore", [1.0, 2.0])["gap"].points[0].mean, Optional[float])
assert_type(study.allocate().study, st.Study)
assert_type(study.rare()["gap"].yield_, Optional[float])
assert_type(study.compare()["gap"].methods[0].method, str)
assert_type(study.replace(bore=st.Dimension(1)), st.Study)
