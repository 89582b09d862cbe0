"""Figures over time of one trial: midstance (4.5), drift (4.9) and convergence (4.10)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.figure import Figure
from numpy.typing import NDArray

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.kinematics.figure_words import (
    ANGLE_LABELS,
    PLANE_COLOURS,
    SHADE,
    SOURCE_COLOURS,
    SOURCE_LABELS,
)
from swaystride.studies.kinematics.plan import SIDES, SOURCES
from swaystride.units import DEG_PER_RAD, GRAVITY_M_S2

Array = NDArray[np.float64]

#: Strides in Figure 4.5, and in Figure 4.10 (two more than the filter is said to need).
STRIDES_AT_MIDSTANCE: Final = 3
STRIDES_AT_START: Final = 12
_ANKLE: Final = ("ankle_dorsiflexion", "ankle_inversion", "ankle_rotation")
_KNEE: Final = ("knee_flexion", "knee_adduction", "knee_rotation")
#: Strides over which Figure 4.9 shows mean, smallest and largest difference: whole ones, so that the
#: mean does not beat with the gait.
_ENVELOPE_STRIDES: Final = 2


def figure_4_5(estimates: xr.Dataset, contacts: pd.DataFrame) -> Figure:
    """Acceleration and angular rate of both feet, with initial contacts and midstance.

    Parameters
    ----------
    estimates : Dataset
        ``foot_acc_m_s2``, ``foot_gyr_rad_s`` and ``zero_velocity`` (side, time).
    contacts : DataFrame
        Counted strides of the trial; those in the middle are drawn.
    """
    fig = new_figure("double", height_mm=95)
    grid = fig.subplots(2, len(SIDES), sharex="col", sharey="row")
    time_s = estimates["time"].to_numpy().astype(float)
    for column, side in zip(grid.T, SIDES, strict=True):
        own = contacts[contacts["side"] == side].sort_values("stride")
        first = max(len(own) // 2 - STRIDES_AT_MIDSTANCE // 2, 0)
        shown = own.iloc[first : first + STRIDES_AT_MIDSTANCE]
        starts = [*shown["initial_contact_s"], shown["next_contact_s"].iloc[-1]]
        margin = 0.1 * (starts[1] - starts[0])
        view = (time_s >= starts[0] - margin) & (time_s <= starts[-1] + margin)
        chosen = estimates.sel(side=side).isel(time=view)
        seen_s = time_s[view] - starts[0]
        acc_g = chosen["foot_acc_m_s2"].to_numpy() / GRAVITY_M_S2
        gyr_deg_s = chosen["foot_gyr_rad_s"].to_numpy() * DEG_PER_RAD
        resting = chosen["zero_velocity"].to_numpy().astype(bool)
        half_s = 0.5 * float(np.median(np.diff(seen_s)))
        for axes, signal in zip(column, (acc_g, gyr_deg_s), strict=True):
            for begin, end in _runs(resting):
                axes.axvspan(
                    seen_s[begin] - half_s, seen_s[end - 1] + half_s, color=OKABE_ITO["sky_blue"],
                    alpha=0.45, linewidth=0.8,
                )  # fmt: skip
            for contact in starts:
                axes.axvline(
                    contact - starts[0],
                    color=OKABE_ITO["vermillion"],
                    linestyle="--",
                    linewidth=0.8,
                )
            axes.plot(seen_s, signal, color=OKABE_ITO["black"], linewidth=0.9)
            axes.set_xlim(float(seen_s[0]), float(seen_s[-1]))
        column[0].set_title(f"{side.capitalize()} foot")
        column[1].set_xlabel("time (s)")
    for axes in grid[:, 0]:  # after all panels: setting a limit ends the search for the other one
        axes.set_ylim(bottom=0.0)
    grid[0, 0].set_ylabel("|acceleration| (g)")
    grid[1, 0].set_ylabel("|angular rate| (°/s)")
    handles = [
        grid[0, 0].axvspan(np.nan, np.nan, color=OKABE_ITO["sky_blue"], alpha=0.45, linewidth=0),
        grid[0, 0].plot([], [], color=OKABE_ITO["vermillion"], linestyle="--", linewidth=0.8)[0],
    ]
    _legend_below(fig, handles, ["midstance (zero velocity)", "initial contact"])
    return fig


def figure_4_9(estimates: xr.Dataset, contacts: pd.DataFrame, side: str = "left") -> Figure:
    """Difference from OPTIC of integrated gyroscopes and of the filter, ankle, whole trial.

    Parameters
    ----------
    estimates : Dataset
        ``angle_deg`` (source, side, angle, time) and ``integrated_deg`` (side, angle, time).
    contacts : DataFrame
        Counted strides of the trial, for the duration of a stride.
    side : str
        The source shows the left one.
    """
    fig = new_figure("double", height_mm=105)
    panels = fig.subplots(2, 1, sharex=True)
    time_s = estimates["time"].to_numpy().astype(float)
    own = estimates.sel(side=side)
    strides = contacts[contacts["side"] == side]
    stride_s = float((strides["next_contact_s"] - strides["initial_contact_s"]).median())
    optic = own["angle_deg"].sel(source="optic")
    rows = (
        ("a  Integrated gyroscopes − OPTIC", own["integrated_deg"] - optic),
        ("b  ErKF − OPTIC", own["angle_deg"].sel(source="erkf") - optic),
    )
    for axes, (title, difference) in zip(panels, rows, strict=True):
        for angle, colour in zip(_ANKLE, PLANE_COLOURS, strict=True):
            error = difference.sel(angle=angle).to_numpy().astype(float)
            middle_s, low, mean, high = envelope(error, time_s, _ENVELOPE_STRIDES * stride_s)
            axes.fill_between(middle_s, low, high, color=colour, alpha=0.25, linewidth=0)
            axes.plot(middle_s, mean, color=colour, linewidth=0.9, label=ANGLE_LABELS[angle])
        axes.axhline(0.0, color=OKABE_ITO["black"], linewidth=0.5)
        axes.set_title(f"{title}, {side} ankle")
        axes.set_ylabel("difference (°)")
    panels[1].set_xlabel("time (s)")
    panels[1].set_xlim(float(time_s[0]), float(time_s[-1]))
    handles, labels = panels[0].get_legend_handles_labels()
    _legend_below(fig, handles, labels)
    return fig


def figure_4_10(estimates: xr.Dataset, contacts: pd.DataFrame) -> Figure:
    """Knee angles of both sources at the start of a trial.

    Parameters
    ----------
    estimates : Dataset
        ``angle_deg`` (source, side, angle, time).
    contacts : DataFrame
        Counted strides of the trial; the first one marks where the analysis begins.
    """
    fig = new_figure("double", height_mm=120)
    grid = fig.subplots(len(_KNEE), len(SIDES), sharex="col", sharey="row")
    time_s = estimates["time"].to_numpy().astype(float)
    for column, side in zip(grid.T, SIDES, strict=True):
        own = contacts[contacts["side"] == side].sort_values("stride")
        begin_s = float(own["initial_contact_s"].iloc[0])
        duration_s = float((own["next_contact_s"] - own["initial_contact_s"]).median())
        number = int(own["stride"].iloc[0])
        from_s = max(time_s[0], begin_s - (number - 0.5) * duration_s)
        to_s = min(time_s[-1], from_s + (STRIDES_AT_START + 0.5) * duration_s)
        view = (time_s >= from_s) & (time_s <= to_s)
        for axes, angle in zip(column, _KNEE, strict=True):
            chosen = estimates["angle_deg"].sel(side=side, angle=angle).isel(time=view)
            for source in SOURCES:
                axes.plot(
                    time_s[view],
                    chosen.sel(source=source).to_numpy(),
                    color=SOURCE_COLOURS[source],
                    linewidth=0.9,
                    label=SOURCE_LABELS[source],
                )
            axes.axvspan(from_s, min(begin_s, to_s), color=SHADE, alpha=0.5, linewidth=0, zorder=0)
            axes.set_xlim(from_s, to_s)
        column[0].set_title(f"{side.capitalize()} knee")
        column[-1].set_xlabel("time (s)")
    for axes, angle in zip(grid[:, 0], _KNEE, strict=True):
        axes.set_ylabel(f"{ANGLE_LABELS[angle].removeprefix('Knee ')} (°)")
    handles, labels = grid[0, 0].get_legend_handles_labels()
    shade = grid[0, 0].axvspan(np.nan, np.nan, color=SHADE, alpha=0.5, linewidth=0)
    _legend_below(fig, [*handles, shade], [*labels, "strides left out"])
    return fig


def envelope(error_deg: Array, time_s: Array, window_s: float) -> tuple[Array, Array, Array, Array]:
    """Middle, smallest, mean and largest value of consecutive windows.

    Parameters
    ----------
    error_deg : ndarray, shape (n,)
        A window without any value is left out.
    time_s : ndarray, shape (n,)
    window_s : float

    Returns
    -------
    tuple of ndarray
        Time of the middle of each window, smallest, mean and largest value.

    Examples
    --------
    >>> error = np.array([1.0, 3.0, np.nan, 5.0])
    >>> [part.tolist() for part in envelope(error, np.arange(4.0), 2.0)]
    [[1.0, 3.0], [1.0, 5.0], [2.0, 5.0], [3.0, 5.0]]
    """
    number = np.floor((time_s - time_s[0]) / window_s).astype(int)
    grouped = pd.Series(error_deg).groupby(number).agg(["min", "mean", "max"]).dropna()
    middle = time_s[0] + (grouped.index.to_numpy() + 0.5) * window_s
    low, mean, high = (grouped[name].to_numpy(dtype=float) for name in ("min", "mean", "max"))
    return middle, low, mean, high


def _runs(flags: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First sample and the one after the last of each run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _legend_below(fig: Figure, handles: Sequence[Artist], labels: Sequence[str]) -> None:
    """One legend for all panels, below them."""
    fig.legend(handles, labels, loc="outside lower center", ncols=len(labels))
