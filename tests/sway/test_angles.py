"""Trunk angles against a known lean, with biased and tilted sensors."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from swaystride.sway.angles import trunk_angles
from swaystride.units import GRAVITY_M_S2

RATE_HZ = 100.0
TIME_S = np.arange(3000) / RATE_HZ


def sensor_at(lean_deg, right_deg, r_body_from_sensor=None):
    """Signals of a sensor that turns in place: pitch about the left axis, then roll."""
    pose = Rotation.from_euler("YX", np.stack([lean_deg, right_deg], axis=1), degrees=True)
    if r_body_from_sensor is not None:
        pose = pose * r_body_from_sensor
    acc = pose.inv().apply([0.0, 0.0, GRAVITY_M_S2]).T
    gyr = (pose[:-1].inv() * pose[1:]).as_rotvec().T * RATE_HZ
    return acc, np.concatenate([gyr, gyr[:, -1:]], axis=1)


def slow(amplitude_deg, frequency_hz):
    return amplitude_deg * np.sin(2 * np.pi * frequency_hz * TIME_S)


@pytest.mark.parametrize("method", ["vqf", "offline_vqf"])
def test_leaning_forward_and_to_the_right_is_positive(method):
    lean, right = slow(2.0, 0.3), slow(1.0, 0.2)
    ap_deg, ml_deg = trunk_angles(*sensor_at(lean, right), RATE_HZ, method=method)
    assert np.abs(ap_deg - lean)[500:].max() < 0.05
    assert np.abs(ml_deg - right)[500:].max() < 0.05


def test_levelling_undoes_a_tilted_belt():
    """A sensor pitched by 25° sees the same sway after tilt correction."""
    lean, right = slow(1.5, 0.3), slow(1.5, 0.2)
    tilted = Rotation.from_euler("Y", 25.0, degrees=True)
    acc, gyr = sensor_at(lean, right, tilted)
    ap_deg, ml_deg = trunk_angles(acc, gyr, RATE_HZ, method="offline_vqf", level=True)
    assert np.std(ap_deg - lean) < 0.03
    assert np.std(ml_deg - right) < 0.03
    _, ml_unlevelled = trunk_angles(acc, gyr, RATE_HZ, method="offline_vqf", level=False)
    assert np.std(ml_unlevelled - right) > 0.08
