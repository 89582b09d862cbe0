"""Bars over all trials: ranges of motion (4.12), and errors of both sources against the truth."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.kinematics.figure_words import (
    SHADE,
    SHORT_LABELS,
    SOURCE_COLOURS,
    SOURCE_LABELS,
)
from swaystride.studies.kinematics.plan import RANGE_ANGLES, SIDES, SOURCES

_BAR_WIDTH: Final = 0.36
_FILLS: Final = {"optic": "#9A9A9A", "erkf": OKABE_ITO["sky_blue"]}


def figure_4_12(table: pd.DataFrame) -> Figure:
    """Ranges of motion of both sources, beside the published comparison.

    Parameters
    ----------
    table : DataFrame
        Table 4.4 of this cohort. Asterisk: significant; hatched: markers measure this angle
        badly.
    """
    fig = new_figure("double", height_mm=120)
    panels = fig.subplots(len(SIDES), 1, sharex=True, sharey=True)
    at = np.arange(len(RANGE_ANGLES), dtype=float)
    for axes, side in zip(panels, SIDES, strict=True):
        own = table[table["side"] == side].set_index("angle").loc[list(RANGE_ANGLES)]
        reference, spread = own["reference_deg_mean"], own["reference_deg_sd"]
        for x, mean, sd in zip(at, reference, spread, strict=True):
            edges = [x - 0.46, x + 0.46]
            axes.fill_between(edges, mean - sd, mean + sd, color=SHADE, linewidth=0, zorder=0)
            axes.plot(edges, [mean, mean], color=OKABE_ITO["vermillion"], linewidth=1.2, zorder=3)
        tops = (reference + spread).to_numpy(dtype=float)
        for source, shift in zip(SOURCES, (-_BAR_WIDTH / 2, _BAR_WIDTH / 2), strict=True):
            mean = own[f"{source}_deg_mean"].to_numpy(dtype=float)
            sd = own[f"{source}_deg_sd"].fillna(0.0).to_numpy(dtype=float)
            bars = axes.bar(
                at + shift,
                mean,
                _BAR_WIDTH,
                yerr=sd,
                color=_FILLS[source],
                edgecolor=OKABE_ITO["black"],
                linewidth=0.5,
                error_kw={"elinewidth": 0.8, "capsize": 1.5},
                zorder=2,
            )
            for bar, poor in zip(bars, own["optic_poor"], strict=True):
                if poor and source == "optic":
                    bar.set_hatch("////")
                    bar.set_hatch_linewidth(0.5)
            tops = np.fmax(tops, mean + sd)
        for x, top, significant in zip(at, tops, own["significant"], strict=True):
            if significant == 1:
                axes.annotate(
                    "*", (x, top), xytext=(0, 1), textcoords="offset points", ha="center",
                    va="bottom", fontsize=10,
                )  # fmt: skip
        axes.set_title(f"{side.capitalize()} side")
        axes.set_ylabel("range of motion (°)")
        axes.set_xlim(-0.6, at.size - 0.4)
        axes.margins(y=0.1)
    # after both panels: setting a limit ends the search for the other one
    panels[0].set_ylim(bottom=0.0)
    panels[-1].set_xticks(at, [SHORT_LABELS[name] for name in RANGE_ANGLES])
    fig.legend(handles=_range_handles(), loc="outside lower center", ncols=4)
    return fig


def _range_handles() -> list[Line2D]:
    """Entries of the legend of Figure 4.12."""
    squares = [
        Line2D(
            [],
            [],
            linestyle="none",
            marker="s",
            markersize=5,
            markerfacecolor=_FILLS[source],
            markeredgecolor="black",
            markeredgewidth=0.5,
            label=f"{SOURCE_LABELS[source]} (hatched: poor)"
            if source == "optic"
            else SOURCE_LABELS[source],
        )
        for source in SOURCES
    ]
    line = Line2D(
        [], [], color=OKABE_ITO["vermillion"], linewidth=1.2, label="published mean (± SD: grey)"
    )
    star = Line2D([], [], linestyle="none", marker="$*$", color="black", label="significant")
    return [*squares, line, star]


def figure_truth(table: pd.DataFrame) -> Figure:
    """Errors of markers and filter against the truth, as they are and after one constant per trial.

    Parameters
    ----------
    table : DataFrame
        From :func:`swaystride.studies.kinematics.truth_tables.truth_angles`.
    """
    fig = new_figure("double", height_mm=110)
    panels = fig.subplots(len(SIDES), 1, sharex=True, sharey=True)
    at = np.arange(len(RANGE_ANGLES), dtype=float)
    for axes, side in zip(panels, SIDES, strict=True):
        own = table[table["side"] == side].set_index("angle").loc[list(RANGE_ANGLES)]
        for source, shift in zip(SOURCES, (-0.12, 0.12), strict=True):
            colour = SOURCE_COLOURS[source]
            axes.errorbar(
                at + shift,
                own[f"{source}_rmsd_trial_deg_mean"],
                yerr=own[f"{source}_rmsd_trial_deg_sd"].fillna(0.0),
                fmt="o",
                color=colour,
                elinewidth=0.9,
                capsize=1.5,
                label=f"{SOURCE_LABELS[source]}, after one constant",
            )
            axes.plot(
                at + shift,
                own[f"{source}_rmsd_deg_mean"],
                "x",
                color=colour,
                label=f"{SOURCE_LABELS[source]}, as it is",
            )
        axes.set_title(f"{side.capitalize()} side")
        axes.set_ylabel("RMS error (°)")
        axes.set_xlim(-0.6, at.size - 0.4)
        axes.grid(axis="y")
    # after both panels: setting a limit ends the search for the other one
    panels[0].set_ylim(bottom=0.0)
    panels[-1].set_xticks(at, [SHORT_LABELS[name] for name in RANGE_ANGLES])
    handles, labels = panels[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=4)
    return fig
