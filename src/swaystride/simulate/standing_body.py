"""A person standing still: one inverted pendulum per direction (spec §9.3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import ConfigurationError
from swaystride.simulate._falling_kernel import integrate_falling_pendulums
from swaystride.simulate._standing_kernel import integrate_pendulums
from swaystride.simulate.loss_of_balance import LossOfBalance
from swaystride.units import GRAVITY_M_S2, RAD_PER_DEG

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StandingParameters:
    """Physical parameters of one standing trial.

    Parameters
    ----------
    mass_kg, pendulum_height_m : float
        Mass m and height h of the centre of mass above the ankle.
    inertia_factor : float
        J / (m h²).
    stiffness_ratio : float
        k = K_P / (m g h); above 1, or the person falls.
    damping_nm_s_rad : float
        K_D.
    delay_s : float
        τ of the delayed control.
    noise_ap_nm, noise_ml_nm : float
        Standard deviation of the noise torque in each direction.
    noise_time_s : float
        T_n, time constant of the noise torque.
    noise_coupling : float
        Correlation of the two noise torques.
    lean_drift_deg, lean_drift_period_s : float
        Slow drift of the lean in both directions: a sinusoid of random phase; its standard
        deviation over a period, and its period.
    breathing_deg, breathing_hz : float
        Amplitude and frequency of the trunk's movement with the breath, anterior-posterior.
    weight_shift_ap_deg, weight_shift_ml_deg : float
        Standard deviation of a further slow lean in each direction, with the period and phase of
        the drift: somebody who shifts their weight in the course of a trial.
    """

    mass_kg: float
    pendulum_height_m: float
    inertia_factor: float
    stiffness_ratio: float
    damping_nm_s_rad: float
    delay_s: float
    noise_ap_nm: float
    noise_ml_nm: float
    noise_time_s: float
    noise_coupling: float
    lean_drift_deg: float
    lean_drift_period_s: float
    breathing_deg: float
    breathing_hz: float
    weight_shift_ap_deg: float = 0.0
    weight_shift_ml_deg: float = 0.0

    @property
    def gravity_torque_nm(self) -> float:
        """``m g h``, the torque per radian with which gravity topples the body."""
        return self.mass_kg * GRAVITY_M_S2 * self.pendulum_height_m


@dataclass(frozen=True)
class StandingMotion:
    """Motion of the trunk: pitch about the left axis, roll about the forward axis.

    Parameters
    ----------
    rate_hz : float
        Sampling rate.
    angle_rad, velocity_rad_s, acceleration_rad_s2 : ndarray, shape (2, n_samples)
        Row 0 is pitch (forward positive), row 1 roll (to the right positive), with their time
        derivatives. The orientation is ``r_world_from_trunk = R_y(pitch) R_x(roll)``.
    loss_times_s : tuple of float
        When balance was lost, counted from the first sample.
    """

    rate_hz: float
    angle_rad: Array
    velocity_rad_s: Array
    acceleration_rad_s2: Array
    loss_times_s: tuple[float, ...] = ()


def simulate_standing(
    parameters: StandingParameters,
    *,
    n_samples: int,
    rate_hz: float,
    warm_up_s: float,
    rng: np.random.Generator,
    start_rad: ArrayLike = (0.0, 0.0),
    loss_of_balance: LossOfBalance | None = None,
) -> StandingMotion:
    """Simulate quiet standing.

    ``J θ̈ = m g h sin θ − K_P θ(t−τ) − K_D θ̇(t−τ) + n(t)`` per direction, with an
    Ornstein-Uhlenbeck torque n, by semi-implicit Euler; drift and breathing are added to the
    angles in closed form. The returned derivatives are those of the returned angles to second
    order in the step: Euler's rates live half a step off the angles and are averaged.

    Parameters
    ----------
    parameters : StandingParameters
        The person and how they stand.
    n_samples : int
        Samples to return, after the warm-up.
    rate_hz : float
        Rate of integration and of the result.
    warm_up_s : float
        Time simulated before the first returned sample.
    rng : numpy.random.Generator
        Source of the noise torques and of the phases of drift and breathing.
    start_rad : array_like, shape (2,)
        Pitch and roll at the start of the warm-up, at rest.
    loss_of_balance : LossOfBalance, optional
        What happens beyond the limit of balance; by default the control has no limit. A motion
        that never crosses it is the same with and without. A fall of the warm-up may reach into
        the returned window; its time is not returned.

    Returns
    -------
    StandingMotion

    Raises
    ------
    ConfigurationError
        If the stiffness does not carry the body or the coupling is not a correlation.

    Examples
    --------
    >>> firm = StandingParameters(
    ...     mass_kg=70.0, pendulum_height_m=0.9, inertia_factor=1.1, stiffness_ratio=1.3,
    ...     damping_nm_s_rad=250.0, delay_s=0.1, noise_ap_nm=3.0, noise_ml_nm=2.0,
    ...     noise_time_s=1.0, noise_coupling=0.0, lean_drift_deg=0.0, lean_drift_period_s=60.0,
    ...     breathing_deg=0.0, breathing_hz=0.25)
    >>> motion = simulate_standing(firm, n_samples=30_000, rate_hz=1000.0, warm_up_s=60.0,
    ...                            rng=np.random.default_rng(1))
    >>> sway_deg = np.rad2deg(motion.angle_rad.std(axis=1))
    >>> bool(0.2 < sway_deg[1] < sway_deg[0] < 1.5)
    True
    """
    n_warm_up = round(warm_up_s * rate_hz)
    n_steps = n_warm_up + n_samples
    if loss_of_balance is None:
        angle, rate = pendulum_paths(
            parameters, n_steps=n_steps, rate_hz=rate_hz, rng=rng, start_rad=start_rad
        )
        losses = np.array([], dtype=np.int64)
    else:
        angle, rate, losses = falling_paths(
            parameters,
            loss_of_balance,
            n_steps=n_steps,
            rate_hz=rate_hz,
            rng=rng,
            start_rad=start_rad,
        )
    kept, following = angle[:, n_warm_up:-1], rate[:, n_warm_up:]
    slow = slow_movement(
        parameters, np.arange(n_samples) / rate_hz, rng.uniform(0.0, 2.0 * np.pi, size=3)
    )
    return StandingMotion(
        rate_hz=rate_hz,
        angle_rad=kept + slow[0],
        velocity_rad_s=(following[:, :-1] + following[:, 1:]) / 2.0 + slow[1],
        acceleration_rad_s2=np.diff(following, axis=1) * rate_hz + slow[2],
        loss_times_s=tuple(((losses[losses >= n_warm_up] - n_warm_up) / rate_hz).tolist()),
    )


def pendulum_paths(
    parameters: StandingParameters,
    *,
    n_steps: int,
    rate_hz: float,
    rng: np.random.Generator,
    start_rad: ArrayLike = (0.0, 0.0),
) -> tuple[Array, Array]:
    """Angles and half-step rates of the two pendulums, without drift and breathing.

    Parameters
    ----------
    parameters : StandingParameters
        The person and how they stand.
    n_steps : int
        Steps of integration.
    rate_hz : float
        Steps per second.
    rng : numpy.random.Generator
        Source of the noise torques.
    start_rad : array_like, shape (2,)
        Angles at the start, at rest.

    Returns
    -------
    angle_rad, rate_rad_s : ndarray, shape (2, n_steps + 1)
        ``rate_rad_s[:, i + 1]`` takes ``angle_rad[:, i]`` to ``angle_rad[:, i + 1]``.

    Raises
    ------
    ConfigurationError
        If the stiffness does not carry the body or the coupling is not a correlation.
    """
    angle, rate = integrate_pendulums(
        *_kernel_arguments(parameters, n_steps, rate_hz, rng, start_rad)
    )
    return angle, rate


def falling_paths(
    parameters: StandingParameters,
    loss_of_balance: LossOfBalance,
    *,
    n_steps: int,
    rate_hz: float,
    rng: np.random.Generator,
    start_rad: ArrayLike = (0.0, 0.0),
) -> tuple[Array, Array, NDArray[np.int64]]:
    """As :func:`pendulum_paths`, with losses of balance.

    The reaction times come from a child of `rng`, which takes nothing from its own stream: the
    paths are those of :func:`pendulum_paths` up to the first loss.

    Parameters
    ----------
    parameters, n_steps, rate_hz, rng, start_rad
        See :func:`pendulum_paths`.
    loss_of_balance : LossOfBalance
        What happens beyond the limit of balance.

    Returns
    -------
    angle_rad, rate_rad_s : ndarray, shape (2, n_steps + 1)
        See :func:`pendulum_paths`.
    loss_steps : ndarray of int, shape (n_losses,)
        Index of the first angle beyond the threshold, for each loss.

    Raises
    ------
    ConfigurationError
        See :func:`pendulum_paths`.
    """
    loss = loss_of_balance
    angle, rate, loss_steps = integrate_falling_pendulums(
        *_kernel_arguments(parameters, n_steps, rate_hz, rng, start_rad),
        loss.threshold_rad,
        loss.largest_rad,
        loss.draw_reaction_steps(n_steps, rate_hz, rng.spawn(1)[0]),
        loss.catch_steps(rate_hz),
    )
    return angle, rate, loss_steps


def _kernel_arguments(
    p: StandingParameters,
    n_steps: int,
    rate_hz: float,
    rng: np.random.Generator,
    start_rad: ArrayLike,
) -> tuple[Array, Array, float, float, float, float, int, float, Array]:
    """What both kernels take: noise, body, control, step and start."""
    if not p.stiffness_ratio > 1.0:
        raise ConfigurationError(
            "the body falls", expected="stiffness_ratio > 1", found=f"{p.stiffness_ratio:g}"
        )
    if not abs(p.noise_coupling) <= 1.0:
        raise ConfigurationError(
            "the noise torques cannot be coupled like this",
            expected="−1 ≤ noise_coupling ≤ 1",
            found=f"{p.noise_coupling:g}",
        )
    normals = rng.standard_normal((2, n_steps))
    if p.noise_coupling:
        normals[1] *= np.sqrt(1.0 - p.noise_coupling**2)
        normals[1] += p.noise_coupling * normals[0]
    start = np.stack([np.asarray(start_rad, dtype=np.float64), np.zeros(2)], axis=1)
    return (
        normals,
        np.array([p.noise_ap_nm, p.noise_ml_nm]) / p.gravity_torque_nm,
        float(np.exp(-1.0 / (rate_hz * p.noise_time_s))),
        GRAVITY_M_S2 / (p.inertia_factor * p.pendulum_height_m),
        p.stiffness_ratio,
        p.damping_nm_s_rad / p.gravity_torque_nm,
        round(p.delay_s * rate_hz),
        1.0 / rate_hz,
        start,
    )


def slow_movement(parameters: StandingParameters, time_s: Array, phases_rad: ArrayLike) -> Array:
    """Lean drift and breathing with their first and second derivatives.

    Parameters
    ----------
    parameters : StandingParameters
        Amplitudes, period and frequency.
    time_s : ndarray, shape (n_samples,)
        Time.
    phases_rad : array_like, shape (..., 3)
        Phases of the drift in pitch, of the drift in roll, and of the breathing.

    Returns
    -------
    ndarray, shape (3, ..., 2, n_samples)
        Angle (rad), velocity and acceleration; pitch and roll.
    """
    p = parameters
    phases = np.asarray(phases_rad, dtype=np.float64)[..., None]
    drift_rate = 2.0 * np.pi / p.lean_drift_period_s
    shift_deg = np.array([[p.weight_shift_ap_deg], [p.weight_shift_ml_deg]])
    lean_deg = np.hypot(p.lean_drift_deg, shift_deg)
    drift = _harmonic(np.sqrt(2.0) * lean_deg * RAD_PER_DEG, drift_rate, time_s, phases[..., :2, :])
    breath_rate = 2.0 * np.pi * p.breathing_hz
    drift[..., 0, :] += _harmonic(
        p.breathing_deg * RAD_PER_DEG, breath_rate, time_s, phases[..., 2, :]
    )
    return drift


def _harmonic(
    amplitude: float | Array, rate_rad_s: float, time_s: Array, phase_rad: Array
) -> Array:
    """A sinusoid and its two derivatives, stacked on a new first axis."""
    sine = amplitude * np.sin(rate_rad_s * time_s + phase_rad)
    cosine = amplitude * np.cos(rate_rad_s * time_s + phase_rad)
    return np.stack([sine, rate_rad_s * cosine, -(rate_rad_s**2) * sine])


def lean_angles_deg(angle_rad: ArrayLike) -> Array:
    """Sway angles by their definition (spec §8.1), from pitch and roll.

    With the vertical seen from the trunk, ``u = (−sin p, sin r cos p, cos r cos p)``:
    ``AP = atan2(−u_x, u_z)`` and ``ML = atan2(u_y, u_z)``.

    Parameters
    ----------
    angle_rad : array_like, shape (..., 2, n_samples)
        Pitch and roll.

    Returns
    -------
    ndarray, shape (..., 2, n_samples)
        AP and ML in degrees, forward and to the right positive.

    Examples
    --------
    >>> lean_angles_deg(np.deg2rad([[2.0], [0.0]])).round(9).tolist()
    [[2.0], [0.0]]
    """
    angle = np.asarray(angle_rad, dtype=np.float64)
    pitch, roll = angle[..., 0, :], angle[..., 1, :]
    ap = np.arctan(np.tan(pitch) / np.cos(roll))
    return np.stack([ap, roll], axis=-2) / RAD_PER_DEG
