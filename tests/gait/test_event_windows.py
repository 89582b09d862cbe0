"""Windows around events against plain loops."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.event_windows import stride_rms, window_maxima

SEEDS = st.integers(0, 2**32 - 1)


@given(SEEDS)
def test_largest_values_like_a_loop(seed):
    rng = np.random.default_rng(seed)
    signal = rng.standard_normal(60)
    signal[rng.integers(0, 60)] = np.nan
    start = rng.uniform(-0.2, 3.2, 12)
    stop = start + rng.uniform(-0.05, 0.6, 12)
    stop[0] = np.nan
    found = window_maxima(signal, start, stop, 20.0)
    for k in range(12):
        expected = np.nan
        if np.isfinite(stop[k]) and stop[k] >= start[k]:
            first, last = round(start[k] * 20.0), round(stop[k] * 20.0)
            if first >= 0 and last < 60:
                expected = max(signal[first : last + 1])
                if np.isnan(signal[first : last + 1]).any():
                    expected = np.nan
        assert found[k] == pytest.approx(expected, nan_ok=True)


@given(SEEDS, st.booleans())
def test_root_mean_squares_like_a_loop(seed, remove_mean):
    rng = np.random.default_rng(seed)
    signals = 9.81 + rng.standard_normal((3, 100))
    first = rng.integers(0, 80, 10)
    last = first + rng.integers(1, 21, 10)
    found = stride_rms(signals, first / 50.0, last / 50.0, 50.0, remove_mean=remove_mean)
    for k in range(10):
        part = signals[:, first[k] : last[k]]
        expected = part.std(axis=1) if remove_mean else np.sqrt(np.mean(part**2, axis=1))
        assert np.allclose(found[:, k], expected, atol=1e-7)


def test_missing_samples_make_their_strides_missing():
    signals = np.ones((2, 40))
    signals[1, 15] = np.nan
    for remove_mean in (True, False):
        found = stride_rms(signals, [0, 1, 2], [1, 2, 4], 10.0, remove_mean=remove_mean)
        assert np.isnan(found).tolist() == [[False] * 3, [False, True, False]]
    lost = np.vstack([np.ones(40), np.full(40, np.nan)])
    assert np.isnan(stride_rms(lost, [0], [4], 10.0, remove_mean=True)).tolist() == [
        [False],
        [True],
    ]


def test_strides_outside_and_none():
    assert stride_rms(np.ones((3, 5)), [], [], 10.0, remove_mean=True).shape == (3, 0)
    assert window_maxima(np.ones(5), [], [], 10.0).shape == (0,)
    assert np.isnan(window_maxima(np.ones(5), [-1.0, 0.2], [0.1, 9.0], 10.0)).all()
    with pytest.raises(RecordingError, match="samples from 0 to 5; found 0 to 7"):
        stride_rms(np.ones((1, 5)), [0.0], [0.7], 10.0, remove_mean=False)
