"""All measures of a run together: what they are made of, what is missing, choices of strides."""

import numpy as np
import pandas as pd
import pytest

from swaystride.gait.impact_peaks import IMPACT_WINDOW
from swaystride.gait.run_measures import (
    COORDINATION_MEASURES,
    MEASURES,
    STRIDE_MEASURES,
    MeasureRules,
    measure_run,
)
from swaystride.gait.segment_ranges import EARLY_STANCE
from swaystride.gait.segment_signals import PRINTED_FILTERS, SegmentSignals
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.gait.vector_coding import ANGULAR_DEVIATION

RULES = MeasureRules(
    filters=PRINTED_FILTERS,
    impact=IMPACT_WINDOW,
    roll=EARLY_STANCE,
    coding=ANGULAR_DEVIATION,
    coding_cutoff_hz=15.0,
    arm="upper_arm",
    remove_pelvis_mean=True,
    remove_arm_mean=False,
)


def with_true_lengths(run):
    """True strides, all of the length that the speed gives."""
    strides = running_strides(run.events, RUNNING_STRIDES)
    length = run.speed_m_s * strides["stride_time_s"]
    return strides.assign(stride_length_m=length, speed_m_s=run.speed_m_s)


@pytest.fixture(scope="module")
def measured(thirteen_imus):
    run = thirteen_imus(12.0)
    strides = with_true_lengths(run)
    return run, measure_run(run.signals, strides, rate_hz=500.0, mass_kg=70.0, rules=RULES)


def test_there_are_the_36_measures_of_the_print(measured):
    _, found = measured
    means = found.mean_over(found.strides["is_valid"].to_numpy())
    assert list(means.index) == list(MEASURES)
    assert len(MEASURES) == 36
    assert len(COORDINATION_MEASURES) == 12
    assert np.isfinite(means).all()


def test_means_are_those_of_the_sides_and_parts_of_each_other(measured):
    _, found = measured
    keep = found.strides["is_valid"].to_numpy()
    means = found.mean_over(keep)
    kept = found.strides[keep]
    by_side = kept.groupby("side")[list(STRIDE_MEASURES)].mean()
    assert means[list(STRIDE_MEASURES)].to_numpy() == pytest.approx(by_side.mean().to_numpy())
    assert means["peak_tibial_g_per_kg"] == pytest.approx(means["peak_tibial_g"] / 70.0)
    assert kept["duty_factor"].to_numpy() == pytest.approx(
        (kept["contact_time_s"] / kept["stride_time_s"]).to_numpy()
    )
    ratios = kept[["ap_ratio", "vertical_ratio", "ml_ratio"]].to_numpy()
    assert np.sum(ratios**2, axis=1) == pytest.approx(1.0)


def test_the_mean_attenuation_is_not_the_attenuation_of_the_means(measured):
    _, found = measured
    means = found.mean_over(found.strides["is_valid"].to_numpy())
    naive = 1.0 - means["peak_pelvic_g"] / means["peak_tibial_g"]
    assert abs(means["attenuation_shank_pelvis"] - naive) > 1e-3


@pytest.mark.parametrize(
    ("absent", "missing"),
    [
        ("head", ("peak_head_g", "peak_head_g_per_kg", "attenuation_pelvis_head")),
        ("shank_left", ("peak_tibial_g", "attenuation_shank_head", "knee_range_deg")),
        ("thigh_right", ("hip_range_deg", "knee_range_deg", "shank_thigh_mid_stance")),
        ("upper_arm_left", ("arm_vertical_rms_g", "arm_ml_rms_g", "arm_ap_rms_g")),
    ],
)
def test_without_a_sensor_its_measures_are_missing_and_no_others(measured, absent, missing):
    run, whole = measured
    fewer = {name: signals for name, signals in run.signals.items() if name != absent}
    found = measure_run(fewer, with_true_lengths(run), rate_hz=500.0, mass_kg=70.0, rules=RULES)
    keep = whole.strides["is_valid"].to_numpy()
    before, after = whole.mean_over(keep), found.mean_over(keep)
    assert after[list(missing)].isna().all()
    known = after.notna()
    assert known.sum() >= 22
    assert after[known].to_numpy() == pytest.approx(before[known].to_numpy())


def test_a_loss_spoils_only_the_strides_in_which_it_lies(measured):
    run, whole = measured
    broken = dict(run.signals)
    acc = run.signals["shank_right"].acc_m_s2.copy()
    acc[:, 5000:5500] = np.nan
    broken["shank_right"] = SegmentSignals(acc, run.signals["shank_right"].gyr_rad_s)
    found = measure_run(broken, with_true_lengths(run), rate_hz=500.0, mass_kg=70.0, rules=RULES)
    lost = found.strides["peak_tibial_g"].isna() & whole.strides["peak_tibial_g"].notna()
    assert 1 <= lost.sum() <= 3
    assert found.strides.loc[lost, "side"].eq("right").all()
    assert found.strides.loc[lost, "start_s"].between(9.8, 11.1).all()


def test_too_few_strides_have_no_coordination(measured):
    _, found = measured
    few = np.zeros(len(found.strides), dtype=bool)
    few[:20] = True
    means = found.mean_over(few)
    assert means[list(COORDINATION_MEASURES)].isna().all()
    assert np.isfinite(means["stride_time_s"])


def test_strides_without_toe_off_count_where_none_is_needed(measured):
    run, whole = measured
    strides = with_true_lengths(run)
    strides.loc[4, ["toe_off_s", "contact_time_s", "flight_time_s", "duty_factor"]] = np.nan
    found = measure_run(run.signals, strides, rate_hz=500.0, mass_kg=70.0, rules=RULES)
    row = found.strides.loc[4]
    assert np.isnan(row["peak_head_g"])
    assert row["hip_range_deg"] == whole.strides.loc[4, "hip_range_deg"]
    everything = pd.Series(found.mean_over(np.ones(len(strides), dtype=bool)))
    assert np.isfinite(everything).all()
