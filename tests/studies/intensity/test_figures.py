"""Figures: what is drawn is what was counted."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.studies.intensity.difficulty import difficulty, residuals
from swaystride.studies.intensity.figures import (
    figure_difficulty,
    figure_predicted_ratings,
    figure_residuals,
    figure_self_ratings,
)
from swaystride.studies.intensity.kinematics import predictions
from swaystride.studies.intensity.plan import DIMENSIONS
from swaystride.studies.intensity.tables import table_3_2


@pytest.fixture(autouse=True)
def style():
    with figure_style():
        yield


def cells(figure):
    """Counts as written, self-rating or prediction by row, and the shares that shade them."""
    axes = figure.axes[0]
    written = np.zeros((5, 5), dtype=int)
    for text in axes.texts:
        column, row = (int(at) for at in text.get_position())
        written[row, column] = int(text.get_text())
    return written, np.asarray(axes.images[0].get_array())


@pytest.mark.parametrize("level", ["per_trial", "per_exercise"])
def test_self_ratings_are_counted_by_row(ratings, level):
    own = ratings[ratings["rating_level"] == level]
    expected = pd.crosstab(own["self_rating"], own["rating"]).reindex(
        index=range(1, 6), columns=range(1, 6), fill_value=0
    )
    written, shares = cells(figure_self_ratings(ratings, level))
    np.testing.assert_array_equal(written, expected)
    np.testing.assert_allclose(shares, expected.div(expected.sum(axis=1), axis=0).fillna(0.0))


@pytest.mark.parametrize("level", ["per_trial", "per_exercise"])
def test_predicted_ratings_are_rounded_and_counted_by_row(ratings, sway, plan, level):
    predicted = predictions(ratings, sway, plan, quick=True)["predicted"]
    own = predicted[predicted["rating_level"] == level]
    written, _ = cells(figure_predicted_ratings(predicted, level))
    assert written.sum() == len(own)
    for rating in range(1, 6):
        low = -np.inf if rating == 1 else rating - 0.5
        high = np.inf if rating == 5 else rating + 0.5
        inside = (own["predicted"] >= low) & (own["predicted"] < high)
        assert written[rating - 1].sum() == inside.sum()


def test_difficulty_shows_both_intervals_and_the_print(ratings, plan, tmp_path):
    ours = table_3_2(difficulty(ratings, plan))
    printed = pd.read_csv(REPOSITORY / "data" / "published" / "table_3_2.csv")
    figure = figure_difficulty(ours, printed)
    assert len(figure.axes) == 2
    for axes, level in zip(figure.axes, ("per_trial", "per_exercise"), strict=True):
        points = [line.get_xdata() for line in axes.lines if len(line.get_xdata()) == 4]
        mine = ours[ours["rating"] == level].set_index("aspect").loc[list(DIMENSIONS), "estimate"]
        np.testing.assert_allclose(points[0], mine)
        theirs = printed[printed["rating"] == level].set_index("aspect")
        np.testing.assert_allclose(points[1], theirs.loc[list(DIMENSIONS), "estimate"])
    first = save_figure(figure, tmp_path / "figure", simulated=True)[1].read_bytes()
    again = save_figure(figure_difficulty(ours, printed), tmp_path / "again", simulated=True)
    assert again[1].read_bytes() == first


def test_residuals_of_all_dimensions_are_drawn(ratings, plan):
    table = residuals(ratings, plan)
    figure = figure_residuals(table)
    assert len(figure.axes) == 8
    n = (ratings["rating_level"] == "per_trial").sum()
    assert all(len(axes.lines[0].get_xdata()) == n for axes in figure.axes)
