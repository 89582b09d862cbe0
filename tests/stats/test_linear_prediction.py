import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import ModelError
from swaystride.stats.linear_prediction import least_squares_prediction, leave_one_cluster_out


def made(seed: int = 0, n: int = 60, p: int = 5) -> tuple[pd.DataFrame, pd.Series]:
    """Columns of very different size and spread; c3 is a combination of c0 and c1."""
    rng = np.random.default_rng(seed)
    values = rng.normal(size=(n, p)) * 10.0 ** np.arange(-3, p - 3) + rng.normal(size=p)
    X = pd.DataFrame(values, columns=[f"c{at}" for at in range(p)], index=np.arange(n) + 100)
    X["c3"] = 30.0 * X["c0"] - 2.0 * X["c1"] + 7.0
    return X, pd.Series(values @ rng.normal(size=p) + rng.normal(size=n), index=X.index)


def test_agrees_with_minimum_norm_least_squares():
    X, y = made()
    fit = least_squares_prediction(X, y)
    full = np.column_stack([np.ones(len(X)), X])
    scale = np.linalg.norm(full, axis=0)
    solution = np.linalg.lstsq(full / scale, y, rcond=1e-10)[0]
    np.testing.assert_allclose(fit.predictions, full / scale @ solution, rtol=1e-9)
    used = np.column_stack([np.ones(len(X)), X[list(fit.kept)]])
    np.testing.assert_allclose(fit.coefficients, np.linalg.lstsq(used, y, rcond=None)[0], rtol=1e-8)
    assert list(fit.coefficients.index) == ["Intercept", *fit.kept]
    assert fit.predictions.index.equals(X.index)


def test_collinear_and_constant_columns_are_named():
    X, y = made()
    X["length"] = 30.0 * X["c2"]  # path length is mean velocity times a common duration
    X["one"] = 4.2
    X["zero"] = 0.0
    fit = least_squares_prediction(X, y)
    assert fit.dropped == ("c3", "length", "one", "zero")
    assert fit.kept == ("c0", "c1", "c2", "c4")


def test_rounding_in_a_file_hides_no_combination():
    rng = np.random.default_rng(2)
    X = pd.DataFrame({"speed": rng.uniform(0.05, 0.07, 200), "jerk": rng.uniform(1, 2, 200)})
    X["length"] = 30.0 * X["speed"]
    written = X.map(lambda value: float(f"{value:.8g}"))
    assert least_squares_prediction(written, X["jerk"]).dropped == ("length",)


def test_column_that_nearly_repeats_another_is_kept():
    X, y = made()
    X["near"] = X["c2"] + 1e-5 * X["c2"].std() * np.random.default_rng(9).normal(size=len(X))
    assert "near" in least_squares_prediction(X, y).kept


@given(
    st.lists(st.floats(-9, 9), min_size=5, max_size=5),
    st.lists(st.sampled_from([-1.0, 1.0]), min_size=5, max_size=5),
    st.integers(0, 20),
)
def test_units_change_neither_columns_nor_predictions(powers, signs, seed):
    X, y = made(seed)
    fit = least_squares_prediction(X, y)
    other = least_squares_prediction(X * (np.array(signs) * 10.0 ** np.array(powers)), y)
    assert (other.kept, other.dropped) == (fit.kept, fit.dropped)
    np.testing.assert_allclose(other.predictions, fit.predictions, rtol=1e-7, atol=1e-7)


def test_residuals_are_orthogonal_to_every_column_dropped_ones_too():
    X, y = made(3)
    rest = y - least_squares_prediction(X, y).predictions
    for column in X:
        assert abs(np.corrcoef(rest, X[column])[0, 1]) < 1e-9
    assert abs(rest.mean()) < 1e-12


def test_predict_repeats_the_fitted_rows_and_needs_no_dropped_column():
    X, y = made()
    fit = least_squares_prediction(X, y)
    again = fit.predict(X[list(fit.kept)].iloc[::-1])
    np.testing.assert_allclose(again, fit.predictions.iloc[::-1], rtol=1e-9)
    assert again.index.equals(X.index[::-1])


def test_left_out_predictions_follow_from_the_hat_matrix():
    """The deleted residual of a block is inv(I - H_cc) times its residual."""
    X, y = made(1)
    clusters = pd.Series(np.repeat(list("cabd"), [10, 25, 5, 20]), index=X.index)
    left_out = leave_one_cluster_out(X, y, clusters)
    fit = least_squares_prediction(X, y)
    used = np.column_stack([np.ones(len(X)), X[list(fit.kept)]])
    basis = np.linalg.qr(used)[0]
    hat = basis @ basis.T
    rest = (y - fit.predictions).to_numpy()
    for label in "abcd":
        rows = (clusters == label).to_numpy()
        deleted = np.linalg.solve(np.eye(rows.sum()) - hat[np.ix_(rows, rows)], rest[rows])
        np.testing.assert_allclose((y - left_out.predictions)[rows], deleted, rtol=1e-6, atol=1e-8)
    assert left_out.dropped == dict.fromkeys("abcd", ("c3",))


def test_left_out_predictions_do_not_know_the_left_out_outcomes():
    X, y = made(2)
    clusters = np.arange(len(X)) % 4
    before = leave_one_cluster_out(X, y, clusters).predictions
    changed = y.where(clusters != 2, 1e3)
    after = leave_one_cluster_out(X, changed, clusters).predictions
    assert (before[clusters == 2] == after[clusters == 2]).all()
    assert (before[clusters != 2] != after[clusters != 2]).all()


def test_column_that_varies_in_one_cluster_only_is_dropped_without_it():
    X, y = made()
    clusters = np.arange(len(X)) % 3
    X["rare"] = np.where(clusters == 1, np.arange(len(X)), 0.0)
    left_out = leave_one_cluster_out(X, y, clusters)
    assert left_out.dropped == {0: ("c3",), 1: ("c3", "rare"), 2: ("c3",)}


def test_no_usable_column_predicts_the_mean():
    y = np.array([1.0, 2.0, 6.0])
    fit = least_squares_prediction(pd.DataFrame({"a": [5.0, 5.0, 5.0]}), y)
    assert (fit.kept, fit.dropped) == ((), ("a",))
    assert fit.predictions.tolist() == [3.0, 3.0, 3.0]


def test_unfit_tables_are_refused():
    X, y = made()
    with pytest.raises(ModelError, match="the column c1 is missing in 1 of 60 rows"):
        least_squares_prediction(X.assign(c1=X["c1"].where(X.index != 103)), y)
    with pytest.raises(ModelError, match="the column c2 is not numeric"):
        least_squares_prediction(X.assign(c2="a"), y)
    with pytest.raises(ModelError, match="the column c0 occurs twice"):
        least_squares_prediction(X[["c0", "c0"]], y)
    with pytest.raises(ModelError, match="expected 60 values; found"):
        least_squares_prediction(X, y.to_numpy()[:-1])
    with pytest.raises(ModelError, match="labelled by other rows"):
        least_squares_prediction(X, y.reset_index(drop=True))
    with pytest.raises(ModelError, match="the column y is not finite in 1 of 60 rows"):
        least_squares_prediction(X, y.where(y.index != 105))
    with pytest.raises(ModelError, match="5 rows cannot carry 5 coefficients"):
        least_squares_prediction(X.iloc[:5], y.iloc[:5])
    with pytest.raises(ModelError, match="expected 60 rows; found 3"):
        leave_one_cluster_out(X, y, list("aab"))
    with pytest.raises(ModelError, match="too few clusters"):
        leave_one_cluster_out(X, y, np.zeros(60))
