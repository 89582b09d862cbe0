import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ModelError
from swaystride.stats import clustered_mixed_model
from swaystride.stats.cluster_bootstrap import cluster_weights
from swaystride.stats.clustered_mixed_model import (
    resampled_fixed_effects,
    resampled_random_intercepts,
)
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model

MODELS = [
    "(1|p) + (1|r)",
    "(1|p) + (1|p:e) + (1|r) + (1|p:r)",
    "(1|p:e) + (1|r) + (1|e) + (1|e:r)",
    "(1|p)",
    "(1|r)",
]


def resampled_table(frame: pd.DataFrame, cluster: str, weight: np.ndarray) -> pd.DataFrame:
    """The table of a resample; each copy of a cluster has a label of its own."""
    labels = np.unique(frame[cluster])
    copies = [
        frame[frame[cluster] == label].assign(**{cluster: f"{label}-{copy}"})
        for label, times in zip(labels, weight, strict=True)
        for copy in range(times)
    ]
    return pd.concat(copies, ignore_index=True)


def dense_fixed_effects(fit: MixedModelFit, frame: pd.DataFrame) -> np.ndarray:
    """Generalised least squares with H written out, at the ratios of the fit."""
    H = np.eye(len(frame))
    for name, ratio in zip(fit.n_groups, fit.estimates.gamma, strict=True):
        code = frame.groupby(name.split(":")).ngroup().to_numpy()
        H += ratio * (code[:, None] == code[None, :])
    X = np.column_stack([np.ones(len(frame)), frame["x"], frame["z"]])
    root = np.linalg.cholesky(H)
    white = np.linalg.solve(root, np.column_stack([X, frame["y"]]))
    return np.linalg.lstsq(white[:, :-1], white[:, -1], rcond=None)[0]


@pytest.fixture
def rated(crossed) -> pd.DataFrame:
    """Ratings with a covariate within patients and one between exercises."""
    frame = crossed(3)
    return frame.assign(z=np.array([0.3, -1.0, 0.5, 1.5, -0.2])[frame["e"]], y=frame["y"] + 50.0)


@pytest.mark.parametrize("groups", MODELS)
def test_resamples_equal_dense_least_squares_on_the_resampled_table(rated, groups):
    fit = fit_mixed_model(f"y ~ x + z + {groups}", rated)
    assert (fit.estimates.gamma > 0.0).any()
    weights = cluster_weights(6, 12, seed=5)
    assert weights.max() > 2
    draws = resampled_fixed_effects(fit, rated["p"], weights)
    for weight, draw in zip(weights, draws, strict=True):
        twin = dense_fixed_effects(fit, resampled_table(rated, "p", weight))
        np.testing.assert_allclose(draw, twin, rtol=1e-9, atol=1e-9)


def test_clusters_crossed_with_everything(rated):
    """Resampled raters: a patient keeps one effect, the pair of patient and rater is new."""
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|p:e) + (1|r) + (1|p:r)", rated)
    weights = cluster_weights(5, 6, seed=1)
    draws = resampled_fixed_effects(fit, rated["r"], weights)
    for weight, draw in zip(weights, draws, strict=True):
        twin = dense_fixed_effects(fit, resampled_table(rated, "r", weight))
        np.testing.assert_allclose(draw, twin, rtol=1e-9, atol=1e-9)


def test_each_cluster_once_is_the_fit(rated):
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|p:e) + (1|r)", rated)
    draws = resampled_fixed_effects(fit, rated["p"], np.ones((1, 6)))
    np.testing.assert_allclose(draws[0], fit.estimates.beta, atol=1e-12)


def test_component_at_zero_plays_no_part(rated):
    rng = np.random.default_rng(6)
    frame = rated.assign(y=rng.normal(size=6)[rated["p"]] + rng.normal(size=len(rated)))
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|r)", frame)
    assert fit.variance_components["r"] == 0.0
    weights = cluster_weights(6, 5, seed=2)
    draws = resampled_fixed_effects(fit, frame["p"], weights)
    for weight, draw in zip(weights, draws, strict=True):
        twin = dense_fixed_effects(fit, resampled_table(frame, "p", weight))
        np.testing.assert_allclose(draw, twin, rtol=1e-9, atol=1e-9)


