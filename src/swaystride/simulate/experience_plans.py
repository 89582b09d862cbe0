"""What each run of the simulated experience study is meant to be, before anything is simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.steady_parts import is_steady
from swaystride.simulate.experience_beats import beat_times_s, mean_rate_bpm
from swaystride.simulate.experience_cohort import ExperienceTables, Pattern, pattern_of
from swaystride.simulate.experience_parameters import STUDY, ExperienceCohort
from swaystride.simulate.experience_profiles import drawn_turn, pace_m_s, run_profile
from swaystride.simulate.running_body import RunnerBody, runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import RunnerManner, RunProfile
from swaystride.simulate.running_run import REFERENCE_HEIGHT_M
from swaystride.simulate.running_scatter import drawn_manner, manner_scales
from swaystride.simulate.running_steps import run_steps
from swaystride.simulate.seeds import generator
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

#: Passes in which the duty factor of the manner is shifted; each leaves a few per cent of the error.
_PASSES: Final = 3


@dataclass(frozen=True)
class PlannedRun:
    """What a run is meant to be.

    Parameters
    ----------
    name : str
        Participant and run, as ``P01_01``.
    body : RunnerBody
        Of the participant.
    mass_kg : float
        Of the participant.
    pattern : {"aerial", "terrestrial"}
        Global running pattern.
    duty_factor : float
        Mean over the steady strides, as drawn.
    speed_m_s : float
        Mean over the steady part, as drawn.
    heart_rate_bpm : float
        Mean over the steady part, as drawn.
    manner : RunnerManner
        How the person runs then.
    profile : RunProfile
        Speed and changes.
    turn_s : tuple of float
        Begin and end of the turn.
    excluded : DataFrame
        Parts that are not steady, as from :func:`swaystride.gait.steady_parts.exclusions`.
    """

    name: str
    body: RunnerBody
    mass_kg: float
    pattern: Pattern
    duty_factor: float
    speed_m_s: float
    heart_rate_bpm: float
    manner: RunnerManner
    profile: RunProfile
    turn_s: tuple[float, float]
    excluded: pd.DataFrame

    @property
    def steady_s(self) -> Array:
        """Begin and end of the steady parts, shape (2, 2)."""
        warm_up, turn = self.excluded["stop_s"]
        return np.array([[warm_up, self.excluded["start_s"][1]], [turn, self.profile.time_s[-1]]])


def planned_run(
    run: str, tables: ExperienceTables, cohort: ExperienceCohort, seed: int
) -> PlannedRun:
    """Draw what a run is meant to be.

    Drawn are pattern, mean duty factor, mean speed and mean heart rate over the steady part, the
    manner and its changes. The duty factor of the manner is then shifted until that of the steady
    strides, as they will be simulated, is the drawn one.

    Parameters
    ----------
    run : str
        Name, as ``P01_01``.
    tables : ExperienceTables
        Tables of the whole cohort.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    PlannedRun
    """
    participant = run.split("_")[0]
    people = tables.participants.set_index("participant")
    level, sex = (str(people[name][participant]) for name in ("current_level", "sex"))
    height_m, mass_kg = (float(people[name][participant]) for name in ("height_m", "mass_kg"))
    pattern = pattern_of(run, cohort)
    protocol, course = cohort.protocol, cohort.course
    z_person = generator(seed, STUDY, participant, "levels").standard_normal(2)
    z_run = generator(seed, STUDY, run, "levels").standard_normal(2)
    speed = pace_m_s(
        cohort.pace,
        level=level,
        sex=sex,
        is_terrestrial=pattern == "terrestrial",
        z=(float(z_person[0]), float(z_run[0])),
    )
    turn = drawn_turn(course, generator(seed, STUDY, run, "turn"))
    margin = course.turn_margin_s
    excluded = pd.DataFrame(
        {
            "start_s": [0.0, turn[0] - margin],
            "stop_s": [protocol.warm_up_s, turn[1] + margin],
            "reason": ["warm_up", "turn"],
        }
    )
    planned = PlannedRun(
        name=run,
        body=runner_body(height_m, mass_kg, shares=usual_shares(), shoe=usual_shoe()),
        mass_kg=mass_kg,
        pattern=pattern,
        duty_factor=_drawn_duty(pattern, cohort, generator(seed, STUDY, run, "duty factor")),
        speed_m_s=speed,
        heart_rate_bpm=mean_rate_bpm(cohort.heart, float(z_person[1]), float(z_run[1])),
        manner=_manner(participant, run, cohort, seed),
        profile=run_profile(
            course,
            speed,
            manner_scales(cohort.person),
            turn,
            duration_s=protocol.duration_s,
            warm_up_s=protocol.warm_up_s,
            rng=generator(seed, STUDY, run, "profile"),
        ),
        turn_s=turn,
        excluded=excluded,
    )
    for _ in range(_PASSES):
        missed = planned.duty_factor - _mean_duty(planned, cohort, seed)
        manner = replace(planned.manner, duty_factor=planned.manner.duty_factor + missed)
        planned = replace(planned, manner=manner)
    return planned


def beats_of(planned: PlannedRun, cohort: ExperienceCohort, seed: int) -> Array:
    """Instants of the R-peaks of a run, whether a strap shows them or not.

    Parameters
    ----------
    planned : PlannedRun
        The run.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    return beat_times_s(
        cohort.heart,
        planned.heart_rate_bpm,
        duration_s=cohort.protocol.duration_s,
        warm_up_s=cohort.protocol.warm_up_s,
        steady=planned.steady_s,
        rng=generator(seed, STUDY, planned.name, "heart"),
    )


def _manner(participant: str, run: str, cohort: ExperienceCohort, seed: int) -> RunnerManner:
    """How a participant runs in a run."""
    drawn = drawn_manner(
        cohort.person,
        generator(seed, STUDY, participant, "manner"),
        generator(seed, STUDY, run, "manner"),
    )
    earlier = cohort.push_off.toe_off_pitch_deg * RAD_PER_DEG
    return replace(drawn, toe_off_pitch_rad=drawn.toe_off_pitch_rad + earlier)


def _drawn_duty(pattern: Pattern, cohort: ExperienceCohort, rng: np.random.Generator) -> float:
    """Mean duty factor of a run, within the range of its pattern."""
    mean, sd, ends = (getattr(cohort.duty, f"{pattern}_{part}") for part in ("mean", "sd", "range"))
    while True:
        value = float(mean + sd * rng.standard_normal())
        if ends[0] <= value <= ends[1]:
            return value


def _mean_duty(planned: PlannedRun, cohort: ExperienceCohort, seed: int) -> float:
    """Mean duty factor of the steady strides that this manner will have: of both sides, averaged."""
    steps = run_steps(
        planned.manner,
        planned.profile,
        duration_s=cohort.protocol.duration_s,
        stride_time_scale=float(np.sqrt(planned.body.height_m / REFERENCE_HEIGHT_M)),
        variability=cohort.stride,
        rng=generator(seed, STUDY, planned.name, "motion"),
    )
    means = []
    for side in range(2):
        contact, off = steps.contact_s[side::2], steps.toe_off_s[side::2]
        counts = is_steady(contact[:-1], contact[1:], planned.excluded)
        counts &= (contact[:-1] >= 0.0) & (contact[1:] <= cohort.protocol.duration_s)
        share = (off - contact)[:-1] / np.diff(contact)
        means.append(share[counts].mean())
    return float(np.mean(means))
