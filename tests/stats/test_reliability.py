"""Reliability: closed formulas, mixed models and pingouin agree; printed classes."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pingouin
import pytest
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


def test_incomplete_and_small_tables_are_errors() -> None:
    with pytest.raises(ModelError, match="a rating is missing"):
        two_way_icc([[1.0, np.nan], [2.0, 3.0]])
    with pytest.raises(ModelError, match="no table of targets by raters"):
        two_way_icc([[1.0, 2.0]])
