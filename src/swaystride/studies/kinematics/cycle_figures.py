"""Figures over the gait cycle: features (4.7), shifted joint centres (4.8), mean curves (4.11)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.kinematics.figure_words import (
    ANGLE_LABELS,
    CYCLE_LABEL,
    DIRECTION_COLOURS,
    DIRECTION_LABELS,
    SHORT_LABELS,
    SOURCE_COLOURS,
    SOURCE_LABELS,
)
from swaystride.studies.kinematics.perturbation import UNSHIFTED
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SAGITTAL_ANGLES, SIDES, SOURCES

Array = NDArray[np.float64]

_JOINTS: Final = ("hip", "knee", "ankle")
_PHASE_TICKS: Final = (0, 25, 50, 75, 100)


def figure_4_7(curves: pd.DataFrame) -> Figure:
    """Features of gait on the mean curves of a trial.

    Parameters
    ----------
    curves : DataFrame
        Of one trial: ``source``, ``side``, ``angle``, ``phase_pct``, ``mean_deg``.
    """
    fig = new_figure("double", height_mm=100)
    grid = fig.subplots(len(SIDES), len(SAGITTAL_ANGLES), sharex=True, sharey="col")
    for row, side in zip(grid, SIDES, strict=True):
        for axes, angle in zip(row, SAGITTAL_ANGLES, strict=True):
            phase = _curve(curves, "erkf", side, angle)[0]
            means = {source: _curve(curves, source, side, angle)[1] for source in SOURCES}
            for source, mean in means.items():
                axes.plot(phase, mean, color=SOURCE_COLOURS[source], label=SOURCE_LABELS[source])
            _mark_features(axes, phase, means, angle)
            axes.set_ylabel(f"{side.capitalize()} {ANGLE_LABELS[angle].lower()} (°)")
            axes.margins(y=0.22)
            axes.set_xlim(0, 100)
            axes.set_xticks(_PHASE_TICKS)
    for axes in grid[-1]:
        axes.set_xlabel(CYCLE_LABEL)
    handles, labels = grid[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return fig


def _mark_features(axes: Axes, phase: Array, means: Mapping[str, Array], angle: str) -> None:
    """Dots and words for the features that an angle has (Table 4.6), on the curve of the filter."""
    mean = means["erkf"]
    if not np.isfinite(mean).any():
        return
    high, low = np.fmax(*means.values()), np.fmin(*means.values())
    marks = {
        "hip_flexion": [
            (int(np.nanargmax(mean)), "peak flexion", 1),
            (int(np.nanargmin(mean)), "peak extension", -1),
        ],
        "knee_flexion": [(stance_peak(mean), "peak flexion\nin stance", 1)],
        "ankle_dorsiflexion": [
            (int(np.nanargmax(mean)), "peak dorsiflexion", 1),
            (int(np.nanargmin(mean)), "peak plantarflexion", -1),
            (0, "at IC", -1 if mean[5] > mean[0] else 1),  # where the curve does not go
        ],
    }[angle]
    for at, words, above in marks:
        axes.plot(
            phase[at], mean[at], "o", color=OKABE_ITO["vermillion"], markersize=3.5, clip_on=False
        )
        side = "left" if phase[at] < 22 else "right" if phase[at] > 78 else "center"
        axes.annotate(
            words,
            (
                max(phase[at] - 10.0, 1.0) if side == "left" else phase[at],
                (high if above > 0 else low)[at],
            ),
            xytext=(0, 5 * above),
            textcoords="offset points",
            ha=side,
            va="bottom" if above > 0 else "top",
            fontsize=6.5,
        )


def stance_peak(mean_deg: Array) -> int:
    """First peak of a mean knee curve: that of stance comes before the larger one of swing.

    Parameters
    ----------
    mean_deg : ndarray, shape (101,)

    Returns
    -------
    int
        Its sample; the largest of the first two fifths if the curve has no peak there.
    """
    early = 2 * mean_deg.size // 5
    slope = np.diff(mean_deg[:early])
    peaks = 1 + np.flatnonzero((slope[:-1] > 0.0) & (slope[1:] <= 0.0))
    return int(peaks[0]) if peaks.size else int(np.nanargmax(mean_deg[:early]))


def figure_4_8(shifted: pd.DataFrame, joints: Sequence[str] = ("knee", "ankle")) -> Figure:
    """Marker angles when joint centres are shifted.

    Parameters
    ----------
    shifted : DataFrame
        Of one trial, from :func:`swaystride.studies.kinematics.perturbation.trial_perturbation`:
        ``shifted`` (joint, or none), ``direction``, ``sign``, ``side``, ``angle``, ``phase_pct``,
        ``mean_deg``.
    joints : sequence of str
        Which joints are shifted, a pair of columns each.
    """
    fig = new_figure("double", height_mm=205)
    columns = [(joint, side) for joint in joints for side in SIDES]
    grid = fig.subplots(len(ANGLE_NAMES), len(columns), sharex=True, sharey="row", squeeze=False)
    colours = {**DIRECTION_COLOURS, UNSHIFTED: OKABE_ITO["black"]}
    for at, (joint, side) in enumerate(columns):
        own = shifted[shifted["shifted"].isin([joint, UNSHIFTED]) & (shifted["side"] == side)]
        # the curve without a shift last, on top
        ordered = own.sort_values(["direction", "sign", "phase_pct"])
        for axes, angle in zip(grid[:, at], ANGLE_NAMES, strict=True):
            lines = ordered[ordered["angle"] == angle].groupby(["direction", "sign"], sort=True)
            for (direction, _), line in lines:
                axes.plot(
                    line["phase_pct"],
                    line["mean_deg"],
                    color=colours[str(direction)],
                    linewidth=0.8,
                )
            axes.set_xlim(0, 100)
            axes.set_xticks(_PHASE_TICKS)
        grid[0, at].set_title(f"{joint.capitalize()} centre,\n{side} side")
        grid[-1, at].set_xlabel(CYCLE_LABEL)
    for axes, angle in zip(grid[:, 0], ANGLE_NAMES, strict=True):
        axes.set_ylabel(f"{SHORT_LABELS[angle]} (°)")
    fig.align_ylabels(grid[:, 0])
    handles = [
        Line2D([], [], color=DIRECTION_COLOURS[name], label=words)
        for name, words in DIRECTION_LABELS.items()
    ]
    handles.append(Line2D([], [], color=OKABE_ITO["black"], label="not shifted"))
    fig.legend(handles=handles, loc="outside lower center", ncols=len(handles))
    return fig


def figure_4_11(curves: pd.DataFrame) -> Figure:
    """Mean joint angles of both sources over the gait cycle, and their scatter over strides.

    Parameters
    ----------
    curves : DataFrame
        Of one trial: ``source``, ``side``, ``angle``, ``phase_pct``, ``mean_deg``, ``sd_deg``.
    """
    fig = new_figure("double", height_mm=205)
    grid = fig.subplots(len(SIDES) * len(_JOINTS), 3, sharex=True)
    for s, side in enumerate(SIDES):
        for at, angle in enumerate(ANGLE_NAMES):
            axes = grid[len(_JOINTS) * s + at // 3, at % 3]
            for source in SOURCES:
                phase, mean, sd = _curve(curves, source, side, angle)
                colour = SOURCE_COLOURS[source]
                axes.fill_between(phase, mean - sd, mean + sd, color=colour, alpha=0.2, linewidth=0)
                axes.plot(phase, mean, color=colour, label=SOURCE_LABELS[source])
            axes.set_title(f"{side.capitalize()} {ANGLE_LABELS[angle].lower()}", fontsize=7.0)
            axes.set_xlim(0, 100)
            axes.set_xticks(_PHASE_TICKS)
            if at % 3 == 0:
                axes.set_ylabel("angle (°)")
    for axes in grid[-1]:
        axes.set_xlabel(CYCLE_LABEL)
    fig.align_ylabels(grid[:, 0])
    handles, labels = grid[0, 0].get_legend_handles_labels()
    words = [f"{label}, mean ± SD over strides" for label in labels]
    fig.legend(handles, words, loc="outside lower center", ncols=len(words))
    return fig


def _curve(curves: pd.DataFrame, source: str, side: str, angle: str) -> tuple[Array, Array, Array]:
    """Phase, mean and standard deviation of one curve; its SD is zero if the table has none."""
    own = curves[
        (curves["source"] == source) & (curves["side"] == side) & (curves["angle"] == angle)
    ].sort_values("phase_pct")
    phase, mean = (own[name].to_numpy(dtype=float) for name in ("phase_pct", "mean_deg"))
    sd = own["sd_deg"].to_numpy(dtype=float) if "sd_deg" in own else np.zeros_like(mean)
    return phase, mean, sd
