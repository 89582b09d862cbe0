"""Alignment of the walking chain from its sensors alone; turns; wrong sides."""

import numpy as np
import pytest

from swaystride.erkf.alignment import level_mounting
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map
from swaystride.signals.segment_alignment import main_axis, pointing_right
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


def test_a_mounting_that_disagrees_is_an_error(walk):
    right = walk.body.r_anatomical_from_sensor[3][2]
    np.testing.assert_array_equal(pointing_right(-right, walk.gyr[3], prior=right), right)
    with pytest.raises(RecordingError, match="right_shank: movement and mounting disagree"):
        pointing_right(right, walk.gyr[3], prior=-right, place="right_shank")


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
