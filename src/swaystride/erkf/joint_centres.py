"""Joint centres from the sensors alone (Seel, Schauer and Raisch 2012; methods §1.13).

Both sensors of a joint feel the acceleration of its centre once the acceleration of the sensor
about the centre is taken off; seen from either sensor it has the same size.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from swaystride.signals.filters import lowpass_without_lag

Array = NDArray[np.float64]


class JointCentreFit(NamedTuple):
    """Result of :func:`joint_centre_of`.

    ``proximal_m`` and ``distal_m`` (3,), from the sensors to the centre; ``residual_m_s2``, root
    mean square of what remains; ``sd_m`` (6,), standard deviations of both, as if the residual were
    white.
    """

    proximal_m: Array
    distal_m: Array
    residual_m_s2: float
    sd_m: Array


def lever_matrices(gyr_rad_s: Array, rate_hz: float) -> Array:
    """K with ``K r = ω̇ × r + ω × (ω × r)`` at every sample.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (3, n_samples)
        Low-passed.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (n_samples, 3, 3)
    """
    x, y, z = gyr_rad_s
    dx, dy, dz = np.gradient(gyr_rad_s, 1.0 / rate_hz, axis=1)
    rows = [
        [-(y * y + z * z), x * y - dz, x * z + dy],
        [x * y + dz, -(x * x + z * z), y * z - dx],
        [x * z - dy, y * z + dx, -(x * x + y * y)],
    ]
    return np.ascontiguousarray(np.array(rows).transpose(2, 0, 1))


def joint_centre_of(
    proximal: tuple[Array, Array],
    distal: tuple[Array, Array],
    rate_hz: float,
    *,
    cutoff_hz: float,
    prior_m: tuple[Array, Array],
    prior_sd_m: float | tuple[float, float],
    noise_m_s2: float,
    independent_s: float,
    axes: tuple[Array, Array] | None = None,
) -> JointCentreFit:
    """Vectors from both sensors to the centre of their joint.

    Parameters
    ----------
    proximal, distal : (ndarray, ndarray), each of shape (3, n_samples)
        Accelerometer and gyroscope of both sensors.
    rate_hz : float
        Sampling rate.
    cutoff_hz : float
        Low-pass before rates are differentiated (10-15 Hz).
    prior_m : (ndarray, ndarray)
        Rough vectors from the sensors to the centre: start of the search.
    prior_sd_m : float or (float, float)
        How rough; infinity uses them as the start only. Where the movement says nothing about a
        direction (along the axis of a hinge), the prior decides.
    noise_m_s2 : float
        Size of the residual that is expected (soft tissue); weighs signals against the prior. An
        effective number of independent samples is taken from the cutoff.
    independent_s : float
        How much of the recording says something new: soft tissue does the same in every stride, so
        that many strides weigh as much as one (infinity: the whole recording counts).
    axes : (ndarray, ndarray), optional
        Axis of a hinge in both frames: the mean component along it is taken off both vectors.

    Returns
    -------
    JointCentreFit
    """
    (a1, k1), (a2, k2) = (
        (
            lowpass_without_lag(acc, cutoff_hz, rate_hz).T,
            lever_matrices(lowpass_without_lag(gyr, cutoff_hz, rate_hz), rate_hz),
        )
        for acc, gyr in (proximal, distal)
    )
    # neighbouring samples are alike: about two independent ones per period of the cutoff
    share = min(1.0, independent_s * rate_hz / len(a1))
    weight = np.sqrt(share * min(1.0, 2.0 * cutoff_hz / rate_hz)) / noise_m_s2
    start = np.concatenate(prior_m)
    prior_sd = np.repeat(np.broadcast_to(np.asarray(prior_sd_m, dtype=np.float64), 2), 3)

    def residual(r: Array) -> Array:
        one = np.linalg.norm(a1 + k1 @ r[:3], axis=1)
        two = np.linalg.norm(a2 + k2 @ r[3:], axis=1)
        return np.concatenate([weight * (one - two), (r - start) / prior_sd])

    found = least_squares(residual, start, method="lm", x_scale=0.1)
    r1, r2 = found.x[:3], found.x[3:]
    if axes is not None:
        along = 0.5 * (r1 @ axes[0] + r2 @ axes[1])
        r1, r2 = r1 - along * axes[0], r2 - along * axes[1]
    size = float(np.sqrt(np.mean(np.square(found.fun[: len(a1)]))) / weight)
    jacobian = np.asarray(found.jac, dtype=np.float64)
    covariance = np.linalg.pinv(jacobian.T @ jacobian)
    scale = max(1.0, size / noise_m_s2)
    return JointCentreFit(r1, r2, size, scale * np.sqrt(np.diag(covariance)))
