from itertools import combinations

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ModelError
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.selection import eliminate_terms, raise_to_exponent, search_exponent

TERMS = ["order", "block", "N", "removed", "block:N", "block:order", "removed:order", "age"]


@pytest.fixture
def cohort() -> pd.DataFrame:
    rng = np.random.default_rng(12)
    trials = [(0, 0.0, 0.0)] * 4 + [(N, 1.0, float(N % 3 == 0)) for N in range(1, 16)]
    trials += [(15, 0.0, 0.0)] * 3 + [(N, 0.0, float(N % 3 == 0)) for N in range(16, 31)]
    frame = pd.concat(
        pd.DataFrame(trials, columns=["N", "block", "removed"]).assign(
            who=who, order=float(who % 2), age=rng.normal(70, 5)
        )
        for who in range(12)
    ).reset_index(drop=True)
    frame["y"] = -0.1 * frame["N"] ** 0.4 * (1 + 0.5 * frame["block"]) + 0.3 * frame["removed"]
    frame["y"] += rng.normal(0, 0.3, 12)[frame["who"]] + rng.normal(0, 0.1, len(frame))
    return frame


def test_search_equals_a_formula_fit_at_every_exponent(cohort):
    grid = [0.2, 0.4, 0.6, 1.0, 2.0]
    search = search_exponent(cohort, "y", TERMS, ["who"], base="N", exponents=grid)
    for exponent in grid:
        powered = raise_to_exponent(cohort, "N", exponent)
        fit = fit_mixed_model(f"y ~ {' + '.join(TERMS)} + (1|who)", powered, reml=False)
        assert search.loglik[exponent] == pytest.approx(fit.loglik, abs=1e-9)
    assert search.best == search.loglik.idxmax() == 0.4


def test_base_in_a_product_with_itself_is_raised_twice(cohort):
    search = search_exponent(cohort, "y", ["N", "N:N"], ["who"], base="N", exponents=[0.5])
    cohort["root"] = np.sqrt(cohort["N"])
    fit = fit_mixed_model("y ~ root + N + (1|who)", cohort, reml=False)
    assert search.loglik[0.5] == pytest.approx(fit.loglik, abs=1e-9)


def test_every_step_is_the_best_single_deletion(cohort):
    protected = ["N", "removed"]
    frame = raise_to_exponent(cohort, "N", 0.4)
    result = eliminate_terms(frame, "y", TERMS, ["who"], protected=protected)

    def aic(terms):
        return fit_mixed_model(f"y ~ {' + '.join(terms)} + (1|who)", frame, reml=False).aic

    kept = list(TERMS)
    for row in result.path.itertuples():
        scores = {
            term: aic([t for t in kept if t != term]) for term in kept if term not in protected
        }
        assert row.aic_before == pytest.approx(aic(kept), abs=1e-8)
        assert row.dropped == min(scores, key=scores.get)
        assert row.aic_after == pytest.approx(scores[row.dropped], abs=1e-8)
        assert row.aic_after < row.aic_before
        kept.remove(row.dropped)
    assert result.terms == tuple(kept)
    assert result.path["step"].tolist() == list(range(1, len(result.path) + 1))
    assert result.aic == pytest.approx(aic(kept), abs=1e-8)
    for term in kept:
        if term not in protected:
            assert aic([t for t in kept if t != term]) >= result.aic


def test_marginality_is_ignored_and_protected_terms_stay(cohort):
    rng = np.random.default_rng(3)
    cohort["y"] = cohort["block"] * cohort["N"] + rng.normal(0, 0.1, len(cohort))
    terms = ["block", "N", "block:N", "age"]
    result = eliminate_terms(cohort, "y", terms, ["who"], protected=["age"])
    assert "block:N" in result.terms
    assert "block" not in result.terms
    assert "age" in result.terms


def test_nothing_is_dropped_when_everything_matters(cohort):
    cohort["y"] += 2 * cohort["block"]
    result = eliminate_terms(cohort, "y", ["block", "N", "removed"], ["who"])
    assert result.terms == ("block", "N", "removed")
    assert len(result.path) == 0
    assert list(result.path.columns) == ["step", "dropped", "aic_before", "aic_after"]


def test_the_order_of_the_terms_does_not_matter(cohort):
    frame = raise_to_exponent(cohort, "N", 0.4)
    for order in list(combinations(range(4), 2))[:3]:
        shuffled = [TERMS[at] for at in order] + [
            t for t in TERMS if t not in {TERMS[a] for a in order}
        ]
        one = eliminate_terms(frame, "y", TERMS, ["who"])
        other = eliminate_terms(frame, "y", shuffled, ["who"])
        assert set(one.terms) == set(other.terms)
        assert one.aic == pytest.approx(other.aic, abs=1e-8)


def test_several_grouping_factors_are_allowed(cohort):
    cohort["set"] = cohort.groupby("who").cumcount() // 6
    groups = ["who", "who:set"]
    result = eliminate_terms(cohort, "y", ["N", "removed", "age"], groups)
    terms = " + ".join(result.terms)
    fit = fit_mixed_model(f"y ~ {terms} + (1|who) + (1|who:set)", cohort, reml=False)
    assert result.aic == pytest.approx(fit.aic, abs=1e-7)


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (
            lambda f: search_exponent(f, "y", ["block"], ["who"], base="N", exponents=[1.0]),
            "no term holds the column N; found block",
        ),
        (
            lambda f: search_exponent(f, "y", ["N"], ["who"], base="N", exponents=[]),
            "there is no exponent to choose from",
        ),
        (
            lambda f: search_exponent(f, "y", ["N"], ["who"], base="N", exponents=[-1.0]),
            "the column N is not finite in 48 of 444 rows",
        ),
        (
            lambda f: search_exponent(
                f.assign(N=f["N"] - 1), "y", ["N"], ["who"], base="N", exponents=[0.5]
            ),
            "the column N has no real powers; expected no negative value; found 48 of 444 rows",
        ),
        (
            lambda f: eliminate_terms(f, "y", ["N"], ["who"], protected=["block"]),
            "the protected term block is not in the model; expected N",
        ),
        (lambda f: eliminate_terms(f, "q", ["N"], ["who"]), "there is no column q"),
        (lambda f: eliminate_terms(f.assign(y="a"), "y", ["N"], ["who"]), "y is not numeric"),
        (lambda f: raise_to_exponent(f, "q", 1.0), "there is no column q"),
    ],
)
def test_refusals(cohort, call, line):
    with pytest.raises(ModelError) as error:
        call(cohort)
    assert line in str(error.value)
