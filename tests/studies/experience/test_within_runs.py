"""Associations within runs: who is left out, a plain twin from the same draws, order and counts."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ConfigurationError
from swaystride.gait.rating_windows import PRINTED_WINDOWS, sliding_windows
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.studies.experience.within_runs import (
    EXCLUDED_COLUMNS,
    LIMITS,
    SUMMARY_COLUMNS,
    WITHIN_COLUMNS,
    WithinRules,
    run_draws,
    significant_within,
    within_runs,
)

RULES = WithinRules(0.95, 60, 5, ("independent", "ar1", "block"), 9, 10)
EDGES = sliding_windows(600.0, 1800.0, PRINTED_WINDOWS)
N = len(EDGES)


def run_windows(name, rating, seed=1):
    rng = np.random.default_rng(seed)
    table = pd.DataFrame(rng.normal(size=(N, len(MEASURE_KEYS))), columns=list(MEASURE_KEYS))
    return table.assign(
        run=name, start_s=EDGES[:, 0], stop_s=EDGES[:, 1], affective_valence=rating
    )  # fmt: skip


def described(*names, pattern="aerial"):
    return pd.DataFrame(
        {"run": names, "participant": [name[:3] for name in names], "pattern": pattern}
    )


def associated(windows, names, rules=RULES):
    return within_runs(windows, described(*names), rules, step_s=20.0)


@pytest.fixture(scope="module")
def varied():
    return np.repeat([2.0, 3.0, 1.0, 4.0, 3.0, 2.0, 5.0, 4.0, 3.0], 7)[:N]


def test_a_run_without_varying_affect_is_left_out_and_counted(varied):
    late = np.where(np.arange(N) < 6, varied, np.nan)
    windows = pd.concat(
        [
            run_windows("P01_01", varied),
            run_windows("P01_02", np.full(N, 3.0)),
            run_windows("P02_01", np.full(N, np.nan)),
            run_windows("P03_01", late),
        ],
        ignore_index=True,
    )
    names = ["P01_01", "P01_02", "P02_01", "P03_01"]
    within, excluded = associated(windows, names, replace(RULES, errors=("independent",)))
    assert list(within) == list(WITHIN_COLUMNS)
    assert list(excluded) == list(EXCLUDED_COLUMNS)
    assert set(within["run"]) == {"P01_01"}
    assert within["measure"].tolist() == list(MEASURE_KEYS)
    assert dict(zip(excluded["run"], excluded["reason"], strict=True)) == {
        "P01_02": "constant affect",
        "P02_01": "no ratings",
        "P03_01": "too few windows",
    }
    assert excluded["group"].tolist() == ["aerial"] * 3
    assert within[list(LIMITS["ar1"] + LIMITS["block"])].isna().all(axis=None)
    assert within["rho"].isna().all()


def test_a_plain_twin_draws_the_same_printed_intervals(varied):
    """Every new outcome of one run written out, correlated with every measure."""
    windows = run_windows("P01_01", varied)
    windows.loc[20:25, "speed_m_s"] = np.nan
    within, _ = associated(windows, ["P01_01"], replace(RULES, errors=("independent",)))
    draws = run_draws("P01_01", N, RULES)
    minutes = EDGES.mean(axis=1) / 60.0 - 20.0
    for measure, row in within.set_index("measure").iterrows():
        known = windows[measure].notna().to_numpy()
        x, y, t = windows.loc[known, measure].to_numpy(), varied[known], minutes[known]
        X = np.column_stack([np.ones(len(x)), x, t])
        fitted = X @ np.linalg.lstsq(X, y, rcond=None)[0]
        sd = np.sqrt(np.sum((y - fitted) ** 2) / (len(x) - 3))
        alone, given_time = [], []
        for normal in draws.normal.T:
            new = fitted + sd * normal[known]
            (xy, xt), ty = np.corrcoef([x, new, t])[0, 1:], np.corrcoef(t, new)[0, 1]
            alone.append(xy)
            given_time.append((xy - xt * ty) / np.sqrt((1 - xt**2) * (1 - ty**2)))
        for name, values in zip(
            LIMITS["independent"], (alone, alone, given_time, given_time), strict=True
        ):
            share = 0.025 if "low" in name else 0.975
            assert row[name] == pytest.approx(np.quantile(values, share), abs=1e-10)
        assert row["n_windows"] == known.sum()
        assert row["r"] == pytest.approx(np.corrcoef(x, y)[0, 1], abs=1e-12)


def test_a_run_has_its_own_draws_whatever_runs_there_are(varied):
    both = pd.concat(
        [run_windows("P01_01", varied, 3), run_windows("P05_02", varied[::-1], 4)],
        ignore_index=True,
    )
    together, _ = associated(both, ["P01_01", "P05_02"])
    alone, _ = associated(both[both["run"] == "P05_02"], ["P05_02"])
    own = together[together["run"] == "P05_02"].reset_index(drop=True)
    pd.testing.assert_frame_equal(own, alone)
    first, second = (run_draws(name, N, RULES).normal for name in ("P01_01", "P05_02"))
    assert not np.any(first == second)


def test_what_time_explains_is_not_there_given_time():
    """Measure and affect drift, and have nothing else in common (Figure 5.9)."""
    rng = np.random.default_rng(9)
    drift = np.linspace(0.0, 6.0, N)
    windows = run_windows("P01_01", drift + rng.normal(0.0, 0.5, N))
    windows["contact_time_s"] = drift + rng.normal(0.0, 0.5, N)
    within, _ = associated(windows, ["P01_01"])
    row = within.set_index("measure").loc["contact_time_s"]
    assert row["r"] > 0.9
    assert row["ci_low"] > 0.0
    assert row["ci_low_partial"] < 0.0 < row["ci_high_partial"]
    assert row["p_time"] < 1e-6
    summary = significant_within(within).set_index(["errors", "measure"])
    for errors in LIMITS:
        told = summary.loc[(errors, "contact_time_s")]
        assert told[["n_significant", "n_positive", "n_stay_given_time"]].tolist() == [1, 1, 0]


def test_ratings_that_hold_for_minutes_widen_the_intervals(varied):
    windows = pd.concat([run_windows("P01_01", varied, seed) for seed in (1, 2)]).iloc[:N]
    slow = np.repeat(np.random.default_rng(2).normal(size=9), 7)[:N]
    windows["duty_factor"] = slow + np.random.default_rng(3).normal(0.0, 0.1, N)
    within, _ = associated(windows, ["P01_01"])
    row = within.set_index("measure").loc["duty_factor"]
    assert row["rho"] > 0.6
    width = row["ci_high"] - row["ci_low"]
    assert row["ci_high_ar1"] - row["ci_low_ar1"] > 1.3 * width
    assert row["ci_high_block"] - row["ci_low_block"] > 1.1 * width


def test_a_measure_that_cannot_be_estimated_has_a_row_with_its_reason(varied):
    windows = run_windows("P01_01", varied)
    windows["peak_head_g"] = np.nan
    windows.loc[9:, "heart_rate_bpm"] = np.nan
    windows["speed_m_s"] = 3.0
    within, _ = associated(windows, ["P01_01"])
    reasons = within.set_index("measure")["reason"]
    assert len(reasons) == 37
    few = "too few windows; expected 10 or more with a value; found"
    assert reasons["peak_head_g"] == f"{few} 0"
    assert reasons["heart_rate_bpm"] == f"{few} 9"
    assert reasons["speed_m_s"] == "the predictor is constant; found 3"
    assert (reasons == "").sum() == 34
    assert within.loc[within["reason"] != "", "r"].isna().all()


def test_the_summary_counts_what_leaves_out_zero():
    rows = []
    for at, (low, high, low_partial, high_partial) in enumerate(
        [(0.1, 0.5, 0.05, 0.4), (0.1, 0.5, -0.1, 0.4), (-0.5, -0.1, -0.6, -0.2), (-0.5, -0.1, 0.1, 0.3), (-0.2, 0.3, 0.1, 0.4)]
    ):  # fmt: skip
        row = dict(zip(LIMITS["independent"], (low, high, low_partial, high_partial), strict=True))
        rows.append({"run": f"P0{at}_01", "measure": "speed_m_s", **row})
    summary = significant_within(pd.DataFrame(rows, columns=list(WITHIN_COLUMNS)))
    assert list(summary) == list(SUMMARY_COLUMNS)
    (row,) = summary.to_dict("records")
    assert (row["errors"], row["n_runs"]) == ("independent", 5)
    assert (row["n_significant"], row["n_positive"], row["n_stay_given_time"]) == (4, 2, 2)
    assert row["share_significant"] == pytest.approx(0.8)


def test_a_cohort_without_runs_has_empty_tables():
    within, excluded = associated(run_windows("P01_01", 1.0).iloc[:0], [])
    assert list(within) == list(WITHIN_COLUMNS)
    assert list(excluded) == list(EXCLUDED_COLUMNS)
    assert within.empty
    assert significant_within(within).empty


def test_a_block_must_be_shorter_than_the_shortest_run():
    with pytest.raises(ConfigurationError, match="expected more than 9 windows; found 9"):
        replace(RULES, least_windows=9)
