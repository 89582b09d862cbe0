"""Rate and index from time stamps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.io.time_stamps import index_from_time_stamps


@given(
    rate=st.sampled_from([40.0, 60.0, 100.0, 128.0, 1000 / 3, 1024.0]),
    steps=st.lists(st.integers(1, 60), min_size=5, max_size=50),
    origin=st.sampled_from([0.0, 1.55e9]),
)
def test_gaps_are_placed_although_stamps_are_rounded_to_microseconds(
    rate: float, steps: list[int], origin: float
) -> None:
    steps = [1] * (len(steps) + 1) + steps  # most packets arrive
    index = np.concatenate([[0], np.cumsum(steps)])
    stamped = index_from_time_stamps(np.round(origin + index / rate, 6))
    assert stamped.bad_rows == ()
    np.testing.assert_array_equal(stamped.index, index)
    assert stamped.rate_hz == pytest.approx(rate, rel=2e-6 * rate / index[-1])


def test_rounding_does_not_accumulate_over_a_day() -> None:
    # 1/128 s is 7812.5 µs: the median step is off by half a microsecond.
    index = np.delete(np.arange(128 * 3600 * 24), slice(1000, 3000))
    stamped = index_from_time_stamps(np.floor(index / 128 * 1e6) * 1e-6)
    np.testing.assert_array_equal(stamped.index, index)
    assert stamped.worst_jitter < 1e-3


def test_jitter_is_measured() -> None:
    time = np.arange(100) / 100.0
    time[50] += 0.0025
    stamped = index_from_time_stamps(time)
    assert stamped.worst_jitter == pytest.approx(0.25)
    np.testing.assert_array_equal(stamped.index, np.arange(100))


@pytest.mark.parametrize(
    ("time", "bad_rows"),
    [([0.0, 0.01, 0.01, 0.02], (2,)), ([0.0, 0.01, 0.005, 0.02], (2,)), ([0.0, 0.0], (1,))],
)
def test_stamps_that_do_not_advance(time: list[float], bad_rows: tuple[int, ...]) -> None:
    assert index_from_time_stamps(time).bad_rows == bad_rows


@pytest.mark.parametrize("time", [[], [1.0], [0.0, np.nan]])
def test_too_little_to_measure_a_rate(time: list[float]) -> None:
    with pytest.raises(ValueError, match="at least two finite time stamps"):
        index_from_time_stamps(time)
