"""Packet counters: from wrapped counter to sample index, with the wrap-around detected.

A wireless sensor numbers its packets with a counter of few bits. Packets that were lost show as
steps larger than one; the wrap-around shows as a step backwards. Nothing about the width of the
counter is assumed: the smallest power of two above the largest counter is the only modulus for
which a step backwards can be a loss of less than half a turn, and it is accepted only on evidence.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

#: Width of the counter of Xsens MTw and MTi devices; a loss at the wrap itself is accepted for it.
SIXTEEN_BIT = 2**16

ProblemKind = Literal["duplicate", "backward", "jump"]


@dataclass(frozen=True)
class CounterProblem:
    """A step that no loss of packets explains.

    Parameters
    ----------
    kind : {"duplicate", "backward", "jump"}
        The same counter again; a step back that is not a wrap-around; a step forward by more than
        half a turn, which is a packet out of order or a loss that cannot be counted.
    row : int
        0-based row of the second of the two packets.
    previous, value : int
        The two counters.
    """

    kind: ProblemKind
    row: int
    previous: int
    value: int


@dataclass(frozen=True)
class UnwrappedCounter:
    """What a packet counter says about the time axis.

    Parameters
    ----------
    index : ndarray of int64, shape (n_rows,)
        Sample index of each row, counted from the first packet. Trust it only without problems.
    modulus : int or None
        The modulus at which the counter wrapped, or None if it never did.
    problems : tuple of CounterProblem
        In the order of the rows.
    """

    index: NDArray[np.int64]
    modulus: int | None
    problems: tuple[CounterProblem, ...]


def unwrap_packet_counter(counter: ArrayLike, *, modulus: int | None = None) -> UnwrappedCounter:
    """Turn a packet counter into sample indices.

    Parameters
    ----------
    counter : array_like of int, shape (n_rows,)
        Counters in the order of the file, not negative.
    modulus : int, optional
        The modulus, if it is known. Without it, a step backwards is taken for a wrap-around at the
        smallest power of two M above the largest counter, if it then is a loss of less than M/2
        packets, and if M is 65536 or some step goes from M - 1 to 0 exactly.

    Returns
    -------
    UnwrappedCounter
        Every pattern of loss shorter than half the modulus is recovered exactly.

    Examples
    --------
    >>> unwrapped = unwrap_packet_counter([65533, 65534, 1, 2])
    >>> unwrapped.index, unwrapped.modulus
    (array([0, 1, 4, 5]), 65536)
    >>> unwrap_packet_counter([10, 11, 11]).problems
    (CounterProblem(kind='duplicate', row=2, previous=11, value=11),)
    """
    values = np.asarray(counter, dtype=np.int64)
    if values.size == 0:
        return UnwrappedCounter(np.zeros(0, dtype=np.int64), None, ())
    steps = np.diff(values)
    candidate = modulus or _smallest_power_of_two_above(int(values.max()))
    is_wrap = (steps < 0) & (steps + candidate <= candidate // 2)
    if modulus is None and not _has_evidence(values, is_wrap, candidate):
        is_wrap = np.zeros_like(is_wrap)
    half_turn = candidate // 2 if modulus or is_wrap.any() else max(candidate, SIXTEEN_BIT) // 2
    problems = tuple(
        CounterProblem(_kind_of(int(steps[i])), int(i) + 1, int(values[i]), int(values[i + 1]))
        for i in np.flatnonzero(((steps <= 0) & ~is_wrap) | (steps > half_turn))
    )
    index = np.concatenate([[0], np.cumsum(steps + candidate * is_wrap)])
    return UnwrappedCounter(index, candidate if is_wrap.any() else None, problems)


def lost_between(index: NDArray[np.int64]) -> NDArray[np.int64]:
    """Count the samples that are missing between consecutive rows; a repeated row hides none.

    Parameters
    ----------
    index : ndarray of int
        Sample index of every row.

    Examples
    --------
    >>> lost_between(np.array([0, 1, 4, 4, 5]))
    array([0, 2, 0, 0])
    """
    lost: NDArray[np.int64] = np.maximum(np.diff(index) - 1, 0)
    return lost


def _smallest_power_of_two_above(value: int) -> int:
    return 1 << max(value, 1).bit_length()


def _has_evidence(values: NDArray[np.int64], is_wrap: NDArray[np.bool_], candidate: int) -> bool:
    """16 bit is what the devices have; any other width must show a step from M - 1 to 0."""
    if candidate == SIXTEEN_BIT:
        return True
    exact = (values[:-1] == candidate - 1) & (values[1:] == 0)
    return bool((exact & is_wrap).any())


def _kind_of(step: int) -> ProblemKind:
    if step == 0:
        return "duplicate"
    return "backward" if step < 0 else "jump"
