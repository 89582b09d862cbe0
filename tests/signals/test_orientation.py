"""Orientation: axes are remapped as frames, the vertical is found."""

import itertools

import numpy as np
import pytest

from swaystride.errors import ConfigurationError, RecordingError
from swaystride.signals.orientation import remap_axes, up_in_sensor

NAMES = [f"{sign}{axis}" for sign in ("", "-") for axis in "xyz"]
UNIT = {name: np.eye(3)["xyz".index(name[-1])] * (-1 if "-" in name else 1) for name in NAMES}


def test_exactly_the_24_right_handed_frames_are_accepted():
    accepted = 0
    for forward, left, up in itertools.product(NAMES, repeat=3):
        right_handed = np.allclose(np.cross(UNIT[forward], UNIT[left]), UNIT[up]) and any(UNIT[up])
        if right_handed:
            body = remap_axes(
                np.stack([UNIT[n] for n in (forward, left, up)], axis=1),
                forward=forward,
                left=left,
                up=up,
            )
            np.testing.assert_array_equal(body, np.eye(3))
            accepted += 1
        else:
            with pytest.raises(ConfigurationError, match="not a right-handed frame"):
                remap_axes(np.eye(3), forward=forward, left=left, up=up)
    assert accepted == 24


def test_an_unknown_axis_is_named():
    with pytest.raises(
        ConfigurationError, match=r"unknown sensor axis; expected ±x, ±y or ±z; found w"
    ):
        remap_axes(np.eye(3), forward="w", left="y", up="z")


@pytest.mark.parametrize("method", ["vqf", "offline_vqf"])
def test_the_vertical_is_found_at_rest(method):
    direction = np.array([0.48, -0.6, 0.64])
    acc = np.tile(9.81 * direction[:, None], 600)
    up = up_in_sensor(acc, 0 * acc, rate_hz=100.0, tau_acc_s=3.0, method=method)
    np.testing.assert_allclose(up[:, -1], direction, atol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(up, axis=0), 1.0, rtol=1e-9)


def test_missing_samples_are_refused():
    acc = np.full((3, 100), np.nan)
    with pytest.raises(RecordingError, match="missing samples"):
        up_in_sensor(acc, np.zeros((3, 100)), rate_hz=100.0, tau_acc_s=3.0, method="vqf")
