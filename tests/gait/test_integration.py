"""Integration of the gyroscope against closed forms."""

import numpy as np
import pytest

from swaystride.gait.integration import integrated_orientation
from swaystride.rotations import exp_map, log_map, matrix_from_quaternion

RATE_HZ = 200.0
STILL = np.array([1.0, 0.0, 0.0, 0.0])


def start_quaternion(seed):
    q = np.random.default_rng(seed).standard_normal(4)
    return q / np.linalg.norm(q)


def missed_deg(one, two):
    return np.degrees(np.linalg.norm(log_map(np.swapaxes(one, -1, -2) @ two), axis=-1))


@pytest.mark.parametrize("seed", [1, 2])
def test_a_steady_turn_about_any_axis_is_exact(seed):
    omega = np.random.default_rng(seed).standard_normal(3)
    n, start = 1001, start_quaternion(seed)
    found = integrated_orientation(np.tile(omega[:, None], n), RATE_HZ, start)
    time_s = np.arange(n) / RATE_HZ
    expected = matrix_from_quaternion(start) @ exp_map(time_s[:, None] * omega)
    assert missed_deg(matrix_from_quaternion(found), expected).max() < 1e-6
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)


def test_it_begins_with_the_start():
    start = start_quaternion(3)
    found = integrated_orientation(np.ones((3, 4)), RATE_HZ, start)
    assert missed_deg(*(matrix_from_quaternion(q) for q in (found[0], start))) < 1e-9
    assert found.shape == (4, 4)


def test_a_swing_comes_back_within_the_error_of_the_second_order():
    """Two degrees of freedom at the rates of a running foot: no commutation is left out."""
    time_s = np.arange(0.0, 3.0, 1.0 / RATE_HZ)

    def rotation(t):
        pitch = exp_map(np.outer(np.sin(9.0 * t), [0.0, 0.0, 0.9]))
        return pitch @ exp_map(np.outer(np.sin(7.0 * t), [0.4, 0.0, 0.0]))

    h = 1e-5
    gyr = log_map(np.swapaxes(rotation(time_s - h), 1, 2) @ rotation(time_s + h)) / (2.0 * h)
    found = integrated_orientation(gyr.T, RATE_HZ, STILL)
    assert missed_deg(matrix_from_quaternion(found), rotation(time_s)).max() < 0.2


def test_nothing_stops_the_drift_of_a_bias():
    bias = np.radians([0.0, 0.0, 0.5])
    found = integrated_orientation(np.tile(bias[:, None], 4001), RATE_HZ, STILL)
    drift = missed_deg(matrix_from_quaternion(found), np.eye(3))
    np.testing.assert_allclose(drift[[2000, 4000]], [5.0, 10.0], rtol=1e-6)
