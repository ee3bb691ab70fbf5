import os
import sys
import warnings

import pytest

import sensitol as st

sys.path.insert(0, os.path.dirname(__file__))
REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

FORMULA = "bore - shaft/cos(tilt*deg)"


def pytest_configure(config):
    # Its message counts on the numbers of the study; tests of warnings ask for them.
    warnings.simplefilter("always")
    config.addinivalue_line("filterwarnings", "ignore::sensitol.SensitolWarning")


def shaft_and_bore(model=None, **more):
    """The README's study, by a formula or by a model."""
    formula = None if model is not None else FORMULA
    return st.Study(
        "Shaft and bore",
        dimensions={
            "bore": st.Dimension(25.020, 0.010, unit="mm"),
            "shaft": st.Dimension(24.980, (-0.013, 0.0), unit="mm"),
            "tilt": st.Dimension(0.0, 1.5, unit="deg", distribution="uniform"),
        },
        characteristics={"clearance": st.Characteristic(formula, unit="mm", lower=0.02, upper=0.07, target_yield=0.999)},
        model=model,
        **more,
    )


@pytest.fixture
def study():
    return shaft_and_bore()


@pytest.fixture
def repository():
    return REPOSITORY
