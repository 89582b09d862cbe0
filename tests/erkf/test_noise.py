"""Noise sets: printed numbers, and the same random walk at any rate."""

import math
from dataclasses import replace

import numpy as np
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


def test_changing_signals_add_the_square_of_what_a_step_may_miss():
    noise = replace(WALKING, acc_step_share=0.05, gyr_step_share=0.02)
    signals = np.random.default_rng(1).normal(size=(50, 7, 6))
    found = noise.integration_noise(signals, 200.0)
    assert found.shape == (50, 7, 2)
    assert not found[0].any()
    for k, j in ((1, 0), (20, 3), (49, 6)):
        acc = np.linalg.norm(signals[k, j, :3] - signals[k - 1, j, :3])
        gyr = np.linalg.norm(signals[k, j, 3:] - signals[k - 1, j, 3:])
        assert found[k, j, 0] == pytest.approx((0.05 * acc / 200.0) ** 2)
        assert found[k, j, 1] == pytest.approx((0.02 * gyr / 200.0) ** 2)


def test_steady_signals_and_nil_shares_add_nothing():
    signals = np.random.default_rng(2).normal(size=(30, 7, 6))
    assert not WALKING.integration_noise(signals, 100.0).any()
    noise = replace(WALKING, acc_step_share=0.05, gyr_step_share=0.02)
    assert not noise.integration_noise(np.repeat(signals[:1], 30, axis=0), 100.0).any()
    only_acc = replace(noise, gyr_step_share=0.0).integration_noise(signals, 100.0)
    assert not only_acc[:, :, 1].any()
    assert (only_acc[1:, :, 0] > 0.0).all()


def test_at_twice_the_rate_the_same_movement_adds_an_eighth_per_second():
    """Steps are half as long, changes half as large, and there are twice as many."""
    noise = replace(WALKING, acc_step_share=0.05)
    added = []
    for rate_hz in (100.0, 200.0):
        time = np.arange(round(rate_hz) + 1) / rate_hz
        signals = np.zeros((len(time), 1, 6))
        signals[:, 0, 0] = 5.0 * np.sin(2 * np.pi * time)
        added.append(noise.integration_noise(signals, rate_hz)[:, 0, 0].sum())
    assert added[1] / added[0] == pytest.approx(1 / 8, rel=0.01)


def test_a_refused_constraint_is_believed_after_whole_samples():
    assert RECOMMENDED_OPTIONS.patience(200.0) == 300
    assert replace(RECOMMENDED_OPTIONS, longest_refusal_s=0.013).patience(100.0) == 1
    assert PRINTED_OPTIONS.patience(200.0) == np.iinfo(np.int64).max
