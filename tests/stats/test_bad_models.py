"""Models that cannot be fitted are refused in one line that says what to change."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ModelError
from swaystride.stats.mixed_design import MixedDesign
from swaystride.stats.mixed_fit import fit_design
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.mixed_refits import refit_responses


@pytest.fixture
def table() -> pd.DataFrame:
    rng = np.random.default_rng(0)
    frame = pd.DataFrame([(p, r) for p in "abcde" for r in "uvwx"], columns=["who", "rater"])
    frame["y"], frame["x"] = rng.normal(size=20), rng.normal(size=20)
    frame["minus"], frame["same"] = 1.0 - frame["x"], 7.0
    frame["row"], frame["one"] = np.arange(20), "all"
    frame["gap"] = frame["x"].where(frame["row"] > 2)
    frame["team"] = frame["who"].where(frame["row"] != 7)
    frame["sum"] = frame["who"].map(ord) + 2.0 * frame["rater"].map(ord)
    frame["yes"] = frame["y"] > 0
    return frame


@pytest.mark.parametrize(
    ("formula", "line"),
    [
        ("same ~ x + (1|who)", "the outcome is constant; found 7 in all 20 rows"),
        ("same ~ x + (1|who) + (1|rater)", "the outcome is constant; found 7 in all 20 rows"),
        ("minus ~ x + (1|who)", "the fixed effects reproduce the outcome exactly"),
        (
            "y ~ x + (1|row)",
            "the random intercept of row cannot be told from the residual; "
            "expected fewer levels than rows; found 20 levels in 20 rows",
        ),
        (
            "y ~ x + (1|who) + (1|who:rater)",
            "the random intercept of who:rater cannot be told from the residual; "
            "expected fewer levels than rows; found 20 levels in 20 rows",
        ),
        (
            "y ~ x + minus + (1|who)",
            "the fixed effects are collinear; found minus is given by Intercept, x",
        ),
        (
            "y ~ who + (1|who)",
            "the fixed effects already determine every level of who",
        ),
        ("y ~ x + (1|one)", "the grouping factor one has 1 level; expected 2 or more"),
        (
            "y ~ x + (1|who) + (1|one:who)",
            "the grouping factors who and one:who divide the rows in the same way",
        ),
        (
            "y ~ gap + (1|who)",
            "the column gap is missing in 3 of 20 rows; expected complete rows",
        ),
        (
            "gap ~ x + (1|who)",
            "the column gap is missing in 3 of 20 rows; expected complete rows",
        ),
        (
            "y ~ x + (1|team:rater)",
            "the column team is missing in 1 of 20 rows; expected complete rows",
        ),
        (
            "y ~ x + (1|nobody)",
            "there is no column nobody; expected one of who, rater, y, x, minus, same, row, one, "
            "gap, team, sum, yes",
        ),
        (
            "y ~ x + (x|who)",
            "y ~ x + (x|who): random slopes are out of scope: (x|who); "
            "expected random intercepts only, '(1|group)'",
        ),
        (
            "y ~ x + (1 + x|who)",
            "y ~ x + (1 + x|who): random slopes are out of scope: (1 + x|who); "
            "expected random intercepts only, '(1|group)'",
        ),
    ],
)
def test_formulas(table, formula, line):
    with pytest.raises(ModelError) as error:
        fit_mixed_model(formula, table)
    assert str(error.value) == line


def test_an_outcome_that_crossed_groups_reproduce(table):
    twice = pd.concat([table, table], ignore_index=True)
    with pytest.raises(ModelError) as error:
        fit_mixed_model("sum ~ 1 + (1|who) + (1|rater)", twice)
    assert str(error.value) == "the groups reproduce the outcome: no residual variance is left"


def test_another_family(table):
    with pytest.raises(ModelError) as error:
        fit_mixed_model("yes ~ x + (1|who)", table, family="binomial")
    assert str(error.value) == (
        "generalised linear mixed models are out of scope; expected family 'gaussian'; "
        "found 'binomial'"
    )


def test_kenward_roger(table):
    fit = fit_mixed_model("y ~ x + (1|who)", table)
    with pytest.raises(ModelError) as error:
        fit.fixed_effects("kenward-roger")
    assert str(error.value) == (
        "unknown degrees of freedom; expected satterthwaite or residual "
        "(Kenward-Roger is out of scope); found kenward-roger"
    )


@pytest.mark.parametrize(
    ("change", "line"),
    [
        (lambda Y: np.where(np.arange(3)[:, None] == 1, np.nan, Y), "response 1 is not finite"),
        (lambda Y: np.where(np.arange(20) == 4, np.inf, Y), "response 0 is not finite"),
        (
            lambda Y: Y[:, :-1],
            "the responses do not fit the design; expected an array of shape (N, 20); "
            "found (3, 19)",
        ),
        (
            lambda Y: Y[0],
            "the responses do not fit the design; expected an array of shape (N, 20); found (20,)",
        ),
    ],
)
@pytest.mark.parametrize("groups", ["(1|who)", "(1|who) + (1|rater)"])
def test_responses(table, groups, change, line):
    fit = fit_mixed_model(f"y ~ x + {groups}", table)
    with pytest.raises(ModelError) as error:
        fit.refit_many(change(fit.simulate(3, seed=1)))
    assert str(error.value) == line


@pytest.mark.parametrize(
    ("groups", "line"),
    [
        ("(1|who)", "response 2 is reproduced by the groups"),
        ("(1|who) + (1|rater)", "response 2: the outcome is constant; found 7 in all 20 rows"),
    ],
)
def test_a_constant_response(table, groups, line):
    fit = fit_mixed_model(f"y ~ x + {groups}", table)
    responses = fit.simulate(3, seed=1)
    responses[2] = table["same"]
    with pytest.raises(ModelError) as error:
        fit.refit_many(responses)
    assert str(error.value) == line


def test_no_process(table):
    fit = fit_mixed_model("y ~ x + (1|who) + (1|rater)", table)
    with pytest.raises(ModelError) as error:
        fit.refit_many(fit.simulate(2, seed=1), processes=0)
    assert str(error.value) == "no process to work with; expected 1 or more; found 0"


def test_outcomes_given_as_arrays(table):
    design = fit_mixed_model("y ~ x + (1|who)", table).estimates.design
    assert isinstance(design, MixedDesign)
    with pytest.raises(ModelError) as error:
        fit_design(design, table["gap"].to_numpy())
    assert str(error.value) == "the outcome is not finite"
    with pytest.raises(ModelError) as error:
        refit_responses(design, table[["gap"]].to_numpy().T, reml=True)
    assert str(error.value) == "response 0 is not finite"
