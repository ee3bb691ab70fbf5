"""Copies: by pickle and by copy."""

import copy
import pickle

import pytest
from conftest import shaft_and_bore

import models
import sensitol as st


@pytest.mark.parametrize("model", [None, models.clearance, models.clearance_vectorized, models.plain])
def test_studies_come_back(model):
    study = shaft_and_bore(model)
    for again in (pickle.loads(pickle.dumps(study)), copy.copy(study), copy.deepcopy(study)):
        assert again.sha256 == study.sha256
        assert again.analyze("full")["clearance"].sigma == study.analyze("full")["clearance"].sigma


def test_a_decorated_function_is_pickled_by_name():
    assert pickle.loads(pickle.dumps(models.clearance)) is models.clearance
    assert pickle.loads(pickle.dumps(st.model(version="3")(models.plain))).version == "3"


@pytest.mark.parametrize("run", ["analyze", "simulate", "rare", "compare"])
def test_results_come_back(run):
    study = shaft_and_bore()
    found = getattr(study, run)(**({"samples": 1000} if run != "analyze" else {}))
    again = pickle.loads(pickle.dumps(found))
    assert type(again) is type(found)
    assert again.to_dict() == found.to_dict()
    assert (str(again), again.to_html(), again.tables()) == (str(found), found.to_html(), found.tables())
    assert again.study == found.study
    # The copy can be pickled again.
    assert pickle.loads(pickle.dumps(again)).to_dict() == found.to_dict()


def test_errors_come_back():
    with pytest.raises(st.StudyError) as error:
        st.Study(dimensions={"a": st.Dimension(10, -0.3)}, characteristics={"y": st.Characteristic("a")})
    again = pickle.loads(pickle.dumps(error.value))
    assert (str(again), again.key, again.help) == (str(error.value), error.value.key, error.value.help)
    with pytest.raises(st.AnalysisError) as other:
        shaft_and_bore().analyze("full", budget=3)
    assert pickle.loads(pickle.dumps(other.value)).advice == other.value.advice


def test_entries_come_back_and_stay():
    one = st.Dimension(10, (-0.1, 0.2), unit="mm")
    assert pickle.loads(pickle.dumps(one)) == one
    assert copy.deepcopy(st.Characteristic("a", lower=1)) == st.Characteristic("a", lower=1)
    with pytest.raises(AttributeError, match="a Dimension cannot be changed: make another one"):
        one.nominal = 3
    with pytest.raises(AttributeError, match="Record cannot be changed"):
        shaft_and_bore().dimensions["bore"].sigma = 1
