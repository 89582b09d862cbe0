"""Parts of a run that count: after the warm-up, without the turn and without lost data (methods §7.1)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.segment_signals import complete_parts, lowpassed_parts
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

EXCLUSION_COLUMNS: Final = ("start_s", "stop_s", "reason")


@dataclass(frozen=True)
class SteadyRule:
    """What does not count as steady running.

    Parameters
    ----------
    warm_up_s : float
        Excluded at the begin.
    turn_rad, turn_window_s : float
        A turn is a change of heading by more than the angle within the window.
    turn_cutoff_hz : float
        Low-pass of the turning rate (4th order, zero lag).
    turn_margin_s : float
        Excluded before and after a turn as well.
    """

    warm_up_s: float
    turn_rad: float
    turn_window_s: float
    turn_cutoff_hz: float
    turn_margin_s: float


#: Warm-up: dissertation, §5.3.4.1; bounds of the turn are not printed: methods §7.1 [N].
PRINTED_STEADY: Final = SteadyRule(600.0, 60.0 * RAD_PER_DEG, 10.0, 1.0, 10.0)


def exclusions(
    yaw_rate_rad_s: ArrayLike,
    rate_hz: float,
    rule: SteadyRule,
    *,
    missing: NDArray[np.bool_] | None = None,
) -> pd.DataFrame:
    """Parts of a run that are left out, and why.

    Parameters
    ----------
    yaw_rate_rad_s : array_like, shape (n_samples,)
        Turning rate of the pelvis about the vertical; missing samples are NaN. The pelvis turns to
        and fro with every stride, so it is the change of heading that is judged, not the path of
        the rate.
    rate_hz : float
        Sampling rate.
    rule : SteadyRule
    missing : ndarray of bool, shape (n_samples,), optional
        Samples that are lost; by default those of the turning rate.

    Returns
    -------
    DataFrame
        ``start_s``, ``stop_s``, ``reason`` (``warm_up``, ``turn`` or ``lost_data``), in this order
        of reasons; parts may overlap.

    Raises
    ------
    RecordingError
        If the run is not longer than the warm-up.

    Examples
    --------
    >>> yaw = np.zeros(12000)
    >>> yaw[9000:9050] = np.pi / 5.0
    >>> exclusions(yaw, 10.0, PRINTED_STEADY)["reason"].tolist()
    ['warm_up', 'turn']
    """
    yaw = np.asarray(yaw_rate_rad_s, dtype=np.float64)
    duration_s = yaw.size / rate_hz
    if duration_s <= rule.warm_up_s:
        raise RecordingError(
            "the run is not longer than the warm-up",
            expected=f"more than {rule.warm_up_s:g} s",
            found=f"{duration_s:.1f} s",
        )
    parts = [(0.0, rule.warm_up_s, "warm_up")] if rule.warm_up_s > 0.0 else []
    parts += [(*turn, "turn") for turn in turns(yaw, rate_hz, rule)]
    lost = np.isnan(yaw) if missing is None else missing
    present = np.where(lost, np.nan, 0.0)
    edges = np.r_[0, complete_parts(present).ravel(), yaw.size].reshape(-1, 2) / rate_hz
    parts += [(a, b, "lost_data") for a, b in edges.tolist() if b > a]
    return pd.DataFrame(parts, columns=list(EXCLUSION_COLUMNS))


def turns(yaw_rate_rad_s: ArrayLike, rate_hz: float, rule: SteadyRule) -> list[tuple[float, float]]:
    """Turns of the path with their margins.

    Parameters
    ----------
    yaw_rate_rad_s : array_like, shape (n_samples,)
        Turning rate of the pelvis about the vertical; missing samples are NaN.
    rate_hz : float
        Sampling rate.
    rule : SteadyRule

    Returns
    -------
    list of tuple of float
        Begin and end in s: all windows with too large a change of heading, and the margins.
    """
    yaw = np.asarray(yaw_rate_rad_s, dtype=np.float64)
    slow = np.nan_to_num(lowpassed_parts(yaw, rule.turn_cutoff_hz, rate_hz))
    heading = np.concatenate([[0.0], np.cumsum(slow)]) / rate_hz
    length = min(round(rule.turn_window_s * rate_hz), yaw.size)
    turned = np.abs(heading[length:] - heading[:-length]) > rule.turn_rad
    edges = np.flatnonzero(np.diff(np.r_[False, turned, False].astype(np.int8)))
    found: list[tuple[float, float]] = []
    for first, last in edges.reshape(-1, 2):
        begin = max(first / rate_hz - rule.turn_margin_s, 0.0)
        end = min((last - 1 + length) / rate_hz + rule.turn_margin_s, yaw.size / rate_hz)
        if found and begin <= found[-1][1]:
            begin, end = found.pop()[0], end
        found.append((float(begin), float(end)))
    return found


def is_steady(start_s: ArrayLike, stop_s: ArrayLike, excluded: pd.DataFrame) -> NDArray[np.bool_]:
    """Which strides (or windows) lie wholly outside all excluded parts.

    Parameters
    ----------
    start_s, stop_s : array_like, shape (n,)
        In s from the first sample.
    excluded : DataFrame
        As from :func:`exclusions`.

    Returns
    -------
    ndarray of bool, shape (n,)

    Examples
    --------
    >>> excluded = pd.DataFrame({"start_s": [0.0], "stop_s": [10.0], "reason": ["warm_up"]})
    >>> is_steady([9.5, 10.0], [10.2, 10.7], excluded).tolist()
    [False, True]
    """
    start, stop = (np.asarray(edge, dtype=np.float64) for edge in (start_s, stop_s))
    begin, end = excluded["start_s"].to_numpy(float), excluded["stop_s"].to_numpy(float)
    overlap = (start[:, None] < end) & (stop[:, None] > begin)
    return np.asarray(~overlap.any(axis=1))
