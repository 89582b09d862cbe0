"""Strides of a foot: from zero-velocity epoch to zero-velocity epoch."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

STRIDE_COLUMNS = ("start_s", "stop_s", "length_m", "angle_rad", "speed_m_s", "is_half")


def stride_table(trajectory: xr.Dataset) -> pd.DataFrame:
    """Every stride of a trajectory: length, angle to the next stride, speed (Potter et al., §2.2).

    Parameters
    ----------
    trajectory : Dataset
        As from :func:`swaystride.gait.trajectory.foot_trajectory`.

    Returns
    -------
    DataFrame
        ``start_s``, ``stop_s``; ``length_m``, the size of the displacement in three dimensions;
        ``angle_rad``, the angle between this displacement and the next one (missing for the last
        stride and before a rest or gap); ``speed_m_s``, length over duration; ``is_half``: begins or
        ends at rest.

    Examples
    --------
    >>> from swaystride.gait.foot_methods import PRINTED
    >>> from swaystride.gait.trajectory import foot_trajectory
    >>> still = np.tile([[0.0], [0.0], [9.80665]], 300)
    >>> len(stride_table(foot_trajectory(still, 0 * still, 100.0, PRINTED)))
    0
    """
    index = trajectory["epoch_index"].to_numpy()
    is_rest = trajectory["epoch_is_rest"].to_numpy()
    piece = trajectory["epoch_piece"].to_numpy()
    # Two ends of one rest enclose no stride: between them every sample is still.
    still = np.cumsum(np.r_[0, trajectory["zero_velocity"].to_numpy()])
    moved = still[index[1:] + 1] - still[index[:-1]] <= index[1:] - index[:-1]
    is_stride = moved & (piece[1:] == piece[:-1])
    at = trajectory["position"].to_numpy()[:, index]
    vector = np.diff(at, axis=1)
    cross = np.linalg.norm(np.cross(vector[:, :-1].T, vector[:, 1:].T), axis=1)
    angle = np.arctan2(cross, np.sum(vector[:, :-1] * vector[:, 1:], axis=0))
    angle = np.append(np.where(is_stride[1:], angle, np.nan), np.nan)[: len(is_stride)]
    rate_hz = float(trajectory.attrs["rate_hz"])
    start_s, stop_s = index[:-1] / rate_hz, index[1:] / rate_hz
    length = np.linalg.norm(vector, axis=0)
    table: pd.DataFrame = pd.DataFrame(
        {
            "start_s": start_s,
            "stop_s": stop_s,
            "length_m": length,
            "angle_rad": angle,
            "speed_m_s": length / (stop_s - start_s),
            "is_half": is_rest[:-1] | is_rest[1:],
        }
    )
    strides: pd.DataFrame = table.loc[is_stride].reset_index(drop=True)
    return strides


def distance_m(strides: pd.DataFrame) -> float:
    """Distance travelled: the sum of all stride lengths, half strides at both ends included.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`stride_table`.
    """
    return float(strides["length_m"].sum())


def stride_lengths_at(
    trajectory: xr.Dataset, instants_s: ArrayLike, *, horizontal: bool = True
) -> NDArray[np.float64]:
    """Displacement between given instants, for comparison with another system.

    Parameters
    ----------
    trajectory : Dataset
        As from :func:`swaystride.gait.trajectory.foot_trajectory`.
    instants_s : array_like, shape (k,)
        Rising, in s from the first sample; positions between samples are interpolated.
    horizontal : bool
        Whether the vertical is left out.

    Returns
    -------
    ndarray, shape (k - 1,)
        m.

    Raises
    ------
    RecordingError
        If an instant lies outside the recording.
    """
    instants = np.asarray(instants_s, dtype=np.float64)
    time = trajectory["time"].to_numpy()
    if instants.size and (instants.min() < time[0] or instants.max() > time[-1]):
        raise RecordingError(
            "an instant lies outside the recording",
            place="instants_s",
            expected=f"between {time[0]:g} and {time[-1]:g} s",
            found=f"{instants.min():g} to {instants.max():g} s",
        )
    axes = trajectory["position"].to_numpy()[: 2 if horizontal else 3]
    at = np.stack([np.interp(instants, time, axis) for axis in axes])
    return np.asarray(np.linalg.norm(np.diff(at, axis=1), axis=0))
