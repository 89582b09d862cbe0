import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values
from swaystride.simulate.feedback_parameters import FeedbackCohort, cohort_from_config


@pytest.fixture(scope="session")
def cohort() -> FeedbackCohort:
    """The published cohort."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "feedback.yaml")
    return cohort_from_config(plain_values(tree["simulation"]))
