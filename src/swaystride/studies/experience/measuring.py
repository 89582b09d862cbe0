"""Measures of one run: stride by stride, in sliding windows, and over the whole run (dissertation, §5.3.4.1)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.findings import Finding
from swaystride.gait.event_checks import EventLimits, event_findings
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.impact_peaks import ATTENUATION_COLUMNS, PEAK_COLUMNS
from swaystride.gait.rating_windows import WindowRule, sliding_windows
from swaystride.gait.run_measures import (
    PER_MASS_COLUMNS,
    MeasureRules,
    RunMeasures,
    measure_run,
)
from swaystride.gait.running_events import SIDES, RunningEventRule, running_events
from swaystride.gait.segment_signals import VERTICAL, SegmentSignals
from swaystride.gait.spatiotemporal import StrideRule, running_strides, with_lengths
from swaystride.gait.steady_parts import SteadyRule, exclusions, is_steady
from swaystride.gait.trajectory import foot_trajectory
from swaystride.studies.experience.chest_strap import mean_rate_bpm
from swaystride.studies.experience.design import LOSSES, UNSTEADY
from swaystride.studies.experience.equipment import Equipment
from swaystride.studies.experience.plan import HEART_RATE, MEASURE_KEYS, NEEDED_SENSORS

Signals = dict[str, SegmentSignals]

#: Peaks and attenuations that a clipped sensor spoils.
_OF_SHANK = ("peak_tibial_g", "peak_tibial_g_per_kg", *ATTENUATION_COLUMNS[::2])
_OF_PELVIS = ("peak_pelvic_g", "peak_pelvic_g_per_kg", *ATTENUATION_COLUMNS[:2])
_OF_HEAD = ("peak_head_g", "peak_head_g_per_kg", *ATTENUATION_COLUMNS[1:])

assert {*_OF_SHANK, *_OF_PELVIS, *_OF_HEAD} == {
    *PEAK_COLUMNS,
    *PER_MASS_COLUMNS,
    *ATTENUATION_COLUMNS,
}


@dataclass(frozen=True)
class MetricRules:
    """How a run is measured.

    Parameters
    ----------
    events : RunningEventRule
        Initial contact and toe-off.
    strides : StrideRule
        Which strides are those of a run.
    limits : EventLimits
        From when on events are doubtful.
    trajectory : FootMethod
        Position of the feet.
    measures : MeasureRules
        Everything that is measured in a stride.
    steady : SteadyRule
        What is left out.
    windows : WindowRule
        For associations within a run.
    least_strides : int
        With fewer strides a run or a window has no measures.
    """

    events: RunningEventRule
    strides: StrideRule
    limits: EventLimits
    trajectory: FootMethod
    measures: MeasureRules
    steady: SteadyRule
    windows: WindowRule
    least_strides: int


@dataclass(frozen=True, eq=False)
class RunTables:
    """Measures of one run.

    Parameters
    ----------
    strides : DataFrame
        A row per stride: times, measures, ``is_valid`` (within the rule), ``is_steady``.
    windows : DataFrame
        A row per sliding window: ``start_s``, ``stop_s``, ``n_strides``, all measures.
    whole : DataFrame
        One row: ``n_strides``, ``n_rejected``, all measures.
    findings : list of Finding
    """

    strides: pd.DataFrame
    windows: pd.DataFrame
    whole: pd.DataFrame
    findings: list[Finding]


def measured_run(
    signals: Signals,
    beats: pd.DataFrame,
    spans: pd.DataFrame,
    *,
    rate_hz: float,
    mass_kg: float,
    equipment: Equipment,
    rules: MetricRules,
    file: str,
) -> RunTables:
    """Measure one run.

    Parameters
    ----------
    signals : dict of str to SegmentSignals
        In anatomical axes, by sensor.
    beats : DataFrame
        ``time_s`` (end) and ``interval_s`` of the intervals between heart beats.
    spans : DataFrame
        Events of the lab and clipping: ``start_s``, ``stop_s``, ``event``, ``sensor`` (label).
    rate_hz : float
        Sampling rate.
    mass_kg : float
        Of the runner.
    equipment : Equipment
        Labels, by which spans name sensors.
    rules : MetricRules
    file : str
        Of the run, for findings.

    Returns
    -------
    RunTables

    Raises
    ------
    RecordingError
        If nobody runs, a foot sensor is turned over, or the run is not longer than the warm-up.
    """
    feet = {str(side): signals[f"foot_{side}"] for side in SIDES}
    events = running_events(feet, signals["lumbar"], rate_hz=rate_hz, rule=rules.events)
    timed = running_strides(events, rules.strides)
    trajectories = {
        side: foot_trajectory(foot.acc_m_s2, foot.gyr_rad_s, rate_hz, rules.trajectory)
        for side, foot in feet.items()
    }
    strides = with_lengths(timed, trajectories)
    measured = measure_run(signals, strides, rate_hz=rate_hz, mass_kg=mass_kg, rules=rules.measures)
    left_out = unsteady_parts(signals, spans, rate_hz, rules.steady)
    steady = is_steady(strides["start_s"], strides["stop_s"], left_out)
    table = without_clipped(measured.strides, spans, equipment).assign(is_steady=steady)
    measured = RunMeasures(table, measured.increments, measured.coding)
    counts = table["is_valid"].to_numpy() & steady
    duration_s = next(iter(signals.values())).acc_m_s2.shape[1] / rate_hz
    heart = beats["time_s"].to_numpy(float), beats["interval_s"].to_numpy(float)
    whole = _values(measured, counts, rules.least_strides)
    whole[HEART_RATE] = mean_rate_bpm(*heart, rules.steady.warm_up_s, duration_s)
    number = {
        "n_strides": int(counts.sum()),
        "n_rejected": int((steady & ~table["is_valid"]).sum()),
    }
    return RunTables(
        strides=table,
        windows=_windows(measured, counts, heart, duration_s, rules),
        whole=pd.DataFrame([{**number, **{key: whole[key] for key in MEASURE_KEYS}}]),
        findings=event_findings(table[steady], rules.limits, file=file),
    )


def unsteady_parts(
    signals: Signals, spans: pd.DataFrame, rate_hz: float, rule: SteadyRule
) -> pd.DataFrame:
    """Parts of the run that are left out: warm-up, turns, losses, and what the lab says.

    Parameters
    ----------
    signals : dict of str to SegmentSignals
        In anatomical axes.
    spans : DataFrame
        Events of the lab.
    rate_hz : float
        Sampling rate.
    rule : SteadyRule

    Returns
    -------
    DataFrame
        ``start_s``, ``stop_s``, ``reason``.
    """
    missing = np.logical_or.reduce([signals[name].missing() for name in NEEDED_SENSORS])
    found = exclusions(signals["lumbar"].gyr_rad_s[VERTICAL], rate_hz, rule, missing=missing)
    ours = spans["event"].isin(UNSTEADY) | (
        spans["event"].isin(LOSSES) & spans["sensor"].isin(["", "all"])
    )
    said = spans.loc[ours, ["start_s", "stop_s", "event"]].rename(columns={"event": "reason"})
    lasting = missing.size / rate_hz
    ends = said["stop_s"].where(~said["reason"].isin(LOSSES), said["stop_s"].fillna(lasting))
    said = said.assign(
        start_s=said["start_s"] - rule.turn_margin_s,
        stop_s=ends.fillna(said["start_s"]) + rule.turn_margin_s,
    )
    return pd.concat([part for part in (found, said) if len(part)], ignore_index=True)


def without_clipped(
    strides: pd.DataFrame, spans: pd.DataFrame, equipment: Equipment
) -> pd.DataFrame:
    """Strides without the peaks that a clipped sensor spoils.

    Parameters
    ----------
    strides : DataFrame
        With the columns of :data:`swaystride.gait.run_measures.STRIDE_MEASURES`.
    spans : DataFrame
        With rows ``clipped``.
    equipment : Equipment
        Labels, by which spans name sensors.

    Returns
    -------
    DataFrame
    """
    table = strides.copy()
    clipped = spans[spans["event"] == "clipped"]
    for label, own in clipped.groupby("sensor"):
        name = equipment.name_of(str(label)) or ""
        spoilt = ~is_steady(table["start_s"], table["stop_s"], own)
        if name.startswith("shank"):
            spoilt &= (table["side"] == name.removeprefix("shank_")).to_numpy()
        columns = {"shank": _OF_SHANK, "lumbar": _OF_PELVIS, "head": _OF_HEAD}.get(
            name.split("_")[0], ()
        )
        table.loc[spoilt, list(columns)] = np.nan
    return table


def _values(measured: RunMeasures, counts: NDArray[np.bool_], least: int) -> dict[str, float]:
    """Measures over some strides; missing with too few of them."""
    if int(counts.sum()) < least:
        return dict.fromkeys(MEASURE_KEYS, float("nan"))
    return {str(key): float(value) for key, value in measured.mean_over(counts).items()}


def _windows(
    measured: RunMeasures,
    counts: NDArray[np.bool_],
    heart: tuple[NDArray[np.float64], NDArray[np.float64]],
    duration_s: float,
    rules: MetricRules,
) -> pd.DataFrame:
    """Measures in sliding windows."""
    start = measured.strides["start_s"].to_numpy(float)
    rows = []
    for begin, end in sliding_windows(rules.steady.warm_up_s, duration_s, rules.windows).tolist():
        inside = counts & (start >= begin) & (start < end)
        values = _values(measured, inside, rules.least_strides)
        values[HEART_RATE] = mean_rate_bpm(*heart, begin, end)
        edges = {"start_s": begin, "stop_s": end, "n_strides": int(inside.sum())}
        rows.append({**edges, **{key: values[key] for key in MEASURE_KEYS}})
    return pd.DataFrame(rows)
