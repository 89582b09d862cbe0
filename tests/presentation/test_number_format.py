"""Number formatting: properties, bounds and refusals."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import ConfigurationError
from swaystride.presentation.number_format import (
    MINUS,
    format_integer,
    format_interval,
    format_number,
    format_p,
    is_missing,
    parse_format,
)

finite = st.floats(-1e9, 1e9)
places = st.integers(0, 8)


@given(finite, places)
def test_plain_text_reads_back_within_half_a_unit_of_the_last_decimal(value, decimals):
    text = format_number(value, decimals, "plain")
    assert text.isascii()
    # the slack is the rounding of the float itself, a few units of its last place
    assert abs(float(text) - value) <= 0.5 * 10**-decimals + 4 * np.spacing(abs(value))


@given(finite, places)
def test_page_and_plain_differ_only_in_the_minus(value, decimals):
    page = format_number(value, decimals)
    assert page.replace(MINUS, "-") == format_number(value, decimals, "plain")
    assert "-" not in page


@given(finite, places)
def test_shape_is_fixed_and_zero_has_no_sign(value, decimals):
    text = format_number(value, decimals, "plain")
    assert re.fullmatch(r"-?\d+" + (rf"\.\d{{{decimals}}}" if decimals else ""), text)
    assert not (text.startswith("-") and float(text) == 0.0)


@given(finite, places)
def test_sign_is_symmetric(value, decimals):
    text = format_number(abs(value), decimals, "plain")
    mirrored = format_number(-abs(value), decimals, "plain")
    assert mirrored in (text, "-" + text)


@given(st.floats(0, 1), st.integers(1, 6))
def test_p_is_never_printed_as_impossible_or_certain(p, decimals):
    text = format_p(p, decimals)
    if text[0] == "<":
        assert p < 10.0**-decimals == float(text[1:])
    elif text[0] == ">":
        assert p > float(text[1:])
    else:
        assert float(text) == pytest.approx(p, abs=0.5001 * 10.0**-decimals)
        assert float(text) > 0.0


@pytest.mark.parametrize("missing", [None, float("nan"), np.nan, pd.NA, pd.NaT, np.float32("nan")])
def test_missing_is_empty_everywhere(missing):
    assert is_missing(missing)
    assert format_number(missing, 3) == format_integer(missing) == format_p(missing) == ""
    assert format_interval(missing, missing, 2) == ""
    for spec in ("text", "integer", "number:2", "p"):
        assert parse_format(spec).cell(missing) == ""


def test_half_open_interval_shows_the_gap():
    assert format_interval(-0.5, None, 1) == "[−0.5, ?]"


def test_infinity_is_legible():
    assert format_number(-np.inf, 2) == "−∞"
    assert float(format_number(-np.inf, 2, "plain")) == -np.inf


@given(st.integers(-(10**15), 10**15))
def test_integers_are_exact(value):
    assert int(format_integer(value, "plain")) == value


@pytest.mark.parametrize("value", [1.5, "many", np.inf])
def test_integer_format_refuses_a_fraction(value):
    with pytest.raises(ConfigurationError, match=r"'integer'; expected a whole number; found"):
        format_integer(value)


@pytest.mark.parametrize("p", [-0.01, 1.01])
def test_p_outside_zero_to_one_is_refused(p):
    with pytest.raises(ConfigurationError, match=r"p-value; expected a number from 0 to 1"):
        format_p(p)


@pytest.mark.parametrize("spec", ["", "nummer", "number", "number:x", "number:1:2:3", "text:2", -1])
def test_unknown_format_says_what_is_known(spec):
    with pytest.raises(ConfigurationError, match=r"column format; expected a count of decimals"):
        parse_format(spec)


def test_negative_decimals_are_refused():
    with pytest.raises(ConfigurationError, match=r"0 or more; found -1"):
        format_number(1.0, -1)


def test_short_forms():
    assert parse_format("number:2:5").cell(-1 / 3, "plain") == "-0.33333"
    assert parse_format("number:2:5").cell(-1 / 3) == "−0.33"
    assert parse_format("p").cell(0.5, "plain") == "0.500000"
    assert parse_format("p:2").cell(0.001) == "<0.01"
    assert parse_format(3).cell(0.05, upper_bound=True) == "<0.050"
    assert parse_format(3).interval(-1, 2) == "[−1.000, 2.000]"
    assert parse_format("text").cell("4:40") == "4:40"
