"""The models recover known slopes; the random intercept of the trial does what theory says."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.errors import ModelError
from swaystride.studies.imu_design.experiments import EXPERIMENTS
from swaystride.studies.imu_design.models import effects, residuals, variance_components
from swaystride.studies.imu_design.plan import EFFECT_COLUMNS, SLOPE, TABLES


def of_model(table, model):
    return table[table["model"] == model].reset_index(drop=True)


def with_orthogonal_noise(table):
    """Add noise that neither a fixed effect nor a trial can explain."""
    dummies = pd.get_dummies(table[["condition"]]).to_numpy(float)
    trials = pd.get_dummies(table["participant"] + table["trial"]).to_numpy(float)
    speed = table[["speed_m_s"]].to_numpy()
    known = np.hstack([dummies, dummies * speed, trials])
    noise = np.random.default_rng(9).normal(size=len(table))
    noise -= known @ np.linalg.lstsq(known, noise, rcond=None)[0]
    return table.assign(error_pct=table["error_pct"] + noise)


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_known_slopes_are_recovered_exactly(experiment, observations_with, plan, slopes):
    table = observations_with()
    table = with_orthogonal_noise(table[table["experiment"] == experiment])
    found = effects(table, experiment, plan)
    assert tuple(found) == EFFECT_COLUMNS
    for model in ("subject", "subject_and_trial"):
        own = of_model(found, model)
        np.testing.assert_allclose(own[SLOPE], slopes[experiment], atol=1e-9)
        printed = pd.read_csv(REPOSITORY / f"data/published/{TABLES[experiment]}.csv")
        assert own["effect"].tolist() == printed["effect"].tolist()
        assert set(own["n_trials"]) == {60}
        assert set(own["n_participants"]) == {6}


def test_the_printed_model_has_the_standard_error_of_the_print(observations_with, plan):
    """With scatter as in the paper (residual SD 1.85 %) the intervals are as wide as printed."""
    table = observations_with(participant_sd=0.8, row_sd=1.85)
    own = of_model(effects(table, "accelerometer_range", plan), "subject")
    widths = (own["ci_high"] - own["ci_low"]).to_numpy()
    printed = pd.read_csv(REPOSITORY / "data/published/table_a1.csv")
    np.testing.assert_allclose(widths, printed["ci_high"] - printed["ci_low"], rtol=0.2)


def test_profile_limits_hold_the_estimate_and_belong_to_the_chosen_model(
    observations_with, plan, plan_with
):
    table = observations_with(participant_sd=0.5, trial_sd=1.5, row_sd=0.5)
    printed = effects(table, "gyro_range", plan)
    ours = effects(table, "gyro_range", plan_with(trial_intercept=True))
    assert ((printed["ci_low"] < printed[SLOPE]) & (printed[SLOPE] < printed["ci_high"])).all()
    pd.testing.assert_frame_equal(
        printed.drop(columns=["ci_low", "ci_high"]), ours.drop(columns=["ci_low", "ci_high"])
    )
    differs = (printed["ci_low"] - ours["ci_low"]).abs() > 1e-9
    assert differs.groupby(printed["model"]).any().all()


def test_shared_trial_errors_leave_slopes_and_shrink_standard_errors(observations_with, plan):
    """In a balanced table both models estimate the same slopes; only their errors differ."""
    found = effects(observations_with(trial_sd=1.8, row_sd=0.3), "accelerometer_range", plan)
    one, both = (of_model(found, name) for name in ("subject", "subject_and_trial"))
    np.testing.assert_allclose(one[SLOPE][1:], both[SLOPE][1:], atol=1e-9)
    assert (both["se"][1:] < 0.35 * one["se"][1:]).all()
    # the evidence on the baseline is the trials: its error does not shrink
    assert 0.8 < both["se"][0] / one["se"][0] < 1.6
    assert both["df"][0] < one["df"][0]


def test_components_are_those_put_in(observations_with):
    parts = [
        variance_components(
            observations_with(seed=seed, participant_sd=1.0, trial_sd=1.5, row_sd=0.5),
            "accelerometer_range",
        )
        for seed in range(30)
    ]
    mean = pd.concat(parts).groupby(["model", "component"])["sd_pct"].mean()
    assert mean["subject_and_trial", "participant:trial"] == pytest.approx(1.5, rel=0.05)
    assert mean["subject_and_trial", "Residual"] == pytest.approx(0.5, rel=0.05)
    assert mean["subject", "Residual"] == pytest.approx(np.hypot(1.5, 0.5), rel=0.1)


def test_residuals_have_the_rows_of_the_experiment(observations_with, plan):
    table = residuals(observations_with(row_sd=1.0), "decimation", plan)
    assert len(table) == 300
    assert table["residual"].mean() == pytest.approx(0.0, abs=1e-6)


def test_one_participant_is_refused_in_one_line(observations_with, plan):
    table = observations_with()
    with pytest.raises(ModelError) as error:
        effects(table[table["participant"] == "P03"], "gyro_range", plan)
    assert str(error.value) == (
        "the models of gyro_range cannot be fitted; "
        "expected trials of 2 participants or more; found P03"
    )
