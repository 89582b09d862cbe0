"""Numbers about self-ratings against SciPy, NumPy and pandas on the same pairs."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from swaystride.errors import DesignError
from swaystride.stats.cluster_bootstrap import bootstrap_interval, cluster_bootstrap
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.studies.intensity.self_ratings import (
    paired_ratings,
    self_predictions,
    self_ratings,
    variance_pairs,
)


@pytest.fixture(scope="module")
def found(ratings, plan):
    table = self_ratings(ratings, plan).set_index("quantity")
    table.index = table.index.str.removeprefix("study3_text/")
    return table


def rounded(values):
    return np.clip(np.floor(values + 0.5), 1, 5)


def statistics(rating, own):
    slope, intercept = np.polyfit(own, rating, 1)
    counts = pd.crosstab(own, rating).reindex(index=range(1, 6), columns=range(1, 6), fill_value=0)
    shares = counts.div(counts.sum(axis=1), axis=0)
    return {
        "spearman_self_vs_pt": stats.spearmanr(own, rating).statistic,
        "pt_minus_self_mean_difference": np.mean(rating - own),
        "difference_sd": np.std(rating - own, ddof=1),
        "self_predicts_pt_accuracy": 100 * np.mean(rounded(intercept + slope * own) == rating),
        "self_5_agrees_with_pt": 100 * shares.loc[5, 5],
        "self_4_is_pt_5": 100 * shares.loc[4, 5],
    }


SCALES = {
    "spearman_self_vs_pt": "fisher_z",
    "pt_minus_self_mean_difference": "identity",
    "difference_sd": "identity",
    "self_predicts_pt_accuracy": "logit",
    "self_5_agrees_with_pt": "logit",
    "self_4_is_pt_5": "logit",
}


@pytest.mark.parametrize("level", ["per_trial", "per_exercise"])
def test_estimates_and_participant_intervals_equal_plain_resampling(ratings, found, plan, level):
    pairs = paired_ratings(ratings, level)
    rating, own = pairs["rating"].to_numpy(), pairs["self_rating"].to_numpy()
    expected = statistics(rating, own)
    draws = cluster_bootstrap(
        lambda rows: list(statistics(rating[rows], own[rows]).values()),
        pairs["participant"],
        n=plan.cluster_bootstrap_n,
        seed=plan.cluster_bootstrap_seed,
    )
    assert np.isfinite(draws).mean() > 0.99  # a resample without any self-rating of 5
    for at, (name, value) in enumerate(expected.items()):
        percent = SCALES[name] == "logit"
        row = found.loc[f"{name}_{level}" + ("_percent" if percent else "")].astype(float)
        np.testing.assert_allclose(row["estimate"], value, rtol=1e-9, err_msg=name)
        unit = 100.0 if percent else 1.0
        limits = bootstrap_interval(
            value / unit,
            draws[np.isfinite(draws[:, at]), at] / unit,
            n_clusters=6,
            level=0.95,
            scale=SCALES[name],
        )
        np.testing.assert_allclose(
            row[["participant_ci_low", "participant_ci_high"]],
            unit * np.array(limits),
            rtol=1e-6,
            err_msg=name,
        )


def test_printed_intervals_follow_their_closed_forms(ratings, found):
    pairs = paired_ratings(ratings, "per_exercise")
    n, difference = len(pairs), pairs["rating"] - pairs["self_rating"]
    r = stats.spearmanr(pairs["self_rating"], pairs["rating"])
    half = stats.norm.ppf(0.975) / np.sqrt(n - 3)
    row = found.loc["spearman_self_vs_pt_per_exercise"]
    expected = np.tanh(np.arctanh(r.statistic) + np.array([-half, half]))
    np.testing.assert_allclose(row[["ci_low", "ci_high"]].astype(float), expected)
    np.testing.assert_allclose(row["p"], r.pvalue, rtol=1e-6)

    row = found.loc["difference_sd_per_exercise"]
    squares = ((difference - difference.mean()) ** 2).sum()
    expected = np.sqrt(squares / stats.chi2.ppf([0.975, 0.025], n - 1))
    np.testing.assert_allclose(row[["ci_low", "ci_high"]].astype(float), expected)

    row = found.loc["pt_minus_self_mean_difference_per_exercise"]
    fit = fit_mixed_model(
        "d ~ 1 + (1|participant) + (1|rater)", pairs.assign(d=difference), reml=False
    )
    model = fit.fixed_effects("residual").iloc[0]
    for name in ("se", "df", "p", "ci_low", "ci_high"):
        np.testing.assert_allclose(row[name], model[name])
    np.testing.assert_allclose(row["estimate"], difference.mean())


def test_the_printed_widths_follow_from_the_printed_estimates():
    """Fisher's z and χ² with 645 pairs give the intervals that the chapter prints (spec §8.5)."""
    half = stats.norm.ppf(0.975) / np.sqrt(645 - 3)
    limits = np.tanh(np.arctanh(0.769) + np.array([-half, half]))
    np.testing.assert_allclose(limits, [0.735, 0.799], atol=0.001)
    limits = 0.961 * np.sqrt(644 / stats.chi2.ppf([0.975, 0.025], 644))
    np.testing.assert_allclose(limits, [0.910, 1.015], atol=0.0025)


