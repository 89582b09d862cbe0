"""Conditions: one sensor is changed at a time, in the unit of its range; names as printed."""

import numpy as np
import pandas as pd
import pytest
import scipy.signal

from import_graph import REPOSITORY
from swaystride.errors import RecordingError
from swaystride.studies.imu_design.conditions import Signals, limited
from swaystride.studies.imu_design.experiments import EXPERIMENTS, effect_names
from swaystride.studies.imu_design.plan import TABLES

RNG = np.random.default_rng(4)
SIGNALS = Signals(60.0 * RNG.normal(size=(3, 4000)), 8.0 * RNG.normal(size=(3, 4000)), 1000.0)


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_names_are_those_of_the_printed_tables(experiment, settings):
    printed = pd.read_csv(REPOSITORY / f"data/published/{TABLES[experiment]}.csv")
    assert effect_names(experiment, settings) == printed["effect"].tolist()


def test_a_range_in_g_clips_the_accelerometer_alone(settings):
    changed, loss = limited(SIGNALS, "accelerometer_range", 6.0, settings)
    assert np.abs(changed.acc_m_s2).max() == pytest.approx(6 * 9.80665)
    assert changed.gyr_rad_s is SIGNALS.gyr_rad_s
    expected = np.linalg.norm(changed.acc_m_s2, axis=0).sum()
    whole = np.linalg.norm(SIGNALS.acc_m_s2, axis=0).sum()
    assert loss == pytest.approx(100 * (1 - expected / whole))


def test_a_range_in_degrees_clips_the_gyroscope_alone(settings):
    changed, loss = limited(SIGNALS, "gyro_range", 500.0, settings)
    assert np.abs(changed.gyr_rad_s).max() == pytest.approx(np.deg2rad(500))
    assert changed.acc_m_s2 is SIGNALS.acc_m_s2
    assert 0 < loss < 100


def test_a_condition_without_effect_is_recognised(settings):
    changed, loss = limited(SIGNALS, "accelerometer_range", 100.0, settings)
    assert changed.same_as(SIGNALS)
    assert loss == 0.0
    assert not limited(SIGNALS, "gyro_range", 500.0, settings)[0].same_as(SIGNALS)
    assert limited(SIGNALS, "decimation", 1000.0, settings)[0].same_as(SIGNALS)


def test_both_methods_lower_the_rate_of_both_sensors(settings):
    left_out, loss = limited(SIGNALS, "downsampling", 125.0, settings)
    assert left_out.rate_hz == 125.0
    assert np.isnan(loss)
    np.testing.assert_array_equal(left_out.gyr_rad_s, SIGNALS.gyr_rad_s[:, ::8])
    filtered, _ = limited(SIGNALS, "decimation", 125.0, settings)
    theirs = scipy.signal.decimate(SIGNALS.acc_m_s2, 8, n=8, axis=-1)
    np.testing.assert_allclose(filtered.acc_m_s2, theirs, atol=1e-9)


def test_a_rate_that_does_not_divide_is_refused(settings):
    odd = Signals(SIGNALS.acc_m_s2, SIGNALS.gyr_rad_s, 800.0)
    with pytest.raises(
        RecordingError, match="no whole multiple of the one wanted; expected a mult"
    ):
        limited(odd, "downsampling", 500.0, settings)
