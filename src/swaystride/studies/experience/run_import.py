"""Import of one run: sensors read, checked and turned into anatomical axes; the chest strap beside."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.sensor_alignment import (
    AlignmentRule,
    SensorAlignment,
    align_sensors,
    alignment_findings,
)
from swaystride.gait.sensors_in_step import StepRule
from swaystride.io.reading import read_recording
from swaystride.recording import Recording, findings_of
from swaystride.studies.experience.chest_strap import StrapBeats, read_beats
from swaystride.studies.experience.design import EVENT_COLUMNS, RunFiles, read_events
from swaystride.studies.experience.equipment import Equipment
from swaystride.studies.experience.run_checks import (
    ClippingRule,
    UnusableRunError,
    clipped_spans,
    require_sensors,
    without_late_sensors,
    without_losses,
)
from swaystride.units import DEG_PER_RAD

Signals = dict[str, SegmentSignals]


@dataclass(frozen=True)
class RunRules:
    """When a run can be used.

    Parameters
    ----------
    rate_hz : float or None
        Sampling rate for files that do not say it; None: the file must.
    units : mapping of str to str, or None
        Units of ``acc`` and ``gyr`` for files that do not state them.
    duplicate_packets : {"error", "keep_first"}
        A packet that stands twice stops the run, or its first row is kept with a finding.
    shortest_after_warm_up_s : float
        A run that lasts for less after the warm-up is left out.
    """

    rate_hz: float | None
    units: Mapping[str, str] | None
    duplicate_packets: Literal["error", "keep_first"]
    shortest_after_warm_up_s: float


@dataclass(frozen=True)
class ImportRules:
    """Everything that the import is told.

    Parameters
    ----------
    run : RunRules
    steps : StepRule
        When sensors count as out of step.
    clipping : ClippingRule
        When a sensor counts as clipped.
    equipment : Equipment
        Labels and mounting.
    alignment : AlignmentRule
    warm_up_s : float
        Left out of the analysis.
    """

    run: RunRules
    steps: StepRule
    clipping: ClippingRule
    equipment: Equipment
    alignment: AlignmentRule
    warm_up_s: float


@dataclass(frozen=True, eq=False)
class ImportedRun:
    """What a usable run consists of.

    Parameters
    ----------
    signals : dict of str to SegmentSignals
        In anatomical axes, by sensor; those that are missing are not in it.
    rate_hz, duration_s : float
        Of the run.
    source : dict of str to str
        File and hash.
    alignment : DataFrame
        ``sensor``, ``r_00`` … ``r_22`` (anatomical from sensor), ``share``, ``off_horizontal_deg``.
    beats : StrapBeats
        Heart beats in the time of the run.
    spans : DataFrame
        Events of the lab, and where a sensor was clipped: ``start_s``, ``stop_s``, ``event``,
        ``sensor``.
    findings : list of Finding
    """

    signals: Signals
    rate_hz: float
    duration_s: float
    source: dict[str, str]
    alignment: pd.DataFrame
    beats: StrapBeats
    spans: pd.DataFrame
    findings: list[Finding]


def import_run(run: RunFiles, folder: Path, rules: ImportRules) -> ImportedRun:
    """Read, check and align one run.

    Parameters
    ----------
    run : RunFiles
    folder : Path
        Where the study's files lie.
    rules : ImportRules

    Returns
    -------
    ImportedRun

    Raises
    ------
    UnusableRunError
        If the run is too short, it has no calibration, or a sensor that gives the events is missing
        or out of step.
    RecordingError
        If a file is missing or damaged, or a sensor is turned over.
    DesignError
        If the table of events is malformed.
    """
    _require_calibration(run)
    equipment, file = rules.equipment, run.files["imu"]
    events = _events(run, folder)
    recording = _read(folder, file, rules.run)
    rate_hz = float(recording.attrs["rate_hz"])
    duration_s = recording.sizes["time"] / rate_hz
    _require_length(duration_s, rules, file)
    signals, lost = without_losses(
        _signals(recording, equipment), events, equipment, rate_hz, run.files.get("events", "")
    )
    findings = [*findings_of(recording), *lost, *require_sensors(signals, equipment.labels, file)]
    signals, late = without_late_sensors(signals, equipment.labels, rate_hz, rules.steps, file)
    clipped, clips = clipped_spans(signals, equipment.labels, rate_hz, rules.clipping, file)
    alignment, doubts = _alignment(run, folder, tuple(signals), rate_hz, rules)
    kept = {name: alignment[name].turned(signals.pop(name)) for name in alignment}
    strap = read_beats(run, folder, recording.attrs.get("start_unix_us"), duration_s)
    source = {name: str(recording.attrs[name]) for name in ("source_file", "source_sha256")}
    return ImportedRun(
        signals=kept,
        rate_hz=rate_hz,
        duration_s=duration_s,
        source=source,
        alignment=alignment_table(alignment),
        beats=strap,
        spans=pd.concat([part for part in (events, clipped) if len(part)] or [events]),
        findings=[*findings, *late, *clips, *doubts, *strap.findings],
    )


def _require_calibration(run: RunFiles) -> None:
    """Without standing and walking a run has no anatomical axes."""
    for kind, what in (("standing", "quiet standing"), ("walking", "walking")):
        if kind not in run.files:
            raise UnusableRunError(
                f"no calibration in {what}",
                file="runs.tsv",
                place=run.name,
                expected=f"a file in the column {kind}",
                found="none",
            )


def _require_length(duration_s: float, rules: ImportRules, file: str) -> None:
    """Something must be left after the warm-up."""
    least = rules.warm_up_s + rules.run.shortest_after_warm_up_s
    if duration_s < least:
        raise UnusableRunError(
            "the run is hardly longer than the warm-up",
            file=file,
            expected=f"{least:g} s at least",
            found=f"{duration_s:.1f} s",
        )


def _events(run: RunFiles, folder: Path) -> pd.DataFrame:
    """What happened in the run; nothing if there is no table."""
    if "events" not in run.files:
        return pd.DataFrame(columns=list(EVENT_COLUMNS))
    return read_events(folder / run.files["events"], name=run.files["events"])


def _read(folder: Path, file: str, rules: RunRules) -> Recording:
    """A recording of the sensors."""
    if not (folder / file).is_file():
        raise RecordingError("no such file", file=file, expected="the file named in runs.tsv")
    return read_recording(
        folder / file,
        rate_hz=rules.rate_hz,
        units=rules.units,
        duplicate_packets=rules.duplicate_packets,
    )


def _signals(recording: Recording, equipment: Equipment) -> Signals:
    """Signals by sensor, in the axes of the sensors, float32; labels that nobody knows are left."""
    found: Signals = {}
    for k, label in enumerate(recording["sensor"].to_numpy().tolist()):
        name = equipment.name_of(str(label))
        if name is not None:
            acc, gyr = (
                recording[signal].to_numpy()[k].astype(np.float32) for signal in ("acc", "gyr")
            )
            found[name] = SegmentSignals(acc, gyr)
    return found


def _alignment(
    run: RunFiles, folder: Path, names: tuple[str, ...], rate_hz: float, rules: ImportRules
) -> tuple[dict[str, SensorAlignment], list[Finding]]:
    """Axes of the sensors of the run, from standing and walking before it."""
    equipment = rules.equipment
    calm: dict[str, Signals] = {}
    findings: list[Finding] = []
    for kind in ("standing", "walking"):
        recording = _read(folder, run.files[kind], rules.run)
        own = float(recording.attrs["rate_hz"])
        if not np.isclose(own, rate_hz, rtol=1e-3):
            raise RecordingError(
                "calibration and run differ in rate",
                file=run.files[kind],
                expected=f"{rate_hz:g} Hz",
                found=f"{own:g} Hz",
            )
        findings += findings_of(recording)
        calm[kind] = _signals(recording, equipment)
    found, absent = _sensors_of(calm["standing"], names, equipment, run.files["standing"])
    try:
        alignment = align_sensors(
            {name: calm["standing"][name] for name in found},
            calm["walking"],
            equipment.mounting,
            rate_hz=rate_hz,
            rule=rules.alignment,
        )
    except RecordingError as error:
        place = equipment.labels.get(error.place or "", error.place)
        raise RecordingError(
            error.problem,
            file=f"{run.files['standing']}, {run.files['walking']}",
            place=place,
            expected=error.expected,
            found=error.found,
        ) from error
    weak = alignment_findings(alignment, rules.alignment, file=run.files["walking"])
    labelled = [replace(f, place=equipment.labels.get(f.place, f.place)) for f in weak]
    return alignment, [*findings, *absent, *labelled]


def _sensors_of(
    standing: Signals, names: tuple[str, ...], equipment: Equipment, file: str
) -> tuple[list[str], list[Finding]]:
    """Sensors of the run that stand as well."""
    require_sensors({name: standing[name] for name in standing}, _only(equipment, names), file)
    found = [name for name in names if name in standing]
    absent = [
        Finding(
            "sensor_not_calibrated",
            "warning",
            file,
            equipment.labels[name],
            "a sensor with this label",
            "none; its measures are missing",
        )
        for name in names
        if name not in standing
    ]
    return found, absent


def _only(equipment: Equipment, names: tuple[str, ...]) -> dict[str, str]:
    """Labels of some sensors."""
    return {name: equipment.labels[name] for name in names}


def alignment_table(alignment: Mapping[str, SensorAlignment]) -> pd.DataFrame:
    """Axes of all sensors as rows.

    Parameters
    ----------
    alignment : mapping of str to SensorAlignment

    Returns
    -------
    DataFrame
        ``sensor``, ``r_00`` … ``r_22``, ``share`` and ``off_horizontal_deg`` (missing where the
        mounting gave the axis).
    """
    rows = []
    for name, own in alignment.items():
        r: NDArray[np.float64] = own.r_anatomical_from_sensor
        row: dict[str, object] = {"sensor": name}
        row |= {f"r_{i}{j}": float(r[i, j]) for i in range(3) for j in range(3)}
        row["share"] = np.nan if own.main is None else own.main.share
        off = np.nan if own.main is None else DEG_PER_RAD * own.main.off_horizontal_rad
        rows.append(row | {"off_horizontal_deg": off})
    return pd.DataFrame(rows)
