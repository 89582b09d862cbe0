"""The compiled kernel against plain twins: coordinates, feet, pelvis, inverse kinematics, chain."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from swaystride.simulate._running_coordinates import impact_pulse, rolling, step_height
from swaystride.simulate._running_kernel import (
    ELBOW,
    HEAD_ANGLES,
    HIP_ROTATION,
    KNEE_ADDUCTION,
    KNEE_ROTATION,
    PELVIS_ANGLES,
    SHOULDER,
    TRUNK_ANGLES,
    two_link_angles,
)
from swaystride.simulate._running_points import segment_states
from swaystride.simulate.running_manner import fourier
from swaystride.simulate.running_pelvis import pelvis_height, pelvis_steps, rise_over_contact_m
from swaystride.units import GRAVITY_M_S2


def joint(angles):
    """Rz(α) Rx(β) Ry(γ), plain."""
    return Rotation.from_euler("ZXY", angles).as_matrix()


@pytest.fixture(scope="module")
def sampled(runs):
    motion = runs(3.5, belt_dip=0.02)
    time = np.sort(np.random.default_rng(2).uniform(0.5, 19.5, 300))
    q, states, channels, belt = segment_states(motion.tables, time)
    return motion, time, q, states[:, :13], channels, belt


@given(
    st.tuples(*[st.floats(-0.5, 0.5)] * 2),
    st.floats(0.1, 2.2),
    st.floats(-0.9, 1.4),
    st.tuples(*[st.floats(-3.0, 3.0)] * 9),
)
def test_two_links_close_exactly_and_their_angles_are_derivatives(betas, knee, hip, rates):
    links = np.array([0.43, 0.41])
    rotation, adduction = betas

    def leg(hip_angle, hip_beta, hip_gamma, knee_angle, knee_beta):
        shank = joint([hip_angle, hip_beta, hip_gamma]) @ joint([knee_angle, knee_beta, 0.0])
        down = np.array([0.0, -1.0, 0.0])
        return joint([hip_angle, hip_beta, hip_gamma]) @ down * links[0] + shank @ down * links[1]

    # The ankle moves as a polynomial of time about a place that the leg can reach.
    place = leg(hip, 0.1, rotation, -knee, adduction)
    speed, bend = np.reshape(rates[:6], (2, 3)) * 0.2

    def solve(t):
        w = place + speed * t + bend * t * t / 2
        jets = tuple((w[i], speed[i] + bend[i] * t, bend[i]) for i in range(3))
        turn = (rotation + rates[6] * t, rates[6], 0.0)
        side = (adduction + 0.1 * rates[7] * t, 0.1 * rates[7], 0.0)
        return two_link_angles(jets, links, turn, side), turn, side, w

    (found_knee, found_hip, found_beta), turn, side, w = solve(0.0)
    closed = leg(found_hip[0], found_beta[0], turn[0], found_knee[0], side[0])
    np.testing.assert_allclose(closed, w, atol=1e-9)
    assert found_knee[0] == pytest.approx(-knee, abs=1e-9)
    step = 1e-5
    (ahead, *_), (behind, *_) = solve(step), solve(-step)
    for now, later, before in zip((found_knee, found_hip, found_beta), ahead, behind, strict=True):
        # Close to a straight leg the angles change fast, and differences lose digits.
        scale = 1.0 + abs(now[1]) + abs(now[2])
        assert abs((later[0] - before[0]) / (2 * step) - now[1]) < 1e-5 * scale
        assert abs((later[1] - before[1]) / (2 * step) - now[2]) < 1e-4 * scale * scale


def test_periodic_coordinates_equal_their_plain_sums(sampled):
    motion, time, q, *_ = sampled
    tables = motion.tables
    for side, rows in ((0, range(7)), (1, range(7)), (2, range(7, 19))):
        contact = tables.contact_s[side]
        stride = np.searchsorted(contact, time, side="right") - 1
        start = tables.phase[side, :, 0]
        piece = np.searchsorted(start, time, side="right") - 1
        u = time - start[piece]
        phase = sum(tables.phase[side, piece, 1 + k] * u**k for k in range(6))
        x = (time - contact[stride]) / (contact[stride + 1] - contact[stride])
        blend = x**3 * (10 - 15 * x + 6 * x * x)
        for row in rows:
            wave = fourier(tables.fourier[side, row, :12], phase)[0]
            low, high = (
                table[side][stride + shift, row]
                for table, shift in ((tables.offset, 0), (tables.offset, 1))
            )
            small, large = (tables.amplitude[side][stride + shift, row] for shift in (0, 1))
            plain = low + (high - low) * blend + (small + (large - small) * blend) * wave
            np.testing.assert_allclose(q[:, side, row, 0], plain, atol=1e-12)


def test_feet_equal_the_foot_simulator(sampled):
    motion, time, _, states, *_ = sampled
    for side in range(2):
        pose = motion.feet[side].pose(time)
        for order in range(3):
            at = slice(15 + 3 * order, 18 + 3 * order)
            np.testing.assert_allclose(
                states[:, 5 + side, at].T, pose.ankle_m[order], rtol=1e-11, atol=1e-11
            )
        turned = Rotation.from_euler(
            "ZXY",
            np.stack([pose.heading_rad[0], pose.roll_rad[0], -pose.pitch_rad[0]], axis=-1),
        ).as_matrix()
        # Foot axes x to the toes, y left, z up; segment axes x anterior, y up, z right.
        isb = turned[:, :, [0, 2, 1]] * [1.0, 1.0, -1.0]
        np.testing.assert_allclose(states[:, 5 + side, :9].reshape(-1, 3, 3), isb, atol=1e-12)


def test_the_chain_equals_a_plain_twin(sampled):
    motion, time, q, states, *_ = sampled
    joints = motion.body.joints_m()
    rotations = states[..., :9].reshape(len(time), 13, 3, 3)
    places = states[..., 15:18]

    def angles(side, first):
        return q[:, side, first : first + 3, 0]

    def check(child, parent, turn):
        np.testing.assert_allclose(
            rotations[:, child], rotations[:, parent] @ joint(turn), atol=1e-12
        )

    upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    np.testing.assert_allclose(
        rotations[:, 0], upright @ joint(angles(2, PELVIS_ANGLES)), atol=1e-12
    )
    check(7, 0, angles(2, TRUNK_ANGLES))
    check(8, 7, angles(2, HEAD_ANGLES))
    for side in range(2):
        check(9 + side, 7, angles(1 - side, SHOULDER))
        elbow = q[:, 1 - side, ELBOW, 0]
        check(11 + side, 9 + side, np.stack([elbow, 0 * elbow, 0 * elbow], axis=-1))
        # What inverse kinematics is given, the chain shows.
        hip = Rotation.from_matrix(
            np.swapaxes(rotations[:, 0], 1, 2) @ rotations[:, 1 + side]
        ).as_euler("ZXY")
        knee = Rotation.from_matrix(
            np.swapaxes(rotations[:, 1 + side], 1, 2) @ rotations[:, 3 + side]
        ).as_euler("ZXY")
        np.testing.assert_allclose(hip[:, 2], q[:, side, HIP_ROTATION, 0], atol=1e-12)
        np.testing.assert_allclose(knee[:, 1], q[:, side, KNEE_ADDUCTION, 0], atol=1e-12)
        np.testing.assert_allclose(knee[:, 2], q[:, side, KNEE_ROTATION, 0], atol=1e-12)
    for child, parent in (
        (1, 0),
        (2, 0),
        (3, 1),
        (4, 2),
        (7, 0),
        (9, 7),
        (10, 7),
        (11, 9),
        (12, 10),
    ):
        carried = places[:, parent] + rotations[:, parent] @ joints[child]
        np.testing.assert_allclose(places[:, child], carried, atol=1e-11)


def test_the_sole_rolls_as_in_the_foot_simulator(usual_body, runs):
    tables = runs(3.5).tables
    pitch = np.linspace(-2.0, 0.9, 400)
    plain = usual_body.sole.rolling(pitch)
    compiled = np.array([rolling(tables.sole, tables.edges, angle) for angle in pitch]).T
    np.testing.assert_allclose(compiled, plain, atol=1e-13)


def test_the_pelvis_is_pushed_up_and_falls_freely():
    contact = np.cumsum([0.0, 0.35, 0.36, 0.34, 0.35, 0.36])
    steps = pelvis_steps(contact, contact + 0.2, np.full(6, 0.9))
    for row, (begin, lasts) in enumerate(steps[:, :2]):
        for inside, expected in (
            (begin + 0.5 * lasts, None),
            (begin + lasts + 0.05, -GRAVITY_M_S2),
        ):
            height, speed, acceleration = step_height(steps, inside, row)
            assert height == pytest.approx(pelvis_height(steps, [inside])[0], abs=1e-12)
            step = 1e-4
            around = pelvis_height(steps, [inside - step, inside, inside + step])
            assert speed == pytest.approx((around[2] - around[0]) / (2 * step), abs=1e-5)
            if expected is not None:
                assert acceleration == pytest.approx(expected, abs=1e-12)
    # Nothing jumps from step to step.
    for row in range(len(steps) - 1):
        before = step_height(steps, contact[row + 1], row)
        after = step_height(steps, contact[row + 1], row + 1)
        np.testing.assert_allclose(before, after, atol=1e-9)


def test_equal_steps_have_the_half_wave_of_the_methods():
    step, lasts = 0.35, 0.2
    contact = step * np.arange(8)
    steps = pelvis_steps(contact, contact + lasts, np.full(8, 0.9))
    np.testing.assert_allclose(steps[:-1, 4], np.pi * GRAVITY_M_S2 * step / (2 * lasts))
    np.testing.assert_allclose(steps[:-1, 5], 0.0, atol=1e-9)
    time = np.linspace(step, 2 * step, 20001)
    height = pelvis_height(steps, time)
    assert np.trapezoid(height, time) / step == pytest.approx(0.9, abs=1e-8)
    assert height[0] - 0.9 == pytest.approx(-float(rise_over_contact_m(lasts, step)), abs=1e-8)


@pytest.mark.parametrize("kind", range(5))
def test_an_impact_pulse_is_smooth_and_ends(runs, kind):
    pulses = runs(3.5).tables.pulses
    time = np.linspace(-0.01, 0.5, 25501)
    value, first, second = np.array([impact_pulse(pulses, kind, t) for t in time]).T
    assert value[0] == 0.0
    assert value[-1] == 0.0
    step = time[1] - time[0]
    assert np.abs(np.gradient(value, step) - first)[1:-1].max() < 3e-3 * np.abs(first).max()
    assert np.abs(np.gradient(first, step) - second)[1:-1].max() < 1e-2 * np.abs(second).max()
    assert max(second if kind < 2 else value) == pytest.approx(1.0, abs=1e-3)
