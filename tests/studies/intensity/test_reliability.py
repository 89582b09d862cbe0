"""Reliability of the ratings: mean squares of a balanced cohort, independent refits, bad designs."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import jackknife_interval
from swaystride.stats.reliability import intraclass_correlation
from swaystride.studies.intensity.design import read_design
from swaystride.studies.intensity.observations import analysed_ratings, rating_findings
from swaystride.studies.intensity.reliability import fit_decomposition, quick_icc, reliability


def balanced(seed, p=5, e=6, r=4):
    """Every rater rates every exercise of every patient; all variances well above zero."""
    rng = np.random.default_rng(seed)
    y = (
        rng.normal(0, 1.0, (p, 1, 1))
        + rng.normal(0, 1.0, (p, e, 1))
        + rng.normal(0, 0.8, (1, 1, r))
        + rng.normal(0, 0.7, (p, 1, r))
        + rng.normal(0, 0.5, (p, e, r))
    )
    at = np.indices(y.shape).reshape(3, -1)
    return y, pd.DataFrame(
        {
            "participant": [f"P{i}" for i in at[0]],
            "exercise": [f"E{i}_{j}" for i, j in zip(at[0], at[1], strict=True)],
            "trial": pd.array([pd.NA] * y.size, dtype="Int64"),
            "rating_level": "per_exercise",
            "rater": [f"R{k}" for k in at[2]],
            "rating": y.ravel(),
        }
    )


@pytest.mark.parametrize("seed", [1, 2, 4])
def test_nested_components_are_those_of_the_mean_squares(seed):
    """Analysis of variance of exercises within patients, both crossed with raters (REML = ANOVA)."""
    y, ratings = balanced(seed)
    p, e, r = y.shape
    mean = y.mean()
    patient, exercise = y.mean(axis=(1, 2)), y.mean(axis=2)
    rater, both = y.mean(axis=(0, 1)), y.mean(axis=1)
    ms_p = e * r * ((patient - mean) ** 2).sum() / (p - 1)
    ms_e = r * ((exercise - patient[:, None]) ** 2).sum() / (p * (e - 1))
    ms_r = p * e * ((rater - mean) ** 2).sum() / (r - 1)
    ms_pr = e * ((both - patient[:, None] - rater + mean) ** 2).sum() / ((p - 1) * (r - 1))
    rest = y - exercise[:, :, None] - both[:, None, :] + patient[:, None, None]
    ms_rest = (rest**2).sum() / (p * (e - 1) * (r - 1))
    expected = {
        "participant": (ms_p - ms_e - ms_pr + ms_rest) / (e * r),
        "participant:exercise": (ms_e - ms_rest) / r,
        "rater": (ms_r - ms_pr) / (p * e),
        "participant:rater": (ms_pr - ms_rest) / e,
        "Residual": ms_rest,
    }
    assert min(expected.values()) > 0
    found = fit_decomposition(ratings, "per_exercise", "recommended").variance_components
    for name, value in expected.items():
        np.testing.assert_allclose(found[name], value, rtol=1e-5, err_msg=name)
    between = expected["participant"] + expected["participant:exercise"]
    np.testing.assert_allclose(
        intraclass_correlation(found, "rater"), between / sum(expected.values()), rtol=1e-6
    )


@pytest.fixture(scope="module")
def found(ratings, plan):
    return reliability(ratings, plan)


def test_components_are_shares_of_the_whole_and_give_the_icc(found):
    for (_, form), own in found["components"].groupby(["rating", "form"]):
        np.testing.assert_allclose(own["share"].sum(), 1.0)
        without = own.loc[own["contains_rater"] == "no", "share"].sum()
        np.testing.assert_allclose(without, own["icc"].iloc[0])
        assert len(own) in ((14, 7) if form == "printed" else (10, 5))


def test_the_participant_interval_is_the_jackknife_of_cold_refits(found, ratings, plan):
    """The package starts each refit at the whole fit; here each one starts from nothing."""
    for level in ("per_trial", "per_exercise"):
        left_out = [
            intraclass_correlation(
                fit_decomposition(
                    ratings[ratings["participant"] != patient], level, "recommended"
                ).variance_components,
                "rater",
            )
            for patient in sorted(set(ratings["participant"]))
        ]
        row = found["results"].set_index("quantity").loc[f"study3_text/icc_pt_{level}"]
        expected = jackknife_interval(row["estimate"], left_out, level=0.95, scale="fisher_z")
        limits = row[["participant_ci_low", "participant_ci_high"]].astype(float)
        np.testing.assert_allclose(limits, expected, atol=2e-6)
        assert row["ci_low"] < row["estimate"] < row["ci_high"]


def test_without_intervals_the_icc_is_the_same(found, ratings, plan):
    quick = quick_icc(ratings, plan)
    np.testing.assert_allclose(quick["estimate"], found["results"]["estimate"])
    assert quick["participant_ci_low"].isna().all()


def test_the_form_of_the_plan_is_reported_and_both_stand_in_the_components(
    ratings, plan_with, found
):
    icc = quick_icc(ratings, plan_with(icc_form="printed"))["estimate"].to_numpy()
    components = found["components"].drop_duplicates(["rating", "form"]).set_index("form")
    np.testing.assert_allclose(components.loc["printed", "icc"], icc)


def test_constant_ratings_are_an_error_that_can_be_read(ratings, plan):
    with pytest.raises(ModelError, match="the outcome is constant; found 3 in all"):
        quick_icc(ratings.assign(rating=3.0), plan)


def test_a_patient_with_one_rater_stays_and_is_reported(tmp_path, make_cohort, write_tables, plan):
    tables = make_cohort(4)
    all_ratings = tables[3]
    first = all_ratings.query("participant == 'P01' and rater != 'self'")["rater"].iloc[0]
    others = (all_ratings["participant"] == "P01") & ~all_ratings["rater"].isin([first, "self"])
    write_tables(tmp_path, (*tables[:3], all_ratings[~others]))
    design = read_design(tmp_path)
    assert "few_raters" in set(rating_findings(design)["check"])
    kept = analysed_ratings(design)
    assert set(kept.loc[kept["participant"] == "P01", "rater"]) == {first}
    icc = quick_icc(kept, plan)
    assert icc["n"].sum() == len(kept)
    assert icc["estimate"].between(0, 1).all()
