"""Compiled strapdown kernels: tilt-corrected orientation, velocity per stride, against time.

Errors of orientation are small rotations in the world frame, ``r_true = Exp(d) r``.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.gait._quaternion_kernels import rotated, skew, tilted, turned
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def orientation_with_tilt(
    gyr: Array,
    step_s: float,
    start: Array,
    epoch_index: Index,
    epoch_up: Array,
    epoch_sd: Array,
    start_sd_rad: float,
    rate_noise: float,
) -> Array:
    """Integrate the gyroscope; at every epoch a Kalman update of the tilt by the accelerometer.

    The error is a small rotation in the world frame; its covariance grows by
    ``rate_noise² · time`` and is a 3 × 3 matrix that no rotation changes, so that it is needed at
    epochs only. Measurement: up as seen by the accelerometer, in the world frame, against e_z.

    Parameters
    ----------
    gyr : array, shape (3, n)
        rad/s, bias removed.
    step_s : float
        Time step.
    start : array, shape (4,)
        Orientation of the first sample.
    epoch_index : array of int, shape (m,)
        Samples with an update, rising.
    epoch_up : array, shape (m, 3)
        Unit vectors of the mean acceleration there, sensor frame.
    epoch_sd : array, shape (m,)
        Standard deviation of each component of `epoch_up`.
    start_sd_rad : float
        Standard deviation of the tilt at the start.
    rate_noise : float
        rad/s/√Hz.

    Returns
    -------
    array, shape (n, 4)
        After the update at epochs.
    """
    n = gyr.shape[1]
    out = np.empty((n, 4))
    q = (start[0], start[1], start[2], start[3])
    p = np.zeros((3, 3))
    p[0, 0] = p[1, 1] = start_sd_rad * start_sd_rad
    up = np.zeros(3)
    up[2] = 1.0
    h = skew(up)
    epoch = 0
    last = 0
    for k in range(n):
        if k > 0:
            q = turned(
                q,
                0.5 * (gyr[0, k - 1] + gyr[0, k]),
                0.5 * (gyr[1, k - 1] + gyr[1, k]),
                0.5 * (gyr[2, k - 1] + gyr[2, k]),
                step_s,
            )
        if epoch < len(epoch_index) and k == epoch_index[epoch]:
            for axis in range(3):
                p[axis, axis] += rate_noise * rate_noise * step_s * (k - last)
            last = k
            seen = rotated(q, epoch_up[epoch, 0], epoch_up[epoch, 1], epoch_up[epoch, 2])
            # r_true u = e_z and r_true = Exp(d) r, so that r u = e_z + [e_z]x d.
            y = np.array([seen[0], seen[1], seen[2] - 1.0])
            s = h @ p @ h.T + epoch_sd[epoch] ** 2 * np.eye(3)
            gain = np.linalg.solve(s, h @ p).T
            d = gain @ y
            p = p - gain @ h @ p
            p = 0.5 * (p + p.T)
            q = tilted(q, d[0], d[1], d[2])
            epoch += 1
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = q
    return out


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def velocity_between_epochs(
    acc: Array, orientation: Array, step_s: float, epoch_index: Index
) -> Array:
    """Velocity, zero at every epoch: trapezoidal integration, linear drift removed between them.

    Before the first and after the last epoch the velocity is zero.

    Parameters
    ----------
    acc : array, shape (3, n)
        m/s² in the sensor frame.
    orientation : array, shape (n, 4)
    step_s : float
        Time step.
    epoch_index : array of int, shape (m,)
        Rising.

    Returns
    -------
    array, shape (n, 3)
    """
    velocity = np.zeros((acc.shape[1], 3))
    for epoch in range(len(epoch_index) - 1):
        first, last = epoch_index[epoch], epoch_index[epoch + 1]
        q = (
            orientation[first, 0],
            orientation[first, 1],
            orientation[first, 2],
            orientation[first, 3],
        )
        before = rotated(q, acc[0, first], acc[1, first], acc[2, first])
        for k in range(first + 1, last + 1):
            q = (orientation[k, 0], orientation[k, 1], orientation[k, 2], orientation[k, 3])
            after = rotated(q, acc[0, k], acc[1, k], acc[2, k])
            for axis in range(3):
                velocity[k, axis] = velocity[k - 1, axis] + 0.5 * step_s * (
                    before[axis] + after[axis]
                )
            velocity[k, 2] -= step_s * GRAVITY_M_S2
            before = after
        for axis in range(3):
            drift = velocity[last, axis] / (last - first)
            for k in range(first + 1, last + 1):
                velocity[k, axis] -= drift * (k - first)
            velocity[last, axis] = 0.0
    return velocity


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def integrate_backward(
    acc: Array,
    gyr: Array,
    step_s: float,
    bias: Array,
    stop: int,
    orientation: Array,
    velocity: Array,
) -> None:
    """Strapdown against time from sample `stop` to the first, in place.

    Parameters
    ----------
    acc, gyr : array, shape (3, n)
        m/s² and rad/s in the sensor frame.
    step_s : float
        Time step.
    bias : array, shape (3,)
        Gyroscope bias in rad/s.
    stop : int
        Sample whose state is known.
    orientation, velocity : array, shape (n, 4) and (n, 3)
        Filled before `stop`.
    """
    for k in range(stop - 1, -1, -1):
        q1 = (
            orientation[k + 1, 0],
            orientation[k + 1, 1],
            orientation[k + 1, 2],
            orientation[k + 1, 3],
        )
        q0 = turned(
            q1,
            -(0.5 * (gyr[0, k] + gyr[0, k + 1]) - bias[0]),
            -(0.5 * (gyr[1, k] + gyr[1, k + 1]) - bias[1]),
            -(0.5 * (gyr[2, k] + gyr[2, k + 1]) - bias[2]),
            step_s,
        )
        before = rotated(q0, acc[0, k], acc[1, k], acc[2, k])
        after = rotated(q1, acc[0, k + 1], acc[1, k + 1], acc[2, k + 1])
        orientation[k, 0], orientation[k, 1], orientation[k, 2], orientation[k, 3] = q0
        for axis in range(3):
            velocity[k, axis] = velocity[k + 1, axis] - 0.5 * step_s * (before[axis] + after[axis])
        velocity[k, 2] += step_s * GRAVITY_M_S2
