"""Steps of a run: when the feet land, how long they stay, and what the person is like then."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.signal import lfilter

from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_spline import PiecewiseQuintic, least_jerk
from swaystride.simulate.running_manner import (
    RunnerManner,
    RunProfile,
    RunVariability,
    manner_anchors,
)

Array = NDArray[np.float64]

#: Strides that are run before the recording begins and after it ends.
LEAD_STRIDES = 4


@dataclass(frozen=True)
class RunPath:
    """Way of the runner over the ground (or the belt), before any bobbing and swaying.

    Parameters
    ----------
    x, y, heading : PiecewiseQuintic
        Position in m and direction in rad, on common pieces.
    """

    x: PiecewiseQuintic
    y: PiecewiseQuintic
    heading: PiecewiseQuintic


@dataclass(frozen=True)
class RunSteps:
    """All steps of a run; even ones are right, odd ones left.

    Parameters
    ----------
    contact_s, toe_off_s : ndarray, shape (n,)
        First and last touch.
    stride_s : ndarray, shape (n,)
        Usual duration of a stride at that time.
    speed_m_s : ndarray, shape (n,)
        Speed.
    gait : dict of str to ndarray, shape (n,)
        Feet and body of the usual runner of that speed.
    manner : dict of str to ndarray, shape (n,)
        How this runner differs then.
    """

    contact_s: Array
    toe_off_s: Array
    stride_s: Array
    speed_m_s: Array
    gait: dict[str, Array]
    manner: dict[str, Array]

    def __len__(self) -> int:
        """Number of steps."""
        return len(self.contact_s)


def run_steps(
    manner: RunnerManner,
    profile: RunProfile,
    *,
    duration_s: float,
    stride_time_scale: float,
    variability: RunVariability,
    rng: np.random.Generator,
) -> RunSteps:
    """Steps that cover a recording, with a lead on both sides.

    Parameters
    ----------
    manner : RunnerManner
        Of the runner.
    profile : RunProfile
        Speed and changes.
    duration_s : float
        Length of the recording, which begins at time 0.
    stride_time_scale : float
        Factor on all stride times (longer legs swing more slowly).
    variability : RunVariability
        Scatter.
    rng : numpy.random.Generator
        Source of the scatter.

    Returns
    -------
    RunSteps
    """
    slowest = float(gait_anchors().at([profile.speed_m_s.min()])["stride_time_s"][0])
    shortest = 0.5 * slowest * stride_time_scale
    n = 2 * int(duration_s / shortest + 4 * LEAD_STRIDES + 8)
    jitter = 1.0 + np.sqrt(2.0) * variability.time_cv * rng.standard_normal(n)
    duty = variability.duty_cv * correlated(rng, n, variability.memory)
    begin = -LEAD_STRIDES * 2.0 * shortest - rng.uniform(0.0, 2.0 * shortest)
    contact: Array = np.asarray(begin + shortest * np.arange(n), dtype=np.float64)
    for _ in range(4):
        stride = _stride_time(manner, profile, contact) * stride_time_scale
        ways = np.cumsum(0.5 * (stride * jitter)[:-1])
        contact = begin + np.concatenate([np.zeros(1), ways])
    keep = contact < duration_s + 2 * LEAD_STRIDES * shortest
    keep[: 2 * (np.count_nonzero(keep) // 2)] = True
    keep[2 * (np.count_nonzero(keep) // 2) :] = False
    contact, stride, duty = contact[keep], stride[keep], duty[keep]
    speed = profile.speed_at(contact)
    own = profile.manner(manner, contact)
    gait = {**gait_anchors().at(speed), **manner_anchors().at(speed)}
    share = (gait["duty_factor"] + own["duty_factor"]) * (1.0 + duty)
    return RunSteps(contact, contact + share * stride, stride, speed, gait, own)


def _stride_time(manner: RunnerManner, profile: RunProfile, time_s: Array) -> Array:
    usual = gait_anchors().at(profile.speed_at(time_s))["stride_time_s"]
    return np.asarray(usual * profile.manner(manner, time_s)["stride_time"])


def correlated(
    rng: np.random.Generator, n: int, memory: float, columns: tuple[int, ...] = ()
) -> Array:
    """Unit normal numbers that remember: each is `memory` times the last one, and new.

    Consecutive steps belong to different legs: the memory is from step to step of one leg.

    Parameters
    ----------
    rng : numpy.random.Generator
        Source.
    n : int
        Number of steps.
    memory : float
        Correlation from stride to stride.
    columns : tuple of int
        Further axes.

    Returns
    -------
    ndarray, shape (n, *columns)
    """
    noise = rng.standard_normal((n, *columns))
    noise[2:] *= np.sqrt(1.0 - memory**2)
    return np.asarray(lfilter([1.0], [1.0, 0.0, -memory], noise, axis=0))


def run_path(profile: RunProfile, begin_s: float, end_s: float) -> RunPath:
    """Way that belongs to a profile; position 0 is where the recording begins.

    Speed and direction are smoothed over half a second, so that no corner of the profile is a
    jerk.

    Parameters
    ----------
    profile : RunProfile
        Speed and direction.
    begin_s, end_s : float
        Times that it covers at least.

    Returns
    -------
    RunPath
    """
    step, every = 0.05, 10
    n = every * (int((end_s - begin_s) / (step * every)) + 2) + 1
    first = np.floor(begin_s / step) * step
    time = first + step * np.arange(n)
    speed = gaussian_filter1d(profile.speed_at(time), 0.5 / step, mode="nearest")
    heading = gaussian_filter1d(profile.heading_at(time), 0.5 / step, mode="nearest")
    velocity = np.stack([speed * np.cos(heading), speed * np.sin(heading)])
    # The two integrals of velocities that are smooth: Simpson would not change a micrometre.
    way = np.concatenate(
        [np.zeros((2, 1)), np.cumsum((velocity[:, 1:] + velocity[:, :-1]) * step / 2, axis=1)],
        axis=1,
    )
    origin = np.array([np.interp(0.0, time, way[axis]) for axis in range(2)])
    values = np.stack([way[0] - origin[0], way[1] - origin[1], heading])
    first_derivative = np.stack([*velocity, np.gradient(heading, step)])
    second = np.stack([np.gradient(row, step) for row in first_derivative])
    knots = time[::every]
    pieces = []
    for axis in range(3):
        states = np.stack(
            [values[axis, ::every], first_derivative[axis, ::every], second[axis, ::every]], axis=-1
        )
        pairs = np.stack([states[:-1], states[1:]], axis=1)
        both = np.stack([knots[:-1], knots[1:]], axis=1)
        pieces.append(PiecewiseQuintic(knots[:-1], least_jerk(both, pairs)[:, 0]))
    return RunPath(*pieces)
