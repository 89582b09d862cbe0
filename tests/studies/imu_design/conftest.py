"""A cohort of measures with known slopes, study tables as a lab writes them, and a foot that rolls."""

import numpy as np
import pandas as pd
import pytest

from swaystride.studies.imu_design.experiments import (
    EXPERIMENTS,
    ExperimentSettings,
    effect_names,
)
from swaystride.studies.imu_design.plan import ImuDesignPlan

SETTINGS = ExperimentSettings(
    accelerometer_ranges_g=(100.0, 75.0, 50.0, 24.0, 16.0, 10.0, 6.0),
    gyro_ranges_deg_s=(2000.0, 1500.0, 1000.0, 750.0, 500.0),
    rates_hz=(1000.0, 500.0, 250.0, 125.0, 62.5),
    decimation_order=8,
    decimation_ripple_db=0.05,
    decimation_edge=0.8,
)

#: Printed slopes of Tables A1 to A4: baseline first, then differences from it.
SLOPES = {
    "accelerometer_range": (-0.39, 0.0, -0.03, -0.57, -1.08, -2.24, -5.70),
    "gyro_range": (-0.41, 0.0, 0.05, -0.40, -3.08),
    "downsampling": (-1.12, -0.09, -0.13, -0.26, 0.94),
    "decimation": (-1.17, -0.01, -0.03, 0.08, 0.12),
}

PARTICIPANTS = """participant\tsex\tage_years\theight_m\tmass_kg
A\tF\t21\t1.62\t55
B\tM\t30\t1.81\t80
"""
TRIALS = """participant\ttrial\tfoot\timu\tfile\tdistance_m\texclude
A\t01\tleft\timu_1\tA/1_left_1.csv\t100\t
A\t01\tleft\timu_2\tA/1_left_2.csv\t100\t
A\t01\tright\timu_1\tA/1_right_1.csv\t100\t
A\t01\tright\timu_2\tA/1_right_2.csv\t100\t
A\t02\tleft\timu_1\tA/2_left_1.csv\t100\t
A\t02\tleft\timu_2\tA/2_left_2.csv\t100\tstrap came off
B\t01\tright\timu_1\tB/1_right_1.csv\t60\t
B\t01\tright\timu_2\tB/1_right_2.csv\t60\t
"""


def draw_observations(*, seed=1, participant_sd=0.0, trial_sd=0.0, row_sd=0.0):
    """Observations whose slopes over speed are those of :data:`SLOPES`, plus scatter."""
    rng = np.random.default_rng(seed)
    rows = []
    for person in range(6):
        own = rng.normal(0, participant_sd)
        for trial in range(10):
            speed, of_trial = 1.2 + 0.55 * trial + 0.03 * person, rng.normal(0, trial_sd)
            for experiment, slopes in SLOPES.items():
                names = effect_names(experiment, SETTINGS)
                levels = SETTINGS.levels(experiment)
                truncates = experiment in ("accelerometer_range", "gyro_range")
                for at, (name, level) in enumerate(zip(names, levels, strict=True)):
                    slope = slopes[0] + (slopes[at] if at else 0.0)
                    error = 1.0 + slope * speed + own + of_trial + rng.normal(0, row_sd)
                    rows.append(
                        {
                            "participant": f"P{person + 1:02d}",
                            "trial": f"{trial + 1:02d}",
                            "experiment": experiment,
                            "condition": name,
                            "level": level,
                            "speed_m_s": speed,
                            "error_pct": error,
                            "loss_percent": 0.5 * at * speed if truncates else np.nan,
                            "length_difference_sd_m": 0.01 * at * speed,
                            "angle_difference_sd_deg": 0.1 * at * speed,
                            "n_feet": 2,
                            "n_strides": 60,
                        }
                    )
    table = pd.DataFrame(rows)
    order = {name: at for at, name in enumerate(EXPERIMENTS)}
    return table.sort_values(
        ["experiment", "level", "participant", "trial"],
        key=lambda x: x.map(order) if x.name == "experiment" else -x if x.name == "level" else x,
        ignore_index=True,
    )


def make_plan(**changes):
    values = {
        "trial_intercept": False,
        "confidence_level": 0.95,
        "significance_level": 0.05,
        "distance_error_limit_pct": 5.0,
        "sample_walking_speed_m_s": 1.4,
        "sample_running_speed_m_s": 5.8,
    }
    return ImuDesignPlan(**(values | changes))


@pytest.fixture(scope="session")
def settings():
    return SETTINGS


@pytest.fixture(scope="session")
def slopes():
    return SLOPES


@pytest.fixture(scope="session")
def plan():
    return make_plan()


@pytest.fixture(scope="session")
def plan_with():
    """A plan with some choices changed."""
    return make_plan


@pytest.fixture(scope="session")
def observations_with():
    """The generator of observations itself."""
    return draw_observations


@pytest.fixture
def folder(tmp_path):
    """Study tables as a lab writes them."""
    (tmp_path / "participants.tsv").write_text(PARTICIPANTS, encoding="utf-8")
    (tmp_path / "trials.tsv").write_text(TRIALS, encoding="utf-8")
    return tmp_path
