"""Features of single strides: ranges, peaks, the angle at contact, length and width."""

from __future__ import annotations

from typing import Final, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.gait.footfalls import footfalls, stride_lengths, stride_widths
from swaystride.studies.kinematics.plan import ANGLE_NAMES, FEATURES, SIDES, SOURCES
from swaystride.studies.kinematics.stride_selection import FootStrides

Array = NDArray[np.float64]

RANGE_FEATURES: Final = tuple(f"rom_{angle}" for angle in ANGLE_NAMES)
SPATIAL_FEATURES: Final = ("stride_length_m", "stride_width_m", "stride_width_signed_m")
#: Every feature of a stride, in the order of the tables.
STRIDE_FEATURES: Final = (*RANGE_FEATURES, *FEATURES, *SPATIAL_FEATURES)


def ranges_of_motion(angles_deg: ArrayLike, contacts: ArrayLike) -> Array:
    """Range of each angle within each stride.

    Parameters
    ----------
    angles_deg : array_like, shape (..., n_samples)
    contacts : array_like of int, shape (n_strides + 1,)
        Samples of initial contact, rising.

    Returns
    -------
    ndarray, shape (..., n_strides)
        NaN where a sample of the stride is missing.

    Examples
    --------
    >>> ranges_of_motion([1.0, 5.0, 2.0, 0.0, np.nan], [0, 2, 4]).tolist()
    [4.0, 2.0]
    """
    return _over_strides(np.maximum, angles_deg, contacts) - _over_strides(
        np.minimum, angles_deg, contacts
    )


def peak_features(angles_deg: ArrayLike, contacts: ArrayLike, toe_off: ArrayLike) -> Array:
    """The features of Table 4.6 of each stride.

    Parameters
    ----------
    angles_deg : array_like, shape (..., 9, n_samples)
        Angles of one side in the order of the plan.
    contacts : array_like of int, shape (n_strides + 1,)
        Samples of initial contact, rising.
    toe_off : array_like, shape (n_strides,)
        Samples of toe-off, each within its stride; NaN where unknown.

    Returns
    -------
    ndarray, shape (..., 6, n_strides)
        In the order of :data:`~swaystride.studies.kinematics.plan.FEATURES`: peaks within the
        stride, that of the knee between contact and toe-off; extension and plantarflexion are
        positive. NaN where a sample of the stride is missing.
    """
    angles = np.asarray(angles_deg, dtype=np.float64)
    hip, knee, ankle = (
        angles[..., ANGLE_NAMES.index(name), :]
        for name in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
    )
    at_contact = ankle[..., np.asarray(contacts, dtype=np.int64)[:-1]]
    return np.stack(
        [
            _over_strides(np.maximum, hip, contacts),
            -_over_strides(np.minimum, hip, contacts),
            _stance_maximum(knee, contacts, toe_off),
            _over_strides(np.maximum, ankle, contacts),
            -_over_strides(np.minimum, ankle, contacts),
            at_contact,
        ],
        axis=-2,
    )


def spatial_features(
    estimates: xr.Dataset,
    strides: dict[Literal["right", "left"], FootStrides],
    *,
    horizontal_length: bool,
) -> dict[Literal["right", "left"], Array]:
    """Lengths and widths of all strides of both feet.

    A stride has the length between the footfalls at its begin and at its end, and the width of the
    footfall at its begin.

    Parameters
    ----------
    estimates : xarray.Dataset
        ``foot_position_m`` (source, side, axis, time) and ``zero_velocity`` (side, time).
    strides : dict
        Both feet, from the same samples.
    horizontal_length : bool
        Whether the vertical is left out of the length.

    Returns
    -------
    dict of str to ndarray, shape (n_sources, 3, n_strides)
        By side, in the order of :data:`SPATIAL_FEATURES`; NaN beside a stance without a still
        sample or across a missed contact.
    """
    values = {side: np.empty((len(SOURCES), 3, len(strides[side].regular))) for side in SIDES}
    for row, source in enumerate(SOURCES):
        paths = estimates["foot_position_m"].sel(source=source)
        places = {
            side: footfalls(
                paths.sel(side=side).to_numpy(),
                estimates["zero_velocity"].sel(side=side).to_numpy(),
                strides[side].contacts,
            )
            for side in SIDES
        }
        for side, other in (SIDES, SIDES[::-1]):
            lengths = stride_lengths(places[side], horizontal=horizontal_length)
            width = stride_widths(
                places[side],
                strides[side].contacts,
                places[other],
                strides[other].contacts,
                side=side,
            )[:-1]
            values[side][row] = np.where(strides[side].regular, lengths, np.nan), abs(width), width
    return values


def _over_strides(peak: np.ufunc, values: ArrayLike, contacts: ArrayLike) -> Array:
    """Largest or smallest value from each contact to the sample before the next one."""
    at = np.asarray(contacts, dtype=np.int64)
    whole = np.asarray(values, dtype=np.float64)[..., : at[-1]]
    return np.asarray(peak.reduceat(whole, at[:-1], axis=-1))


def _stance_maximum(values: Array, contacts: ArrayLike, toe_off: ArrayLike) -> Array:
    """Largest value from each contact to toe-off; NaN without a toe-off."""
    at, off = np.asarray(contacts, dtype=np.int64), np.asarray(toe_off, dtype=np.float64)
    known = np.isfinite(off)
    after = np.where(known, np.floor(np.where(known, off, 0.0)), at[:-1]).astype(np.int64) + 1
    edges = np.stack([at[:-1], np.minimum(after, at[1:] - 1)], axis=1).ravel()
    peaks = np.maximum.reduceat(values[..., : at[-1]], edges, axis=-1)[..., ::2]
    return np.where(known, peaks, np.nan)
