"""Sampling: what passes, what folds, what a converter leaves."""

import numpy as np
import pytest
from scipy.signal import firwin, upfirdn

from swaystride.errors import ConfigurationError
from swaystride.simulate.sampling import anti_alias, filter_reach, quantise

RATE = 1000.0


@pytest.mark.parametrize("frequency", [0.1, 2.0, 10.0, 35.0])
def test_anti_alias_filter_passes_sway_without_delay(frequency):
    reach = filter_reach(RATE, 100.0)
    t = (np.arange(2000 + 2 * reach) - reach) / RATE
    out = anti_alias(np.sin(2 * np.pi * frequency * t), rate_hz=RATE, output_rate_hz=100.0)
    expected = np.sin(2 * np.pi * frequency * np.arange(len(out)) / 100.0)
    assert len(out) == 200
    np.testing.assert_allclose(out, expected, atol=2e-3)


@pytest.mark.parametrize("frequency", [70.0, 110.0, 260.0, 499.0])
def test_anti_alias_filter_stops_what_would_fold(frequency):
    t = np.arange(3000) / RATE
    out = anti_alias(np.sin(2 * np.pi * frequency * t), rate_hz=RATE, output_rate_hz=100.0)
    assert np.abs(out).max() < 2e-3


@pytest.mark.parametrize("n", [81, 82, 145, 146, 400, 1001])
@pytest.mark.parametrize("bandwidth_hz", [None, 30.0])
def test_outputs_in_groups_are_those_of_one_long_filter(n, bandwidth_hz):
    signal = np.random.default_rng(n).standard_normal((2, 3, n))
    out = anti_alias(signal, rate_hz=2000.0, output_rate_hz=500.0, bandwidth_hz=bandwidth_hz)
    taps = firwin(81, bandwidth_hz or 250.0, window=("kaiser", 5.65), fs=2000.0)
    filtered = upfirdn(taps, signal, down=4, axis=-1)
    expected = filtered[..., 20 : 20 + (n - 81) // 4 + 1]
    np.testing.assert_allclose(out, expected, rtol=1e-12, atol=1e-13)


def test_rates_without_an_integer_ratio_are_refused():
    with pytest.raises(
        ConfigurationError, match="integer ratio of the rates; found 1000 Hz to 128"
    ):
        anti_alias(np.zeros(5000), rate_hz=1000.0, output_rate_hz=128.0)


def test_equal_rates_only_cut_the_reach():
    signal = np.arange(100.0)
    out = anti_alias(signal, rate_hz=100.0, output_rate_hz=100.0)
    reach = filter_reach(100.0, 100.0)
    assert np.array_equal(out, signal[reach:-reach])


def test_quantised_values_are_steps_within_the_range():
    values = quantise(np.linspace(-3.0, 3.0, 1001), full_scale=2.0, bits=8)
    step = 4.0 / 256
    np.testing.assert_allclose(values / step, np.rint(values / step))
    assert values.min() == -2.0
    assert values.max() == 2.0 - step
    inside = np.abs(np.linspace(-3.0, 3.0, 1001)) < 2.0 - step
    assert np.abs(values - np.linspace(-3.0, 3.0, 1001))[inside].max() <= step / 2 + 1e-12


def test_the_bandwidth_is_where_half_of_the_amplitude_passes():
    time = np.arange(0.0, 3.0, 1 / 4000)
    for frequency, passes in ((100.0, 1.0), (250.0, 0.5), (400.0, 0.0)):
        wave = np.cos(2 * np.pi * frequency * time)
        out = anti_alias(wave, rate_hz=4000.0, output_rate_hz=1000.0, bandwidth_hz=250.0)
        assert np.abs(out).max() == pytest.approx(passes, abs=0.01)
