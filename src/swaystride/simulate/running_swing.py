"""Swings of a runner's feet, as the flexion of hip and knee of real runners carries them.

The rolling stance is closed form. In swing the ankle follows the way that the mean curves of hip
and knee would take it, bent so that it begins and ends in the states that the stances prescribe.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_motion import FootMotion
from swaystride.simulate.foot_spline import PiecewiseQuintic, joined, least_jerk
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import curves, fourier
from swaystride.simulate.running_pelvis import pelvis_height
from swaystride.simulate.running_steps import RunPath, RunSteps

Array = NDArray[np.float64]

#: Shares of the swing at which the way of the ankle is prescribed.
SWING_KNOTS: Final = (0.12, 0.3, 0.5, 0.7, 0.88)
#: Phase of the toe-off in the mean curves, of runners at 2.5 m/s with a duty factor of 0.36, and how
#: it falls with the duty factor: fitted by eye to the sagittal curves of running_markers_grf at 2.5,
#: 3.5 and 4.5 and of running_full_body_ik at 3.96 m/s; spec §9.1 found 0.33 best at 0.28.
SEED_TOE_OFF: Final = 0.365
SEED_DUTY: Final = 0.36
SEED_SLOPE: Final = 0.45
#: Mean flexion of hip and knee over the range of the curves: 12.1° of 48°, 42.7° of 81° (spec §9.1).
HIP_MEAN: Final = 12.13 / 48.0
KNEE_MEAN: Final = 42.71 / 81.0
#: The sole stays at least this far above the ground in the middle of a swing, m.
LEAST_CLEARANCE_M: Final = 0.015


def phase_pieces(contact_s: ArrayLike, toe_off_s: ArrayLike) -> PiecewiseQuintic:
    """Phase of the strides of one foot: k at contact k, about k + 0.35 at toe-off, smooth between.

    Parameters
    ----------
    contact_s, toe_off_s : array_like, shape (n,)
        First and last touches in turn.

    Returns
    -------
    PiecewiseQuintic
        2 (n − 1) pieces from the first to the last contact.
    """
    contact, toe_off = np.asarray(contact_s), np.asarray(toe_off_s)
    n = len(contact)
    knots = np.stack([contact, toe_off], axis=-1).ravel()[:-1]
    duty = (toe_off - contact)[:-1] / np.diff(contact)
    leaving = SEED_TOE_OFF + SEED_SLOPE * (np.append(duty, duty[-1]) - SEED_DUTY)
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


def seed_angles(
    hip_range_rad: ArrayLike, knee_range_rad: ArrayLike, phase: ArrayLike
) -> tuple[Array, Array]:
    """Flexion of thigh (against the vertical) and knee in the mean curves of real runners.

    Parameters
    ----------
    hip_range_rad, knee_range_rad : array_like
        Ranges of the flexion.
    phase : array_like
        Phase of the stride.

    Returns
    -------
    thigh_rad, knee_rad : ndarray
    """
    shapes = curves()
    phase = np.asarray(phase, dtype=np.float64)
    hip = fourier(shapes["hip_flexion"], phase.ravel())[0].reshape(phase.shape) + HIP_MEAN
    knee = fourier(shapes["knee_flexion"], phase.ravel())[0].reshape(phase.shape) + KNEE_MEAN
    return np.asarray(hip_range_rad) * hip, np.asarray(knee_range_rad) * knee


def seed_way(
    body: RunnerBody, hip_range_rad: ArrayLike, knee_range_rad: ArrayLike, phase: ArrayLike
) -> tuple[Array, Array]:
    """Ankle from the hip, forward and up, for the mean curves of hip and knee.

    Parameters
    ----------
    body : RunnerBody
        Lengths.
    hip_range_rad, knee_range_rad : array_like
        Ranges of the flexion.
    phase : array_like
        Phase of the stride.

    Returns
    -------
    forward_m, up_m : ndarray
    """
    thigh, knee = seed_angles(hip_range_rad, knee_range_rad, phase)
    shank = thigh - knee
    forward = body.thigh_m * np.sin(thigh) + body.shank_m * np.sin(shank)
    return forward, -body.thigh_m * np.cos(thigh) - body.shank_m * np.cos(shank)


@dataclass(frozen=True)
class SwingAims:
    """What the swings of one foot aim at, per stance of that foot.

    Parameters
    ----------
    hip_range_rad, knee_range_rad : ndarray, shape (n,)
        Ranges of flexion.
    noise_m : ndarray, shape (n, 2)
        Scatter of the ankle in the middle of the swing, forward and up.
    """

    hip_range_rad: Array
    knee_range_rad: Array
    noise_m: Array


def swing_aims(steps: RunSteps, side: int, noise_m: Array) -> SwingAims:
    """Aims of the swings of one foot (0 right, 1 left).

    Parameters
    ----------
    steps : RunSteps
        Steps of the run.
    side : int
        0 right, 1 left.
    noise_m : ndarray, shape (n_steps, 2)
        Scatter of the ankle, forward and up.
    """
    own = slice(side, None, 2)
    return SwingAims(
        (steps.gait["hip_seed_range_rad"] * steps.manner["hip_range"])[own],
        (steps.gait["knee_seed_range_rad"] * steps.manner["knee_range"])[own],
        noise_m[own],
    )


def with_seed_swings(
    motion: FootMotion, body: RunnerBody, path: RunPath, pelvis: Array, aims: SwingAims
) -> FootMotion:
    """Foot motion whose swings follow the mean curves of real runners.

    Parameters
    ----------
    motion : FootMotion
        With other swings, whose ends are kept.
    body : RunnerBody
        Lengths of the leg.
    path : RunPath
        Way of the hips.
    pelvis : ndarray, shape (n, 7)
        Height of the hips.
    aims : SwingAims
        What the swings aim at.

    Returns
    -------
    FootMotion
    """
    stances = motion.stances
    off, contact = stances.toe_off_s[:-1], stances.contact_s[1:]
    begin = np.stack([axis(off) for axis in motion.swing])
    end = np.stack([axis(contact) for axis in motion.swing])
    shares = np.array([0.0, *SWING_KNOTS, 1.0])
    times = off[:, None] + shares * (contact - off)[:, None]
    x, y = path.x(times.ravel())[0], path.y(times.ravel())[0]
    heading = path.heading(times.ravel())[0]
    x, y, heading = (a.reshape(times.shape) for a in (x, y, heading))
    hips = pelvis_height(pelvis, times)
    touches = np.concatenate([[off[0] - 0.3], contact])
    phase = phase_pieces(touches, np.append(off, contact[-1] + 0.3))(times.ravel())[0]
    forward, up = seed_way(
        body, aims.hip_range_rad[:-1, None], aims.knee_range_rad[:-1, None], phase.reshape(x.shape)
    )
    cosine, sine = np.cos(heading), np.sin(heading)

    def from_hips(state: Array, knot: int) -> tuple[Array, Array, Array]:
        dx, dy = state[0, 0] - x[:, knot], state[1, 0] - y[:, knot]
        c, s = cosine[:, knot], sine[:, knot]
        return c * dx + s * dy, c * dy - s * dx, state[2, 0] - hips[:, knot]

    first, last = from_hips(begin, 0), from_hips(end, -1)
    # What the seeds miss at both ends is made up for gradually.
    blend = shares**3 * (10.0 - 15.0 * shares + 6.0 * shares**2)

    def bent(seed: Array, axis: int) -> Array:
        start, stop = first[axis] - seed[:, 0], last[axis] - seed[:, -1]
        return seed + start[:, None] * (1.0 - blend) + stop[:, None] * blend

    middle = np.sin(np.pi * shares)
    forward = bent(forward, 0) + aims.noise_m[:-1, :1] * middle
    aside = bent(np.zeros_like(forward), 1)
    up = bent(up, 2) + aims.noise_m[:-1, 1:] * middle + hips
    ground = motion.sole.support_m(motion.pitch(times.ravel())[0]).reshape(times.shape)
    up = np.maximum(up, ground + LEAST_CLEARANCE_M)
    ways = (x + cosine * forward - sine * aside, y + sine * forward + cosine * aside, up)
    coordinates = []
    for axis, way in enumerate(ways):
        states = np.full((*times.shape, 3), np.nan)
        states[:, :, 0] = way
        states[:, 0], states[:, -1] = begin[axis].T, end[axis].T
        coordinates.append(joined(times[:, :-1], least_jerk(times, states)))
    return replace(motion, swing=(coordinates[0], coordinates[1], coordinates[2]))