def test_variances_between_trials_are_compared_by_a_paired_t_test(ratings, found):
    rating, own = [], []
    trials = ratings[ratings["rating_level"] == "per_trial"]
    for _, three in trials.groupby(["participant", "exercise", "rater"]):
        assert len(three) == 3
        rating.append(np.var(three["rating"], ddof=1))
        own.append(np.var(three["self_rating"], ddof=1))
    test = stats.ttest_rel(rating, own)
    row = found.loc["pt_minus_self_between_trial_variance_difference"].astype(float)
    limits = test.confidence_interval(0.95)
    np.testing.assert_allclose(row["estimate"], np.mean(rating) - np.mean(own))
    np.testing.assert_allclose(row[["ci_low", "ci_high"]], [limits.low, limits.high])
    np.testing.assert_allclose([row["p"], row["df"]], [test.pvalue, len(rating) - 1])


def test_missing_self_ratings_cost_their_own_rows_only(ratings, plan):
    lost = (ratings["participant"] == "P01") & (ratings["trial"] == 2).fillna(False)
    table = ratings.assign(self_rating=ratings["self_rating"].mask(lost.astype(bool)))
    assert lost.sum() == 8 * 3
    assert len(paired_ratings(table, "per_trial")) == len(paired_ratings(ratings, "per_trial")) - 24
    assert len(paired_ratings(table, "per_exercise")) == len(
        paired_ratings(ratings, "per_exercise")
    )
    assert len(variance_pairs(table)) == len(variance_pairs(ratings)) - 24
    assert self_ratings(table, plan)["estimate"].notna().all()


def test_without_any_self_rating_the_error_says_so(ratings, plan):
    with pytest.raises(DesignError) as caught:
        self_ratings(ratings.assign(self_rating=np.nan), plan)
    assert str(caught.value) == (
        "per trial: no rating has a self-rating beside it; "
        "expected rows of ratings.tsv with rater self"
    )


def test_prediction_in_sample_is_the_printed_accuracy_and_left_out_is_never_fitted(
    ratings, found, plan
):
    table = self_predictions(ratings, plan).set_index(["rating", "statistic"])
    for level in ("per_trial", "per_exercise"):
        row = table.loc[(level, "accuracy_percent")]
        assert (
            row["in_sample"] == found.loc[f"self_predicts_pt_accuracy_{level}_percent", "estimate"]
        )
        pairs = paired_ratings(ratings, level)
        hits = []
        for patient, own in pairs.groupby("participant"):
            rest = pairs[pairs["participant"] != patient]
            slope, intercept = np.polyfit(rest["self_rating"], rest["rating"], 1)
            hits.append(rounded(intercept + slope * own["self_rating"]) == own["rating"])
        np.testing.assert_allclose(row["left_out"], 100 * np.concatenate(hits).mean())
