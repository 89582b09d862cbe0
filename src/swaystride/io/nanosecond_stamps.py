"""Time stamps of 19 digits, read as whole numbers: a float would lose the last three."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io.table import Table

_NEWLINE, _RETURN, _ZERO = 10, 13, ord("0")
_MOST_DIGITS = 19
_LARGEST = np.uint64(np.iinfo(np.int64).max)


def drop_truncated_stamps(
    table: Table, column: str, *, digits: int | None = None
) -> tuple[Table, NDArray[np.int64], NDArray[np.bool_], list[Finding]]:
    r"""Read a column of nanoseconds; a row whose stamp has lost digits is emptied and marked.

    Parameters
    ----------
    table : Table
    column : str
        Name of the column.
    digits : int, optional
        Digits of a whole stamp; the most frequent number in the file if not given.

    Returns
    -------
    table : Table
        The same table, with the marked rows empty, so that the line numbers stay.
    stamps_ns : ndarray of int64, shape (n_rows,)
        0 where the stamp is truncated.
    kept : ndarray of bool, shape (n_rows,)
    findings : list of Finding
        A warning if rows are left out.

    Raises
    ------
    RecordingError
        If no row has a whole stamp.

    Examples
    --------
    >>> from swaystride.io.source_text import SourceText
    >>> from pathlib import Path
    >>> text = b"time,ecg\n1714920600006020096,1\n17149206000,2\n1714920600021384960,3\n"
    >>> table = Table(SourceText(Path("a.csv"), text, ""), ("time", "ecg"), ",", 9, 2)
    >>> _, stamps, kept, findings = drop_truncated_stamps(table, "time")
    >>> stamps[kept], findings[0].place
    (array([1714920600006020096, 1714920600021384960]), 'first at line 3')
    """
    data = table.source.data
    body = data[table.start :].rstrip(b"\r\n")
    if not body:
        raise RecordingError(
            "no data rows",
            file=table.source.name,
            place=f"line {table.first_line}",
            expected="numbers after the column row",
            found="end of file",
        )
    characters = np.frombuffer(body, dtype=np.uint8)
    first, last = _field_bounds(characters, table, table.positions([column])[0])
    lengths = last - first
    stamps, plain = _whole_numbers(characters, first, lengths)
    if digits is None:
        digits = int(np.bincount(lengths[plain & (lengths > 0)], minlength=1).argmax())
        if lengths[0] == digits - 1 and stamps[0] >= 9 * 10 ** (digits - 2):
            # The clock passes a power of ten during the recording.
            digits -= 1
    kept = plain & (lengths >= max(digits, 1))
    if not kept.any():
        raise RecordingError(
            f"no row has a whole time stamp in column {column}",
            file=table.source.name,
            place=f"from line {table.first_line}",
            expected=f"{digits} digits" if digits else "whole nanoseconds",
            found=repr(body[:60].split(b"\n")[0].decode("ascii", "replace")),
        )
    if kept.all():
        return table, stamps, kept, []
    bad = np.flatnonzero(~kept)
    lines = body.split(b"\n")
    for row in bad:
        lines[row] = table.delimiter.encode() * (len(table.columns) - 1)
    emptied = data[: table.start] + b"\n".join(lines) + b"\n"
    finding = Finding(
        "truncated_time_stamp",
        "warning",
        table.source.name,
        f"first at line {table.first_line + int(bad[0])}",
        f"{digits} digits in column {column}",
        f"fewer; rows left out: {len(bad)} of {len(kept)}",
    )
    table = replace(table, source=replace(table.source, data=emptied))
    return table, np.where(kept, stamps, 0), kept, [finding]


def _field_bounds(
    characters: NDArray[np.uint8], table: Table, position: int
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First character of a field and the one behind it, in every row; the row's end if it is cut."""
    ends = np.append(np.flatnonzero(characters == _NEWLINE), len(characters))
    starts = np.concatenate([[0], ends[:-1] + 1])
    delimiters = np.append(np.flatnonzero(characters == ord(table.delimiter)), len(characters))
    before = np.searchsorted(delimiters, starts)
    stops = delimiters[np.minimum(before + position, len(delimiters) - 1)]
    last = np.minimum(stops, ends)
    if position == 0:
        first = starts
    else:
        opening = delimiters[np.minimum(before + position - 1, len(delimiters) - 1)]
        first = np.minimum(opening + 1, ends)
    last = last - ((last > first) & (characters[np.maximum(last - 1, 0)] == _RETURN))
    return first, np.maximum(last, first)


def _whole_numbers(
    characters: NDArray[np.uint8], first: NDArray[np.int64], lengths: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Value of each field, and whether it is digits only and fits 64 bits with a sign."""
    plain = (lengths > 0) & (lengths <= _MOST_DIGITS)
    value = np.zeros(len(first), dtype=np.uint64)
    for place in range(_MOST_DIGITS):
        inside = plain & (place < lengths)
        digit = characters[np.where(inside, first + place, 0)] - np.uint8(_ZERO)
        plain &= ~inside | (digit <= 9)
        value = np.where(inside, value * np.uint64(10) + digit, value)
    plain &= value <= _LARGEST
    return np.where(plain, value, 0).astype(np.int64), plain
