"""All kinematic measures of a run, stride by stride and over any choice of strides (dissertation, §5.3.4.1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.arm_intensity import ARM_COLUMNS, arm_intensity
from swaystride.gait.impact_peaks import (
    ATTENUATION_COLUMNS,
    PEAK_COLUMNS,
    ImpactWindow,
    impact_peaks,
    per_body_mass,
)
from swaystride.gait.running_events import SIDES
from swaystride.gait.segment_ranges import RollWindow, joint_ranges_deg, peak_roll_rates_deg_s
from swaystride.gait.segment_signals import (
    AP,
    ML,
    VERTICAL,
    SegmentSignals,
    SignalFilters,
    lowpassed_parts,
)
from swaystride.gait.spatiotemporal import mean_of_sides
from swaystride.gait.stability_ratios import RATIO_COLUMNS, stability_ratios
from swaystride.gait.vector_coding import (
    COUPLES,
    PERIODS,
    VectorCoding,
    coordination_variability,
    segment_increments,
)

Array = NDArray[np.float64]
Signals = Mapping[str, SegmentSignals]

#: Times and lengths that the table of strides brings along (Table 5.2).
SPATIOTEMPORAL: Final = (
    "speed_m_s",
    "stride_length_m",
    "stride_time_s",
    "contact_time_s",
    "flight_time_s",
    "duty_factor",
)
PER_MASS_COLUMNS: Final = tuple(f"{name}_per_kg" for name in PEAK_COLUMNS)
RANGE_COLUMNS: Final = ("hip_range_deg", "knee_range_deg", "peak_roll_rate_deg_s")
#: One value per stride.
STRIDE_MEASURES: Final = (
    *SPATIOTEMPORAL,
    *PEAK_COLUMNS,
    *PER_MASS_COLUMNS,
    *ATTENUATION_COLUMNS,
    *RATIO_COLUMNS,
    *RANGE_COLUMNS,
    *ARM_COLUMNS,
)
#: One value per choice of strides.
COORDINATION_MEASURES: Final = tuple(
    f"{distal}_{proximal}_{period}" for distal, proximal in COUPLES for period in PERIODS
)
#: All 36.
MEASURES: Final = (*STRIDE_MEASURES, *COORDINATION_MEASURES)

PELVIS: Final = "lumbar"
HEAD: Final = "head"


@dataclass(frozen=True)
class MeasureRules:
    """How the measures of a run are taken.

    Parameters
    ----------
    filters : SignalFilters
        Low-pass of acceleration and rate.
    impact : ImpactWindow
        Where peaks of shank and pelvis are sought.
    roll : RollWindow
        Part of the contact in which the roll rate of a foot is judged.
    coding : VectorCoding
        How coordination variability is measured.
    coding_cutoff_hz : float
        Low-pass of the rates for it.
    arm : {"upper_arm", "wrist"}
        Sensor that stands for the arm.
    remove_pelvis_mean, remove_arm_mean : bool
        Whether the mean over the stride is subtracted before root mean squares.
    """

    filters: SignalFilters
    impact: ImpactWindow
    roll: RollWindow
    coding: VectorCoding
    coding_cutoff_hz: float
    arm: Literal["upper_arm", "wrist"]
    remove_pelvis_mean: bool
    remove_arm_mean: bool


@dataclass(frozen=True, eq=False)
class RunMeasures:
    """Measures of a run.

    Parameters
    ----------
    strides : DataFrame
        The strides as given, with one column per measure of :data:`STRIDE_MEASURES`.
    increments : dict of str to dict of str to ndarray
        Changes of the angles of ``foot``, ``shank``, ``thigh`` and ``pelvis`` in the strides of
        each side, from :func:`swaystride.gait.vector_coding.segment_increments`; NaN in strides
        that have no toe-off within them.
    coding : VectorCoding
        How coordination variability is measured.
    """

    strides: pd.DataFrame
    increments: Mapping[str, Mapping[str, NDArray[np.floating]]]
    coding: VectorCoding

    def mean_over(self, keep: NDArray[np.bool_]) -> pd.Series:
        """Every measure over some of the strides: mean per side, then of both sides.

        Parameters
        ----------
        keep : ndarray of bool, shape (n_strides,)
            Which strides count.

        Returns
        -------
        Series
            A value for each of :data:`MEASURES`; missing where a side has none.
        """
        side = self.strides["side"]
        kept = self.strides.loc[keep, list(STRIDE_MEASURES)]
        values = mean_of_sides(kept, side[keep])
        rows = []
        for name in SIDES:
            chosen = keep[(side == name).to_numpy()]
            parts = {
                segment: steps[chosen].astype(np.float64)
                for segment, steps in self.increments[name].items()
            }
            rows.append(coordination_variability(parts, self.coding))
        coordination = pd.DataFrame(rows).mean(axis=0, skipna=False)
        joined: pd.Series = pd.concat([values, coordination])[list(MEASURES)]
        return joined


def measure_run(
    signals: Signals,
    strides: pd.DataFrame,
    *,
    rate_hz: float,
    mass_kg: float,
    rules: MeasureRules,
) -> RunMeasures:
    """Take all measures of a run in its strides.

    Parameters
    ----------
    signals : mapping of str to SegmentSignals
        In anatomical axes, as recorded, by sensor: ``foot_right``, ``shank_left``, ``thigh_right``,
        ``lumbar``, ``head``, ``upper_arm_left``, ``wrist_right``, … Measures of a sensor that is not
        among them are missing; a bilateral one needs both.
    strides : DataFrame
        As from :func:`swaystride.gait.spatiotemporal.with_lengths`.
    rate_hz : float
        Sampling rate.
    mass_kg : float
        Of the runner.
    rules : MeasureRules

    Returns
    -------
    RunMeasures
    """
    peaks = _peaks(signals, strides, rate_hz, rules)
    columns = [peaks, per_body_mass(peaks, mass_kg)]
    columns.append(_ratios(signals, strides, rate_hz, rules))
    columns.append(_ranges(signals, strides, rate_hz, rules))
    columns.append(_arms(signals, strides, rate_hz, rules))
    measured = pd.concat([strides, *columns], axis=1)
    increments: dict[str, dict[str, NDArray[np.floating]]] = {
        side: _increments(signals, strides[strides["side"] == side], side, rate_hz, rules)
        for side in SIDES
    }
    return RunMeasures(measured, increments, rules.coding)


def _acceleration(signals: Signals, name: str, rate_hz: float, rules: MeasureRules) -> Array | None:
    """Filtered acceleration of a sensor, or None if it is missing."""
    if name not in signals:
        return None
    return lowpassed_parts(signals[name].acc_m_s2, rules.filters.acc_cutoff_hz, rate_hz)


def _rate(signals: Signals, name: str, axis: int, cutoff_hz: float, rate_hz: float) -> Array | None:
    """Filtered rate of a sensor about one axis, or None if it is missing."""
    if name not in signals:
        return None
    return lowpassed_parts(signals[name].gyr_rad_s[axis], cutoff_hz, rate_hz)


def _peaks(
    signals: Signals, strides: pd.DataFrame, rate_hz: float, rules: MeasureRules
) -> pd.DataFrame:
    """Peak accelerations and attenuation of every step."""
    longitudinal = {
        name: lowpassed_parts(
            signals[name].acc_m_s2[VERTICAL], rules.filters.acc_cutoff_hz, rate_hz
        )
        for name in ("shank_right", "shank_left", PELVIS, HEAD)
        if name in signals
    }
    n_samples = next(iter(signals.values())).acc_m_s2.shape[1]
    both = all(f"shank_{side}" in longitudinal for side in SIDES)
    unknown = np.full(n_samples, np.nan)
    return impact_peaks(
        strides,
        shank_acc_m_s2={side: longitudinal[f"shank_{side}"] if both else unknown for side in SIDES},
        pelvis_acc_m_s2=longitudinal.get(PELVIS),
        head_acc_m_s2=longitudinal.get(HEAD),
        rate_hz=rate_hz,
        window=rules.impact,
    )


def _ratios(
    signals: Signals, strides: pd.DataFrame, rate_hz: float, rules: MeasureRules
) -> pd.DataFrame:
    """Ratios of the pelvis acceleration."""
    acc = _acceleration(signals, PELVIS, rate_hz, rules)
    if acc is None:
        return pd.DataFrame(np.nan, index=strides.index, columns=list(RATIO_COLUMNS))
    return stability_ratios(strides, acc, rate_hz, remove_mean=rules.remove_pelvis_mean)


def _ranges(
    signals: Signals, strides: pd.DataFrame, rate_hz: float, rules: MeasureRules
) -> pd.DataFrame:
    """Ranges of hip and knee, and roll rates of the feet."""
    found = pd.DataFrame(np.nan, index=strides.index, columns=list(RANGE_COLUMNS))
    cutoff = rules.filters.gyr_cutoff_hz
    pelvis = _rate(signals, PELVIS, ML, cutoff, rate_hz)
    for side in SIDES:
        own = (strides["side"] == side).to_numpy()
        begin, end = (strides.loc[own, name].to_numpy(float) for name in ("start_s", "stop_s"))
        thigh = _rate(signals, f"thigh_{side}", ML, cutoff, rate_hz)
        shank = _rate(signals, f"shank_{side}", ML, cutoff, rate_hz)
        roll = _rate(signals, f"foot_{side}", AP, cutoff, rate_hz)
        for name, distal, proximal in (
            ("hip_range_deg", thigh, pelvis),
            ("knee_range_deg", shank, thigh),
        ):
            if distal is not None and proximal is not None:
                found.loc[own, name] = joint_ranges_deg(distal, proximal, begin, end, rate_hz)
        if roll is not None:
            found.loc[own, "peak_roll_rate_deg_s"] = peak_roll_rates_deg_s(
                roll, strides.loc[own], rate_hz, rules.roll
            )
    return found


def _arms(
    signals: Signals, strides: pd.DataFrame, rate_hz: float, rules: MeasureRules
) -> pd.DataFrame:
    """Intensity of each arm in the strides of its own side."""
    found = pd.DataFrame(np.nan, index=strides.index, columns=list(ARM_COLUMNS))
    for side in SIDES:
        acc = _acceleration(signals, f"{rules.arm}_{side}", rate_hz, rules)
        if acc is not None:
            own = (strides["side"] == side).to_numpy()
            found.loc[own] = arm_intensity(
                strides.loc[own], acc, rate_hz, remove_mean=rules.remove_arm_mean
            )
    return found


def _increments(
    signals: Signals, strides: pd.DataFrame, side: str, rate_hz: float, rules: MeasureRules
) -> dict[str, NDArray[np.floating]]:
    """Changes of the angles of the leg of one side and of the pelvis in its strides."""
    start, off, stop = (
        strides[name].to_numpy(float) for name in ("start_s", "toe_off_s", "stop_s")
    )
    divided = (off > start) & (stop > off)
    found: dict[str, NDArray[np.floating]] = {}
    names = {part: f"{part}_{side}" for part in ("foot", "shank", "thigh")} | {"pelvis": PELVIS}
    for segment, name in names.items():
        rate = _rate(signals, name, ML, rules.coding_cutoff_hz, rate_hz)
        if rate is not None:
            steps = segment_increments(rate, strides.loc[divided], rate_hz)
            found[segment] = np.full((len(strides), steps.shape[-1]), np.nan, dtype=np.float32)
            found[segment][divided] = steps
    return found
