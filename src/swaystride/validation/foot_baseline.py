"""A plain baseline for foot trajectories: VQF orientation, linear removal of velocity drift."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from vqf import offlineVQF

from swaystride.units import GRAVITY_M_S2

FloatArray = NDArray[np.float64]

#: Time constant of the accelerometer correction. VQF's default of 3 s takes the steady forward
#: acceleration of a stride for tilt; with 30 s nearly nothing of it is left.
TAU_ACC_S: Final = 30.0


def vqf_path(
    acc_m_s2: ArrayLike, gyr_rad_s: ArrayLike, rate_hz: float, epoch_index: ArrayLike
) -> FloatArray:
    """Position by VQF (offline, 6-D), integration, and linear de-drift between epochs.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n)
        Signals in the sensor frame.
    rate_hz : float
    epoch_index : array_like of int, shape (k,)
        Samples at which the velocity is taken for zero.

    Returns
    -------
    array, shape (3, n)
        World frame, z up, heading arbitrary.
    """
    acc, gyr = (np.ascontiguousarray(np.asarray(v, dtype=float).T) for v in (acc_m_s2, gyr_rad_s))
    fused = offlineVQF(gyr, acc, None, 1.0 / rate_hz, params={"tauAcc": TAU_ACC_S})
    acc_world = _rotated(fused["quat6D"], acc) - np.array([0.0, 0.0, GRAVITY_M_S2])
    return dedrifted_position(acc_world.T, rate_hz, epoch_index)


def dedrifted_position(
    acc_world_m_s2: ArrayLike, rate_hz: float, epoch_index: ArrayLike
) -> FloatArray:
    """Twice integrated acceleration whose velocity is made zero at the epochs.

    Between two epochs the velocity error is taken to grow linearly; before the first and after
    the last it is constant.

    Parameters
    ----------
    acc_world_m_s2 : array_like, shape (3, n)
        Acceleration without gravity.
    rate_hz : float
    epoch_index : array_like of int, shape (k,)

    Returns
    -------
    array, shape (3, n)

    Examples
    --------
    A bias of acceleration does no harm.

    >>> dedrifted_position(np.full((3, 5), 0.7), 1.0, [0, 4]).round(9).tolist()[0]
    [0.0, 0.0, 0.0, 0.0, 0.0]
    """
    acc = np.asarray(acc_world_m_s2, dtype=np.float64)
    epochs = np.asarray(epoch_index, dtype=np.int64)
    velocity = _integral(acc, rate_hz)
    samples = np.arange(acc.shape[1])
    drift = np.stack([np.interp(samples, epochs, axis[epochs]) for axis in velocity])
    return _integral(velocity - drift, rate_hz)


def _integral(values: FloatArray, rate_hz: float) -> FloatArray:
    """Trapezoids along time, zero at the start."""
    steps = 0.5 * (values[:, 1:] + values[:, :-1]) / rate_hz
    return np.concatenate([np.zeros((len(values), 1)), np.cumsum(steps, axis=1)], axis=1)


def _rotated(quaternion: FloatArray, vectors: FloatArray) -> FloatArray:
    """Vectors (n, 3) turned by unit quaternions (n, 4), scalar first."""
    w, v = quaternion[:, :1], quaternion[:, 1:]
    cross = np.cross(v, vectors)
    return np.asarray(vectors + 2.0 * (w * cross + np.cross(v, cross)))
