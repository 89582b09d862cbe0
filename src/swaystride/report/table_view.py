"""A table as the page shows it: headings, groups of rows, cells with marks, footnotes.

Every table of a page, compared or not, becomes a :class:`TableView`, and one template draws it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd

from swaystride.errors import DesignError
from swaystride.presentation.table_files import cells_of, column_formats

MARKS = {"agrees": "●", "borderline": "○", "differs": "◆"}
"""Symbols of agreement; shape and filling differ, so that colour is not needed."""

CLAIM_AGREEMENT = {"yes": "agrees", "partly": "borderline", "no": "differs", "not testable": ""}


@dataclass(frozen=True)
class HeadCell:
    """One heading of a column or of a group of columns."""

    text: str
    colspan: int = 1
    rowspan: int = 1
    numeric: bool = False


@dataclass(frozen=True)
class Cell:
    """One cell.

    Parameters
    ----------
    text : str
        What it says.
    detail : str
        Smaller text below, for example an interval.
    mark : str
        Agreement, a key of ``MARKS``, or empty.
    strip : float, optional
        Difference in standard errors, drawn on a small scale.
    numeric, heading, muted : bool
        Aligned as a number; names its row; set in grey.
    rowspan : int
        Rows that the cell covers.
    note : str
        Letter of a footnote.
    mark_space : bool
        Keeps the place of a mark, so that the numbers of a column stay aligned.
    """

    text: str
    detail: str = ""
    mark: str = ""
    strip: float | None = None
    numeric: bool = False
    heading: bool = False
    muted: bool = False
    rowspan: int = 1
    note: str = ""
    mark_space: bool = False


@dataclass(frozen=True)
class RowGroup:
    """Rows under a common heading; the heading may be empty."""

    label: str
    rows: tuple[tuple[Cell, ...], ...]


@dataclass(frozen=True)
class TableView:
    """Everything that the template needs to draw one table.

    Parameters
    ----------
    head : tuple of tuple of HeadCell
        Heading rows, top first.
    groups : tuple of RowGroup
        The body.
    n_columns : int
        Columns of the body.
    footnotes : tuple of (str, str)
        Letter and text.
    legend : tuple of (str, str)
        Agreement and its meaning, shown below the table.
    """

    head: tuple[tuple[HeadCell, ...], ...]
    groups: tuple[RowGroup, ...]
    n_columns: int
    footnotes: tuple[tuple[str, str], ...] = ()
    legend: tuple[tuple[str, str], ...] = ()


def listing_view(
    frame: pd.DataFrame,
    *,
    formats: Mapping[str, str | int],
    labels: Mapping[str, str] | None = None,
) -> TableView:
    """View of a table without a printed counterpart.

    Parameters
    ----------
    frame : pandas.DataFrame
        The table.
    formats : mapping of str to str or int
        Column to short form of its format.
    labels : mapping of str to str, optional
        Words for columns and for the values of text columns.

    Examples
    --------
    >>> view = listing_view(pd.DataFrame({"group": ["a"], "age": [70.44]}), formats={"age": 1})
    >>> [cell.text for cell in view.groups[0].rows[0]]
    ['a', '70.4']
    """
    words = labels or {}
    form = column_formats(frame, formats)
    names = list(form)
    rows = tuple(
        tuple(
            Cell(
                words.get(text, text) if form[name].kind == "text" else text,
                numeric=form[name].is_numeric,
                heading=position == 0,
            )
            for position, (name, text) in enumerate(zip(names, row, strict=True))
        )
        for row in cells_of(frame, form, "page")
    )
    head = tuple(HeadCell(words.get(name, name), numeric=form[name].is_numeric) for name in names)
    return TableView((head,), (RowGroup("", rows),), len(names))


def claims_view(
    frame: pd.DataFrame,
    *,
    verdict: str = "reproduced",
    labels: Mapping[str, str] | None = None,
) -> TableView:
    """View of a table of claims, one claim a row.

    Parameters
    ----------
    frame : pandas.DataFrame
        All columns are shown, in their order; the first holds the claims.
    verdict : str
        Column that says ``yes``, ``partly``, ``no`` or ``not testable``.
    labels : mapping of str to str, optional
        Words for columns; others are shown with spaces for underscores.

    Raises
    ------
    DesignError
        If the column of verdicts is missing or has another word.

    Examples
    --------
    >>> claims = pd.DataFrame({"claim": ["Sway falls."], "reproduced": ["partly"]})
    >>> [(cell.text, cell.mark) for cell in claims_view(claims).groups[0].rows[0]]
    [('Sway falls.', ''), ('partly', 'borderline')]
    """
    names = [str(name) for name in frame.columns]
    if verdict not in names:
        raise DesignError(
            "columns of a claims table", expected=repr(verdict), found=", ".join(names)
        )
    unknown = sorted(set(frame[verdict].astype(str)) - set(CLAIM_AGREEMENT))
    if unknown:
        raise DesignError(
            f"column {verdict!r} of a claims table",
            expected="yes, partly, no or not testable",
            found=", ".join(unknown),
        )
    texts = frame.astype(object).where(frame.notna(), "").astype(str)
    rows = tuple(
        tuple(
            Cell(
                text,
                mark=CLAIM_AGREEMENT[text] if name == verdict else "",
                heading=position == 0,
            )
            for position, (name, text) in enumerate(zip(names, row, strict=True))
        )
        for row in texts.to_numpy().tolist()
    )
    words = labels or {}
    head = tuple(HeadCell(words.get(name, name.replace("_", " ").capitalize())) for name in names)
    return TableView((head,), (RowGroup("", rows),), len(head))
