import numpy as np
import pytest

from swaystride.stats.mixed_design import design_from_terms
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.satterthwaite import satterthwaite_df


@pytest.mark.parametrize(("groups", "size"), [(5, 4), (12, 3), (30, 10)])
def test_balanced_one_way_layout_has_the_textbook_degrees_of_freedom(one_way, groups, size):
    frame = one_way(groups=groups, size=size, sd=2.0, seed=1)
    fit = fit_mixed_model("y ~ x + z + (1|who)", frame)
    assert not fit.is_singular
    df = fit.fixed_effects()["df"]
    assert df["Intercept"] == pytest.approx(groups - 2, rel=1e-8)
    assert df["z"] == pytest.approx(groups - 2, rel=1e-8)
    assert df["x"] == pytest.approx(groups * size - groups - 1, rel=1e-8)


def test_maximum_likelihood_counts_the_groups_not_the_contrasts(one_way):
    frame = one_way(groups=10, size=4, sd=2.0)
    df = fit_mixed_model("y ~ x + (1|who)", frame, reml=False).fixed_effects()["df"]
    np.testing.assert_allclose(df, [10.0, 30.0], rtol=1e-8)


@pytest.mark.parametrize(("reml", "expected"), [(True, 38.0), (False, 40.0)])
def test_components_at_zero_leave_the_residual_degrees_of_freedom(one_way, reml, expected):
    frame = one_way(sd=0.0, seed=3)
    frame["y"] -= frame.groupby("who")["y"].transform("mean")
    fit = fit_mixed_model("y ~ x + (1|who)", frame, reml=reml)
    assert fit.is_singular
    np.testing.assert_allclose(fit.fixed_effects()["df"], expected, rtol=1e-10)


@pytest.mark.parametrize("reml", [True, False])
def test_crossed_factors_against_numerical_derivatives(crossed, twin_deviance, reml):
    frame = crossed(seed=6)
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x"], ["p:e", "r"])
    fit = fit_design(design, y, reml=reml)
    codes = [factor.codes for factor in design.factors]
    theta = fit.variances

    def deviance(at):
        return twin_deviance(design.X, codes, y, at[:2] / at[2], reml=reml, sigma2=at[2])

    def covariance(at):
        V = at[2] * np.eye(design.n)
        for variance, code in zip(at[:2], codes, strict=True):
            V += variance * (code[:, None] == code[None, :])
        return np.linalg.inv(design.X.T @ np.linalg.solve(V, design.X))

    steps = np.diag(1e-3 * theta)
    hessian = np.array(
        [
            [
                deviance(theta + a + b)
                - deviance(theta + a - b)
                - deviance(theta - a + b)
                + deviance(theta - a - b)
                for b in steps
            ]
            for a in steps
        ]
    ) / (4 * np.outer(np.diag(steps), np.diag(steps)))
    contrast = np.array([[1.0, 0.5]])
    gradient = np.array(
        [
            (contrast @ (covariance(theta + a) - covariance(theta - a)) @ contrast.T)[0, 0]
            for a in steps
        ]
    ) / (2 * np.diag(steps))
    variance = (contrast @ covariance(theta) @ contrast.T)[0, 0]
    expected = 2 * variance**2 / (gradient @ (2 * np.linalg.inv(hessian)) @ gradient)
    assert satterthwaite_df(fit, contrast)[0] == pytest.approx(expected, rel=1e-4)
