"""Coordination variability of two segments by vector coding (methods §6).

The dissertation names the method only (§5.3.4.1); conventions of Heiderscheit et al. (2002), Chang
et al. (2008) and Needham et al. (2014), in the reading of methods §6 [N].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.segment_ranges import integrated
from swaystride.gait.stride_curves import stride_curves
from swaystride.stats.prediction_ellipse import prediction_factor
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]
VariabilityMethod = Literal["angular_deviation", "circular_sd", "ellipse"]

#: Distal and proximal segment of each couple.
COUPLES: Final = (("foot", "shank"), ("shank", "thigh"), ("thigh", "pelvis"))
#: Intervals of stance, and of swing.
N_INTERVALS: Final = 100
#: Intervals (of stance, then swing) of each period: thirds of stance, last third of swing.
PERIODS: Final[dict[str, slice]] = {
    "early_stance": slice(0, 34),
    "mid_stance": slice(34, 67),
    "late_stance": slice(67, 100),
    "terminal_swing": slice(167, 200),
}


@dataclass(frozen=True)
class VectorCoding:
    """How variability is measured.

    Parameters
    ----------
    method : {"angular_deviation", "circular_sd", "ellipse"}
        √(2(1 − r̄)) or √(−2 ln r̄) of the coupling angles in degrees, or the area of the 95 %
        prediction ellipse of the pairs of increments in square degrees.
    acute : bool
        Whether coupling angles are folded to 0-90° first (Heiderscheit et al. 2002).
    least_strides : int
        Fewer strides give no value: few strides look alike.
    least_vector_share : float
        Intervals whose mean vector is shorter than this share of its largest one do not count: near
        a reversal any scatter turns the angle. 0 keeps all.
    """

    method: VariabilityMethod
    acute: bool
    least_strides: int
    least_vector_share: float


#: Methods §6 [N].
ANGULAR_DEVIATION: Final = VectorCoding("angular_deviation", False, 15, 0.0)
PREDICTION_ELLIPSE: Final = VectorCoding("ellipse", False, 15, 0.0)


def segment_increments(rate_rad_s: ArrayLike, strides: pd.DataFrame, rate_hz: float) -> Array:
    """Changes of a segment's angle over the intervals of stance and swing.

    Parameters
    ----------
    rate_rad_s : array_like, shape (..., n_samples)
        Angular rate of segments about one axis, low-passed at 15 Hz so that the impact does not
        shake them (methods §6); missing samples are NaN.
    strides : DataFrame
        With ``start_s``, ``toe_off_s``, ``stop_s``.
    rate_hz : float
        Sampling rate.

    Returns
    -------
    ndarray, shape (..., n_strides, 200)
        Degrees; 100 intervals from contact to toe-off, 100 to the next contact. The angle is taken
        to be alike at both contacts: a linear drift over the stride is subtracted.

    Raises
    ------
    RecordingError
        If a toe-off is missing or does not lie within its stride.

    Examples
    --------
    >>> strides = pd.DataFrame({"start_s": [0.5], "toe_off_s": [0.75], "stop_s": [1.5]})
    >>> rate = np.radians(10.0) * 2 * np.pi * np.cos(2 * np.pi * (np.arange(1000) / 500 - 0.5))
    >>> steps = segment_increments(rate, strides, 500.0)
    >>> steps.shape, float(steps[0, :100].sum().round(2)), float(abs(steps.sum().round(9)))
    ((1, 200), 10.0, 0.0)
    """
    start, off, stop = (
        strides[name].to_numpy(float) * rate_hz for name in ("start_s", "toe_off_s", "stop_s")
    )
    if not np.all((off > start) & (stop > off)):
        raise RecordingError(
            "strides without a toe-off cannot be divided into stance and swing",
            expected="start_s < toe_off_s < stop_s in every row",
            found=f"{int(np.sum(~((off > start) & (stop > off))))} rows of {off.size} that differ",
        )
    angle = DEG_PER_RAD * integrated(rate_rad_s, rate_hz)
    stance = stride_curves(angle, start, off, N_INTERVALS + 1)
    swing = stride_curves(angle, off, stop, N_INTERVALS + 1)
    steps = np.concatenate([np.diff(stance, axis=-1), np.diff(swing, axis=-1)], axis=-1)
    drift = (swing[..., -1] - stance[..., 0]) / (stop - start)
    part = np.stack([off - start, stop - off], axis=-1) / N_INTERVALS
    return np.asarray(steps - drift[..., None] * np.repeat(part, N_INTERVALS, axis=-1))


def coupling_angles_deg(proximal: ArrayLike, distal: ArrayLike, *, acute: bool = False) -> Array:
    """Direction of the change of two angles in the plane of both.

    Parameters
    ----------
    proximal, distal : array_like, one shape
        Changes of the angles of the proximal (abscissa) and the distal segment (ordinate).
    acute : bool
        Whether the signs of the changes are dropped.

    Returns
    -------
    ndarray
        0 to 360°, or 0 to 90°.

    Examples
    --------
    >>> coupling_angles_deg([1.0, -1.0, 0.0], [1.0, 0.0, -2.0]).tolist()
    [45.0, 180.0, 270.0]
    >>> coupling_angles_deg([1.0, -1.0, 0.0], [1.0, 0.0, -2.0], acute=True).tolist()
    [45.0, 0.0, 90.0]
    """
    x, y = (np.asarray(steps, dtype=np.float64) for steps in (proximal, distal))
    if acute:
        x, y = np.abs(x), np.abs(y)
    return np.asarray(np.mod(DEG_PER_RAD * np.arctan2(y, x), 360.0))


def interval_variability(proximal: ArrayLike, distal: ArrayLike, coding: VectorCoding) -> Array:
    """Variability over strides at each interval.

    Parameters
    ----------
    proximal, distal : array_like, shape (n_strides, n_intervals)
        From :func:`segment_increments`; strides with a missing sample do not count.
    coding : VectorCoding

    Returns
    -------
    ndarray, shape (n_intervals,)
        Degrees (square degrees for the ellipse); missing with too few strides and where the mean
        vector is too short.

    Examples
    --------
    Directions all around have the largest angular deviation, √2 rad:

    >>> around = 2 * np.pi * np.arange(20) / 20
    >>> x, y = np.cos(around)[:, None], np.sin(around)[:, None]
    >>> interval_variability(x, y, ANGULAR_DEVIATION).round(2).tolist()
    [81.03]
    """
    x, y = (np.asarray(steps, dtype=np.float64) for steps in (proximal, distal))
    whole = np.isfinite(x).all(axis=1) & np.isfinite(y).all(axis=1)
    x, y = x[whole], y[whole]
    n = len(x)
    if n < max(coding.least_strides, 1):
        return np.full(x.shape[1], np.nan)
    is_area = coding.method == "ellipse"
    spread = _ellipse_area(x, y) if is_area else _circular_spread(x, y, coding)
    mean_length = np.hypot(x.mean(axis=0), y.mean(axis=0))
    short = mean_length < coding.least_vector_share * mean_length.max()
    return np.where(short, np.nan, spread)


def _circular_spread(x: Array, y: Array, coding: VectorCoding) -> Array:
    """Angular deviation or circular standard deviation of the directions, in degrees."""
    if coding.acute:
        x, y = np.abs(x), np.abs(y)
    length = np.hypot(x, y)
    # without any change there is no direction; such a pair counts as 0°, like atan2(0, 0)
    cosine = np.divide(x, length, out=np.ones_like(x), where=length > 0.0)
    sine = np.divide(y, length, out=np.zeros_like(y), where=length > 0.0)
    resultant = np.minimum(np.hypot(cosine.mean(axis=0), sine.mean(axis=0)), 1.0)
    if coding.method == "circular_sd":
        with np.errstate(divide="ignore"):
            return np.asarray(DEG_PER_RAD * np.sqrt(-2.0 * np.log(resultant)))
    # Σ(1 − cos) loses half the digits near 1; the scatter about the mean direction does not
    mean = np.arctan2(sine.mean(axis=0), cosine.mean(axis=0))
    half = 0.5 * (np.arctan2(sine, cosine) - mean)
    return np.asarray(DEG_PER_RAD * np.sqrt(4.0 * np.mean(np.sin(half) ** 2, axis=0)))


def _ellipse_area(x: Array, y: Array) -> Array:
    """Area of the 95 % prediction ellipse of pairs (Schubert & Kirchner 2014)."""
    n = len(x)
    if n < 3:
        return np.full(x.shape[1], np.nan)
    dx, dy = x - x.mean(axis=0), y - y.mean(axis=0)
    xx, yy, xy = ((a * b).sum(axis=0) / (n - 1) for a, b in ((dx, dx), (dy, dy), (dx, dy)))
    determinant = np.maximum(xx * yy - xy**2, 0.0)
    return np.asarray(np.pi * prediction_factor(n) * np.sqrt(determinant))


def coordination_variability(
    increments: Mapping[str, Array], coding: VectorCoding
) -> dict[str, float]:
    """The twelve values of one side: three couples of segments in four periods.

    Parameters
    ----------
    increments : mapping of str to ndarray, shape (n_strides, 200)
        Of ``foot``, ``shank``, ``thigh`` and ``pelvis`` in the same strides, from
        :func:`segment_increments`.
    coding : VectorCoding

    Returns
    -------
    dict of str to float
        ``foot_shank_early_stance`` and so on: mean over the intervals of the period that count.
        Missing where a segment is missing, or with too few strides.
    """
    values: dict[str, float] = {}
    for distal, proximal in COUPLES:
        spread = np.full(2 * N_INTERVALS, np.nan)
        if distal in increments and proximal in increments:
            spread = interval_variability(increments[proximal], increments[distal], coding)
        for period, part in PERIODS.items():
            known = spread[part][np.isfinite(spread[part])]
            mean = float(known.mean()) if known.size else float("nan")
            values[f"{distal}_{proximal}_{period}"] = mean
    return values
