"""Tables that a lab writes beside its recordings: participants.tsv, trials.tsv, ratings.tsv and the like.

Every table is tab-separated text with one header line. Columns are declared with
:class:`Column`; whatever contradicts the declaration is an error that names file and line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import pandas as pd

from swaystride.errors import DesignError

Kind = Literal["text", "integer", "number"]


@dataclass(frozen=True)
class Column:
    """What a column of a study table must hold.

    Parameters
    ----------
    kind : {"text", "integer", "number"}
        Type of its cells.
    levels : tuple of str, optional
        The only values allowed (text columns).
    minimum, maximum : float, optional
        Range of a numeric column, ends included.
    may_be_empty : bool
        Whether a cell may be empty (it becomes NaN, or an empty text).
    pattern : str
        Regular expression that the whole cell must match (text columns).
    required : bool
        Whether the column must be there; an absent optional column is added empty.
    """

    kind: Kind
    levels: tuple[str, ...] = ()
    minimum: float | None = None
    maximum: float | None = None
    may_be_empty: bool = False
    pattern: str = ""
    required: bool = True


def read_study_table(
    path: Path | str, columns: Mapping[str, Column], *, unique: Sequence[str]
) -> pd.DataFrame:
    """Read and check a study table.

    Parameters
    ----------
    path : path or str
        Tab-separated file, UTF-8.
    columns : mapping of str to Column
        Declaration; further columns are kept as text.
    unique : sequence of str
        Columns that together name a row; no two rows may agree in them. With none, rows may repeat.

    Returns
    -------
    DataFrame
        Rows in the order of the file.

    Raises
    ------
    DesignError
        If the file is missing or empty, a column is missing, a cell is of the wrong kind, out of
        range or not among the levels, or a row stands twice; with file, line and column.
    """
    path = Path(path)
    if not path.is_file():
        raise DesignError("no such file", file=path)
    try:
        with path.open(encoding="utf-8-sig") as file:
            header = file.readline().rstrip("\n").split("\t")
        twice = sorted({name for name in header if header.count(name) > 1})
        if twice:
            raise DesignError(f"column {twice[0]!r} stands twice", file=path, place="line 1")
        raw = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False, encoding="utf-8-sig")
    except pd.errors.EmptyDataError:
        raise DesignError("file is empty", file=path, expected="a header line") from None
    except UnicodeDecodeError:
        raise DesignError("not readable as text", file=path, expected="UTF-8") from None
    except pd.errors.ParserError as error:
        raise DesignError("rows of unequal length", file=path, found=str(error)) from None
    if raw.empty:
        raise DesignError("table has no rows", file=path, expected="at least one")
    missing = [name for name, column in columns.items() if column.required and name not in raw]
    if missing:
        raise DesignError(
            f"column {missing[0]!r} is missing",
            file=path,
            place="line 1",
            expected="columns " + ", ".join(columns) + ", separated by tabs",
            found=", ".join(raw.columns),
        )
    table = raw.copy()
    for name, column in columns.items():
        if name not in raw:
            table[name] = ""
        table[name] = _checked_column(table[name], name, column, path)
    repeated = table.duplicated(list(unique)) if unique else pd.Series(dtype=bool)
    if repeated.any():
        row = int(repeated.to_numpy().argmax())
        key = ", ".join(f"{name} {raw[name].iloc[row]!s}" for name in unique)
        raise DesignError("row stands twice", file=path, place=_line(row), found=key)
    return table


def check_participants(
    participants: pd.DataFrame, trials: pd.DataFrame, people_file: Path, trials_file: Path
) -> None:
    """Everybody who has a trial is listed, and everybody who is listed has one.

    Parameters
    ----------
    participants, trials : DataFrame
        From :func:`read_study_table`, each with the column ``participant``.
    people_file, trials_file : Path
        Where they come from, for the errors.

    Raises
    ------
    DesignError
        With the first line whose participant is unknown, or the participants without trials.
    """
    unknown = ~trials["participant"].isin(participants["participant"])
    if unknown.any():
        row = int(unknown.to_numpy().argmax())
        raise DesignError(
            "participant is not in participants.tsv",
            file=trials_file,
            place=f"{_line(row)}, column participant",
            found=repr(trials.loc[row, "participant"]),
        )
    idle = sorted(set(participants["participant"]) - set(trials["participant"]))
    if idle:
        raise DesignError("participant has no trials", file=people_file, found=", ".join(idle))


def write_study_table(table: pd.DataFrame, path: Path | str) -> None:
    """Write a study table as a lab would keep it: tab-separated, no index, empty for missing.

    Parameters
    ----------
    table : DataFrame
    path : path or str
    """
    table.to_csv(path, sep="\t", index=False, lineterminator="\n")


def _line(row: int) -> str:
    """Place of a data row: the header is line 1."""
    return f"line {row + 2}"


def _checked_column(cells: pd.Series, name: str, column: Column, path: Path) -> pd.Series:
    """One column converted to its kind, or the error of its first bad cell."""
    empty = cells.str.strip() == ""
    if column.kind == "text":
        bad = pd.Series(False, index=cells.index)
        if column.levels:
            bad = ~cells.isin(column.levels)
        if column.pattern:
            bad |= ~cells.str.fullmatch(column.pattern)
        expected = "one of " + ", ".join(column.levels) if column.levels else "text"
        expected += " without blanks and slashes" if column.pattern else ""
        values = cells
    else:
        values = pd.to_numeric(cells.where(~empty), errors="coerce").astype("float64")
        bad = values.isna()
        expected = "an integer" if column.kind == "integer" else "a number"
        if column.kind == "integer":
            bad |= values % 1 != 0
        if column.minimum is not None:
            bad |= values < column.minimum
            expected += f" ≥ {column.minimum:g}"
        if column.maximum is not None:
            bad |= values > column.maximum
            expected += f" ≤ {column.maximum:g}"
    bad = bad & ~empty if column.may_be_empty else bad | empty
    if bad.any():
        row = int(bad.to_numpy().argmax())
        raise DesignError(
            "cell is empty" if empty[row] else "cell does not fit its column",
            file=path,
            place=f"{_line(row)}, column {name}",
            expected=expected,
            found=repr(cells[row]),
        )
    if column.kind == "integer" and not empty.any():
        return values.astype("int64")
    return values
