"""Figures: what is drawn is what was estimated; every figure can be saved."""

import kinematics_results as made
import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.figure_style import OKABE_ITO, figure_style, save_figure
from swaystride.studies.kinematics.cycle_figures import (
    figure_4_7,
    figure_4_8,
    figure_4_11,
    stance_peak,
)
from swaystride.studies.kinematics.figure_words import DIRECTION_COLOURS
from swaystride.studies.kinematics.figures import figure_4_5, figure_4_9, figure_4_10
from swaystride.studies.kinematics.plan import ANGLE_NAMES, RANGE_ANGLES, SIDES
from swaystride.studies.kinematics.range_figures import figure_4_12, figure_truth
from swaystride.studies.kinematics.representative import trial_contacts
from swaystride.studies.kinematics.truth_tables import truth_angles


@pytest.fixture(autouse=True)
def style():
    with figure_style():
        yield


@pytest.fixture(scope="module")
def estimates():
    return made.estimates()


@pytest.fixture(scope="module")
def contacts():
    return trial_contacts(made.stride_rows("P01", "01", np.random.default_rng(0)))


@pytest.fixture(scope="module")
def curves():
    return made.curve_rows("P01", "01")


@pytest.fixture(scope="module")
def ranges():
    return pd.read_csv(REPOSITORY / "data" / "published" / "table_4_4.csv")


def test_midstance_and_contacts_of_three_strides_are_marked(estimates, contacts):
    figure = figure_4_5(estimates, contacts)
    for axes in figure.axes:
        vertical = [line for line in axes.lines if len(set(line.get_xdata())) == 1]
        np.testing.assert_allclose(
            sorted(line.get_xdata()[0] for line in vertical),
            made.STRIDE_S * np.arange(4),
            atol=1e-9,
        )
        shaded = [patch.get_extents() for patch in axes.patches]
        assert len([box for box in shaded if np.isfinite(box.width)]) == 3
    acceleration = max(figure.axes[0].lines, key=lambda line: len(line.get_xdata()))
    assert acceleration.get_ydata().max() == pytest.approx((9.8 + 120) / 9.80665, rel=0.01)


def test_the_drift_of_integration_is_drawn_beside_that_of_the_filter(estimates, contacts):
    raw, own = figure_4_9(estimates, contacts).axes
    last = [line.get_ydata()[-1] for line in raw.lines[:3]]
    np.testing.assert_allclose(last, [1.5 * (1 + a) * 39.6 for a in (6, 7, 8)], rtol=0.01)
    level = [line.get_ydata()[-1] for line in own.lines[:3]]
    expected = [made.bias_deg(ANGLE_NAMES[a], "left") for a in (6, 7, 8)]
    np.testing.assert_allclose(level, expected, atol=0.01)


def test_the_first_strides_are_drawn_and_those_left_out_are_shaded(estimates, contacts):
    figure = figure_4_10(estimates, contacts)
    assert len(figure.axes) == 6
    for at, axes in enumerate(figure.axes):
        first = 7.1 if at % 2 == 0 else 7.45
        assert axes.patches[0].get_extents().x1 <= axes.transData.transform((first + 0.01, 0))[0]
        low, high = axes.get_xlim()
        assert (high - low) / made.STRIDE_S == pytest.approx(12.5, abs=0.1)
        assert [line.get_label() for line in axes.lines[:2]] == ["OPTIC", "ErKF"]


def test_mean_curves_of_all_angles_and_sides_are_drawn(curves):
    figure = figure_4_11(curves)
    assert len(figure.axes) == 18
    phase = np.arange(101) / 100
    for at, axes in enumerate(figure.axes):
        side, angle = SIDES[at // 9], ANGLE_NAMES[at % 9]
        optic, erkf = (line.get_ydata() for line in axes.lines)
        np.testing.assert_allclose(optic, made.wave(phase, angle, side))
        np.testing.assert_allclose(erkf - optic, made.bias_deg(angle, side))
        assert side in axes.get_title(loc="left").lower()


def test_features_are_marked_on_the_curve_of_the_filter(curves):
    figure = figure_4_7(curves)
    hip = figure.axes[0]
    marks = [line for line in hip.lines if line.get_marker() == "o"]
    mean = hip.lines[1].get_ydata()
    assert [mark.get_ydata()[0] for mark in marks] == [mean.max(), mean.min()]
    assert [text.get_text() for text in hip.texts] == ["peak flexion", "peak extension"]


def test_the_peak_of_stance_comes_before_that_of_swing():
    phase = np.arange(101) / 100
    assert stance_peak(made.wave(phase, "knee_flexion", "right")) == 15
    assert stance_peak(np.linspace(0, 60, 101)) == 39


def test_shifted_centres_are_drawn_by_direction():
    joints = ("hip",)
    figure = figure_4_8(made.perturbation_curve_rows("01"), joints)
    assert len(figure.axes) == 9 * 2 * len(joints)
    axes = figure.axes[0]
    offsets = {
        colour: sorted(
            round(float(np.mean(line.get_ydata() - axes.lines[-1].get_ydata())), 6)
            for line in axes.lines
            if line.get_color() == colour
        )
        for colour in DIRECTION_COLOURS.values()
    }
    assert axes.lines[-1].get_color() == OKABE_ITO["black"]
    assert list(offsets.values()) == [[-1.0, 1.0], [-2.0, 2.0], [-3.0, 3.0]]


def test_bars_and_asterisks_are_those_of_the_table(ranges):
    for axes, side in zip(figure_4_12(ranges).axes, SIDES, strict=True):
        own = ranges[ranges["side"] == side].set_index("angle").loc[list(RANGE_ANGLES)]
        heights = [bar.get_height() for bar in axes.patches]
        np.testing.assert_allclose(heights, [*own["optic_deg_mean"], *own["erkf_deg_mean"]])
        assert len(axes.texts) == own["significant"].sum()
        assert sum(bar.get_hatch() is not None for bar in axes.patches) == 3


def test_panels_that_share_an_axis_show_the_largest_value_of_all(estimates, contacts, ranges):
    """The second panel holds the larger values."""
    larger = ranges.copy()
    larger.loc[larger["side"] == "left", "erkf_deg_mean"] += 200.0
    truth = truth_angles(made.frames()["truth"])
    truth.loc[truth["side"] == "left", "optic_rmsd_deg_mean"] = 90.0
    strong = estimates.copy(deep=True)
    strong["foot_acc_m_s2"].loc[{"side": "left"}] *= 3.0
    assert figure_4_12(larger).axes[0].get_ylim()[1] > 300.0
    assert figure_truth(truth).axes[0].get_ylim()[1] > 90.0
    assert figure_4_5(strong, contacts).axes[0].get_ylim()[1] > 3 * (9.8 + 119) / 9.80665


def test_every_figure_finds_room_for_its_panels(estimates, contacts, curves, ranges):
    """A layout that does not fit is a warning, and warnings are errors."""
    truth = truth_angles(made.frames()["truth"])
    for figure in (
        figure_4_5(estimates, contacts),
        figure_4_7(curves),
        figure_4_9(estimates, contacts),
        figure_4_10(estimates, contacts),
        figure_4_12(ranges),
        figure_truth(truth),
    ):
        figure.draw_without_rendering()


def test_a_figure_says_that_it_is_simulated(ranges, tmp_path):
    files = save_figure(figure_4_12(ranges), tmp_path / "figure", simulated=True)
    assert [file.suffix for file in files] == [".svg", ".png", ".pdf"]
