"""Heart beats of a run, in the time of its sensors."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from swaystride.ecg_recording import UNIX_EPOCH, EcgRecording
from swaystride.errors import RecordingError
from swaystride.findings import Finding, findings_from_json
from swaystride.io.polar_ecg import read_ecg
from swaystride.signals.heart_rate import heart_rate
from swaystride.studies.experience.design import RunFiles

Array = NDArray[np.float64]

_US_PER_S = 1_000_000
_NS_PER_US = 1000


@dataclass(frozen=True, eq=False)
class StrapBeats:
    """Intervals between heart beats.

    Parameters
    ----------
    end_s, interval_s : ndarray, shape (n_intervals,)
        End of each accepted interval, in s from the first sample of the sensors, and its length.
    findings : tuple of Finding
    """

    end_s: Array
    interval_s: Array
    findings: tuple[Finding, ...]


def read_beats(
    run: RunFiles, folder: Path, start_unix_us: int | None, duration_s: float
) -> StrapBeats:
    """Beats of a run.

    Parameters
    ----------
    run : RunFiles
    folder : Path
        Where the study's files lie.
    start_unix_us : int, or None
        Begin of the recording of the sensors, if its file tells it.
    duration_s : float
        Length of that recording.

    Returns
    -------
    StrapBeats
        None if the run has no chest strap, or it recorded at another time: a finding says so. Without
        clocks that can be compared both recordings are taken to begin together.

    Raises
    ------
    RecordingError
        If the file is missing or damaged.
    """
    file = run.files.get("ecg")
    if file is None:
        missing = Finding("no_heart_rate", "warning", "runs.tsv", run.name, "an ECG", "none")
        return StrapBeats(np.empty(0), np.empty(0), (missing,))
    if not (folder / file).is_file():
        raise RecordingError("no such file", file=file, expected="the file named in runs.tsv")
    ecg = read_ecg(folder / file)
    offset_s, doubts = _offset_s(ecg, start_unix_us, file)
    found = heart_rate(ecg["ecg"].to_numpy(), float(ecg.attrs["rate_hz"]), file=file)
    findings = [*findings_from_json(ecg.attrs["findings"]), *doubts, *found.findings]
    end_s = found.rr_end_s + offset_s
    inside = (end_s - found.rr_s >= 0.0) & (end_s <= duration_s)
    if not inside.any():
        expected = f"beats within the {duration_s:.0f} s of the run"
        when = f"{end_s.min():.0f} to {end_s.max():.0f} s"
        findings.append(Finding("heart_rate_elsewhere", "warning", file, "ecg", expected, when))
    return StrapBeats(end_s[inside], found.rr_s[inside], tuple(findings))


def _offset_s(
    ecg: EcgRecording, start_unix_us: int | None, file: str
) -> tuple[float, list[Finding]]:
    """Begin of the ECG after that of the sensors."""
    if start_unix_us is None or ecg.attrs["clock_epoch"] != UNIX_EPOCH:
        expected = "clocks of sensors and chest strap that can be compared"
        found = "none; taken to begin together"
        return 0.0, [Finding("clocks_not_comparable", "info", file, "ecg", expected, found)]
    start_us = int(ecg.attrs["start_ns"]) // _NS_PER_US
    return (start_us - int(start_unix_us)) / _US_PER_S, []


def mean_rate_bpm(end_s: Array, interval_s: Array, start_s: float, stop_s: float) -> float:
    """Mean heart rate over a span.

    Parameters
    ----------
    end_s, interval_s : ndarray, shape (n_intervals,)
        As in :class:`StrapBeats`.
    start_s, stop_s : float
        Span.

    Returns
    -------
    float
        60 s over the mean interval; NaN if intervals within the span cover less than half of it.

    Examples
    --------
    >>> ends = np.arange(1.0, 61.0)
    >>> mean_rate_bpm(ends, np.full(60, 0.5), 0.0, 60.0), mean_rate_bpm(ends, np.ones(60), 0.0, 200.0)
    (120.0, nan)
    """
    inside = (end_s - interval_s >= start_s) & (end_s <= stop_s)
    covered = float(interval_s[inside].sum())
    if covered < 0.5 * (stop_s - start_s):
        return float("nan")
    return 60.0 * int(inside.sum()) / covered
