"""Course of a trial: drift of the filter, strides to its convergence, rest of the feet."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES
from swaystride.studies.kinematics.table_options import TableOptions

Array = NDArray[np.float64]

#: Convergence is looked for among as many strides as this, times those said to suffice.
_EARLY: Final = 3
#: Median absolute deviation to the standard deviation of a normal distribution.
_ROBUST_SD: Final = 1.4826
#: Strides in a row that must be near the settled level: single ones stray at any time.
_IN_A_ROW: Final = 3
#: Share of a stride that must be known.
_KNOWN_SHARE: Final = 0.9
#: Share of a trial that a drift window covers at most.
_LARGEST_WINDOW: Final = 1.0 / 3.0

COURSE_COLUMNS: Final = (
    "participant",
    "trial",
    "side",
    "angle",
    "drift_erkf_deg",
    "drift_integrated_deg",
    "strides_to_convergence",
    "n_strides",
    "midstance_samples_per_stride",
    "duration_s",
    "belt_speed_m_s",
)


def trial_course(
    estimates: xr.Dataset, contacts: pd.DataFrame, options: TableOptions
) -> pd.DataFrame:
    """Drift, convergence and midstance of one trial.

    Parameters
    ----------
    estimates : Dataset
        ``angle_deg`` (source, side, angle, time), ``integrated_deg`` (side, angle, time) and
        ``zero_velocity`` (side, time); attributes ``rate_hz`` and ``belt_speed_m_s``.
    contacts : DataFrame
        Counted strides: ``side``, ``stride``, ``initial_contact_s``, ``next_contact_s``; one row
        per stride.
    options : TableOptions

    Returns
    -------
    DataFrame
        :data:`COURSE_COLUMNS` without the first two. Drift: mean difference from OPTIC in the last
        window minus that in the first, of the filter and of the integrated gyroscope.
        ``strides_to_convergence``: strides from the start of the recording until the median
        difference of a stride stays near its settled level (0: from the first on).
    """
    time_s = estimates["time"].to_numpy().astype(float)
    optic = estimates["angle_deg"].sel(source="optic")
    difference = estimates["angle_deg"].sel(source="erkf") - optic
    integrated = estimates["integrated_deg"] - optic
    rows = []
    for side in SIDES:
        own = contacts[contacts["side"] == side].sort_values("stride")
        starts = stride_starts(own, float(time_s[0]))
        resting = estimates["zero_velocity"].sel(side=side).to_numpy().astype(bool)
        samples = _samples_per_stride(resting, time_s, own)
        for angle in ANGLE_NAMES:
            chosen = {"side": side, "angle": angle}
            error = difference.sel(chosen).to_numpy().astype(float)
            raw = integrated.sel(chosen).to_numpy().astype(float)
            rows.append(
                {
                    **chosen,
                    "drift_erkf_deg": drift(error, time_s, options.drift_window_s),
                    "drift_integrated_deg": drift(raw, time_s, options.drift_window_s),
                    "strides_to_convergence": convergence(error, time_s, starts, options),
                    "n_strides": len(own),
                    "midstance_samples_per_stride": samples,
                    "duration_s": float(time_s[-1] - time_s[0]),
                    "belt_speed_m_s": float(estimates.attrs["belt_speed_m_s"]),
                }
            )
    return pd.DataFrame(rows, columns=list(COURSE_COLUMNS[2:]))


def stride_starts(strides: pd.DataFrame, first_s: float) -> Array:
    """Starts of all strides of a foot, those before the first counted one laid back evenly.

    Parameters
    ----------
    strides : DataFrame
        Counted strides of one foot in order: ``initial_contact_s``, ``next_contact_s``.
    first_s : float
        Start of the recording.

    Returns
    -------
    ndarray
        Ascending; from the recording's first whole stride to the end of the last counted one. Only
        medians over a stride rest on it, to which the phase does not matter.

    Examples
    --------
    >>> own = pd.DataFrame({"initial_contact_s": [2.0, 2.7], "next_contact_s": [2.7, 3.4]})
    >>> stride_starts(own, 0.0).round(2).tolist()
    [0.6, 1.3, 2.0, 2.7, 3.4]
    """
    if strides.empty:
        return np.empty(0)
    begin = strides["initial_contact_s"].to_numpy(dtype=float)
    duration = float(np.median(strides["next_contact_s"].to_numpy(dtype=float) - begin))
    n_before = int(np.floor((begin[0] - first_s) / duration + 1e-9))
    before = begin[0] - duration * np.arange(n_before, 0, -1)
    end = float(strides["next_contact_s"].iloc[-1])
    return np.concatenate([before, begin, [end]])


def drift(error_deg: Array, time_s: Array, window_s: float) -> float:
    """Change of a difference from the start to the end of a trial.

    Parameters
    ----------
    error_deg : ndarray, shape (n,)
        NaN where a source is missing.
    time_s : ndarray, shape (n,)
    window_s : float
        Length of both windows, at most a third of the trial.

    Returns
    -------
    float
        Mean of the last window minus mean of the first, degrees.

    Examples
    --------
    >>> time = np.arange(0.0, 100.0)
    >>> round(drift(0.1 * time, time, 20.0), 9)
    8.0
    """
    window = min(window_s, _LARGEST_WINDOW * (time_s[-1] - time_s[0]))
    first, last = time_s < time_s[0] + window, time_s > time_s[-1] - window
    if not (np.isfinite(error_deg[first]).any() and np.isfinite(error_deg[last]).any()):
        return float("nan")
    return float(np.nanmean(error_deg[last]) - np.nanmean(error_deg[first]))


def convergence(error_deg: Array, time_s: Array, starts_s: Array, options: TableOptions) -> float:
    """Strides until the median difference of a stride stays near its settled level.

    The level and its scatter are those of the strides after ``convergence_strides``, up to three
    times as many: later ones may drift.

    Parameters
    ----------
    error_deg : ndarray, shape (n,)
    time_s : ndarray, shape (n,)
    starts_s : ndarray
        From :func:`stride_starts`.
    options : TableOptions

    Returns
    -------
    float
        Strides before the first three in a row that are near it; infinity without such three, NaN
        with too few strides.
    """
    said = options.convergence_strides
    last = min(starts_s.size, _EARLY * said + 1)
    levels = stride_levels(error_deg, time_s, starts_s[:last])
    settled = levels[said:]
    settled = settled[np.isfinite(settled)]
    if settled.size < 2:
        return float("nan")
    level = float(np.median(settled))
    scatter = _ROBUST_SD * float(np.median(np.abs(settled - level)))
    band = max(options.convergence_band_deg, 3.0 * scatter)
    known = np.flatnonzero(np.isfinite(levels))
    near = np.abs(levels[known] - level) <= band
    stays = np.convolve(near, np.ones(_IN_A_ROW), mode="valid") == _IN_A_ROW
    return float(known[stays.argmax()]) if stays.any() else float("inf")


def stride_levels(error_deg: Array, time_s: Array, starts_s: Array) -> Array:
    """Median of a difference over each stride.

    The median, because a marker that is lost and filled can throw the optical angle off for some
    samples; so a stride is left out where too many samples are missing.

    Parameters
    ----------
    error_deg : ndarray, shape (n,)
    time_s : ndarray, shape (n,)
    starts_s : ndarray, shape (m + 1,)

    Returns
    -------
    ndarray, shape (m,)
        NaN where a tenth of the stride or more has no value.
    """
    size = max(starts_s.size - 1, 0)
    at = np.searchsorted(starts_s, time_s, side="right") - 1
    inside = (at >= 0) & (at < size)
    grouped = pd.Series(error_deg[inside]).groupby(at[inside])
    levels = grouped.median().where(grouped.count() > _KNOWN_SHARE * grouped.size())
    return np.asarray(levels.reindex(range(size)).to_numpy(), dtype=np.float64)


def _samples_per_stride(resting: NDArray[np.bool_], time_s: Array, strides: pd.DataFrame) -> float:
    """Mean number of midstance samples in a counted stride."""
    if strides.empty:
        return float("nan")
    cumulative = np.concatenate([[0], np.cumsum(resting)])
    begin = np.searchsorted(time_s, strides["initial_contact_s"].to_numpy(dtype=float))
    end = np.searchsorted(time_s, strides["next_contact_s"].to_numpy(dtype=float))
    return float((cumulative[end] - cumulative[begin]).mean())
