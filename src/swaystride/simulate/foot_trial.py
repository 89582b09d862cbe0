"""One trial of a person: the stances of both feet from rest to rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate.foot_anchors import GaitAnchors
from swaystride.simulate.foot_course import CourseParameters, StepTimes, longest_push_s, step_times
from swaystride.simulate.foot_person import Foot, Person
from swaystride.simulate.foot_stances import FootStances
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StrideScatter:
    """Scatter from stride to stride.

    Parameters
    ----------
    time_cv, impact_cv, arrest_cv, quiet_rate_cv, rise_cv : float
        Coefficients of variation.
    placement_sd_m, width_sd_m : float
        Of the place of a foot along the way, and to the side.
    pitch_sd_deg, roll_sd_deg, heading_sd_deg : float
        Of the angles of the foot.
    standing_width_m : float
        Distance between the feet of a standing person.
    """

    time_cv: float
    impact_cv: float
    arrest_cv: float
    quiet_rate_cv: float
    rise_cv: float
    placement_sd_m: float
    width_sd_m: float
    pitch_sd_deg: float
    roll_sd_deg: float
    heading_sd_deg: float
    standing_width_m: float


@dataclass(frozen=True)
class FootTrial:
    """Stances of both feet in one trial.

    Parameters
    ----------
    left, right : FootStances
        Of each foot; times from the start of the recording.
    start_s, stop_s : float
        When the movement begins and ends.
    duration_s : float
        Length of the recording.
    """

    left: FootStances
    right: FootStances
    start_s: float
    stop_s: float
    duration_s: float


def foot_trial(
    person: Person,
    mean_speed_m_s: float,
    *,
    course: CourseParameters,
    scatter: StrideScatter,
    anchors: GaitAnchors,
    rng: np.random.Generator,
) -> FootTrial:
    """Stances of both feet for a trial of prescribed mean speed.

    Parameters
    ----------
    person : Person
        Whose feet.
    mean_speed_m_s : float
        Distance over the time from the first rise of a heel to the last flat foot.
    course : CourseParameters
        Distance, start, stop and rest.
    scatter : StrideScatter
        From stride to stride.
    anchors : GaitAnchors
        What the foot does at a speed.
    rng : numpy.random.Generator
        Source of all random numbers.

    Returns
    -------
    FootTrial
    """
    steps = step_times(
        course,
        anchors,
        mean_speed_m_s,
        stride_time_scale=person.stride_time,
        stride_time_cv=scatter.time_cv,
        rng=rng,
    )
    before, after = rng.uniform(*course.rest_s, size=2)
    first = int(rng.integers(2))
    stances = {}
    for index, foot in enumerate(person.feet):
        # The foot that steps first has the steps 1, 3, …; the other one 2, 4, ….
        own = np.arange(index != first, len(steps.contact_s), 2)
        stances[foot.side] = _stances(foot, steps, own, course, scatter, anchors, before, rng)
    total_s = course.distance_m / mean_speed_m_s
    return FootTrial(
        stances["left"], stances["right"], before, before + total_s, before + total_s + after
    )


def _stances(
    foot: Foot,
    steps: StepTimes,
    own: NDArray[np.intp],
    course: CourseParameters,
    scatter: StrideScatter,
    anchors: GaitAnchors,
    begin_s: float,
    rng: np.random.Generator,
) -> FootStances:
    """Stances of one foot: the rest at the start, its steps, the last of which is the final rest."""
    n = len(own) + 1
    gait_speed = np.concatenate([steps.gait_speed_m_s[:1], steps.gait_speed_m_s[own]])
    gait = anchors.at(gait_speed)
    angles = _angles(foot, gait, scatter, rng)
    fields = {
        **_times(steps, own, gait, angles),
        **_places(foot, steps, own, gait, course, scatter, rng),
        **angles,
        **_swings(
            foot, anchors.at((gait_speed + np.append(gait_speed[1:], 0.0)) / 2), scatter, rng
        ),
    }
    factor = np.exp(scatter.impact_cv * rng.standard_normal((2, n)))
    fields["impact_forward_m_s"] = gait["impact_forward_m_s"] * foot.manner.impact * factor[0]
    fields["impact_down_m_s"] = gait["impact_down_m_s"] * foot.manner.impact * factor[1]
    fields["arrest_s"] = gait["arrest_time_s"] * foot.manner.arrest
    fields["arrest_s"] *= np.exp(scatter.arrest_cv * rng.standard_normal(n))
    stance_s = fields["toe_off_s"] - fields["contact_s"]
    stance_s[0] = gait["stride_time_s"][0] * gait["duty_factor"][0]
    mean_rate = (fields["flat_pitch_rad"] - fields["toe_off_pitch_rad"]) / stance_s
    quiet = gait["quiet_rate_ratio"] * mean_rate * foot.manner.quiet_rate
    fields["quiet_rate_rad_s"] = quiet * np.exp(scatter.quiet_rate_cv * rng.standard_normal(n))
    for name in ("contact_s", "flat_s", "heel_off_s", "toe_off_s"):
        fields[name] = fields[name] + begin_s
    return FootStances(**_at_rest(fields))


def _times(
    steps: StepTimes, own: NDArray[np.intp], gait: dict[str, Array], angles: dict[str, Array]
) -> dict[str, Array]:
    """Contact, foot flat, heel-off and toe-off from the contacts of both feet."""
    contacts = steps.contact_s
    duty = gait["duty_factor"]
    # The rest at the start takes the place of a stance one stride before the first step.
    contact = np.concatenate([[np.nan], contacts[own]])
    stride = np.diff(contact, append=np.nan)
    stride[0] = 2.0 * (contacts[1] - contacts[0])
    contact[0] = contact[1] - stride[0]
    toe_off = contact + duty * stride
    flat = contact + gait["flat_delay_s"]
    heel_off = contact + gait["heel_off"] * duty * stride
    turn = angles["flat_pitch_rad"] - angles["toe_off_pitch_rad"]
    push = longest_push_s(turn, angles["toe_off_rate_rad_s"])
    heel_off = np.maximum(np.maximum(heel_off, flat + 0.1 * duty * stride), toe_off - push)
    if own[0] == 0:
        heel_off[0], toe_off[0] = 0.0, steps.first_push_s
    if own[-1] == len(contacts) - 1:
        flat[-1] = steps.stop_s
    flat[0] = np.nan
    contact[0] = np.nan
    return {"contact_s": contact, "flat_s": flat, "heel_off_s": heel_off, "toe_off_s": toe_off}


def _places(
    foot: Foot,
    steps: StepTimes,
    own: NDArray[np.intp],
    gait: dict[str, Array],
    course: CourseParameters,
    scatter: StrideScatter,
    rng: np.random.Generator,
) -> dict[str, Array]:
    """Where the foot stands: under the body in the middle of its stance."""
    n = len(own) + 1
    contacts = steps.contact_s
    stride = 2.0 * np.diff(contacts, append=2 * contacts[-1] - contacts[-2])
    noise = rng.standard_normal((3, n))
    middle = contacts[own] + 0.5 * gait["duty_factor"][1:] * stride[own]
    x = np.zeros(n)
    x[1:] = steps.course.way_m(middle) + scatter.placement_sd_m * noise[0, 1:]
    x[-1] = course.distance_m
    y = -foot.right * gait["step_width_m"] / 2.0 + scatter.width_sd_m * noise[1]
    y[[0, -1]] = -foot.right * scatter.standing_width_m / 2.0
    toe_out = gait["toe_out_rad"] + foot.manner.toe_out_rad
    heading = -foot.right * toe_out + scatter.heading_sd_deg * RAD_PER_DEG * noise[2]
    return {"x_m": x, "y_m": y, "heading_rad": heading}


def _angles(
    foot: Foot, gait: dict[str, Array], scatter: StrideScatter, rng: np.random.Generator
) -> dict[str, Array]:
    """Pitch and roll of the foot at contact, flat and toe-off."""
    n = len(gait["duty_factor"])
    pitch = scatter.pitch_sd_deg * RAD_PER_DEG * rng.standard_normal((2, n))
    roll = scatter.roll_sd_deg * RAD_PER_DEG * rng.standard_normal((3, n))
    inversion, eversion = gait["contact_inversion_rad"], gait["flat_eversion_rad"]
    contact = gait["contact_pitch_rad"] + foot.manner.contact_pitch_rad + pitch[0]
    to_flat = (gait["flat_pitch_rad"] - contact) / gait["flat_delay_s"]
    return {
        "contact_pitch_rad": contact,
        "contact_rate_rad_s": gait["contact_rate_share"] * to_flat,
        "flat_pitch_rad": gait["flat_pitch_rad"],
        "toe_off_pitch_rad": gait["toe_off_pitch_rad"] + foot.manner.toe_off_pitch_rad + pitch[1],
        "toe_off_rate_rad_s": gait["toe_off_pitch_rate_rad_s"],
        "contact_roll_rad": foot.right * inversion + roll[0],
        "flat_roll_rad": -foot.right * eversion + roll[1],
        "toe_off_roll_rad": foot.right * inversion / 2.0 + roll[2],
    }


def _swings(
    foot: Foot, gait: dict[str, Array], scatter: StrideScatter, rng: np.random.Generator
) -> dict[str, Array]:
    """What the foot does in the swing behind each stance."""
    n = len(gait["duty_factor"])
    pitch = foot.manner.swing_pitch_rad + scatter.pitch_sd_deg * RAD_PER_DEG * rng.standard_normal(
        n
    )
    roll = scatter.roll_sd_deg * RAD_PER_DEG * rng.standard_normal((2, n))
    rise = foot.manner.rise * np.exp(scatter.rise_cv * rng.standard_normal(n))
    return {
        "swing_pitch_rad": gait["swing_pitch_rad"] + pitch,
        "swing_pitch_time": gait["swing_pitch_time"],
        "swing_roll_rad": foot.right * gait["swing_inversion_rad"] + roll[0],
        "swing_turn_rad": -foot.right * gait["swing_turn_rad"] + roll[1],
        "rise_time": gait["rise_time"],
        "rise_clearance_m": gait["rise_clearance_m"] * rise,
        "late_clearance_m": gait["late_clearance_m"],
        "forward_share": gait["forward_share"],
    }


def _at_rest(fields: dict[str, Array]) -> dict[str, Array]:
    """A level, still foot in the first and the last stance, and NaN for what a rest does not have."""
    for name in ("flat_pitch_rad", "quiet_rate_rad_s", "flat_roll_rad"):
        fields[name][[0, -1]] = 0.0
    arriving = (
        "contact_s",
        "arrest_s",
        "flat_s",
        "contact_pitch_rad",
        "contact_rate_rad_s",
        "contact_roll_rad",
        "impact_forward_m_s",
        "impact_down_m_s",
    )
    leaving = (
        "heel_off_s",
        "toe_off_s",
        "toe_off_pitch_rad",
        "toe_off_rate_rad_s",
        "toe_off_roll_rad",
        "swing_pitch_rad",
        "swing_pitch_time",
        "swing_roll_rad",
        "swing_turn_rad",
        "rise_time",
        "rise_clearance_m",
        "late_clearance_m",
        "forward_share",
    )
    for name in arriving:
        fields[name][0] = np.nan
    for name in leaving:
        fields[name][-1] = np.nan
    return fields
