"""Figures 3.3 and 3.4 of the chapter, the effects beside the print, and the residuals."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.special import ndtri

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.stats.agreement import contingency, rounded_rating
from swaystride.studies.intensity.plan import DIMENSIONS, RATING_LEVELS, RatingLevel

_LEVELS = (1, 2, 3, 4, 5)
_RATED = {"per_trial": "a trial", "per_exercise": "an exercise"}


def figure_self_ratings(ratings: pd.DataFrame, level: RatingLevel) -> Figure:
    """Counts of therapists' ratings against self-ratings (Figure 3.3a, b).

    Parameters
    ----------
    ratings : DataFrame
        As from :func:`swaystride.studies.intensity.observations.analysed_ratings`.
    level : {"per_trial", "per_exercise"}
    """
    chosen = (ratings["rating_level"] == level) & ratings["self_rating"].notna()
    pairs = ratings[chosen]
    counts = contingency(pairs["self_rating"].astype(int), pairs["rating"].astype(int), _LEVELS)
    return _counts_figure(counts, f"self-rating of {_RATED[level]}", level)


def figure_predicted_ratings(predicted: pd.DataFrame, level: RatingLevel) -> Figure:
    """Counts of therapists' ratings against ratings predicted from sway (Figure 3.4a, b).

    Parameters
    ----------
    predicted : DataFrame
        From :func:`swaystride.studies.intensity.kinematics.predictions`.
    level : {"per_trial", "per_exercise"}
    """
    own = predicted[predicted["rating_level"] == level]
    rounded = rounded_rating(own["predicted"]).astype(int)
    counts = contingency(rounded, own["rating"].astype(int), _LEVELS)
    return _counts_figure(counts, f"rating of {_RATED[level]} predicted from sway", level)


def _counts_figure(counts: pd.DataFrame, row_label: str, level: RatingLevel) -> Figure:
    """Contingency table as cells: the count, and the share of its row as shade."""
    values = counts.to_numpy(dtype=float)
    totals = values.sum(axis=1, keepdims=True)
    shares = np.divide(values, totals, out=np.zeros_like(values), where=totals > 0)
    fig = new_figure("single", height_mm=78)
    axes = fig.subplots()
    image = axes.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, origin="lower")
    for row, column in np.ndindex(values.shape):
        axes.text(
            column,
            row,
            f"{values[row, column]:.0f}",
            ha="center",
            va="center",
            color="white" if shares[row, column] > 0.7 else OKABE_ITO["black"],
        )
    ticks = range(len(_LEVELS))
    axes.set_xticks(ticks, [str(k) for k in _LEVELS])
    axes.set_yticks(ticks, [str(k) for k in _LEVELS])
    axes.set_xlabel(f"therapists' rating of {_RATED[level]}")
    axes.set_ylabel(row_label)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    bar = fig.colorbar(image, ax=axes, fraction=0.046, pad=0.04)
    bar.set_label("share of the row")
    bar.outline.set_visible(False)
    return fig


def figure_difficulty(effects: pd.DataFrame, printed: pd.DataFrame) -> Figure:
    """Effects of difficulty with both intervals, beside the printed ones.

    Parameters
    ----------
    effects, printed : DataFrame
        Table 3.2 of this cohort and as printed.
    """
    fig = new_figure("double", height_mm=78)
    columns = fig.subplots(1, 2, sharex=True, sharey=True)
    styles = (
        ("this cohort, interval over patients", "participant_ci", OKABE_ITO["blue"], 3.0, 0.35),
        ("this cohort, interval of the model", "ci", OKABE_ITO["black"], 1.0, 1.0),
    )
    for axes, level in zip(columns, RATING_LEVELS, strict=True):
        ours = effects[effects["rating"] == level].set_index("aspect").loc[list(DIMENSIONS)]
        theirs = printed[printed["rating"] == level].set_index("aspect").loc[list(DIMENSIONS)]
        y = -np.arange(len(DIMENSIONS), dtype=float)
        for label, kind, colour, width, alpha in styles:
            axes.hlines(
                y + 0.14,
                ours[f"{kind}_low"],
                ours[f"{kind}_high"],
                color=colour,
                linewidth=width,
                alpha=alpha,
                label=label,
            )
        axes.plot(ours["estimate"], y + 0.14, "o", color=OKABE_ITO["black"], markersize=3.5)
        axes.hlines(
            y - 0.14,
            theirs["ci_low"],
            theirs["ci_high"],
            color=OKABE_ITO["vermillion"],
            label="printed",
        )
        axes.plot(theirs["estimate"], y - 0.14, "s", color=OKABE_ITO["vermillion"], markersize=3.5)
        axes.axvline(0.0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
        axes.set_yticks(y, list(DIMENSIONS.values()))
        axes.set_xlabel("rating per step of difficulty")
        axes.set_title(f"Ratings of {_RATED[level].split()[1]}s")
    columns[0].set_ylim(-len(DIMENSIONS) - 0.6, 0.5)
    columns[1].legend(loc="lower right", fontsize="small")
    return fig


def figure_residuals(residuals: pd.DataFrame) -> Figure:
    """Residuals of the models of difficulty: by fitted value, and against a normal distribution.

    Parameters
    ----------
    residuals : DataFrame
        From :func:`swaystride.studies.intensity.difficulty.residuals`; ratings of trials are shown.
    """
    fig = new_figure("double", height_mm=96)
    grid = fig.subplots(2, len(DIMENSIONS), sharey="row", squeeze=False)
    dots = {"markersize": 1.2, "alpha": 0.25, "color": OKABE_ITO["blue"], "rasterized": True}
    for (top, bottom), (name, label) in zip(grid.T, DIMENSIONS.items(), strict=True):
        own = residuals[(residuals["rating"] == "per_trial") & (residuals["dimension"] == name)]
        residual = own["residual"].to_numpy(dtype=float)
        top.plot(own["fitted"], residual, ".", **dots)
        top.axhline(0, color=OKABE_ITO["black"], linewidth=0.6)
        top.set_title(label)
        top.set_xlabel("fitted")
        ordered = np.sort(residual) / residual.std()
        quantile = ndtri((np.arange(ordered.size) + 0.5) / ordered.size)
        bottom.plot(quantile, ordered, ".", **dots)
        bottom.axline((0, 0), slope=1, color=OKABE_ITO["black"], linewidth=0.6)
        bottom.set_xlabel("normal quantile")
    grid[0, 0].set_ylabel("residual")
    grid[1, 0].set_ylabel("standardised residual")
    return fig
