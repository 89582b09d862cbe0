"""Motion of the foot: rest, rolling without slip, arrest, swing, and the signals of a sensor."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_kinematics import (
    angular_velocity,
    cross,
    point_position,
    point_signals,
    point_velocity,
    r_world_from_foot,
)
from swaystride.simulate.foot_motion import arrest
from swaystride.simulate.foot_person import draw_person
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_trial import foot_trial
from swaystride.units import GRAVITY_M_S2

SPEEDS = (1.2, 1.7, 2.3, 3.5, 5.0, 6.4)


@pytest.fixture(scope="module")
def feet(runners):
    """Trials of different people by mean speed: (foot, stances, motion, trial)."""

    @cache
    def of(speed: float, side: int = 0):
        rng = np.random.default_rng(round(100 * speed))
        person = draw_person(
            1.71, shape=runners.sole, placement=runners.placement, scatter=runners.person, rng=rng
        )
        trial = foot_trial(
            person,
            speed,
            course=runners.course,
            scatter=runners.stride,
            anchors=gait_anchors(),
            rng=rng,
        )
        foot = person.feet[side]
        stances = (trial.left, trial.right)[side]
        return foot, stances, foot_motion(foot.sole, stances), trial

    return of


def joins(stances):
    """All instants at which two pieces meet."""
    names = ("contact_s", "flat_s", "heel_off_s", "toe_off_s")
    instants = np.concatenate([getattr(stances, name) for name in names])
    arrested = stances.contact_s + stances.arrest_s
    return np.concatenate([instants, arrested])[~np.isnan(np.concatenate([instants, arrested]))]


@pytest.mark.parametrize("speed", SPEEDS)
def test_rest_is_rest(feet, speed):
    foot, stances, motion, trial = feet(speed)
    for begin, end in (
        (-1.0, stances.heel_off_s[0]),
        (stances.flat_s[-1], trial.duration_s + 1.0),
    ):
        pose = motion.pose(np.linspace(begin, end, 200))
        assert np.abs(pose.ankle_m[1:]).max() < 1e-12
        for angle in (pose.pitch_rad, pose.roll_rad):
            assert np.abs(angle).max() < 1e-12
        acc, gyr = point_signals(pose, foot.sensor_m[0])
        np.testing.assert_allclose(acc, [[0], [0], [GRAVITY_M_S2]] * np.ones((1, 200)), atol=1e-9)
        assert np.abs(gyr).max() < 1e-12


@pytest.mark.parametrize("speed", SPEEDS)
def test_both_feet_go_exactly_100_m(feet, speed):
    for side in (0, 1):
        foot, _, motion, trial = feet(speed, side)
        pose = motion.pose([0.0, trial.duration_s])
        way = pose.ankle_m[0, :, 1] - pose.ankle_m[0, :, 0]
        np.testing.assert_allclose(way, [100.0, 0.0, 0.0], atol=1e-9)
        # The sensor, too, up to how the foot is turned out at both ends.
        place = point_position(pose, foot.sensor_m[0])
        assert place[0, 1] - place[0, 0] == pytest.approx(100.0, abs=0.02)


@pytest.mark.parametrize("speed", SPEEDS)
def test_velocity_and_acceleration_are_derivatives_of_the_position(feet, speed):
    _, stances, motion, trial = feet(speed)
    time = np.random.default_rng(1).uniform(0.0, trial.duration_s, 4000)
    time = time[np.abs(time[:, None] - joins(stances)).min(axis=1) > 1e-3]
    step = 5e-6
    now, ahead, behind = (motion.pose(time + shift) for shift in (0.0, step, -step))
    for name in ("ankle_m", "pitch_rad", "roll_rad", "heading_rad"):
        value, after, before = (getattr(p, name) for p in (now, ahead, behind))
        for order in range(2):
            slope = (after[order] - before[order]) / (2 * step)
            scale = 1.0 + np.abs(value[order + 1])
            assert (np.abs(slope - value[order + 1]) / scale).max() < 1e-3


@pytest.mark.parametrize("speed", SPEEDS)
def test_position_velocity_and_acceleration_are_continuous(feet, speed):
    _, stances, motion, _ = feet(speed)
    before, after = (motion.pose(joins(stances) + shift) for shift in (-1e-7, 1e-7))
    for name in ("ankle_m", "pitch_rad", "roll_rad", "heading_rad"):
        jump = np.abs(getattr(after, name) - getattr(before, name))
        # What may change within 0.2 µs: the jerk of the arrest of a sprinter is 6e5 m/s³.
        assert jump[0].max() < 1e-5
        assert jump[1].max() < 1e-3
        assert jump[2].max() < 0.5


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_touching_point_of_a_rolling_foot_does_not_slip(feet, speed):
    foot, stances, motion, _ = feet(speed)
    for stance in range(1, len(stances) - 1):
        begin = stances.contact_s[stance] + stances.arrest_s[stance]
        pose = motion.pose(np.linspace(begin, stances.toe_off_s[stance] - 1e-9, 60))
        x, z = foot.sole.contact_m(pose.pitch_rad[0])
        point = np.stack([x, np.zeros_like(x), z])
        world = pose.ankle_m[0] + np.einsum("ijn,jn->in", r_world_from_foot(pose), point)
        assert np.abs(world[2]).max() < 1e-12
        assert np.abs(point_velocity(pose, point)).max() < 1e-6


@pytest.mark.parametrize("speed", SPEEDS)
def test_first_touch_is_the_start_of_an_arrest_of_the_prescribed_velocity(feet, speed):
    foot, stances, motion, _ = feet(speed)
    pose = motion.pose(stances.contact_s[1:])
    np.testing.assert_allclose(pose.ankle_m[1, 0], stances.impact_forward_m_s[1:], atol=1e-9)
    np.testing.assert_allclose(pose.ankle_m[1, 2], -stances.impact_down_m_s[1:], atol=1e-9)
    # The shoe gives way by half the excess velocity times the duration of the arrest.
    rolling = foot.sole.support_m(pose.pitch_rad[0]) * np.cos(pose.roll_rad[0])
    give_m = pose.ankle_m[0, 2] - rolling
    np.testing.assert_allclose(
        give_m, -motion.excess_m_s[2, 1:] * stances.arrest_s[1:] / 2, atol=1e-12
    )
    assert (give_m > 0).all()
    assert give_m.max() < 0.025


def test_the_arrest_is_a_raised_cosine():
    excess, duration = np.array([[1.0], [0.0], [-2.0]]), 0.02
    time = np.linspace(0.0, duration, 2001)
    moved = arrest(excess * np.ones(2001), time, np.full(2001, duration))
    np.testing.assert_allclose(moved[:, :, -1], 0.0, atol=1e-12)
    assert moved[2, 2].max() == pytest.approx(2 * 2.0 / duration)
    np.testing.assert_allclose(moved[1, :, 0], excess[:, 0])
    np.testing.assert_allclose(moved[0, :, 0], -excess[:, 0] * duration / 2)
    np.testing.assert_allclose(moved[2, :, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.trapezoid(moved[2], time), -excess[:, 0], atol=1e-9)


@pytest.mark.parametrize("speed", SPEEDS)
def test_the_foot_stays_above_the_ground_in_swing(feet, speed):
    foot, _, motion, trial = feet(speed)
    pose = motion.pose(np.arange(0.0, trial.duration_s, 0.002))
    clearance = pose.ankle_m[0, 2] - foot.sole.support_m(pose.pitch_rad[0]) * np.cos(
        pose.roll_rad[0]
    )
    assert clearance.min() > -0.01
    assert 0.02 < clearance.max() < 0.6


@pytest.mark.parametrize("speed", SPEEDS)
def test_angular_velocity_is_that_of_the_orientation(feet, speed):
    _, _, motion, trial = feet(speed)
    time = np.random.default_rng(2).uniform(0.0, trial.duration_s, 500)
    pose = motion.pose(time)
    omega, alpha = angular_velocity(pose)
    step = 1e-6
    ahead, behind = (motion.pose(time + s) for s in (step, -step))
    for now, (left, right) in ((omega, (behind, ahead)),):
        before, after = (np.moveaxis(r_world_from_foot(p), -1, 0) for p in (left, right))
        turned = Rotation.from_matrix(np.swapaxes(before, 1, 2) @ after).as_rotvec().T
        np.testing.assert_allclose(turned / (2 * step), now, atol=2e-4)
    slope = (angular_velocity(ahead)[0] - angular_velocity(behind)[0]) / (2 * step)
    assert (np.abs(slope - alpha) / (1.0 + np.abs(alpha))).max() < 1e-2


@pytest.mark.parametrize("speed", SPEEDS)
def test_noise_free_strapdown_returns_the_position_after_a_stride(feet, speed):
    """Integrate the ideal signals from the middle of one stance to the next (spec §9.2 a)."""
    foot, stances, motion, _ = feet(speed)
    rate, stance = 4096.0, len(stances) // 2
    begin = (stances.flat_s[stance] + stances.heel_off_s[stance]) / 2
    end = (stances.flat_s[stance + 1] + stances.heel_off_s[stance + 1]) / 2
    n = int((end - begin) * rate)
    time = begin + np.arange(2 * n + 1) / (2 * rate)
    pose = motion.pose(time)
    acc, gyr = point_signals(pose, foot.sensor_m[0])
    # Rotation and position by steps of the simulation rate, each with its middle sample.
    turns = Rotation.from_rotvec(
        (gyr[:, :-2:2] + 4 * gyr[:, 1:-1:2] + gyr[:, 2::2]).T / (6 * rate)
        + cross(gyr[:, :-2:2], gyr[:, 2::2]).T / (12 * rate**2)
    )
    rotation = [Rotation.from_matrix(r_world_from_foot(pose)[..., 0])]
    for turn in turns:
        rotation.append(rotation[-1] * turn)
    world = Rotation.concatenate(rotation).apply(acc[:, ::2].T) - [0.0, 0.0, GRAVITY_M_S2]
    velocity = point_velocity(pose, foot.sensor_m[0])[:, 0] + np.concatenate(
        [np.zeros((1, 3)), np.cumsum((world[1:] + world[:-1]) / (2 * rate), axis=0)]
    )
    moved = ((velocity[1:] + velocity[:-1]) / (2 * rate)).sum(axis=0)
    place = point_position(pose, foot.sensor_m[0])
    assert np.abs(moved - (place[:, -1] - place[:, 0])).max() < 1e-3


@pytest.mark.parametrize(
    ("speed", "low", "high"),
    [
        (1.2, 0.0, 0.02),
        (1.7, 0.0, 0.02),
        (2.3, 0.02, 0.2),
        (3.5, 0.03, 0.2),
        (5.0, 0.03, 0.2),
        (6.4, 0.03, 0.2),
    ],
)
def test_speed_of_the_sensor_when_it_turns_least(feet, speed, low, high):
    """Spec §9.2 g for running; a walker's foot is almost still."""
    foot, stances, motion, _ = feet(speed)
    forward = []
    for stance in range(2, len(stances) - 2):
        time = np.arange(stances.contact_s[stance], stances.toe_off_s[stance], 0.001)
        pose = motion.pose(time)
        least = np.argmin(np.linalg.norm(angular_velocity(pose)[0], axis=0))
        forward.append(point_velocity(pose, foot.sensor_m[0])[0, least])
    assert low <= np.median(forward) <= high


def test_sagittal_motion_of_a_sole_without_roll_is_planar(feet):
    foot, stances, _, _ = feet(3.5)
    still = {
        name: np.zeros(len(stances))
        for name in (
            "heading_rad",
            "contact_roll_rad",
            "flat_roll_rad",
            "toe_off_roll_rad",
            "swing_roll_rad",
            "swing_turn_rad",
            "y_m",
        )
    }
    motion = foot_motion(foot.sole, replace(stances, **still))
    pose = motion.pose(np.linspace(0.0, 30.0, 3000))
    assert np.abs(pose.ankle_m[:, 1]).max() < 1e-12
    omega, _ = angular_velocity(pose)
    assert np.abs(omega[[0, 2]]).max() < 1e-12
    np.testing.assert_allclose(omega[1], -pose.pitch_rad[1], atol=1e-12)
