"""The printed estimator: tilt-corrected orientation, linear drift of velocity removed per stride.

Potter et al. (2019), §2.2, after Rebula et al. (2013) and Ojeda & Borenstein (2007).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.gait._strapdown_kernels import orientation_with_tilt, velocity_between_epochs
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.levelling import level_quaternion, mean_directions
from swaystride.gait.zero_velocity import ZeroVelocity, rest_flags

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def epochs_of_movement(zero_velocity: ZeroVelocity) -> tuple[Index, NDArray[np.bool_]]:
    """Epochs between which the foot moves: both ends of every rest, and every stance.

    Parameters
    ----------
    zero_velocity : ZeroVelocity

    Returns
    -------
    epochs : ndarray of int, shape (m,)
        Rising.
    is_rest : ndarray of bool, shape (m,)
    """
    ends = np.unique(np.r_[zero_velocity.rests[:, 0], zero_velocity.rests[:, 1] - 1])
    epochs = np.r_[ends, zero_velocity.stances]
    is_rest = np.r_[np.ones(len(ends), bool), np.zeros(len(zero_velocity.stances), bool)]
    order = np.argsort(epochs, kind="stable")
    return epochs[order].astype(np.int64), is_rest[order]


def linear_drift_states(
    acc_m_s2: Array,
    gyr_rad_s: Array,
    rate_hz: float,
    zero_velocity: ZeroVelocity,
    method: FootMethod,
) -> tuple[Array, Array]:
    """Orientation and velocity of a foot by the printed method.

    Orientation is the integral of the gyroscope, its tilt corrected by a Kalman filter at every
    zero-velocity epoch; velocity is the integral of the acceleration in world axes, nil at every
    epoch, its drift taken as linear in between.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
        Without missing samples, in the sensor frame.
    rate_hz : float
        Sampling rate.
    zero_velocity : ZeroVelocity
        With at least one epoch.
    method : FootMethod

    Returns
    -------
    orientation : ndarray, shape (n_samples, 4)
        ``q_world_from_sensor``; the heading of the first sample is arbitrary.
    velocity : ndarray, shape (n_samples, 3)
        m/s in world axes, nil before the first and after the last epoch.
    """
    epochs, is_rest = epochs_of_movement(zero_velocity)
    rests = zero_velocity.rests
    gyr = gyr_rad_s
    if method.rest_rate_removed and len(rests):
        first, stop = rests[0]
        gyr = gyr - gyr[:, first:stop].mean(axis=1, keepdims=True)
    reach = round(0.5 * method.tilt_average_s * rate_hz)
    up = mean_directions(acc_m_s2, epochs, reach)
    orientation = orientation_with_tilt(
        np.ascontiguousarray(gyr),
        1.0 / rate_hz,
        level_quaternion(up[0]),
        epochs,
        up,
        np.where(is_rest, method.tilt_rest_sd, method.tilt_stance_sd),
        method.tilt_stance_sd,
        method.tilt_rate_noise_rad_s_rthz,
    )
    velocity = velocity_between_epochs(acc_m_s2, orientation, 1.0 / rate_hz, epochs)
    velocity[rest_flags(len(velocity), rests)] = 0.0
    return orientation, velocity
