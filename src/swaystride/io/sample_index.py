"""Where the rows of a file stand on the uniform time axis, or the error that says why not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.hints import ReadHints
from swaystride.io.packet_counter import unwrap_packet_counter
from swaystride.io.time_stamps import StampedSamples, index_from_time_stamps

Array = NDArray[np.float64]

#: Above this a float does not hold every whole number.
LARGEST_COUNTER = 2.0**53


def index_from_counter(
    counter: Array, hints: ReadHints, *, file: str, first_line: int, column: str
) -> tuple[NDArray[np.int64], list[Finding]]:
    """Sample index of each row from its packet counter.

    Parameters
    ----------
    counter : array, shape (n_rows,)
        Packet counter as read.
    hints : ReadHints
        What to do with duplicate packets.
    file : str
        File name, for errors.
    first_line : int
        Line of the first row, for errors.
    column : str
        Name of the column, for errors.

    Returns
    -------
    index : ndarray of int, shape (n_rows,)
        Repeated for duplicate packets, if the hints let them pass.
    findings : list of Finding
        A warning if there are duplicate packets.

    Raises
    ------
    RecordingError
        With the line, if a counter is missing, not a whole number, runs backwards without a
        wrap-around, or is repeated (unless the hints say otherwise).
    """
    bad = np.flatnonzero(
        ~((counter >= 0) & (counter < LARGEST_COUNTER)) | (counter != np.floor(counter))
    )
    if bad.size:
        raise RecordingError(
            f"{column} is not a whole number",
            file=file,
            place=f"line {first_line + int(bad[0])}",
            expected="0, 1, 2, …",
            found=f"{counter[bad[0]]:g}",
        )
    unwrapped = unwrap_packet_counter(counter)
    problems = list(unwrapped.problems)
    findings = []
    if hints.duplicate_packets == "keep_first":
        duplicates = [problem for problem in problems if problem.kind == "duplicate"]
        problems = [problem for problem in problems if problem.kind != "duplicate"]
        if duplicates:
            findings.append(
                Finding(
                    "duplicate_packet",
                    "warning",
                    file,
                    f"first at line {first_line + duplicates[0].row}",
                    f"a packet counter after {duplicates[0].previous}",
                    f"{duplicates[0].value} again; rows left out: {len(duplicates)}",
                )
            )
    if problems:
        raise RecordingError(
            _COUNTER_PROBLEMS[problems[0].kind],
            file=file,
            place=f"line {first_line + problems[0].row}",
            expected=f"a packet counter after {problems[0].previous}",
            found=str(problems[0].value),
        )
    return unwrapped.index, findings


_COUNTER_PROBLEMS = {
    "duplicate": "duplicate packet",
    "backward": "the packet counter runs backwards",
    "jump": "the packet counter jumps by more than half a turn",
}


def index_from_stamps(
    time_s: Array, *, file: str, first_line: int, column: str, row_name: str = "line"
) -> tuple[StampedSamples, list[Finding]]:
    """Sample index and rate from a column of time stamps, with a finding if they are irregular.

    Parameters
    ----------
    time_s : array, shape (n_rows,)
        Time stamps in s.
    file : str
        File name, for errors.
    first_line : int
        Line of the first row, for errors.
    column : str
        Name of the column, for errors.
    row_name : str
        What the file's rows are called: lines of a text, rows of a data set.

    Raises
    ------
    RecordingError
        With the line, if a stamp is missing, repeated or runs backwards, or if there is only one.
    """
    bad = np.flatnonzero(~np.isfinite(time_s))
    if bad.size or len(time_s) < 2:
        raise RecordingError(
            f"{column}: no time stamp" if bad.size else f"{column}: a single time stamp",
            file=file,
            place=f"{row_name} {first_line + (int(bad[0]) if bad.size else 0)}",
            expected="a number in every row, and at least two rows",
            found="an empty field" if bad.size else "one row",
        )
    stamped = index_from_time_stamps(time_s)
    if stamped.bad_rows:
        row = stamped.bad_rows[0]
        step = float(time_s[row] - time_s[row - 1])
        raise RecordingError(
            f"{column}: time stamps do not advance by whole sampling intervals",
            file=file,
            place=f"{row_name} {first_line + row}",
            expected="a stamp at least half a sampling interval after the one before",
            found=f"a step of {step:.6g} s",
        )
    findings = []
    if stamped.worst_jitter > 0.5:
        findings.append(
            Finding(
                "irregular_time_stamps",
                "warning",
                file,
                column,
                "stamps within half a sampling interval of a uniform axis",
                f"{stamped.worst_jitter:.2f} intervals away",
            )
        )
    return stamped, findings
