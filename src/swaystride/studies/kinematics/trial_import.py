"""Import of one trial: sensors and markers of running and of the standing before it, on one clock."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_from_json
from swaystride.gait.initial_contact import InitialContactRule
from swaystride.io.c3d import read_c3d
from swaystride.io.reading import read_recording
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.joint_axes import public_joint_axes
from swaystride.mocap.marker_cleaning import Cleaning, clean_markers
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT, points
from swaystride.mocap.optical_angles import segment_poses
from swaystride.mocap.static_calibration import PRINTED_OPTIONS, static_model
from swaystride.recording import Recording, findings_of
from swaystride.signals.gaps import fill_short_gaps
from swaystride.studies.kinematics.alignment_in_time import ClockRules, clock_delay_s, shifted
from swaystride.studies.kinematics.equipment import Markers, SensorLabels
from swaystride.studies.kinematics.trial_checks import (
    UnusableTrialError,
    require_overlap,
    require_running,
    require_same_rate,
    require_standing,
    without_frozen,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TrialRules:
    """When a trial can be used.

    Parameters
    ----------
    rate_hz : float or None
        Sampling rate for files that do not say it; None: the file must.
    units : mapping of str to str, or None
        Units of ``acc`` and ``gyr`` for files that do not state them.
    duplicate_packets : {"error", "keep_first"}
        A packet that stands twice stops the participant, or its first row is kept with a finding.
    shortest_duration_s : float
        A shorter uninterrupted run is not used.
    shortest_standing_s : float
        A shorter standing is not used.
    longest_gap_s : float
        Shorter gaps of a sensor are filled; a longer one cuts the recording, and the longest part
        remains.
    """

    rate_hz: float | None
    units: Mapping[str, str] | None
    duplicate_packets: Literal["error", "keep_first"]
    shortest_duration_s: float
    shortest_standing_s: float
    longest_gap_s: float


@dataclass(frozen=True)
class ImportRules:
    """Everything that the import is told.

    Parameters
    ----------
    trial : TrialRules
    clocks : ClockRules
    cleaning : Cleaning
    labels : SensorLabels
    markers : Markers
    contacts : InitialContactRule
        Says what counts as running.
    """

    trial: TrialRules
    clocks: ClockRules
    cleaning: Cleaning
    labels: SensorLabels
    markers: Markers
    contacts: InitialContactRule


@dataclass(frozen=True, eq=False)
class ImportedTrial:
    """What a usable trial consists of.

    Parameters
    ----------
    running : Recording
        Seven sensors in the order of ``SEGMENTS``, gaps filled; the attribute ``start_s`` says where
        in the file its first sample is.
    markers : MarkerRecording
        Clean markers at the same samples.
    standing : Recording
    standing_markers : MarkerRecording
    findings : list of Finding
    """

    running: Recording
    markers: MarkerRecording
    standing: Recording
    standing_markers: MarkerRecording
    findings: list[Finding]


def import_trial(
    files: Mapping[str, str], folder: Path, person: Anthropometrics, rules: ImportRules
) -> ImportedTrial:
    """Read, check and align one trial.

    Parameters
    ----------
    files : mapping of str to str
        By kind (:data:`swaystride.studies.kinematics.design.KINDS`), relative to `folder`.
    folder : Path
    person : Anthropometrics
    rules : ImportRules

    Returns
    -------
    ImportedTrial

    Raises
    ------
    UnusableTrialError
        If a recording is missing, too short or without a marker, or nobody runs in it.
    RecordingError
        If a file is damaged, sensors or markers are exchanged, or lengths contradict the markers.
    """
    for kind, what in (
        ("running_imu", "running recording of the sensors"),
        ("running_markers", "running recording of the markers"),
        ("standing_imu", "static trial of the sensors"),
        ("standing_markers", "static trial of the markers"),
    ):
        if kind not in files:
            raise UnusableTrialError(f"{what} missing", file="trials.tsv", expected=f"a row {kind}")
    markers, labels = rules.markers, rules.labels
    file, film = files["running_imu"], files["running_markers"]
    whole, frozen = without_frozen(
        _sensors(folder, file, rules.trial, labels), rules.trial.longest_gap_s, file
    )
    running, cut = _longest_part(whole, rules.trial, file)
    standing = _standing(folder, files["standing_imu"], rules.trial, labels)
    still = CONVENTIONAL_GAIT.static_markers(medial=False)
    raw_static = _markers(folder, files["standing_markers"], still)
    raw = _markers(folder, film, tuple(dict.fromkeys((*still, *markers.names()))))
    require_same_rate(whole, raw, files)
    require_running(running, file, rules.contacts)
    early = require_overlap(running, raw, rules.trial.shortest_duration_s, film)
    clean = clean_markers(raw, CONVENTIONAL_GAIT, rules.cleaning, names=markers.names())
    model = static_model(
        raw_static,
        CONVENTIONAL_GAIT,
        person,
        options=PRINTED_OPTIONS,
        axes=public_joint_axes("spine_plane"),
    )
    start = round(float(running.attrs["start_s"]) * float(running.attrs["rate_hz"]))
    rotations = segment_poses(clean, model)[0][start:]
    delay_s, late = clock_delay_s(
        running["gyr"].to_numpy(),
        rotations,
        float(running.attrs["rate_hz"]),
        rules.clocks,
        labels.in_order(),
        file,
    )
    aligned = _aligned(clean, delay_s, start, running.sizes["time"])
    findings = [
        *findings_of(running),
        *frozen,
        *cut,
        *findings_of(standing),
        *gap_counts(findings_from_json(clean.attrs["findings"])),
        *early,
        *late,
    ]
    return ImportedTrial(running, aligned, standing, raw_static, findings)


def _read(folder: Path, file: str, rules: TrialRules) -> Recording:
    """A recording of the sensors."""
    if not (folder / file).is_file():
        raise RecordingError("no such file", file=file, expected="the file named in trials.tsv")
    return read_recording(
        folder / file,
        rate_hz=rules.rate_hz,
        units=rules.units,
        duplicate_packets=rules.duplicate_packets,
    )


def _sensors(folder: Path, file: str, rules: TrialRules, labels: SensorLabels) -> Recording:
    """The seven sensors in the order of the segments."""
    recording = _read(folder, file, rules)
    there = [str(name) for name in recording["sensor"].to_numpy()]
    missing = [label for label in labels.in_order() if label not in there]
    if missing:
        raise UnusableTrialError(
            "sensor missing",
            file=file,
            place=", ".join(missing),
            expected="seven sensors with the labels of the configuration",
            found=f"only {', '.join(there)}",
        )
    chosen = recording.sel(sensor=list(labels.in_order()))[["acc", "gyr"]]
    return chosen.assign_coords(sensor=list(SEGMENTS))


def _longest_part(
    recording: Recording, rules: TrialRules, file: str
) -> tuple[Recording, list[Finding]]:
    """Longest part in which no sensor stops for longer than may be filled."""
    rate_hz = float(recording.attrs["rate_hz"])
    signals = np.concatenate([recording["acc"].to_numpy(), recording["gyr"].to_numpy()], axis=1)
    channels = signals.reshape(-1, signals.shape[2])
    longest = round(rules.longest_gap_s * rate_hz)
    filled = fill_short_gaps(channels, longest_gap=longest).reshape(signals.shape)
    finite = np.isfinite(filled)
    whole = np.asarray(finite.all(axis=(0, 1)))
    never_stops = np.asarray(finite.all(axis=(1, 2)))
    edges = np.flatnonzero(np.diff(whole.astype(np.int8), prepend=0, append=0))
    parts = edges.reshape(-1, 2)
    lengths = parts[:, 1] - parts[:, 0]
    best = parts[int(np.argmax(lengths))] if len(parts) else np.zeros(2, dtype=np.int64)
    duration_s = (best[1] - best[0]) / rate_hz
    if duration_s < rules.shortest_duration_s:
        raise UnusableTrialError(
            "data loss: no uninterrupted part that is long enough",
            file=file,
            expected=f"{rules.shortest_duration_s:g} s without a gap over {rules.longest_gap_s:g} s",
            found=f"{duration_s:.2f} s",
        )
    part = slice(int(best[0]), int(best[1]))
    out = recording.isel(time=part).copy()
    # on the clock of the file
    out = out.assign_coords(time=np.arange(part.start, part.stop) / rate_hz)
    out["acc"] = (("sensor", "axis", "time"), filled[:, :3, part])
    out["gyr"] = (("sensor", "axis", "time"), filled[:, 3:, part])
    out.attrs["start_s"] = part.start / rate_hz
    if len(parts) == 1 and part == slice(0, len(whole)):
        return out, []
    stopped = [
        str(name)
        for name, ok in zip(recording["sensor"].to_numpy(), never_stops, strict=True)
        if not ok
    ]
    finding = Finding(
        "recording_interrupted",
        "warning",
        file,
        ", ".join(name.replace("_", " ") for name in stopped),
        f"no gap over {rules.longest_gap_s:g} s",
        f"the part from {part.start / rate_hz:.2f} s to {part.stop / rate_hz:.2f} s is used",
    )
    return out, [finding]


def _standing(folder: Path, file: str, rules: TrialRules, labels: SensorLabels) -> Recording:
    """Quiet standing of the sensors."""
    recording = _sensors(folder, file, rules, labels)
    rate_hz = float(recording.attrs["rate_hz"])
    whole = np.isfinite(recording["gyr"].to_numpy()).all(axis=(0, 1))
    whole &= np.isfinite(recording["acc"].to_numpy()).all(axis=(0, 1))
    if whole.sum() / rate_hz < rules.shortest_standing_s:
        raise UnusableTrialError(
            "static trial of the sensors too short",
            file=file,
            expected=f"{rules.shortest_standing_s:g} s",
            found=f"{whole.sum() / rate_hz:.2f} s",
        )
    standing = recording.isel(time=np.flatnonzero(whole))
    require_standing(standing, file)
    return standing


def _markers(folder: Path, file: str, names: tuple[str, ...]) -> MarkerRecording:
    """Some markers as the file has them; each is seen at least once."""
    if not (folder / file).is_file():
        raise RecordingError("no such file", file=file, expected="the file named in trials.tsv")
    recording = read_c3d(folder / file)
    there = {str(name) for name in recording["marker"].to_numpy()}
    missing = [name for name in names if name not in there]
    if missing:
        raise UnusableTrialError(
            "marker missing throughout",
            file=file,
            place=", ".join(missing),
            expected="all markers of the set",
            found="no such label",
        )
    chosen = recording.sel(marker=list(names))
    try:
        points(chosen, names)
    except RecordingError as error:
        raise UnusableTrialError(
            error.problem,
            file=file,
            place=error.place,
            expected=error.expected,
            found=error.found,
        ) from None
    return chosen


def _aligned(
    markers: MarkerRecording, delay_s: float, start: int, n_samples: int
) -> MarkerRecording:
    """Markers at the samples of the sensors."""
    rate_hz = float(markers.attrs["rate_hz"])
    position = shifted(markers["position"].to_numpy(), delay_s, rate_hz, start + n_samples)
    return xr.Dataset(
        {"position": (("marker", "axis", "time"), position[:, :, start:], {"units": "m"})},
        coords={
            "marker": markers["marker"],
            "axis": markers["axis"],
            "time": (start + np.arange(n_samples)) / rate_hz,
        },
        attrs=dict(markers.attrs),
    )


def gap_counts(findings: list[Finding]) -> list[Finding]:
    """Findings of the markers, the many about single gaps counted.

    Parameters
    ----------
    findings : list of Finding
        Of one recording.

    Returns
    -------
    list of Finding
        Others unchanged; of each kind of ``marker_gap_…`` one with the number of gaps and the marker
        that has most of them.
    """
    kept = [finding for finding in findings if not finding.check.startswith("marker_gap_")]
    for check in ("marker_gap_filled", "marker_gap_stays"):
        gaps = [finding for finding in findings if finding.check == check]
        if not gaps:
            continue
        markers = Counter(gap.place.split(",")[0] for gap in gaps)
        marker, most = markers.most_common(1)[0]
        found = f"{len(gaps)} gaps of {len(markers)} markers, {most} of them of {marker}"
        place = "whole recording"
        kept.append(Finding(check, gaps[0].severity, gaps[0].file, place, "no gap", found))
    return kept
