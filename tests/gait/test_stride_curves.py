import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from swaystride.errors import RecordingError
from swaystride.gait.stride_curves import N_PHASES, ensemble, stride_curves

VALUES = st.floats(-100, 100, width=32)


@given(hnp.arrays(float, (2, 3, 60), elements=VALUES), st.integers(0, 20), st.integers(2, 19))
def test_every_phase_is_the_linear_interpolation(signals, first, length):
    start, stop = [first, first + length], [first + length, first + 2 * length]
    curves = stride_curves(signals, start, stop)
    assert curves.shape == (2, 3, 2, N_PHASES)
    at = np.linspace(start[1], stop[1], N_PHASES)
    assert np.allclose(curves[1, 2, 1], np.interp(at, np.arange(60), signals[1, 2]), atol=1e-9)
    # the end of a stride is the begin of the next one
    assert np.allclose(curves[..., 0, -1], curves[..., 1, 0], atol=1e-9)


@given(hnp.arrays(float, (6, 11), elements=VALUES), st.floats(-9, 9), st.floats(-5, 5))
def test_mean_and_scatter_follow_gain_and_offset(curves, gain, offset):
    mean, sd = ensemble(curves)
    assert np.allclose(mean, curves.mean(axis=0), atol=1e-9)
    assert np.allclose(sd, curves.std(axis=0, ddof=1), atol=1e-9)
    changed_mean, changed_sd = ensemble(gain * curves + offset)
    assert np.allclose(changed_mean, gain * mean + offset, atol=1e-6)
    assert np.allclose(changed_sd, abs(gain) * sd, atol=1e-6)


def test_missing_samples_touch_the_phases_beside_them_only():
    signal = np.arange(30.0)
    signal[7] = np.nan
    curves = stride_curves(signal, [0, 10], [10, 20], n_phases=11)
    assert np.isnan(curves[0]).nonzero()[0].tolist() == [7]
    mean, sd = ensemble(curves)
    assert mean[7] == 17.0
    assert np.isnan(sd).nonzero()[0].tolist() == [7]
    assert np.isnan(ensemble(np.full((0, 5), 1.0))[0]).all()


def test_strides_of_any_duration_share_their_shape():
    durations = np.array([80, 100, 143, 60])
    edges = np.cumsum(np.r_[0, durations])
    phase = np.concatenate([np.arange(n) / n for n in durations] + [[0.0]])
    mean, sd = ensemble(stride_curves(np.sin(2 * np.pi * phase), edges[:-1], edges[1:]))
    assert np.allclose(mean, np.sin(np.linspace(0, 2 * np.pi, N_PHASES)), atol=2e-3)
    assert sd.max() < 2e-3


@pytest.mark.parametrize(("start", "stop"), [([0, 10], [10, 31]), ([-1], [9]), ([5], [5])])
def test_strides_outside_the_recording(start, stop):
    with pytest.raises(RecordingError, match=r"expected samples from 0 to 29"):
        stride_curves(np.zeros(30), start, stop)
