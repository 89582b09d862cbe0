"""Comparison: arithmetic by hand, order, lonely rows, bounds, words, attainability."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from swaystride.errors import ConfigurationError, DesignError
from swaystride.presentation.table_files import read_table
from swaystride.report.attainability import Unattainable
from swaystride.report.comparison import Value, compare_numbers, compare_words, summarise

PUBLISHED = Path(__file__).resolve().parents[2] / "data" / "published"
ESTIMATE = Value("estimate", "number:3", ci=("ci_low", "ci_high"), confidence=0.95)
KEYS = ["panel", "feature", "effect"]


def one_row(printed, reproduced, value, **columns):
    left = pd.DataFrame({"key": ["a"], "x": [printed]} | columns.get("left", {}))
    right = pd.DataFrame({"key": ["a"], "x": [reproduced]} | columns.get("right", {}))
    return compare_numbers(left, right, keys=["key"], values=[value]).iloc[0]


def test_difference_in_standard_errors_by_hand():
    row = one_row(0.10, 0.16, Value("x", 2, se="se"), right={"se": [0.02]})
    assert row["difference_in_se"] == pytest.approx(3.0)
    assert row["agreement"] == "borderline"
    row = one_row(0.10, 0.05, Value("x", 2, se="se"), right={"se": [0.02]})
    assert row["difference_in_se"] == pytest.approx(-2.5)


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.01, 10), st.floats(0.5, 0.999))
def test_half_width_of_a_normal_interval_gives_the_standard_error(printed, ours, se, confidence):
    half = stats.norm.ppf(0.5 + confidence / 2) * se
    value = Value("x", 2, ci=("low", "high"), confidence=confidence)
    row = one_row(printed, ours, value, right={"low": [ours - half], "high": [ours + half]})
    assert row["se"] == pytest.approx(se, rel=1e-6)
    assert row["difference_in_se"] == pytest.approx((ours - printed) / se, rel=1e-6, abs=1e-9)


def test_half_width_of_a_t_interval_uses_the_degrees_of_freedom():
    half = stats.t.ppf(0.975, 7) * 0.3
    value = Value("x", 2, ci=("low", "high"), confidence=0.95, df="df")
    right = {"low": [1 - half], "high": [1 + half], "df": [7]}
    assert one_row(0.0, 1.0, value, right=right)["se"] == pytest.approx(0.3)


@pytest.mark.parametrize(
    ("ours", "agreement"), [(1.0, "agrees"), (3.0, "agrees"), (3.5, "borderline"), (5.1, "differs")]
)
def test_agreement_classes(ours, agreement):
    row = one_row(1.0, ours, Value("x", 1, se="se"), right={"se": [1.0]})
    assert row["agreement"] == agreement


def test_the_printed_table_agrees_with_itself_in_its_own_order():
    printed = read_table(PUBLISHED / "table_2_3.csv")
    values = [ESTIMATE, Value("p", "p")]
    shuffled = printed.sample(frac=1.0, random_state=1).drop(columns="p_is_upper_bound")
    frame = compare_numbers(printed, shuffled, keys=KEYS, values=values)
    estimates = frame[frame["compared"] == "estimate"]
    pd.testing.assert_frame_equal(
        estimates[KEYS].reset_index(drop=True), printed[KEYS], check_dtype=False
    )
    assert (estimates["difference_in_se"] == 0.0).all()
    assert summarise(frame).agrees == summarise(frame).compared == len(printed)
    assert summarise(frame).one_table_only == 0
    bounds = frame.loc[frame["compared"] == "p", "printed_is_bound"].to_numpy(bool)
    np.testing.assert_array_equal(bounds, printed["p_is_upper_bound"] == 1)


def test_a_key_may_be_called_quantity_but_not_like_a_column_of_the_comparison():
    table = pd.DataFrame({"quantity": ["a", "b"], "value": [1.0, 2.0], "se": [0.1, 0.1]})
    frame = compare_numbers(table, table, keys=["quantity"], values=[Value("value", 2, se="se")])
    assert frame["quantity"].tolist() == ["a", "b"]
    assert summarise(frame).agrees == 2
    clash = table.rename(columns={"quantity": "reason"})
    with pytest.raises(ConfigurationError, match="a key has the name"):
        compare_numbers(clash, clash, keys=["reason"], values=[Value("value", 2)])


def test_rows_of_one_table_only_are_listed():
    printed = pd.DataFrame({"key": ["b", "a"], "x": [1.0, 2.0]})
    ours = pd.DataFrame({"key": ["c", "a"], "x": [3.0, 2.5]})
    frame = compare_numbers(printed, ours, keys=["key"], values=[Value("x", 1)])
    assert frame["key"].tolist() == ["b", "a", "c"]
    assert frame["presence"].tolist() == ["printed", "both", "reproduced"]
    assert np.isnan(frame.loc[0, "reproduced"])
    assert np.isnan(frame.loc[2, "printed"])
    assert summarise(frame).one_table_only == 2


def test_empty_print_is_shown_and_not_judged():
    row = one_row(None, 1.0, Value("x", 1, se="se"), right={"se": [0.5]})
    assert row["presence"] == "both"
    assert row["agreement"] == ""
    assert math.isnan(row["difference_in_se"])


def test_p_value_is_not_judged():
    row = one_row(0.001, 0.5, Value("x", "p"), left={"x_is_upper_bound": [1]})
    assert row["printed_is_bound"]
    assert row["agreement"] == ""


@pytest.mark.parametrize(("ours", "difference"), [(0.5, 0.0), (1.0, 0.0), (1.5, 5.0)])
def test_upper_bound_is_kept_or_exceeded(ours, difference):
    row = one_row(
        1.0, ours, Value("x", 1, se="se"), left={"x_is_upper_bound": [1]}, right={"se": [0.1]}
    )
    assert row["difference_in_se"] == pytest.approx(difference)


def test_zero_standard_error_compares_nothing():
    assert one_row(1.0, 2.0, Value("x", 1, se="se"), right={"se": [0.0]})["agreement"] == ""


def test_keys_that_are_numbers_match_by_value():
    printed = pd.DataFrame({"exponent": [0.4, 0.5], "x": [1, 2]})
    ours = pd.DataFrame({"exponent": ["0.50", "0.40"], "x": [2, 1]})
    frame = compare_numbers(printed, ours, keys=["exponent"], values=[Value("x", 0)])
    assert frame["presence"].tolist() == ["both", "both"]
    assert frame["printed"].tolist() == frame["reproduced"].tolist()


def test_words_of_the_selection_table():
    printed = read_table(PUBLISHED / "table_2_2.csv")
    columns = list(printed.columns[2:])
    ours = printed.copy()
    ours.loc[0, "order"] = "yes"  # printed: no
    ours.loc[1, "intercept"] = "yes"  # printed: yes*
    frame = compare_words(printed, ours, keys=["feature"], columns=columns)
    summary = summarise(frame)
    assert (summary.agrees, summary.borderline, summary.differs) == (6 * 13 - 2, 1, 1)
    changed = frame[frame["agreement"] != "agrees"]
    assert changed["compared"].tolist() == ["order", "intercept"]
    assert changed["agreement"].tolist() == ["differs", "borderline"]


def test_unattainable_rows_are_marked_and_not_counted():
    printed = pd.DataFrame({"key": ["a", "b"], "x": [1.0, 1.0]})
    ours = pd.DataFrame({"key": ["a", "b"], "x": [9.0, 1.0], "se": [1.0, 1.0]})
    rules = [Unattainable({"key": "a"}, "Contradicts itself.", ("x",))]
    frame = compare_numbers(
        printed, ours, keys=["key"], values=[Value("x", 1, se="se")], unattainable=rules
    )
    assert frame["attainable"].tolist() == [False, True]
    assert frame.loc[0, "reason"] == "Contradicts itself."
    summary = summarise(frame)
    assert (summary.agrees, summary.differs, summary.unattainable) == (1, 0, 1)


def test_the_analysis_may_mark_rows_itself():
    printed = pd.DataFrame({"key": ["a"], "x": [1.0]})
    ours = printed.assign(attainable=0, attainable_reason="Identity violated.")
    frame = compare_numbers(printed, ours, keys=["key"], values=[Value("x", 1)])
    assert not frame.loc[0, "attainable"]
    assert frame.loc[0, "reason"] == "Identity violated."


def test_rule_that_matches_nothing_is_refused():
    printed = pd.DataFrame({"key": ["a"], "x": [1.0]})
    with pytest.raises(ConfigurationError, match=r"matches no row; .* found key=z"):
        compare_numbers(
            printed,
            printed,
            keys=["key"],
            values=[Value("x", 1)],
            unattainable=[Unattainable({"key": "z"}, "r")],
        )


def test_key_twice_is_refused():
    good = pd.DataFrame({"key": ["a"], "x": [1.0]})
    bad = pd.DataFrame({"key": ["a", "a"], "x": [1.0, 2.0]})
    with pytest.raises(DesignError, match=r"two rows of the reproduced table have the same key"):
        compare_numbers(good, bad, keys=["key"], values=[Value("x", 1)])


def test_absent_columns_are_named():
    frame = pd.DataFrame({"key": ["a"], "x": [1.0]})
    with pytest.raises(ConfigurationError, match=r"reproduced table lacks a column; expected se"):
        compare_numbers(frame, frame, keys=["key"], values=[Value("x", 1, se="se")])
    with pytest.raises(ConfigurationError, match=r"printed table lacks a column; expected y"):
        compare_numbers(frame, frame, keys=["key"], values=[Value("y", 1)])
    with pytest.raises(ConfigurationError, match=r"lacks a column; expected group"):
        compare_numbers(frame, frame, keys=["group"], values=[Value("x", 1)])


def test_text_in_a_number_column_is_refused():
    printed = pd.DataFrame({"key": ["a"], "x": [">15"]})
    ours = pd.DataFrame({"key": ["a"], "x": [15]})
    with pytest.raises(DesignError, match=r"column 'x'; expected a number or nothing; found '>15'"):
        compare_numbers(printed, ours, keys=["key"], values=[Value("x", 1)])


def test_confidence_is_not_guessed():
    frame = pd.DataFrame({"key": ["a"], "x": [1.0], "low": [0.0], "high": [2.0]})
    with pytest.raises(ConfigurationError, match=r"standard error of 'x'; .* found 'ci' alone"):
        compare_numbers(frame, frame, keys=["key"], values=[Value("x", 1, ci=("low", "high"))])
    wrong = Value("x", 1, ci=("low", "high"), confidence=95)
    with pytest.raises(ConfigurationError, match=r"between 0 and 1; found 95"):
        compare_numbers(frame, frame, keys=["key"], values=[wrong])
