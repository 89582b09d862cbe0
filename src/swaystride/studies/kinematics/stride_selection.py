"""Strides of a trial: their contacts, and which of them count."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@dataclass(frozen=True)
class StrideRule:
    """Which strides of a foot count (config/studies/kinematics.yaml, ``analysis.measures.strides``).

    Parameters
    ----------
    n_dropped : int
        Strides at the start, in which the filter converges.
    n_used : int or None
        Strides that count after them; None for all.
    time_tolerance : float
        A stride whose duration differs from the median by more than this share is none: a contact
        was missed or invented.
    """

    n_dropped: int
    n_used: int | None
    time_tolerance: float


@dataclass(frozen=True, eq=False)
class FootStrides:
    """Strides of one foot of a trial.

    Parameters
    ----------
    contacts : ndarray of int, shape (n_strides + 1,)
        Samples of initial contact.
    toe_off : ndarray, shape (n_strides,)
        Samples of toe-off, with fractions; NaN where there is none.
    regular : ndarray of bool, shape (n_strides,)
        Strides of usual duration.
    counted : ndarray of bool, shape (n_strides,)
        Strides that count.
    """

    contacts: Index
    toe_off: Array
    regular: NDArray[np.bool_]
    counted: NDArray[np.bool_]

    @property
    def numbers(self) -> Index:
        """Numbers of the strides that count; 1 is the first one of the foot in the recording."""
        return np.flatnonzero(self.counted) + 1

    @property
    def start(self) -> Index:
        """First samples of the strides that count."""
        return self.contacts[:-1][self.counted]

    @property
    def stop(self) -> Index:
        """Samples at which the strides that count end and the next ones begin."""
        return self.contacts[1:][self.counted]


def regular_strides(contacts: ArrayLike, rule: StrideRule) -> NDArray[np.bool_]:
    """Strides of usual duration.

    Parameters
    ----------
    contacts : array_like, shape (n_strides + 1,)
        Initial contacts, rising, in any unit of time.
    rule : StrideRule

    Returns
    -------
    ndarray of bool, shape (n_strides,)

    Examples
    --------
    >>> regular_strides([0, 10, 20, 40, 50], StrideRule(10, 150, 0.25)).tolist()
    [True, True, False, True]
    """
    duration = np.diff(np.asarray(contacts, dtype=np.float64))
    if duration.size == 0:
        return np.zeros(0, dtype=np.bool_)
    usual = np.median(duration)
    return np.asarray(np.abs(duration - usual) <= rule.time_tolerance * usual)


def counted_strides(regular: NDArray[np.bool_], rule: StrideRule) -> NDArray[np.bool_]:
    """Regular strides after the dropped ones, up to the number that is used.

    Strides are numbered as they come, irregular ones included, so that ``n_dropped`` 10 and
    ``n_used`` 150 mean strides 11 to 160.

    Parameters
    ----------
    regular : ndarray of bool, shape (n_strides,)
    rule : StrideRule

    Returns
    -------
    ndarray of bool, shape (n_strides,)

    Examples
    --------
    >>> regular = np.array([True, True, False, True, True])
    >>> counted_strides(regular, StrideRule(1, 3, 0.25)).tolist()
    [False, True, False, True, False]
    >>> counted_strides(regular, StrideRule(1, None, 0.25)).tolist()
    [False, True, False, True, True]
    """
    number = np.arange(1, regular.size + 1)
    counted = regular & (number > rule.n_dropped)
    if rule.n_used is not None:
        counted &= number <= rule.n_dropped + rule.n_used
    return counted
