"""Main axis, vertical and frame of a segment in closed form; turns of the path.

Legs of a walking chain are aligned in ``tests/erkf/test_alignment.py``, those of a simulated person
in ``tests/gait/test_sensor_alignment.py``.
"""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.signals.segment_alignment import (
    anatomical_frame,
    main_axis,
    standing_vertical,
    straight_samples,
)


def angle_deg(one, two):
    return np.degrees(np.arccos(np.clip(one @ two, -1.0, 1.0)))


def test_a_turn_of_the_path_does_not_draw_the_axis_to_itself():
    rng = np.random.default_rng(1)
    time = np.arange(3000) / 100.0
    swing = 3.0 * np.sin(2 * np.pi * time)
    turning = np.where((time > 10) & (time < 14), 4.0, 0.0)
    pelvis = np.stack([0 * time, 0 * time, turning])
    up = np.array([0.0, 0.0, 1.0])
    keep = straight_samples(pelvis, up, 100.0, cutoff_hz=0.4, limit_rad_s=0.3)
    assert 0.6 < keep.mean() < 0.9
    assert not keep[1050:1350].any()
    # in the turn the leg is tilted, so that a part of it is horizontal
    leg = np.stack([0.5 * turning, -swing, turning]) + 0.05 * rng.normal(size=(3, 3000))
    found = main_axis(leg, up, keep)
    assert angle_deg(np.abs(found.axis), np.array([0.0, 1.0, 0.0])) < 2.0
    assert found.share > 0.95
    assert found.off_horizontal_rad < 0.1


def test_uncertainty_of_the_axis_is_that_of_repeated_noise():
    time = np.arange(1000) / 100.0
    up = np.array([0.0, 0.0, 1.0])
    axes, sd = [], []
    for seed in range(200):
        rate = np.stack([0 * time, 2.0 * np.sin(time), 0 * time])
        rate += 0.2 * np.random.default_rng(seed).normal(size=rate.shape)
        found = main_axis(rate, up, np.ones(1000, bool))
        axes.append(found.axis[0] * np.sign(found.axis[1]))
        sd.append(found.sd_rad)
    assert np.std(axes) == pytest.approx(np.mean(sd), rel=0.2)


def test_no_movement_is_an_error():
    with pytest.raises(RecordingError, match="no movement"):
        main_axis(np.zeros((3, 10)), np.array([0.0, 0.0, 1.0]), np.ones(10, bool))


def test_frame_keeps_the_vertical_and_is_a_rotation():
    rng = np.random.default_rng(2)
    vertical = standing_vertical(rng.normal(size=3)[:, None] + 0.01 * rng.normal(size=(3, 50)))
    r = anatomical_frame(vertical, rng.normal(size=3))
    np.testing.assert_allclose(r @ r.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(r) == pytest.approx(1.0)
    np.testing.assert_allclose(r @ vertical, [0.0, 1.0, 0.0], atol=1e-12)
