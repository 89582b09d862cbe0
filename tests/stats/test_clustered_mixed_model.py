"""Cluster resamples of mixed models against tables that really are resampled."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from numpy.testing import assert_allclose

from swaystride.errors import ModelError
from swaystride.stats.cluster_bootstrap import cluster_weights
from swaystride.stats.clustered_mixed_model import (
    resampled_fixed_effects,
    resampled_random_intercepts,
)
from swaystride.stats.linear_prediction import (
    least_squares_prediction,
    leave_one_cluster_out,
)
from swaystride.stats.mixed_model import fit_mixed_model


@pytest.fixture(scope="module")
def ratings() -> pd.DataFrame:
    rng = np.random.default_rng(1)
    rows = []
    raters = rng.normal(0, 0.6, 5)
    for patient in range(7):
        ability, own = rng.normal(0, 1.0), rng.normal(0, 0.5, 5)
        chosen = rng.choice(5, size=3, replace=False)
        for exercise in range(6):
            x = float(rng.integers(0, 5))
            level = 0.6 * x + ability + rng.normal(0, 0.7)
            for rater in chosen:
                y = level + raters[rater] + own[rater] + rng.normal(0, 0.5)
                rows.append((f"P{patient}", f"E{exercise}", f"R{rater}", x, y))
    return pd.DataFrame(rows, columns=["patient", "exercise", "rater", "x", "y"])


def resample(table: pd.DataFrame, weights: np.ndarray) -> pd.DataFrame:
    """The table as it would be if the drawn patients were different people."""
    names = sorted(table["patient"].unique())
    parts = [
        table[table["patient"] == name].assign(patient=f"{name}-{copy}")
        for name, weight in zip(names, weights, strict=True)
        for copy in range(weight)
    ]
    return pd.concat(parts, ignore_index=True)


def dense_gls(table: pd.DataFrame, ratios: dict[str, float]) -> np.ndarray:
    """Generalised least squares with the covariance written out."""
    covariance = np.eye(len(table))
    for group, ratio in ratios.items():
        label = table[group.split(":")].astype(str).agg(":".join, axis=1).to_numpy()
        covariance += ratio * (label[:, None] == label)
    X = np.column_stack([np.ones(len(table)), table["x"]])
    weighted = np.linalg.solve(covariance, X)
    return np.linalg.solve(X.T @ weighted, weighted.T @ table["y"].to_numpy())


@pytest.mark.parametrize(
    "random",
    [
        "(1|patient) + (1|rater)",
        "(1|patient) + (1|patient:exercise) + (1|rater) + (1|patient:rater)",
    ],
)
def test_resampled_effects_equal_dense_least_squares(ratings: pd.DataFrame, random: str) -> None:
    fit = fit_mixed_model(f"y ~ x + {random}", ratings)
    weights = cluster_weights(7, 6, seed=3)
    ours = resampled_fixed_effects(fit, ratings["patient"], weights)
    components = fit.variance_components
    ratios = (components.drop("Residual") / components["Residual"]).to_dict()
    twins = [dense_gls(resample(ratings, w), ratios) for w in weights]
    assert_allclose(ours, twins, rtol=1e-9, atol=1e-9)


def test_ratios_of_the_fit_stand_for_those_of_each_resample(ratings: pd.DataFrame) -> None:
    formula = "y ~ x + (1|patient) + (1|rater)"
    weights = cluster_weights(7, 40, seed=4)
    held = resampled_fixed_effects(fit_mixed_model(formula, ratings), ratings["patient"], weights)[
        :, 1
    ]
    refitted = [
        fit_mixed_model(formula, resample(ratings, w)).fixed_effects()["estimate"]["x"]
        for w in weights
    ]
    assert np.abs(held - refitted).max() < 0.5 * np.std(refitted)
    assert np.median(np.abs(held - refitted)) < 0.05 * np.std(refitted)
    assert np.std(held) == pytest.approx(np.std(refitted), rel=0.05)


@pytest.mark.parametrize("reml", [True, False])
def test_resampled_random_intercepts_equal_full_refits(ratings: pd.DataFrame, reml: bool) -> None:
    weights = cluster_weights(7, 8, seed=5)
    ours = resampled_random_intercepts(
        ratings["y"], ratings["x"], ratings["patient"], weights, reml=reml
    )
    for row, weight in enumerate(weights):
        twin = fit_mixed_model("y ~ x + (1|patient)", resample(ratings, weight), reml=reml)
        assert_allclose(ours.estimates[row], twin.fixed_effects()["estimate"], rtol=1e-6)
        variances = [ours.cluster_variance[row], ours.residual_variance[row]]
        assert_allclose(variances, twin.variance_components, rtol=1e-5, atol=1e-7)


def test_a_variance_of_zero_stays_zero() -> None:
    y = np.tile([1.0, 2.0, 4.0], 4)
    fits = resampled_random_intercepts(
        y, np.tile([0.0, 1.0, 0.0], 4), np.repeat(np.arange(4), 3), np.ones((1, 4)), reml=True
    )
    assert fits.cluster_variance.tolist() == [0.0]


def test_inputs_that_do_not_fit_are_errors(ratings: pd.DataFrame) -> None:
    fit = fit_mixed_model("y ~ x + (1|patient)", ratings)
    with pytest.raises(ModelError, match="the weights do not fit the clusters"):
        resampled_fixed_effects(fit, ratings["patient"], np.ones((2, 3)))
    with pytest.raises(ModelError, match="the clusters do not fit the rows"):
        resampled_fixed_effects(fit, ratings["patient"][:-1], np.ones((2, 7)))


def test_prediction_equals_least_squares_and_names_what_it_drops() -> None:
    rng = np.random.default_rng(6)
    x = rng.normal(size=(50, 3)) * [1.0, 1e6, 1e-6] + [5.0, 1e7, 1e-4]
    y = x @ [1.0, 2e-6, 3e6] + rng.normal(size=50)
    full = np.column_stack([x, 30.0 * x[:, 0]])
    fit = least_squares_prediction(full, y)
    design = np.column_stack([np.ones(50), (x - x.mean(axis=0)) / x.std(axis=0)])
    expected = design @ np.linalg.lstsq(design, y, rcond=None)[0]
    assert_allclose(fit.predicted, expected, rtol=1e-9)
    assert fit.dropped in ((0,), (3,))
    assert_allclose(fit.predict(full), fit.predicted, rtol=1e-9)


def test_left_out_predictions_do_not_see_the_left_out_outcomes() -> None:
    rng = np.random.default_rng(7)
    x, who = rng.normal(size=(40, 2)), np.repeat(np.arange(4), 10)
    y = x @ [1.0, -1.0] + rng.normal(size=40)
    before = leave_one_cluster_out(x, y, who)
    changed = np.where(who == 2, y + rng.normal(size=40), y)
    after = leave_one_cluster_out(x, changed, who)
    assert_allclose(after[who == 2], before[who == 2], rtol=1e-12)
    assert np.abs(after[who != 2] - before[who != 2]).max() > 1e-3
    rest = who != 2
    twin = least_squares_prediction(x[rest], y[rest]).predict(x[~rest])
    assert_allclose(before[who == 2], twin, rtol=1e-12)


def test_prediction_of_bad_input_is_an_error() -> None:
    with pytest.raises(ModelError, match="the outcome is constant"):
        least_squares_prediction([[1.0], [2.0]], [3.0, 3.0])
    with pytest.raises(ModelError, match="a value is missing"):
        least_squares_prediction([[1.0], [np.nan]], [3.0, 4.0])
