"""When a run cannot be used, and what of its sensors is not: losses, clipping, clocks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import SwaystrideError
from swaystride.findings import Finding
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.sensors_in_step import StepRule, pair_lags_s
from swaystride.studies.experience.design import EVENT_COLUMNS, LOSSES
from swaystride.studies.experience.equipment import Equipment
from swaystride.studies.experience.plan import NEEDED_SENSORS
from swaystride.units import GRAVITY_M_S2

Signals = dict[str, SegmentSignals]


class UnusableRunError(SwaystrideError):
    """A run is left out; the others go on."""


@dataclass(frozen=True)
class ClippingRule:
    """When a sensor counts as clipped.

    Peaks differ from step to step; only a range makes many of them equal.

    Parameters
    ----------
    least_level_g : float
        No accelerometer in question has a smaller range.
    level_tolerance : float
        Samples that differ by less from the largest of their channel, as a share, are at the range.
    fewest : int
        So many peaks there make it a range.
    margin_s : float
        Samples so near to such a peak are not trusted either.
    """

    least_level_g: float
    level_tolerance: float
    fewest: int
    margin_s: float


def without_losses(
    signals: Signals, events: pd.DataFrame, equipment: Equipment, rate_hz: float, file: str
) -> tuple[Signals, list[Finding]]:
    """Signals without what the lab says is lost or was badly attached.

    Parameters
    ----------
    signals : dict of str to SegmentSignals
        As recorded.
    events : DataFrame
        From :func:`swaystride.studies.experience.design.read_events`.
    equipment : Equipment
        Labels, by which events name sensors.
    rate_hz : float
        Sampling rate.
    file : str
        Of the events, for findings.

    Returns
    -------
    signals : dict of str to SegmentSignals
        Samples within a loss are NaN; a sensor of which nothing is left is not in it.
    findings : list of Finding
        One per loss.
    """
    kept, findings = dict(signals), []
    lost = events[events["event"].isin(LOSSES)]
    columns = (lost[column].tolist() for column in EVENT_COLUMNS)
    for start_s, stop_s, event, label in zip(*columns, strict=True):
        name = equipment.name_of(label)
        if name is None or name not in signals:
            continue
        n_samples = signals[name].acc_m_s2.shape[1]
        first = round(start_s * rate_hz)
        last = n_samples if np.isnan(stop_s) else round(stop_s * rate_hz)
        until = f"{min(last, n_samples) / rate_hz:.1f} s"
        findings.append(
            Finding(
                event,
                "warning",
                file,
                label,
                "signals of the whole run",
                f"none used from {first / rate_hz:.1f} s to {until}",
            )
        )
        acc, gyr = kept[name].acc_m_s2.copy(), kept[name].gyr_rad_s.copy()
        acc[:, first:last] = gyr[:, first:last] = np.nan
        kept[name] = SegmentSignals(acc, gyr)
    return {name: own for name, own in kept.items() if not own.missing().all()}, findings


def require_sensors(
    signals: Mapping[str, SegmentSignals], labels: Mapping[str, str], file: str
) -> list[Finding]:
    """Findings of sensors that are not there.

    Parameters
    ----------
    signals : mapping of str to SegmentSignals
    labels : mapping of str to str
        Label of every sensor that is due.
    file : str
        Of the run.

    Raises
    ------
    UnusableRunError
        If it is one without which there are no events.
    """
    absent = [name for name in labels if name not in signals]
    for name in NEEDED_SENSORS:
        if name in absent:
            raise UnusableRunError(
                "no events without this sensor",
                file=file,
                place=labels[name],
                expected=", ".join(labels[needed] for needed in NEEDED_SENSORS),
                found="no samples of it",
            )
    expected = "a sensor with this label"
    found = "none; its measures are missing"
    return [
        Finding("sensor_missing", "warning", file, labels[name], expected, found) for name in absent
    ]


def without_late_sensors(
    signals: Signals, labels: Mapping[str, str], rate_hz: float, rule: StepRule, file: str
) -> tuple[Signals, list[Finding]]:
    """Signals without pairs of sensors of which one is late.

    Parameters
    ----------
    signals : dict of str to SegmentSignals
        Of the run.
    labels : mapping of str to str
        Label of every sensor.
    rate_hz : float
        Sampling rate.
    rule : StepRule
    file : str
        Of the run.

    Returns
    -------
    signals : dict of str to SegmentSignals
    findings : list of Finding
        One per pair that is left out.

    Raises
    ------
    UnusableRunError
        If it is a pair without which there are no events.
    """
    kept, findings = dict(signals), []
    lags = pair_lags_s(signals, rate_hz, rule)
    late = {pair: lag for pair, lag in lags.items() if abs(lag) > rule.accepted_lag_s}
    for (first, second), lag in late.items():
        place = f"{labels[second]} beside {labels[first]}"
        expected = f"in step within {1e3 * rule.accepted_lag_s:.0f} ms"
        found = f"{1e3 * lag:+.0f} ms"
        # pelvis and sternum, pelvis and head: the one that disagrees with the other two is late
        trunk = first == "lumbar" and sum("lumbar" in pair for pair in late) < 2
        if not trunk and (first in NEEDED_SENSORS or second in NEEDED_SENSORS):
            raise UnusableRunError(
                "sensors out of step", file=file, place=place, expected=expected, found=found
            )
        for name in (second,) if trunk else (first, second):
            kept.pop(name, None)
        findings.append(
            Finding("sensors_out_of_step", "warning", file, place, expected, f"{found}; left out")
        )
    return kept, findings


def clipped_spans(
    signals: Mapping[str, SegmentSignals],
    labels: Mapping[str, str],
    rate_hz: float,
    rule: ClippingRule,
    file: str,
) -> tuple[pd.DataFrame, list[Finding]]:
    """Where the accelerometer of a sensor reached its range.

    Parameters
    ----------
    signals : mapping of str to SegmentSignals
        In the axes of the sensors: a range is one in them alone.
    labels : mapping of str to str
        Label of every sensor.
    rate_hz : float
        Sampling rate.
    rule : ClippingRule
    file : str
        Of the run.

    Returns
    -------
    spans : DataFrame
        ``start_s``, ``stop_s``, ``event`` (``clipped``), ``sensor`` (its label).
    findings : list of Finding
        One per sensor.
    """
    rows, findings = [], []
    for name, own in signals.items():
        runs = _at_range(own.acc_m_s2, rule)
        if not len(runs):
            continue
        rows.append(
            pd.DataFrame(
                {
                    "start_s": runs[:, 0] / rate_hz - rule.margin_s,
                    "stop_s": runs[:, 1] / rate_hz + rule.margin_s,
                    "event": "clipped",
                    "sensor": labels[name],
                }
            )
        )
        expected = "an acceleration within the range of the sensor"
        findings.append(
            Finding(
                "clipped",
                "warning",
                file,
                labels[name],
                expected,
                f"{len(runs)} peaks at its range; peak accelerations of these steps are not used",
            )
        )
    none = pd.DataFrame(columns=["start_s", "stop_s", "event", "sensor"])
    return (pd.concat(rows, ignore_index=True) if rows else none), findings


def _at_range(acc_m_s2: NDArray[np.floating], rule: ClippingRule) -> NDArray[np.int64]:
    """First and last sample of the peaks at the range of a channel; missing samples are none."""
    found = [np.empty((0, 2), dtype=np.int64)]
    for channel in np.nan_to_num(acc_m_s2):
        for signal in (channel, -channel):
            largest = float(signal.max(initial=0.0))
            if largest < rule.least_level_g * GRAVITY_M_S2:
                continue
            at = np.flatnonzero(signal >= (1.0 - rule.level_tolerance) * largest)
            breaks = np.flatnonzero(np.diff(at) > 1)
            peaks = np.stack([at[np.r_[0, breaks + 1]], at[np.r_[breaks, at.size - 1]]], axis=1)
            if len(peaks) >= rule.fewest:
                found.append(peaks)
    return np.unique(np.concatenate(found), axis=0)
