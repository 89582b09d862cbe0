"""Swings of a runner's feet, as the flexion of hip and knee of real runners carries them.

The rolling stance is closed form. In swing the ankle follows the way that the mean curves of hip
and knee would take it, bent so that it begins and ends in the states that the stances prescribe.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate.foot_motion import FootMotion
from swaystride.simulate.foot_spline import joined, least_jerk
from swaystride.simulate.running_aims import aim_phase, aim_way
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_pelvis import pelvis_height
from swaystride.simulate.running_steps import RunPath, RunSteps

Array = NDArray[np.float64]

#: Shares of the swing at which the way of the ankle is prescribed.
SWING_KNOTS: Final = (0.12, 0.3, 0.5, 0.7, 0.88)
#: Share of the swing in which the way at toe-off is forgotten, and the way at first touch prepared;
#: chosen on the curves of running_markers_grf.
SETTLING_SHARE: Final = 0.7
#: The sole stays at least this far above the ground in the middle of a swing, m.
LEAST_CLEARANCE_M: Final = 0.015


@dataclass(frozen=True)
class SwingAims:
    """What the swings of one foot aim at, per stance of that foot.

    Parameters
    ----------
    speed_m_s : ndarray, shape (n,)
        Speed.
    hip_range_rad, knee_range_rad : ndarray, shape (n,)
        Ranges of flexion.
    noise_m : ndarray, shape (n, 2)
        Scatter of the ankle in the middle of the swing, forward and up.
    """

    speed_m_s: Array
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
        steps.speed_m_s[own],
        (steps.gait["hip_aim_range_rad"] * steps.manner["hip_range"])[own],
        (steps.gait["knee_aim_range_rad"] * steps.manner["knee_range"])[own],
        noise_m[own],
    )


def with_aimed_swings(
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
    phase = aim_phase(touches, np.append(off, contact[-1] + 0.3), aims.speed_m_s)
    forward, up = aim_way(
        body,
        aims.hip_range_rad[:-1, None],
        aims.knee_range_rad[:-1, None],
        phase(times.ravel())[0].reshape(x.shape),
        aims.speed_m_s[:-1, None],
    )
    cosine, sine = np.cos(heading), np.sin(heading)

    def from_hips(state: Array, knot: int) -> tuple[Array, Array, Array]:
        dx, dy = state[0, 0] - x[:, knot], state[1, 0] - y[:, knot]
        c, s = cosine[:, knot], sine[:, knot]
        return c * dx + s * dy, c * dy - s * dx, state[2, 0] - hips[:, knot]

    first, last = from_hips(begin, 0), from_hips(end, -1)
    # What the aims miss at both ends is made up for gradually.
    left = 1.0 - _smooth_step(shares / SETTLING_SHARE)
    near = _smooth_step(1.0 - (1.0 - shares) / SETTLING_SHARE)

    def bent(aim: Array, axis: int) -> Array:
        start, stop = first[axis] - aim[:, 0], last[axis] - aim[:, -1]
        return aim + start[:, None] * left + stop[:, None] * near

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


def _smooth_step(share: Array) -> Array:
    """From 0 to 1 with least jerk."""
    x = np.clip(share, 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x**2))
