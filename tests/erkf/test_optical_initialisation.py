"""Mounting, centres and start of the chain when an optical system sees its segments."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_chain import RUNNING, STANDING, chain
from scipy.spatial.transform import Rotation

from swaystride.erkf.optical_initialisation import (
    OpticalPoses,
    mounting_from_rates,
    mounting_from_static,
    optical_centres,
    optical_start,
    segment_rates,
    sensor_rotations,
)
from swaystride.erkf.start import START_IN_MOTION
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map, matrix_from_quaternion
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

BELT_M_S = 2.5
NO_BIAS = np.zeros((7, 3))


@pytest.fixture(scope="module")
def moving():
    return chain(RUNNING, duration_s=5.0, rate_hz=200.0, seed=6)


@pytest.fixture(scope="module")
def poses(moving):
    """The chain on a treadmill whose belt moves to -x."""
    mounting = moving.body.r_anatomical_from_sensor
    time = np.arange(len(moving.position)) / moving.rate_hz
    back = np.outer(time, [-BELT_M_S, 0.0, 0.0])
    centres = {}
    for joint in moving.body.joints:
        j = moving.body.index(joint.proximal)
        centre = moving.position[:, j] + moving.rotation[:, j] @ joint.proximal_centre_m
        centres[joint.name] = centre + back
    return OpticalPoses(
        moving.rotation @ np.swapaxes(mounting, 1, 2),
        centres,
        moving.position + back[:, None],
        moving.rate_hz,
    )


def apart_deg(one, two):
    between = np.swapaxes(one, -1, -2) @ two
    return np.degrees(Rotation.from_matrix(between.reshape(-1, 3, 3)).magnitude())


def test_rates_of_segments_are_those_of_their_sensors(moving, poses):
    found = segment_rates(poses.r_world_from_segment, moving.rate_hz)
    own = np.einsum("jab,jbn->jan", moving.body.r_anatomical_from_sensor, moving.gyr)
    # the mean over two samples; swings turn by up to 30 °/s within one
    np.testing.assert_allclose(found[:, :, 1:-1], own[:, :, 1:-1], atol=0.2)
    assert np.isnan(found[:, :, [0, -1]]).all()


def test_a_lost_segment_costs_its_neighbours_only(poses):
    r = poses.r_world_from_segment.copy()
    r[50, 3] = np.nan
    lost = np.isnan(segment_rates(r, poses.rate_hz)).any(axis=1)
    assert np.flatnonzero(lost[3]).tolist() == [0, 49, 51, len(r) - 1]
    assert np.flatnonzero(lost[2]).tolist() == [0, len(r) - 1]


def test_mounting_from_rates_whatever_the_world(moving, poses):
    truth = moving.body.r_anatomical_from_sensor
    settings = {"rate_hz": moving.rate_hz, "cutoff_hz": 40.0}
    found = mounting_from_rates(poses.r_world_from_segment, moving.gyr, **settings)
    assert apart_deg(found, truth).max() < 0.5
    turned = Rotation.random(rng=np.random.default_rng(1)).as_matrix() @ poses.r_world_from_segment
    again = mounting_from_rates(turned, moving.gyr, **settings)
    np.testing.assert_allclose(again, found, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(found), 1.0, atol=1e-12)


def test_mounting_from_rates_is_exact_for_matching_rates(poses):
    """Rates of the segments themselves, seen from turned sensors, unfiltered: no error is left."""
    slow = exp_map(np.stack([np.sin(np.arange(2000) * s / 400.0) for s in (1.0, 0.7, 1.3)], axis=1))
    r = np.repeat(slow[:, None], 7, axis=1)
    truth = Rotation.random(7, rng=np.random.default_rng(2)).as_matrix()
    rate = segment_rates(r, 400.0)
    rate[:, :, 0], rate[:, :, -1] = rate[:, :, 1], rate[:, :, -2]
    gyr = np.einsum("jba,jbn->jan", truth, rate)
    found = mounting_from_rates(r, gyr, rate_hz=400.0, cutoff_hz=150.0)
    assert apart_deg(found, truth).max() < 1e-3


def test_a_segment_that_is_not_seen_or_hardly_turns_has_no_mounting(moving, poses):
    lost = poses.r_world_from_segment.copy()
    lost[:, 4] = np.nan
    still = poses.r_world_from_segment.copy()
    still[:, 4] = still[0, 4]
    hinge = poses.r_world_from_segment.copy()
    hinge[:, 4] = exp_map(np.outer(np.sin(np.arange(len(hinge)) / 30.0), [0.0, 0.0, 1.0]))
    for r in (lost, still, hinge):
        with pytest.raises(RecordingError, match="left_shank: no turning"):
            mounting_from_rates(r, moving.gyr, rate_hz=moving.rate_hz, cutoff_hz=40.0)


def test_mounting_from_standing_and_running():
    """Segments that stand askew; running turns about the axis that points right in the laboratory."""
    rng = np.random.default_rng(9)
    stance = STANDING @ exp_map(5.0 * RAD_PER_DEG * rng.normal(size=(7, 3)))
    truth = Rotation.random(7, rng=rng).as_matrix()
    r_world_from_sensor = stance @ truth
    up = r_world_from_sensor[:, 2]
    acc = np.repeat(GRAVITY_M_S2 * up[:, :, None], 50, axis=2)
    right = -r_world_from_sensor[:, 1]
    time = np.arange(800) / 200.0
    # a short fast swing forward, a long slow one back
    swing = 4.0 * np.sin(2 * np.pi * 1.4 * time) + 2.0 * np.cos(4 * np.pi * 1.4 * time + np.pi)
    swing = np.where(swing > 0, 3.0 * swing, 0.5 * swing)
    gyr = right[:, :, None] * swing
    found = mounting_from_static(
        acc, gyr, stance, pelvis_right=right[0], rate_hz=200.0, cutoff_hz=15.0
    )
    assert apart_deg(found, truth).max() < 1e-4


def test_centres_are_those_of_the_body(moving, poses):
    mounting = moving.body.r_anatomical_from_sensor
    seen = replace(poses, sensor_position_m=poses.sensor_position_m.copy())
    seen.sensor_position_m[100:150, 3] = np.nan
    found = optical_centres(seen, mounting)
    for joint in moving.body.joints:
        one, two = found[joint.name]
        np.testing.assert_allclose(one, joint.proximal_centre_m, atol=1e-9)
        np.testing.assert_allclose(two, joint.distal_centre_m, atol=1e-9)
    np.testing.assert_allclose(sensor_rotations(poses, mounting), moving.rotation, atol=1e-12)


def test_a_centre_that_is_never_seen_is_an_error(moving, poses):
    centres = poses.centres_m | {"left_hip": np.full_like(poses.centres_m["left_hip"], np.nan)}
    with pytest.raises(RecordingError, match="left_hip"):
        optical_centres(replace(poses, centres_m=centres), moving.body.r_anatomical_from_sensor)


def started(poses, moving, **options):
    settings = {"belt_speed_m_s": BELT_M_S, "gyr_bias_rad_s": NO_BIAS} | options
    return optical_start(poses, moving.body.r_anatomical_from_sensor, START_IN_MOTION, **settings)


def test_start_moves_with_the_belt(moving, poses):
    sample, start = started(poses, moving, first=40)
    assert sample == 40
    # central differences of 200 Hz: the feet change by 60 m/s² within a swing
    np.testing.assert_allclose(start.velocity_m_s, moving.velocity[40], atol=0.01)
    np.testing.assert_allclose(
        matrix_from_quaternion(start.q_world_from_sensor), moving.rotation[40], atol=1e-12
    )
    _, still = started(poses, moving, first=40, belt_speed_m_s=0.0)
    np.testing.assert_allclose(start.velocity_m_s - still.velocity_m_s, [[BELT_M_S, 0.0, 0.0]] * 7)


def test_start_is_the_first_sample_seen_with_both_neighbours(moving, poses):
    assert started(poses, moving)[0] == 1
    gaps = replace(
        poses,
        sensor_position_m=poses.sensor_position_m.copy(),
        r_world_from_segment=poses.r_world_from_segment.copy(),
    )
    gaps.sensor_position_m[:7, 2] = np.nan
    gaps.r_world_from_segment[10:12, 6] = np.nan
    assert started(gaps, moving)[0] == 8
    assert started(gaps, moving, first=9)[0] == 13
    gaps.sensor_position_m[::3, 0] = np.nan
    with pytest.raises(RecordingError, match="sees no start"):
        started(gaps, moving)
