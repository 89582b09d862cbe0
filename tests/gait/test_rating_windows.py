"""Sliding windows and the ratings that belong to them."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.rating_windows import (
    PRINTED_WINDOWS,
    check_ratings,
    mean_rating,
    sliding_windows,
    window_means,
    window_ratings,
)


def test_windows_of_half_an_hour():
    """Minute 10 to 30: 58 windows of a minute, the last one ends with the run."""
    windows = sliding_windows(600.0, 1800.0, PRINTED_WINDOWS)
    assert windows.shape == (58, 2)
    assert np.allclose(np.diff(windows, axis=1), 60.0)
    assert np.allclose(np.diff(windows[:, 0]), 20.0)
    assert windows[[0, -1]].tolist() == [[600.0, 660.0], [1740.0, 1800.0]]
    assert len(sliding_windows(600.0, 1799.9, PRINTED_WINDOWS)) == 57


def test_a_run_too_short_for_a_window():
    with pytest.raises(RecordingError, match="60 s at least; found 600 to 650 s"):
        sliding_windows(600.0, 650.0, PRINTED_WINDOWS)


@settings(max_examples=50)
@given(st.floats(0.0, 60.0))
def test_the_majority_of_a_window_decides(changed_s):
    """A rating that changes within a window counts if it holds for at least half of it."""
    rating = window_ratings([0.0, 600.0 + changed_s], [1.0, 4.0], [[600.0, 660.0]])[0]
    assert rating == (4.0 if 60.0 - changed_s >= changed_s else 1.0)


def test_the_most_recent_rating_holds():
    windows = sliding_windows(600.0, 720.0, PRINTED_WINDOWS)
    assert window_ratings([30.0, 500.0], [1.0, -2.0], windows).tolist() == [-2.0] * 4
    late = window_ratings([655.0], [3.0], windows)
    assert np.isnan(late).tolist() == [True, True, False, False]
    assert late[2:].tolist() == [3.0, 3.0]


def test_lost_ratings_leave_the_windows_without():
    windows = sliding_windows(600.0, 720.0, PRINTED_WINDOWS)
    held = window_ratings([0.0], [2.0], windows, known_until_s=660.0)
    assert np.isnan(held).tolist() == [False, False, True, True]


@settings(max_examples=50)
@given(st.lists(st.integers(0, 1700), min_size=1, max_size=8, unique=True), st.integers(0, 99))
def test_the_weighted_mean_is_that_of_every_second(times, seed):
    times = sorted(times)
    ratings = np.random.default_rng(seed).integers(-5, 6, len(times))
    seconds = np.arange(600, 1800)
    held = np.searchsorted(times, seconds, side="right") - 1
    each = ratings[held[held >= 0]]
    found = mean_rating(times, ratings, 600.0, 1800.0, mean="time_weighted")
    assert found == pytest.approx(each.mean() if each.size else np.nan, nan_ok=True)


def test_simple_means_count_the_ratings_of_the_span():
    assert mean_rating([0, 700, 900], [9, 1, 4], 600.0, 1800.0, mean="simple") == 2.5
    assert np.isnan(mean_rating([0.0], [1.0], 600.0, 1800.0, mean="simple"))
    assert np.isnan(mean_rating([1800.0], [1.0], 600.0, 1800.0, mean="time_weighted"))


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_means_of_windows_like_a_loop(seed):
    rng = np.random.default_rng(seed)
    at = rng.uniform(0.0, 200.0, 120)
    values = pd.DataFrame(rng.standard_normal((120, 2)), columns=["a", "b"])
    values.iloc[::7, 0] = np.nan
    windows = sliding_windows(0.0, 220.0, PRINTED_WINDOWS)
    found = window_means(at, values, windows, least=15)
    for row, (begin, end) in enumerate(windows):
        inside = values[(at >= begin) & (at < end)]
        for name in values:
            few = inside[name].count() < 15
            expected = np.nan if few else inside[name].mean()
            assert found.loc[row, name] == pytest.approx(expected, nan_ok=True)


@pytest.mark.parametrize(
    ("times", "ratings", "message"),
    [
        ([0.0, 1900.0], [1, 2], "rating 2: a rating was given outside the run; expected 0 to 1800"),
        ([-5.0, 10.0], [1, 2], r"rating 1: .* outside the run; .* found -5"),
        (
            [0.0, 10.0],
            [1, 6],
            "rating 2: a rating lies outside the scale; expected -5 to 5; found 6",
        ),
        ([10.0, 10.0], [1, 2], "rating 2: the ratings are not in the order of time"),
        ([10.0, np.nan], [1, 2], "a rating is missing"),
        ([10.0], [1, 2], "found 1 times, 2 ratings"),
        ([], [], "no ratings of affect"),
    ],
)
def test_ratings_that_cannot_be(times, ratings, message):
    with pytest.raises(RecordingError, match=message):
        check_ratings(times, ratings, run_s=1800.0, lowest=-5.0, highest=5.0)
