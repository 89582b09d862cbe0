from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values
from swaystride.simulate import (
    experience_parameters,
    imu_design_parameters,
    kinematics_parameters,
)
from swaystride.simulate.experience_parameters import ExperienceCohort
from swaystride.simulate.feedback_parameters import FeedbackCohort, cohort_from_config
from swaystride.simulate.imu_design_parameters import ImuDesignCohort
from swaystride.simulate.kinematics_parameters import KinematicsCohort
from swaystride.simulate.running_body import RunnerBody, runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import (
    NO_VARIABILITY,
    USUAL_VARIABILITY,
    RunnerManner,
    RunVariability,
    steady_run,
)
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_run import Treadmill, run_motion


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


@pytest.fixture(scope="session")
def treadmill_runners() -> KinematicsCohort:
    """The published cohort of the kinematics study."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "kinematics.yaml")
    return kinematics_parameters.cohort_from_config(plain_values(tree["simulation"]))


@pytest.fixture(scope="session")
def path_runners() -> ExperienceCohort:
    """The published cohort of the experience study."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "experience.yaml")
    return experience_parameters.cohort_from_config(plain_values(tree["simulation"]))


@pytest.fixture(scope="session")
def run_variability() -> RunVariability:
    """Scatter of a usual runner from stride to stride (spec §9.1, step 9)."""
    return USUAL_VARIABILITY


@pytest.fixture(scope="session")
def usual_body() -> RunnerBody:
    """Body of the methods: 1.72 m, 70 kg."""
    return runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())


@pytest.fixture(scope="session")
def runs(usual_body, run_variability) -> Callable[..., RunningMotion]:
    """Runs by speed and length, with scatter or without, overground or on a belt."""

    @cache
    def of(speed_m_s, duration_s=20.0, scatter=True, belt_dip=None) -> RunningMotion:
        return run_motion(
            usual_body,
            RunnerManner(),
            steady_run(duration_s, speed_m_s),
            duration_s=duration_s,
            variability=run_variability if scatter else NO_VARIABILITY,
            rng=np.random.default_rng(round(100 * speed_m_s)),
            treadmill=None if belt_dip is None else Treadmill(belt_dip),
        )

    return of
