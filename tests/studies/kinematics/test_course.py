"""Drift, convergence and midstance of a trial, from errors that are known in closed form."""

import kinematics_results as made
import numpy as np
import pandas as pd
import pytest

from swaystride.studies.kinematics.course import (
    convergence,
    drift,
    stride_levels,
    stride_starts,
    trial_course,
)
from swaystride.studies.kinematics.representative import trial_contacts
from swaystride.studies.kinematics.table_options import TableOptions

OPTIONS = TableOptions(0.05, 2.0, 30.0, 1.0, 10, 5.0)
TIME = np.arange(0, 40, 0.005)
STARTS = np.arange(0, 40, 0.7)


@pytest.fixture(scope="module")
def contacts():
    return trial_contacts(made.stride_rows("P01", "01", np.random.default_rng(0)))


def test_drift_of_a_line_is_its_slope_times_the_distance_of_the_windows():
    window = 40 / 3  # a third of the trial, less than the window asked for
    assert drift(0.3 * TIME, TIME, 30.0) == pytest.approx(0.3 * (40 - window), abs=0.01)
    assert drift(0.3 * TIME, TIME, 5.0) == pytest.approx(0.3 * 35, abs=0.01)
    assert np.isnan(drift(np.full(TIME.size, np.nan), TIME, 5.0))


@pytest.mark.parametrize("number", [0, 1, 4, 9])
def test_an_error_that_ends_with_a_stride_converges_after_it(number):
    error = np.where(0.7 * number - 1e-9 > TIME, 5.0, 0.0) + 2.0
    assert convergence(error, TIME, STARTS, OPTIONS) == number


def test_an_error_within_the_band_counts_as_converged():
    assert convergence(np.where(TIME < 2, 0.9, 0.0), TIME, STARTS, OPTIONS) == 0
    # the third stride lies mostly before two seconds
    assert convergence(np.where(TIME < 2, 1.1, 0.0), TIME, STARTS, OPTIONS) == 3


def test_a_single_stride_that_strays_later_does_not_count():
    error = np.where((TIME > 7.0) & (TIME < 7.7), 5.0, 0.0)
    assert convergence(error, TIME, STARTS, OPTIONS) == 0


def test_slow_drift_of_a_whole_trial_is_not_a_slow_start():
    assert convergence(0.01 * TIME, TIME, STARTS, OPTIONS) == 0


def test_a_level_that_is_never_kept_for_three_strides_is_no_convergence():
    """Two strides of three are at the level, which makes it the median: never three in a row."""
    error = np.where(np.floor(TIME / 0.7 + 1e-9) % 3 == 2, 5.0, 0.0)
    assert convergence(error, TIME, STARTS, OPTIONS) == np.inf


def test_too_few_strides_have_no_convergence():
    assert np.isnan(convergence(TIME * 0, TIME, STARTS[:8], OPTIONS))


def test_a_spike_of_the_markers_is_not_a_late_convergence():
    spike = np.where((TIME > 6.0) & (TIME < 6.2), -40.0, 0.0)
    assert convergence(spike, TIME, STARTS, OPTIONS) == 0


def test_the_level_of_a_stride_is_its_median_and_missing_if_much_is_missing():
    error = np.where(TIME < 0.3, 9.0, 3.0)
    error[(TIME > 0.75) & (TIME < 0.9)] = np.nan
    error[(TIME > 1.45) & (TIME < 1.5)] = np.nan
    levels = stride_levels(error, TIME, STARTS[:5])
    np.testing.assert_allclose(levels, [3.0, np.nan, 3.0, 3.0])


def test_starts_are_laid_back_to_the_start_of_the_recording(contacts):
    own = contacts[contacts["side"] == "right"]
    starts = stride_starts(own, 0.0)
    np.testing.assert_allclose(np.diff(starts), made.STRIDE_S)
    assert starts[0] == pytest.approx(0.1)
    assert starts.size == 10 + made.N_STRIDES + 1


def test_a_whole_trial(contacts):
    table = trial_course(made.estimates(), contacts, OPTIONS)
    assert len(table) == 18
    # the start error of eight degrees decays with 0.8 s: below one degree after 1.7 s
    assert table["strides_to_convergence"].between(1, 3).all()
    first = table[(table["side"] == "right") & (table["angle"] == "hip_flexion")].iloc[0]
    assert first["drift_integrated_deg"] == pytest.approx(1.5 * (40 - 40 / 3), rel=0.01)
    assert abs(first["drift_erkf_deg"]) < 1.0
    assert first["midstance_samples_per_stride"] == pytest.approx(0.05 * 0.7 * 200, abs=0.5)
    assert first["n_strides"] == made.N_STRIDES


def test_missing_markers_leave_the_rest_of_the_course(contacts):
    estimates = made.estimates()
    estimates["angle_deg"].loc[{"source": "optic", "side": "left"}] = np.nan
    table = trial_course(estimates, contacts, OPTIONS).set_index(["side", "angle"])
    assert table.loc["left", "drift_erkf_deg"].isna().all()
    assert table.loc["right", "drift_erkf_deg"].notna().all()
    assert pd.notna(table.loc[("left", "hip_flexion"), "midstance_samples_per_stride"])
