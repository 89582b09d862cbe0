"""Numbers as text: fixed decimals, one spelling for pages and one for files.

The style ``page`` writes a typographic minus (U+2212); the style ``plain`` is ASCII and can be
read back by any program. A missing value is an empty text in both. A value that rounds to zero
has no sign.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, cast, get_args

from swaystride.errors import ConfigurationError

Style = Literal["page", "plain"]
Kind = Literal["text", "integer", "number", "p"]

MINUS = "\N{MINUS SIGN}"
P_DECIMALS = 3
P_DECIMALS_IN_CSV = 6


def is_missing(value: Any) -> bool:
    """Tell whether a cell is empty: None, NaN, NaT or ``pandas.NA``.

    Parameters
    ----------
    value : object
        A cell.

    Examples
    --------
    >>> is_missing(None), is_missing(float("nan")), is_missing(0.0), is_missing("")
    (True, True, False, False)
    >>> import numpy as np
    >>> is_missing(np.float64(1.0)), is_missing(np.float64("nan"))
    (False, True)
    """
    if value is None:
        return True
    if isinstance(value, str):
        return False
    try:
        return bool(value != value)  # True for NaN and NaT
    except TypeError:  # pandas.NA is neither equal nor unequal
        return True


def format_number(value: Any, decimals: int, style: Style = "page") -> str:
    """Write a number with a fixed count of decimals.

    Parameters
    ----------
    value : float or missing
        The number; missing values give an empty text.
    decimals : int
        Digits after the point, 0 or more.
    style : {"page", "plain"}
        Typographic minus, or ASCII.

    Examples
    --------
    >>> format_number(-0.0301, 3), format_number(-0.0301, 3, "plain")
    ('−0.030', '-0.030')
    >>> format_number(-0.0001, 3), format_number(None, 3), format_number(72, 0)
    ('0.000', '', '72')
    """
    if decimals < 0:
        raise ConfigurationError(
            "decimals of a number format", expected="0 or more", found=str(decimals)
        )
    if is_missing(value):
        return ""
    number = float(value)
    if math.isinf(number):
        text = "inf" if style == "plain" else "∞"
        return text if number > 0 else _minus(style) + text
    text = f"{abs(number):.{decimals}f}"
    negative = number < 0 and float(text) != 0.0
    return _minus(style) + text if negative else text


def format_integer(value: Any, style: Style = "page") -> str:
    """Write a count; a value with a fraction is an error, not a rounding.

    Parameters
    ----------
    value : int, whole float or missing
        The count.
    style : {"page", "plain"}
        Typographic minus, or ASCII.

    Raises
    ------
    ConfigurationError
        If the value is not a whole number.

    Examples
    --------
    >>> format_integer(19.0), format_integer(-2, "plain"), format_integer(True)
    ('19', '-2', '1')
    """
    if is_missing(value):
        return ""
    try:
        number = int(value)
        whole = number == value
    except (TypeError, ValueError, OverflowError):
        whole = False
    if not whole:
        raise ConfigurationError(
            "value under the format 'integer'", expected="a whole number", found=repr(value)
        )
    return f"{_minus(style)}{-number}" if number < 0 else str(number)


def format_p(value: Any, decimals: int = P_DECIMALS, *, upper_bound: bool = False) -> str:
    """Write a p-value: fixed decimals, and bounds at both ends instead of 0.000 and 1.000.

    Parameters
    ----------
    value : float or missing
        Probability between 0 and 1.
    decimals : int
        Digits after the point.
    upper_bound : bool
        The source prints "less than value" instead of a value.

    Raises
    ------
    ConfigurationError
        If the value is not a probability.

    Examples
    --------
    >>> format_p(0.0123), format_p(2e-5), format_p(0.01, upper_bound=True), format_p(0.99996)
    ('0.012', '<0.001', '<0.010', '>0.999')
    """
    if is_missing(value):
        return ""
    p = float(value)
    if not 0.0 <= p <= 1.0:
        raise ConfigurationError("p-value", expected="a number from 0 to 1", found=repr(p))
    step = 10.0**-decimals
    if upper_bound:
        return "<" + format_number(p, decimals)
    if p < step:
        return "<" + format_number(step, decimals)
    text = format_number(p, decimals)
    return ">" + format_number(1.0 - step, decimals) if float(text) == 1.0 and p < 1.0 else text


def format_interval(low: Any, high: Any, decimals: int, style: Style = "page") -> str:
    """Write an interval in brackets; empty if both ends are missing.

    Parameters
    ----------
    low, high : float or missing
        Ends; one missing end is shown as a question mark.
    decimals : int
        Digits after the point.
    style : {"page", "plain"}
        Typographic minus, or ASCII.

    Examples
    --------
    >>> format_interval(-0.046, -0.014, 3), format_interval(-0.046, 0.014, 3, "plain")
    ('[−0.046, −0.014]', '[-0.046, 0.014]')
    """
    if is_missing(low) and is_missing(high):
        return ""
    low_text, high_text = (format_number(end, decimals, style) or "?" for end in (low, high))
    return f"[{low_text}, {high_text}]"


@dataclass(frozen=True)
class ColumnFormat:
    """How the cells of one column are written.

    Parameters
    ----------
    kind : {"text", "integer", "number", "p"}
        What the column holds.
    decimals : int
        Digits after the point in the renderings for people.
    csv_decimals : int
        Digits after the point in the CSV.
    """

    kind: Kind
    decimals: int = 0
    csv_decimals: int = 0

    @property
    def is_numeric(self) -> bool:
        """Whether the column is aligned as numbers."""
        return self.kind != "text"

    def cell(self, value: Any, style: Style = "page", *, upper_bound: bool = False) -> str:
        """Write one cell.

        Examples
        --------
        >>> p = parse_format("p")
        >>> p.cell(0.00002), p.cell(0.00002, "plain")
        ('<0.001', '0.000020')
        """
        if is_missing(value):
            return ""
        if self.kind == "text":
            return str(value)
        if self.kind == "integer":
            return format_integer(value, style)
        if style == "plain":
            return format_number(value, self.csv_decimals, style)
        if self.kind == "p":
            return format_p(value, self.decimals, upper_bound=upper_bound)
        text = format_number(value, self.decimals, style)
        return f"<{text}" if upper_bound else text

    def interval(self, low: Any, high: Any, style: Style = "page") -> str:
        """Write an interval with the decimals of the column."""
        return format_interval(low, high, self.decimals, style)


def parse_format(spec: str | int) -> ColumnFormat:
    """Read a column format from its short form in a configuration.

    Parameters
    ----------
    spec : str or int
        ``3`` or ``"number:3"``: three decimals. ``"number:3:6"``: three decimals for people, six
        in the CSV. ``"p"``: p-value, three decimals with bounds for people, six in the CSV
        (``"p:2"``: two for people). ``"integer"``, ``"text"``.

    Raises
    ------
    ConfigurationError
        If the short form is unknown.

    Examples
    --------
    >>> parse_format("number:3:6")
    ColumnFormat(kind='number', decimals=3, csv_decimals=6)
    >>> parse_format(2) == parse_format("number:2")
    True
    """
    kind, *digits = str(spec).split(":") if not isinstance(spec, int) else ("number", str(spec))
    at_most = {"text": 0, "integer": 0, "number": 2, "p": 2}.get(kind, -1)
    known = kind in get_args(Kind) and len(digits) <= at_most
    if (
        not known
        or not all(part.isdecimal() for part in digits)
        or (kind, digits) == ("number", [])
    ):
        raise ConfigurationError(
            "column format",
            expected="a count of decimals, 'number:D', 'number:D:C', 'p', 'integer' or 'text'",
            found=repr(spec),
        )
    if kind == "p":
        decimals = int(digits[0]) if digits else P_DECIMALS
        in_csv = int(digits[1]) if len(digits) > 1 else max(P_DECIMALS_IN_CSV, decimals)
    else:
        decimals = int(digits[0]) if digits else 0
        in_csv = int(digits[1]) if len(digits) > 1 else decimals
    return ColumnFormat(cast(Kind, kind), decimals, in_csv)


def _minus(style: Style) -> str:
    return "-" if style == "plain" else MINUS
