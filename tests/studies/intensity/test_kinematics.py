"""Sway against ratings: statsmodels, plain resampling, and what a missing trial does."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
import statsmodels.formula.api as smf
from scipy import stats

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import bootstrap_interval, cluster_resamples
from swaystride.stats.marginal_correlation import marginal_correlation
from swaystride.studies.intensity.kinematics import correlations, predictions, rated_sway
from swaystride.studies.intensity.plan import FEATURES

LEVELS = ("per_trial", "per_exercise")


@pytest.fixture(scope="module")
def found(ratings, sway, plan):
    return predictions(ratings, sway, plan)


def rounded(values):
    return np.clip(np.floor(np.asarray(values) + 0.5), 1, 5)


@pytest.mark.parametrize(("feature", "transform"), [("ml_rms", "none"), ("phi_mv", "none")])
def test_marginal_correlation_is_that_of_statsmodels(ratings, sway, plan, feature, transform):
    table = rated_sway(ratings, sway, "per_trial")
    x = table[feature] if transform == "none" else np.log(table[feature])
    fit = smf.mixedlm("y ~ x", pd.DataFrame({"y": table["rating"], "x": x}),
                      groups=table["participant"]).fit(reml=False)  # fmt: skip
    explained = np.var(fit.params["x"] * x, ddof=1)
    whole = explained + fit.cov_re.iloc[0, 0] + fit.scale
    row = correlations(ratings, sway, plan, quick=True).set_index("quantity")
    ours = row.loc[f"table_3_3/{feature}/{transform}", "estimate"]
    np.testing.assert_allclose(ours, np.sqrt(explained / whole), atol=2e-5)


def test_a_feature_that_falls_with_the_rating_correlates_negatively(ratings, sway, plan):
    falling = sway.assign(ml_rms=1.0 / sway["ml_rms"])
    there, back = (
        correlations(ratings, table, plan, quick=True).set_index("quantity")["estimate"]
        for table in (sway, falling)
    )
    key = "table_3_3/ml_rms/log"
    np.testing.assert_allclose(back[key], -there[key], rtol=1e-9)


def test_participant_intervals_of_correlations_equal_refits(ratings, sway, plan_with):
    plan = plan_with(cluster_bootstrap_n=25, estimator="reml")
    table = rated_sway(ratings, sway, "per_trial")
    x = np.log(table["phi_mv"].to_numpy())
    draws = []
    for rows in cluster_resamples(table["participant"], 25, plan.cluster_bootstrap_seed):
        copies = pd.Series(rows).groupby(rows).cumcount().astype(str).to_numpy()
        patient = table["participant"].to_numpy()[rows].astype(str) + copies.astype(object)
        draws.append(marginal_correlation(table["rating"].to_numpy()[rows], x[rows], patient).r)
    row = correlations(ratings, sway, plan, quick=True).set_index("quantity")
    row = row.loc["table_3_3/phi_mv/log"].astype(float)
    expected = bootstrap_interval(
        row["estimate"], draws, n_clusters=6, level=0.95, scale="fisher_z"
    )
    limits = row[["participant_ci_low", "participant_ci_high"]]
    np.testing.assert_allclose(limits, expected, atol=1e-5)


def test_the_interval_of_the_model_encloses_the_correlation(ratings, sway, plan):
    table = correlations(ratings, sway, plan)
    assert (table["ci_low"] < table["estimate"]).all()
    assert (table["estimate"] < table["ci_high"]).all()
    assert list(table["quantity"])[:2] == ["table_3_3/phi_rms/none", "table_3_3/ap_rms/none"]
    assert len(table) == 16


@pytest.mark.parametrize("level", LEVELS)
def test_the_prediction_is_ordinary_least_squares(ratings, sway, found, level):
    table = rated_sway(ratings, sway, level)
    names = [
        name
        for name in table
        if name not in ("participant", "exercise", "trial", "rater", "rating")
    ]
    assert len(names) == (8 if level == "per_trial" else 24)
    X = sm.add_constant(table[names])
    theirs = sm.OLS(table["rating"], X).fit().fittedvalues
    ours = found["predicted"].query("rating_level == @level")
    np.testing.assert_allclose(ours["predicted"], theirs, atol=1e-7)
    row = found["left_out"].set_index(["rating", "statistic"])
    agreement = 100 * np.mean(rounded(theirs) == table["rating"])
    np.testing.assert_allclose(row.loc[(level, "accuracy_percent"), "in_sample"], agreement)
    rank = stats.spearmanr(np.round(theirs, 9), table["rating"])
    np.testing.assert_allclose(row.loc[(level, "spearman"), "in_sample"], rank.statistic)
    left_out = np.empty(len(table))
    for patient in set(table["participant"]):
        out = (table["participant"] == patient).to_numpy()
        left_out[out] = X[out] @ sm.OLS(table["rating"][~out], X[~out]).fit().params
    np.testing.assert_allclose(ours["left_out"], left_out, atol=1e-6)
    agreement = 100 * np.mean(rounded(left_out) == table["rating"])
    np.testing.assert_allclose(row.loc[(level, "accuracy_percent"), "left_out"], agreement)


def test_shares_are_rows_of_the_contingency_table(found):
    own = found["predicted"].query("rating_level == 'per_exercise'")
    counts = pd.crosstab(rounded(own["predicted"]), own["rating"])
    row = found["results"].set_index("quantity")["estimate"]
    for name, given, then in (("5_agrees_with_pt", 5, 5), ("4_is_pt_5", 4, 5), ("4_is_pt_4", 4, 4)):
        expected = 100 * counts.loc[given, then] / counts.loc[given].sum()
        ours = row[f"study3_text/kinematics_{name}_per_exercise_percent"]
        np.testing.assert_allclose(ours, expected)


def test_left_out_patients_are_predicted_worse_on_average(ratings, sway, found):
    errors = found["predicted"].assign(
        inside=lambda t: (t["predicted"] - t["rating"]) ** 2,
        outside=lambda t: (t["left_out"] - t["rating"]) ** 2,
    )
    means = errors.groupby("rating_level")[["inside", "outside"]].mean()
    assert (means["outside"] > means["inside"]).all()


def test_logarithms_enter_the_prediction_if_the_plan_says_so(ratings, sway, plan_with, found):
    logs = sway.assign(**{name: np.log(sway[name]) for name in FEATURES})
    by_plan = predictions(ratings, sway, plan_with(prediction_transform="log"), quick=True)
    by_hand = predictions(ratings, logs, plan_with(), quick=True)
    pd.testing.assert_frame_equal(by_plan["results"], by_hand["results"])
    assert not np.allclose(by_plan["predicted"]["predicted"], found["predicted"]["predicted"])


def test_collinear_features_are_dropped_and_named(ratings, sway, plan):
    same = sway.assign(path_length=30.0 * sway["phi_mv"])
    found = predictions(ratings, same, plan, quick=True)
    dropped = found["dropped"].groupby("rating")["feature"].agg(list).to_dict()
    assert dropped == {
        "per_trial": ["path_length"],
        "per_exercise": ["path_length_1", "path_length_2", "path_length_3"],
    }
    without = sm.OLS(
        rated_sway(ratings, sway, "per_trial")["rating"],
        sm.add_constant(
            rated_sway(ratings, same, "per_trial")[[f for f in FEATURES if f != "path_length"]]
        ),
    ).fit()
    own = found["predicted"].query("rating_level == 'per_trial'")["predicted"]
    np.testing.assert_allclose(own, without.fittedvalues, atol=1e-7)
    rows = found["findings"].query("check == 'collinear_feature'")
    assert rows["found"].tolist() == [
        "path_length",
        "path_length_1",
        "path_length_2",
        "path_length_3",
    ]


def test_an_exercise_that_lacks_a_trial_is_left_out_and_reported(ratings, sway, plan):
    first = sway.iloc[0]
    found = predictions(ratings, sway.iloc[1:], plan, quick=True)
    gone = found["findings"].query("check == 'rating_without_sway'")
    assert gone[["participant", "found"]].values.tolist() == [
        [first["participant"], "3 ratings without it, left out"],
        [first["participant"], "3 ratings without it, left out"],
    ]
    assert gone["place"].tolist() == ["prediction per trial", "prediction per exercise"]
    n = found["predicted"].groupby("rating_level").size()
    whole = predictions(ratings, sway, plan, quick=True)["predicted"].groupby("rating_level").size()
    assert (whole - n).to_dict() == {"per_trial": 3, "per_exercise": 3}
    table = rated_sway(ratings, sway.iloc[1:], "per_exercise")
    same = (table["participant"] == first["participant"]) & (table["exercise"] == first["exercise"])
    assert not same.any()


def test_without_sway_there_is_an_error(ratings, sway, plan):
    with pytest.raises(ModelError) as caught:
        predictions(ratings, sway.iloc[:0], plan)
    assert str(caught.value) == "no rating per trial has the features of its trials"
