"""From the stances of a foot to its motion: the pieces between touch, flat, heel-off and toe-off."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_motion import FootMotion, arrest, rolling_ankle
from swaystride.simulate.foot_spline import PiecewiseQuintic, joined, least_jerk
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.sole import Sole

Array = NDArray[np.float64]

#: Shares of the swing at which its way and its roll, its heading and its late clearance are prescribed.
MID_SWING: Final = 0.5
HEADING_SWING: Final = 0.6
LATE_SWING: Final = 0.85
_FREE = np.nan


def foot_motion(sole: Sole, stances: FootStances) -> FootMotion:
    """Motion of a foot that stands as described.

    Parameters
    ----------
    sole : Sole
        Its sole.
    stances : FootStances
        Where and how it stands.

    Returns
    -------
    FootMotion
    """
    pitch, roll = _pitch(stances), _roll(stances)
    heading = _heading(stances)
    end, start, excess = _swing_ends(sole, stances, pitch, roll)
    swing = _swing(sole, stances, pitch, end, start)
    return FootMotion(sole, stances, pitch, roll, heading, swing, excess)


def _quiet_states(stances: FootStances) -> tuple[Array, Array, Array]:
    """Pitch states at foot flat and at heel-off, and the coefficients of the piece between.

    The rate is lowest in the middle and twice as large at both ends.
    """
    lasts = stances.heel_off_s - stances.flat_s
    lasts = np.where(np.isfinite(lasts), lasts, 1.0)
    rate = stances.quiet_rate_rad_s
    zero = np.zeros_like(rate)
    bend = 4.0 * rate / lasts
    start = stances.flat_pitch_rad
    pieces = np.stack([start, -2 * rate, bend / 2, -4 * rate / (3 * lasts**2), zero, zero], axis=-1)
    flat = np.stack([start, -2 * rate, bend], axis=-1)
    heel_off = np.stack([start - 4.0 / 3.0 * rate * lasts, -2 * rate, -bend], axis=-1)
    return flat, heel_off, pieces


def _pitch(stances: FootStances) -> PiecewiseQuintic:
    flat, heel_off, quiet = _quiet_states(stances)
    swing_s = stances.contact_s[1:] - stances.toe_off_s[:-1]
    lowest_s = stances.toe_off_s[:-1] + stances.swing_pitch_time[:-1] * swing_s
    knots = np.stack(
        [
            stances.heel_off_s[:-1],
            stances.toe_off_s[:-1],
            lowest_s,
            stances.contact_s[1:],
            stances.flat_s[1:],
        ],
        axis=-1,
    )
    states = np.full((*knots.shape, 3), _FREE)
    states[:, 0] = heel_off[:-1]
    states[:, 1, 0], states[:, 1, 1] = (
        stances.toe_off_pitch_rad[:-1],
        stances.toe_off_rate_rad_s[:-1],
    )
    states[:, 1, 2] = 0.0
    states[:, 2, 0], states[:, 2, 1] = stances.swing_pitch_rad[:-1], 0.0
    # The foot turns back as half a cosine begins.
    turn = stances.contact_pitch_rad[1:] - stances.swing_pitch_rad[:-1]
    states[:, 2, 2] = np.pi**2 / 2.0 * turn / (stances.contact_s[1:] - lowest_s) ** 2
    states[:, 3, 0], states[:, 3, 1] = stances.contact_pitch_rad[1:], stances.contact_rate_rad_s[1:]
    states[:, 4] = flat[1:]
    return _with_quiet(stances, knots, least_jerk(knots, states), quiet)


def _roll(stances: FootStances) -> PiecewiseQuintic:
    off, contact = stances.toe_off_s[:-1], stances.contact_s[1:]
    middle_s = off + MID_SWING * (contact - off)
    knots = np.stack([stances.heel_off_s[:-1], off, middle_s, contact, stances.flat_s[1:]], axis=-1)
    states = np.full((*knots.shape, 3), _FREE)
    values = (
        stances.flat_roll_rad[:-1],
        stances.toe_off_roll_rad[:-1],
        stances.swing_roll_rad[:-1],
        stances.contact_roll_rad[1:],
        stances.flat_roll_rad[1:],
    )
    states[:, :, 0] = np.stack(values, axis=-1)
    states[:, [0, 1, 4], 1] = 0.0
    states[:, [0, 4], 2] = 0.0
    # At contact the foot already rolls as fast as it must on average to be flat in time.
    roll = stances.flat_roll_rad[1:] - stances.contact_roll_rad[1:]
    states[:, 3, 1] = roll / (stances.flat_s[1:] - contact)
    quiet = np.zeros((len(stances), 6))
    quiet[:, 0] = stances.flat_roll_rad
    return _with_quiet(stances, knots, least_jerk(knots, states), quiet)


def _with_quiet(
    stances: FootStances, knots: Array, moving: Array, quiet: Array
) -> PiecewiseQuintic:
    """Join the moving pieces with the quiet ones between foot flat and heel-off."""
    begin = np.where(np.isfinite(stances.flat_s), stances.flat_s, stances.heel_off_s - 1.0)
    return joined(
        np.concatenate([knots[:, :-1].ravel(), begin]),
        np.concatenate([moving.reshape(-1, 6), quiet]),
    )


def _heading(stances: FootStances) -> PiecewiseQuintic:
    off, contact = stances.toe_off_s[:-1], stances.contact_s[1:]
    knots = np.stack([off, off + HEADING_SWING * (contact - off), contact], axis=-1)
    before, after = stances.heading_rad[:-1], stances.heading_rad[1:]
    middle = (before + after) / 2.0 + stances.swing_turn_rad[:-1]
    states = np.zeros((*knots.shape, 3))
    states[:, 1, 1:] = _FREE
    states[:, :, 0] = np.stack([before, middle, after], axis=-1)
    still = np.zeros((len(stances), 6))
    still[:, 0] = stances.heading_rad
    begin = np.where(np.isfinite(stances.contact_s), stances.contact_s, stances.toe_off_s - 1.0)
    return joined(
        np.concatenate([knots[:, :-1].ravel(), begin]),
        np.concatenate([least_jerk(knots, states).reshape(-1, 6), still]),
    )


def _swing_ends(
    sole: Sole, stances: FootStances, pitch: PiecewiseQuintic, roll: PiecewiseQuintic
) -> tuple[Array, Array, Array]:
    """States of the ankle where each swing begins and ends, and the excess velocities at contact.

    Shapes (3, 3, n_swings), the same, (3, n_stances).
    """
    place = np.stack([stances.x_m, stances.y_m])
    off, contact = stances.toe_off_s[:-1], stances.contact_s[1:]
    begin = rolling_ankle(sole, pitch(off), roll(off), stances.heading_rad[:-1], place[:, :-1])
    end = rolling_ankle(sole, pitch(contact), roll(contact), stances.heading_rad[1:], place[:, 1:])
    excess = np.zeros((3, len(stances)))
    excess[0, 1:] = stances.impact_forward_m_s[1:] - end[1, 0]
    excess[2, 1:] = -stances.impact_down_m_s[1:] - end[1, 2]
    end = end + arrest(excess[:, 1:], np.zeros_like(contact), stances.arrest_s[1:])
    return begin, end, excess


def _swing(
    sole: Sole, stances: FootStances, pitch: PiecewiseQuintic, begin: Array, end: Array
) -> tuple[PiecewiseQuintic, PiecewiseQuintic, PiecewiseQuintic]:
    """Coordinates of the ankle in each swing."""
    off, contact = stances.toe_off_s[:-1], stances.contact_s[1:]

    def at(share: ArrayLike) -> Array:
        return np.asarray(off + np.asarray(share) * (contact - off))

    def through(times: list[Array], middle: list[Array], axis: int) -> PiecewiseQuintic:
        knots = np.stack([off, *times, contact], axis=-1)
        states = np.full((*knots.shape, 3), _FREE)
        states[:, 0], states[:, -1] = begin[:, axis].T, end[:, axis].T
        for knot, values in enumerate(middle, start=1):
            states[:, knot, 0] = values
        return joined(knots[:, :-1], least_jerk(knots, states))

    share = stances.forward_share[:-1]
    x, y = (
        through([at(MID_SWING)], [begin[0, axis] + share * (end[0, axis] - begin[0, axis])], axis)
        for axis in range(2)
    )
    times = [at(stances.rise_time[:-1]), at(LATE_SWING)]
    clearances = [stances.rise_clearance_m[:-1], stances.late_clearance_m[:-1]]
    heights = [
        sole.support_m(pitch(time)[0]) + clear
        for time, clear in zip(times, clearances, strict=True)
    ]
    return x, y, through(times, heights, 2)
