"""Orientation without a magnetometer: the vertical, seen from the sensor."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from vqf import VQF, offlineVQF

from swaystride.errors import ConfigurationError, RecordingError

FusionMethod = Literal["vqf", "offline_vqf"]

_SIGNED_AXES: Final = {
    f"{sign}{name}": (index, factor)
    for index, name in enumerate("xyz")
    for sign, factor in (("", 1.0), ("+", 1.0), ("-", -1.0))
}


def up_in_sensor(
    acc_m_s2: ArrayLike,
    gyr_rad_s: ArrayLike,
    *,
    rate_hz: float,
    tau_acc_s: float,
    method: FusionMethod,
) -> NDArray[np.float64]:
    """Direction of the vertical in the sensor frame, by 6-D fusion (VQF).

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : array_like, shape (3, n_samples)
        Signals in the sensor frame, without missing samples.
    rate_hz : float
        Sampling rate.
    tau_acc_s : float
        Time constant with which the accelerometer corrects the integrated gyroscope.
    method : {"vqf", "offline_vqf"}
        The real-time filter, or the acausal one (forward and backward, without start-up).

    Returns
    -------
    ndarray, shape (3, n_samples)
        Unit vectors ``u = r_world_from_sensor.T @ e_z``.

    References
    ----------
    Laidig & Seel (2023), Information Fusion 91, 187-204.

    Examples
    --------
    >>> still = np.tile([[0.0], [0.0], [9.81]], 300)
    >>> up_in_sensor(still, 0 * still, rate_hz=100.0, tau_acc_s=3.0, method="vqf")[:, -1].round(6)
    array([0., 0., 1.])
    """
    acc = np.ascontiguousarray(np.asarray(acc_m_s2, dtype=np.float64).T)
    gyr = np.ascontiguousarray(np.asarray(gyr_rad_s, dtype=np.float64).T)
    if not (np.all(np.isfinite(acc)) and np.all(np.isfinite(gyr))):
        raise RecordingError(
            "cannot integrate across missing samples", expected="finite values", found="NaN"
        )
    if method == "vqf":
        quaternion = VQF(1.0 / rate_hz, tauAcc=tau_acc_s).updateBatch(gyr, acc)["quat6D"]
    else:
        fused = offlineVQF(gyr, acc, None, 1.0 / rate_hz, params={"tauAcc": tau_acc_s})
        quaternion = fused["quat6D"]
    w, x, y, z = quaternion.T
    return np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def remap_axes(vectors: ArrayLike, *, forward: str, left: str, up: str) -> NDArray[np.float64]:
    """Express sensor vectors in body axes (x forward, y left, z up) by assumed alignment.

    Parameters
    ----------
    vectors : array_like, shape (3, n_samples)
        Components along the sensor's x, y, z.
    forward, left, up : str
        The sensor axis that points there: ``"x"``, ``"-x"``, ``"y"``, …

    Returns
    -------
    ndarray, shape (3, n_samples)

    Raises
    ------
    ConfigurationError
        If the three axes are not a right-handed frame.

    Examples
    --------
    >>> remap_axes(np.eye(3), forward="z", left="y", up="x")
    Traceback (most recent call last):
    ...
    swaystride.errors.ConfigurationError: sensor axes: not a right-handed frame; expected forward × left = up; found forward=z, left=y, up=x
    >>> remap_axes(np.eye(3), forward="-z", left="y", up="x")
    array([[ 0.,  0., -1.],
           [ 0.,  1.,  0.],
           [ 1.,  0.,  0.]])
    """
    r_body_from_sensor = np.zeros((3, 3))
    for row, name in enumerate((forward, left, up)):
        if name not in _SIGNED_AXES:
            raise ConfigurationError(
                "unknown sensor axis", place="sensor axes", expected="±x, ±y or ±z", found=name
            )
        column, sign = _SIGNED_AXES[name]
        r_body_from_sensor[row, column] = sign
    if not np.isclose(np.linalg.det(r_body_from_sensor), 1.0):
        raise ConfigurationError(
            "not a right-handed frame",
            place="sensor axes",
            expected="forward × left = up",
            found=f"forward={forward}, left={left}, up={up}",
        )
    return np.asarray(r_body_from_sensor @ np.asarray(vectors, dtype=np.float64))
