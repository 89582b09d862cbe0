"""Participants and trials of the simulated cohort."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from swaystride.simulate.feedback_cohort import design_rows, design_tables
from swaystride.simulate.feedback_recordings import lost_trials

TABLE_2_1 = pd.read_csv(Path(__file__).parents[2] / "data" / "published" / "table_2_1.csv")


def demo(cohort, n, n_short=0):
    return replace(cohort, protocol=replace(cohort.protocol, n_participants=n, n_short=n_short))


@pytest.mark.parametrize("seed", range(20))
def test_groups_are_those_of_table_2_1_to_the_printed_digits(cohort, seed):
    participants, _ = design_tables(cohort, seed)
    for printed in TABLE_2_1.itertuples():
        group = participants[participants["order"] == printed.group]
        assert len(group) == printed.n
        assert (group["sex"] == "F").sum() == printed.n_female
        assert round(group["age_years"].mean(), 1) == printed.age_mean
        assert round(group["age_years"].std(), 1) == printed.age_sd
        assert round(group["height_m"].mean(), 2) == printed.height_m_mean
        assert round(group["height_m"].std(), 2) == printed.height_m_sd
        assert round(group["mass_kg"].mean()) == printed.mass_kg_mean
        assert round(group["mass_kg"].std()) == printed.mass_kg_sd


def test_the_configured_groups_are_the_printed_ones(cohort):
    for printed in TABLE_2_1.itertuples():
        group = getattr(cohort, printed.group)
        assert (group.n, group.n_female) == (printed.n, printed.n_female)
        assert (group.age_mean_years, group.age_sd_years) == (printed.age_mean, printed.age_sd)
        assert (group.height_mean_m, group.height_sd_m) == (
            printed.height_m_mean,
            printed.height_m_sd,
        )
        assert (group.mass_mean_kg, group.mass_sd_kg) == (printed.mass_kg_mean, printed.mass_kg_sd)


def test_design_has_708_trials_and_alternating_orders(cohort):
    participants, trials = design_tables(cohort, 1)
    assert participants["participant"].tolist() == [f"P{i:02d}" for i in range(1, 20)]
    assert participants["order"].tolist()[:3] == [
        "concurrent_first",
        "terminal_first",
        "concurrent_first",
    ]
    counts = trials.groupby("participant").size()
    assert counts.tolist() == [36] * 7 + [38] * 12
    assert len(trials) == 708
    assert trials["file"].is_unique
    assert trials.iloc[0]["file"] == "P01/P01_01.txt"


def test_short_sessions_lack_the_trials_that_the_document_names(cohort):
    _, trials = design_tables(cohort, 1)
    for participant, rows in trials.groupby("participant"):
        counts = rows.groupby(["feedback", "phase"]).size()
        short = participant <= "P07"
        assert counts["concurrent", "baseline"] == (3 if short else 4)
        assert counts["terminal", "training"] == (14 if short else 15)
        assert counts["terminal", "baseline"] == 4
        assert counts["concurrent", "training"] == 15
        assert rows["session_trial"].tolist() == list(range(1, len(rows) + 1))


def test_feedback_is_shown_in_two_of_three_training_trials(cohort):
    _, trials = design_tables(cohort, 1)
    training = trials[trials["phase"] == "training"]
    third = training["trial_in_set"] == 3
    assert (training.loc[third, "feedback_shown"] == "none").all()
    assert (training.loc[~third, "feedback_shown"] == training.loc[~third, "feedback"]).all()
    assert (trials.loc[trials["phase"] == "baseline", "feedback_shown"] == "none").all()
    assert trials.loc[trials["phase"] == "baseline", "set"].isna().all()


def test_coding_against_a_table_by_hand(cohort):
    small = replace(
        cohort,
        protocol=replace(
            cohort.protocol, n_participants=2, n_short=0, baseline_trials=1, training_sets=1
        ),
    )
    participants, trials = design_tables(small, 1)
    rows = design_rows(participants, trials, small)
    columns = [
        "participant",
        "order",
        "block",
        "trial_number",
        "concurrent_feedback_removed",
        "terminal_feedback_removed",
    ]
    by_hand = [
        # concurrent first: baseline, two with feedback, one without; then the terminal block
        ["P01", 0, 1, 0, 0, 0],
        ["P01", 0, 1, 1, 0, 0],
        ["P01", 0, 1, 2, 0, 0],
        ["P01", 0, 1, 3, 1, 0],
        ["P01", 0, 0, 3, 0, 0],
        ["P01", 0, 0, 4, 0, 0],
        ["P01", 0, 0, 5, 0, 0],
        ["P01", 0, 0, 6, 0, 1],
        # terminal first
        ["P02", 1, 0, 0, 0, 0],
        ["P02", 1, 0, 1, 0, 0],
        ["P02", 1, 0, 2, 0, 0],
        ["P02", 1, 0, 3, 0, 1],
        ["P02", 1, 1, 3, 0, 0],
        ["P02", 1, 1, 4, 0, 0],
        ["P02", 1, 1, 5, 0, 0],
        ["P02", 1, 1, 6, 1, 0],
    ]
    assert rows[columns].to_numpy().tolist() == by_hand
    assert rows["age"].tolist()[0] == participants["age_years"][0]
    assert rows["sex"].tolist()[8] == float(participants["sex"][1] == "M")
    height = rows["pendulum_height_m"].to_numpy()
    assert height[0] == pytest.approx(0.523 * participants["height_m"][0])


def test_published_trial_numbers(cohort):
    rows = design_rows(*design_tables(cohort, 1), cohort)
    full = rows[rows["participant"] == "P19"]
    assert full["trial_number"].tolist() == [0] * 4 + list(range(1, 16)) + [15] * 4 + list(
        range(16, 31)
    )
    assert full["concurrent_feedback_removed"].sum() == 5
    assert full["terminal_feedback_removed"].sum() == 5


@pytest.mark.parametrize("n", [1, 2, 3, 4, 7, 40])
def test_any_size_is_sensible(cohort, n):
    participants, trials = design_tables(demo(cohort, n, n_short=1), 3)
    assert len(participants) == n
    assert len(trials) == 38 * n - 2
    assert participants["age_years"].between(50, 95).all()
    assert participants["height_m"].between(1.35, 1.99).all()
    assert participants["mass_kg"].between(25, 140).all()
    assert set(participants["sex"]) <= {"F", "M"}
    if n >= 19:
        assert (participants["sex"] == "F").mean() == pytest.approx(12 / 19, abs=0.2)


@pytest.mark.parametrize("n", [2, 6, 18])
def test_a_further_participant_changes_nobody_else(cohort, n):
    """Cohorts of any size share their first participants and those participants' trials."""
    small, larger = (design_tables(demo(cohort, m, n_short=1), 3) for m in (n, n + 5))
    for few, many in zip(small, larger, strict=True):
        shared = many[many["participant"].isin(few["participant"])]
        pd.testing.assert_frame_equal(shared.reset_index(drop=True), few)


def test_a_20th_participant_does_not_move_the_lost_trials(cohort):
    keys = ["participant", "session_trial"]
    for seed in range(5):
        lost = [
            lost_trials(design_tables(c, seed)[1], c, seed)[keys].to_numpy().tolist()
            for c in (cohort, demo(cohort, 25, n_short=7))
        ]
        assert lost[0] == lost[1]


def test_tables_depend_on_nothing_but_the_seed(cohort):
    first, second = design_tables(cohort, 8), design_tables(cohort, 8)
    for a, b in zip(first, second, strict=True):
        pd.testing.assert_frame_equal(a, b)
    other, _ = design_tables(cohort, 9)
    assert not np.array_equal(first[0]["age_years"], other["age_years"])


def test_tall_people_are_heavier_on_average(cohort):
    correlations = [
        design_tables(cohort, seed)[0][["height_m", "mass_kg"]].corr().iloc[0, 1]
        for seed in range(60)
    ]
    assert 0.3 < np.mean(correlations) < 0.6
