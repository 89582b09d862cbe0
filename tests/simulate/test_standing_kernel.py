"""The compiled pendulum against a plain twin, closed forms and the theory of its noise."""

import math

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov

from swaystride.simulate._standing_kernel import integrate_pendulums

G = 9.80665


def plain_twin(normals, noise_sd, memory, w2, stiffness, damping_s, delay, step, start):
    """The kernel's arithmetic without compilation, one pendulum and one step at a time."""
    angles, rates = [], []
    for xi, sd, (theta, omega) in zip(normals, noise_sd, start, strict=True):
        angle, rate, noise = [theta], [omega], None
        for i, number in enumerate(xi):
            fresh = sd * number
            noise = fresh if noise is None else memory * noise + math.sqrt(1 - memory**2) * fresh
            past = max(i - delay, 0)
            torque = math.sin(angle[i]) - stiffness * angle[past] - damping_s * rate[past] + noise
            rate.append(rate[i] + step * w2 * torque)
            angle.append(angle[i] + step * rate[-1])
        angles.append(angle)
        rates.append(rate)
    return np.array(angles), np.array(rates)


def run(normals, *, sd=(0.0, 0.0), T=1.0, h=0.9, k=1.3, d=0.4, delay=0, start=None, step=1e-3):
    return integrate_pendulums(
        np.ascontiguousarray(normals),
        np.array(sd),
        math.exp(-step / T),
        G / (1.1 * h),
        k,
        d,
        delay,
        step,
        np.zeros((len(normals), 2)) if start is None else np.array(start),
    )


