"""Phase of the strides of a runner: what all curves over a stride are functions of."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_spline import PiecewiseQuintic, least_jerk

Array = NDArray[np.float64]

#: Phase of the toe-off in the mean curves of slow runners, whose duty factor is 0.36, and how it falls
#: with the duty factor: spec §9.1 found 0.33 best at 0.28.
USUAL_TOE_OFF: Final = 0.365
USUAL_DUTY: Final = 0.36
TOE_OFF_SLOPE: Final = 0.45


def phase_pieces(
    contact_s: ArrayLike,
    toe_off_s: ArrayLike,
    *,
    usual_toe_off: ArrayLike = USUAL_TOE_OFF,
    usual_duty: ArrayLike = USUAL_DUTY,
) -> PiecewiseQuintic:
    """Phase of the strides of one foot: k at contact k, about k + 0.35 at toe-off, smooth between.

    Parameters
    ----------
    contact_s, toe_off_s : array_like, shape (n,)
        First and last touches in turn.
    usual_toe_off, usual_duty : array_like, scalar or shape (n,)
        Phase of the toe-off in the curves, and the duty factor of those who ran them.

    Returns
    -------
    PiecewiseQuintic
        2 (n − 1) pieces from the first to the last contact.
    """
    contact, toe_off = np.asarray(contact_s), np.asarray(toe_off_s)
    n = len(contact)
    knots = np.stack([contact, toe_off], axis=-1).ravel()[:-1]
    duty = (toe_off - contact)[:-1] / np.diff(contact)
    unlike = np.append(duty, duty[-1]) - np.asarray(usual_duty)
    leaving = np.asarray(usual_toe_off) + TOE_OFF_SLOPE * unlike
    values = np.stack([np.arange(n), np.arange(n) + leaving], axis=-1).ravel()[:-1]
    slope = np.diff(values) / np.diff(knots)
    rate = np.empty_like(values)
    # The harmonic mean of neighbouring slopes keeps the phase rising; a foot leaves as it stood.
    rate[1:-1] = 2.0 * slope[1:] * slope[:-1] / (slope[1:] + slope[:-1])
    rate[0], rate[-1] = slope[0], slope[-1]
    rate[1::2] = slope[0::2]
    return _through(knots, values, rate)


def step_phase_pieces(contact_s: ArrayLike) -> PiecewiseQuintic:
    """Phase of the strides that grows by a half from step to step.

    Parameters
    ----------
    contact_s : array_like, shape (n,)
        First touches of both feet in turn, the right one first.

    Returns
    -------
    PiecewiseQuintic
        n − 1 pieces from the first to the last contact.
    """
    contact = np.asarray(contact_s, dtype=np.float64)
    slope = 0.5 / np.diff(contact)
    rate = np.empty_like(contact)
    rate[1:-1] = 2.0 * slope[1:] * slope[:-1] / (slope[1:] + slope[:-1])
    rate[0], rate[-1] = slope[0], slope[-1]
    halves = np.asarray(0.5 * np.arange(len(contact)), dtype=np.float64)
    return _through(contact, halves, rate)


def _through(knots: Array, values: Array, rate: Array) -> PiecewiseQuintic:
    """Quintic pieces between knots with these values and rates and no second derivative there."""
    states = np.stack([values, rate, np.zeros_like(values)], axis=-1)
    pairs = np.stack([states[:-1], states[1:]], axis=1)
    both = np.stack([knots[:-1], knots[1:]], axis=1)
    return PiecewiseQuintic(knots[:-1], least_jerk(both, pairs)[:, 0])
