"""Figures 3 to 12: errors, data loss and differences over speed; a raw trial is drawn elsewhere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy.special import ndtri

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.imu_design.experiments import ExperimentName
from swaystride.studies.imu_design.requirements import loss_limit, with_added_error

#: How a condition is called in a legend: number and unit.
UNITS: Final[Mapping[ExperimentName, str]] = {
    "accelerometer_range": "g",
    "gyro_range": "°/s",
    "downsampling": "Hz",
    "decimation": "Hz",
}
_MARKERS: Final = "os^Dv<>"
_SPEED_LABEL: Final = "mean speed (m/s)"
_ERROR_LABEL: Final = "distance error (%)"


def condition_colours(conditions: list[str]) -> dict[str, str]:
    """One colour per condition: black for the baseline, then from dark to light.

    Parameters
    ----------
    conditions : list of str
        The baseline first.
    """
    ramp = colormaps["plasma"](np.linspace(0.08, 0.88, max(len(conditions) - 1, 1)))
    others = {name: to_hex(colour) for name, colour in zip(conditions[1:], ramp, strict=False)}
    return {conditions[0]: OKABE_ITO["black"], **others}


def level_label(experiment: ExperimentName, level: float) -> str:
    """Words for a level, such as ``±16 g`` or ``62.5 Hz``.

    Parameters
    ----------
    experiment : str
    level : float

    Examples
    --------
    >>> level_label("gyro_range", 500.0)
    '±500 °/s'
    """
    sign = "±" if experiment.endswith("range") else ""
    return f"{sign}{level:g} {UNITS[experiment]}"


def figure_error_over_speed(
    observations: pd.DataFrame, experiment: ExperimentName, limit_pct: float
) -> Figure:
    """Distance error over mean speed, by condition (Figures 3 and 7).

    Parameters
    ----------
    observations : DataFrame
        From :func:`swaystride.studies.imu_design.observations.observations`.
    experiment : str
    limit_pct : float
        The shaded band.
    """
    own = observations[observations["experiment"] == experiment]
    fig = new_figure("double", height_mm=88)
    axes = fig.subplots()
    _band(axes, limit_pct)
    _scatter(axes, own, "speed_m_s", "error_pct", experiment)
    axes.set_xlabel(_SPEED_LABEL)
    axes.set_ylabel(_ERROR_LABEL)
    _legend(axes, own, experiment)
    return fig


def figure_error_over_loss(
    observations: pd.DataFrame,
    experiment: ExperimentName,
    limit_pct: float,
    printed_loss_percent: float,
) -> Figure:
    """Distance error over data loss, by condition (Figures 5 and 9).

    Parameters
    ----------
    observations : DataFrame
    experiment : str
    limit_pct : float
        The shaded band.
    printed_loss_percent : float
        Data loss below which the paper finds all errors within the band; drawn beside the limit
        that the data show.
    """
    own = with_added_error(observations[observations["experiment"] == experiment])
    found, reached = loss_limit(own, "error", limit_pct)
    fig = new_figure("double", height_mm=88)
    axes = fig.subplots()
    _band(axes, limit_pct)
    # losses span decades, and many are zero: linear below a tenth of a percent
    axes.set_xscale("symlog", linthresh=0.1, linscale=0.5)
    _scatter(axes, own, "loss_percent", "error_pct", experiment)
    axes.axvline(
        printed_loss_percent,
        color=OKABE_ITO["vermillion"],
        linestyle="--",
        linewidth=0.9,
        label=f"printed limit, {printed_loss_percent:g} %",
    )
    if reached:
        axes.axvline(
            found,
            color=OKABE_ITO["blue"],
            linewidth=0.9,
            label=f"limit of these data, {found:.1f} %",
        )
    ticks = [t for t in (0.0, 0.1, 1.0, 10.0, 100.0) if t <= 3 * own["loss_percent"].max() or t < 1]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xlim(left=-0.01)
    axes.set_xlabel("data lost to saturation (%)")
    axes.set_ylabel(_ERROR_LABEL)
    _legend(axes, own, experiment, with_lines=True)
    return fig


def figure_stride_differences(observations: pd.DataFrame, experiment: ExperimentName) -> Figure:
    """Spread of the differences from the baseline over mean speed (Figures 6, 10, 11, 12).

    Parameters
    ----------
    observations : DataFrame
    experiment : str
        The baseline, which differs from itself by nothing, is not drawn.
    """
    own = observations[observations["experiment"] == experiment]
    own = own[~own["condition"].str.startswith("baseline_")]
    fig = new_figure("double", height_mm=78)
    panels = fig.subplots(1, 2)
    for axes, column, title, label in zip(
        panels,
        ("length_difference_sd_m", "angle_difference_sd_deg"),
        ("a  Stride length", "b  Stride angle"),
        ("SD of the difference (m)", "SD of the difference (°)"),
        strict=True,
    ):
        _scatter(axes, own, "speed_m_s", column, experiment, baseline=False)
        axes.set_title(title)
        axes.set_xlabel(_SPEED_LABEL)
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0.0)
    _legend(panels[0], own, experiment, baseline=False, inside=True)
    return fig


def figure_residuals(residuals: pd.DataFrame, titles: Mapping[str, str]) -> Figure:
    """Residuals of the four models: by fitted value, and against a normal distribution.

    Parameters
    ----------
    residuals : DataFrame
        ``experiment``, ``fitted``, ``residual``.
    titles : mapping of str to str
        Experiment to heading, in the order of the panels.
    """
    fig = new_figure("double", height_mm=96)
    grid = fig.subplots(2, len(titles), squeeze=False)
    dots = {"markersize": 1.8, "alpha": 0.4, "color": OKABE_ITO["blue"], "rasterized": True}
    for (top, bottom), (name, title) in zip(grid.T, titles.items(), strict=True):
        own = residuals[residuals["experiment"] == name]
        residual = own["residual"].to_numpy(dtype=float)
        top.plot(own["fitted"], residual, ".", **dots)
        top.axhline(0, color=OKABE_ITO["black"], linewidth=0.6)
        top.set_title(title)
        top.set_xlabel("fitted (%)")
        ordered = np.sort(residual) / residual.std()
        quantile = ndtri((np.arange(ordered.size) + 0.5) / ordered.size)
        bottom.plot(quantile, ordered, ".", **dots)
        bottom.axline((0, 0), slope=1, color=OKABE_ITO["black"], linewidth=0.6)
        bottom.set_xlabel("normal quantile")
    grid[0, 0].set_ylabel("residual (%)")
    grid[1, 0].set_ylabel("standardised residual")
    return fig


def _band(axes: Axes, limit_pct: float) -> None:
    """The errors that are acceptable."""
    axes.axhspan(-limit_pct, limit_pct, color="#E8E8E8", linewidth=0, zorder=0)
    axes.axhline(0.0, color=OKABE_ITO["black"], linewidth=0.5, zorder=1)


def _scatter(
    axes: Axes,
    own: pd.DataFrame,
    x: str,
    y: str,
    experiment: ExperimentName,
    *,
    baseline: bool = True,
) -> None:
    """One series per condition; the baseline on top."""
    for rank, (_, rows, colour, marker) in enumerate(_series(own, baseline=baseline)):
        axes.plot(
            rows[x],
            rows[y],
            marker,
            color=colour,
            markersize=3.2,
            markerfacecolor=colour if rank % 2 == 0 else "white",
            markeredgewidth=0.8,
            linestyle="none",
            zorder=10 - rank,
        )


def _series(own: pd.DataFrame, *, baseline: bool) -> list[tuple[float, pd.DataFrame, str, str]]:
    """Level, rows, colour and marker of each condition."""
    names = list(dict.fromkeys(own["condition"]))
    colours = condition_colours(names if baseline else ["", *names])
    shift = 0 if baseline else 1
    return [
        (
            float(own.loc[own["condition"] == name, "level"].iloc[0]),
            own[own["condition"] == name],
            colours[name],
            _MARKERS[(rank + shift) % len(_MARKERS)],
        )
        for rank, name in enumerate(names)
    ]


def _legend(
    axes: Axes,
    own: pd.DataFrame,
    experiment: ExperimentName,
    *,
    baseline: bool = True,
    with_lines: bool = False,
    inside: bool = False,
) -> None:
    """Conditions in their order, beside the axes or inside them."""
    handles = [
        Line2D(
            [],
            [],
            linestyle="none",
            marker=marker,
            color=colour,
            markersize=3.2,
            markerfacecolor=colour if rank % 2 == 0 else "white",
            label=level_label(experiment, level),
        )
        for rank, (level, _, colour, marker) in enumerate(_series(own, baseline=baseline))
    ]
    if with_lines:
        handles += [line for line in axes.lines if not str(line.get_label()).startswith("_")]
    if inside:
        axes.legend(handles=handles, loc="upper left")
    else:
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.01, 0.5))
