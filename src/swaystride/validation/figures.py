"""Figures of the validation page: one per data set."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import OKABE_ITO, new_figure

_KIND_LABELS = {
    "icc": "ICC, closed formula",
    "F": "F",
    "limit": "confidence limit",
    "variance": "variance",
    "lme4 icc": "ICC, REML",
    "criterion": "REML criterion",
    "estimate": "fixed effect",
    "se": "standard error",
    "sd": "SD of an effect",
}


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


def figure_heart_rate(minutes: pd.DataFrame) -> Figure:
    """Heart rate minute by minute, from R-peaks and as the strap reported it.

    Parameters
    ----------
    minutes : DataFrame
        As from :func:`swaystride.validation.chest_strap_ecg.heart_rate_table`.
    """
    fig = new_figure("single", height_mm=60)
    axes = fig.subplots()
    for column, label, colour, marker in (
        ("heart_rate_bpm", "R-peaks", OKABE_ITO["blue"], "o"),
        ("strap_heart_rate_bpm", "strap", OKABE_ITO["vermillion"], "^"),
    ):
        axes.plot(minutes["minute"], minutes[column], f"{marker}-", color=colour, label=label)
    axes.set_xlabel("minute")
    axes.set_ylabel("heart rate, 1/min")
    axes.legend()
    return fig


def figure_reliability(comparison: pd.DataFrame) -> Figure:
    """ICC(2,1) of every table of ratings, ours and R's, and all differences over their tolerance.

    Parameters
    ----------
    comparison : DataFrame
        As from
        :func:`swaystride.validation.reliability_and_mixed_models.reliability_comparison`.
    """
    fig = new_figure("double", height_mm=75)
    left, right = fig.subplots(1, 2)
    _draw_agreement(left, comparison)
    _draw_differences(right, comparison)
    return fig


def _draw_agreement(axes: Axes, comparison: pd.DataFrame) -> None:
    """ICC(2,1) with its interval, two lines per set of ratings."""
    quantities = ["ICC(2,1)", "ICC(2,1): lower limit", "ICC(2,1): upper limit"]
    chosen = comparison[comparison["quantity"].isin(quantities)]
    names = chosen["set"].unique().tolist()
    for column, label, colour, shift in (
        ("value", "ours", OKABE_ITO["blue"], -0.12),
        ("reference", "irr", OKABE_ITO["vermillion"], 0.12),
    ):
        wide = chosen.pivot_table(index="set", columns="quantity", values=column)
        icc, low, high = (wide.loc[names, quantity].to_numpy() for quantity in quantities)
        at = np.arange(len(names)) + shift
        axes.errorbar(icc, at, xerr=[icc - low, high - icc], fmt="o", color=colour, label=label)
    axes.set_yticks(range(len(names)), [name.replace("_", " ") for name in names])
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.set_xlabel("ICC(2,1), 95 % interval")
    axes.legend(loc="center right")


def _draw_differences(axes: Axes, comparison: pd.DataFrame) -> None:
    """Difference from R over the tolerance, by kind of quantity, on a logarithmic scale."""
    kinds = comparison["kind"].unique().tolist()
    floor = 1e-6
    share = (comparison["difference"].abs() / comparison["tolerance"]).clip(lower=floor)
    row = comparison["kind"].map(kinds.index)
    axes.plot(share, row, "o", color=OKABE_ITO["blue"], alpha=0.4, markeredgewidth=0)
    axes.axvline(1.0, color=OKABE_ITO["vermillion"], linewidth=0.8)
    axes.set_xscale("log")
    axes.set_xlim(0.5 * floor, 10.0)
    axes.text(1.3, len(kinds) - 0.6, "tolerance", color=OKABE_ITO["vermillion"], rotation=90)
    axes.set_yticks(range(len(kinds)), [_KIND_LABELS[kind] for kind in kinds])
    axes.set_ylim(len(kinds) - 0.5, -0.5)
    axes.set_xlabel("difference from R over its tolerance")
