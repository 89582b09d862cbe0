"""Values of R and ours: joined without gaps, tolerances that bite, complete people only."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.validation import force_plate_models, manifest
from swaystride.validation import reliability_and_mixed_models as validated
from swaystride.validation.figures import figure_reliability
from swaystride.validation.summary import summary_frame

SHROUT_FLEISS = np.array(
    [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], float
)
DATASETS = [validated.DATASET, force_plate_models.DATASET]


def reference_as_ours(dataset, **changes):
    """Values that agree with R, apart from named changes of ``set|quantity``."""
    values: dict[str, dict[str, float]] = {}
    for row in validated.load_reference(dataset).itertuples():
        values.setdefault(row.set, {})[row.quantity] = row.value
    for place, shift in changes.items():
        name, quantity = place.split("|")
        values[name][quantity] += shift
    return values


@pytest.fixture
def judges_only(monkeypatch):
    """The table of references cut down to the ratings of Shrout & Fleiss."""
    table = validated.load_reference(validated.DATASET)
    chosen = table[table["set"] == "shrout_fleiss_1979"].reset_index(drop=True)
    monkeypatch.setattr(validated, "load_reference", lambda _: chosen.copy())


def test_judges_of_shrout_and_fleiss_give_what_r_prints(judges_only):
    ours = {"shrout_fleiss_1979": validated.rating_values(SHROUT_FLEISS)}
    table = validated.compared(validated.DATASET, ours)
    checks = summary_frame(validated.comparison_checks(validated.DATASET, table))
    assert (checks["within"] == "yes").all()
    assert checks["quantity"].is_unique
    moved = SHROUT_FLEISS + np.array([0.0, 0.0, 0.0, 1e-3])
    shifted = {"shrout_fleiss_1979": validated.rating_values(moved)}
    table = validated.compared(validated.DATASET, shifted)
    checks = summary_frame(validated.comparison_checks(validated.DATASET, table))
    assert (checks["within"] == "no").sum() >= 6


def test_values_of_a_fit_have_the_names_of_r():
    rng = np.random.default_rng(3)
    who, plate = (index.ravel() for index in np.indices((6, 8)))
    table = pd.DataFrame({"who": who, "plate": plate, "x": rng.normal(size=48)})
    table["y"] = table["x"] + rng.normal(size=6)[who] + rng.normal(size=48)
    fit = fit_mixed_model("y ~ x + (1|who) + (1|plate)", table)
    values = validated.model_values(fit, ["(Intercept)", "x"], ["person", "dish"])
    effects = fit.fixed_effects(df="satterthwaite")
    assert values["x: se"] == effects.loc["x", "se"]
    assert values["(Intercept): df"] == effects.loc["Intercept", "df"]
    assert values["variance of person"] == fit.variance_components["who"]
    assert values["SD of dish"] ** 2 == pytest.approx(fit.variance_components["plate"])
    assert values["residual variance"] == fit.variance_components["Residual"]
    assert values["REML criterion"] == -2 * fit.loglik
    with pytest.raises(ValueError, match="zip"):
        validated.model_values(fit, ["x"], ["person", "dish"])


@pytest.mark.parametrize("dataset", DATASETS)
def test_equal_values_pass_and_each_kind_of_wrong_value_fails(dataset):
    equal = validated.compared(dataset, reference_as_ours(dataset))
    checks = summary_frame(validated.comparison_checks(dataset, equal))
    assert checks["quantity"].is_unique
    # Components as printed are not the ICC as printed, so REML and closed formula differ.
    own = checks["reference_source"] != "ours"
    assert (checks.loc[own, "within"] == "yes").all()
    for row in equal.groupby("kind").first().itertuples():
        wrong = reference_as_ours(dataset, **{f"{row.set}|{row.quantity}": 1.01 * row.tolerance})
        found = validated.comparison_checks(dataset, validated.compared(dataset, wrong))
        failed = [
            check for check in found if check.within == "no" and check.reference_source != "ours"
        ]
        assert len(failed) == 1, row.Index
        assert row.set in failed[0].quantity


@pytest.mark.parametrize("dataset", DATASETS)
def test_references_are_complete(dataset):
    table = validated.load_reference(dataset)
    assert not table.duplicated(["set", "quantity"]).any()
    assert table.notna().all(axis=None)
    assert set(table["kind"]) <= set(validated.TOLERANCES)
    names = set(manifest.load_manifest(dataset)["file"])
    assert len(names) >= 9


@pytest.mark.parametrize("dataset", DATASETS)
def test_printed_coefficients_follow_from_printed_variances(dataset):
    """The transcription: ICC(2,1) of lme4 is the share of the target in its three variances."""
    table = validated.load_reference(dataset)
    wide = table.pivot_table(index="set", columns="quantity", values="value")
    wide = wide.dropna(subset=["ICC(2,1) by REML"])
    total = wide[["variance of targets", "variance of raters", "residual variance"]].sum(axis=1)
    assert len(wide) in (4, 5)
    np.testing.assert_allclose(
        wide["variance of targets"] / total, wide["ICC(2,1) by REML"], atol=1e-7
    )
    np.testing.assert_allclose(wide["ICC(2,1) by REML"], wide["ICC(2,1)"], atol=1e-6)
    one = wide["ICC(1,1): F"]
    k = (one - 1) / wide["ICC(1,1)"] - one + 1
    np.testing.assert_allclose(k, np.round(k), atol=1e-3)


def test_a_value_that_was_not_computed_is_an_error():
    values = reference_as_ours(validated.DATASET)
    del values["ctsib"]["REML criterion"]
    with pytest.raises(KeyError, match="REML criterion"):
        validated.compared(validated.DATASET, values)


def plate_table():
    """Three people; the second lacks a trial with open eyes on firm ground."""
    rows = [(person, "Open", "Firm", 10.0 * person + at) for person in (1, 2, 3) for at in range(3)]
    rows.pop(4)
    rows += [(person, "Closed", "Firm", -1.0) for person in (1, 2, 3)]
    return pd.DataFrame(rows, columns=["Subject", "Vision", "Surface", "COPvelo"])


def test_only_people_with_all_three_trials_are_compared():
    found = force_plate_models.repeated_trials(plate_table(), "COPvelo", "Open", "Firm")
    assert found.index.tolist() == [1, 3]
    assert found.to_numpy().tolist() == [[10.0, 11.0, 12.0], [30.0, 31.0, 32.0]]


def test_a_condition_without_or_with_too_many_trials_is_refused():
    table = plate_table()
    twice = pd.concat([table, table])
    with pytest.raises(DesignError, match="no trial of this condition; found Open, Foam"):
        force_plate_models.repeated_trials(table, "COPvelo", "Open", "Foam")
    with pytest.raises(DesignError, match="too many trials of a condition; expected 3; found 6"):
        force_plate_models.repeated_trials(twice, "COPvelo", "Open", "Firm")


def test_the_figure_shows_every_set_and_every_kind():
    table = validated.compared(validated.DATASET, reference_as_ours(validated.DATASET))
    left, right = figure_reliability(table).axes
    assert len(left.get_yticklabels()) == 5
    assert len(right.get_yticklabels()) == table["kind"].nunique()
    (points,) = [line for line in right.lines if len(line.get_xdata()) == len(table)]
    assert (np.asarray(points.get_xdata()) < 1.0).all()
