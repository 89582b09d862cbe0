"""Printed beside reproduced: tables joined by their key columns, in the order of the print.

The result is a tidy frame with one row per table row and quantity. A difference is measured in
standard errors of the reproduced estimate; words (``yes*``, ``yes``, ``no``) are compared as
words. A row that stands in one table only is listed, never dropped.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any, Literal

import pandas as pd
from scipy.special import stdtrit

from swaystride.errors import ConfigurationError
from swaystride.report.attainability import Unattainable, attainability, require_used
from swaystride.report.table_join import (
    cell_number,
    cell_text,
    joined_rows,
    presence,
    require_columns,
)

Agreement = Literal["agrees", "borderline", "differs", ""]

AGREES_WITHIN_SE = 2.0
BORDERLINE_WITHIN_SE = 3.0
_ROUNDING = 1e-9  # so that (0.14 - 0.10)/0.02 is 2 and not a little more

NUMBER_COLUMNS = (
    "compared",
    "printed",
    "printed_is_bound",
    "printed_low",
    "printed_high",
    "reproduced",
    "reproduced_low",
    "reproduced_high",
    "se",
    "difference_in_se",
    "agreement",
    "attainable",
    "reason",
    "presence",
)
WORD_COLUMNS = (
    "compared",
    "printed",
    "reproduced",
    "agreement",
    "attainable",
    "reason",
    "presence",
)


@dataclass(frozen=True)
class Value:
    """One quantity of a table: which columns hold it, and how it is written.

    Parameters
    ----------
    estimate : str
        Column of the value, in both tables.
    format : str or int
        Column format, see :func:`swaystride.presentation.number_format.parse_format`.
    se : str, optional
        Column of the reproduced table with the standard error.
    ci : pair of str, optional
        Columns of the interval, in either table or both.
    confidence : float, optional
        Confidence of the interval, needed where the standard error comes from its half width.
    df : str, optional
        Column of the reproduced table with the degrees of freedom of the interval; without it the
        interval is taken as normal.
    upper_bound : str, optional
        Column of the printed table that is 1 where the print says "less than"; by default
        ``<estimate>_is_upper_bound`` if the printed table has it.
    label : str, optional
        Heading on the page.

    Examples
    --------
    >>> Value("p", "p").upper_bound is None
    True
    """

    estimate: str
    format: str | int
    se: str | None = None
    ci: tuple[str, str] | None = None
    confidence: float | None = None
    df: str | None = None
    upper_bound: str | None = None
    label: str | None = None


@dataclass(frozen=True)
class Summary:
    """How many compared values agree; unattainable ones are counted apart.

    Parameters
    ----------
    agrees, borderline, differs : int
        Values by agreement.
    unattainable : int
        Values that would have been compared, but whose print cannot be attained.
    one_table_only : int
        Table rows that the other table does not have.
    """

    agrees: int
    borderline: int
    differs: int
    unattainable: int
    one_table_only: int

    @property
    def compared(self) -> int:
        """Values that were compared and counted."""
        return self.agrees + self.borderline + self.differs


def compare_numbers(
    printed: pd.DataFrame,
    reproduced: pd.DataFrame,
    *,
    keys: Sequence[str],
    values: Sequence[Value],
    unattainable: Sequence[Unattainable] = (),
) -> pd.DataFrame:
    """Compare the numbers of two tables.

    Parameters
    ----------
    printed, reproduced : pandas.DataFrame
        Tables with the key columns; a reproduced table may have the columns ``attainable`` (0/1)
        and ``attainable_reason``.
    keys : sequence of str
        Columns that name a row.
    values : sequence of Value
        Quantities to compare.
    unattainable : sequence of Unattainable
        Rows that cannot be attained, besides those that the reproduced table itself marks.

    Returns
    -------
    pandas.DataFrame
        The keys followed by ``NUMBER_COLUMNS``. ``difference_in_se`` is
        (reproduced - printed)/se, and 0 below a printed upper bound. ``agreement`` is ``agrees``
        within 2 SE, ``borderline`` within 3, ``differs`` beyond, and empty where nothing can be
        compared: a p-value, which has no standard error, is shown on both sides and not judged.
        ``presence`` is ``both``, ``printed`` or ``reproduced``.

    Raises
    ------
    ConfigurationError
        If a named column does not exist, a key has the name of a column of the result, or the
        standard error cannot be had as described.
    DesignError
        If two rows have the same keys, or a value is not a number.

    Examples
    --------
    >>> printed = pd.DataFrame({"effect": ["a", "b"], "slope": [0.10, None]})
    >>> ours = pd.DataFrame({"effect": ["a", "c"], "slope": [0.14, 1.0], "se": [0.02, 0.1]})
    >>> frame = compare_numbers(printed, ours, keys=["effect"], values=[Value("slope", 2, se="se")])
    >>> frame[["effect", "difference_in_se", "agreement", "presence"]]
      effect  difference_in_se agreement    presence
    0      a               2.0    agrees        both
    1      b               NaN               printed
    2      c               NaN            reproduced
    """
    _require_free_names(keys, NUMBER_COLUMNS)
    _require_values(printed, reproduced, values)
    rows: list[dict[str, Any]] = []
    for named, left, right in joined_rows(printed, reproduced, keys):
        for value in values:
            row = {"compared": value.estimate, **_number_row(left, right, value)}
            row |= attainability(named, value.estimate, right, unattainable)
            rows.append(named | row | {"presence": presence(left, right)})
    frame = pd.DataFrame(rows, columns=[*keys, *NUMBER_COLUMNS])
    require_used(frame, unattainable)
    return frame


def compare_words(
    printed: pd.DataFrame,
    reproduced: pd.DataFrame,
    *,
    keys: Sequence[str],
    columns: Sequence[str],
    unattainable: Sequence[Unattainable] = (),
) -> pd.DataFrame:
    """Compare the words of two tables, for example ``yes*``, ``yes`` and ``no``.

    Equal words agree; words that differ only in their asterisk (the same choice, another
    significance) are borderline; others differ.

    Parameters
    ----------
    printed, reproduced : pandas.DataFrame
        Tables with the key columns and the columns of words.
    keys : sequence of str
        Columns that name a row.
    columns : sequence of str
        Columns of words.
    unattainable : sequence of Unattainable
        Cells that cannot be attained.

    Returns
    -------
    pandas.DataFrame
        The keys followed by ``WORD_COLUMNS``.

    Raises
    ------
    ConfigurationError
        If a named column does not exist.
    DesignError
        If two rows have the same keys.

    Examples
    --------
    >>> printed = pd.DataFrame({"feature": ["x"], "age": ["yes*"], "sex": ["no"]})
    >>> ours = pd.DataFrame({"feature": ["x"], "age": ["yes"], "sex": ["no"]})
    >>> compare_words(printed, ours, keys=["feature"], columns=["age", "sex"])["agreement"].tolist()
    ['borderline', 'agrees']
    """
    _require_free_names(keys, WORD_COLUMNS)
    for table, name in ((printed, "printed"), (reproduced, "reproduced")):
        require_columns(table, columns, name)
    rows: list[dict[str, Any]] = []
    for named, left, right in joined_rows(printed, reproduced, keys):
        for column in columns:
            words = [cell_text(side.get(column)) if side else "" for side in (left, right)]
            row: dict[str, Any] = {"compared": column, "printed": words[0], "reproduced": words[1]}
            row["agreement"] = _word_agreement(*words)
            row |= attainability(named, column, right, unattainable)
            rows.append(named | row | {"presence": presence(left, right)})
    frame = pd.DataFrame(rows, columns=[*keys, *WORD_COLUMNS])
    require_used(frame, unattainable)
    return frame


def summarise(comparison: pd.DataFrame) -> Summary:
    """Count the agreement of a comparison.

    Parameters
    ----------
    comparison : pandas.DataFrame
        From :func:`compare_numbers` or :func:`compare_words`.

    Examples
    --------
    >>> printed = pd.DataFrame({"feature": ["x"], "age": ["yes*"], "sex": ["no"]})
    >>> frame = compare_words(printed, printed, keys=["feature"], columns=["age", "sex"])
    >>> summarise(frame).agrees
    2
    """
    attainable = comparison["attainable"].astype(bool)
    counts = comparison.loc[attainable, "agreement"].value_counts()
    keys = list(comparison.columns[: comparison.columns.get_loc("compared")])
    lonely = comparison.loc[comparison["presence"] != "both", keys].astype(str)
    return Summary(
        agrees=int(counts.get("agrees", 0)),
        borderline=int(counts.get("borderline", 0)),
        differs=int(counts.get("differs", 0)),
        unattainable=int((~attainable & (comparison["agreement"] != "")).sum()),
        one_table_only=len(lonely.drop_duplicates()),
    )


def standard_error(row: Mapping[str, Any], value: Value) -> float:
    """Standard error of a reproduced value: its own column, or the half width of its interval.

    Parameters
    ----------
    row : mapping
        A row of the reproduced table.
    value : Value
        Which columns hold the error or the interval.

    Examples
    --------
    >>> value = Value("b", 2, ci=("low", "high"), confidence=0.95)
    >>> round(standard_error({"low": -1.96, "high": 1.96}, value), 3)
    1.0
    """
    if value.se is not None:
        return cell_number(row.get(value.se), value.se)
    if value.ci is None or value.confidence is None:
        return math.nan
    low, high = (cell_number(row.get(name), name) for name in value.ci)
    tail = 0.5 + 0.5 * value.confidence
    df = cell_number(row.get(value.df), value.df) if value.df else math.inf
    quantile = NormalDist().inv_cdf(tail) if math.isinf(df) else float(stdtrit(df, tail))
    return 0.5 * (high - low) / quantile


def _number_row(left: Mapping[str, Any], right: Mapping[str, Any], value: Value) -> dict[str, Any]:
    """Both sides of one quantity, and their difference."""
    bound_column = value.upper_bound or f"{value.estimate}_is_upper_bound"
    low, high = value.ci or ("", "")
    row: dict[str, Any] = {
        "printed": cell_number(left.get(value.estimate), value.estimate),
        "printed_is_bound": cell_number(left.get(bound_column), bound_column) == 1.0,
        "printed_low": cell_number(left.get(low), low),
        "printed_high": cell_number(left.get(high), high),
        "reproduced": cell_number(right.get(value.estimate), value.estimate),
        "reproduced_low": cell_number(right.get(low), low),
        "reproduced_high": cell_number(right.get(high), high),
        "se": standard_error(right, value),
    }
    difference = math.nan
    if row["se"] > 0.0:
        difference = (row["reproduced"] - row["printed"]) / row["se"]
        if row["printed_is_bound"]:
            difference = max(difference, 0.0)
    return row | {"difference_in_se": difference, "agreement": _number_agreement(difference)}


def _number_agreement(difference: float) -> Agreement:
    if math.isnan(difference):
        return ""
    if abs(difference) <= AGREES_WITHIN_SE + _ROUNDING:
        return "agrees"
    return "borderline" if abs(difference) <= BORDERLINE_WITHIN_SE + _ROUNDING else "differs"


def _word_agreement(printed: str, reproduced: str) -> Agreement:
    if not printed or not reproduced:
        return ""
    if printed == reproduced:
        return "agrees"
    return "borderline" if printed.rstrip("*") == reproduced.rstrip("*") else "differs"


def _require_free_names(keys: Sequence[str], columns: Sequence[str]) -> None:
    """Keys stand beside the columns of the comparison and cannot share their names."""
    taken = [name for name in keys if name in columns]
    if taken:
        raise ConfigurationError(
            "a key has the name of a column of the comparison",
            expected="none of " + ", ".join(columns),
            found=", ".join(taken),
        )


def _require_values(
    printed: pd.DataFrame, reproduced: pd.DataFrame, values: Sequence[Value]
) -> None:
    for value in values:
        require_columns(printed, [value.estimate], "printed")
        if value.upper_bound:
            require_columns(printed, [value.upper_bound], "printed")
        ours = [value.estimate, value.se, value.df, *(value.ci or ())]
        require_columns(reproduced, [name for name in ours if name], "reproduced")
        if value.ci and value.se is None and value.confidence is None:
            raise ConfigurationError(
                f"standard error of {value.estimate!r}",
                expected="'se', or 'ci' with its 'confidence'",
                found="'ci' alone",
            )
        if value.confidence is not None and not 0.0 < value.confidence < 1.0:
            raise ConfigurationError(
                f"confidence of {value.estimate!r}",
                expected="a number between 0 and 1",
                found=repr(value.confidence),
            )