@pytest.mark.parametrize("delay", [0, 1, 120])
def test_kernel_equals_its_plain_twin(delay):
    rng = np.random.default_rng(delay)
    normals = rng.standard_normal((2, 1500))
    arguments = (
        normals,
        np.array([0.01, 0.02]),
        0.998,
        G / 0.99,
        1.3,
        0.4,
        delay,
        1e-3,
        np.array([[0.01, 0.1], [-0.02, 0.0]]),
    )
    for compiled, plain in zip(
        integrate_pendulums(*arguments), plain_twin(*arguments), strict=True
    ):
        np.testing.assert_allclose(compiled, plain, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(("k", "d"), [(1.3, 0.15), (1.25, 0.05), (2.0, 0.3)])
def test_small_noise_free_pendulum_is_a_damped_oscillator(k, d):
    # θ̈ + w2 d θ̇ + w2 (k − 1) θ = 0
    w2, theta0, step = G / 0.99, 1e-4, 1e-3
    decay = w2 * d / 2
    wave = math.sqrt(w2 * (k - 1) - decay**2)
    t = np.arange(5001) * step
    analytic = theta0 * np.exp(-decay * t) * (np.cos(wave * t) + decay / wave * np.sin(wave * t))
    angle, _ = run(np.zeros((1, 5000)), sd=(0.0,), k=k, d=d, start=[[theta0, 0.0]])
    # Semi-implicit Euler is of first order: the error is of the size of the step.
    assert np.abs(angle[0] - analytic).max() < 2 * theta0 * step * wave


def test_the_error_of_integration_falls_with_the_step():
    w2, d, k = G / 0.99, 0.15, 1.3
    decay, duration = w2 * d / 2, 2.0
    wave = math.sqrt(w2 * (k - 1) - decay**2)
    exact = (
        1e-4
        * math.exp(-decay * duration)
        * (math.cos(wave * duration) + decay / wave * math.sin(wave * duration))
    )
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        n = round(duration / step)
        angle, _ = run(np.zeros((1, n)), sd=(0.0,), k=k, d=d, start=[[1e-4, 0.0]], step=step)
        errors.append(abs(angle[0, -1] - exact))
    assert errors[0] / errors[1] == pytest.approx(2, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2, rel=0.1)


def test_undamped_pendulum_keeps_its_energy():
    # ½ θ̇² + w2 (cos θ + k θ²/2) is constant; a symplectic method has no drift.
    angle, rate = run(np.zeros((1, 200_000)), sd=(0.0,), k=1.5, d=0.0, start=[[0.05, 0.0]])
    middle = (rate[0, :-1] + rate[0, 1:]) / 2
    energy = middle**2 / 2 + G / 0.99 * (np.cos(angle[0, :-1]) - 1 + 1.5 * angle[0, :-1] ** 2 / 2)
    start = energy[:20_000].mean()
    assert abs(energy[-20_000:].mean() / start - 1) < 1e-3


def test_a_constant_torque_leads_to_the_balance_of_torques():
    # sin θ − k θ + n = 0, with the noise frozen (memory 1).
    normals = np.full((1, 60_000), 1.0)
    angle, _ = integrate_pendulums(
        normals, np.array([0.02]), 1.0, G / 0.99, 1.3, 0.4, 100, 1e-3, np.zeros((1, 2))
    )
    theta = angle[0, -1]
    assert math.sin(theta) - 1.3 * theta + 0.02 == pytest.approx(0.0, abs=1e-9)


def noise_of(angle, rate, *, w2, k, d, step):
    """Recover the torque noise from the motion of an undelayed pendulum."""
    acceleration = np.diff(rate[0]) / step
    return acceleration / w2 - np.sin(angle[0, :-1]) + k * angle[0, :-1] + d * rate[0, :-1]


def test_noise_is_a_stationary_ornstein_uhlenbeck_process():
    rng = np.random.default_rng(4)
    T, sd, step = 0.5, 0.01, 1e-3
    n_runs, n_steps = 400, 3000
    noises = []
    for _ in range(n_runs):
        angle, rate = run(rng.standard_normal((1, n_steps)), sd=(sd,), T=T)
        noises.append(noise_of(angle, rate, w2=G / 0.99, k=1.3, d=0.4, step=step))
    noise = np.array(noises)
    # Stationary from the first sample on: the variance of the ensemble is the same everywhere.
    error = 4 * np.sqrt(2 / n_runs)
    assert np.abs(noise[:, ::500].var(axis=0) / sd**2 - 1).max() < error
    for lag in (1, 100, 500, 1000):
        correlation = (noise[:, 0] * noise[:, lag]).mean() / sd**2
        assert correlation == pytest.approx(math.exp(-lag * step / T), abs=4 / np.sqrt(n_runs))
    # One step decorrelates by exactly exp(−dt/T).
    step_correlation = (noise[:, 1:] * noise[:, :-1]).mean() / (noise[:, :-1] ** 2).mean()
    assert step_correlation == pytest.approx(math.exp(-step / T), abs=2e-4)


def test_small_sway_scales_with_the_noise():
    normals = np.random.default_rng(5).standard_normal((1, 20_000))
    small, _ = run(normals, sd=(1e-5,), delay=120)
    double, _ = run(normals, sd=(2e-5,), delay=120)
    np.testing.assert_allclose(double, 2 * small, rtol=0, atol=1e-6 * np.abs(small).max())


def test_pendulums_do_not_see_each_other():
    normals = np.random.default_rng(6).standard_normal((2, 2000))
    both, _ = run(normals, sd=(0.01, 0.02), delay=50)
    alone, _ = run(normals[1:], sd=(0.02,), delay=50)
    assert np.array_equal(both[1], alone[0])


def test_stationary_variance_of_the_undelayed_pendulum():
    # Small angles: a linear system of angle, rate and torque, whose covariance is known.
    w2, k, d, T, sd = G / 0.99, 1.4, 0.4, 0.3, 0.003
    system = np.array([[0, 1, 0], [-w2 * (k - 1), -w2 * d, w2], [0, 0, -1 / T]])
    drive = np.diag([0.0, 0.0, 2 * sd**2 / T])
    theory = solve_continuous_lyapunov(system, -drive)
    angle, rate = run(np.random.default_rng(7).standard_normal((1, 3_000_000)), sd=(sd,), T=T, k=k)
    assert angle[0, 20_000:].std() == pytest.approx(np.sqrt(theory[0, 0]), rel=0.03)
    assert rate[0, 20_000:].std() == pytest.approx(np.sqrt(theory[1, 1]), rel=0.03)
