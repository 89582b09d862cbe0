"""The recommended estimator: an error-state smoother that measures at zero-velocity epochs only.

The error of a strapdown solution has nine states: velocity, orientation (a small rotation in the
world frame) and gyroscope bias. Position is never measured, so its error follows from that of the
velocity and needs no state. In stance the contact point of the sole stands still, not the sensor on
top of the foot: ``v + R (ω × r) = 0`` with the lever r from the sensor to the contact point, whose
height is one prior for everybody. At rest velocity and rate are nil. Between epochs nothing is
measured; transition and noise are accumulated, the smoother runs over epochs, and its corrections
are carried back into the strides.

The noise of a step grows with the change of the signal from one sample to the next: what happens
between two samples (the impact of the heel, sampled at 200 Hz) is unknown in proportion to it. So
the smoother puts the correction of velocity where the impact was and not evenly over the stride.
Where a channel is flattened, its sensor has reached its range; there the most likely excess is put
back, and the noise is larger too.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from swaystride.gait._epoch_kernels import filter_epochs, smooth_epochs
from swaystride.gait._strapdown_kernels import integrate_backward
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.levelling import level_quaternion, mean_directions
from swaystride.gait.zero_velocity import ZeroVelocity
from swaystride.signals.plateaus import restore_plateaus

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Sensors of human movement have at least these ranges (±2 g, ±250 °/s).
LEAST_ACC_RANGE_M_S2: Final = 19.0
LEAST_GYR_RANGE_RAD_S: Final = 4.3
#: The filter starts at rest or in stance: standard deviations of velocity (m/s) and tilt (rad).
_START_VELOCITY_SD: Final = (0.01, 0.5)
_START_TILT_SD: Final = (0.02, 0.2)


class SmoothedStates(NamedTuple):
    """Result of :func:`smoothed_states`; `believed` flags the epochs that passed the gate."""

    orientation: Array
    velocity: Array
    epochs: Index
    believed: NDArray[np.bool_]


def measured_epochs(
    zero_velocity: ZeroVelocity, rate_hz: float, spacing_s: float
) -> tuple[Index, NDArray[np.bool_]]:
    """Epochs of the filter: every stance, and rests at a fixed spacing with both ends.

    Parameters
    ----------
    zero_velocity : ZeroVelocity
    rate_hz : float
        Sampling rate.
    spacing_s : float
        Time between two epochs at rest.

    Returns
    -------
    epochs : ndarray of int, shape (m,)
        Rising.
    is_rest : ndarray of bool, shape (m,)

    Examples
    --------
    >>> found = ZeroVelocity(np.array([[0, 30]]), np.array([60]), np.zeros(99, bool))
    >>> [a.tolist() for a in measured_epochs(found, 100.0, 0.1)]
    [[0, 10, 20, 29, 60], [True, True, True, True, False]]
    """
    step = max(1, round(spacing_s * rate_hz))
    parts = [
        np.r_[np.arange(first, stop - 1, step), stop - 1] for first, stop in zero_velocity.rests
    ]
    rests = np.unique(np.concatenate([np.empty(0, dtype=np.int64), *parts]))
    epochs = np.r_[rests, zero_velocity.stances]
    is_rest = np.r_[np.ones(len(rests), bool), np.zeros(len(zero_velocity.stances), bool)]
    order = np.argsort(epochs, kind="stable")
    return epochs[order].astype(np.int64), is_rest[order]


def smoothed_states(
    acc_m_s2: Array,
    gyr_rad_s: Array,
    rate_hz: float,
    zero_velocity: ZeroVelocity,
    method: FootMethod,
) -> SmoothedStates:
    """Orientation and velocity of a foot by the smoother.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
        Without missing samples, in the sensor frame, contiguous.
    rate_hz : float
        Sampling rate.
    zero_velocity : ZeroVelocity
        With at least one epoch.
    method : FootMethod

    Returns
    -------
    SmoothedStates
        ``orientation`` (n, 4), ``q_world_from_sensor`` with an arbitrary heading at the first
        epoch, and ``velocity`` (n, 3) in m/s. Before the first epoch the strapdown runs against
        time; after the last one the foot is taken to stand still.
    """
    n, step_s = acc_m_s2.shape[1], 1.0 / rate_hz
    epochs, is_rest = measured_epochs(zero_velocity, rate_hz, method.rest_spacing_s)
    acc_m_s2, acc_lost = restore_plateaus(acc_m_s2, least_level=LEAST_ACC_RANGE_M_S2)
    gyr_rad_s, gyr_lost = restore_plateaus(gyr_rad_s, least_level=LEAST_GYR_RANGE_RAD_S)
    velocity_noise, angle_noise = step_noise(acc_m_s2, gyr_rad_s, rate_hz, method)
    velocity_noise += step_s**2 * acc_lost
    angle_noise += step_s**2 * gyr_lost
    reach = max(1, round(0.5 * method.stillness_window_s * rate_hz))
    up = mean_directions(acc_m_s2, epochs, reach)
    first = int(epochs[0])
    start, bias = level_quaternion(up[0]), np.zeros(3)
    covariance = _start_covariance(bool(is_rest[0]), method)
    for turn in range(method.passes):
        orientation, velocity, force = np.empty((n, 4)), np.empty((n, 3)), np.empty((n, 3))
        orientation[first], velocity[first] = start, 0.0
        *filtered, biases, believed = filter_epochs(
            acc_m_s2,
            gyr_rad_s,
            step_s,
            epochs,
            is_rest,
            contact_lever(up, is_rest, method.lever_height_m),
            covariance,
            bias,
            velocity_noise,
            angle_noise,
            method.bias_walk_rad_s_rts,
            np.array([method.stance_velocity_sd_m_s] * 2 + [method.stance_vertical_sd_m_s]),
            method.lever_height_sd_m,
            np.array([method.rest_velocity_sd_m_s, method.rest_rate_sd_rad_s]),
            method.gate,
            method.longest_unaided_s,
            orientation,
            velocity,
            force,
        )
        change = smooth_epochs(
            step_s, epochs, *filtered, velocity_noise, angle_noise, orientation, velocity, force
        )
        start, bias = orientation[first].copy(), biases[0] + change[0]
        if turn == 0 and is_rest[0]:
            # Started at rest, the first pass was linearised about the truth but for a small angle.
            break
    integrate_backward(acc_m_s2, gyr_rad_s, step_s, bias, first, orientation, velocity)
    last = int(epochs[-1])
    orientation[last + 1 :], velocity[last + 1 :] = orientation[last], 0.0
    return SmoothedStates(orientation, velocity, epochs, believed)


def step_noise(
    acc_m_s2: Array, gyr_rad_s: Array, rate_hz: float, method: FootMethod
) -> tuple[Array, Array]:
    """Variance that each step adds to each component of velocity and of orientation.

    ``σ² dt + (share · |x[k+1] − x[k]| · dt)²``; what a saturated sensor adds comes on top.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
    rate_hz : float
        Sampling rate.
    method : FootMethod

    Returns
    -------
    velocity_noise, angle_noise : ndarray, shape (n_samples - 1,)
        (m/s)² and rad².
    """
    step_s = 1.0 / rate_hz
    noise = []
    for signal, density, share in (
        (acc_m_s2, method.acc_noise_m_s2_rthz, method.acc_step_share),
        (gyr_rad_s, method.gyr_noise_rad_s_rthz, method.gyr_step_share),
    ):
        change = np.diff(signal, axis=1)
        variance = (share * step_s) ** 2 * np.einsum("ij,ij->j", change, change)
        noise.append(variance + density**2 * step_s)
    return noise[0], noise[1]


def contact_lever(up: Array, is_rest: NDArray[np.bool_], height_m: float) -> Array:
    """Vector from the sensor down to the contact point, in the sensor frame.

    Parameters
    ----------
    up : ndarray, shape (m, 3)
        Unit vectors of the vertical at the epochs, sensor frame.
    is_rest : ndarray of bool, shape (m,)
        Stances alone count; without any, rests.
    height_m : float
        Of the sensor above the contact point. Only the vertical part of the lever moves the
        horizontal speed.

    Returns
    -------
    ndarray, shape (3,)
    """
    chosen = up[~is_rest] if (~is_rest).any() else up
    middle = np.median(chosen, axis=0)
    return np.asarray(-height_m * middle / np.linalg.norm(middle))


def _start_covariance(at_rest: bool, method: FootMethod) -> Array:
    """Covariance at the first epoch; the heading is a convention and therefore exact."""
    kind = 0 if at_rest else 1
    velocity, tilt = _START_VELOCITY_SD[kind], _START_TILT_SD[kind]
    bias = method.start_bias_sd_rad_s
    return np.diag(np.square([velocity] * 3 + [tilt, tilt, 1e-3] + [bias] * 3))
