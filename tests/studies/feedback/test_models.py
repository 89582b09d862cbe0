"""Effects of the printed models: algebra, truth, search and bookkeeping."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.errors import DesignError
from swaystride.simulate.feedback_population import draw_features, expected_log_features
from swaystride.studies.feedback.claims import CLAIMS, claims_table
from swaystride.studies.feedback.models import (
    analyse_feature,
    effect_estimates,
    fit_printed,
    observations,
)
from swaystride.studies.feedback.plan import FEATURES, MAXIMAL_TERMS, TERMS_OF_INTEREST, effects
from swaystride.studies.feedback.tables import (
    TABLE_2_2_COLUMNS,
    table_2_1,
    table_2_2,
    table_2_3,
    table_2_4,
    table_truth,
)


@pytest.fixture(scope="module")
def frame(design, variables, cohort):
    """One cohort of features, rows as in the variables."""
    log_features = draw_features(design, cohort.population, np.random.default_rng(5))
    order = design.sort_values(["participant", "session_trial"]).index
    values = np.exp(log_features.loc[order, list(FEATURES)]).reset_index(drop=True)
    return pd.concat([variables, values], axis=1)


@pytest.fixture(scope="module")
def analyses(frame, plan):
    return {feature: analyse_feature(frame, feature, plan) for feature in FEATURES}


def collected(analyses, name):
    return pd.concat([tables[name] for tables in analyses.values()], ignore_index=True)


def test_effects_of_a_noise_free_response_are_exact(frame, plan):
    """Put known coefficients in: every effect is their weighted sum, whatever the noise is not."""
    rng = np.random.default_rng(1)
    beta = {term: float(rng.normal()) for term in plan.printed_terms["ml_rms"]}
    exponent = plan.printed_exponents["ml_rms"]
    x = frame.assign(trial_number=frame["trial_number"] ** exponent)
    product = {t: np.prod([x[p] for p in t.split(":")], axis=0) for t in beta}
    # a little noise that is orthogonal to nothing in particular: the model needs some
    person = frame["participant"].astype("category").cat.codes.to_numpy()
    y = 0.3 + sum(b * product[t] for t, b in beta.items()) + rng.normal(size=19)[person]
    noisy = frame.assign(ml_rms=np.exp(y + 1e-4 * rng.normal(size=len(y))))
    table = effect_estimates(noisy, "ml_rms", fit_printed(noisy, "ml_rms", plan), plan)
    found = table.set_index(["panel", "effect"])["estimate"]
    end = 15**exponent
    slope_c = beta["trial_number"] + beta["block:trial_number"]
    assert found["training", "concurrent"] == pytest.approx(slope_c, abs=3e-4)
    assert found["training", "terminal_minus_concurrent"] == pytest.approx(
        -beta["block:trial_number"], abs=3e-4
    )
    assert found["removal", "concurrent"] == pytest.approx(
        beta["concurrent_feedback_removed"], abs=3e-4
    )
    assert found["block_change", "concurrent"] == pytest.approx(
        slope_c * end + beta["concurrent_feedback_removed"], abs=3e-4
    )
    assert found["block_change", "terminal"] == pytest.approx(
        beta["trial_number"] * end + beta["terminal_feedback_removed"], abs=3e-4
    )


def test_the_difference_of_the_block_changes_is_their_difference():
    for exponent in (0.1, 0.5, 2.0):
        by_name = {e.name: e.weights for e in effects(exponent, 15) if e.panel == "block_change"}
        for term in MAXIMAL_TERMS:
            difference = by_name["terminal"].get(term, 0.0) - by_name["concurrent"].get(term, 0.0)
            assert by_name["terminal_minus_concurrent"].get(term, 0.0) == pytest.approx(difference)


def test_an_effect_whose_term_was_dropped_comes_from_a_refit(frame, plan):
    table = effect_estimates(frame, "phi_rms", fit_printed(frame, "phi_rms", plan), plan)
    rows = table.set_index(["panel", "effect"])
    assert rows.loc[("training", "terminal_minus_concurrent"), "refit_with"] == "block:trial_number"
    assert rows.loc[("training", "concurrent"), "refit_with"] == ""


def test_tables_keep_the_contract(analyses, tables, printed, plan):
    """Columns begin with those of the printed tables, rows stand in the printed order."""
    text = pd.read_csv(REPOSITORY / "data" / "published" / "table_2_4.csv")
    published = {
        "table_2_1": table_2_1(tables[0]),
        "table_2_2": table_2_2(collected(analyses, "fixed_effects"), 0.05),
        "table_2_3": table_2_3(collected(analyses, "contrasts"), printed, 15),
        "table_2_4": table_2_4(collected(analyses, "contrasts"), printed, text),
    }
    for name, ours in published.items():
        theirs = pd.read_csv(REPOSITORY / "data" / "published" / f"{name}.csv")
        columns = [c for c in theirs.columns if not c.endswith("_is_upper_bound")]
        assert list(ours.columns[: len(columns)]) == columns, name
        keys = [c for c in ("group", "panel", "effect", "feature") if c in columns]
        joined = theirs[keys].merge(ours[keys], on=keys)
        assert len(joined) == len(theirs), name


def test_table_2_1_has_the_printed_demographics(tables):
    """Exact means, standard deviations and counts of the default cohort, to the printed digits."""
    theirs = pd.read_csv(REPOSITORY / "data" / "published" / "table_2_1.csv")
    ours = table_2_1(tables[0])
    digits = {"age_mean": 1, "age_sd": 1, "height_m_mean": 2, "height_m_sd": 2}
    digits |= {"mass_kg_mean": 0, "mass_kg_sd": 0, "n": 0, "n_female": 0}
    for column, decimals in digits.items():
        np.testing.assert_allclose(ours[column].round(decimals), theirs[column], err_msg=column)


def test_selection_keeps_the_terms_of_interest_and_lowers_aic(analyses):
    for tables in analyses.values():
        searched = tables["fixed_effects"].query("model == 'searched'")["term"].tolist()
        assert set(TERMS_OF_INTEREST) <= set(searched)
        path = tables["elimination"]
        assert (path["aic_after"] < path["aic_before"]).all()
        best = tables["exponents"].set_index("exponent")["loglik"].idxmax()
        exponent = tables["fixed_effects"].query("model == 'searched'")["exponent"].iloc[0]
        assert exponent == best


def test_table_2_2_says_yes_star_exactly_for_significant_terms(analyses):
    effects_table = collected(analyses, "fixed_effects")
    table = table_2_2(effects_table, 0.05).set_index("feature")
    for feature in FEATURES:
        own = effects_table.query("feature == @feature and model == 'searched'").set_index("term")
        for term, column in TABLE_2_2_COLUMNS.items():
            expected = "no" if term not in own.index else "yes"
            if term in own.index and own.loc[term, "p"] < 0.05:
                expected = "yes*"
            assert table.loc[feature, column] == expected


def test_claims_are_judged_by_sign_and_p():
    rows = [
        {"model": "printed", "panel": c.panel, "effect": c.effect, "feature": f}
        for c in CLAIMS
        for f in c.features
    ]
    contrasts = pd.DataFrame(rows).drop_duplicates().assign(estimate=-0.1, p=0.01)
    verdict = claims_table(contrasts, 0.05)["reproduced"]
    by_text = dict(zip([c.text for c in CLAIMS], verdict, strict=True))
    assert by_text["Removing terminal feedback changes nothing."] == "no"
    assert by_text["Sway angles fall with the number of trials with concurrent feedback."] == "yes"
    contrasts.loc[contrasts["feature"] == "phi_rms", "p"] = 0.5
    again = claims_table(contrasts, 0.05)["reproduced"]
    assert (
        dict(zip([c.text for c in CLAIMS], again, strict=True))[
            "Removing terminal feedback changes nothing."
        ]
        == "partly"
    )


def test_truth_table_counts_standard_errors(analyses):
    contrasts = collected(analyses, "contrasts")
    ours = contrasts[contrasts["model"] == "printed"]
    truth = ours[["panel", "feature", "effect"]].assign(
        truth=(ours["estimate"] - 1.5 * ours["se"]).to_numpy()
    )
    np.testing.assert_allclose(table_truth(contrasts, truth)["difference_in_se"], 1.5)


def test_every_trial_is_measured_or_excluded(tables, plan, cohort):
    participants, trials = tables
    measures = trials[["participant", "trial"]].assign(
        duration_s=30.0, **dict.fromkeys(FEATURES, 1.0)
    )
    none = pd.DataFrame(columns=["participant", "trial"])
    assert len(observations(participants, trials, measures, none, plan)) == len(trials)
    gone = measures.iloc[[3]][["participant", "trial"]]
    kept = observations(participants, trials, measures.drop(index=3), gone, plan)
    assert len(kept) == len(trials) - 1
    with pytest.raises(DesignError, match="neither measured nor excluded"):
        observations(participants, trials, measures.drop(index=3), none, plan)


def test_expected_features_obey_the_identities(design, cohort):
    expected = expected_log_features(design, cohort.population)
    duration_s = (cohort.population.trial.n_samples - 1) / cohort.population.trial.rate_hz
    np.testing.assert_allclose(
        expected["path_length"], expected["phi_mv"] + np.log(duration_s), rtol=1e-12
    )
