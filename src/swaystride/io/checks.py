"""Checks that every reader makes; each returns findings, errors among them.

What concerns the text itself (truncated lines, delimiters, missing columns, fields that are not
numbers) is found while parsing, in :mod:`swaystride.io.table`.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from swaystride.findings import Finding
from swaystride.io.hints import rates_agree
from swaystride.io.packet_counter import lost_between
from swaystride.recording import Recording
from swaystride.units import DEG_PER_RAD, GRAVITY_M_S2

Array = NDArray[np.float64]

#: Fewest samples from which a median says something about a unit.
FEWEST_SAMPLES_FOR_UNITS = 20
#: The median size of the proper acceleration of a person, from quiet standing to a sprinting foot
#: (45 m/s² at 7 m/s); m/s² taken for g would give 96 m/s² at rest.
HUMAN_ACCELERATION_M_S2 = (4.0, 70.0)
#: No person turns faster than this half of the time (2005 deg/s).
FASTEST_MEDIAN_ANGULAR_RATE_RAD_S = 35.0


def packet_loss(
    index: NDArray[np.int64],
    rate_hz: float,
    *,
    file: str,
    first_line: int,
    row_name: str = "line",
) -> list[Finding]:
    """Lost samples, from the sample index of the rows that are there.

    Parameters
    ----------
    index : ndarray of int, shape (n_rows,)
        Sample index of each row.
    rate_hz : float
    file : str
    first_line : int
        Line number of the first row.
    row_name : str
        What the file's rows are called: lines of a text, rows of a data set.

    Returns
    -------
    list of Finding
        Empty, or one warning with the number lost and the longest run.

    Examples
    --------
    >>> packet_loss(np.array([0, 1, 4, 5]), 100.0, file="a.txt", first_line=6)[0].found
    '2 of 6 packets lost in 1 gap, the longest 2 packets (0.020 s)'
    """
    lost = lost_between(index)
    gaps = np.flatnonzero(lost > 0)
    if gaps.size == 0:
        return []
    first, longest = int(gaps[0]), int(lost.max())
    return [
        Finding(
            "packet_loss",
            "warning",
            file,
            f"first at t = {(index[first] + 1) / rate_hz:.3f} s, before {row_name} "
            f"{first_line + first + 1}",
            "no lost packet",
            f"{int(lost.sum())} of {int(index[-1]) + 1} packets lost in {_count(gaps.size, 'gap')}"
            f", the longest {_count(longest, 'packet')} ({longest / rate_hz:.3f} s)",
        )
    ]


def nan_run(
    values: Array,
    index: NDArray[np.int64],
    rate_hz: float,
    *,
    file: str,
    first_line: int,
    signal: str,
    row_name: str = "line",
) -> list[Finding]:
    """Samples without a number in rows that are there.

    Parameters
    ----------
    values : ndarray, shape (n_channels, n_rows)
        One signal of one sensor; a row counts if any channel is NaN.
    index, rate_hz, file, first_line, row_name
        As for :func:`packet_loss`.
    signal : str
        What to call it in the finding.

    Returns
    -------
    list of Finding
        Empty, or one warning that names the first place, the number of samples and the longest run.

    Examples
    --------
    >>> acc = np.array([[0.0, np.nan, np.nan, 0.0]])
    >>> nan_run(acc, np.arange(4), 100.0, file="a.txt", first_line=6, signal="acc")[0].found
    '2 of 4 samples without a number in 1 run, the longest 2 samples (0.020 s)'
    """
    missing = np.isnan(values).any(axis=0)
    if not missing.any():
        return []
    edges = np.diff(missing.astype(np.int8), prepend=0, append=0)
    starts, stops = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    first, longest = int(starts[0]), int((stops - starts).max())
    return [
        Finding(
            "nan_run",
            "warning",
            file,
            f"{signal}, first at t = {index[first] / rate_hz:.3f} s, {row_name} {first_line + first}",
            "a number in every field",
            f"{int(missing.sum())} of {missing.size} samples without a number in "
            f"{_count(starts.size, 'run')}, the longest {_count(longest, 'sample')} "
            f"({longest / rate_hz:.3f} s)",
        )
    ]


def acceleration_unit(acc_m_s2: Array, *, file: str, signal: str = "acc") -> list[Finding]:
    """Check that the size of the acceleration fits its unit.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (3, n)
        Acceleration after conversion.
    file, signal : str

    Returns
    -------
    list of Finding
        One error if the median size is above 70 m/s², or both median and mean are below 4 m/s²; empty
        with fewer than 20 samples.

    Examples
    --------
    >>> acc = np.tile([[0.0], [0.0], [1.0]], 50)
    >>> acceleration_unit(acc, file="a.txt")[0].found
    'a median of 1 m/s²: values look like g, not m/s²'
    """
    size = _sizes(acc_m_s2)
    low, high = HUMAN_ACCELERATION_M_S2
    if size.size < FEWEST_SAMPLES_FOR_UNITS:
        return []
    median = float(np.median(size))
    # a runner is in flight for half of the time, but on average the ground carries everybody
    if median <= high and max(median, float(size.mean())) >= low:
        return []
    found = f"a median of {median:.4g} m/s²"
    for unit, factor in (("g", 1.0), ("mg", 1000.0)):
        if low <= median / factor * GRAVITY_M_S2 <= high:
            found += f": values look like {unit}, not m/s²"
    return [
        Finding(
            "acceleration_unit",
            "error",
            file,
            signal,
            f"a median |acc| from {low:g} to {high:g} m/s² (about {GRAVITY_M_S2:.1f} at rest)",
            found,
        )
    ]


def angular_rate_unit(gyr_rad_s: Array, *, file: str, signal: str = "gyr") -> list[Finding]:
    """Check that the size of the angular rate fits its unit.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (3, n)
        Angular rate after conversion.
    file, signal : str

    Returns
    -------
    list of Finding
        One error if the median size is above 35 rad/s; empty with fewer than 20 samples.

    Examples
    --------
    >>> angular_rate_unit(np.full((3, 50), 60.0), file="a.txt")[0].found
    'a median of 103.9 rad/s: values look like deg/s, not rad/s'
    """
    median = _median_size(gyr_rad_s)
    if median is None or median <= FASTEST_MEDIAN_ANGULAR_RATE_RAD_S:
        return []
    limit = FASTEST_MEDIAN_ANGULAR_RATE_RAD_S
    return [
        Finding(
            "angular_rate_unit",
            "error",
            file,
            signal,
            f"a median |gyr| of at most {limit:g} rad/s ({limit * DEG_PER_RAD:.0f} deg/s)",
            f"a median of {median:.4g} rad/s: values look like deg/s, not rad/s",
        )
    ]


def check_same_trial(recordings: Sequence[Recording]) -> list[Finding]:
    """Files of one trial must agree in length and rate, and start at the same packet.

    Parameters
    ----------
    recordings : sequence of Recording
        One per file; each is compared with the first.

    Returns
    -------
    list of Finding
        Errors ``same_trial_rate`` and ``same_trial_length``; a warning ``same_trial_start`` if the
        files count packets (attribute ``first_packet``) and start at different ones.

    Examples
    --------
    >>> from swaystride.recording import make_recording
    >>> a, b = (make_recording(rate_hz=100.0, rate_source="argument", sensors=["lumbar"],
    ...                        acc_m_s2=np.zeros((1, 3, n)), source_file=f"{n}.txt")
    ...         for n in (50, 51))
    >>> [(finding.check, finding.found) for finding in check_same_trial([a, b])]
    [('same_trial_length', '51 samples')]
    """
    findings = []
    for other in recordings[1:]:
        first = recordings[0]
        file, place = other.attrs["source_file"], f"beside {first.attrs['source_file']}"
        rates = first.attrs["rate_hz"], other.attrs["rate_hz"]
        if not rates_agree(*rates):
            findings.append(
                Finding("same_trial_rate", "error", file, place, *(f"{r:.7g} Hz" for r in rates))
            )
        sizes = first.sizes["time"], other.sizes["time"]
        if sizes[0] != sizes[1]:
            findings.append(
                Finding("same_trial_length", "error", file, place, *(f"{n} samples" for n in sizes))
            )
        starts = first.attrs.get("first_packet"), other.attrs.get("first_packet")
        if None not in starts and starts[0] != starts[1]:
            findings.append(
                Finding(
                    "same_trial_start", "warning", file, place, *(f"packet {p}" for p in starts)
                )
            )
    return findings


def stop_on_error(findings: Iterable[Finding]) -> list[Finding]:
    """Return the findings if none is an error.

    Raises
    ------
    RecordingError
        From the first finding that is an error.
    """
    findings = list(findings)
    for finding in findings:
        if finding.severity == "error":
            raise finding.as_error()
    return findings


def _sizes(values: Array) -> Array:
    size = np.sqrt(np.einsum("ij,ij->j", values, values))
    return np.asarray(size[np.isfinite(size)])


def _median_size(values: Array) -> float | None:
    size = _sizes(values)
    return float(np.median(size)) if size.size >= FEWEST_SAMPLES_FOR_UNITS else None


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}{'' if number == 1 else 's'}"
