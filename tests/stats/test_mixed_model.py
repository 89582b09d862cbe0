import numpy as np
import pandas as pd
import pytest
from scipy.stats import t as student

from swaystride import stats
from swaystride.errors import ModelError
from swaystride.stats.mixed_model import fit_mixed_model


@pytest.fixture
def fit(crossed):
    frame = crossed()
    frame["s"] = np.where(frame["t"] == 0, "first", "later")
    frame.index = [f"row {at}" for at in range(len(frame))]
    return fit_mixed_model("y ~ x*s + (1|p) + (1|p:e)", frame), frame


def test_the_room_exports_what_it_promises():
    for name in stats.__all__:
        assert getattr(stats, name).__name__ == name


def test_interface(fit):
    fit, frame = fit
    assert fit.formula == "y ~ x*s + (1|p) + (1|p:e)"
    assert fit.reml
    assert fit.converged
    assert "converged" in fit.message
    assert not fit.is_singular
    assert fit.n_observations == len(frame)
    assert fit.n_groups == {"p": 6, "p:e": 24}
    assert list(fit.variance_components.index) == ["p", "p:e", "Residual"]
    assert list(fit.fixed_effects().index) == ["Intercept", "x", "s[T.later]", "x:s[T.later]"]
    assert fit.aic == pytest.approx(-2 * fit.loglik + 2 * (4 + 3))
    assert fit.covariance.loc["x", "x"] == pytest.approx(fit.fixed_effects().loc["x", "se"] ** 2)


def test_fitted_values_residuals_and_random_effects_add_up(fit):
    fit, frame = fit
    pd.testing.assert_series_equal(fit.fitted + fit.residuals, frame["y"], check_names=False)
    effects = fit.random_effects()
    cell = frame["p"].astype(str) + ":" + frame["e"].astype(str)
    fixed = fit.estimates.design.X @ fit.fixed_effects()["estimate"].to_numpy()
    expected = fixed + effects["p"][frame["p"].astype(str)].to_numpy()
    expected += effects["p:e"][cell].to_numpy()
    np.testing.assert_allclose(fit.fitted, expected, atol=1e-12)


def test_tests_follow_from_estimate_error_and_degrees_of_freedom(fit):
    fit, _ = fit
    for df in ("satterthwaite", "residual"):
        table = fit.fixed_effects(df, level=0.9)
        np.testing.assert_allclose(table["t"], table["estimate"] / table["se"])
        np.testing.assert_allclose(table["p"], 2 * student.sf(abs(table["t"]), table["df"]))
        half = student.ppf(0.95, table["df"]) * table["se"]
        np.testing.assert_allclose(table["ci_high"] - table["estimate"], half)
        np.testing.assert_allclose(table["estimate"] - table["ci_low"], half)
    assert (fit.fixed_effects("residual")["df"] == fit.n_observations - 4).all()
    pd.testing.assert_frame_equal(
        fit.confint(level=0.9), fit.fixed_effects(level=0.9)[["estimate", "ci_low", "ci_high"]]
    )


def test_contrasts_by_name_vector_and_matrix_are_the_same(fit):
    fit, _ = fit
    named = fit.contrast({"x": 1, "x:s[T.later]": -0.5})
    assert list(named.index) == ["x - 0.5*x:s[T.later]"]
    pd.testing.assert_frame_equal(named, fit.contrast([0, 1, 0, -0.5]))
    matrix = fit.contrast(np.array([[0, 1, 0, -0.5], [-1.0, 0, 0, 0]]), df="residual")
    assert list(matrix.index) == ["x - 0.5*x:s[T.later]", "-Intercept"]
    single = fit.fixed_effects("residual").loc["Intercept"]
    assert matrix.iloc[1]["estimate"] == -single["estimate"]
    assert matrix.iloc[1]["se"] == pytest.approx(single["se"])
    unit = fit.contrast({"x": 1})
    pd.testing.assert_frame_equal(unit, fit.fixed_effects().loc[["x"]])


