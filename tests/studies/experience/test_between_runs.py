"""Associations between runs: identities, an independent fit, resampled runners, missing values."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy.stats import false_discovery_control, pearsonr

from swaystride.stats.cluster_bootstrap import cluster_bootstrap, cluster_codes, cluster_weights
from swaystride.studies.experience.between_runs import (
    ASSOCIATION_COLUMNS,
    BetweenRules,
    ClusterRule,
    association,
    associations,
    resampled_correlations,
)
from swaystride.studies.experience.plan import MEASURE_KEYS, SCALES

PEOPLE = np.repeat([f"P{at:02d}" for at in range(1, 13)], [3, 2, 2, 1, 3, 1, 2, 2, 1, 2, 3, 1])
RULES = BetweenRules(0.95, ClusterRule(True, 200, 7))
WITHOUT_RESAMPLING = BetweenRules(0.95, ClusterRule(False, 200, 7))


@pytest.fixture
def observations():
    """23 runs of 12 runners, 18 of them aerial, two without heart rate."""
    rng = np.random.default_rng(6)
    n = len(PEOPLE)
    table = pd.DataFrame(rng.normal(size=(n, len(MEASURE_KEYS))), columns=list(MEASURE_KEYS))
    table["affective_valence"] = 0.6 * table["speed_m_s"] + rng.normal(size=n)
    table["activity_enjoyment"] = 94 + 14 * rng.normal(size=n)
    table["flow"] = 71 + 8 * rng.normal(size=n)
    table["participant"] = PEOPLE
    table["pattern"] = np.where(np.arange(n) % 5 == 4, "terrestrial", "aerial")
    table.loc[[0, 22], "pattern"] = "intermediate"
    table.loc[[1, 7], "heart_rate_bpm"] = np.nan
    return table


def one_row(table, measure, scale):
    return association(table[measure], table[scale], table["participant"], RULES)


def test_every_measure_meets_every_scale_in_both_groups(observations):
    table = associations(observations, RULES)
    assert list(table) == list(ASSOCIATION_COLUMNS)
    assert len(table) == 2 * 37 * 3
    n_aerial = int((observations["pattern"] == "aerial").sum())
    for group, n in (("all", 23), ("aerial", n_aerial)):
        own = table[table["group"] == group]
        keys = list(zip(own["measure"], own["scale"], strict=True))
        assert keys == [(measure, scale) for measure in MEASURE_KEYS for scale in SCALES]
        assert set(own.loc[own["measure"] != "heart_rate_bpm", "n"]) == {n}
        assert set(own.loc[own["measure"] == "heart_rate_bpm", "n"]) == {n - 2}
        np.testing.assert_allclose(own["q"], false_discovery_control(own["p"]), atol=1e-14)


def test_beta_over_r_is_the_standard_deviation_of_the_rating(observations):
    table = associations(observations, WITHOUT_RESAMPLING)
    np.testing.assert_allclose(table["beta"] / table["r"], table["rating_sd"], rtol=1e-9)
    hearts = table[(table["measure"] == "heart_rate_bpm") & (table["group"] == "all")]
    for scale in SCALES:
        known = observations.loc[observations["heart_rate_bpm"].notna(), scale]
        own = hearts.loc[hearts["scale"] == scale, "rating_sd"].item()
        assert own == pytest.approx(known.std(ddof=1), rel=1e-12)


def test_a_row_agrees_with_scipy_and_statsmodels(observations):
    row = one_row(observations, "speed_m_s", "affective_valence")
    x, y = observations["speed_m_s"], observations["affective_valence"]
    theirs = pearsonr(x, y)
    assert row["r"] == pytest.approx(theirs.statistic, abs=1e-12)
    assert row["p"] == pytest.approx(theirs.pvalue, rel=1e-9)
    limits = theirs.confidence_interval(0.95)
    assert (row["ci_low"], row["ci_high"]) == pytest.approx((limits.low, limits.high), abs=1e-12)
    line = sm.OLS(y, sm.add_constant((x - x.mean()) / x.std(ddof=1))).fit()
    assert row["beta"] == pytest.approx(line.params.iloc[1], rel=1e-10)
    assert row["p"] == pytest.approx(line.pvalues.iloc[1], rel=1e-8)


def test_resampled_correlations_are_those_of_the_rows_drawn(observations):
    x, y = (observations[name].to_numpy() for name in ("speed_m_s", "flow"))
    codes, labels = cluster_codes(PEOPLE)
    weights = cluster_weights(len(labels), 50, 3).astype(float)
    plain = cluster_bootstrap(
        lambda rows: np.corrcoef(x[rows], y[rows])[0, 1], PEOPLE, n=50, seed=3
    )
    found = resampled_correlations(x, y, codes, weights)
    np.testing.assert_allclose(found, plain, atol=1e-12)


def test_runs_that_repeat_each_other_widen_the_interval_over_runners():
    """Three equal runs of each of 12 people hold no more than one; Fisher's interval does not see it."""
    rng = np.random.default_rng(1)
    once = rng.normal(size=(12, 2)) @ np.array([[1.0, 0.5], [0.0, 0.8]])
    runs = pd.DataFrame(np.repeat(once, 3, axis=0), columns=["speed_m_s", "flow"])
    runs["participant"] = np.repeat([f"P{at}" for at in range(12)], 3)
    thrice = one_row(runs, "speed_m_s", "flow")
    single = one_row(runs.iloc[::3], "speed_m_s", "flow")
    assert thrice["r"] == pytest.approx(single["r"])
    assert thrice["ci_high"] - thrice["ci_low"] < 0.7 * (single["ci_high"] - single["ci_low"])
    for limit in ("ci_low_cluster", "ci_high_cluster"):
        assert thrice[limit] == pytest.approx(single[limit], abs=0.03)
    assert thrice["n_participants"] == 12


