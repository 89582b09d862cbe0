"""Correlation within a series: exact fits, a plain twin of the bootstrap, coverage on known models."""

import numpy as np
import pytest
import statsmodels.api as sm
from statsmodels.stats.multitest import multipletests

from swaystride.errors import ModelError
from swaystride.stats.multiple_tests import benjamini_hochberg
from swaystride.stats.parametric_bootstrap import (
    ERROR_KINDS,
    bootstrap_trends,
    series_draws,
)
from swaystride.stats.residual_autocorrelation import LARGEST, autoregressive_errors
from swaystride.stats.trend_fit import fit_trend

N = 58
PLACE = np.arange(N)
TIME = 600.0 + 20.0 * PLACE


def bootstrap_trend(fit, draws, **options):
    (limits,) = bootstrap_trends([fit], draws, **options)
    return limits


def drifting_series(seed, n=N):
    rng = np.random.default_rng(seed)
    x = np.cumsum(rng.standard_normal(n)) + 0.1 * np.arange(n)
    rating = np.repeat(rng.integers(0, 5, n), 7)[:n].astype(float)
    return x, rating


def correlated_errors(rng, rho, n=N):
    lag = np.abs(np.arange(n)[:, None] - np.arange(n)[None, :])
    return np.linalg.cholesky(float(rho) ** lag) @ rng.standard_normal(n)


# --- the fit, against other implementations -------------------------------------------------------


def test_the_fit_agrees_with_statsmodels_and_with_correlations_of_residuals():
    x, y = drifting_series(1)
    x[[3, 40]] = np.nan
    y[17] = np.nan
    fit = fit_trend(x, y, TIME, PLACE)
    kept = np.isfinite(x) & np.isfinite(y)
    model = sm.OLS(y[kept], sm.add_constant(np.column_stack([x[kept], TIME[kept]]))).fit()
    by_time = sm.add_constant(TIME[kept])
    rest_x, rest_y = (sm.OLS(values[kept], by_time).fit().resid for values in (x, y))
    assert fit.n == kept.sum() == 55
    np.testing.assert_allclose(fit.residuals, model.resid, atol=1e-10)
    assert fit.p_time == pytest.approx(model.pvalues[2], rel=1e-8)
    assert fit.r == pytest.approx(np.corrcoef(x[kept], y[kept])[0, 1], abs=1e-12)
    assert fit.r_partial == pytest.approx(np.corrcoef(rest_x, rest_y)[0, 1], abs=1e-12)
    np.testing.assert_allclose(fit.basis.T @ fit.basis, np.eye(3), atol=1e-12)


# --- the plain twin -------------------------------------------------------------------------------


def twin_rho_and_sd(residuals, X, place):
    """Bisection with the matrices written out."""
    n = len(residuals)
    M = np.eye(n) - X @ np.linalg.inv(X.T @ X) @ X.T
    D, lags = np.zeros((n, n)), np.zeros((n, n), int)
    for i in range(n):
        for j in range(n):
            lags[i, j] = abs(place[i] - place[j])
            D[i, j] = 0.5 if lags[i, j] == 1 else 0.0
    found = residuals @ D @ residuals / (residuals @ residuals)

    def expected(rho):
        R = np.array([[float(rho) ** int(lag) for lag in row] for row in lags])
        return np.trace(M @ D @ M @ R) / np.trace(M @ R), np.trace(M @ R)

    low, high = 0.0, LARGEST
    if expected(low)[0] >= found:
        high = low
    elif expected(high)[0] <= found:
        low = high
    while high - low > 1e-15 and 0.5 * (low + high) not in (low, high):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if expected(middle)[0] < found else (low, middle)
    return high, np.sqrt(residuals @ residuals / expected(high)[1])