def test_held_ratios_are_close_to_full_refits():
    """Draws within a fifth of a standard error (root mean square), their spread within 5 %.

    A covariate that differs between exercises within a patient is the hardest case.
    """
    rng = np.random.default_rng(1)
    rows = [
        (p, e, r, t)
        for p in range(10)
        for e in range(6)
        for r in rng.permutation(6)[:3]
        for t in range(2)
    ]
    frame = pd.DataFrame(rows, columns=["p", "e", "r", "t"])
    frame["x"] = rng.normal(size=60)[frame.groupby(["p", "e"]).ngroup()]
    frame["z"] = frame["e"] % 3
    frame["y"] = 3.0 + 0.3 * frame["x"] + 0.6 * rng.normal(size=len(frame))
    for names, sd in [(["p"], 0.5), (["p", "e"], 0.6), (["r"], 0.4)]:
        code = frame.groupby(names).ngroup().to_numpy()
        frame["y"] += sd * rng.normal(size=code.max() + 1)[code]
    formula = "y ~ x + z + (1|p) + (1|p:e) + (1|r)"
    fit = fit_mixed_model(formula, frame)
    weights = cluster_weights(10, 40, seed=1)
    held = resampled_fixed_effects(fit, frame["p"], weights)
    refits = np.array(
        [
            fit_mixed_model(formula, resampled_table(frame, "p", weight)).estimates.beta
            for weight in weights
        ]
    )
    distance = (held - refits) / refits.std(axis=0)
    assert (np.sqrt((distance**2).mean(axis=0)) < 0.2).all()
    assert (distance != 0.0).all()
    np.testing.assert_allclose(held.std(axis=0) / refits.std(axis=0), 1.0, atol=0.05)


def test_chunks_do_not_show(rated, monkeypatch):
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|r)", rated)
    weights = cluster_weights(6, 20, seed=3)
    whole = resampled_fixed_effects(fit, rated["p"], weights)
    monkeypatch.setattr(clustered_mixed_model, "_NUMBERS_AT_ONCE", 600)
    parts = resampled_fixed_effects(fit, rated["p"], weights)
    np.testing.assert_allclose(parts, whole, rtol=1e-12)
    assert resampled_fixed_effects(fit, rated["p"], np.empty((0, 6))).shape == (0, 3)


def test_unfit_clusters_and_weights_are_refused(rated):
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|r)", rated)
    ones = np.ones((3, 6))
    with pytest.raises(ModelError, match=f"expected {len(rated)} rows; found 3"):
        resampled_fixed_effects(fit, ["a", "b", "c"], ones)
    with pytest.raises(ModelError, match="labelled by other rows than those of the fit"):
        resampled_fixed_effects(fit, rated["p"].iloc[::-1], ones)
    with pytest.raises(ModelError, match=r"expected an array of shape \(n, 6\); found \(3, 5\)"):
        resampled_fixed_effects(fit, rated["p"], ones[:, 1:])
    with pytest.raises(ModelError, match="too few clusters"):
        resampled_fixed_effects(fit, np.zeros(len(rated)), ones)
    for wrong in (-1.0, 0.5, np.nan, np.inf):
        weights = ones.copy()
        weights[1, 2] = wrong
        with pytest.raises(ModelError, match="weights of resample 1 are no multiplicities"):
            resampled_fixed_effects(fit, rated["p"], weights)
    with pytest.raises(ModelError, match="resample 2 holds no cluster"):
        resampled_fixed_effects(fit, rated["p"], ones * [[1], [1], [0]])


