"""The simulated cohort of the intensity study: design, ratings, sway, files, population."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

from swaystride.configuration import load_yaml, plain_values
from swaystride.errors import ConfigurationError
from swaystride.io.reading import read_recording
from swaystride.simulate.intensity_cohort import (
    intensity_tables,
    participant_names,
    rater_assignment,
    truth_of,
)
from swaystride.simulate.intensity_exercises import DIFFICULTY, EXERCISES, choose_exercises
from swaystride.simulate.intensity_fit import rated_rows, rating_statistics
from swaystride.simulate.intensity_parameters import IntensityCohort, cohort_from_config
from swaystride.simulate.intensity_population import population_values
from swaystride.simulate.intensity_ratings import confuse, ordinal
from swaystride.simulate.intensity_recordings import MEASURES, write_patient
from swaystride.simulate.intensity_sway import (
    simulate_features,
    simulate_trial,
    sway_inputs_of,
    trial_generator,
)
from swaystride.simulate.standing_recordings import recorded_duration_s

CONFIG = Path(__file__).parents[2] / "config" / "studies" / "intensity.yaml"


@pytest.fixture(scope="module")
def section() -> dict[str, object]:
    return plain_values(load_yaml(CONFIG)["simulation"])


@pytest.fixture(scope="module")
def cohort(section: dict[str, object]) -> IntensityCohort:
    return cohort_from_config(section)


@pytest.fixture(scope="module")
def small(cohort: IntensityCohort) -> IntensityCohort:
    """Two patients, five exercises, short warm-up: enough for files."""
    return replace(
        cohort,
        protocol=replace(cohort.protocol, n_participants=2, n_exercises=5),
        trial=replace(cohort.trial, warm_up_s=5.0),
    )


def test_there_are_the_printed_54_exercises() -> None:
    assert len(EXERCISES) == 54
    assert len({exercise.name for exercise in EXERCISES}) == 54
    assert not any(e.surface == "foam" and e.stance == "single_leg" for e in EXERCISES)


def test_the_tables_have_the_printed_numbers(cohort: IntensityCohort) -> None:
    tables = intensity_tables(cohort, 5)
    people, raters, ratings = tables.participants, tables.raters, tables.ratings
    groups = people.groupby("group")["age_years"]
    assert_allclose(groups.mean()[["older_adult", "vestibular"]], [69.0, 61.7], atol=0.05)
    assert_allclose(groups.std()[["older_adult", "vestibular"]], [3.6, 25.6], atol=0.1)
    assert people.groupby("group")["sex"].apply(lambda s: (s == "F").sum()).tolist() == [2, 2]
    assert_allclose(
        [raters["experience_years"].mean(), raters["experience_years"].std()], [16, 10], atol=0.06
    )
    assert len(tables.trials) == 450
    whole, own = ratings["trial"].isna(), ratings["rater"] == "self"
    counts = [
        (~whole & ~own).sum(),
        (whole & ~own).sum(),
        (~whole & own).sum(),
        (whole & own).sum(),
    ]
    assert counts == [1935, 645, 450, 150]
    assert ratings["rating"].between(1, 5).all()
    assert not ratings.duplicated(["participant", "exercise", "trial", "rater"]).any()


@pytest.mark.parametrize("seed", range(4))
def test_43_pairs_and_three_to_five_therapists(cohort: IntensityCohort, seed: int) -> None:
    assigned = rater_assignment(cohort, seed)
    counts = [len(set(raters.tolist())) for raters in assigned]
    assert sum(counts) == 43
    assert set(counts) <= {3, 4, 5}
    assert len(set(np.concatenate(assigned).tolist())) == 8


def test_fewer_or_more_patients_change_nobody_else(cohort: IntensityCohort) -> None:
    def of_size(n: int) -> IntensityCohort:
        return replace(cohort, protocol=replace(cohort.protocol, n_participants=n))

    ten, four, twelve = (intensity_tables(of_size(n), 3) for n in (10, 4, 12))
    for other in (four, twelve):
        known = [
            name
            for name in ten.participants["participant"]
            if name in set(other.participants["participant"])
        ]
        for table in ("participants", "trials", "ratings"):
            a, b = getattr(ten, table), getattr(other, table)
            a = a[a["participant"].isin(known)].reset_index(drop=True)
            b = b[b["participant"].isin(known)].reset_index(drop=True)
            pd.testing.assert_frame_equal(a, b)
    assert len(twelve.participants) == 12


def test_exercises_span_the_scale() -> None:
    planned = 1.2 + DIFFICULTY @ [0.6, 0.7, 0.6, 0.1]
    chosen = choose_exercises(
        planned, 15, head_avoidance=0.0, extreme_stance_avoidance=0.0, rng=np.random.default_rng(2)
    )
    assert len(set(chosen.tolist())) == 15
    levels = np.clip(np.round(planned[chosen]), 1, 5)
    # three per level, but for those that lie halfway between two levels
    assert min(np.bincount(levels.astype(int), minlength=6)[1:]) >= 2


def test_avoided_head_movement_becomes_rare_in_hard_exercises() -> None:
    planned = 1.2 + DIFFICULTY @ [0.6, 0.7, 0.6, 0.1]
    rng = np.random.default_rng(3)
    slopes = {}
    for avoidance in (0.0, 1.5):
        drawn = np.concatenate(
            [
                choose_exercises(
                    planned, 15, head_avoidance=avoidance, extreme_stance_avoidance=0.0, rng=rng
                )
                for _ in range(100)
            ]
        )
        slopes[avoidance] = np.polyfit(planned[drawn], DIFFICULTY[drawn, 3], 1)[0]
    assert slopes[1.5] < slopes[0.0] - 0.1


def test_a_number_of_exercises_that_cannot_be_spread_is_an_error() -> None:
    with pytest.raises(ConfigurationError, match="a multiple of 5, at most 54; found 7"):
        choose_exercises(
            np.full(54, 3.0), 7, head_avoidance=0.0, extreme_stance_avoidance=0.0,
            rng=np.random.default_rng(1),
        )  # fmt: skip


def test_thresholds_make_ratings() -> None:
    assert ordinal([-9.0, 1.49, 1.5, 3.0, 4.6], (1.5, 2.5, 3.5, 4.5)).tolist() == [1, 1, 2, 3, 5]


def test_confusion_turns_the_wanted_share_of_ratings() -> None:
    ratings = np.full(20_000, 1)
    turned = confuse(ratings, 0.01, np.random.default_rng(4))
    assert set(turned.tolist()) == {1, 5}
    assert (turned == 5).mean() == pytest.approx(0.01, abs=4 * np.sqrt(0.01 * 0.99 / 20_000))


def test_without_noise_all_therapists_agree_and_the_population_icc_is_one(
    cohort: IntensityCohort,
) -> None:
    quiet = replace(
        cohort.population.therapist,
        rater_sd=0.0, rater_patient_sd=0.0, rater_exercise_sd=0.0,
        trial_noise_sd=0.0, exercise_noise_sd=0.0, confused_share=0.0,
    )  # fmt: skip
    population = replace(cohort.population, therapist=quiet)
    values = population_values(population, cohort.protocol, n_patients=20, seed=1)
    icc = values.set_index("quantity")["value"].filter(like="icc")
    assert_allclose(icc, 1.0, atol=1e-12)


def test_population_icc_is_the_correlation_of_two_therapists(cohort: IntensityCohort) -> None:
    values = population_values(cohort.population, cohort.protocol, n_patients=600, seed=2)
    icc = values.set_index("quantity")["value"]["study3_text/icc_pt_per_exercise"]
    alone = replace(cohort, protocol=replace(cohort.protocol, n_participants=1))
    pairs = np.concatenate(
        [truth_of("P01", alone, seed).therapist_exercise[:, :2] for seed in range(600)]
    )
    assert np.corrcoef(pairs.T)[0, 1] == pytest.approx(icc, abs=0.02)


def test_quick_statistics_of_a_cohort_are_near_its_population(cohort: IntensityCohort) -> None:
    names = participant_names(cohort)
    drawn = []
    for seed in range(60):
        patients = [truth_of(name, cohort, seed) for name in names]
        rows = rated_rows(patients, rater_assignment(cohort, seed), trials=True)
        drawn.append(rating_statistics(rows))
    means, spread = pd.DataFrame(drawn).mean(), pd.DataFrame(drawn).std() / np.sqrt(60)
    values = population_values(cohort.population, cohort.protocol, n_patients=1500, seed=3)
    population = values.set_index("quantity")["value"]
    for ours, theirs in (
        ("stance", "table_3_2/stance/per_trial"),
        ("visual_input", "table_3_2/visual_input/per_trial"),
        ("mean_difference", "study3_text/pt_minus_self_mean_difference_per_trial"),
    ):
        assert abs(means[ours] - population[theirs]) < 4 * spread[ours] + 0.02


def test_a_trial_that_ends_early_is_the_beginning_of_the_full_one(small: IntensityCohort) -> None:
    truth = truth_of("P01", small, 1)
    inputs = sway_inputs_of("P01", truth, small, 1)
    person = {"mass_kg": 70.0, "height_m": 1.7}
    full, short = (
        simulate_trial(
            inputs, 0, 0,
            cohort=replace(
                small,
                population=replace(
                    small.population,
                    sway=replace(small.population.sway, accidental_stop_share=share),
                ),
            ),
            rng=trial_generator(1, "P01", 0, 0),
            **person,
        )
        for share in (0.0, 1.0)
    )  # fmt: skip
    assert short.stop == "by accident"
    n = short.motion.angle_rad.shape[1]
    assert n < full.motion.angle_rad.shape[1]
    assert np.array_equal(short.motion.angle_rad, full.motion.angle_rad[:, :n])
    duration_s = recorded_duration_s(short.motion, small.trial)
    assert small.protocol.shortest_trial_s <= duration_s + 0.02 < small.trial.duration_s


def test_sway_rises_with_intensity(small: IntensityCohort) -> None:
    truth = truth_of("P02", small, 2)
    link = replace(
        small.population.sway, patient_sd=0.0, exercise_sd=0.0, trial_sd=0.0,
        direction_sd_ap=0.0, direction_sd_ml=0.0, activity_sd=0.0, ln_weight_shift=-20.0,
    )  # fmt: skip
    easy, hard = (
        replace(truth, intensity=np.full_like(truth.intensity, level)) for level in (1.0, 3.5)
    )
    plain = replace(small, population=replace(small.population, sway=link))
    person = {"cohort": plain, "mass_kg": 70.0, "height_m": 1.7, "seed": 2}
    medians = [simulate_features("P02", t, **person)["phi_rms"].median() for t in (easy, hard)]
    assert medians[1] > 1.5 * medians[0]


def test_raw_files_and_truth_of_a_patient(small: IntensityCohort, tmp_path: Path) -> None:
    tables = intensity_tables(small, 4)
    truth = write_patient(
        "P01", tables=tables, cohort=small, seed=4, folder=tmp_path, truth_file=tmp_path / "t.tsv"
    )
    own = tables.trials[tables.trials["participant"] == "P01"]
    assert len(truth) == len(own) == 15
    for file, duration_s, lost in zip(
        own["file"], truth["duration_s"], truth["n_lost_packets"], strict=True
    ):
        recording = read_recording(tmp_path / file)
        assert (recording.sizes["time"] - 1) / 100.0 == pytest.approx(
            duration_s, abs=0.011 * (1 + lost)
        )
    person = tables.participants.set_index("participant").loc["P01"]
    features = simulate_features(
        "P01", truth_of("P01", small, 4), cohort=small, seed=4,
        mass_kg=float(person["mass_kg"]), height_m=float(person["height_m"]),
    )  # fmt: skip
    for name in MEASURES:
        assert_allclose(truth[f"true_{name}"], features[name], rtol=1e-12)
    written = pd.read_csv(tmp_path / "t.tsv", sep="\t")
    assert_allclose(written["intensity"], truth["intensity"], rtol=1e-8)


def test_a_misspelt_parameter_is_an_error(section: dict[str, object]) -> None:
    broken = plain_values(load_yaml(CONFIG)["simulation"])
    broken["population"]["sway"]["slope_up"] = broken["population"]["sway"].pop("slope_ap")
    with pytest.raises(ConfigurationError, match="keys do not match what the code takes"):
        cohort_from_config(broken)
    broken = plain_values(load_yaml(CONFIG)["simulation"])
    broken["cohort"]["sensor"] = "mty"
    with pytest.raises(ConfigurationError, match=r"unknown sensor.*found 'mty'"):
        cohort_from_config(broken)