def twin_errors(kind, residuals, X, place, normal, uniform, length):
    """Errors of one draw, one after another."""
    n = len(residuals)
    if kind == "independent":
        sd = np.sqrt(sum(e * e for e in residuals) / (n - 3))
        return [sd * z for z in normal]
    if kind == "ar1":
        rho, sd = twin_errors.ar1
        errors = [normal[0]]
        for i in range(1, n):
            carried = rho ** (place[i] - place[i - 1])
            errors.append(carried * errors[-1] + np.sqrt(1.0 - carried**2) * normal[i])
        return [sd * e for e in errors]
    errors = []
    for u in uniform:
        begin = int(u * (n - length + 1))
        for k in range(length):
            level = np.mean([residuals[s + k] for s in range(n - length + 1)])
            errors.append(np.sqrt(n / (n - 3)) * (residuals[begin + k] - level))
    return errors[:n]


def twin_limits(x, y, time, place, draws, kind, level):
    """Intervals with a loop over the draws and every outcome written out."""
    kept = np.isfinite(x) & np.isfinite(y)
    normal = draws.normal[kept]
    x, y, time, place = x[kept], y[kept], time[kept], place[kept]
    X = np.column_stack([np.ones(len(x)), x, time])
    X[:, 2] -= time.mean()
    fitted = X @ np.linalg.lstsq(X, y, rcond=None)[0]
    residuals = y - fitted
    if kind == "ar1":
        twin_errors.ar1 = twin_rho_and_sd(residuals, X, place)
    by_time = X[:, [0, 2]]

    def without_time(values):
        return values - by_time @ np.linalg.lstsq(by_time, values, rcond=None)[0]

    alone, given_time = [], []
    for z, u in zip(normal.T, draws.uniform.T, strict=True):
        new = fitted + np.array(twin_errors(kind, residuals, X, place, z, u, draws.block_length))
        alone.append(np.corrcoef(x, new)[0, 1])
        given_time.append(np.corrcoef(without_time(x), without_time(new))[0, 1])
    limits = []
    for values in (alone, given_time):
        ordered = sorted(values)
        for share in (0.5 - level / 2, 0.5 + level / 2):
            at = share * (len(ordered) - 1)
            below = int(at)
            above = min(below + 1, len(ordered) - 1)
            limits.append(ordered[below] + (at - below) * (ordered[above] - ordered[below]))
    return limits


@pytest.mark.parametrize("kind", ERROR_KINDS)
def test_a_plain_twin_gives_the_same_intervals(kind):
    for seed in range(3):
        x, y = drifting_series(seed)
        time, place = TIME.copy(), PLACE.copy()
        if seed % 2:  # a turn, and windows without a value
            kept = (PLACE < 20) | (PLACE > 27)
            x, y, time, place = x[kept], y[kept], time[kept], place[kept]
            x[[5, 30]] = np.nan
        draws = series_draws(len(x), n_draws=80, block_length=9, seed=seed)
        limits = bootstrap_trend(fit_trend(x, y, time, place), draws, kind=kind, level=0.9)
        twin = twin_limits(x, y, time, place, draws, kind, 0.9)
        np.testing.assert_allclose([*limits.alone, *limits.given_time], twin, atol=1e-10)


# --- invariances ----------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ERROR_KINDS)
def test_units_and_origin_change_nothing_and_a_sign_mirrors_the_interval(kind):
    x, y = drifting_series(5)
    draws = series_draws(N, n_draws=300, block_length=9, seed=3)

    def limits(x, y, time):
        found = bootstrap_trend(fit_trend(x, y, time, PLACE), draws, kind=kind, level=0.95)
        return np.array([*found.alone, *found.given_time])

    own = limits(x, y, TIME)
    np.testing.assert_allclose(limits(3.0 * x - 7.0, 0.1 * y + 40.0, TIME / 60.0), own, atol=1e-9)
    np.testing.assert_allclose(limits(-x, y, TIME), -own[[1, 0, 3, 2]], atol=1e-9)


def test_the_interval_of_an_outcome_that_the_model_explains_wholly_is_a_point():
    x, _ = drifting_series(2)
    draws = series_draws(N, n_draws=50, block_length=9, seed=1)
    fit = fit_trend(x, 2.0 * x - 0.01 * TIME, TIME, PLACE)
    for kind in ERROR_KINDS:
        limits = bootstrap_trend(fit, draws, kind=kind, level=0.95)
        np.testing.assert_allclose(limits.alone, fit.r, atol=1e-9)
        np.testing.assert_allclose(limits.given_time, 1.0, atol=1e-9)


