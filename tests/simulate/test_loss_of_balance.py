"""Loss of balance: a plain twin, the closed form of the fall, the catch, and what never falls."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import ConfigurationError
from swaystride.simulate._falling_kernel import integrate_falling_pendulums
from swaystride.simulate.inertial_sensor import trunk_signals
from swaystride.simulate.loss_of_balance import LossOfBalance
from swaystride.simulate.seeds import generator
from swaystride.simulate.standing_body import StandingParameters, falling_paths, simulate_standing

RATE_HZ = 1000.0
STEP_S = 1.0 / RATE_HZ
W2 = 9.80665 / (1.1 * 0.9)
RAIL = LossOfBalance(6.0, 0.3, 0.5, largest_deg=20.0, catch_s=1.0)
HARD = StandingParameters(
    mass_kg=70.0,
    pendulum_height_m=0.9,
    inertia_factor=1.1,
    stiffness_ratio=1.20,
    damping_nm_s_rad=220.0,
    delay_s=0.14,
    noise_ap_nm=9.0,
    noise_ml_nm=8.0,
    noise_time_s=0.7,
    noise_coupling=0.0,
    lean_drift_deg=0.0,
    lean_drift_period_s=60.0,
    breathing_deg=0.0,
    breathing_hz=0.25,
)


def plain_twin(
    normals, sd, memory, w2, k, d, delay, step, start, threshold, largest, reactions, n_catch
):
    """Phase after phase in plain Python; the quintic from its six boundary conditions."""
    theta, omega = [np.array(start)[:, 0]], [np.array(start)[:, 1]]
    noise = [np.array(sd) * normals[:, 0]]
    for i in range(1, normals.shape[1]):
        noise.append(memory * noise[-1] + math.sqrt(1 - memory**2) * np.array(sd) * normals[:, i])
    n_steps, losses, reactions = normals.shape[1], [], list(reactions)

    def advance(torque):
        omega.append(omega[-1] + step * w2 * torque)
        theta.append(theta[-1] + step * omega[-1])

    while len(theta) <= n_steps:
        i = len(theta) - 1
        if np.hypot(*theta[i]) <= threshold:
            past = max(i - delay, 0)
            advance(np.sin(theta[i]) - k * theta[past] - d * omega[past] + noise[i])
            continue
        losses.append(i)
        for _ in range(reactions.pop(0)):
            if np.hypot(*theta[-1]) >= largest or len(theta) > n_steps:
                break
            advance(np.sin(theta[-1]))
        acceleration = w2 * np.sin(theta[-1])
        velocity = omega[-1] + step / 2 * acceleration
        T = n_catch * step
        ends = np.array([[x**p for p in range(6)] for x in (0.0, T)])
        slopes = np.array([[p * x ** max(p - 1, 0) for p in range(6)] for x in (0.0, T)])
        bends = np.array([[p * (p - 1) * x ** max(p - 2, 0) for p in range(6)] for x in (0.0, T)])
        conditions = np.stack([ends[0], slopes[0], bends[0], ends[1], slopes[1], bends[1]])
        zero = np.zeros(2)
        wanted = np.stack([theta[-1], velocity, acceleration, zero, zero, zero])
        coefficients = np.linalg.solve(conditions, wanted)
        for m in range(1, n_catch + 1):
            if len(theta) > n_steps:
                break
            target = np.array([(m * step) ** p for p in range(6)]) @ coefficients
            omega.append((target - theta[-1]) / step)
            theta.append(target)
    return np.array(theta).T, np.array(omega).T, losses


def falling(normals, *, start, sd=(0.0, 0.0), threshold=0.1, largest=0.5, reactions=(), n_catch=9):
    """The kernel with the usual body."""
    arguments = (
        np.ascontiguousarray(normals, dtype=np.float64),
        np.array(sd),
        0.998,
        W2,
        1.3,
        0.4,
        120,
        STEP_S,
        np.array(start, dtype=np.float64),
        threshold,
        largest,
        np.array(reactions, dtype=np.int64),
        n_catch,
    )
    return arguments, integrate_falling_pendulums(*arguments)


def losing_runs(n_runs, body=HARD, rail=RAIL, n_steps=60_000):
    for i in range(n_runs):
        rng = generator(31, "losing", f"{i}")
        yield falling_paths(body, rail, n_steps=n_steps, rate_hz=RATE_HZ, rng=rng)


@pytest.fixture(scope="module")
def runs():
    """Runs of a minute, and in them whole losses: first index, of the catch, and of its end."""
    collected = []
    for angle, rate, losses in losing_runs(20):
        acceleration = np.diff(rate, axis=1) * RATE_HZ
        whole = []
        for loss in losses.tolist():
            # The fall lasts as long as the acceleration is that of a free pendulum.
            free = np.abs(acceleration - W2 * np.sin(angle[:, :-1])).max(axis=0) < 1e-6
            catch = loss + int(np.argmin(free[loss:]))
            if catch + 1000 < angle.shape[1] - 1:
                whole.append((loss, catch, catch + 1000))
        collected.append((angle, rate, acceleration, whole))
    assert sum(len(whole) for *_, whole in collected) > 20
    return collected


@pytest.mark.parametrize(
    ("seed", "start"),
    [
        (0, ((0.0, 0.0), (0.0, 0.0))),
        (1, ((0.03, 0.1), (-0.02, 0.0))),
        (2, ((0.2, 0.0), (0.1, -0.3))),
    ],
)
def test_kernel_equals_its_plain_twin(seed, start):
    rng = np.random.default_rng(seed)
    reactions = rng.integers(0, 300, size=30)
    arguments, (angle, rate, losses) = falling(
        rng.standard_normal((2, 6000)),
        sd=(0.03, 0.025),
        start=start,
        threshold=0.07,
        largest=0.15,
        reactions=reactions,
        n_catch=250,
    )
    plain_angle, plain_rate, plain_losses = plain_twin(*arguments)
    assert losses.tolist() == plain_losses
    assert len(losses) > 2
    np.testing.assert_allclose(angle, plain_angle, rtol=0, atol=1e-11)
    np.testing.assert_allclose(rate, plain_rate, rtol=0, atol=1e-8)


@pytest.mark.parametrize("noise_nm", [0.0, 3.0])
def test_who_keeps_the_balance_moves_as_without_the_limit(noise_nm):
    body = replace(HARD, noise_ap_nm=noise_nm, noise_ml_nm=noise_nm, noise_coupling=0.3)
    body = replace(body, lean_drift_deg=0.2, breathing_deg=0.05)
    rngs = [np.random.default_rng(3), np.random.default_rng(3)]
    free, limited = (
        simulate_standing(
            body, n_samples=30_000, rate_hz=RATE_HZ, warm_up_s=9.0, rng=rng, loss_of_balance=rail
        )
        for rng, rail in zip(rngs, (None, RAIL), strict=True)
    )
    assert limited.loss_times_s == free.loss_times_s == ()
    for name in ("angle_rad", "velocity_rad_s", "acceleration_rad_s2"):
        np.testing.assert_array_equal(getattr(limited, name), getattr(free, name))
    # The stream that goes on to the sensor is the same, too.
    assert rngs[0].random() == rngs[1].random()


def test_the_motion_before_the_first_loss_is_that_without_the_limit():
    for i, (angle, _, losses) in enumerate(losing_runs(5)):
        rng = generator(31, "losing", f"{i}")
        free = simulate_standing(HARD, n_samples=60_000, rate_hz=RATE_HZ, warm_up_s=0.0, rng=rng)
        first = losses[0] + 1
        np.testing.assert_array_equal(angle[:, :first], free.angle_rad[:, :first])


def test_a_loss_is_a_crossing_of_the_threshold_and_each_crossing_is_a_loss(runs):
    for angle, _, _, whole in runs:
        inclination = np.rad2deg(np.hypot(*angle))
        losing = np.zeros(inclination.size, dtype=bool)
        for loss, _, end in whole:
            assert inclination[loss] > 6.0
            assert inclination[loss - 1] <= 6.0
            losing[loss:end] = True
        last = whole[-1][2] if whole else 0
        assert np.all(inclination[:last][~losing[:last]] <= 6.0)


def test_the_fall_ends_after_the_reaction_or_at_the_largest_inclination(runs):
    for angle, _, _, whole in runs:
        inclination = np.rad2deg(np.hypot(*angle))
        for loss, catch, end in whole:
            assert np.all(inclination[loss:catch] < 20.0)
            # One step of a fall of at most some 100 °/s beyond the limit.
            assert inclination[catch] < 20.1
            assert inclination[loss:end].max() < 20.0 * 1.7
            np.testing.assert_allclose(angle[:, end], 0.0, atol=1e-15)


def test_reaction_times_are_those_drawn_or_cut_by_the_limit(runs):
    drawn, cut = [], 0
    for i, (angle, _, _, whole) in enumerate(runs):
        child = generator(31, "losing", f"{i}").spawn(1)[0]
        steps = RAIL.draw_reaction_steps(60_000, RATE_HZ, child)
        for number, (loss, catch, _) in enumerate(whole):
            if np.rad2deg(np.hypot(*angle[:, catch])) >= 20.0:
                cut += 1
                assert catch - loss <= steps[number]
            else:
                drawn.append(catch - loss)
                assert catch - loss == steps[number]
    assert len(set(drawn)) > 10
    assert cut > 0


def test_motion_is_smooth_from_the_fall_through_the_catch(runs):
    for angle, rate, acceleration, whole in runs:
        np.testing.assert_allclose(np.diff(angle, axis=1), rate[:, 1:] * STEP_S, atol=1e-14)
        assert np.all(np.isfinite(acceleration))
        for loss, catch, end in whole:
            # Continuous acceleration changes by jerk · step. With angle A, velocity V and
            # acceleration B (in units of the duration, 1 s), the jerk of the catch is at most
            # 60 A + 36 V + 9 B, at its beginning.
            start = np.abs([angle[:, catch], rate[:, catch + 1], acceleration[:, catch]])
            bound = np.array([60.0, 36.0, 9.0]) @ start
            steps = np.abs(np.diff(acceleration[:, loss:end], axis=1))
            assert np.all(steps < 1.05 * bound[:, None] * STEP_S + 1e-6)
            # One step before the end only a step of jerk is left.
            assert np.all(np.abs(acceleration[:, end - 1]) < bound * STEP_S)
            assert np.all(np.abs(rate[:, end]) < bound * STEP_S**2)


def test_at_the_loss_the_acceleration_jumps_by_the_torque_that_is_gone(runs):
    delay, damping_s = 140, 220.0 / HARD.gravity_torque_nm
    for angle, rate, acceleration, whole in runs:
        for loss, catch, _ in whole:
            if catch == loss:
                continue
            control = -1.2 * angle[:, loss - 1 - delay] - damping_s * rate[:, loss - 1 - delay]
            noise = acceleration[:, loss - 1] / W2 - np.sin(angle[:, loss - 1]) - control
            jump = acceleration[:, loss] - acceleration[:, loss - 1]
            gone = np.sin(angle[:, loss]) - np.sin(angle[:, loss - 1]) - control - noise
            np.testing.assert_allclose(jump, W2 * gone, atol=1e-9)
            assert np.all(np.abs(noise) < 6 * 9.0 / HARD.gravity_torque_nm)


def test_control_goes_on_from_the_history_of_the_catch():
    # Without noise: the first step after the catch answers the path one delay before.
    _, (angle, rate, losses) = falling(
        np.zeros((2, 800)), start=[[0.11, 0.2], [0.03, 0.0]], reactions=[100] * 3, n_catch=300
    )
    assert losses.tolist() == [0]
    past = 400 - 120
    control = -1.3 * angle[:, past] - 0.4 * rate[:, past]
    assert np.all(np.abs(control) > 1e-4)
    acceleration = (rate[:, 401] - rate[:, 400]) * RATE_HZ
    np.testing.assert_allclose(acceleration, W2 * control, rtol=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    angle=st.tuples(st.floats(0.005, 0.02), st.floats(-0.02, 0.02)),
    rate=st.tuples(st.floats(-0.02, 0.05), st.floats(-0.05, 0.05)),
)
def test_a_small_fall_is_that_of_the_linear_pendulum(angle, rate):
    n = 500
    _, (path, _, _) = falling(
        np.zeros((2, n)),
        start=np.stack([angle, rate], axis=1),
        threshold=0.001,
        largest=1.5,
        reactions=[n] * 60,
    )
    wave, t = math.sqrt(W2), np.arange(n + 1) * STEP_S
    for p in range(2):
        exact = angle[p] * np.cosh(wave * t) + rate[p] / wave * np.sinh(wave * t)
        # sin θ of angles up to 0.1 and steps of 1 ms are both good for far less than 1 %.
        scale = abs(angle[p]) * np.cosh(wave * t) + abs(rate[p]) / wave * np.sinh(wave * t)
        assert np.all(np.abs(path[p] - exact) <= 0.01 * scale)


def test_a_large_fall_keeps_its_energy():
    _, (angle, rate, _) = falling(
        np.zeros((2, 700)),
        start=[[0.11, 0.1], [-0.05, 0.0]],
        largest=1.5,
        reactions=[700] * 80,
    )
    middle = (rate[:, :-1] + rate[:, 1:])[:, 1:] / 2
    energy = middle**2 / 2 + W2 * np.cos(angle[:, 1:-1])
    gained = W2 * (np.cos(angle[:, 1]) - np.cos(angle[:, -2]))
    assert np.all(np.abs(angle[:, -1]) > 0.2)
    assert np.all(np.abs(energy - energy[:, :1]).max(axis=1) < 2e-3 * gained)


def test_more_noise_loses_balance_more_often():
    counts = []
    for scale in (0.7, 1.0, 1.4):
        body = replace(HARD, noise_ap_nm=9.0 * scale, noise_ml_nm=8.0 * scale)
        counts.append(sum(len(losses) for *_, losses in losing_runs(25, body)))
    assert counts[0] < counts[1] < counts[2]
    assert counts[2] > 3 * counts[0]


def test_a_later_reaction_leads_further():
    peaks = []
    for median_s in (0.1, 0.3, 0.6):
        rail = replace(RAIL, reaction_median_s=median_s, largest_deg=40.0)
        paths = losing_runs(10, rail=rail)
        peaks.append(np.mean([np.hypot(*angle).max() for angle, _, _ in paths]))
    assert peaks[0] < peaks[1] < peaks[2]


def test_loss_times_count_from_the_first_returned_sample():
    arguments = {"rate_hz": RATE_HZ, "loss_of_balance": RAIL}
    whole = simulate_standing(
        HARD, n_samples=90_000, warm_up_s=0.0, rng=np.random.default_rng(4), **arguments
    )
    part = simulate_standing(
        HARD, n_samples=60_000, warm_up_s=30.0, rng=np.random.default_rng(4), **arguments
    )
    later = [t - 30.0 for t in whole.loss_times_s if t >= 30.0]
    assert 0 < len(later) < len(whole.loss_times_s)
    assert part.loss_times_s == pytest.approx(later)
    inclination = np.hypot(*part.angle_rad)
    for time_s in part.loss_times_s:
        assert inclination[round(time_s * RATE_HZ)] > RAIL.threshold_rad


def test_a_strapdown_gyroscope_follows_the_falls():
    motion = simulate_standing(
        replace(HARD, noise_ml_nm=0.0),
        n_samples=60_000,
        rate_hz=RATE_HZ,
        warm_up_s=0.0,
        rng=np.random.default_rng(5),
        loss_of_balance=RAIL,
    )
    assert motion.loss_times_s
    acc, gyr = trunk_signals(motion, (0.0, 0.0, 1.0))
    # Without roll the pitch is the integral of the gyroscope, and the accelerometer at 1 m feels
    # the angular acceleration and gravity.
    pitch = np.cumsum(gyr[1, :-1] + gyr[1, 1:]) * STEP_S / 2
    np.testing.assert_allclose(pitch, motion.angle_rad[0, 1:] - motion.angle_rad[0, 0], atol=1e-4)
    felt = np.gradient(gyr[1], STEP_S) - 9.80665 * np.sin(motion.angle_rad[0])
    np.testing.assert_allclose(acc[0, 1:-1], felt[1:-1], atol=0.5)
    assert np.median(np.abs(acc[0, 1:-1] - felt[1:-1])) < 0.01


def test_reaction_times_are_log_normal_and_always_enough():
    steps = RAIL.draw_reaction_steps(10**7, RATE_HZ, np.random.default_rng(6))
    logs = np.log(steps * STEP_S)
    assert np.median(logs) == pytest.approx(np.log(0.3), abs=4 * 1.25 * 0.5 / 100)
    assert logs.std() == pytest.approx(0.5, abs=4 * 0.5 / np.sqrt(2e4))
    # A body that is always beyond the threshold, caught at once: as many losses as fit.
    fast = LossOfBalance(1e-9, 1e-9, 0.0, largest_deg=1e-9, catch_s=0.005)
    path = falling_paths(HARD, fast, n_steps=3000, rate_hz=RATE_HZ, rng=np.random.default_rng(7))
    assert len(path[2]) > 400
    assert len(path[2]) <= fast.draw_reaction_steps(3000, RATE_HZ, np.random.default_rng(7)).size


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"threshold_deg": 0.0}, r"threshold_deg: .*expected a positive number; found 0"),
        ({"reaction_median_s": -1.0}, "reaction_median_s: .*found -1"),
        ({"catch_s": math.nan}, "catch_s: .*found nan"),
        ({"reaction_log_sd": -0.1}, "reaction_log_sd: .*expected zero or more"),
        ({"largest_deg": 5.0}, "largest_deg: .*expected from threshold_deg to below 90; found 5"),
    ],
)
def test_impossible_losses_are_refused(changes, message):
    with pytest.raises(ConfigurationError, match=message):
        replace(RAIL, **changes)
