"""How one person runs, how that varies from stride to stride, and how it changes over a run."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import ConfigurationError
from swaystride.simulate.foot_anchors import GaitAnchors, read_anchors

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RunnerManner:
    """How a person differs from the usual runner of that speed; neutral unless given.

    Factors are 1 and what is added is 0 for the usual runner, whom ``foot_anchors.csv`` and
    ``running_manner.csv`` describe.

    Parameters
    ----------
    stride_time, impact, arrest, quiet_rate : float
        Factors on the stride time, the velocities at first touch, the duration of the arrest, and
        the slowest rate at which the heel rises.
    duty_factor, contact_pitch_rad, toe_off_pitch_rad, swing_pitch_rad, toe_out_rad : float
        Added.
    foot_roll : float
        Factor on the way from inversion at contact to eversion in stance.
    step_width_m, foot_ahead_m, crouch_m : float
        Added to the step width, to how far the feet land ahead of the hips, and how much lower
        the hips are than they could be.
    hip_range, knee_range : float
        Factors on the flexion of hip and knee that the swing aims at.
    hip_rotation_range, knee_adduction_range, knee_rotation_range : float
        Factors.
    pelvis_range, trunk_range, arm_swing : float
        Factors on the movements of pelvis, trunk (and head), and arms.
    pelvis_tilt_rad, trunk_lean_rad, elbow_rad : float
        Added.
    pelvis_transient, head_transient, soft_tissue : float
        Factors on what of an impact arrives at pelvis and head, and on the wobble of soft tissue.
    """

    stride_time: float = 1.0
    impact: float = 1.0
    arrest: float = 1.0
    quiet_rate: float = 1.0
    duty_factor: float = 0.0
    contact_pitch_rad: float = 0.0
    toe_off_pitch_rad: float = 0.0
    swing_pitch_rad: float = 0.0
    toe_out_rad: float = 0.0
    foot_roll: float = 1.0
    step_width_m: float = 0.0
    foot_ahead_m: float = 0.0
    crouch_m: float = 0.0
    hip_range: float = 1.0
    knee_range: float = 1.0
    hip_rotation_range: float = 1.0
    knee_adduction_range: float = 1.0
    knee_rotation_range: float = 1.0
    pelvis_range: float = 1.0
    trunk_range: float = 1.0
    arm_swing: float = 1.0
    pelvis_tilt_rad: float = 0.0
    trunk_lean_rad: float = 0.0
    elbow_rad: float = 0.0
    pelvis_transient: float = 1.0
    head_transient: float = 1.0
    soft_tissue: float = 1.0


#: Parts of a manner, by name.
Changes = dict[str, Array]


@dataclass(frozen=True)
class RunProfile:
    """Speed and manner over a run, linear between given times.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Rising times from the start of the recording.
    speed_m_s : ndarray, shape (n,)
        Speed.
    changes : dict of str to ndarray, shape (n,)
        What is added to a field of :class:`RunnerManner` at these times: warm-up, fatigue.
    heading_rad : ndarray, shape (n,), optional
        Direction of running, straight ahead by default; it should change slowly.

    Examples
    --------
    A runner who lands harder, by up to a tenth, as fatigue grows over half an hour:

    >>> tired = RunProfile(
    ...     np.array([0.0, 1800.0]), np.array([3.0, 3.0]), {"impact": np.array([0.0, 0.1])}
    ... )
    >>> round(float(tired.manner(RunnerManner(), [900.0])["impact"][0]), 3)
    1.05
    """

    time_s: Array
    speed_m_s: Array
    changes: Changes = field(default_factory=dict)
    heading_rad: Array | None = None

    def __post_init__(self) -> None:
        """Refuse a change of something that no manner has."""
        unknown = sorted(set(self.changes) - {f.name for f in fields(RunnerManner)})
        if unknown:
            raise ConfigurationError(
                "a run changes what no manner has",
                place=unknown[0],
                expected="a field of RunnerManner",
                found=unknown[0],
            )

    def speed_at(self, time_s: ArrayLike) -> Array:
        """Speed at any times."""
        return np.asarray(np.interp(np.asarray(time_s), self.time_s, self.speed_m_s))

    def heading_at(self, time_s: ArrayLike) -> Array:
        """Direction of running at any times, counter-clockwise."""
        time = np.asarray(time_s, dtype=np.float64)
        if self.heading_rad is None:
            return np.zeros_like(time)
        return np.asarray(np.interp(time, self.time_s, self.heading_rad))

    def manner(self, manner: RunnerManner, time_s: ArrayLike) -> dict[str, Array]:
        """Every part of a manner at any times.

        Parameters
        ----------
        manner : RunnerManner
            Of the person.
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        dict of str to ndarray, shape (n,)
        """
        time = np.asarray(time_s, dtype=np.float64)
        values = {}
        for part in fields(RunnerManner):
            values[part.name] = np.full(time.shape, float(getattr(manner, part.name)))
            if part.name in self.changes:
                values[part.name] += np.interp(time, self.time_s, self.changes[part.name])
        return values


def steady_run(duration_s: float, speed_m_s: float) -> RunProfile:
    """Run at constant speed in an unchanging manner.

    Parameters
    ----------
    duration_s, speed_m_s : float
        Length and speed.
    """
    return RunProfile(np.array([0.0, duration_s]), np.array([speed_m_s, speed_m_s]))


@dataclass(frozen=True)
class RunVariability:
    """Scatter from stride to stride.

    Parameters
    ----------
    time_cv, duty_cv, impact_cv, arrest_cv, quiet_rate_cv, range_cv : float
        Coefficients of variation of stride time, duty factor, impact velocity, duration of the
        arrest, slowest rate of the rising heel, and ranges of movement.
    placement_sd_m, width_sd_m, clearance_sd_m : float
        Of the place of a foot along the way and to the side, and of the ankle in mid-swing.
    pitch_sd_rad, roll_sd_rad, heading_sd_rad, joint_sd_rad : float
        Of the angles of the foot, and of the other angles.
    memory : float
        Correlation of all of these from one stride to the next.
    """

    time_cv: float
    duty_cv: float
    impact_cv: float
    arrest_cv: float
    quiet_rate_cv: float
    range_cv: float
    placement_sd_m: float
    width_sd_m: float
    clearance_sd_m: float
    pitch_sd_rad: float
    roll_sd_rad: float
    heading_sd_rad: float
    joint_sd_rad: float
    memory: float


#: A runner whose strides are all alike.
NO_VARIABILITY = RunVariability(**{f.name: 0.0 for f in fields(RunVariability)})

#: Scatter of a usual runner from stride to stride (spec §9.1, step 9).
USUAL_VARIABILITY = RunVariability(
    time_cv=0.012,
    duty_cv=0.015,
    impact_cv=0.08,
    arrest_cv=0.08,
    quiet_rate_cv=0.2,
    range_cv=0.03,
    placement_sd_m=0.01,
    width_sd_m=0.02,
    clearance_sd_m=0.006,
    pitch_sd_rad=0.02,
    roll_sd_rad=0.015,
    heading_sd_rad=0.015,
    joint_sd_rad=0.02,
    memory=0.3,
)


@cache
def manner_anchors() -> GaitAnchors:
    """Return the table ``running_manner.csv`` in this folder."""
    return read_anchors(Path(__file__).with_name("running_manner.csv"))


@cache
def curves() -> dict[str, Array]:
    """Shapes of coordinates over a stride, from ``running_curves.csv`` in this folder.

    Returns
    -------
    dict of str to ndarray, shape (12,)
        Cosine and sine coefficients of the harmonics 1 to 6, scaled to a range of 1.
    """
    table = pd.read_csv(Path(__file__).with_name("running_curves.csv"), index_col="coordinate")
    shapes = {}
    for name, row in table.drop(columns="source").iterrows():
        coefficients = row.to_numpy(dtype=np.float64)
        wave = fourier(coefficients, np.linspace(0.0, 1.0, 2001))[0]
        shapes[str(name)] = coefficients / (wave.max() - wave.min())
    return shapes


def fourier(coefficients: ArrayLike, phase: ArrayLike) -> Array:
    """Fourier series without its constant, and its two derivatives by the phase.

    Parameters
    ----------
    coefficients : array_like, shape (12,)
        a1, b1, …, a6, b6.
    phase : array_like, shape (n,)
        Phase; the period is 1.

    Returns
    -------
    ndarray, shape (3, n)
    """
    c = np.asarray(coefficients, dtype=np.float64)
    k = 2.0 * np.pi * np.arange(1, 7)[:, None]
    turn = k * np.asarray(phase, dtype=np.float64)
    cosine, sine = np.cos(turn), np.sin(turn)
    a, b = c[0::2, None], c[1::2, None]
    wave = a * cosine + b * sine
    return np.stack([wave.sum(0), (k * (b * cosine - a * sine)).sum(0), -(k * k * wave).sum(0)])
