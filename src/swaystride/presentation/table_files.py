r"""Result tables as files: one CSV that joins, and the same cells for people.

The CSV has the columns exactly as given, a fixed float format and ``\n`` line ends, so that it
joins with the printed tables in ``data/published``. Markdown, LaTeX and HTML show the same cells
with caption, notes and, for a simulated cohort, the line that says so.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from swaystride.errors import ConfigurationError, DesignError
from swaystride.presentation.number_format import ColumnFormat, Style, parse_format
from swaystride.presentation.table_text import (
    SIMULATED_NOTE,
    TextTable,
    to_html,
    to_markdown,
    to_tex,
)

__all__ = ["SIMULATED_NOTE", "cells_of", "column_formats", "read_table", "write_table"]


#: Last column of the CSV tables of simulated cohorts.
SIMULATED_COLUMN = "data"


def column_formats(
    frame: pd.DataFrame, formats: Mapping[str, str | int]
) -> dict[str, ColumnFormat]:
    """Format of every column of a frame.

    Text and whole-number columns need no entry; a column of floats does, because its decimals are
    not guessed.

    Parameters
    ----------
    frame : pandas.DataFrame
        The table.
    formats : mapping of str to str or int
        Column to short form of its format.

    Raises
    ------
    ConfigurationError
        If a float column has no format, or a format names a column that does not exist.

    Examples
    --------
    >>> frame = pd.DataFrame({"group": ["a"], "n": [10], "age": [70.4]})
    >>> [form.kind for form in column_formats(frame, {"age": 1}).values()]
    ['text', 'integer', 'number']
    """
    columns = [str(column) for column in frame.columns]
    unknown = [name for name in formats if name not in columns]
    if unknown:
        raise ConfigurationError(
            "format for a column that the table does not have",
            expected=", ".join(columns),
            found=", ".join(unknown),
        )
    return {
        name: parse_format(formats[name]) if name in formats else _format_of(frame[name])
        for name in columns
    }


def cells_of(
    frame: pd.DataFrame, formats: Mapping[str, ColumnFormat], style: Style
) -> list[list[str]]:
    """Cells of a frame as text, row by row.

    Parameters
    ----------
    frame : pandas.DataFrame
        The table.
    formats : mapping of str to ColumnFormat
        From :func:`column_formats`.
    style : {"page", "plain"}
        For people, or for the CSV.

    Examples
    --------
    >>> frame = pd.DataFrame({"age": [70.4, -1.0]})
    >>> cells_of(frame, column_formats(frame, {"age": 1}), "page")
    [['70.4'], ['−1.0']]
    """
    columns: list[list[str]] = []
    for name in frame.columns:
        values: list[Any] = frame[name].astype(object).tolist()
        columns.append([formats[str(name)].cell(value, style) for value in values])
    return [list(row) for row in zip(*columns, strict=True)]


def write_table(
    frame: pd.DataFrame,
    stem: Path | str,
    *,
    caption: str,
    notes: Sequence[str] = (),
    formats: Mapping[str, str | int],
    simulated: bool,
    labels: Mapping[str, str] | None = None,
    shown: pd.DataFrame | None = None,
    shown_formats: Mapping[str, str | int] | None = None,
) -> list[Path]:
    """Write ``<stem>.csv``, ``.md``, ``.tex`` and ``.html`` renderings of one frame.

    Parameters
    ----------
    frame : pandas.DataFrame
        The table; the index is not written.
    stem : path or str
        Path without suffix; its folder is made if needed.
    caption : str
        Caption of the renderings for people.
    notes : sequence of str
        Remarks below the table.
    formats : mapping of str to str or int
        Column to format, see :func:`swaystride.presentation.number_format.parse_format`.
    simulated : bool
        Whether the cohort is simulated; the renderings for people then say so, and the CSV gets a
        last column ``data`` with the word ``simulated`` (columns beyond the printed ones are
        allowed by the table contract).
    labels : mapping of str to str, optional
        Words for column names and for the values of text columns, used in the renderings for
        people only.
    shown : pandas.DataFrame, optional
        What the renderings for people show, where the print arranges the same numbers otherwise;
        the CSV always holds `frame`.
    shown_formats : mapping of str to str or int, optional
        Formats of the columns of `shown`.

    Returns
    -------
    list of Path
        The four files: CSV, Markdown, LaTeX, HTML.

    Raises
    ------
    ConfigurationError
        If the formats do not fit the columns.
    DesignError
        If two columns have the same name.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> frame = pd.DataFrame({"feature": ["phi_rms"], "estimate": [-0.0301]})
    >>> with TemporaryDirectory() as folder:
    ...     files = write_table(frame, f"{folder}/table_1", caption="Effects.",
    ...                         formats={"estimate": 3}, simulated=True)
    ...     print(files[0].read_text())
    feature,estimate,data
    phi_rms,-0.030,simulated
    """
    if isinstance(notes, str):
        raise ConfigurationError("notes of a table", expected="a list of texts", found="one text")
    header = [str(column) for column in frame.columns]
    _require_unique(header, file=None)
    form = column_formats(frame, formats)
    people = frame if shown is None else shown
    page_form = form if shown is None else column_formats(people, shown_formats or {})
    words = labels or {}
    names = [str(column) for column in people.columns]
    rows = [
        [
            words.get(cell, cell) if page_form[name].kind == "text" else cell
            for name, cell in zip(names, row, strict=True)
        ]
        for row in cells_of(people, page_form, "page")
    ]
    table = TextTable(
        header=[words.get(name, name) for name in names],
        rows=rows,
        numeric=[page_form[name].is_numeric for name in names],
        caption=caption,
        notes=notes,
        simulated=simulated,
    )
    texts = {
        ".csv": _csv_text(*_marked(header, cells_of(frame, form, "plain"), simulated)),
        ".md": to_markdown(table),
        ".tex": to_tex(table),
        ".html": to_html(table),
    }
    base = Path(stem)
    base.parent.mkdir(parents=True, exist_ok=True)
    files = []
    for suffix, text in texts.items():
        file = base.parent / (base.name + suffix)
        file.write_text(text, encoding="utf-8", newline="")
        files.append(file)
    return files


def read_table(path: Path | str, *, text_columns: Sequence[str] = ()) -> pd.DataFrame:
    r"""Read a result table or a printed table.

    Only an empty cell is missing; the texts "NA" and "None" stay texts.

    Parameters
    ----------
    path : path or str
        A CSV with one header line.
    text_columns : sequence of str
        Columns kept as text although they look like numbers (identifiers such as "01").

    Raises
    ------
    DesignError
        If there is no such file, no header, or a column twice.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "t.csv"
    ...     _ = file.write_text("unit,p\n01,0.012\nNA,\n")
    ...     read_table(file)["unit"].tolist()
    ['01', 'NA']
    """
    file = Path(path)
    if not file.is_file():
        raise DesignError("no such table", file=file.name, expected="a CSV file")
    with file.open(encoding="utf-8", newline="") as stream:
        header = next(csv.reader(stream), [])
    if not header:
        raise DesignError("empty table", file=file.name, expected="a header line", found="nothing")
    _require_unique(header, file=file.name)
    return pd.read_csv(
        file,
        keep_default_na=False,
        na_values=[""],
        dtype=dict.fromkeys(text_columns, "str"),
    )


def _format_of(column: pd.Series[Any]) -> ColumnFormat:
    """Format of a column that the author left out."""
    if pd.api.types.is_bool_dtype(column) or pd.api.types.is_integer_dtype(column):
        return ColumnFormat("integer")
    if pd.api.types.is_numeric_dtype(column):
        raise ConfigurationError(
            f"no format for the column {column.name!r}",
            expected="a count of decimals, 'number:D', 'p' or 'integer'",
            found="nothing",
        )
    return ColumnFormat("text")


def _require_unique(header: Sequence[str], *, file: str | None) -> None:
    """Refuse a table with two columns of one name."""
    twice = sorted({name for name in header if list(header).count(name) > 1})
    if twice:
        raise DesignError(
            "column name occurs twice",
            file=file,
            expected="unique names",
            found=", ".join(twice),
        )


def _marked(
    header: list[str], rows: list[list[str]], simulated: bool
) -> tuple[list[str], list[list[str]]]:
    """Header and rows with the last column that says where simulated numbers come from."""
    if not simulated:
        return header, rows
    return [*header, SIMULATED_COLUMN], [[*row, "simulated"] for row in rows]


def _csv_text(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    r"""Comma separated text with ``\n`` line ends; quotes only where they are needed."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return stream.getvalue()
