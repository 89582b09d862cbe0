"""Result tables: the columns and rows of the print, and claims judged on made-up results."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.table_files import write_table
from swaystride.studies.intensity import tables
from swaystride.studies.intensity.claims import CLAIMS, claims_table
from swaystride.studies.intensity.difficulty import difficulty
from swaystride.studies.intensity.estimates import cohort_estimates
from swaystride.studies.intensity.kinematics import correlations, predictions
from swaystride.studies.intensity.plan import RESULT_COLUMNS
from swaystride.studies.intensity.recovery import printed_quantities
from swaystride.studies.intensity.reliability import reliability
from swaystride.studies.intensity.self_ratings import self_predictions, self_ratings
from swaystride.studies.intensity.table_styles import TABLE_STYLES

PRINTED = {"table_3_2": "estimate", "table_3_3": "r", "study3_text": "value"}


def printed(name):
    return pd.read_csv(REPOSITORY / "data" / "published" / f"{name}.csv")


@pytest.fixture(scope="module")
def everything(ratings, sway, plan):
    found, reliable = predictions(ratings, sway, plan), reliability(ratings, plan)
    results = pd.concat(
        [
            difficulty(ratings, plan),
            correlations(ratings, sway, plan),
            reliable["results"],
            self_ratings(ratings, plan),
            found["results"],
        ],
        ignore_index=True,
    )
    return results, found, reliable


@pytest.fixture(scope="module")
def built(everything, design, ratings, plan):
    results, found, reliable = everything
    ours = {name: getattr(tables, name)(results) for name in PRINTED}
    return {
        **ours,
        "table_3_1": tables.table_3_1(),
        "cohort": tables.cohort_table(design),
        "rating_counts": tables.rating_counts(design),
        "variance_components": reliable["components"],
        "prediction": pd.concat([self_predictions(ratings, plan), found["left_out"]]),
        "dropped_features": found["dropped"],
        "coverage": tables.coverage_table(ours, {name: printed(name) for name in PRINTED}),
        "claims": claims_table(results, plan.significance_level),
    }


@pytest.mark.parametrize("name", PRINTED)
def test_printed_tables_keep_their_columns_and_rows(built, name):
    theirs = printed(name).drop(columns="p_is_upper_bound")
    ours = built[name]
    assert list(ours)[: theirs.shape[1]] == list(theirs)
    keys = [column for column in theirs if not pd.api.types.is_numeric_dtype(theirs[column])]
    assert ours[keys].values.tolist() == theirs[keys].values.tolist()
    assert ours[PRINTED[name]].notna().all()
    assert {"n", "participant_ci_low", "participant_ci_high"} <= set(ours)


def test_every_quantity_of_the_text_has_a_participant_interval(built):
    table = built["study3_text"].set_index("quantity")
    assert (table["participant_ci_low"] <= table["value"]).all()
    assert (table["value"] <= table["participant_ci_high"]).all()


@pytest.mark.parametrize("name", sorted(set(TABLE_STYLES) - {"truth"}))
def test_every_table_can_be_written_in_its_style(built, name, tmp_path):
    style = TABLE_STYLES[name]
    write_table(
        built[name],
        tmp_path / name,
        caption=style.caption,
        notes=style.notes,
        formats=style.formats,
        simulated=True,
    )
    assert (tmp_path / f"{name}.csv").stat().st_size > 0


def test_the_scale_has_five_levels_for_both_kinds_of_raters(built):
    table = built["table_3_1"]
    assert table["rating"].tolist() == [1, 2, 3, 4, 5]
    assert table.notna().all().all()
    texts = table.drop(columns="rating").to_numpy().ravel()
    assert len(set(texts)) == 10


def test_the_cohort_is_counted_by_group(built, design):
    table = built["cohort"].set_index("group")
    assert table["n"].to_dict() == {"older_adult": 3, "vestibular": 3, "therapists": 4}
    assert table["n_female"].tolist()[:2] == [2, 2]
    assert table.loc["older_adult", "age_mean"] == 62.0
    assert table.loc["older_adult", "age_sd"] == 2.0
    assert table.loc["therapists", "experience_mean"] == 7.5


def test_ratings_are_counted_by_kind(built, design):
    table = built["rating_counts"]
    assert table["n"].sum() == len(design.ratings)
    assert table["n"].tolist() == [432, 144, 144, 48]
    assert table["pairs"].tolist() == [18, 6, 18, 6]
    shares = table[[f"share_{level}" for level in range(1, 6)]]
    np.testing.assert_allclose(shares.sum(axis=1), 100.0)


def test_coverage_counts_printed_values_within_limits():
    ours = pd.DataFrame(
        {
            "estimate": [0.0, 0.0, 0.0],
            "ci_low": [-1.0, -1.0, np.nan],
            "ci_high": [1.0, 1.0, np.nan],
            "participant_ci_low": [-3.0] * 3,
            "participant_ci_high": [3.0] * 3,
        }
    )
    theirs = pd.DataFrame({"estimate": [0.5, 2.0, 4.0]})
    row = tables.coverage_table({"table_3_2": ours}, {"table_3_2": theirs}).iloc[0]
    assert row.tolist() == ["table_3_2", 3, 2, 1, 3, 2]


def test_quick_estimates_hold_every_printed_quantity_and_agree_with_the_tables(
    everything, ratings, sway, plan
):
    quick = cohort_estimates(ratings, sway, plan)
    names = printed_quantities(*(printed(name) for name in PRINTED)).index
    assert set(names) <= set(quick["quantity"])
    assert quick["quantity"].is_unique
    assert tuple(quick) == RESULT_COLUMNS
    both = quick.merge(everything[0], on="quantity", suffixes=("", "_full"), validate="one_to_one")
    assert len(both) == len(quick)
    np.testing.assert_allclose(both["estimate"], both["estimate_full"])
    jackknifed = both["quantity"].str.contains("icc")
    rest = both[~jackknifed]
    np.testing.assert_allclose(rest["participant_ci_low"], rest["participant_ci_low_full"])


def as_printed():
    """The printed values with the printed p, as if a cohort had given exactly these."""
    rows = []
    for name, value in PRINTED.items():
        table = printed(name)
        keys = table[["aspect", "rating"]] if name == "table_3_2" else None
        keys = table[["feature", "transform"]] if name == "table_3_3" else keys
        keys = table[["quantity"]] if keys is None else keys
        for key, estimate, p in zip(keys.values.tolist(), table[value], table["p"], strict=True):
            rows.append(("/".join([name, *key]), estimate, p))
    return pd.DataFrame(rows, columns=["quantity", "estimate", "p"])


def test_claims_hold_for_the_printed_numbers_where_these_support_them():
    """The printed numbers contradict the prose once, on ratings of trials (register I-10)."""
    results = as_printed()
    per_trial = "study3_text/pt_minus_self_mean_difference_per_trial"
    results.loc[results["quantity"] == per_trial, "p"] = 0.001  # not printed for trials
    table = claims_table(results, 0.05).set_index("claim")
    assert len(table) == len(CLAIMS)
    failed = table[table["reproduced"] != "yes"]
    assert [text.split("(")[0].strip() for text in failed.index] == [
        "Predictions from sway agree more often than self-ratings: trials"
    ]
    assert failed["reproduced"].tolist() == ["no"]


def test_claims_fail_when_signs_turn():
    results = as_printed()
    turned = results.assign(estimate=-results["estimate"])
    table = claims_table(turned, 0.05).set_index("claim")["reproduced"]
    assert table["Ratings rise with the difficulty of surface, stance and vision."] == "no"
    assert table["Ratings fall with head movement."] == "no"
    nothing = results.assign(p=0.5)
    table = claims_table(nothing, 0.05).set_index("claim")["reproduced"]
    assert table["Every feature of sway correlates with the ratings."] == "no"
    assert table["Self-ratings vary less between trials of an exercise."] == "no"


def test_a_claim_that_holds_in_part_says_so():
    results = as_printed()
    one = results["quantity"] == "table_3_2/surface/per_trial"
    results.loc[one, "estimate"] = -1.0
    row = claims_table(results, 0.05).iloc[1]
    assert (row["holds"], row["reproduced"]) == ("5 of 6", "partly")
