"""Stances of both feet of a runner from the steps of the run."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate.foot_course import longest_push_s
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.running_manner import RunVariability
from swaystride.simulate.running_steps import RunPath, RunSteps, correlated

Array = NDArray[np.float64]


def run_stances(
    steps: RunSteps,
    path: RunPath,
    ahead_m: Array,
    *,
    variability: RunVariability,
    rng: np.random.Generator,
) -> tuple[FootStances, FootStances]:
    """Stances of the right and the left foot.

    The first and the last stance of each foot stand for the rest that the foot model wants at both
    ends; both lie in the lead, outside the recording.

    Parameters
    ----------
    steps : RunSteps
        Steps of the run.
    path : RunPath
        Where the runner is.
    ahead_m : ndarray, shape (n_steps,)
        How far the ankle of the level foot stands ahead of the hips in the middle of the stance.
    variability : RunVariability
        Scatter.
    rng : numpy.random.Generator
        Source of the scatter.

    Returns
    -------
    right, left : FootStances
    """
    n = len(steps)
    noise = correlated(rng, n, variability.memory, (14,)).T
    right = np.where(np.arange(n) % 2 == 0, 1.0, -1.0)
    angles = _angles(steps, right, variability, noise)
    values = {**_times(steps, angles), **angles}
    values.update(_places(steps, path, ahead_m, right, variability, noise))
    values.update(_swings(steps, right, variability, noise))
    values.update(_impacts(steps, values, variability, noise))
    feet = []
    for side in range(2):
        own = {name: value[side::2].copy() for name, value in values.items()}
        for name in ("contact_s", "arrest_s", "flat_s"):
            own[name][0] = np.nan
        for name in ("heel_off_s", "toe_off_s"):
            own[name][-1] = np.nan
        feet.append(FootStances(**own))
    return feet[0], feet[1]


def _times(steps: RunSteps, angles: dict[str, Array]) -> dict[str, Array]:
    contact_time = steps.toe_off_s - steps.contact_s
    # The anchors' delay belongs to the usual contact time.
    usual = steps.gait["duty_factor"] * steps.gait["stride_time_s"]
    flat = steps.contact_s + steps.gait["flat_delay_s"] * contact_time / usual
    heel_off = steps.contact_s + steps.gait["heel_off"] * contact_time
    turn = angles["flat_pitch_rad"] - angles["toe_off_pitch_rad"]
    push = longest_push_s(turn, angles["toe_off_rate_rad_s"])
    heel_off = np.maximum(np.maximum(heel_off, flat + 0.1 * contact_time), steps.toe_off_s - push)
    return {
        "contact_s": steps.contact_s,
        "flat_s": flat,
        "heel_off_s": heel_off,
        "toe_off_s": steps.toe_off_s,
    }


def _places(
    steps: RunSteps,
    path: RunPath,
    ahead_m: Array,
    right: Array,
    variability: RunVariability,
    noise: Array,
) -> dict[str, Array]:
    """Where the feet stand: beside the path, as far ahead of the hips as told."""
    middle = (steps.contact_s + steps.toe_off_s) / 2.0
    x, y, heading = path.x(middle)[0], path.y(middle)[0], path.heading(middle)[0]
    along = ahead_m + variability.placement_sd_m * noise[0]
    width = steps.gait["step_width_m"] + steps.manner["step_width_m"]
    aside = -right * width / 2.0 + variability.width_sd_m * noise[1]
    toe_out = steps.gait["toe_out_rad"] + steps.manner["toe_out_rad"]
    cosine, sine = np.cos(heading), np.sin(heading)
    return {
        "x_m": x + cosine * along - sine * aside,
        "y_m": y + sine * along + cosine * aside,
        "heading_rad": heading - right * toe_out + variability.heading_sd_rad * noise[2],
    }


def _angles(
    steps: RunSteps, right: Array, variability: RunVariability, noise: Array
) -> dict[str, Array]:
    """Pitch and roll of the feet at contact, flat and toe-off."""
    gait, manner = steps.gait, steps.manner
    pitch, roll = variability.pitch_sd_rad * noise[3:5], variability.roll_sd_rad * noise[5:8]
    contact = gait["contact_pitch_rad"] + manner["contact_pitch_rad"] + pitch[0]
    contact_time = steps.toe_off_s - steps.contact_s
    usual = gait["duty_factor"] * gait["stride_time_s"]
    to_flat = (gait["flat_pitch_rad"] - contact) / (gait["flat_delay_s"] * contact_time / usual)
    # The way from inversion to eversion is shared as in the usual runner.
    more = manner["foot_roll"]
    return {
        "contact_pitch_rad": contact,
        "contact_rate_rad_s": gait["contact_rate_share"] * to_flat,
        "flat_pitch_rad": gait["flat_pitch_rad"].copy(),
        "toe_off_pitch_rad": gait["toe_off_pitch_rad"] + manner["toe_off_pitch_rad"] + pitch[1],
        "toe_off_rate_rad_s": gait["toe_off_pitch_rate_rad_s"].copy(),
        "contact_roll_rad": right * more * gait["contact_inversion_rad"] + roll[0],
        "flat_roll_rad": -right * more * gait["flat_eversion_rad"] + roll[1],
        "toe_off_roll_rad": right * gait["contact_inversion_rad"] / 2.0 + roll[2],
    }


def _swings(
    steps: RunSteps, right: Array, variability: RunVariability, noise: Array
) -> dict[str, Array]:
    """What the feet do in the swing behind each stance."""
    gait, manner = steps.gait, steps.manner
    pitch = manner["swing_pitch_rad"] + variability.pitch_sd_rad * noise[8]
    roll = variability.roll_sd_rad * noise[9:11]
    return {
        "swing_pitch_rad": gait["swing_pitch_rad"] + pitch,
        "swing_pitch_time": gait["swing_pitch_time"].copy(),
        "swing_roll_rad": right * gait["swing_inversion_rad"] + roll[0],
        "swing_turn_rad": -right * gait["swing_turn_rad"] + roll[1],
        "rise_time": gait["rise_time"].copy(),
        "rise_clearance_m": gait["rise_clearance_m"].copy(),
        "late_clearance_m": gait["late_clearance_m"].copy(),
        "forward_share": gait["forward_share"].copy(),
    }


def _impacts(
    steps: RunSteps, values: dict[str, Array], variability: RunVariability, noise: Array
) -> dict[str, Array]:
    """Velocities at first touch, the arrest, and the slowest rate of the rising heel."""
    gait, manner = steps.gait, steps.manner
    factor = manner["impact"] * np.exp(variability.impact_cv * noise[11])
    arrest = gait["arrest_time_s"] * manner["arrest"] * np.exp(variability.arrest_cv * noise[12])
    turn = values["flat_pitch_rad"] - values["toe_off_pitch_rad"]
    mean_rate = turn / (steps.toe_off_s - values["contact_s"])
    slow = np.exp(variability.quiet_rate_cv * noise[13]) * manner["quiet_rate"]
    return {
        "impact_forward_m_s": gait["impact_forward_m_s"] * factor,
        "impact_down_m_s": gait["impact_down_m_s"] * factor,
        "arrest_s": arrest,
        "quiet_rate_rad_s": gait["quiet_rate_ratio"] * mean_rate * slow,
    }
