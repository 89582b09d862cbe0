"""Strides matched in time, and the spread of their differences."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.studies.imu_design.stride_differences import (
    difference_summary,
    match_strides,
    pooled_sd,
)


def strides(edges, lengths=None, angles=None):
    """Strides between successive instants."""
    n = len(edges) - 1
    half = np.zeros(n, dtype=bool)
    half[[0, -1]] = True
    return pd.DataFrame(
        {
            "start_s": edges[:-1],
            "stop_s": edges[1:],
            "length_m": np.ones(n) if lengths is None else lengths,
            "angle_rad": np.zeros(n) if angles is None else angles,
            "is_half": half,
        }
    )


def test_every_stride_is_its_own_match():
    table = strides(np.arange(8.0))
    matches = match_strides(table, table)
    assert matches.baseline.tolist() == matches.other.tolist() == list(range(7))


def test_strides_taken_for_one_have_no_partner():
    """The other estimate misses the epochs at 3, 4 and 5 s."""
    matches = match_strides(
        strides(np.arange(9.0)), strides(np.array([0.0, 1.0, 2.0, 6.0, 7.0, 8.0]))
    )
    assert matches.baseline.tolist() == [0, 1, 6, 7]
    assert matches.other.tolist() == [0, 1, 3, 4]


def test_a_split_stride_has_no_partner():
    matches = match_strides(
        strides(np.arange(5.0)), strides(np.array([0.0, 1.0, 1.5, 2.0, 3.0, 4.0]))
    )
    assert matches.baseline.tolist() == [0, 2, 3]
    assert matches.other.tolist() == [0, 3, 4]


@given(st.floats(-0.45, 0.45), st.integers(2, 12))
def test_a_shift_below_half_a_stride_does_not_matter(shift, n):
    table = strides(np.arange(n + 1.0))
    moved = strides(np.arange(n + 1.0) + shift)
    assert match_strides(table, moved).other.tolist() == list(range(n))


def test_nothing_matches_nothing():
    table = strides(np.arange(4.0))
    assert match_strides(table.iloc[:0], table).baseline.size == 0
    summary = difference_summary(table, table.iloc[:0])
    assert summary["n_matched"] == 0
    assert np.isnan(summary["length_difference_sd_m"])


def test_differences_are_baseline_minus_estimate_of_whole_strides():
    """Half strides at the ends are left out; the angle of the last stride is unknown."""
    edges = np.arange(7.0)
    angles = np.deg2rad([9.0, 1.0, 2.0, 3.0, np.nan, np.nan])
    baseline = strides(edges, [5.0, 1.0, 1.2, 1.4, 1.6, 5.0], angles)
    other = strides(edges, [1.0, 0.9, 1.0, 1.1, 1.2, 1.0], np.deg2rad([0.0] * 5 + [np.nan]))
    summary = difference_summary(baseline, other)
    assert summary["n_matched"] == 4
    assert summary["length_difference_mean_m"] == pytest.approx(0.25)
    assert summary["length_difference_sd_m"] == pytest.approx(np.std([0.1, 0.2, 0.3, 0.4], ddof=1))
    assert summary["n_angles"] == 3
    assert summary["angle_difference_mean_deg"] == pytest.approx(2.0)
    assert summary["angle_difference_sd_deg"] == pytest.approx(1.0)


@given(st.lists(st.lists(st.floats(-5, 5), min_size=0, max_size=6), min_size=1, max_size=4))
def test_pooled_moments_are_those_of_the_joined_sample(samples):
    parts = [np.array(sample) for sample in samples]
    moments = np.array(
        [
            (x.size, x.mean() if x.size else np.nan, x.std(ddof=1) if x.size > 1 else np.nan)
            for x in parts
        ]
    )
    joined = np.concatenate(parts)
    found = pooled_sd(*moments.T)
    if joined.size < 2:
        assert np.isnan(found)
    else:
        assert found == pytest.approx(joined.std(ddof=1), abs=1e-9)
