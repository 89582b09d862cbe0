"""Figures: what is drawn is what was measured; every figure can be saved."""

import experience_results as made
import numpy as np
import pandas as pd
import pytest

from swaystride.gait.rating_windows import WindowRule
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.experience import exemplars
from swaystride.studies.experience.rating_figures import figure_5_4, figure_5_5, figure_5_6
from swaystride.studies.experience.series_figures import (
    empty_figure,
    figure_5_2,
    figure_5_3,
    figure_5_9,
)
from swaystride.studies.experience.summary_figure import figure_5_7, figure_5_8
from swaystride.studies.experience.table_options import TruthLimits
from swaystride.studies.experience.tables import association_table
from swaystride.studies.experience.truth_figure import figure_truth

LIMITS = TruthLimits(1.0, 12.0, 0.018, 2.0, 8.0, 5.0, 2.0, 2.0, 2.0, 6.0, 10.0, 3.0)
WINDOWS = WindowRule(60.0, 20.0)


@pytest.fixture(autouse=True)
def style():
    with figure_style():
        yield


@pytest.fixture(scope="module")
def joined():
    return made.joined()


@pytest.fixture(scope="module")
def strides():
    return {run: made.stride_rows(run) for run in made.MEASURED}


def spans(axes):
    """Begin and end of the shaded spans of a panel."""
    boxes = [patch.get_extents().transformed(axes.transData.inverted()) for patch in axes.patches]
    return [(round(box.x0, 2), round(box.x1, 2)) for box in boxes]


def test_four_runs_are_chosen_by_their_changes(strides):
    assert exemplars.four_runs(strides) == ["P01_01", "P01_02", "P02_02", "P02_01"]
    assert exemplars.four_runs({"P02_01": strides["P02_01"]}) == ["P02_01"]
    early, late = exemplars.duty_factor_changes(strides["P01_01"])
    per_s = made.DRIFT_MS["P01_01"] / 1000.0 / made.STRIDE_S / made.DURATION_S
    assert early == pytest.approx(per_s * (180 + 70 - 30), rel=0.02)
    assert late == pytest.approx(per_s * 280, rel=0.02)


def test_what_is_left_out_is_grey(strides):
    figure = figure_5_2(strides)
    for axes in figure.axes:
        warm_up, turn = spans(axes)
        assert warm_up == (0.0, pytest.approx(made.WARM_UP_S / 60, abs=0.02))
        assert turn == (pytest.approx(5.0, abs=0.02), pytest.approx(10 / 60 + 5, abs=0.02))
    line = figure.axes[3].lines[-1]
    np.testing.assert_allclose(line.get_ydata(), made.AERIAL, rtol=1e-12)


def test_fewer_runs_leave_panels_empty(strides):
    figure = figure_5_2({run: strides[run] for run in made.MEASURED[:2]})
    assert [axes.axison for axes in figure.axes] == [True, True, False, False]


def test_windows_are_drawn_where_the_rating_changes(strides):
    run = exemplars.most_rated_run(
        pd.concat(map(made.affect_rows, made.MEASURED)), ["P02_01", "P01_02"]
    )
    assert run == "P01_02"
    windows = made.window_rows(run)
    figure = figure_5_3(run, strides[run], windows, made.affect_rows(run), WINDOWS)
    upper, lower = figure.axes
    means = [line for line in upper.lines if line.get_marker() == "D"]
    assert len(means) == 2
    first, second = (line.get_xdata()[0] for line in means)
    assert second - first == WINDOWS.step_s
    at = int(windows.index[windows["start_s"] + 30 == first][0])
    assert windows["affective_valence"].diff()[at + 1] == 1
    for line, row in zip(means, (at, at + 1), strict=True):
        assert line.get_ydata()[0] == pytest.approx(1000 * windows["contact_time_s"][row])
    ratings = [line.get_ydata()[0] for line in lower.lines if line.get_marker() == "D"]
    assert ratings == windows["affective_valence"][at : at + 2].tolist()


