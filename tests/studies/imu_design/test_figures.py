"""Figures: what is drawn is what was measured."""

import numpy as np
import pandas as pd
import pytest

from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.imu_design.conditions import Signals
from swaystride.studies.imu_design.experiments import EXPERIMENTS
from swaystride.studies.imu_design.figures import (
    condition_colours,
    figure_error_over_loss,
    figure_error_over_speed,
    figure_residuals,
    figure_stride_differences,
)
from swaystride.studies.imu_design.models import residuals
from swaystride.studies.imu_design.raw_figures import SampleTrial, figure_truncated


@pytest.fixture(autouse=True)
def style():
    with figure_style():
        yield


def points(axes, n):
    """Data of the series with n points, in the order in which they were drawn."""
    return [line.get_xydata() for line in axes.lines if len(line.get_xdata()) == n]


def test_every_trial_is_drawn_under_every_condition(observations_with):
    table = observations_with(row_sd=0.1)
    own = table[table["experiment"] == "accelerometer_range"]
    drawn = points(figure_error_over_speed(table, "accelerometer_range", 5.0).axes[0], 60)
    assert len(drawn) == 7
    for series, name in zip(drawn, dict.fromkeys(own["condition"]), strict=True):
        rows = own[own["condition"] == name]
        np.testing.assert_array_equal(series, rows[["speed_m_s", "error_pct"]].to_numpy())


def test_the_limit_of_the_data_is_drawn_where_the_first_error_is_beyond_it(observations_with):
    table = observations_with()
    own = table[table["experiment"] == "gyro_range"]
    beyond = own[own["error_pct"].abs() > 5.0]
    axes = figure_error_over_loss(table, "gyro_range", 5.0, 2.6).axes[0]
    vertical = [line.get_xdata()[0] for line in points_vertical(axes)]
    assert vertical == [2.6, beyond["loss_percent"].min()]
    inside = figure_error_over_loss(table, "gyro_range", 500.0, 2.6).axes[0]
    assert [line.get_xdata()[0] for line in points_vertical(inside)] == [2.6]


def points_vertical(axes):
    return [
        line
        for line in axes.lines
        if len(line.get_xdata()) == 2 and line.get_xdata()[0] == line.get_xdata()[1]
    ]


@pytest.mark.parametrize("experiment", EXPERIMENTS)
def test_spread_is_drawn_without_the_baseline(observations_with, experiment, settings):
    figure = figure_stride_differences(observations_with(), experiment)
    for axes in figure.axes:
        assert len(points(axes, 60)) == len(settings.levels(experiment)) - 1


def test_colours_are_distinct_and_the_baseline_is_black():
    colours = condition_colours(list("abcdefg"))
    assert colours["a"] == "#000000"
    assert len(set(colours.values())) == 7


def sample(n=400, rate_hz=100.0):
    """A foot that moves with the period of one second, at 30 g and 1200 °/s."""

    time = np.arange(n) / rate_hz
    wave = np.sin(2 * np.pi * time)
    signals = Signals(
        np.stack([30 * 9.80665 * wave, wave, wave]),
        np.stack([wave, np.deg2rad(1200) * wave, wave]),
        rate_hz,
    )
    strides = pd.DataFrame({"start_s": [0.0, 1.0, 2.0], "stop_s": [1.0, 2.0, 3.0]})
    return SampleTrial("a  Walking", signals, strides, np.array([[0.9, 1.2], [1.9, 2.2]]))


def test_truncations_are_drawn_in_g_and_degrees(settings, tmp_path):
    for experiment, at, full in (("accelerometer_range", 0, 30.0), ("gyro_range", 1, 1200.0)):
        figure = figure_truncated([sample(), sample()], experiment, settings)
        assert len(figure.axes) == 6
        axes = figure.axes[2 * at]
        largest = [np.abs(line.get_ydata()).max() for line in axes.lines]
        expected = [min(full, level) for level in settings.levels(experiment)]
        np.testing.assert_allclose(largest, expected, rtol=1e-3)
        assert len(axes.patches) >= 1
    first = save_figure(figure, tmp_path / "one", simulated=True)[1].read_bytes()
    assert save_figure(figure, tmp_path / "two", simulated=True)[1].read_bytes() == first


def test_residuals_of_all_experiments_are_drawn(observations_with, plan):

    table = observations_with(row_sd=1.0)
    parts = pd.concat([residuals(table, name, plan) for name in EXPERIMENTS])
    figure = figure_residuals(parts, {name: name for name in EXPERIMENTS})
    assert len(figure.axes) == 8
    assert len(figure.axes[0].lines[0].get_xdata()) == 420
