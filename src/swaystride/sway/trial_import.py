"""Import of the standing trials of one participant: read, check, exclude by rule."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

import pandas as pd

from swaystride.errors import RecordingError
from swaystride.findings import FINDING_COLUMNS, Finding
from swaystride.io.reading import read_recording
from swaystride.recording import Recording, findings_of, six_axis_signals
from swaystride.signals.gaps import missing_runs, present_span

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
    duplicate_packets : {"error", "keep_first"}
        A packet that stands twice stops the participant, or its first row is kept with a finding.
    shortest_duration_s : float
        A trial shorter than this is excluded.
    longest_duration_s : float
        A trial longer than this is excluded.
    longest_gap_s : float
        A trial with a longer run of missing samples is excluded; shorter ones are filled.
    """

    rate_hz: float | None
    units: Mapping[str, str] | None
    duplicate_packets: Literal["error", "keep_first"]
    shortest_duration_s: float
    longest_duration_s: float
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

    @property
    def summary(self) -> str:
        """How many trials, usable and excluded, and findings."""
        n_usable, n_excluded = len(self.recordings), len(self.exclusions)
        return (
            f"{n_usable + n_excluded} trials, {n_usable} usable, {n_excluded} excluded, "
            f"{len(self.findings)} findings"
        )


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
    if duration_s > rules.longest_duration_s + 0.5 / rate_hz:
        expected, found = f"at most {rules.longest_duration_s:g} s", f"{duration_s:.2f} s"
        return {"reason": "trial too long", "expected": expected, "found": found}
    runs = missing_runs(six_axis_signals(recording))
    longest_s = float(runs["length"].max()) / rate_hz if len(runs) else 0.0
    if longest_s > rules.longest_gap_s:
        expected, found = f"no gap over {rules.longest_gap_s:g} s", f"{longest_s:.2f} s"
        return {"reason": "data loss: gap too long", "expected": expected, "found": found}
    return None


def _read_trial(path: Path, name: str, rules: RecordingRules) -> Recording:
    """Read one file of one lumbar sensor, from its first to its last complete sample."""
    if not path.is_file():
        raise RecordingError("no such file", file=name, expected="the file named in trials.tsv")
    recording = read_recording(
        path,
        rate_hz=rules.rate_hz,
        units=rules.units,
        duplicate_packets=rules.duplicate_packets,
    )
    for signal in ("acc", "gyr"):
        if signal not in recording:
            finding = Finding("missing_signal", "error", name, "", signal, "not in the file")
            raise finding.as_error(f"signal {signal!r} is missing")
    if recording.sizes["sensor"] != 1:
        raise RecordingError(
            "several sensors in one file",
            file=name,
            expected="one sensor in each file",
            found=", ".join(map(str, recording["sensor"].values)),
        )
    return recording.isel(time=present_span(six_axis_signals(recording)))
