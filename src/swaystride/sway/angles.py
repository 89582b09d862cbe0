"""Trunk angles from a lumbar sensor."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.signals.orientation import FusionMethod, up_in_sensor
from swaystride.units import DEG_PER_RAD


def trunk_angles(
    acc: ArrayLike,
    gyr: ArrayLike,
    rate_hz: float,
    *,
    tau_acc_s: float = 3.0,
    method: FusionMethod = "vqf",
    level: bool = False,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Anterior-posterior and medio-lateral lean of the trunk.

    Parameters
    ----------
    acc, gyr : array_like, shape (3, n_samples)
        m/s² and rad/s in body-aligned sensor axes: x forward, y left, z up.
    rate_hz : float
        Sampling rate.
    tau_acc_s : float
        Time constant of the accelerometer correction; 3 s is the default of VQF.
    method : {"vqf", "offline_vqf"}
        See :func:`swaystride.signals.orientation.up_in_sensor`.
    level : bool
        Take the mean direction of the vertical in this recording as the sensor's own vertical
        (tilt correction). Without it the alignment is assumed, as in the dissertation (§2.3.3).

    Returns
    -------
    ap_deg, ml_deg : ndarray, shape (n_samples,)
        Lean in degrees, forward and to the right positive (spec §8.1).

    Examples
    --------
    A sensor at rest, leaning 2° forward:

    >>> lean = np.deg2rad(2.0)
    >>> acc = np.tile([[-9.81 * np.sin(lean)], [0.0], [9.81 * np.cos(lean)]], 500)
    >>> ap_deg, ml_deg = trunk_angles(acc, np.zeros((3, 500)), 100.0)
    >>> float(ap_deg[-1].round(2)), float(ml_deg[-1].round(2))
    (2.0, 0.0)
    """
    up = up_in_sensor(acc, gyr, rate_hz=rate_hz, tau_acc_s=tau_acc_s, method=method)
    if level:
        up = _levelled(up)
    ap = np.arctan2(-up[0], up[2])
    ml = np.arctan2(up[1], up[2])
    return ap * DEG_PER_RAD, ml * DEG_PER_RAD


def _levelled(up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotate so that the mean vertical is z, keeping the heading of the forward axis."""
    z = up.mean(axis=1)
    z /= np.linalg.norm(z)
    x = np.array([1.0, 0.0, 0.0]) - z[0] * z
    x /= np.linalg.norm(x)
    r_level_from_sensor = np.stack([x, np.cross(z, x), z])
    return np.asarray(r_level_from_sensor @ up)
