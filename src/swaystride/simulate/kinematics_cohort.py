"""The simulated cohort of the kinematics study: runners, what is measured on them, trials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.intensity_people import draw_ages, draw_bodies
from swaystride.simulate.kinematics_parameters import (
    STUDY,
    KinematicsCohort,
    Measuring,
    RunningHistory,
)
from swaystride.simulate.running_body import RunnerBody, runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import RunnerManner
from swaystride.simulate.running_markers import marker_places
from swaystride.simulate.running_scatter import MOST_SD, drawn_manner
from swaystride.simulate.running_sensors import place_point_m
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]

#: Recordings of each trial and the ends of their names, in the order of the table.
KINDS: Final = {
    "running_imu": "running.h5",
    "running_markers": "running.c3d",
    "standing_imu": "standing.h5",
    "standing_markers": "standing.c3d",
}
#: A typical pace is not faster than that of a race, min/km [N].
_LEAST_SLOWER: Final = 0.1
#: Nobody ran regularly before this age, years [N].
_FIRST_AGE: Final = 12.0


@dataclass(frozen=True)
class KinematicsTables:
    """The tables that a lab would keep.

    Parameters
    ----------
    participants, trials : DataFrame
        As docs/your-data.md describes them.
    """

    participants: pd.DataFrame
    trials: pd.DataFrame


def participant_names(cohort: KinematicsCohort) -> list[str]:
    """Names of the participants, ``P01`` onwards.

    Parameters
    ----------
    cohort : KinematicsCohort
        Parameters.
    """
    return [f"P{number:02d}" for number in range(1, cohort.protocol.n_participants + 1)]


def trial_names(cohort: KinematicsCohort) -> list[str]:
    """Names of the trials of a participant, ``01`` onwards.

    Parameters
    ----------
    cohort : KinematicsCohort
        Parameters.
    """
    return [f"{number:02d}" for number in range(1, cohort.protocol.n_trials + 1)]


def body_of(height_m: float, mass_kg: float) -> RunnerBody:
    """Body of a participant.

    Parameters
    ----------
    height_m, mass_kg : float
        Stature and mass.
    """
    return runner_body(height_m, mass_kg, shares=usual_shares(), shoe=usual_shoe())


def manner_of(participant: str, trial: str, cohort: KinematicsCohort, seed: int) -> RunnerManner:
    """How a participant runs in a trial: the person's manner, and a little of the trial's own.

    Parameters
    ----------
    participant, trial : str
        Names.
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    RunnerManner
    """
    return drawn_manner(
        cohort.person,
        generator(seed, STUDY, participant, "manner"),
        generator(seed, STUDY, participant, f"trial {trial}", "manner"),
    )


def true_measures(body: RunnerBody, measuring: Measuring) -> dict[str, float]:
    """Lengths and widths of the legs as a perfect tape and caliper would find them.

    Parameters
    ----------
    body : RunnerBody
        Of whom.
    measuring : Measuring
        What is under a marker.

    Returns
    -------
    dict of str to float
        ``leg_length`` (anterior superior iliac spine to medial malleolus of the straight leg),
        ``knee_width`` and ``ankle_width``, in m.

    Examples
    --------
    >>> found = true_measures(body_of(1.72, 70.0), Measuring(0.0, 0.0, 0.007, 0.002))
    >>> {name: round(value, 3) for name, value in found.items()}
    {'leg_length': 0.943, 'knee_width': 0.102, 'ankle_width': 0.072}
    """
    places = marker_places()
    above_skin = measuring.marker_radius_m + measuring.base_plate_m
    knee = place_point_m(places["RKNE"], body)[2] - above_skin
    ankle = place_point_m(places["RANK"], body)[2] - above_skin
    spine = place_point_m(places["RASI"], body) - [above_skin, 0.0, 0.0]
    malleolus = np.array([0.0, -body.leg_m, body.hip_distance_m / 2.0 - ankle])
    return {
        "leg_length": float(np.linalg.norm(spine - malleolus)),
        "knee_width": 2.0 * float(knee),
        "ankle_width": 2.0 * float(ankle),
    }


def kinematics_tables(cohort: KinematicsCohort, seed: int) -> KinematicsTables:
    """Participants and trials, as a lab would keep them.

    Parameters
    ----------
    cohort : KinematicsCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    KinematicsTables
        One row per person, and one per recording.
    """
    names = participant_names(cohort)
    ages, sexes = draw_ages(cohort.people, len(names), generator(seed, STUDY, "people"))
    people = [
        _person(name, sex, age, cohort, seed)
        for name, sex, age in zip(names, sexes, ages.tolist(), strict=True)
    ]
    rows = [
        {
            "participant": name,
            "trial": trial,
            "kind": kind,
            "file": f"{name}/{name}_{trial}_{end}",
            "belt_speed_m_s": cohort.protocol.belt_speed_m_s if "running" in kind else 0.0,
            "exclude": "",
        }
        for name in names
        for trial in trial_names(cohort)
        for kind, end in KINDS.items()
    ]
    return KinematicsTables(pd.DataFrame(people), pd.DataFrame(rows))


def _person(name: str, sex: str, age: float, cohort: KinematicsCohort, seed: int) -> dict[str, Any]:
    """One row of the participants."""
    height, mass = draw_bodies(cohort.bodies, sex, generator(seed, STUDY, name, "body"))
    row: dict[str, Any] = {
        "participant": name,
        "sex": sex,
        "age_years": age,
        "height_m": height,
        "mass_kg": mass,
    }
    rng = generator(seed, STUDY, name, "measures")
    for measure, true in true_measures(body_of(height, mass), cohort.measuring).items():
        sd = cohort.measuring.leg_length_sd_m
        if measure != "leg_length":
            sd = cohort.measuring.width_sd_m
        for side in ("right", "left"):
            error = sd * float(np.clip(rng.standard_normal(), -MOST_SD, MOST_SD))
            row[f"{measure}_{side}_m"] = round(true + error, 3)
    history = reported_history(cohort.history, age, generator(seed, STUDY, name, "history"))
    return row | history


def reported_history(
    history: RunningHistory, age_years: float, rng: np.random.Generator
) -> dict[str, str]:
    """Years of running, typical pace and race time of one person, as people write them.

    Parameters
    ----------
    history : RunningHistory
        Distribution.
    age_years : float
        Age of the person.
    rng : numpy.random.Generator
        The person's own.

    Returns
    -------
    dict of str to str
        Columns of Table 4.1: years such as ``5`` or ``>15``, pace such as ``4:40`` or
        ``4:50-5:10``, time such as ``20:22`` or nothing.
    """
    z = np.clip(rng.standard_normal(3), -MOST_SD, MOST_SD)
    with_range, no_race = rng.random(2) < (history.pace_range_share, history.no_race_share)
    years = history.years_median * np.exp(history.years_log_sd * z[0])
    whole = max(1, round(min(float(years), age_years - _FIRST_AGE)))
    race_min = history.race_5km_mean_min + history.race_5km_sd_min * z[1]
    slower = history.slower_mean_min_per_km + history.slower_sd_min_per_km * z[2]
    # People round their pace to 5 seconds.
    pace_s = 5.0 * round(12.0 * float(race_min / 5.0 + max(slower, _LEAST_SLOWER)))
    paces = [pace_s]
    if with_range:
        paces = [pace_s - history.pace_range_s_per_km, pace_s + history.pace_range_s_per_km]
    return {
        "years_running": f">{history.years_at_most}"
        if whole > history.years_at_most
        else f"{whole}",
        "typical_pace_min_per_km": "-".join(map(_minutes, paces)),
        "race_5km_min": "" if no_race else _minutes(60.0 * float(race_min)),
    }


def _minutes(seconds: float) -> str:
    """Seconds as minutes and seconds, such as ``4:40``."""
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d}"
