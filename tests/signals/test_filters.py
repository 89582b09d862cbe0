"""Filters: frequency response in closed form, no lag, no start-up."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.signals.filters import butterworth_lowpass, lowpass_without_lag

RATE_HZ = 100.0
TIME_S = np.arange(6000) / RATE_HZ
CHOICES = {"cutoff_hz": 2.0, "rate_hz": RATE_HZ, "order": 2, "pad_s": 3.0}


def gain(frequency_hz, direction):
    wave = np.sin(2 * np.pi * frequency_hz * TIME_S)
    out = butterworth_lowpass(wave, direction=direction, **CHOICES)[2000:4000]
    return np.sqrt(2) * out.std()


@pytest.mark.parametrize("frequency_hz", [0.5, 1.0, 2.0, 4.0])
def test_gain_is_that_of_a_butterworth_filter(frequency_hz):
    """|H|² = 1 / (1 + (tan(πf/fs)/tan(πfc/fs))⁴), squared for two passes."""
    ratio = np.tan(np.pi * frequency_hz / RATE_HZ) / np.tan(np.pi * 2.0 / RATE_HZ)
    one_pass = 1 / np.sqrt(1 + ratio**4)
    assert gain(frequency_hz, "causal") == pytest.approx(one_pass, rel=2e-3)
    assert gain(frequency_hz, "zero_lag") == pytest.approx(one_pass**2, rel=2e-3)


def test_zero_lag_keeps_a_symmetric_pulse_symmetric():
    pulse = np.exp(-((TIME_S - TIME_S.mean()) ** 2))
    out = butterworth_lowpass(pulse, direction="zero_lag", **CHOICES)
    np.testing.assert_allclose(out, out[::-1], atol=1e-9)


def test_a_causal_filter_starts_in_steady_state():
    out = butterworth_lowpass(np.full(300, 5.0), direction="causal", **CHOICES)
    np.testing.assert_allclose(out, 5.0, rtol=1e-12)


@pytest.mark.parametrize("direction", ["zero_lag", "causal"])
def test_channels_are_filtered_independently(direction):
    signal = np.random.default_rng(3).normal(size=(2, 3, 500))
    together = butterworth_lowpass(signal, direction=direction, **CHOICES)
    alone = butterworth_lowpass(signal[1, 2], direction=direction, **CHOICES)
    np.testing.assert_allclose(together[1, 2], alone, rtol=1e-12)


def test_a_recording_shorter_than_the_padding_is_filtered():
    assert butterworth_lowpass(np.ones(20), direction="zero_lag", **CHOICES).shape == (20,)


def test_impossible_requests_are_refused():
    with pytest.raises(RecordingError, match=r"0 < cutoff_hz < 50; found 60"):
        butterworth_lowpass(np.ones(9), direction="causal", **{**CHOICES, "cutoff_hz": 60.0})
    with pytest.raises(RecordingError, match="missing samples"):
        butterworth_lowpass([1.0, np.nan, 1.0], direction="causal", **CHOICES)


def test_the_usual_filter_is_the_one_of_second_order_padded_by_three_periods():
    wave = np.sin(2 * np.pi * TIME_S) + TIME_S
    spelled = butterworth_lowpass(wave, direction="zero_lag", **{**CHOICES, "pad_s": 1.5})
    np.testing.assert_array_equal(lowpass_without_lag(wave, 2.0, RATE_HZ), spelled)
