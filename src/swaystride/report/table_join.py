"""Two tables joined by the text of their keys, without losing a row.

A key compares as text, except that numbers compare as numbers: 0.4, "0.40" and " 0.4" are one key.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import pandas as pd

from swaystride.errors import ConfigurationError, DesignError
from swaystride.presentation.number_format import is_missing

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")


def joined_rows(
    printed: pd.DataFrame, reproduced: pd.DataFrame, keys: Sequence[str]
) -> Iterable[tuple[dict[str, Any], dict[str, Any], dict[str, Any]]]:
    """Yield keys and both rows: the printed order, then what only the reproduced table has.

    A row that one table does not have is an empty mapping there.

    Parameters
    ----------
    printed, reproduced : pandas.DataFrame
        Tables with the key columns.
    keys : sequence of str
        Columns that name a row.

    Raises
    ------
    ConfigurationError
        If a key column does not exist.
    DesignError
        If two rows of one table have the same key.

    Examples
    --------
    >>> printed = pd.DataFrame({"a": [0.4, 0.5]})
    >>> ours = pd.DataFrame({"a": ["0.40", "0.6"]})
    >>> for key, left, right in joined_rows(printed, ours, ["a"]):
    ...     print(key["a"], presence(left, right))
    0.4 both
    0.5 printed
    0.6 reproduced
    """
    left, right = _by_key(printed, keys, "printed"), _by_key(reproduced, keys, "reproduced")
    for key in [*left, *(key for key in right if key not in left)]:
        mine, other = left.get(key, {}), right.get(key, {})
        source = mine or other
        yield {name: source[name] for name in keys}, mine, other


def _by_key(
    table: pd.DataFrame, keys: Sequence[str], name: str
) -> dict[tuple[str, ...], dict[str, Any]]:
    require_columns(table, keys, name)
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    for record in table.astype(object).to_dict("records"):
        row = {str(column): value for column, value in record.items()}
        key = tuple(canonical_key(row[column]) for column in keys)
        if key in rows:
            raise DesignError(
                f"two rows of the {name} table have the same key",
                expected=f"unique {', '.join(keys)}",
                found=", ".join(key),
            )
        rows[key] = row
    return rows


def canonical_key(value: Any) -> str:
    """Spelling of a key that is the same for 0.4, "0.40" and " 0.4".

    Parameters
    ----------
    value : object
        A cell of a key column.

    Examples
    --------
    >>> canonical_key(0.4), canonical_key(" 0.40"), canonical_key("phi_rms"), canonical_key(None)
    ('0.4', '0.4', 'phi_rms', '')
    """
    text = cell_text(value)
    return repr(float(text)) if _NUMBER.fullmatch(text) else text


def cell_text(value: Any) -> str:
    """Text of a cell, trimmed; empty if the cell is.

    Parameters
    ----------
    value : object
        A cell.

    Examples
    --------
    >>> cell_text(" yes* "), cell_text(float("nan"))
    ('yes*', '')
    """
    return "" if is_missing(value) else str(value).strip()


def cell_number(value: Any, column: str) -> float:
    """Read a cell as a number; NaN if it is empty.

    Parameters
    ----------
    value : object
        A cell.
    column : str
        Its column, for the error.

    Raises
    ------
    DesignError
        If the cell holds something else.

    Examples
    --------
    >>> cell_number("0.5", "estimate"), cell_number(None, "estimate")
    (0.5, nan)
    """
    text = cell_text(value)
    if not text:
        return math.nan
    try:
        return float(text)
    except ValueError:
        raise DesignError(
            f"value in the column {column!r}", expected="a number or nothing", found=repr(text)
        ) from None


def require_columns(table: pd.DataFrame, names: Sequence[str], which: str) -> None:
    """Refuse a table that lacks one of the named columns.

    Parameters
    ----------
    table : pandas.DataFrame
        The table.
    names : sequence of str
        Columns that it must have.
    which : str
        What to call the table in the error.

    Examples
    --------
    >>> require_columns(pd.DataFrame({"p": [0.5]}), ["p"], "printed")
    """
    missing = [name for name in names if name not in table.columns]
    if missing:
        raise ConfigurationError(
            f"the {which} table lacks a column",
            expected=", ".join(missing),
            found=", ".join(str(name) for name in table.columns),
        )


def presence(left: Mapping[str, Any], right: Mapping[str, Any]) -> str:
    """Name where a row stands: ``both``, ``printed`` or ``reproduced``.

    Parameters
    ----------
    left, right : mapping
        The printed and the reproduced row; empty where there is none.
    """
    if left and right:
        return "both"
    return "printed" if left else "reproduced"
