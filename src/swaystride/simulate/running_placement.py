"""Where a runner puts the feet and how high the hips are, so that the legs move as real ones do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.running_aims import aim_angles, aim_phase
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import NO_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_pelvis import pelvis_height, pelvis_steps
from swaystride.simulate.running_stances import run_stances
from swaystride.simulate.running_steps import LEAD_STRIDES, run_path, run_steps

Array = NDArray[np.float64]

#: A leg is never longer than this share of thigh and shank (spec §9.1, step 4): the knee stays flexed
#: by 11°, and does not snap when a foot lands.
LONGEST_LEG: Final = 0.995
#: Share that the usual stride aims at, so that most strides keep clear of the limit [N].
USUAL_LONGEST_LEG: Final = 0.9945
#: The same at first and last touch: just before and after them the leg is longer still.
FIRST_LONGEST_LEG: Final = 0.985
LAST_LONGEST_LEG: Final = 0.972


@dataclass(frozen=True)
class Placement:
    """Placement at some speeds, linear between them.

    Parameters
    ----------
    speed_m_s, ahead_m, hip_height_m : ndarray, shape (n,)
        How far the ankle of the level foot is ahead of the hips in the middle of the stance, and
        the mean height of the hips.
    """

    speed_m_s: Array
    ahead_m: Array
    hip_height_m: Array

    def at(self, speed_m_s: ArrayLike) -> tuple[Array, Array]:
        """Distance ahead and height of the hips at any speeds."""
        speed = np.asarray(speed_m_s)
        return (
            np.asarray(np.interp(speed, self.speed_m_s, self.ahead_m)),
            np.asarray(np.interp(speed, self.speed_m_s, self.hip_height_m)),
        )


def placement(
    body: RunnerBody, manner: RunnerManner, stride_time_scale: float, speed_m_s: ArrayLike
) -> Placement:
    """Placement whose stances come closest to the mean curves of real runners.

    The rolling ankle passes the hips in a given way; how far ahead it is and how high the hips are
    is chosen by least squares of hip and knee, among those for which no leg is too long.

    Parameters
    ----------
    body : RunnerBody
        Of the runner.
    manner : RunnerManner
        Of the runner.
    stride_time_scale : float
        Factor on stride times.
    speed_m_s : array_like, shape (n,)
        Rising speeds.

    Returns
    -------
    Placement
    """
    speeds = np.atleast_1d(np.asarray(speed_m_s, dtype=np.float64))
    both = np.array([_at_speed(body, manner, stride_time_scale, float(v)) for v in speeds])
    return Placement(speeds, both[:, 0], both[:, 1])


def _at_speed(
    body: RunnerBody, manner: RunnerManner, stride_time_scale: float, speed_m_s: float
) -> tuple[float, float]:
    """Distance ahead and hip height of one steady stride."""
    rng = np.random.default_rng(0)
    profile = steady_run(1.0, speed_m_s)
    steps = run_steps(
        manner,
        profile,
        duration_s=1.0,
        stride_time_scale=stride_time_scale,
        variability=NO_VARIABILITY,
        rng=rng,
    )
    path = run_path(profile, steps.contact_s[0] - 1.0, steps.toe_off_s[-1] + 1.0)
    right, _ = run_stances(steps, path, np.zeros(len(steps)), variability=NO_VARIABILITY, rng=rng)
    step = 2 * LEAD_STRIDES
    own = step // 2
    # First touch and, for the fit, what follows the arrest, in which the shoe gives way.
    rolling = np.linspace(right.contact_s[own] + right.arrest_s[own], right.toe_off_s[own], 40)
    time = np.concatenate([right.contact_s[[own]], rolling[:-1]])
    ankle = foot_motion(body.sole, right).pose(time).ankle_m[0]
    bobbing = pelvis_height(
        pelvis_steps(steps.contact_s, steps.toe_off_s, np.zeros(len(steps))), time
    )
    phase = aim_phase(steps.contact_s[::2], steps.toe_off_s[::2], speed_m_s)(time)[0]
    ranges = [
        (steps.gait[f"{joint}_aim_range_rad"] * steps.manner[f"{joint}_range"])[step]
        for joint in ("hip", "knee")
    ]
    way = (ankle[0] - path.x(time)[0], ankle[1], ankle[2] - bobbing)
    ahead, height = _closest(body, way, *aim_angles(ranges[0], ranges[1], phase, speed_m_s))
    return ahead + manner.foot_ahead_m, height - manner.crouch_m


def _closest(
    body: RunnerBody, way: tuple[Array, Array, Array], hip: Array, knee: Array
) -> tuple[float, float]:
    """Distance ahead and hip height for which hip and knee move most as wanted.

    All distances and heights of a fine grid are tried. The knee counts with its angle, the hip
    with its movement only, because its zero depends on the pelvis.
    """
    x, y, z = way
    aside = body.hip_distance_m / 2.0 + y
    ahead = np.arange(-0.1, 0.3, 0.004)[:, None, None]
    height = body.leg_m * np.arange(0.9, 1.12, 0.003)[:, None]
    forward, down = x + ahead, z - height
    square = forward**2 + down**2 + aside**2
    cosine = (square - body.thigh_m**2 - body.shank_m**2) / (2.0 * body.thigh_m * body.shank_m)
    flexed = np.arccos(np.clip(cosine, -1.0, 1.0))
    # Between the thigh and the line from hip to ankle.
    inner = np.arctan2(body.shank_m * np.sin(flexed), body.thigh_m + body.shank_m * np.cos(flexed))
    thigh = np.arctan2(forward, -down) + inner
    turned = thigh - hip
    miss = np.mean(((flexed - knee) ** 2)[..., 1:], axis=-1) + np.var(turned[..., 1:], axis=-1)
    reach = np.sqrt(square) / body.leg_m
    too_far = (reach > USUAL_LONGEST_LEG).any(axis=-1)
    too_far |= (reach[..., 0] > FIRST_LONGEST_LEG) | (reach[..., -1] > LAST_LONGEST_LEG)
    miss = np.where(too_far, np.inf, miss)
    i, j = np.unravel_index(np.argmin(miss), miss.shape)
    return float(ahead[i, 0, 0]), float(height[j, 0])