# --- coverage -------------------------------------------------------------------------------------


def coverage(rho, slope, kinds, *, n_sets, n_draws):
    """Share of sets whose interval holds the correlation of the model, alone and given time."""
    rng = np.random.default_rng(11)
    x = np.cumsum(rng.standard_normal(N))
    basis = fit_trend(x, rng.standard_normal(N), TIME, PLACE)
    mean = slope * (x - x.mean()) / x.std() + 0.02 * PLACE
    lag = np.abs(PLACE[:, None] - PLACE[None, :])
    R = rho**lag if rho else np.eye(N)
    L = np.linalg.cholesky(R)
    along, spread = (
        basis.basis[:, 1:].T @ mean,
        np.diag(basis.basis[:, 1:].T @ R @ basis.basis[:, 1:]),
    )
    rest = np.trace(R) - np.trace(basis.basis.T @ R @ basis.basis)
    alone = basis.share @ along / np.sqrt(along @ along + spread.sum() + rest)
    given_time = along[1] / np.sqrt(along[1] ** 2 + spread[1] + rest)
    hits = {kind: np.zeros(2) for kind in kinds}
    for at in range(n_sets):
        fit = fit_trend(x, mean + L @ rng.standard_normal(N), TIME, PLACE)
        draws = series_draws(N, n_draws=n_draws, block_length=9, seed=at)
        for kind in kinds:
            found = bootstrap_trend(fit, draws, kind=kind, level=0.95)
            pairs = ((alone, found.alone), (given_time, found.given_time))
            hits[kind] += [low <= true <= high for true, (low, high) in pairs]
    return {kind: (value / n_sets).tolist() for kind, value in hits.items()}


@pytest.mark.parametrize("slope", [0.0, 0.6])
def test_independent_errors_are_covered_by_the_interval_of_their_own_model(slope):
    alone, given_time = coverage(0.0, slope, ["independent"], n_sets=600, n_draws=500)[
        "independent"
    ]
    assert 0.92 <= alone <= 0.98
    assert 0.92 <= given_time <= 0.98


def test_errors_that_follow_each_other_need_the_interval_that_knows_it():
    found = coverage(0.7, 0.0, ERROR_KINDS, n_sets=200, n_draws=200)
    assert max(found["independent"]) < 0.75
    assert min(found["ar1"]) > 0.87
    for kind in ("ar1", "block"):
        assert min(np.subtract(found[kind], found["independent"])) > 0.1


def test_time_alone_has_small_p_values_as_often_as_it_should():
    rng = np.random.default_rng(4)
    p = [
        fit_trend(rng.standard_normal(N), rng.standard_normal(N), TIME, PLACE).p_time
        for _ in range(1000)
    ]
    assert 0.03 < np.mean(np.array(p) < 0.05) < 0.07


# --- errors that follow each other ----------------------------------------------------------------


@pytest.mark.parametrize("rho", [0.0, 0.5, 0.8])
def test_the_correlation_of_errors_is_found_although_residuals_hide_it(rho):
    rng = np.random.default_rng(8)
    x = np.cumsum(rng.standard_normal(N))
    kept = (PLACE < 25) | (PLACE > 30)
    found, naive = [], []
    for _ in range(200):
        y = correlated_errors(rng, rho)
        fit = fit_trend(x[kept], y[kept], TIME[kept], PLACE[kept])
        found.append(fit.autoregressive)
        naive.append(fit.residuals[1:] @ fit.residuals[:-1] / (fit.residuals @ fit.residuals))
    assert np.median([own.rho for own in found]) == pytest.approx(rho, abs=0.05)
    assert np.median(naive) < rho - 0.04
    variance = np.mean([own.sd**2 for own in found if own.rho < LARGEST])
    assert variance == pytest.approx(1.0, abs=0.25)


