"""Alignment of the walking chain from its sensors alone; turns; wrong sides."""

import numpy as np
import pytest

from swaystride.erkf.alignment import (
    anatomical_frame,
    level_mounting,
    main_axis,
    pointing_right,
    standing_vertical,
    straight_samples,
)
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map
from swaystride.units import GRAVITY_M_S2

LEGS = ((1, 3, 5), (2, 4, 6))


def angle_deg(one, two):
    return np.degrees(np.arccos(np.clip(one @ two, -1.0, 1.0)))


def test_legs_of_the_chain_turn_about_their_right(walk):
    keep = np.ones(walk.gyr.shape[2], bool)
    for thigh, shank, foot in LEGS:
        found = {}
        for j in (shank, thigh, foot):
            mounting = walk.body.r_anatomical_from_sensor[j]
            main = main_axis(walk.gyr[j], mounting[1], keep)
            reference = None if j == shank else found[shank] @ walk.gyr[shank]
            found[j] = pointing_right(main.axis, walk.gyr[j], shank_rate=reference)
            assert abs(main.axis @ mounting[1]) < 1e-12
            # the feet of the chain turn out by 7° and in and out in swing
            assert angle_deg(found[j], mounting[2]) < (15.0 if j == foot else 8.0)
        assert (
            main_axis(walk.gyr[shank], walk.body.r_anatomical_from_sensor[shank][1], keep).share
            > 0.8
        )


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


def test_a_mounting_that_disagrees_is_an_error(walk):
    right = walk.body.r_anatomical_from_sensor[3][2]
    np.testing.assert_array_equal(pointing_right(-right, walk.gyr[3], prior=right), right)
    with pytest.raises(RecordingError, match="right_shank: movement and mounting disagree"):
        pointing_right(right, walk.gyr[3], prior=-right, place="right_shank")


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


def standing(mounting, n=40):
    """Gravity in sensors whose segments are upright."""
    return np.repeat(GRAVITY_M_S2 * mounting[:, 1, :, None], n, axis=2)


def swinging(mounting, rng, rate_hz=100.0, duration_s=10.0):
    """Segments turn about their right: short and fast forward, long and slow back."""
    time = np.arange(round(rate_hz * duration_s)) / rate_hz
    rate = 3.0 * np.sin(2 * np.pi * time)
    rate = np.where(rate > 0, 2.0 * rate, 0.7 * rate)
    size = rng.uniform(0.5, 1.5, size=7)
    return mounting[:, 2, :, None] * (size[:, None, None] * rate)


@pytest.mark.parametrize("seed", range(3))
def test_any_mounting_of_upright_swinging_segments_is_found(seed):
    rng = np.random.default_rng(seed)
    mounting = exp_map(rng.normal(scale=1.5, size=(7, 3)))
    settings = {"pelvis_right": mounting[0, 2], "rate_hz": 100.0, "cutoff_hz": 15.0}
    gyr = swinging(mounting, rng)
    found = level_mounting(standing(mounting), gyr, **settings)
    np.testing.assert_allclose(found, mounting, atol=1e-9)
    # a slanted pelvis sensor keeps its vertical; the path turns where it is not asked
    gyr[:, :, 300:600] += 8.0 * mounting[:, 0, :, None]
    keep = np.ones(gyr.shape[2], bool)
    keep[250:650] = False
    found = level_mounting(
        standing(mounting),
        gyr,
        keep=keep,
        **settings | {"pelvis_right": mounting[0, 2] + 0.3 * mounting[0, 1]},
    )
    np.testing.assert_allclose(found, mounting, atol=1e-3)


def test_mounting_of_the_chain_from_its_walk(walk):
    """Its segments are neither exactly upright nor turn about one axis: some degrees, no side wrong."""
    truth = walk.body.r_anatomical_from_sensor
    found = level_mounting(
        standing(truth), walk.gyr, pelvis_right=truth[0, 2], rate_hz=100.0, cutoff_hz=15.0
    )
    for j in range(7):
        np.testing.assert_allclose(found[j, 1], truth[j, 1], atol=1e-12)
        assert angle_deg(found[j, 2], truth[j, 2]) < (15.0 if j > 4 else 8.0)


def test_a_frame_needs_movement():
    mounting = np.repeat(np.eye(3)[None], 7, axis=0)
    with pytest.raises(RecordingError, match="no movement"):
        level_mounting(
            standing(mounting),
            np.zeros((7, 3, 300)),
            pelvis_right=mounting[0, 2],
            rate_hz=100.0,
            cutoff_hz=15.0,
        )
