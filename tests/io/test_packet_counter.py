"""Every loss shorter than half a turn is recovered; nothing else passes for a wrap-around."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.io.packet_counter import (
    CounterProblem,
    UnwrappedCounter,
    lost_between,
    unwrap_packet_counter,
)

HALF_TURN = 2**15
# A step of s packets has lost s - 1; long and short steps are equally likely to be drawn.
STEPS = st.lists(st.one_of(st.integers(1, 4), st.integers(1, HALF_TURN)), min_size=1, max_size=40)


@given(start=st.integers(0, 2**16 - 1), steps=STEPS)
def test_any_loss_shorter_than_half_the_modulus_is_recovered(start: int, steps: list[int]) -> None:
    index = np.concatenate([[0], np.cumsum(steps)])
    unwrapped = unwrap_packet_counter((start + index) % 2**16)
    assert unwrapped.problems == ()
    np.testing.assert_array_equal(unwrapped.index, index)
    wraps = bool(np.any(np.diff((start + index) // 2**16)))
    assert unwrapped.modulus == (2**16 if wraps else None)


@given(data=st.data(), bits=st.integers(3, 32))
def test_any_loss_is_recovered_for_a_known_modulus(data: st.DataObject, bits: int) -> None:
    modulus = 2**bits
    start = data.draw(st.integers(0, modulus - 1))
    steps = data.draw(st.lists(st.integers(1, modulus // 2), min_size=1, max_size=20))
    index = np.concatenate([[0], np.cumsum(steps)])
    unwrapped = unwrap_packet_counter((start + index) % modulus, modulus=modulus)
    assert unwrapped.problems == ()
    np.testing.assert_array_equal(unwrapped.index, index)


@pytest.mark.parametrize("bits", [4, 8, 12, 16, 20, 32])
def test_the_width_is_detected_when_the_wrap_itself_is_seen(bits: int) -> None:
    index = np.delete(np.arange(30), [4, 5, 17])
    unwrapped = unwrap_packet_counter((2**bits - 10 + index) % 2**bits)
    assert unwrapped.modulus == 2**bits
    assert unwrapped.problems == ()
    np.testing.assert_array_equal(unwrapped.index, index)


def test_several_wraps() -> None:
    index = np.arange(200_000)
    unwrapped = unwrap_packet_counter((60_000 + index) % 2**16)
    np.testing.assert_array_equal(unwrapped.index, index)


def test_two_recordings_in_one_file_are_not_a_wrap() -> None:
    # 61 -> 5 would be a wrap of a 6-bit counter with a loss of 7; nothing else speaks for 6 bits.
    assert unwrap_packet_counter([60, 61, 5, 6]).problems == (CounterProblem("backward", 2, 61, 5),)


@pytest.mark.parametrize(
    ("counter", "problems"),
    [
        ([10, 11, 11, 12], (CounterProblem("duplicate", 2, 11, 11),)),
        ([10, 12, 11, 13], (CounterProblem("backward", 2, 12, 11),)),
        ([65535, 0, 65534, 1], (CounterProblem("jump", 2, 0, 65534),)),
        ([5, 40_000], (CounterProblem("jump", 1, 5, 40_000),)),
    ],
)
def test_problems_name_their_row(counter: list[int], problems: tuple[CounterProblem, ...]) -> None:
    assert unwrap_packet_counter(counter).problems == problems


def test_no_row_and_one_row() -> None:
    empty = unwrap_packet_counter([])
    assert (empty.index.size, empty.modulus, empty.problems) == (0, None, ())
    single = unwrap_packet_counter([65535])
    assert isinstance(single, UnwrappedCounter)
    assert single.index.tolist() == [0]


@settings(max_examples=50)
@given(st.sets(st.integers(1, 500)))
def test_lost_between_counts_what_is_not_there(lost: set[int]) -> None:
    index = np.array([i for i in range(502) if i not in lost])
    assert lost_between(index).sum() == len(lost)
