"""Figures of the ratings: affect over time (5.4), its distribution (5.5), enjoyment and flow (5.6)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.experience.plan import SCALE_ENDS
from swaystride.studies.experience.table_inputs import participant_of

_S_PER_MIN: Final = 60.0
#: Width of the classes of Figure 5.6, in points.
_CLASS_WIDTH: Final = 5.0
_SUMS: Final = {"activity_enjoyment": "PACES", "flow": "Flow Short Scale"}


def figure_5_4(affect: pd.DataFrame, checks: pd.DataFrame) -> Figure:
    """Affect over time: a row per participant, a column per run.

    Parameters
    ----------
    affect : DataFrame
        ``run``, ``time_s``, ``feeling_scale``.
    checks : DataFrame
        ``run``, ``duration_s`` of every run, in the order of the lab's table.
    """
    people = list(dict.fromkeys(participant_of(run) for run in checks["run"]))
    of_person = {name: [r for r in checks["run"] if participant_of(r) == name] for name in people}
    n_columns = max(len(runs) for runs in of_person.values())
    fig = new_figure("double", height_mm=max(14.0 * len(people) + 20.0, 45.0))
    grid = fig.subplots(len(people), n_columns, sharex=True, sharey=True, squeeze=False)
    low = min(0.0, float(affect["feeling_scale"].min())) if len(affect) else 0.0
    duration = checks.set_index("run")["duration_s"].astype(float)
    for row, name in zip(grid, people, strict=True):
        for axes in row[len(of_person[name]) :]:
            axes.set_visible(False)
        for axes, run in zip(row, of_person[name], strict=False):
            own = affect[affect["run"] == run].sort_values("time_s")
            value = own["feeling_scale"].to_numpy(dtype=float)
            if value.size:
                time = np.append(own["time_s"].to_numpy(dtype=float), duration[run]) / _S_PER_MIN
                axes.step(time, np.append(value, value[-1]), where="post", color=OKABE_ITO["blue"])
                axes.plot(time[:-1], value, "o", color=OKABE_ITO["blue"], markersize=2.0)
            axes.set_ylim(low - 0.5, SCALE_ENDS["affective_valence"][1] + 0.5)
            axes.grid(axis="y")
            axes.tick_params(labelbottom=True)
        row[0].set_ylabel(name)
    for column in grid.T:
        shown = [axes for axes in column if axes.get_visible()]
        for axes in shown[:-1]:
            axes.tick_params(labelbottom=False)
    grid[0, 0].set_xlim(0, float(np.nanmax(duration)) / _S_PER_MIN)
    fig.supxlabel("time (min)", fontsize=7.5)
    fig.supylabel("Feeling Scale, by participant", fontsize=7.5)
    return fig


def figure_5_5(affect: pd.DataFrame) -> Figure:
    """Distribution of all ratings of affect.

    Parameters
    ----------
    affect : DataFrame
        ``feeling_scale``.
    """
    fig = new_figure("single", height_mm=60)
    axes = fig.subplots()
    low, high = (int(end) for end in SCALE_ENDS["affective_valence"])
    steps = np.arange(low, high + 1)
    counts = affect["feeling_scale"].value_counts().reindex(steps, fill_value=0)
    axes.bar(steps, counts, 0.85, color=OKABE_ITO["sky_blue"], edgecolor="black", linewidth=0.5)
    axes.set_xticks(steps)
    axes.set_xlabel("Feeling Scale (−5 very bad, +5 very good)")
    axes.set_ylabel("ratings")
    return fig


def figure_5_6(scores: pd.DataFrame) -> Figure:
    """Distributions of the two questionnaires, whole possible range.

    Parameters
    ----------
    scores : DataFrame
        ``activity_enjoyment``, ``flow``.
    """
    fig = new_figure("double", height_mm=60)
    panels = fig.subplots(1, 2, sharey=True)
    for axes, (scale, name) in zip(panels, _SUMS.items(), strict=True):
        low, high = SCALE_ENDS[scale]
        edges = np.arange(np.floor(low / _CLASS_WIDTH), np.ceil(high / _CLASS_WIDTH) + 1)
        values = scores[scale].dropna().to_numpy(dtype=float)
        axes.hist(
            values, edges * _CLASS_WIDTH, color=OKABE_ITO["sky_blue"], edgecolor="black",
            linewidth=0.5,
        )  # fmt: skip
        if values.size:
            axes.axvline(
                float(np.median(values)), color=OKABE_ITO["vermillion"], linestyle="--",
                label="median",
            )  # fmt: skip
        axes.set_xlim(low, high)
        axes.set_xlabel(f"{name} (points, {low:g} to {high:g})")
    panels[0].yaxis.set_major_locator(MaxNLocator(integer=True))
    panels[0].set_ylabel("runs")
    panels[0].legend()
    return fig
