"""Start: velocity of poses, belt frame, covariance of tilt and heading."""

import numpy as np
import pytest

from swaystride.erkf.start import START_AT_REST, START_IN_MOTION, start_from_poses
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map
from swaystride.units import RAD_PER_DEG


def test_velocity_is_the_central_difference_in_the_frame_of_the_belt(walk):
    rotation = walk.rotation[:50]
    start = start_from_poses(
        walk.position[:50] - np.arange(50)[:, None, None] * [0.03, 0.0, 0.0],
        rotation,
        100.0,
        START_IN_MOTION,
        sample=20,
        frame_velocity_m_s=np.array([3.0, 0.0, 0.0]),
    )
    # at 3 m/s a belt moves back by 0.03 m per sample; in its frame everybody walks overground
    np.testing.assert_allclose(start.velocity_m_s, walk.velocity[20], atol=0.02)
    states = start.states()
    assert states.shape == (7, 13)
    assert not states[:, 10:].any()


@pytest.mark.parametrize("sample", [0, 49])
def test_the_ends_have_no_central_difference(walk, sample):
    with pytest.raises(RecordingError, match="between 1 and 48"):
        start_from_poses(
            walk.position[:50], walk.rotation[:50], 100.0, START_AT_REST, sample=sample
        )


def test_tilt_and_heading_are_about_world_axes(walk):
    start = start_from_poses(walk.position[:9], walk.rotation[:9], 100.0, START_AT_REST)
    p = start.covariance(with_bias=True)
    np.testing.assert_array_equal(p, p.T)
    for j, r in enumerate(walk.rotation[1]):
        o = 12 * j
        world = r @ p[o + 6 : o + 9, o + 6 : o + 9] @ r.T
        expected = np.diag(np.square([3.0, 3.0, 5.0])) * RAD_PER_DEG**2
        np.testing.assert_allclose(world, expected, atol=1e-12)
        assert p[o + 9, o + 9] == pytest.approx((0.5 * RAD_PER_DEG) ** 2)
    nine = start.covariance(with_bias=False)
    assert nine.shape == (63, 63)
    assert not np.triu(nine, 9)[:9].any()


def test_a_rotation_error_in_sensor_axes_is_a_tilt_in_the_world(walk):
    """The local error of a heading change is R^T e_z, whatever the mounting."""
    r = walk.rotation[0, 3]
    turned = exp_map([0.0, 0.0, 0.01]) @ r
    local = r.T @ turned
    vector = np.array([local[2, 1], local[0, 2], local[1, 0]]) / 0.01
    np.testing.assert_allclose(vector, r[2], atol=0.01)
