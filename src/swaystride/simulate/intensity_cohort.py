"""The simulated cohort of the intensity study: patients, therapists, exercises, ratings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.simulate.intensity_exercises import EXERCISES
from swaystride.simulate.intensity_parameters import STUDY, IntensityCohort
from swaystride.simulate.intensity_people import (
    PatientGroup,
    draw_ages,
    draw_bodies,
    draw_experience,
)
from swaystride.simulate.intensity_ratings import (
    PatientTruth,
    draw_exercise_effects,
    draw_patient,
    draw_rater_effects,
)
from swaystride.simulate.seeds import generator

#: Groups of patients, in the order of :func:`group_of`.
GROUPS: Final = ("older_adult", "vestibular")


@dataclass(frozen=True)
class IntensityTables:
    """The tables that a lab would keep.

    Parameters
    ----------
    participants, raters, trials, ratings : DataFrame
        As docs/your-data.md describes them.
    """

    participants: pd.DataFrame
    raters: pd.DataFrame
    trials: pd.DataFrame
    ratings: pd.DataFrame


def participant_names(cohort: IntensityCohort) -> list[str]:
    """Names of the patients, ``P01`` onwards.

    Parameters
    ----------
    cohort : IntensityCohort
        Parameters.
    """
    return [f"P{number:02d}" for number in range(1, cohort.protocol.n_participants + 1)]


def group_of(number: int, cohort: IntensityCohort) -> str:
    """Group of patient `number` (from 0): the two groups are spread evenly over the study.

    Parameters
    ----------
    number : int
        Position of the patient.
    cohort : IntensityCohort
        Sizes of the groups.
    """
    n_printed = cohort.older_adult.n + cohort.vestibular.n
    before, after = (
        round(cohort.vestibular.n * count / n_printed) for count in (number, number + 1)
    )
    return GROUPS[after - before]


def truth_of(participant: str, cohort: IntensityCohort, seed: int) -> PatientTruth:
    """What is true of one patient, all therapists' ratings included.

    Parameters
    ----------
    participant : str
        Name of the patient.
    cohort : IntensityCohort
        Parameters.
    seed : int
        Seed of the cohort.
    """
    population, protocol = cohort.population, cohort.protocol
    return draw_patient(
        population,
        exercise_effects=draw_exercise_effects(population, generator(seed, STUDY, "exercises")),
        rater_effects=draw_rater_effects(
            population, protocol.n_raters, generator(seed, STUDY, "raters")
        ),
        n_exercises=protocol.n_exercises,
        n_trials=protocol.n_trials,
        rng=generator(seed, STUDY, participant, "truth"),
    )


def rater_assignment(cohort: IntensityCohort, seed: int) -> list[NDArray[np.intp]]:
    """Which therapists rate which patient, in rising order (dissertation §3.3.3.2).

    The printed number of patients shares the printed number of pairs; a smaller cohort is its
    first part. Therapists are drawn at random among those with the fewest patients so far.

    Parameters
    ----------
    cohort : IntensityCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    list of ndarray of int
        Indices of the therapists, one array per patient.
    """
    protocol = cohort.protocol
    rng = generator(seed, STUDY, "assignment")
    counts = _raters_per_patient(cohort, rng)
    load = np.zeros(protocol.n_raters)
    assigned = []
    for count in counts[: protocol.n_participants]:
        order = np.lexsort((rng.random(protocol.n_raters), load))
        chosen = np.sort(order[:count])
        load[chosen] += 1
        assigned.append(chosen)
    return assigned


def _raters_per_patient(cohort: IntensityCohort, rng: np.random.Generator) -> list[int]:
    """Numbers of therapists per patient, within their range and with the printed sum."""
    low, high = cohort.protocol.raters_per_participant
    n_printed = cohort.older_adult.n + cohort.vestibular.n
    counts = np.full(n_printed, cohort.protocol.n_pairs // n_printed)
    counts[: cohort.protocol.n_pairs % n_printed] += 1
    counts = rng.permutation(counts)
    # A few exchanges spread the numbers over their range without changing the sum.
    for _ in range(n_printed // 2):
        giver, taker = rng.choice(n_printed, size=2, replace=False)
        if counts[giver] > low and counts[taker] < high:
            counts[giver] -= 1
            counts[taker] += 1
    extra = max(cohort.protocol.n_participants - n_printed, 0)
    # spawned: further patients must not move the draws of the printed ones
    further = rng.spawn(1)[0].integers(low, high + 1, size=extra)
    return [*counts.tolist(), *further.tolist()]


def intensity_tables(cohort: IntensityCohort, seed: int) -> IntensityTables:
    """Patients, therapists, trials and ratings, as a lab would keep them.

    Parameters
    ----------
    cohort : IntensityCohort
        Parameters.
    seed : int
        Seed of the cohort.

    Returns
    -------
    IntensityTables
    """
    protocol = cohort.protocol
    names = participant_names(cohort)
    raters = [f"T{number}" for number in range(1, protocol.n_raters + 1)]
    trials, ratings = [], []
    for name, assigned in zip(names, rater_assignment(cohort, seed), strict=True):
        truth = truth_of(name, cohort, seed)
        trials.append(trial_rows(name, truth))
        ratings.append(rating_rows(name, truth, {raters[i]: int(i) for i in assigned}))
    experience = draw_experience(cohort.therapists, generator(seed, STUDY, "experience"))
    return IntensityTables(
        participants=_participants(names, cohort, seed),
        raters=pd.DataFrame({"rater": raters, "experience_years": experience}),
        trials=pd.concat(trials, ignore_index=True),
        ratings=pd.concat(ratings, ignore_index=True),
    )


def trial_rows(participant: str, truth: PatientTruth) -> pd.DataFrame:
    """Rows of trials.tsv of one patient, in the order of the session.

    Parameters
    ----------
    participant : str
        Name of the patient.
    truth : PatientTruth
        Of this patient.
    """
    rows = [
        {
            "participant": participant,
            "exercise": EXERCISES[index].name,
            "exercise_order": order,
            "trial": trial,
            "surface": EXERCISES[index].surface,
            "stance": EXERCISES[index].stance,
            "vision": EXERCISES[index].vision,
            "head": EXERCISES[index].head,
            "file": f"{participant}/{participant}_{order:02d}_{trial}.txt",
            "note": "",
        }
        for order, index in enumerate(truth.exercises.tolist(), start=1)
        for trial in range(1, truth.intensity.shape[1] + 1)
    ]
    return pd.DataFrame(rows)


def rating_rows(participant: str, truth: PatientTruth, raters: dict[str, int]) -> pd.DataFrame:
    """Rows of ratings.tsv of one patient: each trial and each exercise, by each rater.

    Parameters
    ----------
    participant : str
        Name of the patient.
    truth : PatientTruth
        Of this patient.
    raters : dict of str to int
        Name of each assigned therapist, and the position in the arrays of `truth`.
    """
    rows: list[tuple[str, int | None, str, int]] = []
    for e, index in enumerate(truth.exercises.tolist()):
        name = EXERCISES[index].name
        for t in range(truth.intensity.shape[1]):
            rows.append((name, t + 1, "self", int(truth.self_trial[e, t])))
            rows += [
                (name, t + 1, r, int(truth.therapist_trial[e, t, i])) for r, i in raters.items()
            ]
        rows.append((name, None, "self", int(truth.self_exercise[e])))
        rows += [(name, None, r, int(truth.therapist_exercise[e, i])) for r, i in raters.items()]
    table = pd.DataFrame(rows, columns=["exercise", "trial", "rater", "rating"])
    table.insert(0, "participant", participant)
    return table.astype({"trial": "Int64"})


def _participants(names: list[str], cohort: IntensityCohort, seed: int) -> pd.DataFrame:
    """Table of the patients; a group's printed size is drawn as a whole, further ones alone."""
    groups = [group_of(number, cohort) for number in range(len(names))]
    table = pd.DataFrame({"participant": names, "group": groups})
    parts = []
    for group in GROUPS:
        rows = np.flatnonzero(table["group"] == group)
        parameters: PatientGroup = getattr(cohort, group)
        ages, sexes = draw_ages(parameters, len(rows), generator(seed, STUDY, "people", group))
        bodies = [
            draw_bodies(cohort.bodies, sex, generator(seed, STUDY, names[row], "body"))
            for row, sex in zip(rows, sexes, strict=True)
        ]
        part = pd.DataFrame(
            {
                "age_years": ages,
                "sex": sexes,
                "height_m": [height for height, _ in bodies],
                "mass_kg": [mass for _, mass in bodies],
            },
            index=pd.Index(rows),
        )
        parts.append(part)
    return table.join(pd.concat(parts))
