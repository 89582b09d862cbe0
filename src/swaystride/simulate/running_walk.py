"""Walking from rest to rest, for movements that calibrate sensors on segments."""

from __future__ import annotations

from dataclasses import fields
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate._running_kernel import OSCILLATION
from swaystride.simulate._running_points import longest_falls
from swaystride.simulate.foot_anchors import gait_anchors
from swaystride.simulate.foot_course import CourseParameters
from swaystride.simulate.foot_person import Foot, FootManner, Person
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_spline import PiecewiseQuintic, least_jerk
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.foot_trial import FootTrial, StrideScatter, foot_trial
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import RunnerManner, manner_anchors
from swaystride.simulate.running_motion import RunningMotion, assembled
from swaystride.simulate.running_pelvis import still_pelvis
from swaystride.simulate.running_phases import PhaseTables, signed_phase, usual_coordinates
from swaystride.simulate.running_placement import LONGEST_LEG
from swaystride.simulate.running_run import REFERENCE_HEIGHT_M, within_reach
from swaystride.simulate.running_steps import RunPath
from swaystride.simulate.running_swing import phase_pieces, step_phase_pieces

Array = NDArray[np.float64]

#: How far a walker's hips are ahead of the ankle in the middle of a stance, in leg lengths: over the
#: ball of the foot rather than the ankle [N].
_HIPS_AHEAD: Final = 0.085


def walk_motion(
    body: RunnerBody,
    manner: RunnerManner,
    mean_speed_m_s: float,
    *,
    course: CourseParameters,
    scatter: StrideScatter,
    rng: np.random.Generator,
) -> RunningMotion:
    """Stand, walk a distance, stand: the feet as in the foot simulator, the body on top.

    Parameters
    ----------
    body : RunnerBody
        Of the person.
    manner : RunnerManner
        How the person moves; what belongs to running feet has no effect.
    mean_speed_m_s : float
        Mean speed.
    course : CourseParameters
        Distance, start, stop, and rests before and after.
    scatter : StrideScatter
        From stride to stride.
    rng : numpy.random.Generator
        Source of all that is random.

    Returns
    -------
    RunningMotion
    """
    scale = float(np.sqrt(body.height_m / REFERENCE_HEIGHT_M))
    neutral = FootManner(1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, manner.toe_out_rad)
    no_sensor = np.zeros((2, 3))
    left, right = (
        Foot(side, body.sole, neutral, no_sensor, np.eye(3)) for side in ("left", "right")
    )
    trial = foot_trial(
        Person(scale * manner.stride_time, (left, right)),
        mean_speed_m_s,
        course=course,
        scatter=scatter,
        anchors=gait_anchors(),
        rng=rng,
    )
    stances = (trial.right, trial.left)
    feet = (foot_motion(body.sole, stances[0]), foot_motion(body.sole, stances[1]))
    path = _path(trial, course.distance_m, _HIPS_AHEAD * body.leg_m)
    height = body.sole.ankle_height_m + LONGEST_LEG * body.leg_m

    def built(lower_m: float) -> RunningMotion:
        return assembled(
            body,
            duration_s=trial.duration_s,
            feet=feet,
            path=path,
            pelvis=still_pelvis(height),
            phases=(
                _phase(0, stances[0], trial, manner, mean_speed_m_s, lower_m),
                _phase(1, stances[1], trial, manner, mean_speed_m_s, lower_m),
                _phase(2, stances[0], trial, manner, mean_speed_m_s, lower_m),
            ),
        )

    # A walker's hips are lower than those of somebody who stands; the legs say by how much.
    high = built(0.0)
    limit = LONGEST_LEG * body.leg_m
    lower = float(longest_falls(high.tables, high.duration_s, 0.008, limit).max())
    return within_reach(built(max(lower, 0.0)), LONGEST_LEG)


def _path(trial: FootTrial, distance_m: float, ahead_m: float) -> RunPath:
    """The body is a little ahead of each ankle in the middle of its stance."""
    knots, places = [trial.start_s], [0.0]
    middle = [
        (t, x)
        for stances in (trial.right, trial.left)
        for t, x in zip(
            (stances.contact_s + stances.toe_off_s)[1:-1] / 2.0, stances.x_m[1:-1], strict=True
        )
    ]
    for t, x in sorted(middle):
        knots.append(float(t))
        places.append(float(x) + ahead_m)
    knots.append(max(trial.stop_s, knots[-1] + 0.3))
    places.append(distance_m)
    states = np.full((1, len(knots), 3), np.nan)
    states[0, :, 0] = places
    states[0, [0, -1], 1:] = 0.0
    pieces = least_jerk([knots], states)[0]
    start = np.array([knots[0] - 1.0, *knots])
    coefficients = np.zeros((len(start), 6))
    coefficients[1:-1] = pieces
    coefficients[-1, 0] = distance_m
    still = PiecewiseQuintic(start, np.zeros((len(start), 6)))
    return RunPath(PiecewiseQuintic(start, coefficients), still, still)


def _phase(
    side: int,
    stances: FootStances,
    trial: FootTrial,
    manner: RunnerManner,
    speed_m_s: float,
    lower_m: float,
) -> PhaseTables:
    """Coordinates that come and go with the steps of one leg."""
    last = stances.contact_s[-1]
    contact = np.array([stances.toe_off_s[0] - 0.5, *stances.contact_s[1:], trial.stop_s + 0.6])
    toe_off = np.array([*stances.toe_off_s[:-1], (last + contact[-1]) / 2.0, contact[-1] + 0.3])
    n = len(contact)
    gait = {name: np.repeat(value, n) for name, value in manner_anchors().at([speed_m_s]).items()}
    own = {f.name: np.full(n, float(getattr(manner, f.name))) for f in fields(RunnerManner)}
    offset, amplitude = usual_coordinates(gait, own)
    # Hanging arms and a level pelvis at rest; movement grows and fades with the first and last step.
    going = np.ones((n, 1))
    going[[0, -1]], going[-2] = 0.0, 0.5
    offset[:, OSCILLATION + 2] -= lower_m
    strength = np.zeros((n, 3))
    down = np.nan_to_num(stances.impact_down_m_s[1:])
    strength[1:-1, 0] = down * gait["pelvis_transient"][0] * manner.pelvis_transient
    strength[1:-1, 1] = down * gait["head_transient"][0] * manner.head_transient
    strength[1:-1, 2] = down * manner.soft_tissue
    offset = offset * np.where(going > 0.0, 1.0, 0.0)
    # Pelvis and trunk go with the right leg: steps of walkers are even enough.
    even = 0.5 * np.diff(contact, append=contact[-1] + 1.0)
    between = np.stack([contact, contact + even], axis=-1).ravel()[:-1]
    phase = step_phase_pieces(between) if side == 2 else phase_pieces(contact, toe_off)
    return signed_phase(side, contact, phase, offset, amplitude * going, strength)
