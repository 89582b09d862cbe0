"""Delay and assignment: fractions of a sample, exchanged rows, two legs half a stride apart."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from swaystride.errors import RecordingError
from swaystride.signals.synchronisation import match_signals

RATE_HZ = 100.0


def smooth_noise(rng, rows, duration_s=60.0):
    """Functions of time with content up to 5 Hz."""
    knots = np.arange(-20, round(10 * duration_s) + 20) / 10.0
    return CubicSpline(knots, rng.normal(size=(rows, len(knots))), axis=1)


def times(duration_s=60.0):
    return np.arange(round(duration_s * RATE_HZ)) / RATE_HZ


@pytest.mark.parametrize("delay_s", [0.0, 0.1234, -0.4567, 1.0, 0.005])
def test_delay_is_found_within_a_fraction_of_a_sample(delay_s):
    signal, time = smooth_noise(np.random.default_rng(1), 3), times()
    found = match_signals(signal(time - delay_s), signal(time), RATE_HZ, longest_s=1.5)
    assert found.delay_s == pytest.approx(delay_s, abs=0.05 / RATE_HZ)
    assert found.partner.tolist() == [0, 1, 2]
    assert found.correlation.min() > 0.97
    np.testing.assert_array_equal(found.correlation, found.own_correlation)


def test_exchanging_the_sets_turns_delay_and_assignment_round():
    signal, time = smooth_noise(np.random.default_rng(2), 4), times()
    first, second = signal(time - 0.21), signal(time)[[2, 0, 3, 1]]
    there, back = (
        match_signals(*pair, RATE_HZ, longest_s=1.0) for pair in ((first, second), (second, first))
    )
    assert there.delay_s == pytest.approx(-back.delay_s, abs=1e-9)
    np.testing.assert_array_equal(there.partner[back.partner], np.arange(4))
    assert there.partner.tolist() == [1, 3, 0, 2]


@pytest.mark.parametrize("scale", [1.0, 57.3])
def test_sizes_and_offsets_do_not_matter(scale):
    signal, time = smooth_noise(np.random.default_rng(3), 3), times()
    second = signal(time)
    plain = match_signals(second, second, RATE_HZ, longest_s=1.0)
    found = match_signals(scale * second + 4.0, second[::-1] - 2.0, RATE_HZ, longest_s=1.0)
    assert found.delay_s == pytest.approx(plain.delay_s, abs=1e-9)
    assert found.partner.tolist() == [2, 1, 0]


def legs(rng, variability, duration_s=60.0, stride_s=0.7):
    """Two legs half a stride apart as functions of time; size and length of strides vary."""
    number = round(duration_s / stride_s) + 10
    length = stride_s * (1.0 + 0.3 * variability * rng.normal(size=number))
    begin = np.cumsum(length) - 5 * stride_s
    phase = CubicSpline(begin, np.arange(number))
    size = CubicSpline(np.arange(number), 1.0 + variability * rng.normal(size=(2, number)), axis=1)

    def at(time):
        rows = []
        for leg, shift in enumerate((0.0, 0.5)):
            own = phase(time) + shift
            shape = np.exp(3.0 * np.cos(2 * np.pi * own)) / 20.0 + 0.3 * np.cos(4 * np.pi * own)
            rows.append(shape * size(own)[leg])
        return np.array(rows)

    return at


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("swapped", [False, True])
@pytest.mark.parametrize("delay_s", [0.08, -0.3])
def test_legs_that_are_half_a_stride_apart(seed, swapped, delay_s):
    """Swapped legs are found as such, and not as a delay of half a stride; nor whole strides."""
    rng = np.random.default_rng(seed)
    at, time = legs(rng, 0.05), times()
    first = at(time - delay_s) + 0.05 * rng.normal(size=(2, len(time)))
    second = at(time)[::-1] if swapped else at(time)
    found = match_signals(first, second, RATE_HZ, longest_s=2.0)
    assert found.partner.tolist() == ([1, 0] if swapped else [0, 1])
    assert found.delay_s == pytest.approx(delay_s, abs=0.5 / RATE_HZ)
    if swapped:
        assert (found.own_correlation < found.correlation - 0.2).all()


def test_missing_samples_count_for_nothing():
    rng = np.random.default_rng(5)
    signal, time = smooth_noise(rng, 3), times()
    first, second = signal(time - 0.37), signal(time)
    first[1, 1000:2500], second[2, :800] = np.nan, np.nan
    found = match_signals(first, second, RATE_HZ, longest_s=1.0)
    assert found.partner.tolist() == [0, 1, 2]
    assert found.delay_s == pytest.approx(0.37, abs=0.1 / RATE_HZ)
    assert found.correlation.min() > 0.8


@pytest.mark.parametrize("value", [3.0, np.nan])
def test_a_row_that_says_nothing_leaves_the_others_alone(value):
    signal, time = smooth_noise(np.random.default_rng(6), 2), times()
    first, second = signal(time - 0.1), signal(time)
    first[1] = value
    found = match_signals(first, second, RATE_HZ, longest_s=1.0)
    assert found.partner.tolist() == [0, 1]
    assert found.correlation[1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        (((2, 500), (3, 500)), r"two sets of equal size.*found \(2, 500\) and \(3, 500\)"),
        (((2, 402), (2, 402)), "403 samples at least"),
    ],
)
def test_sets_that_cannot_be_matched(shapes, message):
    first, second = (np.zeros(shape) for shape in shapes)
    with pytest.raises(RecordingError, match=message):
        match_signals(first, second, RATE_HZ, longest_s=1.0)
