"""The simulated cohort of the IMU-design study: people, trials, mean speeds."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.foot_person import Person, draw_person
from swaystride.simulate.imu_design_parameters import STUDY, ImuDesignCohort
from swaystride.simulate.intensity_people import draw_ages, draw_bodies
from swaystride.simulate.seeds import generator

Array = NDArray[np.float64]

FEET: Final = ("left", "right")
IMUS: Final = ("imu_1", "imu_2")


@dataclass(frozen=True)
class ImuDesignTables:
    """The tables that a lab would keep.

    Parameters
    ----------
    participants, trials : DataFrame
        As docs/your-data.md describes them.
    """

    participants: pd.DataFrame
    trials: pd.DataFrame


def participant_names(cohort: ImuDesignCohort) -> list[str]:
    """Names of the participants, ``P01`` onwards.

    Parameters
    ----------
    cohort : ImuDesignCohort
        Parameters.
    """
    return [f"P{number:02d}" for number in range(1, cohort.protocol.n_participants + 1)]


def trial_names(cohort: ImuDesignCohort) -> list[str]:
    """Names of the trials of a participant, ``01`` onwards.

    Parameters
    ----------
    cohort : ImuDesignCohort
        Parameters.
    """
    count = cohort.protocol.n_walking + cohort.protocol.n_running
    return [f"{number:02d}" for number in range(1, count + 1)]


def mean_speeds(participant: str, cohort: ImuDesignCohort, seed: int) -> Array:
    """Mean speeds of the trials of one participant, walking and then running, each rising.

    Parameters
    ----------
    participant : str
        Name.
    cohort : ImuDesignCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    ndarray, shape (n_trials,)
        In m/s.
    """
    protocol = cohort.protocol
    rng = generator(seed, STUDY, participant, "speeds")
    parts = []
    for count, slow, fast in (
        (protocol.n_walking, protocol.slow_walk_m_s, protocol.fast_walk_m_s),
        (protocol.n_running, protocol.slow_run_m_s, protocol.sprint_m_s),
    ):
        speeds = np.linspace(rng.uniform(*slow), rng.uniform(*fast), count)
        jitter = protocol.speed_jitter * rng.uniform(-1.0, 1.0, size=count)
        if count > 2:
            step = speeds[1] - speeds[0]
            speeds[1:-1] += step * jitter[1:-1]
        parts.append(speeds)
    return np.concatenate(parts)


def person_of(participant: str, height_m: float, cohort: ImuDesignCohort, seed: int) -> Person:
    """Feet of one participant.

    Parameters
    ----------
    participant : str
        Name.
    height_m : float
        Stature.
    cohort : ImuDesignCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    return draw_person(
        height_m,
        shape=cohort.sole,
        placement=cohort.placement,
        scatter=cohort.person,
        rng=generator(seed, STUDY, participant, "feet"),
    )


def imu_design_tables(cohort: ImuDesignCohort, seed: int) -> ImuDesignTables:
    """Participants and trials, as a lab would keep them.

    Parameters
    ----------
    cohort : ImuDesignCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    ImuDesignTables
        One row per person, and one per recording.
    """
    names = participant_names(cohort)
    ages, sexes = draw_ages(cohort.people, len(names), generator(seed, STUDY, "people"))
    bodies = [
        draw_bodies(cohort.bodies, sex, generator(seed, STUDY, name, "body"))
        for name, sex in zip(names, sexes, strict=True)
    ]
    participants = pd.DataFrame(
        {
            "participant": names,
            "sex": sexes,
            "age_years": ages,
            "height_m": [height for height, _ in bodies],
            "mass_kg": [mass for _, mass in bodies],
        }
    )
    rows = [
        {
            "participant": name,
            "trial": trial,
            "foot": foot,
            "imu": imu,
            "file": f"{name}/{name}_{trial}_{foot}_{imu}.csv",
            "distance_m": cohort.course.distance_m,
            "exclude": "",
        }
        for name in names
        for trial in trial_names(cohort)
        for foot in FEET
        for imu in IMUS
    ]
    return ImuDesignTables(participants, pd.DataFrame(rows))
