"""A run, overground or on a treadmill: from a runner and a profile to the motion of the body."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, maximum_filter1d

from swaystride.simulate._running_points import longest_falls
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_spline import PiecewiseQuintic, least_jerk
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import RunnerManner, RunProfile, RunVariability
from swaystride.simulate.running_motion import RunningMotion, assembled
from swaystride.simulate.running_pelvis import pelvis_steps
from swaystride.simulate.running_phases import phase_tables
from swaystride.simulate.running_placement import LONGEST_LEG, placement
from swaystride.simulate.running_stances import run_stances
from swaystride.simulate.running_steps import RunSteps, correlated, run_path, run_steps
from swaystride.simulate.running_swing import swing_aims, with_aimed_swings

Array = NDArray[np.float64]

#: Stature to which the stride times of the anchors belong, m (spec §12).
REFERENCE_HEIGHT_M = 1.72


@dataclass(frozen=True)
class Treadmill:
    """Belt that is slowed by every stance.

    Parameters
    ----------
    dip : float
        Share by which the belt is slower in the middle of a stance.
    """

    dip: float


def run_motion(
    body: RunnerBody,
    manner: RunnerManner,
    profile: RunProfile,
    *,
    duration_s: float,
    variability: RunVariability,
    rng: np.random.Generator,
    treadmill: Treadmill | None = None,
) -> RunningMotion:
    """Motion of a runner who is already running when the recording begins and still when it ends.

    Parameters
    ----------
    body : RunnerBody
        Lengths.
    manner : RunnerManner
        How the person runs.
    profile : RunProfile
        Speed and changes over the run.
    duration_s : float
        Length of the recording.
    variability : RunVariability
        Scatter from stride to stride.
    rng : numpy.random.Generator
        Source of the scatter.
    treadmill : Treadmill, optional
        Run on a belt, whose mean speed is that of the profile; the world is then the frame of the
        belt.

    Returns
    -------
    RunningMotion
    """
    scale = float(np.sqrt(body.height_m / REFERENCE_HEIGHT_M))
    steps = run_steps(
        manner,
        profile,
        duration_s=duration_s,
        stride_time_scale=scale,
        variability=variability,
        rng=rng,
    )
    path = run_path(profile, steps.contact_s[0] - 1.0, steps.toe_off_s[-1] + 1.0)
    low, high = profile.speed_m_s.min(), profile.speed_m_s.max()
    speeds = np.linspace(low, high, 1 if low == high else 5)
    ahead, height = placement(body, manner, scale, speeds).at(steps.speed_m_s)
    ahead = ahead + steps.manner["foot_ahead_m"] - manner.foot_ahead_m
    height = height - steps.manner["crouch_m"] + manner.crouch_m
    pelvis = pelvis_steps(steps.contact_s, steps.toe_off_s, height)
    stances = run_stances(steps, path, ahead, variability=variability, rng=rng)
    noise_m = variability.clearance_sd_m * correlated(rng, len(steps), variability.memory, (2,))
    feet = [
        with_aimed_swings(
            foot_motion(body.sole, stances[side]),
            body,
            path,
            pelvis,
            swing_aims(steps, side, noise_m),
        )
        for side in range(2)
    ]
    strength = impact_strength(steps, (stances[0].impact_down_m_s, stances[1].impact_down_m_s))
    right, left, both = (
        phase_tables(steps, side, strength, variability=variability, rng=rng) for side in range(3)
    )
    belt = None if treadmill is None else _belt(treadmill, steps, profile)
    motion = assembled(
        body,
        duration_s=duration_s,
        feet=(feet[0], feet[1]),
        path=path,
        pelvis=pelvis,
        phases=(right, left, both),
        belt=belt,
        belt_speed_m_s=0.0 if treadmill is None else float(profile.speed_m_s.mean()),
    )
    # Single steps that reach too far are run lower, with their neighbours; the rest stays as it is.
    drop = np.maximum(_falls(motion, LONGEST_LEG), 0.0)
    drop = gaussian_filter1d(maximum_filter1d(drop, 9), 4.0 / 3.0, truncate=3.0)
    lower = pelvis_steps(steps.contact_s, steps.toe_off_s, height - np.append(drop, drop[-1]))
    motion = replace(motion, tables=motion.tables._replace(steps=np.ascontiguousarray(lower)))
    return within_reach(motion, LONGEST_LEG)


def _falls(motion: RunningMotion, longest: float) -> Array:
    """How much too high the hips are in each step; between two instants a leg gains 0.5 mm."""
    limit = longest * motion.body.leg_m
    return np.asarray(longest_falls(motion.tables, motion.duration_s, 0.008, limit) + 5e-4)


def impact_strength(steps: RunSteps, down_m_s: tuple[Array, Array]) -> Array:
    """Size of each impact for pelvis (m/s²), head (m/s²) and soft tissue (m/s).

    Parameters
    ----------
    steps : RunSteps
        Steps of the run.
    down_m_s : tuple of ndarray
        Downward velocity at every first touch of the right and of the left foot.

    Returns
    -------
    ndarray, shape (n_steps, 3)
    """
    down = np.empty(len(steps))
    down[0::2], down[1::2] = down_m_s
    gait, manner = steps.gait, steps.manner
    return np.stack(
        [
            gait["pelvis_transient"] * manner["pelvis_transient"] * down,
            gait["head_transient"] * manner["head_transient"] * down,
            manner["soft_tissue"] * down,
        ],
        axis=-1,
    )


def within_reach(motion: RunningMotion, longest: float) -> RunningMotion:
    """Same motion with the pelvis lowered until no leg is longer than a share of its links.

    Parameters
    ----------
    motion : RunningMotion
        Legs that do not reach are NaN in it.
    longest : float
        Largest distance from hip to ankle, over thigh and shank.

    Returns
    -------
    RunningMotion
    """
    fall = float(_falls(motion, longest).max())
    if fall <= 0.0:
        return motion
    steps = motion.tables.steps.copy()
    steps[:, 2] -= fall
    return replace(motion, tables=motion.tables._replace(steps=steps))


def _belt(treadmill: Treadmill, steps: RunSteps, profile: RunProfile) -> PiecewiseQuintic:
    """What the belt does beyond its mean speed: a dip in every stance, made up for all the time."""
    contact, toe_off = steps.contact_s[:-1], steps.toe_off_s[:-1]
    dip = treadmill.dip * float(profile.speed_m_s.mean())
    lost = np.sum(dip * (toe_off - contact) / 2.0)
    gain = lost / (steps.contact_s[-1] - contact[0])
    knots = np.stack([contact, (contact + toe_off) / 2.0, toe_off], axis=-1).ravel()
    knots = np.append(knots, steps.contact_s[-1])
    speed = np.full(len(knots), gain)
    speed[1::3] -= dip
    slowed = np.zeros(len(knots) - 1)
    slowed[0::3] = slowed[1::3] = dip * (toe_off - contact) / 4.0
    place = np.concatenate([[0.0], np.cumsum(gain * np.diff(knots) - slowed)])
    place -= np.interp(0.0, knots, place)
    states = np.stack([place, speed, np.zeros_like(speed)], axis=-1)
    pairs = np.stack([states[:-1], states[1:]], axis=1)
    both = np.stack([knots[:-1], knots[1:]], axis=1)
    return PiecewiseQuintic(knots[:-1], least_jerk(both, pairs)[:, 0])
