import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student

from swaystride.errors import ModelError
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_model import fit_mixed_model


@pytest.mark.parametrize("reml", [True, False])
@pytest.mark.parametrize("groups", ["(1|p)", "(1|p:e)", "(1|p) + (1|r)"])
def test_many_at_once_equal_one_by_one(crossed, groups, reml):
    fit = fit_mixed_model(f"y ~ x + {groups}", crossed(), reml=reml)
    responses = fit.simulate(25, seed=4)
    responses[::3] = np.random.default_rng(1).normal(size=responses[::3].shape)  # often singular
    refits = fit.refit_many(responses)
    assert refits.converged.all()
    assert (refits.variance_components.iloc[::3, 0] == 0.0).any()
    for at, y in enumerate(responses):
        single = fit_design(fit.estimates.design, y, reml=reml)
        np.testing.assert_allclose(refits.estimates.iloc[at], single.beta, atol=1e-8)
        np.testing.assert_allclose(
            refits.se.iloc[at], np.sqrt(np.diag(single.covariance)), rtol=1e-7
        )
        np.testing.assert_allclose(
            refits.variance_components.iloc[at], single.variances, rtol=1e-6, atol=1e-9
        )
        assert refits.loglik[at] == pytest.approx(single.loglik, abs=1e-9)


def test_simulated_responses_have_the_moments_of_the_model(crossed):
    frame = crossed()
    fit = fit_mixed_model("y ~ x + (1|p) + (1|p:e)", frame)
    responses = fit.simulate(20000, seed=1)
    V = fit.estimates.sigma2 * np.eye(len(frame))
    for variance, factor in zip(
        fit.estimates.variances, fit.estimates.design.factors, strict=False
    ):
        V += variance * (factor.codes[:, None] == factor.codes[None, :])
    mean = fit.estimates.design.X @ fit.estimates.beta
    np.testing.assert_allclose(responses.mean(axis=0), mean, atol=5 * np.sqrt(V[0, 0] / 20000))
    np.testing.assert_allclose(np.cov(responses.T), V, atol=0.06 * V[0, 0])


def test_intervals_cover_the_truth(one_way):
    fit = fit_mixed_model("y ~ x + z + (1|who)", one_way(groups=40, size=4))
    refits = fit.refit_many(fit.simulate(4000, seed=11))
    distance = np.abs(refits.estimates - fit.estimates.beta) / refits.se
    coverage = (distance <= student.ppf(0.975, fit.fixed_effects()["df"])).mean()
    assert ((coverage > 0.935) & (coverage < 0.965)).all()
    mean = refits.variance_components.mean()  # REML is unbiased where zero is far away
    np.testing.assert_allclose(mean, fit.variance_components, rtol=0.03)


def test_chunks_do_not_show(one_way, monkeypatch):
    from swaystride.stats import mixed_refits

    fit = fit_mixed_model("y ~ x + (1|who)", one_way())
    responses = fit.simulate(50, seed=0)
    whole = fit.refit_many(responses)
    monkeypatch.setattr(mixed_refits, "_CHUNK", 7)
    parts = fit.refit_many(responses)
    np.testing.assert_allclose(parts.estimates, whole.estimates, rtol=1e-9)
    np.testing.assert_allclose(parts.loglik, whole.loglik, rtol=1e-12)


@pytest.mark.parametrize("groups", ["(1|p)", "(1|p) + (1|r)"])
def test_no_responses_give_empty_tables(crossed, groups):
    fit = fit_mixed_model(f"y ~ x + {groups}", crossed())
    refits = fit.refit_many(np.empty((0, fit.n_observations)))
    assert refits.estimates.shape == (0, 2)
    assert len(refits.loglik) == len(refits.variance_components) == 0


def test_unfit_responses_are_refused(one_way):
    frame = one_way()
    fit = fit_mixed_model("y ~ x + (1|who)", frame)
    with pytest.raises(
        ModelError, match=r"do not fit the design; expected an array of shape \(N, 40"
    ):
        fit.refit_many(np.zeros((2, 39)))
    responses = fit.simulate(3, seed=0)
    responses[1, 4] = np.nan
    with pytest.raises(ModelError, match="response 1 is not finite"):
        fit.refit_many(responses)
    responses[1] = frame["who"]
    with pytest.raises(ModelError, match="response 1 is reproduced by the groups"):
        fit.refit_many(responses)


def test_the_number_of_processes_does_not_show(crossed):
    fit = fit_mixed_model("y ~ x + (1|p) + (1|r) + (1|p:e)", crossed())
    responses = fit.simulate(7, seed=2)
    alone, shared = (fit.refit_many(responses, processes=processes) for processes in (1, 2))
    for name in ("estimates", "se", "variance_components"):
        pd.testing.assert_frame_equal(getattr(alone, name), getattr(shared, name), check_exact=True)
    assert alone.loglik.tolist() == shared.loglik.tolist()
    assert alone.converged.tolist() == shared.converged.tolist()
    responses[5] = 1.0
    with pytest.raises(ModelError, match="response 5: the outcome is constant; found 1 in all"):
        fit.refit_many(responses, processes=2)
