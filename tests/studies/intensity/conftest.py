"""A small synthetic cohort: a latent intensity drives ratings, self-ratings and sway alike."""

from itertools import product

import numpy as np
import pandas as pd
import pytest

from swaystride.io.study_tables import write_study_table
from swaystride.studies.intensity.design import DIFFICULTY_CODES, SELF, read_design
from swaystride.studies.intensity.observations import analysed_ratings
from swaystride.studies.intensity.plan import FEATURES, IntensityPlan

#: Log of each feature at intensity 0, and its rise per level of intensity.
SWAY = dict(zip(FEATURES, product((0.0, 0.3, -0.2, 0.5, 0.4, 0.2, 3.9, 1.5), (0.35,)), strict=True))
DIFFICULTY_EFFECTS = (0.4, 0.6, 0.6, -0.2)


def make_plan(**changes):
    values = {
        "icc_form": "recommended",
        "estimator": "ml",
        "degrees_of_freedom": "residual",
        "exercise_within_patient": False,
        "prediction_transform": "none",
        "ellipse_measure": "ellipse_area",
        "icc_bootstrap_n": 8,
        "icc_bootstrap_seed": 5,
        "cluster_bootstrap_n": 60,
        "cluster_bootstrap_seed": 11,
        "confidence_level": 0.95,
        "significance_level": 0.05,
        "processes": 1,
    }
    return IntensityPlan(**(values | changes))


def draw_cohort(seed, *, n_patients=6, n_exercises=8, n_raters=4, raters_per_patient=3):
    """Study tables and sway measures of a cohort.

    Returns participants, raters, trials, ratings (as a lab would keep them) and measures.
    """
    rng = np.random.default_rng(seed)
    combinations = list(product(*(codes for _, codes in DIFFICULTY_CODES.values())))
    patients = [f"P{number:02d}" for number in range(1, n_patients + 1)]
    raters = [f"R{number}" for number in range(1, n_raters + 1)]
    bias = dict(zip([*raters, SELF], [*rng.normal(0, 0.2, n_raters), -0.3], strict=True))
    trials, ratings, measures = [], [], []
    for patient, ability in zip(patients, rng.normal(0, 0.5, n_patients), strict=True):
        chosen = rng.choice(len(combinations), n_exercises, replace=False)
        judges = [*rng.choice(raters, raters_per_patient, replace=False), SELF]
        for order, at in enumerate(chosen, start=1):
            levels = combinations[at]
            codes = [
                DIFFICULTY_CODES[name][1][level]
                for name, level in zip(DIFFICULTY_CODES, levels, strict=True)
            ]
            whole = 0.2 + ability + np.dot(DIFFICULTY_EFFECTS, codes) + rng.normal(0, 0.6)
            latent = whole + rng.normal(0, 0.4, 3)
            exercise = "-".join(levels)
            for trial in (1, 2, 3):
                trials.append(
                    (patient, exercise, order, trial, *levels, f"{patient}/{order}_{trial}.txt")
                )
                logs = np.array([a + b * latent[trial - 1] for a, b in SWAY.values()])
                features = np.exp(logs + rng.normal(0, 0.15, len(FEATURES)))
                name = f"exercise_{order:02d}_trial_{trial}"
                measures.append((patient, name, 29.99, *features, 1.5 * features[-1]))
            for judge, trial in product(judges, (1, 2, 3, None)):
                value = latent.mean() if trial is None else latent[trial - 1]
                noisy = value + bias[judge] + rng.normal(0, 0.4)
                rating = int(np.clip(np.floor(noisy + 0.5), 1, 5))
                ratings.append((patient, exercise, trial, judge, rating))
    people = pd.DataFrame(
        {
            "participant": patients,
            "group": ["older_adult", "vestibular"] * (n_patients // 2),
            "age_years": 60.0 + np.arange(n_patients),
            "sex": ["F", "F", "M"] * (n_patients // 3),
            "height_m": 1.7,
            "mass_kg": 70.0,
        }
    )
    therapists = pd.DataFrame({"rater": raters, "experience_years": 5.0 * np.arange(n_raters)})
    columns = ["participant", "exercise", "exercise_order", "trial"]
    columns += [column for column, _ in DIFFICULTY_CODES.values()]
    return (
        people,
        therapists,
        pd.DataFrame(trials, columns=[*columns, "file"]),
        pd.DataFrame(
            ratings, columns=["participant", "exercise", "trial", "rater", "rating"]
        ).astype({"trial": "Int64"}),
        pd.DataFrame(
            measures,
            columns=["participant", "trial", "duration_s", *FEATURES, "ellipse_area_prediction"],
        ),
    )


def write_cohort(folder, tables):
    names = ("participants", "raters", "trials", "ratings")
    for name, table in zip(names, tables, strict=False):
        write_study_table(table, folder / f"{name}.tsv")


def sway_of(trials, measures):
    """Features by the number of the trial, as the analysis sees them."""
    names = [
        f"exercise_{order:02d}_trial_{trial}"
        for order, trial in zip(trials["exercise_order"], trials["trial"], strict=True)
    ]
    key = trials[["participant", "exercise"]].assign(number=trials["trial"], trial=names)
    joined = key.merge(measures, on=["participant", "trial"], validate="one_to_one")
    return joined.drop(columns="trial").rename(columns={"number": "trial"})


@pytest.fixture(scope="session")
def plan():
    return make_plan()


@pytest.fixture(scope="session")
def cohort_tables():
    return draw_cohort(3)


@pytest.fixture(scope="session")
def design(cohort_tables, tmp_path_factory):
    folder = tmp_path_factory.mktemp("intensity")
    write_cohort(folder, cohort_tables)
    return read_design(folder)


@pytest.fixture(scope="session")
def ratings(design):
    return analysed_ratings(design)


@pytest.fixture(scope="session")
def sway(cohort_tables):
    return sway_of(cohort_tables[2], cohort_tables[4])


@pytest.fixture(scope="session")
def make_cohort():
    """The generator itself, for tests that need other sizes."""
    return draw_cohort


@pytest.fixture(scope="session")
def write_tables():
    return write_cohort


@pytest.fixture(scope="session")
def plan_with():
    """A plan with some choices changed."""
    return make_plan
