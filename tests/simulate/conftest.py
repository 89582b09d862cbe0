import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values
from swaystride.simulate import imu_design_parameters
from swaystride.simulate.feedback_parameters import FeedbackCohort, cohort_from_config
from swaystride.simulate.imu_design_parameters import ImuDesignCohort


@pytest.fixture(scope="session")
def cohort() -> FeedbackCohort:
    """The published cohort."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "feedback.yaml")
    return cohort_from_config(plain_values(tree["simulation"]))


@pytest.fixture(scope="session")
def runners() -> ImuDesignCohort:
    """The published cohort of the IMU-design study."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "imu_design.yaml")
    return imu_design_parameters.cohort_from_config(plain_values(tree["simulation"]))
