"""Strides against the truth: closed forms of a foot that walks a polygon."""

import numpy as np
import pandas as pd
import pytest

from swaystride.studies.imu_design.truth import error_table, gait_of, true_strides


def zigzag(time_s):
    """Strides of 1.5 m and 1 s, turned by 30° to the left and to the right in turn."""
    corners = np.cumsum(
        [(0.0, 0.0)] + [(1.5 * np.cos(a), 1.5 * np.sin(a)) for a in np.deg2rad([0, 30] * 4)], axis=0
    )
    xy = [np.interp(time_s, np.arange(9.0), corners[:, at]) for at in (0, 1)]
    return np.stack([*xy, np.zeros_like(time_s)], axis=1)


def estimate(scale=1.0):
    edges = np.arange(9.0)
    half = np.zeros(8, dtype=bool)
    half[[0, -1]] = True
    return pd.DataFrame(
        {
            "start_s": edges[:-1],
            "stop_s": edges[1:],
            "length_m": 1.5 * scale,
            "angle_rad": np.r_[np.full(7, np.deg2rad(31.0)), np.nan],
            "is_half": half,
        }
    )


def test_true_length_and_angle_are_those_of_the_path():
    errors = true_strides(estimate(), zigzag)
    np.testing.assert_allclose(errors["true_length_m"], 1.5)
    np.testing.assert_allclose(errors["true_angle_deg"][:7], 30.0)
    assert np.isnan(errors["true_angle_deg"][7])


def test_errors_are_summarised_by_method_and_gait():
    parts = []
    for method, scale in (("printed", 0.97), ("recommended", 1.01)):
        for gait in ("sprinting", "walking"):
            errors = true_strides(estimate(scale), zigzag)
            parts.append(errors.assign(method=method, imu="imu_1", gait=gait))
    table = error_table(pd.concat(parts, ignore_index=True))
    assert table["method"].tolist() == ["printed", "printed", "recommended", "recommended"]
    assert table["gait"].tolist() == ["walking", "sprinting"] * 2
    assert table["n_strides"].tolist() == [6] * 4
    np.testing.assert_allclose(table["mean_error_percent"], [-3, -3, 1, 1])
    np.testing.assert_allclose(table["rms_error_percent"], [3, 3, 1, 1])
    np.testing.assert_allclose(table["sd_error_percent"], 0, atol=1e-12)
    np.testing.assert_allclose(table["median_angle_error_deg"], 1.0)


@pytest.mark.parametrize(
    ("duty", "speed", "gait"),
    [
        (0.62, 1.2, "walking"),
        (0.51, 6.0, "walking"),
        (0.36, 2.3, "running"),
        (0.2, 5.5, "sprinting"),
    ],
)
def test_gaits(duty, speed, gait):
    assert gait_of(duty, speed, 5.5) == gait
