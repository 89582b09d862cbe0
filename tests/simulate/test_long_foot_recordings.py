"""The trajectory on simulated feet: neither the length of a recording nor a bias moves its error."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.strides import distance_m, stride_table
from swaystride.gait.trajectory import foot_trajectory
from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_trial import foot_trial
from swaystride.simulate.imu_design_cohort import person_of
from swaystride.simulate.imu_design_recordings import sensor_signals, sensor_unit

PARTICIPANT = "P01"
SEED = 11
BIAS_RAD_S = np.radians(0.1)


@pytest.fixture(scope="module")
def walks(runners):
    """Acceleration and rate of IMU 1 on one walking foot, over 5 min and over 30 s."""
    person = person_of(PARTICIPANT, 1.75, runners, SEED)
    foot = person.feet[0]
    unit = sensor_unit(foot, runners.imu_1, PARTICIPANT, "imu_1", SEED)

    def of(length_m):
        rng = np.random.default_rng(SEED)
        course = replace(runners.course, distance_m=length_m)
        trial = foot_trial(
            person, 1.3, course=course, scatter=runners.stride, anchors=gait_anchors(), rng=rng
        )
        return sensor_signals(
            foot_motion(foot.sole, trial.left),
            foot.sensor_m[0],
            runners.imu_1,
            unit,
            duration_s=trial.duration_s,
            rng=rng,
        )

    return {length_m: of(length_m) for length_m in (40.0, 390.0)}


def error_percent(signals, length_m, bias_rad_s=0.0):
    acc, gyr = signals
    trajectory = foot_trajectory(acc, gyr + bias_rad_s, 128.0, RECOMMENDED)
    return 100.0 * (distance_m(stride_table(trajectory)) / length_m - 1.0)


def test_five_minutes_are_no_worse_than_thirty_seconds(walks):
    short, long = (error_percent(walks[length], length) for length in (40.0, 390.0))
    assert walks[390.0][0].shape[1] > 290 * 128
    assert abs(long - short) <= 0.2


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_bias_of_the_gyroscope_moves_nothing(walks, axis):
    bias = np.zeros((3, 1))
    bias[axis] = BIAS_RAD_S
    for length in (40.0, 390.0):
        plain = error_percent(walks[length], length)
        assert abs(error_percent(walks[length], length, bias) - plain) <= 0.2
