"""Delimited numbers: a fast C parser when all is well, and the exact place when it is not."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.source_text import SourceText, decode

#: Delimiters that the vendors' export dialogues offer, in the order in which they are tried.
DELIMITERS = {"tab": "\t", "comma": ",", "semicolon": ";", "space": " "}
_NAME_OF = {symbol: name for name, symbol in DELIMITERS.items()}
#: Spellings of a missing number; an empty field is one.
MISSING = ("", "NaN", "nan", "NA")
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_NEWLINE = 10


@dataclass(frozen=True)
class Table:
    """Where the numbers of a file stand.

    Parameters
    ----------
    source : SourceText
    columns : tuple of str
        Names from the column row; the number of fields of every data row.
    delimiter : str
        One character.
    start : int
        Byte offset of the first data row.
    first_line : int
        Line number of the first data row, 1-based.
    decimal : str
        Decimal sign.
    """

    source: SourceText
    columns: tuple[str, ...]
    delimiter: str
    start: int
    first_line: int
    decimal: str = "."

    def positions(self, names: Sequence[str]) -> list[int]:
        """Positions of named columns.

        Raises
        ------
        RecordingError
            If a name does not occur, or occurs twice.
        """
        for name in names:
            if self.columns.count(name) != 1:
                raise RecordingError(
                    f"column {name} is {'missing' if name not in self.columns else 'ambiguous'}",
                    file=self.source.name,
                    place=f"line {self.first_line - 1}",
                    expected=f"one column {name}",
                    found=", ".join(name or "(unnamed)" for name in self.columns),
                )
        return [self.columns.index(name) for name in names]


def name_of_delimiter(delimiter: str) -> str:
    """Return the word for a delimiter, as errors show it."""
    return _NAME_OF.get(delimiter, repr(delimiter))


def split_columns(text: str, *, file: str, line: int, known: re.Pattern[str]) -> tuple[str, ...]:
    r"""Split a column row at the delimiter that it uses.

    Parameters
    ----------
    text : str
        The column row.
    file, line
        Its place, for errors.
    known : re.Pattern
        Matches each column name of the format; two in one field are glued columns.

    Returns
    -------
    tuple of str
        The column names, followed by the delimiter as the last element.

    Raises
    ------
    RecordingError
        If no delimiter splits the row, or columns stay glued.

    Examples
    --------
    >>> split_columns("Acc_X;Acc_Y", file="a.txt", line=1, known=re.compile(r"Acc_[XYZ]"))
    ('Acc_X', 'Acc_Y', ';')
    """
    delimiter = max(DELIMITERS.values(), key=text.count)
    expected = ", ".join(DELIMITERS) + " between the column names"
    if delimiter not in text:
        raise RecordingError(
            "wrong delimiter: one column found",
            file=file,
            place=f"line {line}",
            expected=expected,
            found=_shorten(text),
        )
    columns = tuple(name.strip() for name in text.split(delimiter))
    for position, name in enumerate(columns, start=1):
        if len(known.findall(name)) > 1:
            raise RecordingError(
                "wrong delimiter: glued columns",
                file=file,
                place=f"line {line}, column {position}",
                expected=f"one column name between two delimiters ({name_of_delimiter(delimiter)})",
                found=_shorten(name),
            )
    return (*columns, delimiter)


def read_numbers(table: Table, positions: Sequence[int]) -> NDArray[np.float64]:
    """Parse columns of a table.

    Parameters
    ----------
    table : Table
    positions : sequence of int
        Columns to read, in the order wanted; all others need only be there.

    Returns
    -------
    ndarray of float64, shape (len(positions), n_rows)
        Missing numbers are NaN.

    Raises
    ------
    RecordingError
        With line and column: no data rows, a truncated last line, a line with another number of
        fields or another delimiter, a field that is not a number.
    """
    body = table.source.data[table.start :].rstrip(b"\r\n")
    if not body.strip():
        raise RecordingError(
            "no data rows",
            file=table.source.name,
            place=f"line {table.first_line}",
            expected="numbers after the column row",
            found="end of file",
        )
    _check_field_counts(table, body)
    unique = sorted(set(positions))
    try:
        frame = pd.read_csv(
            io.BytesIO(body),
            sep=table.delimiter,
            header=None,
            usecols=unique,
            dtype=np.float64,
            engine="c",
            quoting=csv.QUOTE_NONE,
            skip_blank_lines=False,
            keep_default_na=False,
            na_values=list(MISSING),
            decimal=table.decimal,
            encoding_errors="replace",
        )
    except (ValueError, OverflowError) as error:
        raise _locate_bad_field(table, body, unique, str(error)) from error
    values = frame.to_numpy().T[[unique.index(position) for position in positions]]
    if np.isinf(values).any():
        raise _locate_bad_field(table, body, unique, "an infinite number")
    return values


def _check_field_counts(table: Table, body: bytes) -> None:
    """Require the same number of fields in every row (pandas would fill short rows with NaN)."""
    characters = np.frombuffer(body, dtype=np.uint8)
    ends = np.append(np.flatnonzero(characters == _NEWLINE), len(characters))
    delimiters = np.flatnonzero(characters == ord(table.delimiter))
    n_fields = np.diff(np.searchsorted(delimiters, ends), prepend=0) + 1
    n_columns = len(table.columns)
    wrong = np.flatnonzero(n_fields != n_columns)
    if wrong.size == 0:
        return
    row = int(wrong[0])
    text = decode(body[0 if row == 0 else ends[row - 1] + 1 : ends[row]]).rstrip("\r")
    problem = "wrong number of fields"
    found = f"{n_fields[row]} fields: {_shorten(text)}"
    other = [
        name
        for name, symbol in DELIMITERS.items()
        if symbol != table.delimiter and text.count(symbol) == n_columns - 1 > 0
    ]
    if not text.strip():
        problem, found = "empty line inside the data", "nothing"
    elif other:
        problem, found = "wrong delimiter", f"{n_columns} fields separated by {other[0]}"
    elif row == len(ends) - 1 and n_fields[row] < n_columns:
        problem = "truncated file: the last line is not complete"
    raise RecordingError(
        problem,
        file=table.source.name,
        place=f"line {table.first_line + row}",
        expected=f"{n_columns} fields separated by {name_of_delimiter(table.delimiter)}",
        found=found,
    )


def _locate_bad_field(
    table: Table, body: bytes, positions: Sequence[int], reason: str
) -> RecordingError:
    """Slow path: the first field, in reading order, that is not a number."""
    for row, text in enumerate(decode(body).split("\n")):
        fields = text.rstrip("\r").split(table.delimiter)
        for position in positions:
            field = fields[position].strip()
            if field in MISSING:
                continue
            if table.decimal != ".":
                field = field.replace(".", "?").replace(table.decimal, ".")
            if not (_NUMBER.fullmatch(field) and np.isfinite(float(field))):
                name = table.columns[position] or "(unnamed)"
                return RecordingError(
                    "not a number",
                    file=table.source.name,
                    place=f"line {table.first_line + row}, column {position + 1} ({name})",
                    expected="a finite number, an empty field or NaN",
                    found=repr(fields[position]),
                )
    return RecordingError(
        "the rows cannot be parsed",
        file=table.source.name,
        place=f"from line {table.first_line}",
        expected="numbers",
        found=reason,
    )


def _shorten(text: str, limit: int = 60) -> str:
    return repr(text if len(text) <= limit else text[:limit] + "…")
