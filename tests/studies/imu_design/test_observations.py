"""From feet to trials: against a table written by hand."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import RecordingError
from swaystride.studies.imu_design.observations import (
    mean_speeds,
    observations,
    recording_verdicts,
    sample_trials,
    usable_metrics,
)

# participant trial foot experiment condition level start stop distance strides loss n mean sd
ROWS = """
A 01 left  accelerometer_range baseline_100g   100 2.0 52.0  99 40 0 10 0.00 0.00
A 01 right accelerometer_range baseline_100g   100 2.4 53.0 101 41 0 10 0.00 0.00
A 01 left  accelerometer_range 6g                6 2.0 52.0  90 40 4  2 0.10 0.10
A 01 right accelerometer_range 6g                6 2.4 53.0  80 41 8  2 0.30 0.10
A 01 left  decimation          baseline_1000hz 1000 1.0 59.0  98 40 . 10 0.00 0.00
B 01 right accelerometer_range baseline_100g   100 3.0 23.0  99 20 0 10 0.00 0.00
B 01 right accelerometer_range 6g                6 3.0 23.0   .  . .  . .    .
C 01 left  decimation          baseline_1000hz 1000 2.0 27.0 100 25 . 10 0.00 0.00
"""
COLUMNS = [
    "participant",
    "trial",
    "foot",
    "experiment",
    "condition",
    "level",
    "motion_start_s",
    "motion_stop_s",
    "distance_m",
    "n_strides",
    "loss_percent",
    "n_matched",
    "length_difference_mean_m",
    "length_difference_sd_m",
]


def make_metrics(text=ROWS):
    rows = [line.split() for line in text.strip().splitlines()]
    table = pd.DataFrame(rows, columns=COLUMNS).replace(".", np.nan)
    numeric = COLUMNS[5:]
    table[numeric] = table[numeric].astype(float)
    for name, source in (("n_angles", "n_matched"),):
        table[name] = table[source]
    for end in ("mean", "sd"):
        table[f"angle_difference_{end}_deg"] = 10 * table[f"length_difference_{end}_m"]
    return table.assign(known_distance_m=100.0)


def test_speed_is_distance_over_first_start_to_last_stop_of_imu_1():
    """A: 2.0 to 53.0 s, whatever IMU 2 says; C has only IMU 2."""
    speeds = mean_speeds(make_metrics()).set_index("participant")["speed_m_s"]
    assert speeds["A"] == pytest.approx(100 / 51.0)
    assert speeds["B"] == pytest.approx(100 / 20.0)
    assert speeds["C"] == pytest.approx(100 / 25.0)


def test_observations_agree_with_a_table_written_by_hand():
    table = observations(make_metrics())
    keys = table[["participant", "experiment", "condition"]].values.tolist()
    assert keys == [
        ["A", "accelerometer_range", "baseline_100g"],
        ["B", "accelerometer_range", "baseline_100g"],
        ["A", "accelerometer_range", "6g"],
        ["A", "decimation", "baseline_1000hz"],
        ["C", "decimation", "baseline_1000hz"],
    ]
    np.testing.assert_allclose(table["error_pct"], [0.0, -1.0, -15.0, -2.0, 0.0], atol=1e-9)
    assert table["n_feet"].tolist() == [2, 1, 2, 1, 1]
    assert table["n_strides"].tolist() == [81, 20, 81, 40, 25]
    assert table["loss_percent"].tolist()[:3] == [0.0, 0.0, 6.0]
    # differences 0.1 ± 0.1 and 0.3 ± 0.1 over two strides each
    both = np.r_[
        0.1 + 0.1 * np.array([-1, 1]) / np.sqrt(2), 0.3 + 0.1 * np.array([-1, 1]) / np.sqrt(2)
    ]
    assert table["length_difference_sd_m"][2] == pytest.approx(both.std(ddof=1))
    assert table["angle_difference_sd_deg"][2] == pytest.approx(10 * both.std(ddof=1))


def test_a_recording_without_rest_or_stride_is_not_used():
    metrics = make_metrics()
    metrics.loc[(metrics["participant"] == "A") & (metrics["foot"] == "left"), "motion_stop_s"] = (
        np.nan
    )
    metrics.loc[metrics["participant"] == "C", "n_strides"] = 0
    metrics.loc[metrics["participant"] == "B", "motion_start_s"] = np.nan
    verdicts = recording_verdicts(metrics)
    assert verdicts.values.tolist() == [
        ["A", "01", "left", "imu_1", "no rest at the end"],
        ["A", "01", "right", "imu_1", ""],
        ["A", "01", "left", "imu_2", "no rest at the end"],
        ["B", "01", "right", "imu_1", "no rest at the start"],
        ["C", "01", "left", "imu_2", "no stride"],
    ]
    table = observations(usable_metrics(metrics))
    assert table["participant"].tolist() == ["A", "A"]
    np.testing.assert_allclose(table["error_pct"], [1.0, -20.0], atol=1e-9)


def test_a_cohort_without_any_usable_recording_is_refused():
    metrics = make_metrics().assign(motion_start_s=np.nan)
    with pytest.raises(RecordingError, match="no recording of the cohort is usable; expected"):
        usable_metrics(metrics)


def test_sample_trials_are_the_nearest_in_speed(plan, observations_with):
    table = observations_with()
    samples = sample_trials(table, plan)
    assert samples["gait"].tolist() == ["walking", "running"]
    speeds = table["speed_m_s"].unique()
    for found, wanted in zip(samples["speed_m_s"], (1.4, 5.8), strict=True):
        assert abs(found - wanted) == np.abs(speeds - wanted).min()
