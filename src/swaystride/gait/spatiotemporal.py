"""Spatiotemporal measures of running, stride by stride (dissertation, Table 5.2; methods §7.2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from swaystride.gait.running_events import SIDES

Array = NDArray[np.float64]

STRIDE_COLUMNS: Final = (
    "side",
    "start_s",
    "toe_off_s",
    "other_contact_s",
    "stop_s",
    "stride_time_s",
    "contact_time_s",
    "flight_time_s",
    "step_time_s",
    "duty_factor",
    "step_frequency_hz",
    "is_valid",
)
#: A zero-velocity epoch belongs to a stance if it lies within this share of the stride after the
#: contact [N].
_STANCE_SHARE: Final = 0.6


@dataclass(frozen=True)
class StrideRule:
    """Which strides are those of a run.

    Parameters
    ----------
    stride_tolerance : float
        Largest difference of a stride time from the median of both feet, as a share of it.
    shortest_contact_s, longest_contact_s : float
        Limits of the contact time.
    """

    stride_tolerance: float
    shortest_contact_s: float
    longest_contact_s: float


#: Methods §3.5 [N].
RUNNING_STRIDES: Final = StrideRule(0.25, 0.12, 0.40)
#: For toe-off by the literal rule, which falls on mid-stance: the lower limit would reject all.
LITERAL_STRIDES: Final = StrideRule(0.25, 0.0, 0.40)


def running_strides(events: pd.DataFrame, rule: StrideRule) -> pd.DataFrame:
    """Strides from contact to contact of the same foot, with their times.

    Parameters
    ----------
    events : DataFrame
        As from :func:`swaystride.gait.running_events.running_events`.
    rule : StrideRule

    Returns
    -------
    DataFrame
        A row per stride, in the order of its begin: ``side``; ``start_s``, ``toe_off_s``,
        ``other_contact_s`` (the next contact of the other foot, if it comes before the stop),
        ``stop_s``; ``stride_time_s``; ``contact_time_s``; ``flight_time_s``, from toe-off to the
        contact of the other foot; ``step_time_s``, from contact to contact of the other foot;
        ``duty_factor``; ``step_frequency_hz``, two steps per stride; ``is_valid``: within the rule.
        Strides outside it stay in the table, so that they can be counted.

    Examples
    --------
    >>> events = pd.DataFrame({"side": ["right", "left"] * 3, "initial_contact_s": np.arange(6) * 0.35,
    ...                        "toe_off_s": np.arange(6) * 0.35 + 0.2})
    >>> strides = running_strides(events, RUNNING_STRIDES)
    >>> columns = ["stride_time_s", "contact_time_s", "flight_time_s", "duty_factor"]
    >>> strides[columns].iloc[0].round(3).tolist(), len(strides), int(strides["is_valid"].sum())
    ([0.7, 0.2, 0.15, 0.286], 4, 4)
    """
    contacts = {side: _sorted_events(events, side) for side in SIDES}
    tables = []
    for side, other in zip(SIDES, reversed(SIDES), strict=True):
        start, off = contacts[side]
        other_start = contacts[other][0]
        begin, end = start[:-1], start[1:]
        after = np.searchsorted(other_start, begin, side="right")
        opposite = np.append(other_start, np.nan)[after]
        opposite = np.where(opposite < end, opposite, np.nan)
        columns = {"start_s": begin, "toe_off_s": off[:-1], "other_contact_s": opposite}
        tables.append(pd.DataFrame({"side": side, **columns, "stop_s": end}))
    strides: pd.DataFrame = pd.concat(tables).sort_values("start_s", ignore_index=True)
    strides["stride_time_s"] = strides["stop_s"] - strides["start_s"]
    strides["contact_time_s"] = strides["toe_off_s"] - strides["start_s"]
    strides["flight_time_s"] = strides["other_contact_s"] - strides["toe_off_s"]
    strides["step_time_s"] = strides["other_contact_s"] - strides["start_s"]
    strides["duty_factor"] = strides["contact_time_s"] / strides["stride_time_s"]
    strides["step_frequency_hz"] = 2.0 / strides["stride_time_s"]
    usual = strides["stride_time_s"].median()
    strides["is_valid"] = (
        (strides["stride_time_s"] - usual).abs() <= rule.stride_tolerance * usual
    ) & strides["contact_time_s"].between(rule.shortest_contact_s, rule.longest_contact_s)
    return strides[list(STRIDE_COLUMNS)]


def _sorted_events(events: pd.DataFrame, side: str) -> tuple[Array, Array]:
    """Contacts and toe-offs of one foot, in the order of time."""
    own = events.loc[events["side"] == side].sort_values("initial_contact_s")
    return own["initial_contact_s"].to_numpy(float), own["toe_off_s"].to_numpy(float)


def zero_velocity_lengths(strides: pd.DataFrame, trajectory: xr.Dataset) -> Array:
    """Length of strides of one foot, from stance to stance.

    At initial contact a foot still moves; its displacement from one zero-velocity epoch to the next
    is equal on average and scatters less (methods §7.2).

    Parameters
    ----------
    strides : DataFrame
        Rows of one side of the table of :func:`running_strides`.
    trajectory : Dataset
        Of this foot, from :func:`swaystride.gait.trajectory.foot_trajectory`, with the same
        begin of time.

    Returns
    -------
    ndarray, shape (n_strides,)
        Horizontal, in m. NaN where one of the two stances has no epoch or a gap lies between them.
    """
    epoch = trajectory["epoch_index"].to_numpy()
    start, stop = strides["start_s"].to_numpy(float), strides["stop_s"].to_numpy(float)
    if epoch.size == 0:
        return np.full(start.size, np.nan)
    epoch_s = epoch / float(trajectory.attrs["rate_hz"])
    reach = _STANCE_SHARE * (stop - start)
    first, has_first = _epoch_after(epoch_s, start, reach)
    last, has_last = _epoch_after(epoch_s, stop, reach)
    piece = trajectory["epoch_piece"].to_numpy()
    place = trajectory["position"].to_numpy()[:2, epoch]
    length = np.hypot(*(place[:, last] - place[:, first]))
    known = has_first & has_last & (piece[first] == piece[last])
    return np.where(known, length, np.nan)


def _epoch_after(
    epoch_s: Array, contact_s: Array, reach_s: Array
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """First epoch within reach after each contact, and whether there is one."""
    at = np.searchsorted(epoch_s, contact_s)
    there = at < epoch_s.size
    at = np.minimum(at, epoch_s.size - 1)
    return at, there & (epoch_s[at] <= contact_s + reach_s)


def with_lengths(strides: pd.DataFrame, trajectories: dict[str, xr.Dataset]) -> pd.DataFrame:
    """Add length and speed to the strides of both feet.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`running_strides`.
    trajectories : dict of str to Dataset
        ``right`` and ``left``; a side without a trajectory has no lengths.

    Returns
    -------
    DataFrame
        With ``stride_length_m`` and ``speed_m_s`` (length over stride time).
    """
    length = np.full(len(strides), np.nan)
    for side, trajectory in trajectories.items():
        own = (strides["side"] == side).to_numpy()
        length[own] = zero_velocity_lengths(strides.loc[own], trajectory)
    return strides.assign(
        stride_length_m=length, speed_m_s=length / strides["stride_time_s"].to_numpy()
    )


def mean_of_sides(values: pd.DataFrame, side: pd.Series) -> pd.Series:
    """Mean per side, then the mean of both, so that a foot with more strides weighs no more.

    Parameters
    ----------
    values : DataFrame
        A row per stride or step; missing values do not count.
    side : Series
        Side of each row.

    Returns
    -------
    Series
        One value per column; missing where a side has none.

    Examples
    --------
    >>> values = pd.DataFrame({"x": [1.0, 3.0, 5.0]})
    >>> float(mean_of_sides(values, pd.Series(["right", "right", "left"]))["x"])
    3.5
    """
    means = values.groupby(side.to_numpy()).mean().reindex(list(SIDES))
    averaged: pd.Series = means.mean(axis=0, skipna=False)
    return averaged