def test_a_difference_of_levels_does_not_depend_on_the_reference_level(crossed):
    frame = crossed()
    frame["level"] = pd.Categorical(frame["t"].map({0: "a", 1: "b", 2: "c"}))
    one = fit_mixed_model("y ~ level + (1|p) + (1|r)", frame)
    frame["level"] = frame["level"].cat.reorder_categories(["c", "a", "b"])
    other = fit_mixed_model("y ~ level + (1|p) + (1|r)", frame)
    left = one.contrast({"level[T.b]": 1, "level[T.c]": -1})
    right = other.contrast({"level[T.b]": 1})
    np.testing.assert_allclose(left, right, rtol=1e-7)


@pytest.mark.parametrize(
    ("call", "line"),
    [
        (
            lambda f: f.contrast({"q": 1}),
            "there is no fixed effect q; expected one of Intercept, x",
        ),
        (lambda f: f.contrast([1, 2]), "expected 4 weights, for Intercept, x"),
        (lambda f: f.contrast({"x": 0}), "the contrast has no weight"),
        (lambda f: f.fixed_effects("kenward-roger"), "Kenward-Roger is out of scope"),
        (lambda f: f.confint("bayes"), "unknown kind of interval"),
        (lambda f: f.confint("bootstrap"), "the bootstrap needs a seed"),
        (lambda f: f.confint(level=95), "the confidence level is no probability; found 95"),
    ],
)
def test_questions_that_have_no_answer_are_refused(fit, call, line):
    with pytest.raises(ModelError) as error:
        call(fit[0])
    assert line in str(error.value)


def _table() -> pd.DataFrame:
    rng = np.random.default_rng(0)
    frame = pd.DataFrame({"x": rng.normal(size=20), "who": np.repeat(list("abcde"), 4)})
    frame["y"], frame["word"] = rng.normal(size=20), list("uv") * 10
    frame["gap"] = frame["x"].where(frame.index != 3)
    frame["team"] = frame["who"].where(frame.index != 7)
    frame["zero"], frame["twice"] = 0.0, 2 * frame["x"]
    frame["kind"] = pd.Categorical(frame["word"], ["u", "v", "never"])
    return frame


@pytest.mark.parametrize(
    ("formula", "line"),
    [
        ("y ~ x + (x|who)", "random slopes are out of scope: (x|who)"),
        ("y ~ q + (1|who)", "there is no column q; expected one of x, who"),
        ("q ~ x + (1|who)", "there is no column q"),
        ("y ~ x + (1|q)", "there is no column q"),
        ("y ~ gap + (1|who)", "the column gap is missing in 1 of 20 rows; expected complete rows"),
        ("gap ~ x + (1|who)", "the column gap is missing in 1 of 20 rows"),
        ("y ~ x + (1|team)", "the column team is missing in 1 of 20 rows"),
        ("log(zero) ~ x + (1|who)", "the column log(zero) is not finite in 20 of 20 rows"),
        ("y ~ log(zero) + (1|who)", "the column log(zero) is not finite in 20 of 20 rows"),
        ("y ~ x + twice + (1|who)", "the fixed effects are collinear; found twice is given by x"),
        ("y ~ kind + (1|who)", "the fixed effect kind[T.never] is zero in every row"),
        ("word ~ x + (1|who)", "the outcome is not one numeric column; found word[u], word[v]"),
        ("y ~ 0 + (1|who)", "there is no fixed effect, not even an intercept"),
        ("y ~ x +* word + (1|who)", "the fixed part cannot be read"),
        ("y ~ log(word) + (1|who)", "the fixed part cannot be evaluated"),
        ("zero ~ x + (1|who)", "the outcome is constant; found 0 in all 20 rows"),
        ("twice ~ x + (1|who)", "the fixed effects reproduce the outcome exactly"),
    ],
)
def test_formulas_and_tables_that_cannot_be_fitted_are_refused_in_one_line(formula, line):
    with np.errstate(divide="ignore"), pytest.raises(ModelError) as error:
        fit_mixed_model(formula, _table())
    assert line in str(error.value)
    assert "\n" not in str(error.value)


def test_an_empty_table_is_refused():
    with pytest.raises(ModelError, match="there are no rows"):
        fit_mixed_model("y ~ x + (1|who)", _table().iloc[:0])
