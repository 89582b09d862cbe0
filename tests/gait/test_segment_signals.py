"""Low-pass of signals with gaps, part by part."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.segment_signals import (
    PRINTED_FILTERS,
    SegmentSignals,
    complete_parts,
    filtered,
    lowpassed_parts,
)


def test_the_cut_off_halves_the_amplitude_and_does_not_shift():
    """−3 dB forward and again backward: half of a sine at the cut-off is left, in phase."""
    time = np.arange(5000) / 500.0
    acc, gyr = np.sin(2 * np.pi * 60.0 * time), np.sin(2 * np.pi * 50.0 * time)
    out = filtered(
        SegmentSignals(np.tile(acc, (3, 1)), np.tile(gyr, (3, 1))), 500.0, PRINTED_FILTERS
    )
    middle = slice(1000, 4000)
    assert np.allclose(out.acc_m_s2[:, middle], 0.5 * acc[middle], atol=1e-6)
    assert np.allclose(out.gyr_rad_s[:, middle], 0.5 * gyr[middle], atol=1e-6)


def test_parts_are_filtered_by_themselves():
    noise = np.random.default_rng(1).standard_normal((2, 900))
    holed = noise.copy()
    holed[0, 300:340] = np.nan
    out = lowpassed_parts(holed, 20.0, 200.0)
    assert np.isnan(out[:, 300:340]).all()
    assert np.array_equal(out[:, :300], lowpassed_parts(noise[:, :300], 20.0, 200.0))
    assert np.array_equal(out[:, 340:], lowpassed_parts(noise[:, 340:], 20.0, 200.0))


@given(st.lists(st.booleans(), min_size=1, max_size=40))
def test_parts_hold_all_samples_that_are_there(missing):
    flags = np.array(missing)
    parts = complete_parts(np.where(flags, np.nan, 1.0))
    held = np.zeros(flags.size, dtype=bool)
    for first, last in parts:
        assert last > first
        held[first:last] = True
    assert np.array_equal(held, ~flags)
    assert np.all(parts[1:, 0] > parts[:-1, 1])


def test_shapes_that_do_not_fit():
    with pytest.raises(
        RecordingError, match=r"two arrays of shape \(3, n\); found \(3, 5\) and \(3, 6\)"
    ):
        SegmentSignals(np.zeros((3, 5)), np.zeros((3, 6)))
    lost = SegmentSignals(np.array([[0.0, np.nan]] * 3), np.zeros((3, 2)))
    assert lost.missing().tolist() == [False, True]
