"""Gaps: found, filled when short, left alone otherwise."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from swaystride.signals.gaps import fill_short_gaps, missing_runs, present_span

MASKS = st.lists(st.booleans(), min_size=1, max_size=60)


def slow_runs(mask):
    """Runs of True, by walking through the list."""
    runs, start = [], None
    for index, value in enumerate([*mask, False]):
        if value and start is None:
            start = index
        if not value and start is not None:
            runs.append((start, index - start))
            start = None
    return runs


@given(MASKS)
def test_runs_agree_with_a_walk_through_the_list(mask):
    signal = np.where(mask, np.nan, 1.0)
    runs = missing_runs(signal)
    assert list(runs.itertuples(index=False, name=None)) == slow_runs(mask)


@given(MASKS, st.floats(-5, 5), st.floats(-2, 2))
def test_a_straight_line_is_rebuilt_exactly_between_its_ends(mask, offset, slope):
    line = offset + slope * np.arange(len(mask))
    signal = np.where(mask, np.nan, line)
    filled = fill_short_gaps(np.stack([signal, 2 * line]), longest_gap=len(mask))
    inside = present_span(signal)
    np.testing.assert_allclose(filled[0, inside], line[inside], atol=1e-9)
    outside = np.ones(len(mask), dtype=bool)
    outside[inside] = False
    assert np.isnan(filled[0, outside]).all()


def test_a_gap_longer_than_allowed_stays():
    signal = np.array([0.0, np.nan, 2.0, np.nan, np.nan, 5.0])
    filled = fill_short_gaps(signal, longest_gap=1)
    np.testing.assert_array_equal(np.isnan(filled), [False, False, False, True, True, False])


def test_the_input_is_not_changed():
    signal = np.array([0.0, np.nan, 2.0])
    fill_short_gaps(signal, longest_gap=1)
    assert np.isnan(signal[1])


def test_a_sample_is_missing_if_any_channel_is():
    signal = np.array([[0.0, np.nan, 2.0, 3.0], [0.0, 1.0, 2.0, np.nan]])
    assert missing_runs(signal)["start"].tolist() == [1, 3]
    assert present_span(signal) == slice(0, 3)
    assert present_span(np.full((2, 3), np.nan)) == slice(0, 0)
