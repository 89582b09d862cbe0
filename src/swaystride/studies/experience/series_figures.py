"""Figures over the time of single runs: duty factor (5.2), windows (5.3), contact time and affect (5.9)."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from swaystride.gait.rating_windows import WindowRule
from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.experience.exemplars import steady_span

Array = NDArray[np.float64]

SHADE: Final = "#D9D9D9"
_S_PER_MIN: Final = 60.0
_MS_PER_S: Final = 1000.0
#: Bin of Figure 5.2: a dozen strides of each foot.
_BIN_S: Final = 10.0
#: Pieces of a run without steady strides that are shorter than this are rejected strides, not spans.
_SHORTEST_BAND_S: Final = 5.0
#: Share of the strides of the fullest windows that the windows of Figure 5.3 need: the turn leaves
#: others with less.
_NEARLY_ALL: Final = 0.9
#: Windows that Figure 5.3 shows.
_WINDOWS_SHOWN: Final = 2


def figure_5_2(strides: dict[str, pd.DataFrame]) -> Figure:
    """Duty factor over the time of some runs; what is left out is grey.

    Parameters
    ----------
    strides : dict of str to DataFrame
        By run: ``start_s``, ``stop_s``, ``duty_factor``, ``is_steady``; at most four are drawn.
    """
    shown = list(strides.items())[:4]
    fig = new_figure("double", height_mm=105)
    grid = fig.subplots(2, 2, sharex=True)
    for axes, letter in zip(grid.flat, "abcd", strict=True):
        if not shown:
            axes.set_axis_off()
            continue
        run, own = shown.pop(0)
        own = own.sort_values("start_s")
        _shade_left_out(axes, own)
        minute, mean = _binned(own["start_s"], own["duty_factor"])
        axes.plot(
            own["start_s"] / _S_PER_MIN,
            own["duty_factor"],
            ".",
            markersize=0.8,
            color=OKABE_ITO["sky_blue"],
            alpha=0.5,
            rasterized=True,
        )
        axes.plot(minute, mean, color=OKABE_ITO["blue"])
        axes.set_title(f"{letter}  Run {run}")
        axes.set_xlim(0, float(own["stop_s"].max()) / _S_PER_MIN)
        middle = own["duty_factor"].median()
        spread = own["duty_factor"].quantile([0.01, 0.99]).to_numpy(dtype=float)
        axes.set_ylim(min(spread[0], middle - 0.01) - 0.005, max(spread[1], middle + 0.01) + 0.005)
    for axes in grid[-1]:
        axes.set_xlabel("time (min)")
    for axes in grid[:, 0]:
        axes.set_ylabel("duty factor")
    return fig


def _shade_left_out(axes: Axes, strides: pd.DataFrame) -> None:
    """Grey bands where no stride counts."""
    steady = strides["is_steady"].to_numpy(dtype=bool)
    start_s, stop_s = (strides[name].to_numpy(dtype=float) for name in ("start_s", "stop_s"))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], ~steady, [False]]).astype(int)))
    for begin, end in edges.reshape(-1, 2):
        if stop_s[end - 1] - start_s[begin] >= _SHORTEST_BAND_S:
            from_min = 0.0 if begin == 0 else start_s[begin] / _S_PER_MIN
            axes.axvspan(from_min, stop_s[end - 1] / _S_PER_MIN, color=SHADE, linewidth=0, zorder=0)


def _binned(time_s: pd.Series, values: pd.Series) -> tuple[Array, Array]:
    """Means of consecutive spans of time, at their middles in minutes."""
    number = np.floor(time_s.to_numpy(dtype=float) / _BIN_S)
    grouped = values.groupby(number).mean()
    index = np.arange(number.min(), number.max() + 1)
    mean = grouped.reindex(index).to_numpy(dtype=float)
    return (index + 0.5) * _BIN_S / _S_PER_MIN, mean


def figure_5_3(
    run: str, strides: pd.DataFrame, windows: pd.DataFrame, ratings: pd.DataFrame, rule: WindowRule
) -> Figure:
    """How windows slide over a run, and which rating belongs to each.

    Parameters
    ----------
    run : str
    strides : DataFrame
        Of the run: ``start_s``, ``contact_time_s``, ``is_steady``, ``is_valid``.
    windows : DataFrame
        Of the run: ``start_s``, ``stop_s``, ``n_strides``, ``contact_time_s``,
        ``affective_valence``.
    ratings : DataFrame
        Of the run: ``time_s``, ``feeling_scale``.
    rule : WindowRule
        Length and step of the windows.
    """
    fig = new_figure("double", height_mm=90)
    upper, lower = fig.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    first = _first_window_shown(windows)
    chosen = windows.iloc[first : first + _WINDOWS_SHOWN]
    from_s = float(chosen["start_s"].iloc[0]) - rule.step_s
    to_s = float(chosen["stop_s"].iloc[-1]) + rule.step_s
    counts = strides["is_steady"] & strides["is_valid"]
    own = strides[strides["start_s"].between(from_s, to_s) & counts]
    upper.plot(
        own["start_s"], _MS_PER_S * own["contact_time_s"], ".", color=OKABE_ITO["sky_blue"],
        label="strides",
    )  # fmt: skip
    top = float(_MS_PER_S * own["contact_time_s"].max())
    gap = max(0.08 * (top - float(_MS_PER_S * own["contact_time_s"].min())), 1e-6)
    colours = (OKABE_ITO["blue"], OKABE_ITO["vermillion"])
    for place, (colour, (_, window)) in enumerate(zip(colours, chosen.iterrows(), strict=False)):
        begin, end = float(window["start_s"]), float(window["stop_s"])
        middle = 0.5 * (begin + end)
        height = top + (1.5 + 2.0 * place) * gap
        upper.annotate(
            "", (begin, height), (end, height),
            arrowprops={"arrowstyle": "|-|,widthA=0.3,widthB=0.3", "color": colour},
        )  # fmt: skip
        upper.text(middle, height + 0.3 * gap, f"window {place + 1}", ha="center", color=colour)
        upper.plot(
            [middle], [_MS_PER_S * window["contact_time_s"]], "D", color=colour,
            label=f"mean of window {place + 1}",
        )  # fmt: skip
        lower.plot([middle], [window["affective_valence"]], "D", color=colour)
    _steps(lower, ratings, to_s)
    upper.set_ylim(top=top + (2.5 + 2.0 * len(chosen)) * gap)
    upper.set_ylabel("contact time (ms)")
    upper.set_title(f"Run {run}: windows of {rule.length_s:g} s, shifted by {rule.step_s:g} s")
    lower.yaxis.set_major_locator(MaxNLocator(integer=True))
    lower.set_ylabel("Feeling Scale")
    lower.set_xlabel("time (s)")
    lower.set_xlim(from_s, to_s)
    fig.legend(*upper.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return fig


def _first_window_shown(windows: pd.DataFrame) -> int:
    """Of neighbours with the most strides the first whose ratings differ, else the first ones."""
    if len(windows) < _WINDOWS_SHOWN:
        return 0
    rating = windows["affective_valence"].to_numpy(dtype=float)
    strides = windows["n_strides"].to_numpy(dtype=float)
    fewest = np.minimum(strides[:-1], strides[1:])
    full = fewest >= _NEARLY_ALL * fewest.max()
    changes = np.flatnonzero(full & (np.abs(np.diff(rating)) > 0))
    return int(changes[0] if changes.size else np.flatnonzero(full)[0])


def _steps(axes: Axes, ratings: pd.DataFrame, until_s: float, unit_s: float = 1.0) -> None:
    """Ratings that hold until the next one."""
    own = ratings.sort_values("time_s")
    time = np.append(own["time_s"].to_numpy(dtype=float), until_s) / unit_s
    value = own["feeling_scale"].to_numpy(dtype=float)
    if value.size:
        axes.step(time, np.append(value, value[-1]), where="post", color=OKABE_ITO["black"])
        axes.plot(time[:-1], value, "o", color=OKABE_ITO["black"], markersize=2.5)


def figure_5_9(
    run: str, windows: pd.DataFrame, ratings: pd.DataFrame, strides: pd.DataFrame, result: Any
) -> Figure:
    """Contact time and affect of one run, and the line of time through both.

    Parameters
    ----------
    run : str
    windows : DataFrame
        Of the run: ``start_s``, ``stop_s``, ``contact_time_s``, ``affective_valence``.
    ratings : DataFrame
        Of the run: ``time_s``, ``feeling_scale``.
    strides : DataFrame
        Of the run, for its steady part.
    result : mapping
        Row of the associations within runs: ``r``, ``ci_low``, ``ci_high``.
    """
    fig = new_figure("double", height_mm=85)
    upper, lower = fig.subplots(2, 1, sharex=True)
    middle = 0.5 * (windows["start_s"] + windows["stop_s"]).to_numpy(dtype=float) / _S_PER_MIN
    begin_s, end_s = steady_span(strides)
    rows = (
        (upper, _MS_PER_S * windows["contact_time_s"], OKABE_ITO["blue"], "contact time (ms)"),
        (lower, windows["affective_valence"], OKABE_ITO["vermillion"], "Feeling Scale"),
    )
    for axes, values, colour, label in rows:
        value = values.to_numpy(dtype=float)
        axes.plot(middle, value, "o", color=colour, label="windows")
        known = np.isfinite(value)
        if known.sum() > 2:
            slope = np.polyfit(middle[known], value[known], 1)
            axes.plot(middle, np.polyval(slope, middle), "--", color=colour, label="trend")
        axes.set_ylabel(label)
    _steps(lower, ratings[ratings["time_s"] <= end_s], end_s, _S_PER_MIN)
    lower.set_xlabel("time (min)")
    lower.set_xlim(begin_s / _S_PER_MIN, end_s / _S_PER_MIN)
    upper.legend()
    upper.set_title(
        f"Run {run}: R = {result['r']:.2f}, 95 % interval {result['ci_low']:.2f} to "
        f"{result['ci_high']:.2f}".replace("-", "\N{MINUS SIGN}")
    )
    return fig


def empty_figure(words: str) -> Figure:
    """A figure that says why there is none.

    Parameters
    ----------
    words : str
    """
    fig = new_figure("single", height_mm=25)
    axes = fig.subplots()
    axes.set_axis_off()
    axes.text(0.5, 0.5, words, ha="center", va="center", transform=axes.transAxes)
    return fig
