"""Lower rates: kept samples, aliasing, the filter against its formula and against SciPy."""

import numpy as np
import pytest
import scipy.signal
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.signals.resampling import DecimationFilter, decimate, keep_every, whole_factor

LOWPASS = DecimationFilter(order=8, ripple_db=0.05, edge=0.8)


def tone(frequency_hz, *, rate_hz=1000.0, n=8000):
    return np.sin(2 * np.pi * frequency_hz * np.arange(n) / rate_hz)


def middle(values):
    """The part that the ends of the filter do not reach."""
    n = values.shape[-1]
    return values[..., n // 4 : -n // 4]


@given(st.integers(1, 20), st.integers(1, 200))
def test_kept_samples_are_the_multiples_of_the_factor(factor, n):
    kept = keep_every(np.arange(float(n)), factor)
    assert kept.tolist() == [float(k) for k in range(0, n, factor)]


@given(st.integers(1, 6), st.integers(1, 6))
def test_leaving_out_in_two_steps_is_one(first, second):
    values = np.arange(300.0).reshape(3, 100)
    twice = keep_every(keep_every(values, first), second)
    np.testing.assert_array_equal(twice, keep_every(values, first * second))


def test_without_a_filter_a_high_tone_folds_back():
    """90 Hz at 100 Hz looks like −10 Hz."""
    kept = keep_every(tone(90.0), 10)
    np.testing.assert_allclose(kept, tone(-10.0, rate_hz=100.0, n=800), atol=1e-9)


@pytest.mark.parametrize("factor", [2, 4, 8, 16])
def test_decimation_agrees_with_scipy(factor):
    signal = np.random.default_rng(factor).normal(size=(3, 4001))
    theirs = scipy.signal.decimate(signal, factor, n=8, ftype="iir", axis=-1, zero_phase=True)
    np.testing.assert_allclose(decimate(signal, factor, lowpass=LOWPASS), theirs, atol=1e-12)


@pytest.mark.parametrize("factor", [2, 4, 8, 16])
@pytest.mark.parametrize("share", [0.25, 0.75, 1.0, 1.5])
def test_the_gain_is_that_of_the_chebyshev_formula_twice(factor, share):
    """1/(1 + ε² T₈²(tan(ω/2)/tan(ω_edge/2))) is the gain of forward and backward together."""
    edge_hz = 0.8 * 500.0 / factor
    frequency_hz = share * edge_hz
    epsilon2 = 10 ** (LOWPASS.ripple_db / 10) - 1
    warped = np.tan(np.pi * frequency_hz / 1000) / np.tan(np.pi * edge_hz / 1000)
    polynomial = np.polynomial.chebyshev.chebval(warped, [0] * 8 + [1])
    gain = 1 / (1 + epsilon2 * polynomial**2)
    n = 16000
    found = middle(decimate(tone(frequency_hz, n=n), factor, lowpass=LOWPASS))
    expected = middle(gain * keep_every(tone(frequency_hz, n=n), factor))
    np.testing.assert_allclose(found, expected, atol=2e-5)


def test_the_phase_is_zero_and_kept_samples_start_at_the_first():
    """A slow tone passes where it was, within the ripple of 0.1 dB."""
    slow = tone(3.0)
    found = decimate(slow, 16, lowpass=LOWPASS)
    assert found.size == 500
    np.testing.assert_allclose(middle(found), middle(keep_every(slow, 16)), atol=0.012)


@given(st.floats(-100, 100), st.floats(-100, 100), st.integers(1, 16))
def test_decimation_is_linear_and_keeps_constants_within_the_ripple(a, b, factor):
    """An even order has its passband minimum at zero frequency: −0.05 dB, twice."""
    one, other = np.random.default_rng(1).normal(size=(2, 400))
    left = decimate(a * one + b * other, factor, lowpass=LOWPASS)
    right = a * decimate(one, factor, lowpass=LOWPASS) + b * decimate(
        other, factor, lowpass=LOWPASS
    )
    np.testing.assert_allclose(left, right, atol=1e-9 * (1 + abs(a) + abs(b)))
    level = decimate(np.full(400, a), factor, lowpass=LOWPASS)
    dc_gain = 1.0 if factor == 1 else 10 ** (-LOWPASS.ripple_db / 10)
    np.testing.assert_allclose(level, dc_gain * a, atol=1e-6 * (1 + abs(a)))


@given(st.floats(40, 2000), st.integers(1, 20), st.floats(-0.009, 0.009))
def test_a_measured_rate_is_divided_by_a_whole_number(target_hz, factor, off):
    assert whole_factor(target_hz * factor * (1 + off), target_hz) == factor


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (
            lambda: whole_factor(1024.0, 62.5),
            "the sampling rate is no whole multiple of the one wanted; "
            "expected a multiple of 62.5 Hz; found 1024 Hz",
        ),
        (lambda: whole_factor(100.0, 1000.0), "expected a multiple of 1000 Hz; found 100 Hz"),
        (lambda: keep_every([1.0], 0), "factor of a lower rate; expected 1 or more; found 0"),
        (
            lambda: decimate(np.ones(99), 2, lowpass=DecimationFilter(8, 0.05, 1.0)),
            "edge of the decimation filter; expected a share of the new Nyquist frequency",
        ),
        (
            lambda: decimate([np.nan] * 99, 2, lowpass=LOWPASS),
            "cannot filter across missing samples; expected finite values; found NaN",
        ),
        (
            lambda: decimate(np.ones(27), 2, lowpass=LOWPASS),
            "too short for the decimation filter; expected more than 27 samples; found 27",
        ),
    ],
)
def test_bad_input_is_named(call, line):
    with pytest.raises(RecordingError) as error:
        call()
    assert line in str(error.value)
