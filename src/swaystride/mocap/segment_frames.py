"""Frames from points: pelvis, three points, rigid fits, and the planar angle of three points.

All functions work frame by frame on arrays with trailing axis 3 and pass NaN through.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def unit(vector: Array) -> Array:
    """Vectors of length one.

    Parameters
    ----------
    vector : ndarray, shape (..., 3)
    """
    return np.asarray(vector / np.linalg.norm(vector, axis=-1, keepdims=True))


def across(vector: Array, axis: Array) -> Array:
    """Unit vector of the part of a vector that is perpendicular to a unit axis.

    Parameters
    ----------
    vector, axis : ndarray, shape (..., 3)
    """
    return unit(vector - np.sum(vector * axis, axis=-1, keepdims=True) * axis)


def frame_of(x: Array, y: Array, z: Array) -> Array:
    """Rotation matrices whose columns are three axes.

    Parameters
    ----------
    x, y, z : ndarray, shape (..., 3)
        Perpendicular unit vectors in the world.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        ``r_world_from_frame``.
    """
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def pelvis_frame(front: Array, back: Array) -> tuple[Array, Array]:
    """Anatomical frame of the pelvis in the order of the conventional gait model (methods §5.3).

    Parameters
    ----------
    front, back : ndarray, shape (2, n, 3)
        Right and left anterior and posterior superior iliac spines.

    Returns
    -------
    r_world_from_pelvis : ndarray, shape (n, 3, 3)
        x forward, y up, z right.
    origin_m : ndarray, shape (n, 3)
        Middle of the anterior spines.
    """
    right, left = front
    outward = unit(right - left)
    up = unit(np.cross(left - right, np.mean(back, axis=0) - right))
    return frame_of(np.cross(up, outward), up, outward), (right + left) / 2.0


def trio_frame(proximal: Array, lateral: Array, distal: Array) -> Array:
    """Technical frame of three points: y from the distal to the proximal one, x ⟂ their plane.

    Parameters
    ----------
    proximal, lateral, distal : ndarray, shape (n, 3)
        Joint centre that the upstream segment carries, marker on a wand or the skin, and the
        distal marker (methods §5.6).

    Returns
    -------
    ndarray, shape (n, 3, 3)
        ``r_world_from_technical``.
    """
    y = unit(proximal - distal)
    z = across(lateral - distal, y)
    return frame_of(np.cross(y, z), y, z)


def rigid_fit(points: Array, template: Array) -> tuple[Array, Array, Array]:
    """Pose that carries a template onto points with least squares (Söderkvist and Wedin 1993).

    Parameters
    ----------
    points : ndarray, shape (m, n, 3)
        In the world.
    template : ndarray, shape (m, 3)
        The same points in the frame of the segment.

    Returns
    -------
    r_world_from_template : ndarray, shape (n, 3, 3)
        NaN in frames where a point is missing.
    origin_m : ndarray, shape (n, 3)
        Origin of the template in the world.
    residual_m : ndarray, shape (n,)
        Root mean square distance that is left.
    """
    n = points.shape[1]
    rotation, origin = np.full((n, 3, 3), np.nan), np.full((n, 3), np.nan)
    residual = np.full(n, np.nan)
    known = np.isfinite(points).all(axis=(0, 2))
    seen = points[:, known]
    middle, middle_template = seen.mean(axis=0), template.mean(axis=0)
    scatter = np.einsum("mna,mb->nab", seen - middle, template - middle_template)
    u, _, vt = np.linalg.svd(scatter)
    sign = np.ones((len(u), 3))
    sign[:, 2] = np.linalg.det(u) * np.linalg.det(vt)
    r = np.einsum("nab,nb,nbc->nac", u, sign, vt)
    rotation[known] = r
    origin[known] = middle - r @ middle_template
    placed = np.einsum("nab,mb->mna", r, template) + origin[known]
    residual[known] = np.sqrt(np.mean(np.sum((placed - seen) ** 2, axis=2), axis=0))
    return rotation, origin, residual


def planar_angles(proximal: Array, lateral: Array, distal: Array) -> Array:
    """How far three points are from a line (methods §5.7); 0 is a line.

    Parameters
    ----------
    proximal, lateral, distal : ndarray, shape (n, 3)

    Returns
    -------
    ndarray, shape (3, n)
        Angle at the proximal point (the reading that is printed [N]), angle at the distal point,
        and π minus the angle at the lateral point, rad; the third is the sum of the others.

    Examples
    --------
    >>> three = [np.array([[0.0, 0.0, z]]) for z in (1.0, 0.5, 0.0)]
    >>> three[1][0, 1] = 0.5
    >>> np.degrees(planar_angles(*three)).ravel().round(6).tolist()
    [45.0, 45.0, 90.0]
    """
    at_proximal = _angle_between(lateral - proximal, distal - proximal)
    at_distal = _angle_between(lateral - distal, proximal - distal)
    return np.stack([at_proximal, at_distal, at_proximal + at_distal])


def _angle_between(one: Array, two: Array) -> Array:
    """Angle of two vectors, exact near 0 too."""
    return np.asarray(
        np.arctan2(np.linalg.norm(np.cross(one, two), axis=-1), np.sum(one * two, axis=-1))
    )


def mean_rotation(rotations: Array) -> Array:
    """Rotation closest to a set of rotations; NaN rows are left out.

    Parameters
    ----------
    rotations : ndarray, shape (n, 3, 3)
    """
    u, _, vt = np.linalg.svd(np.nanmean(rotations, axis=0))
    return np.asarray(u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt)
