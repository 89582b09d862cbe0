"""Reliability: closed formulas, mixed models and pingouin agree; printed classes."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pingouin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from swaystride.errors import ModelError
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.reliability import (
    bootstrap_icc,
    intraclass_correlation,
    reliability_class,
    reliability_formula,
    two_way_icc,
)

SHROUT_FLEISS = np.array(
    [[9, 2, 5, 8], [6, 1, 3, 2], [8, 4, 6, 8], [7, 1, 2, 6], [10, 5, 6, 9], [6, 2, 4, 7]], float
)


def long_form(table: np.ndarray) -> pd.DataFrame:
    target, rater = np.indices(table.shape)
    return pd.DataFrame({"target": target.ravel(), "rater": rater.ravel(), "rating": table.ravel()})


def test_closed_formulas_give_what_shrout_and_fleiss_print() -> None:
    printed = [0.17, 0.29, 0.71, 0.44, 0.62, 0.91]
    assert_allclose(two_way_icc(SHROUT_FLEISS)["icc"], printed, atol=0.005)


@pytest.mark.filterwarnings("ignore:The inplace keyword")
@pytest.mark.parametrize("seed", range(3))
def test_closed_formulas_and_limits_agree_with_pingouin(seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = 2 * rng.normal(size=(12, 1)) + rng.normal(size=4) + rng.normal(size=(12, 4))
    ours = two_way_icc(table)
    theirs = pingouin.intraclass_corr(
        long_form(table), targets="target", raters="rater", ratings="rating"
    )
    assert_allclose(ours["icc"], theirs["ICC"], atol=1e-12)
    assert_allclose(ours["f"], theirs["F"], rtol=1e-10)
    interval = "CI95%" if "CI95%" in theirs else "CI95"
    assert_allclose(ours[["ci_low", "ci_high"]], np.stack(theirs[interval]), atol=0.0051)


def test_mixed_model_and_closed_formula_agree_on_complete_ratings() -> None:
    fit = fit_mixed_model("rating ~ 1 + (1|target) + (1|rater)", long_form(SHROUT_FLEISS))
    icc = intraclass_correlation(fit.variance_components, "rater")
    assert icc == pytest.approx(two_way_icc(SHROUT_FLEISS).loc["ICC(2,1)", "icc"], abs=1e-7)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("shape", [(4, 3), (8, 2), (30, 5)])
def test_reml_gives_the_closed_forms_where_no_component_is_zero(
    seed: int, shape: tuple[int, int]
) -> None:
    """On complete ratings REML is the analysis of variance unless a mean square is too small."""
    rng = np.random.default_rng([seed, *shape])
    n, k = shape
    table = 5 * rng.normal(size=(n, 1)) + 5 * rng.normal(size=k) + rng.normal(size=shape)
    rest = table - table.mean(1, keepdims=True) - table.mean(0) + table.mean()
    error = (rest**2).sum() / ((n - 1) * (k - 1))
    closed = [
        table.mean(axis=1).var(ddof=1) - error / k,
        table.mean(axis=0).var(ddof=1) - error / n,
        error,
    ]
    assert min(closed) > 0
    fit = fit_mixed_model("rating ~ 1 + (1|target) + (1|rater)", long_form(table))
    assert_allclose(fit.variance_components, closed, rtol=1e-6)
    icc = intraclass_correlation(fit.variance_components, "rater")
    assert icc == pytest.approx(two_way_icc(table).loc["ICC(2,1)", "icc"], abs=1e-8)


@given(st.integers(2, 9), st.integers(2, 6), st.integers(0, 10_000))
def test_order_does_not_matter_and_limits_hold_the_estimate(n: int, k: int, seed: int) -> None:
    rng = np.random.default_rng(seed)
    table = rng.normal(size=(n, 1)) + rng.normal(size=(n, k))
    found = two_way_icc(table)
    assert_allclose(two_way_icc(rng.permutation(rng.permutation(table), axis=1)), found, rtol=1e-6)
    assert found["p"].between(0.0, 1.0).all()
    for model in "123":
        both = found.loc[[f"ICC({model},1)", f"ICC({model},k)"]]
        single, average = both["icc"]
        if single > 0.0:
            assert average == pytest.approx(k * single / (1 + (k - 1) * single), rel=1e-6)
            assert (both["ci_low"] <= both["icc"]).all()
            assert (both["icc"] <= both["ci_high"]).all()
            assert (both["ci_high"] <= 1.0).all()


def test_limits_hold_the_estimate_when_targets_differ_less_than_chance() -> None:
    """A negative share would give the approximation negative or no degrees of freedom."""
    rng = np.random.default_rng(12)
    for shape in [(2, 2), (3, 2), (2, 3), (5, 4)] * 50:
        table = rng.normal(size=shape)
        table -= 0.9 * table.mean(axis=1, keepdims=True)
        row = two_way_icc(table).loc["ICC(2,1)"]
        assert row["ci_low"] <= row["icc"] <= row["ci_high"] < 1.0
    beyond = two_way_icc([[1.0, 6.0, 2.0], [6.0, 1.0, 3.0], [3.0, 2.5, 5.0]])
    assert beyond.loc["ICC(2,1)", "icc"] < -0.5
    assert np.isneginf(beyond.loc["ICC(2,k)", "icc"])


def test_limits_of_consistency_cover_the_truth_exactly_as_often_as_they_say() -> None:
    """Its interval is exact under normal ratings; 1000 tables at level 0.8."""
    rng = np.random.default_rng(20)
    truth, covered = 4.0 / 5.0, 0
    for _ in range(1000):
        table = 2 * rng.normal(size=(8, 1)) + rng.normal(size=3) + rng.normal(size=(8, 3))
        row = two_way_icc(table, level=0.8).loc["ICC(3,1)"]
        covered += row["ci_low"] <= truth <= row["ci_high"]
    assert abs(covered / 1000 - 0.8) < 4 * np.sqrt(0.8 * 0.2 / 1000)


def test_icc_does_not_depend_on_shift_and_scale_of_the_ratings() -> None:
    moved = two_way_icc(3.0 * SHROUT_FLEISS + 100.0)
    assert_allclose(moved, two_way_icc(SHROUT_FLEISS), rtol=1e-8)


@pytest.mark.parametrize(
    ("form", "trial", "n_components"),
    [("printed", "t", 13), ("recommended", "t", 9), ("printed", None, 6), ("recommended", None, 4)],
)
def test_number_of_components(form: str, trial: str | None, n_components: int) -> None:
    formula = reliability_formula(
        form,  # type: ignore[arg-type]
        outcome="y",
        patient="p",
        exercise="e",
        rater="r",
        trial=trial,
    )
    groups = [part.split(")")[0] for part in formula.split("(1|")[1:]]
    assert len(groups) == n_components
    assert len({frozenset(group.split(":")) for group in groups}) == n_components
    assert {"t"} not in [set(group.split(":")) for group in groups]


def test_components_with_the_rater_count_as_unreliability() -> None:
    components = pd.Series(
        {"p": 2.0, "p:e": 1.0, "r": 0.5, "p:r": 0.5, "p:t": 1.0, "Residual": 1.0}
    )
    assert intraclass_correlation(components, "r") == pytest.approx(4.0 / 6.0)
    table = pd.DataFrame([components, 2 * components])
    assert_allclose(intraclass_correlation(table, "r"), [4.0 / 6.0, 4.0 / 6.0])


def test_a_rater_without_component_is_an_error() -> None:
    with pytest.raises(ModelError, match="no variance component contains 'judge'"):
        intraclass_correlation(pd.Series({"p": 1.0, "Residual": 1.0}), "judge")


@pytest.mark.parametrize(
    ("icc", "word"),
    [(0.49, "poor"), (0.5, "moderate"), (0.749, "moderate"), (0.75, "good"), (0.9, "good"),
     (0.901, "excellent")],
)  # fmt: skip
def test_reliability_classes(icc: float, word: str) -> None:
    assert reliability_class(icc) == word


def test_bootstrap_interval_holds_the_estimate_and_does_not_depend_on_processes() -> None:
    rng = np.random.default_rng(4)
    table = 2 * rng.normal(size=(15, 1)) + 0.5 * rng.normal(size=4) + rng.normal(size=(15, 4))
    fit = fit_mixed_model("rating ~ 1 + (1|target) + (1|rater)", long_form(table))
    alone = bootstrap_icc(fit, "rater", n=60, seed=5, level=0.95)
    assert alone.ci_low < alone.icc < alone.ci_high
    assert alone.n_not_converged == 0
    assert bootstrap_icc(fit, "rater", n=60, seed=5, level=0.95, processes=2) == alone


def test_bootstrap_limits_are_percentiles_of_single_refits() -> None:
    rng = np.random.default_rng(6)
    table = long_form(2 * rng.normal(size=(9, 1)) + rng.normal(size=3) + rng.normal(size=(9, 3)))
    fit = fit_mixed_model("rating ~ 1 + (1|target) + (1|rater)", table)
    shares = []
    for response in fit.simulate(30, seed=[2, 9]):
        one = fit_mixed_model(fit.formula, table.assign(rating=response)).variance_components
        shares.append(one["target"] / (one["target"] + one["rater"] + one["Residual"]))
    found = bootstrap_icc(fit, "rater", n=30, seed=[2, 9], level=0.8)
    assert_allclose([found.ci_low, found.ci_high], np.quantile(shares, [0.1, 0.9]), atol=1e-6)
    assert found.n_refits == 30


@pytest.mark.parametrize(
    ("table", "line"),
    [
        ([[1.0, np.nan], [2.0, 3.0]], "a rating is missing"),
        ([[1.0, 2.0]], r"no table of targets by raters; .* found \(1, 2\)"),
        ([[1.0], [2.0]], r"no table of targets by raters; .* found \(2, 1\)"),
        ([1.0, 2.0], "no table of targets by raters"),
        ([[3.0, 3.0], [3.0, 3.0]], "all ratings are equal; found 3.0"),
        ([[1.0, 2.0], [4.0, 5.0], [0.3, 1.3]], "no residual variance; found raters that differ"),
    ],
)
def test_tables_that_cannot_tell_are_refused(table: object, line: str) -> None:
    with pytest.raises(ModelError, match=line):
        two_way_icc(table)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"r": 1}, "the grouping factor r has 1 level; expected 2 or more"),
        ({"p": 1}, "the grouping factor p has 1 level"),
        ({"y": 2.0}, "the outcome is constant; found 2 in all 48 rows"),
        ({"y": np.nan}, "the column y is missing in 48 of 48 rows"),
    ],
)
def test_ratings_that_cannot_tell_are_refused(change: dict[str, float], line: str) -> None:
    levels = pd.MultiIndex.from_product([range(4), range(4), range(3)], names=["p", "e", "r"])
    ratings = levels.to_frame(index=False)
    ratings["y"] = np.random.default_rng(0).normal(size=len(ratings))
    formula = reliability_formula("recommended", outcome="y", patient="p", exercise="e", rater="r")
    with pytest.raises(ModelError, match=line):
        fit_mixed_model(formula, ratings.assign(**change))


def test_the_form_of_the_model_is_one_of_two() -> None:
    with pytest.raises(ModelError, match="expected printed or recommended; found crossed"):
        reliability_formula(
            "crossed",  # type: ignore[arg-type]
            outcome="y",
            patient="p",
            exercise="e",
            rater="r",
        )


def test_an_icc_needs_a_residual_a_level_and_draws() -> None:
    with pytest.raises(ModelError, match="residual variance is absent; found p, r, p:r"):
        intraclass_correlation(pd.Series({"p": 1.0, "r": 1.0, "p:r": 1.0}), "r")
    with pytest.raises(ModelError, match="no variance to share"):
        intraclass_correlation(pd.Series({"p": 0.0, "r": 0.0, "Residual": 0.0}), "r")
    with pytest.raises(ModelError, match="confidence level is no probability; found 95"):
        two_way_icc(SHROUT_FLEISS, level=95)
    fit = fit_mixed_model("rating ~ 1 + (1|target) + (1|rater)", long_form(SHROUT_FLEISS))
    with pytest.raises(ModelError, match="confidence level is no probability; found 0"):
        bootstrap_icc(fit, "rater", n=10, seed=1, level=0)
    with pytest.raises(ModelError, match=r"too few draws for an interval; .* found 1"):
        bootstrap_icc(fit, "rater", n=1, seed=1, level=0.9)
