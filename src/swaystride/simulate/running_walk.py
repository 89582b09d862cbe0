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
from swaystride.simulate.running_run import REFERENCE_HEIGHT_M, within_reach
from swaystride.simulate.running_steps import RunPath
from swaystride.simulate.running_stride_phase import phase_pieces, step_phase_pieces

Array = NDArray[np.float64]

#: How far a walker's hips are ahead of the ankle in the middle of a stance, in leg lengths: over the
#: ball of the foot rather than the ankle [N].
_HIPS_AHEAD: Final = 0.085
#: A walker's leg is never longer than this share of thigh and shank: the knee stays flexed by 7°, as
#: real ones are at least at contact and in the late stance [M].
_LONGEST_LEG: Final = 0.998
#: How long a walker goes down before the first step [N].
_GOING_DOWN_S: Final = 0.8
#: Passes in which the height of the hips over each stride is found.
_LOWERINGS: Final = 3


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
    height = body.sole.ankle_height_m + _LONGEST_LEG * body.leg_m
    knots = _knots_s(2, stances[0], trial)

    def built(lower_m: Array) -> RunningMotion:
        # Rows of the pelvis only tell the strides apart: none of them moves it.
        pelvis = np.repeat(still_pelvis(height), len(knots) + 1, axis=0)
        pelvis[1:, 0] = knots
        phases = [
            _phase(side, stances[side % 2], trial, manner, mean_speed_m_s) for side in range(3)
        ]
        phases[2].offset[:, OSCILLATION + 2] -= lower_m
        return assembled(
            body,
            duration_s=trial.duration_s,
            feet=feet,
            path=path,
            pelvis=pelvis,
            phases=(phases[0], phases[1], phases[2]),
        )

    # A walker's hips are lower than those of somebody who stands; the legs say by how much, stride
    # by stride, so that one long step does not bend the knees of all others.
    limit = _LONGEST_LEG * body.leg_m
    lower = np.zeros(len(knots))
    for _ in range(_LOWERINGS):
        motion = built(lower)
        falls = longest_falls(motion.tables, motion.duration_s, 0.008, limit)[1:]
        lower[1:-1] += np.maximum(np.maximum(falls[1:-1], falls[:-2]), 0.0)
    # From stride to stride the hips change little.
    inner = np.convolve(lower[1:-1], [0.25, 0.5, 0.25], mode="same")
    lower[2:-2] = np.maximum(inner, lower[1:-1])[1:-1]
    return within_reach(built(lower), _LONGEST_LEG)


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


def _knots_s(side: int, stances: FootStances, trial: FootTrial) -> Array:
    """Contacts of one leg between a begin and an end at rest.

    Pelvis and trunk (side 2) go down a little before the first foot is lifted.
    """
    begin = stances.toe_off_s[0] - 0.5
    knots = [begin, *stances.contact_s[1:], trial.stop_s + 0.6]
    if side == 2:
        knots[0] = min(begin, trial.start_s)
        knots.insert(0, knots[0] - _GOING_DOWN_S)
    return np.array(knots)


def _phase(
    side: int, stances: FootStances, trial: FootTrial, manner: RunnerManner, speed_m_s: float
) -> PhaseTables:
    """Coordinates that come and go with the steps of one leg."""
    contact = _knots_s(side, stances, trial)
    toe_off = np.array([*stances.toe_off_s[:-1], (contact[-2] + contact[-1]) / 2.0])
    toe_off = np.append(toe_off, contact[-1] + 0.3)
    n = len(contact)
    gait = {name: np.repeat(value, n) for name, value in manner_anchors().at([speed_m_s]).items()}
    own = {f.name: np.full(n, float(getattr(manner, f.name))) for f in fields(RunnerManner)}
    offset, amplitude = usual_coordinates(gait, own)
    # Hanging arms and a level pelvis at rest; movement grows and fades with the first and last step.
    going = np.ones((n, 1))
    going[: n - len(stances.contact_s)] = going[-1] = 0.0
    going[-2] = 0.5
    strength = np.zeros((n, 3))
    down = np.nan_to_num(stances.impact_down_m_s[1:])
    begin = n - 1 - len(down)
    strength[begin:-1, 0] = down * gait["pelvis_transient"][0] * manner.pelvis_transient
    strength[begin:-1, 1] = down * gait["head_transient"][0] * manner.head_transient
    strength[begin:-1, 2] = down * manner.soft_tissue
    offset = offset * np.where(going > 0.0, 1.0, 0.0)
    # Pelvis and trunk go with the right leg: steps of walkers are even enough.
    even = 0.5 * np.diff(contact, append=contact[-1] + 1.0)
    between = np.stack([contact, contact + even], axis=-1).ravel()[:-1]
    phase = step_phase_pieces(between) if side == 2 else phase_pieces(contact, toe_off)
    return signed_phase(side, contact, phase, offset, amplitude * going, strength)
