"""Noise sets: printed numbers, and the same random walk at any rate."""

import math

import pytest

from swaystride.erkf.noise import NOISE_SETS, RUNNING_PRINTED, RUNNING_SWAPPED, WALKING
from swaystride.erkf.options import PRINTED_OPTIONS, RECOMMENDED_OPTIONS


def test_a_second_adds_the_same_variance_at_any_rate():
    for rate_hz in (100.0, 200.0, 500.0):
        step = RUNNING_PRINTED.step_noise(rate_hz, with_bias=True)
        assert math.sqrt(rate_hz * step[3]) == pytest.approx(0.0127, abs=5e-5)  # m/s per √s
        assert math.degrees(math.sqrt(rate_hz * step[6])) == pytest.approx(0.17, abs=0.005)
        assert math.sqrt(rate_hz * step[9]) == pytest.approx(5e-5)
        assert step[:3] == [0.0] * 3


def test_nine_states_have_no_noise_of_bias():
    assert len(WALKING.step_noise(200.0, with_bias=False)) == 9


def test_printed_degrees_are_chords():
    """Table 4.2 prints 45.84° and 57.30°: 0.8 and 1 as differences of unit vectors."""
    assert RUNNING_PRINTED.knee_axis_sd == pytest.approx(0.800, abs=1e-3)
    assert WALKING.hip_axis_sd == pytest.approx(1.0, abs=1e-3)
    assert WALKING.knee_axis_sd == pytest.approx(0.020, abs=1e-3)


def test_swapped_exchanges_hip_and_knee_only():
    assert RUNNING_SWAPPED.hip_axis_sd == RUNNING_PRINTED.knee_axis_sd
    assert RUNNING_SWAPPED.knee_axis_sd == RUNNING_PRINTED.hip_axis_sd
    assert RUNNING_SWAPPED.knee_centre_sd_m == RUNNING_PRINTED.knee_centre_sd_m
    assert set(NOISE_SETS) == {"recommended", "running_printed", "running_swapped", "walking"}


def test_white_errors_are_not_inflated():
    assert PRINTED_OPTIONS.joint_inflation(200.0) == 1.0
    assert RECOMMENDED_OPTIONS.joint_inflation(1000.0) == RECOMMENDED_OPTIONS.joint_inflation(50.0)
