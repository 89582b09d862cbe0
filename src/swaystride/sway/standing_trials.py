"""Standing trials of one participant: import with exclusion rules, and sway measures per trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from swaystride.errors import RecordingError
from swaystride.findings import FINDING_COLUMNS, Finding
from swaystride.io.reading import read_recording
from swaystride.recording import Recording, findings_of
from swaystride.signals.filters import Direction, butterworth_lowpass
from swaystride.signals.gaps import fill_short_gaps, missing_runs, present_span
from swaystride.signals.orientation import FusionMethod, remap_axes
from swaystride.sway.angles import trunk_angles
from swaystride.sway.metrics import sway_metrics

EXCLUSION_COLUMNS = ("trial", "file", "reason", "expected", "found")


@dataclass(frozen=True)
class RecordingRules:
    """When a standing trial can be used.

    Parameters
    ----------
    rate_hz : float or None
        Sampling rate for files that do not say it; None: the file must.
    units : mapping of str to str, or None
        Units of ``acc``, ``gyr`` (and ``mag``) for files that do not state them.
    shortest_duration_s : float
        A trial shorter than this is excluded.
    longest_gap_s : float
        A trial with a longer run of missing samples is excluded; shorter ones are filled.
    """

    rate_hz: float | None
    units: Mapping[str, str] | None
    shortest_duration_s: float
    longest_gap_s: float


@dataclass(frozen=True)
class MeasurementMethod:
    """How sway is measured on a usable trial.

    Parameters
    ----------
    sensor_forward, sensor_left, sensor_up : str
        Sensor axes that point there when the participant stands (assumed alignment).
    fusion, tau_acc_s, level_sensor
        See :func:`swaystride.sway.angles.trunk_angles`.
    remove_mean_rate : bool
        Subtract each axis' mean angular rate: over a standing trial the net rotation is nil, so
        that the mean is the gyroscope's bias.
    filter_order, cutoff_hz, filter_direction, pad_s
        See :func:`swaystride.signals.filters.butterworth_lowpass`.
    longest_gap_s : float
        Longest run of missing samples that is filled by interpolation.
    """

    sensor_forward: str
    sensor_left: str
    sensor_up: str
    fusion: FusionMethod
    tau_acc_s: float
    level_sensor: bool
    remove_mean_rate: bool
    filter_order: int
    cutoff_hz: float
    filter_direction: Direction
    pad_s: float
    longest_gap_s: float


@dataclass(frozen=True)
class ImportedTrials:
    """What the import of one participant yields.

    Parameters
    ----------
    recordings : mapping of str to Recording
        Usable trials by name, gaps still NaN.
    findings, exclusions : DataFrame
        What the checks saw; which trials are left out and why.
    """

    recordings: Mapping[str, Recording]
    findings: pd.DataFrame
    exclusions: pd.DataFrame


def import_trials(
    files: Mapping[str, Path],
    folder: Path,
    rules: RecordingRules,
    excluded_by_lab: Mapping[str, str],
) -> ImportedTrials:
    """Read all trials of one participant and apply the exclusion rules.

    Parameters
    ----------
    files : mapping of str to Path
        Trial name to its file, relative to `folder`, in the order of the session.
    folder : Path
        Where the study's recordings lie.
    rules : RecordingRules
    excluded_by_lab : mapping of str to str
        Trials that the lab itself leaves out, with its reason; their files are not read.

    Returns
    -------
    ImportedTrials

    Raises
    ------
    RecordingError
        If a file is missing or is not a usable recording: the unit stops, others go on.
    """
    recordings: dict[str, Recording] = {}
    findings: list[dict[str, str]] = []
    exclusions: list[dict[str, str]] = []
    for trial, file in files.items():
        if trial in excluded_by_lab:
            row = {"reason": excluded_by_lab[trial], "expected": "", "found": ""}
            exclusions.append({"trial": trial, "file": str(file), **row})
            continue
        recording = _read_trial(folder / file, str(file), rules)
        findings += [{"trial": trial, **asdict(finding)} for finding in findings_of(recording)]
        reason = unusable(recording, rules)
        if reason is None:
            recordings[trial] = recording
        else:
            exclusions.append({"trial": trial, "file": str(file), **reason})
    return ImportedTrials(
        recordings,
        pd.DataFrame(findings, columns=["trial", *FINDING_COLUMNS]),
        pd.DataFrame(exclusions, columns=list(EXCLUSION_COLUMNS)),
    )


def unusable(recording: Recording, rules: RecordingRules) -> dict[str, str] | None:
    """Why a trial is excluded (reason, expected, found), or None if it is usable.

    A trial that the rules call lost has lost too much of its data: it ended early, or its radio
    link was down for longer than may be filled.

    Parameters
    ----------
    recording : Recording
        One trial.
    rules : RecordingRules
        When a trial can be used.
    """
    rate_hz = recording.attrs["rate_hz"]
    duration_s = (recording.sizes["time"] - 1) / rate_hz
    # half a sample of tolerance: durations are multiples of the sampling interval
    if duration_s < rules.shortest_duration_s - 0.5 / rate_hz:
        expected, found = f"at least {rules.shortest_duration_s:g} s", f"{duration_s:.2f} s"
        return {"reason": "data loss: trial too short", "expected": expected, "found": found}
    runs = missing_runs(_signals(recording))
    longest_s = float(runs["length"].max()) / rate_hz if len(runs) else 0.0
    if longest_s > rules.longest_gap_s:
        expected, found = f"no gap over {rules.longest_gap_s:g} s", f"{longest_s:.2f} s"
        return {"reason": "data loss: gap too long", "expected": expected, "found": found}
    return None


def filtered_sway(recording: Recording, method: MeasurementMethod) -> tuple[np.ndarray, np.ndarray]:
    """Trunk angles of one trial as they are analysed: aligned, fused, filtered.

    Parameters
    ----------
    recording : Recording
        One usable trial.
    method : MeasurementMethod
        How sway is measured.

    Returns
    -------
    ap_deg, ml_deg : ndarray, shape (n_samples,)
        Forward and right lean positive.
    """
    rate_hz = recording.attrs["rate_hz"]
    longest_gap = round(method.longest_gap_s * rate_hz)
    acc, gyr = fill_short_gaps(_signals(recording), longest_gap=longest_gap).reshape(2, 3, -1)
    if method.remove_mean_rate:
        gyr = gyr - gyr.mean(axis=1, keepdims=True)
    axes = {
        "forward": method.sensor_forward,
        "left": method.sensor_left,
        "up": method.sensor_up,
    }
    angles = trunk_angles(
        remap_axes(acc, **axes),
        remap_axes(gyr, **axes),
        rate_hz,
        tau_acc_s=method.tau_acc_s,
        method=method.fusion,
        level=method.level_sensor,
    )
    ap_deg, ml_deg = butterworth_lowpass(
        angles,
        cutoff_hz=method.cutoff_hz,
        rate_hz=rate_hz,
        order=method.filter_order,
        direction=method.filter_direction,
        pad_s=method.pad_s,
    )
    return ap_deg, ml_deg


def measure_trial(recording: Recording, method: MeasurementMethod) -> dict[str, float]:
    """Sway measures of one trial, with its duration in s and number of filled samples.

    Parameters
    ----------
    recording : Recording
        One usable trial.
    method : MeasurementMethod
        How sway is measured.
    """
    rate_hz = recording.attrs["rate_hz"]
    ap_deg, ml_deg = filtered_sway(recording, method)
    return {
        "duration_s": (recording.sizes["time"] - 1) / rate_hz,
        "samples_filled": int(missing_runs(_signals(recording))["length"].sum()),
        **sway_metrics(ap_deg, ml_deg, rate_hz),
    }


def _read_trial(path: Path, name: str, rules: RecordingRules) -> Recording:
    """Read one file of one lumbar sensor, from its first to its last complete sample."""
    if not path.is_file():
        raise RecordingError("no such file", file=name, expected="the file named in trials.tsv")
    recording = read_recording(path, rate_hz=rules.rate_hz, units=rules.units)
    for signal in ("acc", "gyr"):
        if signal not in recording:
            finding = Finding("missing_signal", "error", name, "", signal, "not in the file")
            raise finding.as_error(f"signal {signal!r} is missing")
    if recording.sizes["sensor"] != 1:
        raise RecordingError(
            "several sensors in one file",
            file=name,
            expected="the lumbar sensor alone",
            found=", ".join(map(str, recording["sensor"].values)),
        )
    return recording.isel(time=present_span(_signals(recording)))


def _signals(recording: Recording) -> np.ndarray:
    """Accelerometer and gyroscope of the one sensor, shape (6, n_samples)."""
    return np.concatenate([recording["acc"].to_numpy()[0], recording["gyr"].to_numpy()[0]])
