"""Footfalls of a walk or run, and the lengths and widths of strides between them (methods §1.9)."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

Array = NDArray[np.float64]


#: A still sample later than this share of the stride after a contact is not of its stance [N].
_STANCE_SHARE: Final = 0.6


def footfalls(position_m: ArrayLike, zero_velocity: ArrayLike, contacts: ArrayLike) -> Array:
    """Where a foot stands: its mean position over the still samples of each stance.

    Parameters
    ----------
    position_m : array_like, shape (3, n_samples)
        Path of a point of the foot over the ground; on a treadmill in the frame of the belt.
        Missing samples are NaN and do not count.
    zero_velocity : array_like of bool, shape (n_samples,)
        Samples at which the foot is taken to stand still.
    contacts : array_like of int, shape (n_contacts,)
        Samples of initial contact, rising: a stance begins with each.

    Returns
    -------
    ndarray, shape (n_contacts, 3)
        NaN for a stance without a still sample.

    Raises
    ------
    RecordingError
        If the shapes do not fit.

    Examples
    --------
    >>> x = np.array([0.0, 0.1, 0.2, 2.0, 3.0, 3.1, 3.3])
    >>> path = np.stack([x, 0 * x, 0 * x])
    >>> still = np.array([1, 1, 0, 0, 0, 1, 0], dtype=bool)
    >>> footfalls(path, still, [0, 4])[:, 0].round(3).tolist()
    [0.05, 3.1]
    """
    position = np.asarray(position_m, dtype=np.float64)
    still = np.asarray(zero_velocity, dtype=np.bool_)
    at = np.asarray(contacts, dtype=np.int64)
    if position.ndim != 2 or position.shape[0] != 3 or still.shape != position.shape[1:]:
        raise RecordingError(
            "path and still samples do not fit",
            expected="shapes (3, n) and (n,)",
            found=f"{position.shape} and {still.shape}",
        )
    samples = np.flatnonzero(still & np.isfinite(position).all(axis=0))
    stance = np.searchsorted(at, samples, side="right") - 1
    own = stance >= 0
    if at.size > 1:
        # what comes later belongs to a stance whose contact was missed, or lies after the last one
        own[own] = samples[own] - at[stance[own]] <= _STANCE_SHARE * np.median(np.diff(at))
    samples, stance = samples[own], stance[own]
    count = np.bincount(stance, minlength=at.size)
    # about a place nearby, because a run on a belt ends a kilometre from its begin
    origin = np.where(np.isfinite(position[:, at]), position[:, at], 0.0)
    near = position[:, samples] - origin[:, stance]
    total = np.stack([np.bincount(stance, weights=row, minlength=at.size) for row in near])
    return np.asarray((origin + total / np.where(count > 0, count, np.nan)).T)


def stride_lengths(footfall_m: ArrayLike, *, horizontal: bool) -> Array:
    """Distance between consecutive footfalls of one foot.

    Parameters
    ----------
    footfall_m : array_like, shape (n_footfalls, 3)
        From :func:`footfalls`.
    horizontal : bool
        Whether the vertical is left out.

    Returns
    -------
    ndarray, shape (n_footfalls - 1,)
        NaN beside a missing footfall.

    Examples
    --------
    >>> stride_lengths([[0, 0, 0], [3, 4, 0], [3, 4, 2]], horizontal=False).tolist()
    [5.0, 2.0]
    """
    places = np.asarray(footfall_m, dtype=np.float64)[:, : 2 if horizontal else 3]
    return np.asarray(np.linalg.norm(np.diff(places, axis=0), axis=1))


def stride_widths(
    footfall_m: ArrayLike,
    contacts: ArrayLike,
    other_footfall_m: ArrayLike,
    other_contacts: ArrayLike,
    *,
    side: Literal["right", "left"],
) -> Array:
    """Horizontal distance of footfalls from the line through those of the other foot.

    The line joins the last footfall of the other foot before a contact and the first one after it,
    so that a heading or a position that drifts over many strides does no harm.

    Parameters
    ----------
    footfall_m : array_like, shape (n, 3)
        Footfalls of this foot; world axes, z up.
    contacts : array_like, shape (n,)
        Their initial contacts, rising, in any unit of time.
    other_footfall_m, other_contacts : array_like, shape (m, 3) and (m,)
        Of the other foot, in the same world and unit.
    side : {"right", "left"}
        Of this foot.

    Returns
    -------
    ndarray, shape (n,)
        Positive where the foot falls on its own side of the line; the absolute value is the width
        without a sign. NaN where a footfall is missing or the contacts of the feet do not take
        turns: another contact of this foot between the two of the other one.

    Examples
    --------
    >>> right = [[1.0, -0.05, 0.0], [3.0, 0.01, 0.0]]
    >>> left = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]
    >>> stride_widths(right, [1, 3], left, [0, 2, 4], side="right").tolist()
    [0.05, -0.01]
    """
    own = np.asarray(footfall_m, dtype=np.float64)[:, :2]
    other = np.asarray(other_footfall_m, dtype=np.float64)[:, :2]
    time, other_time = np.asarray(contacts), np.asarray(other_contacts)
    after = np.searchsorted(other_time, time, side="right")
    bracketed = (after > 0) & (after < other_time.size)
    widths = np.full(time.size, np.nan)
    place, after = own[bracketed], after[bracketed]
    between = np.searchsorted(time, other_time[after]) - np.searchsorted(
        time, other_time[after - 1]
    )
    line = other[after] - other[after - 1]
    way = place - other[after - 1]
    left_of_line = (line[:, 0] * way[:, 1] - line[:, 1] * way[:, 0]) / np.hypot(*line.T)
    outward = left_of_line if side == "left" else -left_of_line
    widths[bracketed] = np.where(between == 1, outward, np.nan)
    return widths
