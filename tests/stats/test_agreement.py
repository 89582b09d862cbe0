"""Agreement of ratings: pandas and plain loops agree; what is not on the scale is refused."""

import math

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import DesignError
from swaystride.stats.agreement import (
    conditional_share,
    contingency,
    exact_agreement,
    rounded_rating,
)

LEVELS = [1, 2, 3, 4, 5]
pairs = st.lists(st.tuples(*[st.sampled_from(LEVELS)] * 2), min_size=1, max_size=60)


@given(st.lists(st.floats(-1e6, 1e6), min_size=1), st.integers(-3, 2), st.integers(3, 9))
def test_a_rounded_rating_is_the_nearest_of_the_scale(prediction, low, high):
    found = rounded_rating(prediction, low, high)
    scale = np.arange(low, high + 1)
    for value, rating in zip(prediction, found.tolist(), strict=True):
        assert abs(value - rating) == np.abs(value - scale).min()


def test_halves_go_up_and_the_ends_hold():
    assert rounded_rating([0.4, 1.5, 2.5, 3.5, 4.5, 5.5]).tolist() == [1, 2, 3, 4, 5, 5]


@given(pairs)
def test_the_table_counts_what_pandas_counts(ratings):
    a, b = map(list, zip(*ratings, strict=True))
    table = contingency(a, b, LEVELS)
    theirs = pd.crosstab(pd.Series(a), pd.Series(b)).reindex(
        index=LEVELS, columns=LEVELS, fill_value=0
    )
    assert (table.to_numpy() == theirs.to_numpy()).all()
    assert table.to_numpy().sum() == len(ratings)
    assert (contingency(b, a, LEVELS).to_numpy() == table.to_numpy().T).all()


@given(pairs)
def test_shares_follow_from_the_table(ratings):
    a, b = map(np.array, zip(*ratings, strict=True))
    table = contingency(a, b, LEVELS)
    assert exact_agreement(a, b) == pytest.approx(np.trace(table.to_numpy()) / len(a))
    assert exact_agreement(a, a) == 1.0
    for row in LEVELS:
        of_row = b[a == row]
        for column in LEVELS:
            share = conditional_share(table, row, column)
            if len(of_row) == 0:
                assert math.isnan(share)
            else:
                assert share == pytest.approx(sum(of_row == column) / len(of_row))


def test_levels_may_be_words():
    table = contingency(["easy", "hard"], ["hard", "hard"], ["easy", "hard"])
    assert conditional_share(table, "easy", "hard") == 1.0


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (lambda: rounded_rating([1.0, np.nan]), "prediction is not finite in 1 of 2 places"),
        (lambda: rounded_rating([1.0], 5, 1), "scale is empty; expected low < high; found 5 and 1"),
        (lambda: exact_agreement([1, 2], [1]), r"found shapes \(2,\) and \(1,\)"),
        (lambda: exact_agreement([], []), "nothing is rated"),
        (lambda: exact_agreement([1, None], [1, 2]), "rating is missing in 1 of 2 places"),
        (lambda: contingency([1, 7], [1, 2], LEVELS), "not on the scale; .*; found 7"),
        (lambda: contingency([1.5], [1], LEVELS), "not on the scale; .*; found 1.5"),
        (lambda: contingency([1], [1], [1, 2, 1]), "named twice"),
        (lambda: conditional_share(contingency([1], [1], LEVELS), 1, 6), "no such rating; .* 6"),
        (lambda: conditional_share(contingency([1], [1], LEVELS), 0, 1), "no such rating; .* 0"),
    ],
)
def test_what_is_no_rating_is_refused(call, line):
    with pytest.raises(DesignError, match=line):
        call()
