"""Pooled errors of stride length: closed forms, the constant correction, verdicts."""

import numpy as np
import pandas as pd
import pytest

from swaystride.validation.foot_checks import MOCAP_LIMITS, limit_checks
from swaystride.validation.foot_errors import comparison_table, pooled_errors
from swaystride.validation.foot_strides import METHODS

RNG = np.random.default_rng(8)


def strides(error, gait="walk", trials=("a", "b", "c")):
    """Strides of several trials, ours with the given errors, the others without values."""
    error = np.asarray(error, dtype=float)
    truth = 1.0 + 0.5 * RNG.random(len(error))
    table = pd.DataFrame({"trial": np.resize(list(trials), len(error)), "reference_m": truth})
    table = table.assign(gait=gait, **dict.fromkeys(METHODS, np.nan))
    return table.assign(length_m=truth + error)


def test_errors_of_a_known_sample():
    found = pooled_errors(strides([0.03, -0.01, 0.01, 0.05], trials=("a", "b")), "length_m")
    assert found["n"] == 4
    assert found["bias_m"] == pytest.approx(0.02)
    assert found["rmse_m"] == pytest.approx(np.sqrt(0.0036 / 4))
    assert found["sd_m"] == pytest.approx(np.sqrt(0.0009 - 0.0004))
    assert found["median_abs_m"] == pytest.approx(0.02)
    by_trial = np.sqrt([(0.0009 + 0.0001) / 2, (0.0001 + 0.0025) / 2])
    assert found["median_trial_rmse_m"] == pytest.approx(by_trial.mean())


def test_rmse_is_bias_and_sd_together():
    found = pooled_errors(strides(RNG.normal(0.02, 0.03, 200)), "length_m")
    assert found["rmse_m"] ** 2 == pytest.approx(found["bias_m"] ** 2 + found["sd_m"] ** 2)


def test_one_bad_stride_moves_the_rmse_but_not_the_medians():
    error = np.tile([0.01, -0.01], 60)
    before = pooled_errors(strides(error), "length_m")
    error[7] = 2.0
    after = pooled_errors(strides(error), "length_m")
    assert after["rmse_m"] > 15 * before["rmse_m"]
    assert after["median_abs_m"] == pytest.approx(before["median_abs_m"])
    assert after["median_trial_rmse_m"] == pytest.approx(before["median_trial_rmse_m"])


def test_a_constant_factor_is_seen_through_and_fitted_to_other_trials_only():
    table = strides(np.zeros(30))
    table["length_m"] = 0.9 * table["reference_m"]
    found = pooled_errors(table, "length_m")
    assert found["rmse_m"] > 0.1
    assert found["rmse_scaled_m"] == pytest.approx(0.0, abs=1e-12)
    # a factor of one trial only cannot be learnt from the others, and harms them
    table["length_m"] = table["reference_m"] * np.where(table["trial"] == "a", 0.9, 1.0)
    found = pooled_errors(table, "length_m")
    assert found["rmse_scaled_m"] > found["rmse_m"]


def test_the_constant_correction_equals_a_loop_over_left_out_trials():
    table = strides(RNG.normal(-0.03, 0.02, 90))
    errors = []
    for name in ("a", "b", "c"):
        own = table["trial"] == name
        x, y = table.loc[~own, "length_m"], table.loc[~own, "reference_m"]
        factor = np.linalg.lstsq(x.to_numpy()[:, None], y.to_numpy(), rcond=None)[0][0]
        errors.append(factor * table.loc[own, "length_m"] - table.loc[own, "reference_m"])
    expected = np.sqrt(np.mean(np.concatenate(errors) ** 2))
    assert pooled_errors(table, "length_m")["rmse_scaled_m"] == pytest.approx(expected)


def test_strides_without_a_value_are_left_out_and_no_value_at_all_is_no_row():
    table = strides(np.full(12, 0.01))
    table.loc[:5, "stored_m"] = table["reference_m"]
    assert pooled_errors(table, "stored_m")["n"] == 6
    assert pooled_errors(table, "gaitmap_m")["n"] == 0
    assert np.isnan(pooled_errors(table, "gaitmap_m")["rmse_m"])
    assert np.isnan(pooled_errors(table[table["trial"] == "a"], "length_m")["rmse_scaled_m"])
    methods = comparison_table(table, ["walk"])["method"].tolist()
    assert methods == ["recommended", "in the files"]


@pytest.mark.parametrize(("error", "within"), [(0.049, "yes"), (0.051, "no"), (-0.051, "no")])
def test_a_limit_holds_the_pooled_error(error, within):
    checks = limit_checks("set", strides(np.full(9, error)), MOCAP_LIMITS)
    verdicts = [check.within for check in checks if not np.isnan(check.tolerance)]
    assert verdicts == [within]
    assert {check.within for check in checks} == {within, "reported"}


def test_missing_numbers_of_gaitmap_are_said():
    table = strides(np.zeros(9))
    said = "strides with a length by gaitmap"
    assert said in [check.quantity for check in limit_checks("set", table, MOCAP_LIMITS)]
    table["gaitmap_m"] = table["reference_m"] + 0.02
    checks = {check.quantity: check for check in limit_checks("set", table, MOCAP_LIMITS)}
    assert said not in checks
    assert checks["walk: bias, m: gaitmap RTS"].value == pytest.approx(0.02)
    assert checks["walk: bias, m: gaitmap RTS"].within == "reported"
