"""Figures of the foot recordings: errors of all methods, and every trial's path and strides."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.validation.foot_errors import pooled_errors
from swaystride.validation.foot_recording import FloatArray
from swaystride.validation.foot_strides import METHODS, FootTrial
from swaystride.validation.plane_alignment import align_in_plane

_COLOURS: Final = {
    "length_m": OKABE_ITO["blue"],
    "printed_m": OKABE_ITO["sky_blue"],
    "stored_m": OKABE_ITO["vermillion"],
    "gaitmap_m": OKABE_ITO["bluish_green"],
    "vqf_m": OKABE_ITO["reddish_purple"],
}
_MARKS: Final = {"length_m": "o", "stored_m": "^", "gaitmap_m": "s"}
_GAITS: Final = {"run": "running", "walk": "walking", "other": "short strides"}
#: Errors beyond this are drawn at the edge and counted there.
_EDGE_M: Final = 0.15
#: A path so much longer than wide is stretched across.
_LONG_PATH: Final = 4.0


def figure_errors(strides: pd.DataFrame) -> Figure:
    """Error of every stride by gait and method, with mean and standard deviation.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`swaystride.validation.foot_strides.all_strides`.
    """
    gaits = [gait for gait in _GAITS if (strides["gait"] == gait).any()]
    fig = new_figure("double" if len(gaits) > 1 else "single", height_mm=75)
    panels = fig.subplots(1, len(gaits), sharey=True, squeeze=False)[0]
    for axes, gait in zip(panels, gaits, strict=True):
        _draw_errors(axes, strides[strides["gait"] == gait])
        axes.set_title(f"{_GAITS[gait]}, {(strides['gait'] == gait).sum()} strides")
    panels[0].set_ylabel("error of stride length, m")
    return fig


def figure_trial(trial: FootTrial) -> Figure:
    """Path in the plane and the error of every stride of one trial.

    Parameters
    ----------
    trial : FootTrial
    """
    fig = new_figure("double", height_mm=70)
    left, right = fig.subplots(1, 2)
    draw_path(left, trial)
    left.set(xlabel="m", ylabel="m")
    left.set_title(f"{trial.recording.trial}, {_GAITS[trial.recording.gait]}")
    draw_stride_errors(right, trial)
    right.set(xlabel="stride", ylabel="error of stride length, m")
    handles = [*_legend(left), *_legend(right)]
    fig.legend(*zip(*handles, strict=True), loc="outside lower center", ncols=len(handles))
    return fig


def figure_sheet(trials: Sequence[FootTrial]) -> Figure:
    """Paths and stride errors of several trials, two trials in a row.

    Parameters
    ----------
    trials : sequence of FootTrial
    """
    n_rows = -(-len(trials) // 2)
    fig = new_figure("double", height_mm=42 * n_rows + 8)
    panels = fig.subplots(n_rows, 4, squeeze=False).reshape(-1, 2)
    for (left, right), trial in zip(panels, trials, strict=False):
        draw_path(left, trial)
        draw_stride_errors(right, trial)
        for axes in (left, right):
            axes.tick_params(labelsize=5.5)
            axes.set_title(axes.get_title(loc="left"), fontsize=6.5)
    for left, right in panels[len(trials) :]:
        left.set_axis_off()
        right.set_axis_off()
    handles = [*_legend(panels[0][0]), *_legend(panels[0][1])]
    fig.legend(*zip(*handles, strict=True), loc="outside lower center", ncols=len(handles))
    return fig


def draw_path(axes: Axes, trial: FootTrial) -> None:
    """Optical path, ours and the stored one, each turned and shifted onto the optical.

    Parameters
    ----------
    axes : Axes
    trial : FootTrial
    """
    recording = trial.recording
    reference = recording.path_m
    axes.plot(*reference, color=OKABE_ITO["black"], linewidth=1.6, label="optical path")
    time_s = np.arange(recording.acc_m_s2.shape[1]) / recording.rate_hz
    for path, colour, name in (
        (trial.path_m, _COLOURS["length_m"], "our path"),
        (recording.stored_path_m, _COLOURS["stored_m"], "path in the files"),
    ):
        if path is None:
            continue
        at_frames = _interpolated(path, time_s, recording.path_s)
        aligned = align_in_plane(at_frames, reference).apply(at_frames)
        axes.plot(*aligned, color=colour, linewidth=0.7, label=name)
    given = _interpolated(reference, recording.path_s, recording.instants_s)
    axes.plot(*given, ".", color=OKABE_ITO["black"], markersize=3)
    length, width = np.sort(np.ptp(reference, axis=1))[::-1]
    if length < _LONG_PATH * width:
        axes.set_aspect("equal", adjustable="datalim")
    axes.set_title(recording.trial)


def draw_stride_errors(axes: Axes, trial: FootTrial) -> None:
    """Error of each given stride, ours, stored and gaitmap's; what lies beyond is at the edge.

    Parameters
    ----------
    axes : Axes
    trial : FootTrial
    """
    strides = trial.strides
    axes.axhline(0.0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
    for column, mark in _MARKS.items():
        error = strides[column] - strides["reference_m"]
        if error.isna().all():
            continue
        axes.plot(
            strides["stride"],
            error.clip(-_EDGE_M, _EDGE_M),
            mark,
            color=_COLOURS[column],
            markersize=2.5 if column == "length_m" else 2.0,
            markeredgewidth=0.0,
            label=METHODS[column],
            zorder=3 if column == "length_m" else 2,
        )
    rmse = 1000.0 * pooled_errors(strides, "length_m")["rmse_m"]
    axes.set_ylim(-1.05 * _EDGE_M, 1.05 * _EDGE_M)
    axes.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    axes.set_title(f"RMSE {rmse:.0f} mm")


def _draw_errors(axes: Axes, strides: pd.DataFrame) -> None:
    """Strips of one gait: every stride, mean ± SD, and how many lie beyond the edge."""
    columns = [name for name in METHODS if strides[name].notna().any()]
    axes.axhline(0.0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
    for at, column in enumerate(columns):
        error = (strides[column] - strides["reference_m"]).dropna().to_numpy()
        beside = at + 0.5 * (_spread(len(error)) - 0.5)
        colour = _COLOURS[column]
        axes.plot(
            beside,
            np.clip(error, -_EDGE_M, _EDGE_M),
            ".",
            color=colour,
            alpha=0.45,
            markersize=2.5,
            markeredgewidth=0.0,
        )
        axes.errorbar(
            at + 0.36, error.mean(), yerr=error.std(), fmt="_", color=colour, markersize=6
        )
        n_beyond = int(np.sum(np.abs(error) > _EDGE_M))
        if n_beyond:
            axes.text(at, 1.04 * _EDGE_M, str(n_beyond), ha="center", va="bottom", size=6)
    axes.set_xticks(
        range(len(columns)), [METHODS[name].replace(", ", ",\n") for name in columns],
        rotation=40, ha="right", rotation_mode="anchor",
    )  # fmt: skip
    axes.set_ylim(-1.1 * _EDGE_M, 1.2 * _EDGE_M)


def _spread(n: int) -> FloatArray:
    """Even, repeatable sideways places of n points (multiples of the golden ratio)."""
    return np.asarray((0.5 + 0.618033988749895 * np.arange(n)) % 1.0)


def _interpolated(path_m: FloatArray, from_s: FloatArray, to_s: FloatArray) -> FloatArray:
    """Path at other times."""
    return np.stack([np.interp(to_s, from_s, axis) for axis in path_m])


def _legend(axes: Axes) -> list[tuple[object, str]]:
    """Handles and labels."""
    return list(zip(*axes.get_legend_handles_labels(), strict=True))