def test_resample_without_data_on_an_effect_is_named(rated, monkeypatch):
    frame = rated.assign(x=rated["x"].where(rated["p"] == 4, 0.0))
    fit = fit_mixed_model("y ~ x + z + (1|p) + (1|r)", frame)
    monkeypatch.setattr(clustered_mixed_model, "_NUMBERS_AT_ONCE", 1)
    with pytest.raises(ModelError, match="resample 1 does not determine the fixed effects"):
        resampled_fixed_effects(fit, frame["p"], [[1, 1, 1, 1, 1, 1], [2, 1, 1, 1, 0, 1]])
    with pytest.raises(ModelError, match="resample 0 does not determine the fixed effects"):
        resampled_random_intercepts(
            frame["y"], frame["x"], frame["p"], [[2, 1, 1, 1, 0, 1]], reml=True
        )


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize(("columns", "sd"), [("x", 1.0), ("x", 0.3), ("z", 1.0), ("x + z", 0.6)])
def test_random_intercepts_equal_refits_of_the_resampled_table(one_way, columns, sd, reml):
    frame = one_way(groups=7, size=6, sd=sd, seed=3).sample(frac=0.85, random_state=1)
    frame["y"] += 100.0
    weights = cluster_weights(7, 40, seed=2)
    draws = resampled_random_intercepts(
        frame["y"], frame[columns.split(" + ")], frame["who"], weights, reml=reml
    )
    assert draws.converged.all()
    if sd == 0.3:
        at_zero = draws.cluster_variance == 0.0
        assert 0.1 < at_zero.mean() < 0.9
    for at, weight in enumerate(weights):
        table = resampled_table(frame, "who", weight)
        fit = fit_mixed_model(f"y ~ {columns} + (1|who)", table, reml=reml)
        np.testing.assert_allclose(draws.fixed_effects[at], fit.estimates.beta, atol=1e-8)
        np.testing.assert_allclose(
            [draws.cluster_variance[at], draws.residual_variance[at]],
            fit.estimates.variances,
            rtol=1e-6,
            atol=1e-9,
        )
        fixed = fit.estimates.design.X @ fit.estimates.beta
        np.testing.assert_allclose(draws.fixed_variance[at], fixed.var(ddof=1), rtol=1e-7)


@pytest.mark.parametrize("reml", [True, False])
def test_balanced_layout_has_the_closed_form(one_way, reml):
    """Mean squares of a balanced one-way layout with a covariate orthogonal to groups."""
    frame = one_way(groups=8, size=5, sd=1.5)
    draws = resampled_random_intercepts(
        frame["y"], frame["x"], frame["who"], np.ones((1, 8)), reml=reml
    )
    slope = (frame["x"] @ frame["y"]) / (frame["x"] @ frame["x"])
    rest = frame["y"] - slope * frame["x"]
    means = rest.groupby(frame["who"]).transform("mean")
    within = ((rest - means) ** 2).sum() / (40 - 8 - (1 if reml else 0))
    between = ((means - rest.mean()) ** 2).sum() / (7 if reml else 8)
    np.testing.assert_allclose(draws.fixed_effects[0], [frame["y"].mean(), slope], rtol=1e-12)
    np.testing.assert_allclose(draws.residual_variance[0], within, rtol=1e-9)
    np.testing.assert_allclose(draws.cluster_variance[0], (between - within) / 5, rtol=1e-9)


def test_units_of_outcome_and_covariate(one_way):
    frame, weights = one_way(), cluster_weights(8, 20, seed=1)
    first = resampled_random_intercepts(frame["y"], frame["x"], frame["who"], weights, reml=True)
    other = resampled_random_intercepts(
        1e3 * frame["y"] - 7.0, 1e-4 * frame["x"] + 2.0, frame["who"], weights, reml=True
    )
    np.testing.assert_allclose(other.fixed_effects[:, 1], 1e7 * first.fixed_effects[:, 1])
    np.testing.assert_allclose(other.residual_variance, 1e6 * first.residual_variance)
    np.testing.assert_allclose(other.cluster_variance, 1e6 * first.cluster_variance, atol=1.0)
    np.testing.assert_allclose(other.fixed_variance, 1e6 * first.fixed_variance)


def test_unfit_random_intercepts_are_refused(one_way):
    frame = one_way()
    y, x, who, ones = frame["y"], frame["x"], frame["who"], np.ones((2, 8))

    def fit(y=y, x=x, clusters=who, weights=ones):
        return resampled_random_intercepts(y, x, clusters, weights, reml=True)

    with pytest.raises(ModelError, match=r"outcome and covariates do not fit.*\(40,\) and \(39,\)"):
        fit(x=x[1:])
    with pytest.raises(ModelError, match="expected 40 rows; found 39"):
        fit(clusters=who[1:])
    with pytest.raises(ModelError, match="the column y is not finite in 1 of 40 rows"):
        fit(y=y.where(y.index != 3))
    with pytest.raises(ModelError, match="the column x1 is not finite in 40 of 40 rows"):
        fit(x=np.column_stack([x, np.full(40, np.inf)]))
    with pytest.raises(ModelError, match="covariates are collinear; found column 1 is given by"):
        fit(x=np.column_stack([x, 2.0 * x + 1.0]))
    with pytest.raises(ModelError, match="resample 1 holds a single cluster"):
        fit(weights=[[1] * 8, [1] + [0] * 7])
    with pytest.raises(ModelError, match="resample 0 is reproduced by the clusters"):
        fit(y=who + 2.0 * x)
