"""Measures of a run through files, against the truth, and what windows and wholes have in common."""

import json

import numpy as np
import pandas as pd
import pytest

from swaystride.simulate.experience_truth import read_run_truth
from swaystride.studies.experience.chest_strap import mean_rate_bpm
from swaystride.studies.experience.measuring_files import RUN_TABLE, WINDOW_TABLE
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.studies.experience.truth import truth_rows

RUN = "P01_01"


@pytest.fixture(scope="module", params=["printed", "recommended", "literal_toe_off"])
def measured(request, whole_lab):
    return request.param, whole_lab.measured(request.param)[0]


def beside_the_truth(lab, strides):
    """Strides that count beside the true ones of the same contacts."""
    true = pd.read_parquet(lab.truth / f"{RUN}_strides.parquet")
    true = true[true["is_steady"]].sort_values("start_s").assign(at=lambda t: t["start_s"])
    own = strides[strides["is_valid"] & strides["is_steady"]].sort_values("start_s")
    own = own.assign(at=own["start_s"])
    both = pd.merge_asof(
        own, true, on="at", by="side", direction="nearest", tolerance=0.1, suffixes=("", "_true")
    )
    return both.dropna(subset=["start_s_true"])


def test_tables_have_their_columns_and_all_37_measures(measured):
    _, tables = measured
    assert tuple(tables["runs"].columns) == RUN_TABLE
    assert tuple(tables["windows"].columns) == WINDOW_TABLE
    assert np.isfinite(tables["runs"][list(MEASURE_KEYS)].to_numpy(float)).all()


def test_errors_against_the_truth(measured, whole_lab):
    """Limits of the recommended variant; the printed one is late by the lag of the peak."""
    variant, tables = measured
    both = beside_the_truth(whole_lab, tables["strides"])
    assert len(both) > 40
    error = {
        name: both[name] - both[f"{name}_true"]
        for name in ("start_s", "stride_time_s", "contact_time_s", "duty_factor", "stride_length_m")
    }
    assert abs(error["stride_time_s"].mean()) < 1e-3
    for name in ("hip_range_deg", "knee_range_deg"):
        assert abs((both[name] - both[f"{name}_true"]).mean()) < 2.0
    true_peak = both["peak_tibial_g_true"].mean()
    if variant == "recommended":
        assert both["peak_tibial_g"].mean() == pytest.approx(true_peak, rel=0.03)
        assert abs(error["start_s"].mean()) < 8e-3
        assert error["start_s"].std() < 5e-3
        assert abs(error["contact_time_s"].mean()) < 12e-3
        assert abs(error["duty_factor"].mean()) < 0.018
        assert both["stride_length_m"].mean() == pytest.approx(
            both["stride_length_m_true"].mean(), rel=0.03
        )
    else:
        assert 5e-3 < error["start_s"].mean() < 20e-3
        # the window begins too late for the peak of some steps
        assert 0.6 * true_peak < both["peak_tibial_g"].mean() < 1.03 * true_peak
    if variant == "literal_toe_off":
        assert both["duty_factor"].mean() < 0.7 * both["duty_factor_true"].mean()


def test_truth_rows_name_every_measure_with_its_error(whole_lab):
    tables, _ = whole_lab.measured("recommended")
    truth = whole_lab.truth / RUN
    rows = truth_rows(
        RUN,
        whole=tables["runs"],
        strides=tables["strides"],
        alignment=pd.read_parquet(whole_lab.outputs().alignment),
        true_values=json.loads(truth.with_suffix(".json").read_text()),
        true_strides=pd.read_parquet(f"{truth}_strides.parquet"),
        motion=read_run_truth(truth.with_suffix(".npz")).motion,
    ).set_index("measure")
    assert set(MEASURE_KEYS) <= set(rows.index)
    assert (rows["error"] - (rows["estimate"] - rows["truth"])).abs().max() < 1e-12
    assert abs(rows["error"]["initial_contact_bias_ms"]) < 8.0
    assert abs(rows["error"]["toe_off_bias_ms"]) < 12.0
    for sensor in ("foot_right", "shank_left"):
        assert rows["error"][f"alignment_{sensor}_ml_deg"] < 6.0
    # the low-pass takes some of the peak
    assert -0.4 < rows["error"]["peak_tibial_g_unfiltered"] / rows["truth"]["peak_tibial_g"] < 0.0
    # bones turn less in the knee than what soft tissue carries, and not by much
    assert abs(rows["error"]["knee_range_deg_bone"]) < 6.0


def test_a_window_over_the_whole_run_is_the_run(whole_lab, measured):
    """Stride means of a run, weighted by its sides, from its own table of strides."""
    _, tables = measured
    strides, run = tables["strides"], tables["runs"].iloc[0]
    kept = strides[strides["is_valid"] & strides["is_steady"]]
    assert run["n_strides"] == len(kept)
    by_side = kept.groupby("side")[["stride_time_s", "duty_factor", "hip_range_deg"]].mean()
    assert run[by_side.columns].to_numpy(float) == pytest.approx(by_side.mean().to_numpy())


def test_windows_begin_after_the_warm_up_and_hold_their_own_strides(measured):
    _, tables = measured
    windows, strides = tables["windows"], tables["strides"]
    assert windows["start_s"].iloc[0] == 6.0
    assert np.diff(windows["start_s"]) == pytest.approx(5.0)
    assert windows["stop_s"].max() <= 50.0
    counts = strides["is_valid"] & strides["is_steady"]
    for window in windows.to_dict("records"):
        inside = counts & strides["start_s"].between(
            window["start_s"], window["stop_s"], inclusive="left"
        )
        assert window["n_strides"] == inside.sum()
        if inside.sum() >= 8:
            own = strides[inside].groupby("side")["contact_time_s"].mean().mean()
            assert window["contact_time_s"] == pytest.approx(own)


def test_the_turn_is_left_out(measured):
    _, tables = measured
    strides = tables["strides"]
    inside = strides["start_s"].between(21.0, 26.0)
    assert not strides.loc[inside, "is_steady"].any()


def test_mean_heart_rate_needs_half_of_the_span():
    ends = np.arange(1.0, 31.0)
    assert mean_rate_bpm(ends, np.ones(30), 0.0, 60.0) == pytest.approx(60.0)
    assert np.isnan(mean_rate_bpm(ends, np.ones(30), 0.0, 61.0))
