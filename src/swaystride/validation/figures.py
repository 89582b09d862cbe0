"""Figures of the validation page: one per data set."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import OKABE_ITO, new_figure


def figure_force_plate(trials: pd.DataFrame) -> Figure:
    """Area and velocity of every force-plate trial against the authors' numbers.

    Parameters
    ----------
    trials : DataFrame
        As from :func:`swaystride.validation.standing_force_plate.force_plate_trials`.
    """
    fig = new_figure("double", height_mm=70)
    panels = fig.subplots(1, 2)
    for axes, (name, label) in zip(
        panels,
        (("area_cm2", "ellipse area, cm²"), ("velocity_cm_s", "mean velocity, cm/s")),
        strict=True,
    ):
        published, ours = trials[f"{name}_published"], trials[name]
        axes.plot(published, ours, ".", color=OKABE_ITO["blue"])
        axes.axline((0, 0), slope=1, color=OKABE_ITO["black"], linewidth=0.6)
        axes.set_xlabel(f"published {label}")
        axes.set_ylabel(f"ours, {label.split(', ')[1]}")
        error = (ours / published - 1).abs().max()
        axes.set_title(f"largest relative difference {error:.1e}")
    return fig


def figure_lumbar(trials: pd.DataFrame) -> Figure:
    """What lost packets do to sway measures, with and without rebuilding the gaps.

    Parameters
    ----------
    trials : DataFrame
        As from :func:`swaystride.validation.lumbar_imu_standing.lumbar_trials`.
    """
    fig = new_figure("double", height_mm=75)
    panels = fig.subplots(1, 3)
    names = (("ap_rms", "AP RMS"), ("ml_rms", "ML RMS"), ("path_length", "path length"))
    for axes, (name, label) in zip(panels, names, strict=True):
        compared = trials.dropna(subset=[f"{name}_rebuilt"])
        share = compared["pattern_lost"] / compared["window_samples"]
        for how, colour, marker in (
            ("glued", OKABE_ITO["vermillion"], "^"),
            ("rebuilt", OKABE_ITO["blue"], "o"),
        ):
            change = 100 * (compared[f"{name}_{how}"] / compared[name] - 1)
            axes.plot(
                100 * share, change, marker, color=colour, markersize=2.5, label=f"gaps {how}"
            )
        axes.axhline(0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
        axes.set_title(label)
        axes.set_xlabel("packets lost, %")
    panels[0].set_ylabel("error against the complete window, %")
    panels[-1].legend(loc="lower right")
    return fig
