"""Joint centres and starts from the sensors of the chain alone."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_chain import RUNNING, chain
from scipy.spatial.transform import Rotation

from swaystride.erkf.body import LOWER_LIMB_JOINTS, SEGMENTS
from swaystride.erkf.imu_initialisation import (
    MID_SHANK_CENTRES,
    CentreSearch,
    chain_positions,
    chain_velocities,
    facing_forward,
    imu_centres,
    level_orientations,
    start_at_rest,
    start_in_stance,
)
from swaystride.erkf.lower_limbs import estimate_lower_limbs
from swaystride.erkf.noise import RECOMMENDED_NOISE
from swaystride.erkf.options import RECOMMENDED_OPTIONS
from swaystride.erkf.start import START_AT_REST, START_IN_MOTION
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map, matrix_from_quaternion
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

SEARCH = CentreSearch(
    cutoff_hz=45.0, rough_sd_m=0.1, pelvis_sd_m=0.02, noise_m_s2=0.3, independent_s=1.0
)


@pytest.fixture(scope="module")
def moving():
    return chain(RUNNING, duration_s=12.0, rate_hz=200.0, seed=3)


def joint_gaps(position, velocity, rotation, gyr, body):
    """Between both images of every joint centre: distances and differences of velocity."""
    gaps = []
    for joint in body.joints:
        images = []
        for segment, lever in (
            (joint.proximal, joint.proximal_centre_m),
            (joint.distal, joint.distal_centre_m),
        ):
            j = body.index(segment)
            turning = rotation[j] @ np.cross(gyr[j], lever)
            images.append(np.r_[position[j] + rotation[j] @ lever, velocity[j] + turning])
        gaps.append(images[0] - images[1])
    return np.array(gaps)


@pytest.mark.parametrize("foot", ["right_foot", "left_foot"])
def test_joints_close_and_the_contact_point_rests(moving, foot):
    """For any orientations and rates, not only for those of a chain in motion."""
    rng = np.random.default_rng(7)
    body, rotation = moving.body, Rotation.random(7, rng=rng).as_matrix()
    gyr = rng.normal(scale=3.0, size=(7, 3))
    position = chain_positions(rotation, body)
    velocity = chain_velocities(rotation, gyr, body, foot)
    assert not position[0].any()
    np.testing.assert_allclose(joint_gaps(position, velocity, rotation, gyr, body), 0.0, atol=1e-12)
    ground = body.index(foot)
    rolling = rotation[ground] @ np.cross(gyr[ground], body.contact_levers_m[foot])
    np.testing.assert_allclose(velocity[ground] + rolling, 0.0, atol=1e-12)


def test_the_moving_chain_is_met_exactly(moving):
    """Where a foot of the chain stands, its true positions and velocities come out."""
    for row, foot in enumerate(moving.body.contact_levers_m):
        for sample in np.flatnonzero(moving.stance[row])[[3, 40, 90]]:
            rotation = moving.rotation[sample]
            position = chain_positions(rotation, moving.body)
            truth = moving.position[sample] - moving.position[sample, 0]
            np.testing.assert_allclose(position, truth, atol=1e-9)
            velocity = chain_velocities(rotation, moving.gyr[:, :, sample], moving.body, foot)
            np.testing.assert_allclose(velocity, moving.velocity[sample], atol=1e-6)


def test_everybody_faces_forward_whatever_the_headings(moving):
    segment = moving.rotation @ np.swapaxes(moving.body.r_anatomical_from_sensor, 1, 2)
    stride = round(2 * RUNNING.stride_s * moving.rate_hz)
    headings = np.random.default_rng(1).uniform(-np.pi, np.pi, size=7)
    turned = exp_map(np.outer(headings, [0.0, 0.0, 1.0])) @ segment
    plain, found = (facing_forward(one, slice(0, stride)) for one in (segment, turned))
    np.testing.assert_allclose(found, plain, atol=1e-12)
    right = found[:stride, :, :, 2].mean(axis=0)
    np.testing.assert_allclose(right[:, 0], 0.0, atol=1e-12)
    assert (right[:, 1] < 0.0).all()
    # a turn about the vertical only: heights of all axes stay
    np.testing.assert_allclose(found[:, :, 2], segment[:, :, 2], atol=1e-12)


def test_inclinations_are_those_of_a_person_who_stands():
    rng = np.random.default_rng(5)
    truth = Rotation.random(3, rng=rng).as_matrix()
    up = truth[:, 2]
    acc = np.repeat(GRAVITY_M_S2 * up[:, :, None], 600, axis=2)
    found = level_orientations(acc, np.zeros_like(acc), 100.0)
    assert found.shape == (600, 3, 3, 3)
    np.testing.assert_allclose(found[300, :, 2], up, atol=1e-4)


def test_a_start_at_rest_is_a_standing_chain(moving):
    rotation = moving.rotation[0]
    bias = np.full((7, 3), 0.01)
    start = start_at_rest(rotation, moving.body, bias, START_AT_REST)
    assert not start.velocity_m_s.any()
    np.testing.assert_array_equal(start.gyr_bias_rad_s, bias)
    np.testing.assert_allclose(
        matrix_from_quaternion(start.q_world_from_sensor), rotation, atol=1e-12
    )
    np.testing.assert_allclose(start.position_m, chain_positions(rotation, moving.body))
    start.states()


def test_the_first_foot_that_stands_starts(moving):
    flags = np.zeros((2, 100), bool)
    flags[1, 30:40] = True
    flags[0, 35:50] = True
    start = start_in_stance(
        moving.rotation[:60], moving.gyr, flags, moving.body, np.zeros((7, 3)), START_IN_MOTION
    )
    assert start[0] == 30
    expected = chain_velocities(moving.rotation[30], moving.gyr[:, :, 30], moving.body, "left_foot")
    np.testing.assert_allclose(start[1].velocity_m_s, expected, atol=1e-12)
    with pytest.raises(RecordingError, match="no foot on the ground"):
        start_in_stance(
            moving.rotation[:20], moving.gyr, flags, moving.body, np.zeros((7, 3)), START_IN_MOTION
        )


def estimated(moving, sample, start):
    later = replace(moving, acc=moving.acc[:, :, sample:], gyr=moving.gyr[:, :, sample:])
    noise = replace(RECOMMENDED_NOISE, hip_axis_sd=None, zero_velocity_sd_m_s=0.02)
    found = estimate_lower_limbs(
        later.recording(),
        moving.body,
        moving.stance[:, sample:],
        noise,
        start=start,
        options=RECOMMENDED_OPTIONS,
    )
    angles = found["joint_angle"].transpose("time", "joint", "angle").to_numpy()
    return (angles - moving.angles[sample:]) / RAD_PER_DEG


def test_a_start_in_mid_run_comes_to_the_true_one(moving):
    """Orientations by VQF, faced forward; after ten strides nearly as good as the truth."""
    segment = level_orientations(moving.acc, moving.gyr, moving.rate_hz) @ np.swapaxes(
        moving.body.r_anatomical_from_sensor, 1, 2
    )
    strides = slice(0, round(8 * RUNNING.stride_s * moving.rate_hz))
    rotation = facing_forward(segment, strides) @ moving.body.r_anatomical_from_sensor
    sample, start = start_in_stance(
        rotation, moving.gyr, moving.stance, moving.body, np.zeros((7, 3)), START_IN_MOTION
    )
    errors = estimated(moving, sample, start)
    best = estimated(moving, 0, moving.start(START_IN_MOTION))
    settled = round(10 * RUNNING.stride_s * moving.rate_hz)
    rms = [np.sqrt(np.mean(e**2)) for e in (errors[:100], errors[settled:], best[settled:])]
    assert rms[0] > 1.0
    assert rms[1] < 0.3
    assert rms[2] < 0.1


def anatomical(vectors, body, joint):
    one, two = body.index(joint.proximal), body.index(joint.distal)
    mounting = body.r_anatomical_from_sensor
    return mounting[one] @ vectors[0], mounting[two] @ vectors[1]


def test_centres_of_all_joints_from_rough_vectors(moving):
    """Rough vectors 3 cm off; what movement tells is found, along the axis of a knee it is not."""
    rough = {}
    for place, (kind, side, _, _) in enumerate(LOWER_LIMB_JOINTS):
        joint = moving.body.joints[place]
        centres = (joint.proximal_centre_m, joint.distal_centre_m)
        if side == "right":
            rough[kind] = tuple(
                tuple(v + np.array([0.02, -0.02, 0.01]))
                for v in anatomical(centres, moving.body, joint)
            )
    found = imu_centres(
        moving.acc,
        moving.gyr,
        moving.body.r_anatomical_from_sensor,
        moving.rate_hz,
        rough=rough,
        search=SEARCH,
    )
    assert list(found) == [joint.name for joint in moving.body.joints]
    for joint in moving.body.joints:
        if joint.side == "left":
            continue
        fit = found[joint.name]
        truth = anatomical((joint.proximal_centre_m, joint.distal_centre_m), moving.body, joint)
        own = anatomical((fit.proximal_m, fit.distal_m), moving.body, joint)
        axes = slice(0, 2) if joint.kind == "knee" else slice(0, 3)
        limit = 0.02 if joint.kind == "hip" else 0.012
        for one, two in zip(own, truth, strict=True):
            assert np.abs(one - two)[axes].max() < limit
            assert np.abs(one - two).max() < 2 * SEARCH.rough_sd_m


def test_left_rough_vectors_are_mirrored(moving):
    """With a tight prior the vectors are the rough ones, z turned round on the left."""
    tight = replace(SEARCH, rough_sd_m=1e-7, pelvis_sd_m=1e-7)
    mounting = moving.body.r_anatomical_from_sensor
    found = imu_centres(
        moving.acc[:, :, :400],
        moving.gyr[:, :, :400],
        mounting,
        moving.rate_hz,
        rough=MID_SHANK_CENTRES,
        search=tight,
    )
    thigh, shank = SEGMENTS.index("left_thigh"), SEGMENTS.index("left_shank")
    proximal, distal = MID_SHANK_CENTRES["knee"]
    mirror = np.array([1.0, 1.0, -1.0])
    fit = found["left_knee"]
    np.testing.assert_allclose(mounting[thigh] @ fit.proximal_m, proximal * mirror, atol=1e-5)
    np.testing.assert_allclose(mounting[shank] @ fit.distal_m, distal * mirror, atol=1e-5)
