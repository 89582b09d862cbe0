"""Clipping and data loss: closed forms and properties."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from swaystride.errors import RecordingError
from swaystride.signals.saturation import clip_axes, data_loss_percent

SIGNALS = arrays(np.float64, (3, 12), elements=st.floats(-200, 200, width=32))
LIMITS = st.floats(0.5, 250)


def test_the_loss_of_a_clipped_sine_has_its_closed_form():
    """A sine clipped at half its amplitude: ∫ is 4 per period, of which clipping leaves this."""
    phase = (np.arange(200_000) + 0.5) * 2 * np.pi / 200_000
    full = np.sin(phase)[np.newaxis]
    a = np.arcsin(0.5)
    kept = 4 * (1 - np.cos(a)) + 4 * 0.5 * (np.pi / 2 - a)
    loss = data_loss_percent(clip_axes(full, limit=0.5), full)
    assert loss == pytest.approx(100 * (1 - kept / 4), abs=1e-6)


def test_the_magnitude_is_taken_over_the_axes():
    """One axis of three is clipped: sqrt(3² + 4² + 6²) remains of sqrt(3² + 4² + 12²) = 13."""
    full = np.array([[3.0], [4.0], [12.0]])
    loss = data_loss_percent(clip_axes(full, limit=6.0), full)
    assert loss == pytest.approx(100 * (1 - np.sqrt(61) / 13))


@given(SIGNALS, LIMITS)
def test_nothing_beyond_the_range_and_nothing_else_changed(signal, limit):
    clipped = clip_axes(signal, limit=limit)
    assert (np.abs(clipped) <= limit).all()
    inside = np.abs(signal) <= limit
    assert (clipped[inside] == signal[inside]).all()
    assert (np.sign(clipped) == np.sign(signal)).all()
    np.testing.assert_array_equal(clip_axes(clipped, limit=limit), clipped)


@given(SIGNALS.filter(lambda s: np.abs(s).max() > 1e-3), LIMITS, LIMITS)
def test_the_loss_grows_as_the_range_shrinks(signal, one, other):
    small, large = sorted((one, other))
    losses = [data_loss_percent(clip_axes(signal, limit=x), signal) for x in (small, large)]
    assert 100 >= losses[0] >= losses[1] - 1e-9 >= -1e-9
    if np.abs(signal).max() <= large:
        assert losses[1] == 0.0


@given(SIGNALS.filter(lambda s: np.abs(s).max() > 1e-3), LIMITS, st.floats(0.01, 100))
def test_the_loss_has_no_unit(signal, limit, scale):
    one = data_loss_percent(clip_axes(signal, limit=limit), signal)
    other = data_loss_percent(clip_axes(scale * signal, limit=scale * limit), scale * signal)
    assert one == pytest.approx(other, abs=1e-8)


def test_missing_samples_stay_missing_when_clipped():
    assert np.isnan(clip_axes([[np.nan, 9.0]], limit=6.0)).tolist() == [[True, False]]


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (
            lambda: clip_axes([[1.0]], limit=0.0),
            "the range of a sensor; expected above 0; found 0.0",
        ),
        (
            lambda: data_loss_percent(np.zeros((3, 4)), np.zeros((3, 5))),
            "do not belong together; expected two arrays of one shape (n_axes, n_samples); "
            "found (3, 4) and (3, 5)",
        ),
        (
            lambda: data_loss_percent([[1.0, np.nan]], [[1.0, np.nan]]),
            "data loss of a signal with missing samples; expected finite values; found NaN",
        ),
        (
            lambda: data_loss_percent([[0.0]], [[0.0]]),
            "data loss of a signal that is zero throughout",
        ),
    ],
)
def test_bad_input_is_named(call, line):
    with pytest.raises(RecordingError) as error:
        call()
    assert line in str(error.value)
