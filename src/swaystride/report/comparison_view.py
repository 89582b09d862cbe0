"""A comparison as a table for the page: printed, reproduced, difference in standard errors."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import groupby
from string import ascii_lowercase
from typing import Any

import pandas as pd

from swaystride.presentation.number_format import ColumnFormat, format_number, parse_format
from swaystride.report.comparison import AGREES_WITHIN_SE, BORDERLINE_WITHIN_SE, Value
from swaystride.report.page import render_table
from swaystride.report.table_join import cell_text
from swaystride.report.table_view import Cell, HeadCell, RowGroup, TableView

WIDE_UP_TO = 3
"""Quantities beside each other; with more, each quantity has a line of its own."""

NOT_PRINTED = "not printed"
NOT_REPRODUCED = "not reproduced"
ONLY_REPRODUCED = "Not in the printed table"

NUMBER_LEGEND = (
    ("agrees", f"within {AGREES_WITHIN_SE:g} SE"),
    ("borderline", f"{AGREES_WITHIN_SE:g} to {BORDERLINE_WITHIN_SE:g} SE apart"),
    ("differs", f"more than {BORDERLINE_WITHIN_SE:g} SE apart"),
)
WORD_LEGEND = (
    ("", "no mark: same as printed"),
    ("borderline", "printed → reproduced: same choice, other significance"),
    ("differs", "printed → reproduced: other choice"),
)

_Row = dict[str, Any]


def number_view(
    comparison: pd.DataFrame,
    *,
    keys: Sequence[str],
    values: Sequence[Value],
    group: str | None = None,
    labels: Mapping[str, str] | None = None,
) -> TableView:
    """View of what :func:`swaystride.report.comparison.compare_numbers` returned.

    Parameters
    ----------
    comparison : pandas.DataFrame
        The tidy comparison.
    keys, values
        As given to ``compare_numbers``.
    group : str, optional
        Key whose values become headings above their rows.
    labels : mapping of str to str, optional
        Words for columns and key values.

    Examples
    --------
    >>> from swaystride.report.comparison import compare_numbers
    >>> printed = pd.DataFrame({"effect": ["a"], "slope": [0.10]})
    >>> ours = pd.DataFrame({"effect": ["a"], "slope": [0.13], "se": [0.02]})
    >>> values = [Value("slope", 2, se="se")]
    >>> view = number_view(compare_numbers(printed, ours, keys=["effect"], values=values),
    ...                    keys=["effect"], values=values)
    >>> [cell.text for cell in view.groups[0].rows[0]]
    ['a', '0.10', '0.13', '+1.5']
    """
    words = _Words(labels)
    shown_keys = [name for name in keys if name != group]
    notes = _Notes()
    wide = len(values) <= WIDE_UP_TO
    records = _records(comparison)
    groups = []
    for heading, members in _grouped(records, group):
        rows: list[tuple[Cell, ...]] = []
        for lines in _chunks(members, len(values)):
            _choose_noted(lines)
            rows += (_wide_row if wide else _long_rows)(lines, shown_keys, values, words, notes)
        if wide and len(shown_keys) > 1:
            rows = _merged(rows)
        label = words(heading)
        if members and members[0]["presence"] == "reproduced":
            label = f"{ONLY_REPRODUCED}: {label}" if label else ONLY_REPRODUCED
        groups.append(RowGroup(label, tuple(rows)))
    head = (_wide_head if wide else _long_head)(shown_keys, values, words)
    n_columns = len(groups[0].rows[0]) if groups and groups[0].rows else 1
    compared = any(record["agreement"] for record in records)
    legend = NUMBER_LEGEND if compared else ()
    return TableView(head, tuple(groups), n_columns, notes.lines, legend)


def word_view(
    comparison: pd.DataFrame,
    *,
    keys: Sequence[str],
    labels: Mapping[str, str] | None = None,
) -> TableView:
    """View of what :func:`swaystride.report.comparison.compare_words` returned.

    Rows and columns change places where that makes the table narrower. A cell that agrees shows
    the word once; one that does not shows both.

    Parameters
    ----------
    comparison : pandas.DataFrame
        The tidy comparison.
    keys : sequence of str
        As given to ``compare_words``.
    labels : mapping of str to str, optional
        Words for columns and key values.

    Examples
    --------
    >>> from swaystride.report.comparison import compare_words
    >>> printed = pd.DataFrame({"feature": ["x"], "age": ["yes"], "sex": ["no"]})
    >>> ours = pd.DataFrame({"feature": ["x"], "age": ["no"], "sex": ["no"]})
    >>> frame = compare_words(printed, ours, keys=["feature"], columns=["age", "sex"])
    >>> [[cell.text for cell in row] for row in word_view(frame, keys=["feature"]).groups[0].rows]
    [['age', 'yes → no'], ['sex', 'no']]
    """
    words, notes = _Words(labels), _Notes()
    records = _records(comparison)
    quantities = list(dict.fromkeys(str(record["compared"]) for record in records))
    table = _chunks(records, max(len(quantities), 1))
    names = [", ".join(words(record[0][key]) for key in keys) for record in table]
    corner = ", ".join(words(key) for key in keys)
    cells = [[_word_cell(record, notes) for record in line] for line in table]
    tops = [words(quantity) for quantity in quantities]
    if len(tops) > len(names):
        cells, tops, names = [list(column) for column in zip(*cells, strict=True)], names, tops
        corner = ""
    head = (HeadCell(corner), *(HeadCell(top) for top in tops))
    rows = tuple((Cell(name, heading=True), *line) for name, line in zip(names, cells, strict=True))
    return TableView((head,), (RowGroup("", rows),), len(head), notes.lines, WORD_LEGEND)


def comparison_html(view: TableView, caption: str) -> str:
    """HTML of one table, as it stands on the pages.

    Parameters
    ----------
    view : TableView
        From :func:`number_view` or :func:`word_view`.
    caption : str
        Caption of the table.

    Examples
    --------
    >>> view = TableView(((HeadCell("a"),),), (RowGroup("", ((Cell("<b>"),),)),), 1)
    >>> "&lt;b&gt;" in comparison_html(view, "One cell.")
    True
    """
    return render_table(view, caption)


class _Words:
    """Words for identifiers; what has none is shown as it is."""

    def __init__(self, labels: Mapping[str, str] | None) -> None:
        self._labels = labels or {}

    def __call__(self, value: Any) -> str:
        text = cell_text(value)
        return self._labels.get(text, text)


class _Notes:
    """Footnotes, one letter per text."""

    def __init__(self) -> None:
        self._letters: dict[str, str] = {}

    def letter(self, text: str) -> str:
        """Letter of a text; empty if there is no text."""
        if not text:
            return ""
        number = len(self._letters)
        label = ascii_lowercase[number % 26] * (number // 26 + 1)
        return self._letters.setdefault(text, label)

    @property
    def lines(self) -> tuple[tuple[str, str], ...]:
        return tuple((letter, text) for text, letter in self._letters.items())


def _wide_head(
    keys: Sequence[str], values: Sequence[Value], words: _Words
) -> tuple[tuple[HeadCell, ...], ...]:
    top = [HeadCell(words(key), rowspan=2) for key in keys]
    below = []
    for value in values:
        parts = ["Printed", "Reproduced"] + (["Difference in SE"] if _has_se(value) else [])
        top.append(HeadCell(_heading(value, words), colspan=len(parts)))
        below += [HeadCell(part, numeric=True) for part in parts]
    return tuple(top), tuple(below)


def _long_head(
    keys: Sequence[str], values: Sequence[Value], words: _Words
) -> tuple[tuple[HeadCell, ...], ...]:
    parts = ["Printed", "Reproduced"]
    if any(_has_se(value) for value in values):
        parts.append("Difference in SE")
    names = [*(words(key) for key in keys), "Quantity"]
    return (
        (
            *(HeadCell(name) for name in names),
            *(HeadCell(part, numeric=True) for part in parts),
        ),
    )


def _wide_row(
    lines: Sequence[_Row],
    keys: Sequence[str],
    values: Sequence[Value],
    words: _Words,
    notes: _Notes,
) -> list[tuple[Cell, ...]]:
    cells = [Cell(words(lines[0][key]), heading=True) for key in keys]
    for line, value in zip(lines, values, strict=True):
        cells += _number_cells(line, value, notes, strip=_has_se(value))
    return [tuple(cells)]


def _long_rows(
    lines: Sequence[_Row],
    keys: Sequence[str],
    values: Sequence[Value],
    words: _Words,
    notes: _Notes,
) -> list[tuple[Cell, ...]]:
    rows = []
    any_se = any(_has_se(value) for value in values)
    for position, (line, value) in enumerate(zip(lines, values, strict=True)):
        first = [
            Cell(words(line[key]), heading=True, rowspan=len(values))
            for key in keys
            if position == 0
        ]
        cells = [*first, Cell(_heading(value, words), heading=True)]
        rows.append((*cells, *_number_cells(line, value, notes, strip=any_se)))
    return rows


def _number_cells(line: _Row, value: Value, notes: _Notes, *, strip: bool) -> list[Cell]:
    """Printed, reproduced and, for quantities with a standard error, the difference."""
    form = parse_format(value.format)
    note = notes.letter(f"Not attainable: {line['reason']}" if line["noted"] else "")
    printed = _side(line, "printed", form, NOT_PRINTED, bound=bool(line["printed_is_bound"]))
    reproduced = _side(line, "reproduced", form, NOT_REPRODUCED)
    cells = [
        Cell(**(printed | {"note": note})),
        Cell(**reproduced),
    ]
    if strip:
        cells.append(_difference_cell(line))
    return cells


def _choose_noted(lines: Sequence[_Row]) -> None:
    """Put the footnote of a row on the quantities that are compared, or on all if none is."""
    compared = any(line["agreement"] for line in lines)
    for line in lines:
        line["noted"] = not line["attainable"] and (bool(line["agreement"]) or not compared)


def _side(
    line: _Row, side: str, form: ColumnFormat, absent: str, *, bound: bool = False
) -> dict[str, Any]:
    text = form.cell(line[side], upper_bound=bound)
    interval = form.interval(line[f"{side}_low"], line[f"{side}_high"])
    missing = line["presence"] not in ("both", side)
    return {
        "text": text or (absent if missing else "–"),
        "detail": interval,
        "numeric": True,
        "muted": not text,
    }


def _difference_cell(line: _Row) -> Cell:
    difference = float(line["difference_in_se"])
    if math.isnan(difference):
        return Cell("", numeric=True, mark=line["agreement"])
    text = format_number(difference, 1)
    text = text if text.startswith(("−", "0.0")) else f"+{text}"
    if not line["attainable"]:  # shown, but neither judged nor counted
        return Cell(text, numeric=True, muted=True, mark_space=True)
    return Cell(
        text,
        numeric=True,
        mark=line["agreement"],
        strip=difference,
    )


def _word_cell(line: _Row, notes: _Notes) -> Cell:
    printed = line["printed"] or (NOT_PRINTED if line["presence"] == "reproduced" else "–")
    ours = line["reproduced"] or (NOT_REPRODUCED if line["presence"] == "printed" else "–")
    return Cell(
        printed if printed == ours else f"{printed} → {ours}",
        mark=line["agreement"] if printed != ours and line["attainable"] else "",
        muted=printed == ours == "no" or not line["agreement"],
        note=notes.letter("" if line["attainable"] else f"Not attainable: {line['reason']}"),
    )


def _heading(value: Value, words: _Words) -> str:
    return value.label or words(value.estimate)


def _has_se(value: Value) -> bool:
    return value.se is not None or value.ci is not None


def _records(comparison: pd.DataFrame) -> list[_Row]:
    return [
        {str(name): value for name, value in record.items()}
        for record in comparison.astype(object).to_dict("records")
    ]


def _grouped(records: Sequence[_Row], group: str | None) -> list[tuple[str, list[_Row]]]:
    """Runs of rows with the same grouping key; rows that are not printed stand apart."""

    def run(record: _Row) -> tuple[str, bool]:
        heading = "" if group is None else cell_text(record[group])
        return heading, record["presence"] == "reproduced"

    return [(heading, list(members)) for (heading, _), members in groupby(records, run)]


def _merged(rows: list[tuple[Cell, ...]]) -> list[tuple[Cell, ...]]:
    """Rows whose first heading is that of the row above share one cell."""
    merged: list[tuple[Cell, ...]] = []
    for _, members in groupby(rows, lambda row: row[0].text):
        first, *others = members
        merged.append((replace(first[0], rowspan=1 + len(others)), *first[1:]))
        merged += [row[1:] for row in others]
    return merged


def _chunks(records: Sequence[_Row], size: int) -> list[list[_Row]]:
    return [list(records[start : start + size]) for start in range(0, len(records), size)]
