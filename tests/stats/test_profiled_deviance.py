"""The one-factor and the block evaluators against V written out, and against each other."""

import numpy as np
import pytest

from swaystride.errors import ModelError
from swaystride.stats.crossed_factors import CrossedStructure
from swaystride.stats.mixed_design import design_from_terms
from swaystride.stats.mixed_fit import ols_residual
from swaystride.stats.one_factor import OneFactorStructure
from swaystride.stats.profiled_deviance import (
    at_component_variance,
    at_residual_variance,
    profiled,
)

CROSSED = [
    ["p"],
    ["p", "r"],
    ["p", "p:e"],
    ["r", "p:e", "p"],
    ["p", "p:e", "r", "p:r", "p:t", "r:t"],
    ["e", "p", "r", "e:p", "e:r", "p:r", "t:e", "e:p:r"],
]


def _bound(structure, design, y):
    return structure(design).bind(ols_residual(design, y))


def _ratios(k, seed, zero):
    gamma = np.random.default_rng(seed).lognormal(-0.5, 1.0, size=k)
    if zero:
        gamma[::2] = 0.0
    return gamma


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize("zero", [True, False])
@pytest.mark.parametrize("groups", CROSSED, ids="+".join)
def test_value_gradient_and_hessian_against_the_written_out_covariance(
    crossed, twin_deviance, groups, zero, reml
):
    frame = crossed()
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x", "t"], groups)
    codes = [factor.codes for factor in design.factors]
    nu = design.n - design.p if reml else design.n
    gamma = _ratios(len(groups), 5, zero)

    def twin(at):
        return twin_deviance(design.X, codes, y, at, reml=reml)

    bound = _bound(CrossedStructure, design, y)
    value, gradient, hessian = profiled(bound.parts(gamma, reml=reml), nu)
    value += design.log_det_xtx if reml else 0.0
    assert value == pytest.approx(twin(gamma), abs=1e-9)
    # differences across zero are legitimate: H stays positive definite for tiny negative ratios
    for i, step in enumerate(1e-5 * np.eye(len(groups))):
        assert gradient[i] == pytest.approx(
            (twin(gamma + step) - twin(gamma - step)) / 2e-5, rel=1e-5, abs=1e-4
        )
        inner = gamma + step + 1e-5
        ahead = profiled(bound.parts(inner + step, reml=reml), nu)[1]
        behind = profiled(bound.parts(inner - step, reml=reml), nu)[1]
        middle = profiled(bound.parts(inner, reml=reml), nu)[2]
        np.testing.assert_allclose(middle[i], (ahead - behind) / 2e-5, rtol=2e-5, atol=1e-4)
    np.testing.assert_allclose(hessian, hessian.T, atol=1e-9)


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize("gamma", [0.0, 1e-6, 0.3, 50.0, 1e4])
def test_closed_form_of_one_factor_equals_the_blocks(crossed, gamma, reml):
    frame = crossed(seed=2)
    design = design_from_terms(frame, ["x", "t"], ["p:e"])
    y, ratio = frame["y"].to_numpy(), np.array([gamma])
    closed = _bound(OneFactorStructure, design, y)
    blocks = _bound(CrossedStructure, design, y)
    one, other = closed.parts(ratio, reml=reml), blocks.parts(ratio, reml=reml)
    for name in vars(one):
        np.testing.assert_allclose(getattr(one, name), getattr(other, name), rtol=1e-8, atol=1e-12)
    left, right = closed.solution(ratio), blocks.solution(ratio)
    np.testing.assert_allclose(left.shift, right.shift, atol=1e-11)
    np.testing.assert_allclose(left.precision, right.precision, atol=1e-10)
    np.testing.assert_allclose(left.random[0], right.random[0], atol=1e-10)
    np.testing.assert_allclose(left.residual, right.residual, atol=1e-10)
    np.testing.assert_allclose(
        OneFactorStructure(design).precision_slopes(ratio),
        CrossedStructure(design).precision_slopes(ratio),
        rtol=1e-8,
        atol=1e-12,
    )


@pytest.mark.parametrize("groups", CROSSED, ids="+".join)
def test_solution_against_the_written_out_covariance(crossed, groups):
    frame = crossed(seed=4)
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x"], groups)
    gamma = _ratios(len(groups), 1, zero=False)
    Z = [np.eye(f.n_levels)[f.codes] for f in design.factors]
    H = np.eye(design.n) + sum(g * z @ z.T for g, z in zip(gamma, Z, strict=True))
    inverse = np.linalg.inv(H)
    precision = design.Q.T @ inverse @ design.Q
    shift = np.linalg.solve(precision, design.Q.T @ inverse @ y) - design.Q.T @ y
    rest = inverse @ (y - design.Q @ (design.Q.T @ y + shift))
    structure = CrossedStructure(design)
    solution = structure.bind(ols_residual(design, y)).solution(gamma)
    np.testing.assert_allclose(solution.precision, precision, atol=1e-10)
    np.testing.assert_allclose(solution.shift, shift, atol=1e-10)
    np.testing.assert_allclose(solution.residual, rest, atol=1e-10)
    for i, z in enumerate(Z):
        np.testing.assert_allclose(solution.random[i], gamma[i] * z.T @ rest, atol=1e-10)
        across = z.T @ inverse @ design.Q
        np.testing.assert_allclose(
            structure.precision_slopes(gamma)[i], across.T @ across, atol=1e-9
        )


@pytest.mark.parametrize("index", [0, 1])
def test_deviances_with_one_variance_held_fixed(crossed, twin_deviance, index):
    frame = crossed()
    y = frame["y"].to_numpy()
    design = design_from_terms(frame, ["x"], ["p", "r"])
    codes = [factor.codes for factor in design.factors]
    bound = _bound(CrossedStructure, design, y)
    gamma = np.array([0.7, 0.2])

    def held(at):
        parts = bound.parts(at, reml=False)
        return at_component_variance(parts, design.n, at, index, 0.4)

    def residual(at):
        return at_residual_variance(bound.parts(at, reml=False), design.n, 0.9)

    expected = twin_deviance(design.X, codes, y, gamma, reml=False, sigma2=0.4 / gamma[index])
    assert held(gamma)[0] == pytest.approx(expected, abs=1e-9)
    expected = twin_deviance(design.X, codes, y, gamma, reml=False, sigma2=0.9)
    assert residual(gamma)[0] == pytest.approx(expected, abs=1e-9)
    for function in (held, residual):
        for i, step in enumerate(1e-5 * np.eye(2)):
            ahead, behind = function(gamma + step), function(gamma - step)
            assert function(gamma)[1][i] == pytest.approx((ahead[0] - behind[0]) / 2e-5, rel=1e-5)
            np.testing.assert_allclose(
                function(gamma)[2][i], (ahead[1] - behind[1]) / 2e-5, rtol=1e-5
            )


@pytest.mark.parametrize("structure", [OneFactorStructure, CrossedStructure])
def test_groups_that_the_fixed_effects_determine_are_refused(one_way, structure):
    frame = one_way(groups=3)
    for level in (1, 2):
        frame[f"is{level}"] = (frame["who"] == level).astype(float)
    design = design_from_terms(frame, ["is1", "is2"], ["who"])
    with pytest.raises(ModelError, match="the fixed effects already determine every level of who"):
        structure(design)