def test_the_interval_over_runners_covers_as_often_as_it_says():
    rng = np.random.default_rng(3)
    codes = np.repeat(np.arange(12), 2)
    people = [f"P{code:02d}" for code in codes]
    hits = []
    for _ in range(200):
        # people differ, and two runs of one person are alike
        person = rng.normal(size=(12, 2)) @ np.array([[1.0, 0.5], [0.0, np.sqrt(0.75)]])
        values = person[codes] * np.sqrt(0.8) + np.sqrt(0.2) * (
            rng.normal(size=(24, 2)) @ np.array([[1.0, 0.5], [0.0, np.sqrt(0.75)]])
        )
        runs = pd.DataFrame(values, columns=["speed_m_s", "flow"]).assign(participant=people)
        row = one_row(runs, "speed_m_s", "flow")
        hits.append(
            (row["ci_low"] < 0.5 < row["ci_high"], row["ci_low_cluster"] < 0.5 < row["ci_high_cluster"])
        )  # fmt: skip
    independent, over_runners = np.mean(hits, axis=0)
    assert independent < 0.88
    assert 0.90 < over_runners < 0.98


def test_without_resampling_there_is_no_interval_over_runners(observations):
    table = associations(observations, WITHOUT_RESAMPLING)
    assert table[["ci_low_cluster", "ci_high_cluster"]].isna().all(axis=None)
    assert (table["reason_cluster"] == "").all()
    assert table["q"].notna().all()


def test_rows_without_enough_runs_or_variation_say_why(observations):
    few = observations.assign(flow=observations["flow"].where(observations.index < 3))
    few["speed_m_s"] = 3.0
    table = associations(few, RULES)
    flow = table[table["scale"] == "flow"]
    numbers = ["r", "p", "q", "beta", "rating_sd", "ci_low", "ci_low_cluster"]
    assert flow[numbers].isna().all(axis=None)
    assert flow["reason"].str.contains("too few pairs .* expected 4 or more; found").all()
    constant = table[(table["measure"] == "speed_m_s") & (table["scale"] != "flow")]
    assert constant["reason"].str.contains("the first variable is constant").all()
    assert constant["q"].isna().all()
    assert table["q"].notna().sum() == 2 * 36 * 2


@pytest.mark.parametrize(
    ("people", "reason"),
    [
        (["P1"] * 8, "too few clusters to resample; expected 2 or more; found 1"),
        (["P1", "P2", "P3", "P4"] * 2, ""),
        (["P1", "P2", "P3", "P4"], "too few participants for an interval over them"),
    ],
)
def test_few_runners_have_no_interval_and_a_reason(people, reason):
    rng = np.random.default_rng(2)
    values = rng.normal(size=(len(people), 2))
    runs = pd.DataFrame(values, columns=["speed_m_s", "flow"]).assign(participant=people)
    row = one_row(runs, "speed_m_s", "flow")
    assert np.isfinite(row["r"])
    assert row["n_participants"] == len(set(people))
    assert row["reason_cluster"].startswith(reason)
    assert np.isfinite(row["ci_low_cluster"]) == (reason == "")


def test_a_cohort_without_runs_has_rows_without_numbers(observations):
    table = associations(observations.iloc[:0], RULES)
    assert len(table) == 2 * 37 * 3
    assert (table["n"] == 0).all()
    assert table["r"].isna().all()