def test_without_correlation_the_standard_deviation_is_that_of_a_regression():
    level = np.full((6, 1), 6**-0.5)
    residuals = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    rho, sd = autoregressive_errors(residuals, level, range(6))
    assert rho == 0.0
    assert sd == pytest.approx(np.sqrt(6 / 5))


def test_a_random_walk_stops_at_the_largest_correlation():
    x, _ = drifting_series(3)
    fit = fit_trend(x, np.where(PLACE < 30, 1.0, 4.0) + 1e-3 * PLACE**2, TIME, PLACE)
    assert fit.autoregressive.rho == LARGEST


# --- bad input ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("predictor", "outcome", "problem"),
    [
        (np.ones(N), np.arange(N) % 5, "the predictor is constant; found 1"),
        (np.arange(N) % 5, np.full(N, 3.0), "the outcome is constant; found 3"),
        (2.0 * TIME - 5.0, np.arange(N) % 5, "the predictor moves with time exactly"),
        (np.where(PLACE < 4, PLACE % 3, np.nan), PLACE % 5, "too few complete rows; expected 5 or more"),
    ],
)  # fmt: skip
def test_what_cannot_be_fitted_says_why(predictor, outcome, problem):
    with pytest.raises(ModelError, match=problem):
        fit_trend(predictor, outcome, TIME, PLACE)


def test_intervals_that_cannot_be_drawn_say_why():
    x, y = drifting_series(1)
    fit = fit_trend(x, y, TIME, PLACE)
    one_block = series_draws(N, n_draws=5, block_length=58, seed=1)
    with pytest.raises(ModelError, match="no longer than a block; expected over 58 rows; found 58"):
        bootstrap_trend(fit, one_block, kind="block", level=0.95)
    draws = series_draws(N, n_draws=5, block_length=9, seed=1)
    with pytest.raises(ModelError, match="unknown kind of errors; expected independent or ar1"):
        bootstrap_trend(fit, draws, kind="ar2", level=0.95)
    with pytest.raises(ModelError, match="level is no probability"):
        bootstrap_trend(fit, draws, kind="ar1", level=95)


def test_rows_without_neighbours_have_no_correlation_of_errors_and_no_such_interval():
    x, y = drifting_series(1)
    draws = series_draws(N, n_draws=5, block_length=9, seed=1)
    apart = fit_trend(x, y, TIME, 3 * PLACE)
    assert np.isnan(apart.autoregressive).all()
    limits = bootstrap_trend(apart, draws, kind="ar1", level=0.95)
    assert np.isnan([*limits.alone, *limits.given_time]).all()
    assert np.isfinite(bootstrap_trend(apart, draws, kind="block", level=0.95).alone).all()


@pytest.mark.parametrize("kind", ERROR_KINDS)
def test_predictors_of_a_series_do_not_depend_on_each_other(kind):
    draws = series_draws(N, n_draws=60, block_length=9, seed=2)
    fits = []
    for seed in range(6):
        x, _ = drifting_series(seed)
        x[: 4 * (seed % 3)] = np.nan
        fits.append(fit_trend(x, drifting_series(9)[1], TIME, PLACE))
    together = bootstrap_trends(fits, draws, kind=kind, level=0.95)
    alone = [bootstrap_trend(fit, draws, kind=kind, level=0.95) for fit in fits]
    np.testing.assert_allclose(together, alone, atol=1e-12)
    assert bootstrap_trends([], draws, kind=kind, level=0.95) == []


# --- many tests -----------------------------------------------------------------------------------


def test_false_discoveries_agree_with_statsmodels_and_skip_what_was_not_tested():
    p = np.random.default_rng(2).uniform(size=40) ** 3
    q = benjamini_hochberg(np.insert(p, [0, 20], np.nan))
    assert np.isnan(q[[0, 21]]).all()
    np.testing.assert_allclose(q[np.isfinite(q)], multipletests(p, method="fdr_bh")[1], atol=1e-14)
    assert np.isnan(benjamini_hochberg([np.nan, np.nan])).all()
    with pytest.raises(ModelError, match=r"no probability; expected 0 to 1; found 1\.2"):
        benjamini_hochberg([0.5, 1.2])
