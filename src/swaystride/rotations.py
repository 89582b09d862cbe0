"""Rotations in one convention: Hamilton quaternions, scalar first, frames in the names.

A rotation ``r_b_from_a`` takes coordinates in frame a to coordinates in frame b:
``v_b = r_b_from_a @ v_a``. A quaternion ``q_b_from_a`` stands for the same rotation. Quaternions
have shape (..., 4) in the order w, x, y, z; matrices (..., 3, 3); vectors and angle triples
(..., 3). Angles are in radians. Rows that contain NaN give NaN.

The arithmetic is :class:`scipy.spatial.transform.Rotation`; this module pins down the conventions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]


def quaternion_from_matrix(r_b_from_a: ArrayLike) -> Array:
    """Quaternion of a rotation matrix, with a scalar part that is not negative.

    Parameters
    ----------
    r_b_from_a : array_like, shape (..., 3, 3)
        Rotation matrices. Matrices printed with few decimals are brought back to the nearest
        rotation.

    Returns
    -------
    ndarray, shape (..., 4)
        Unit quaternions ``q_b_from_a`` (w, x, y, z).

    Examples
    --------
    >>> quaternion_from_matrix([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).round(4)
    array([0.7071, 0.    , 0.    , 0.7071])
    """
    return _by_row(
        r_b_from_a,
        (3, 3),
        (4,),
        lambda rows: _rotations().from_matrix(rows).as_quat(canonical=True, scalar_first=True),
    )


def matrix_from_quaternion(q_b_from_a: ArrayLike) -> Array:
    """Rotation matrix of a quaternion, which need not have unit length.

    Parameters
    ----------
    q_b_from_a : array_like, shape (..., 4)
        Quaternions (w, x, y, z).

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Matrices ``r_b_from_a``.

    Examples
    --------
    >>> half = np.sqrt(0.5)
    >>> (matrix_from_quaternion([half, 0.0, 0.0, half]) @ [1.0, 0.0, 0.0]).round(12) + 0.0
    array([0., 1., 0.])
    """
    return _by_row(
        q_b_from_a,
        (4,),
        (3, 3),
        lambda rows: _rotations().from_quat(rows, scalar_first=True).as_matrix(),
    )


def quaternion_from_roll_pitch_yaw(roll_pitch_yaw_rad: ArrayLike) -> Array:
    """Quaternion of Xsens Euler angles: yaw about z, then pitch about y', then roll about x''.

    Parameters
    ----------
    roll_pitch_yaw_rad : array_like, shape (..., 3)
        Roll, pitch and yaw in radians: ``r_world_from_sensor = Rz(yaw) Ry(pitch) Rx(roll)``
        (Xsens, "Orientation output specifications").

    Returns
    -------
    ndarray, shape (..., 4)
        ``q_world_from_sensor`` (w, x, y, z), with a scalar part that is not negative.

    Examples
    --------
    >>> quaternion_from_roll_pitch_yaw([0.0, 0.0, np.pi / 2]).round(4)
    array([0.7071, 0.    , 0.    , 0.7071])
    """
    return _by_row(
        roll_pitch_yaw_rad,
        (3,),
        (4,),
        lambda rows: (
            _rotations().from_euler("ZYX", rows[:, ::-1]).as_quat(canonical=True, scalar_first=True)
        ),
    )


def exp_map(rotation_vector_rad: ArrayLike) -> Array:
    """Exp: rotation vector to rotation matrix.

    Parameters
    ----------
    rotation_vector_rad : array_like, shape (..., 3)
        Axis times angle.

    Returns
    -------
    ndarray, shape (..., 3, 3)

    Examples
    --------
    >>> (exp_map([0.0, 0.0, np.pi / 2]) @ [1.0, 0.0, 0.0]).round(12) + 0.0
    array([0., 1., 0.])
    """
    return _by_row(
        rotation_vector_rad, (3,), (3, 3), lambda rows: _rotations().from_rotvec(rows).as_matrix()
    )


def log_map(r_b_from_a: ArrayLike) -> Array:
    """Log: rotation matrix to the rotation vector with an angle of at most pi.

    Parameters
    ----------
    r_b_from_a : array_like, shape (..., 3, 3)

    Returns
    -------
    ndarray, shape (..., 3)
        Axis times angle in radians.

    Examples
    --------
    >>> log_map(exp_map([0.1, -0.2, 0.3])).round(12)
    array([ 0.1, -0.2,  0.3])
    """
    return _by_row(
        r_b_from_a, (3, 3), (3,), lambda rows: _rotations().from_matrix(rows).as_rotvec()
    )


def matrix_from_cardan_zxy(angles_rad: ArrayLike) -> Array:
    """Rotation matrix of ISB joint angles, ``Rz(alpha) Rx(beta) Ry(gamma)``.

    Parameters
    ----------
    angles_rad : array_like, shape (..., 3)
        Alpha, beta, gamma of the intrinsic Cardan sequence Z-X'-Y'' (Grood and Suntay 1983;
        Wu et al. 2002).

    Returns
    -------
    ndarray, shape (..., 3, 3)
        ``r_proximal_from_distal``.

    Examples
    --------
    >>> matrix_from_cardan_zxy([0.0, 0.0, 0.0])
    array([[1., 0., 0.],
           [0., 1., 0.],
           [0., 0., 1.]])
    """
    return _by_row(
        angles_rad, (3,), (3, 3), lambda rows: _rotations().from_euler("ZXY", rows).as_matrix()
    )


def cardan_zxy_from_matrix(r_proximal_from_distal: ArrayLike) -> Array:
    """ISB joint angles of a rotation matrix (methods, section 1.8).

    With 1-based elements: ``beta = asin(R32)``, ``alpha = atan2(-R12, R22)``,
    ``gamma = atan2(-R31, R33)``.

    Parameters
    ----------
    r_proximal_from_distal : array_like, shape (..., 3, 3)

    Returns
    -------
    ndarray, shape (..., 3)
        Alpha, beta, gamma in radians, not unwrapped; beta lies within ±pi/2.

    Examples
    --------
    >>> cardan_zxy_from_matrix(matrix_from_cardan_zxy([1.0, 0.2, -0.1])).round(12)
    array([ 1. ,  0.2, -0.1])
    """
    r = np.asarray(r_proximal_from_distal, dtype=np.float64)
    beta = np.arcsin(np.clip(r[..., 2, 1], -1.0, 1.0))
    alpha = np.arctan2(-r[..., 0, 1], r[..., 1, 1])
    gamma = np.arctan2(-r[..., 2, 0], r[..., 2, 2])
    return np.stack([alpha, beta, gamma], axis=-1)


def _rotations() -> type[Rotation]:
    """SciPy's rotations, loaded at their first use: tables and figures never turn anything."""
    from scipy.spatial.transform import Rotation

    return Rotation


def _by_row(
    values: ArrayLike,
    shape_in: tuple[int, ...],
    shape_out: tuple[int, ...],
    convert: Callable[[Array], Array],
) -> Array:
    """Apply a conversion of (n, *shape_in) arrays to any leading shape; NaN rows stay NaN."""
    array = np.asarray(values, dtype=np.float64)
    n_trailing = len(shape_in)
    if array.shape[-n_trailing:] != shape_in:
        raise ValueError(f"the last axes must be {shape_in}, not {array.shape}")
    leading = array.shape[:-n_trailing]
    rows = array.reshape(-1, *shape_in)
    valid = np.isfinite(rows).all(axis=tuple(range(1, rows.ndim)))
    out = np.full((len(rows), *shape_out), np.nan)
    if valid.any():
        out[valid] = convert(rows[valid])
    return out.reshape(*leading, *shape_out)