def test_affect_has_a_row_per_participant_and_a_column_per_run(joined):
    figure = figure_5_4(joined["answers/affect"], made.checks())
    shown = [axes.get_visible() for axes in figure.axes]
    assert shown == [True, True, True, True, True, False, True, True, False]
    steps = figure.axes[0].lines[0]
    assert steps.get_xdata()[-1] == made.DURATION_S / 60
    assert steps.get_ydata().tolist() == [1, 2, 3, 4, 5, 5]
    assert not figure.axes[7].lines  # the run that was left out has no ratings


def test_every_rating_is_counted(joined):
    figure = figure_5_5(joined["answers/affect"])
    heights = [bar.get_height() for bar in figure.axes[0].patches]
    assert heights == [0, 0, 0, 0, 0, 0, 5, 5, 10, 5, 5]


def test_every_score_is_counted(joined):
    figure = figure_5_6(joined["answers/scores"])
    for axes in figure.axes:
        assert sum(bar.get_height() for bar in axes.patches) == 6


def test_only_significant_associations_have_a_cell(joined):
    rows = joined["models/associations"]
    tables = {group: association_table(rows, group, 0.05) for group in ("all", "aerial")}
    tables["aerial"] = tables["aerial"].assign(significant=0)
    figure = figure_5_7(tables)
    first, second = figure.axes
    assert len(first.patches) == (tables["all"]["significant"] == 1).sum()
    assert not second.patches
    assert {text.get_text() for text in first.texts} == {"0.80", "\N{MINUS SIGN}0.80"}


def test_no_significant_association_is_a_figure_too(joined):
    table = association_table(joined["models/associations"], "all", 0.05).assign(significant=0)
    assert not figure_5_7({"all": table}).axes[0].patches


def test_runs_are_drawn_by_pattern(joined):
    figure = figure_5_8(joined["models/within_runs"])
    aerial, terrestrial = figure.axes
    points = aerial.lines[0]
    assert points.get_ydata().tolist() == [-0.6, 0.1, 0.7, 0.8]
    assert [label.get_text() for label in terrestrial.get_xticklabels()] == ["P03_01"]
    low, high = aerial.collections[0].get_segments()[0][:, 1]
    assert (low, high) == (pytest.approx(-0.8), pytest.approx(-0.4))


def test_the_exemplar_of_time_loses_most(joined, strides):
    result = exemplars.confounded_run(joined["models/within_runs"])
    assert result["run"] == "P01_02"
    figure = figure_5_9(
        result["run"],
        made.window_rows("P01_02"),
        made.affect_rows("P01_02"),
        strides["P01_02"],
        result,
    )
    trend = figure.axes[0].lines[1]
    per_min = made.DRIFT_MS["P01_02"] / 10.0
    np.testing.assert_allclose(np.diff(trend.get_ydata()) / np.diff(trend.get_xdata()), per_min)
    assert exemplars.confounded_run(joined["models/within_runs"].iloc[:0]) is None


def test_without_a_significant_run_the_largest_is_shown(joined):
    weak = joined["models/within_runs"].assign(ci_low=-1.0)
    assert exemplars.confounded_run(weak)["run"] == "P01_01"


def test_errors_outside_a_limit_are_marked():
    errors = pd.concat(map(made.truth_rows, made.MEASURED), ignore_index=True)
    at = (errors["run"] == "P02_01") & (errors["measure"] == "knee_range_deg")
    errors.loc[at, "error"] = -3.0
    figure = figure_truth(errors, LIMITS)
    knee = next(axes for axes in figure.axes if axes.get_title(loc="left") == "Knee range (°)")
    inside, outside = (line for line in knee.lines if line.get_marker() in "oD")
    assert len(inside.get_xdata()) == len(made.MEASURED) - 1
    assert (outside.get_xdata().tolist(), outside.get_ydata().tolist()) == ([3.0], [-3.0])


def test_a_figure_says_why_it_is_empty(tmp_path):
    figure = empty_figure("no run with ratings that vary")
    assert figure.axes[0].texts[0].get_text() == "no run with ratings that vary"
    assert len(save_figure(figure, tmp_path / "nothing", simulated=True)) == 3
