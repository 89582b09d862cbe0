"""Strides of a limited IMU beside those of the baseline: matched in time, compared in length and angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.units import DEG_PER_RAD

#: Columns that :func:`difference_summary` returns.
DIFFERENCE_COLUMNS: Final = (
    "n_matched",
    "length_difference_mean_m",
    "length_difference_sd_m",
    "n_angles",
    "angle_difference_mean_deg",
    "angle_difference_sd_deg",
)


@dataclass(frozen=True, eq=False)
class Matches:
    """Pairs of strides.

    Parameters
    ----------
    baseline, other : ndarray of int, shape (n_pairs,)
        Rows of the two tables.
    """

    baseline: NDArray[np.intp]
    other: NDArray[np.intp]


def match_strides(baseline: pd.DataFrame, other: pd.DataFrame) -> Matches:
    """Pair each stride with the one of the other table that is nearest in time.

    Two strides are as far apart as their starts or their stops, whichever is more. They are a pair
    if each is the nearest to the other and they are less than half a baseline stride apart: what
    one estimate splits or takes for one stride with its neighbour has no partner.

    Parameters
    ----------
    baseline, other : DataFrame
        ``start_s`` and ``stop_s``.

    Returns
    -------
    Matches

    Examples
    --------
    >>> baseline = pd.DataFrame({"start_s": [0.0, 1.0, 2.0], "stop_s": [1.0, 2.0, 3.0]})
    >>> other = pd.DataFrame({"start_s": [0.1, 2.1], "stop_s": [1.1, 3.0]})
    >>> matches = match_strides(baseline, other)
    >>> matches.baseline.tolist(), matches.other.tolist()
    ([0, 2], [0, 1])
    """
    if baseline.empty or other.empty:
        none = np.empty(0, dtype=np.intp)
        return Matches(none, none)
    ends = [table[["start_s", "stop_s"]].to_numpy(dtype=np.float64) for table in (baseline, other)]
    apart = np.abs(ends[0][:, np.newaxis] - ends[1][np.newaxis, :]).max(axis=2)
    nearest_other = apart.argmin(axis=1)
    nearest_baseline = apart.argmin(axis=0)
    rows = np.arange(len(baseline))
    mutual = nearest_baseline[nearest_other] == rows
    duration = ends[0][:, 1] - ends[0][:, 0]
    close = apart[rows, nearest_other] < 0.5 * duration
    kept = rows[mutual & close]
    return Matches(kept, nearest_other[kept])


def difference_summary(baseline: pd.DataFrame, other: pd.DataFrame) -> dict[str, float]:
    """Mean and spread of the differences baseline − other, over the matched strides of one foot.

    The half strides at both ends are left out: a person who starts or stops is not running.

    Parameters
    ----------
    baseline, other : DataFrame
        From :func:`swaystride.gait.strides.stride_table`.

    Returns
    -------
    dict
        :data:`DIFFERENCE_COLUMNS`; standard deviations are divided by n − 1 and NaN below two
        strides.
    """
    matches = match_strides(baseline, other)
    ours, theirs = baseline.iloc[matches.baseline], other.iloc[matches.other]
    whole = ~(ours["is_half"].to_numpy(bool) | theirs["is_half"].to_numpy(bool))
    length = ours["length_m"].to_numpy(float) - theirs["length_m"].to_numpy(float)
    angle = DEG_PER_RAD * (ours["angle_rad"].to_numpy(float) - theirs["angle_rad"].to_numpy(float))
    n_matched, length_mean, length_sd = _moments(length[whole])
    n_angles, angle_mean, angle_sd = _moments(angle[whole & np.isfinite(angle)])
    values = (n_matched, length_mean, length_sd, n_angles, angle_mean, angle_sd)
    return dict(zip(DIFFERENCE_COLUMNS, values, strict=True))


def pooled_sd(n: NDArray[np.float64], mean: NDArray[np.float64], sd: NDArray[np.float64]) -> float:
    """Standard deviation of several samples taken together, from the moments of each.

    Parameters
    ----------
    n, mean, sd : ndarray, shape (n_samples,)
        Size, mean and standard deviation (n − 1) of each sample; one of fewer than two values may
        have NaN.

    Returns
    -------
    float
        NaN if there are fewer than two values in all.

    Examples
    --------
    >>> one, other = np.array([1.0, 2.0, 6.0]), np.array([4.0, 5.0])
    >>> moments = [(x.size, x.mean(), x.std(ddof=1)) for x in (one, other)]
    >>> bool(np.isclose(pooled_sd(*np.array(moments).T), np.r_[one, other].std(ddof=1)))
    True
    """
    there = n > 0
    sizes, means = n[there], mean[there]
    total = sizes.sum()
    if total < 2:
        return float("nan")
    within = (sizes - 1) * np.nan_to_num(sd[there]) ** 2
    centre = (sizes * means).sum() / total
    between = sizes * (means - centre) ** 2
    return float(np.sqrt((within.sum() + between.sum()) / (total - 1)))


def _moments(values: NDArray[np.float64]) -> tuple[int, float, float]:
    """Size, mean and standard deviation, NaN where they do not exist."""
    n = values.size
    mean = float(values.mean()) if n else float("nan")
    return n, mean, float(values.std(ddof=1)) if n > 1 else float("nan")
