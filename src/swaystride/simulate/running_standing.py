"""Quiet standing in a posture of one's own, away from the neutral one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate._running_kernel import N_COORDINATES
from swaystride.simulate.foot_motion import FootMotion
from swaystride.simulate.foot_spline import PiecewiseQuintic, least_jerk
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_motion import RunningMotion, assembled
from swaystride.simulate.running_pelvis import still_pelvis
from swaystride.simulate.running_phases import PhaseTables
from swaystride.simulate.running_run import within_reach
from swaystride.simulate.running_steps import RunPath

Array = NDArray[np.float64]

#: Standing people may straighten their knees to 5°.
_LONGEST_STANDING_LEG: Final = 0.999


@dataclass(frozen=True)
class StandingManner:
    """How people stand.

    Parameters
    ----------
    segment_sd_rad : float
        Scatter of the angles of pelvis, trunk, head, thighs, shanks and arms about the neutral
        posture (spec §9.1: 3-5°).
    feet_apart_m, feet_sd_m : float
        Between the ankles, and the scatter of each foot along both axes.
    toe_out_rad, toe_out_sd_rad : float
        Feet turned out.
    knee_rad, knee_sd_rad : float
        Flexion of the knees.
    elbow_rad : float
        Flexion of the elbows.
    sway_m : float
        Standard deviation of the slow sway of the pelvis.
    """

    segment_sd_rad: float
    feet_apart_m: float
    feet_sd_m: float
    toe_out_rad: float
    toe_out_sd_rad: float
    knee_rad: float
    knee_sd_rad: float
    elbow_rad: float
    sway_m: float


def standing_motion(
    body: RunnerBody, manner: StandingManner, *, duration_s: float, rng: np.random.Generator
) -> RunningMotion:
    """A person who stands quietly on flat feet.

    Parameters
    ----------
    body : RunnerBody
        Of the person.
    manner : StandingManner
        How people stand.
    duration_s : float
        Length of the recording.
    rng : numpy.random.Generator
        Source of posture and sway.

    Returns
    -------
    RunningMotion
    """
    feet = (_foot(body, manner, 1.0, rng), _foot(body, manner, -1.0, rng))
    # The legs incline as far as the other segments, the feet stay: the hips are ahead or behind.
    lean = manner.segment_sd_rad * rng.standard_normal()
    path = _swaying(body.leg_m * np.sin(lean), manner.sway_m, duration_s, rng)
    knee = max(manner.knee_rad + manner.knee_sd_rad * rng.standard_normal(), 0.09)
    square = body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee)
    leg = np.sqrt(square) * np.cos(lean)
    height = body.sole.ankle_height_m + leg
    right, left, both = (_still_phase(manner, rng) for _ in range(3))
    motion = assembled(
        body,
        duration_s=duration_s,
        feet=feet,
        path=path,
        pelvis=still_pelvis(float(height)),
        phases=(right, left, both),
    )
    return within_reach(motion, _LONGEST_STANDING_LEG)


def _foot(
    body: RunnerBody, manner: StandingManner, right: float, rng: np.random.Generator
) -> FootMotion:
    """A flat foot that never moves."""
    x, y = manner.feet_sd_m * rng.standard_normal(2)
    heading = -right * (manner.toe_out_rad + manner.toe_out_sd_rad * rng.standard_normal())
    values = {name: np.full(1, np.nan) for name in FootStances.names()}
    values |= {"x_m": np.array([x]), "y_m": np.array([y - right * manner.feet_apart_m / 2.0])}
    values |= {"heading_rad": np.array([heading])}
    zero = constant(0.0)
    return FootMotion(
        sole=body.sole,
        stances=FootStances(**values),
        pitch=zero,
        roll=zero,
        heading=constant(float(heading)),
        swing=(zero, zero, zero),
        excess_m_s=np.zeros((3, 1)),
    )


def constant(value: float) -> PiecewiseQuintic:
    """Function that never changes.

    Parameters
    ----------
    value : float
        Its value.
    """
    return PiecewiseQuintic(np.zeros(1), np.array([[value, 0.0, 0.0, 0.0, 0.0, 0.0]]))


def _swaying(
    forward_m: float, sway_m: float, duration_s: float, rng: np.random.Generator
) -> RunPath:
    """Slow sway about a place, with knots every 0.8 s."""
    knots = np.arange(-1.6, duration_s + 2.4, 0.8)
    axes = []
    for place in (forward_m, 0.0):
        states = np.full((1, len(knots), 3), 0.0)
        noise = rng.standard_normal(len(knots) + 2)
        states[0, :, 0] = place + sway_m * (noise[:-2] + noise[1:-1] + noise[2:]) / np.sqrt(3.0)
        states[0, 1:-1, 1] = (states[0, 2:, 0] - states[0, :-2, 0]) / 1.6
        axes.append(PiecewiseQuintic(knots[:-1], least_jerk(knots[None], states)[0]))
    still = np.zeros((len(knots) - 1, 6))
    return RunPath(axes[0], axes[1], PiecewiseQuintic(knots[:-1], still))


def _still_phase(manner: StandingManner, rng: np.random.Generator) -> PhaseTables:
    """Angles that do not change."""
    offset = np.zeros(N_COORDINATES)
    angles = [i for i in range(N_COORDINATES) if i not in (1, 2, 7, 8, 9)]
    offset[angles] = manner.segment_sd_rad * rng.standard_normal(len(angles))
    offset[6] = manner.elbow_rad + offset[6]
    both = np.stack([offset, offset])
    return PhaseTables(
        contact_s=np.array([-2e9, -1e9]),
        phase=constant(0.0),
        offset=both,
        amplitude=np.zeros_like(both),
        fourier=np.zeros((N_COORDINATES, 12)),
        strength=np.zeros((2, 3)),
    )
