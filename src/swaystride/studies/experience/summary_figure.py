"""Figures over the runs: significant associations (5.7), contact time within runs (5.8)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.presentation.number_format import format_number
from swaystride.studies.experience.exemplars import CONTACT_TIME
from swaystride.studies.experience.plan import MEASURES, SCALES
from swaystride.studies.experience.run_tables import INTERVALS

SCALE_LABELS: Final = {
    "affective_valence": "Affective\nvalence",
    "activity_enjoyment": "Activity\nenjoyment",
    "flow": "Flow",
}
GROUP_LABELS: Final = {"all": "all runs", "aerial": "aerial runs"}
_MAP: Final = LinearSegmentedColormap.from_list(
    "correlation", [OKABE_ITO["vermillion"], "#FFFFFF", OKABE_ITO["blue"]]
)
_PATTERN_COLOURS: Final = {"aerial": OKABE_ITO["blue"], "terrestrial": OKABE_ITO["vermillion"]}


def figure_5_7(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Every measure with a significant association: its correlation with each scale, both groups.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        Tables 5.3 (``all``) and 5.4 (``aerial``): ``measure``, ``scale``, ``r``, ``significant``.
        A cell without significance is left empty.
    """
    joined = pd.concat([table.assign(group=group) for group, table in tables.items()])
    found = joined[joined["significant"].fillna(0).astype(int) == 1]
    names = [measure.name for measure in MEASURES if measure.name in set(found["measure"])]
    fig = new_figure("double", height_mm=30.0 + 6.0 * max(len(names), 1))
    panels = fig.subplots(1, len(tables), sharey=True)
    for axes, group in zip(np.atleast_1d(panels), tables, strict=True):
        own = found[found["group"] == group]
        for row in own.to_dict("records"):
            x, y = SCALES.index(row["scale"]), names.index(row["measure"])
            tone = _MAP(0.5 + 0.5 * float(row["r"]))
            axes.add_patch(
                Rectangle((x - 0.46, y - 0.42), 0.92, 0.84, facecolor=tone, edgecolor="black",
                          linewidth=0.5)
            )  # fmt: skip
            axes.text(x, y, format_number(row["r"], 2), ha="center", va="center")
        axes.set_xlim(-0.6, len(SCALES) - 0.4)
        axes.set_xticks(range(len(SCALES)), [SCALE_LABELS[scale] for scale in SCALES])
        axes.set_title(f"{GROUP_LABELS[group].capitalize()} ({len(own)} significant)")
        axes.grid(axis="y")
    first = np.atleast_1d(panels)[0]
    first.set_yticks(range(len(names)), names)
    first.set_ylim(max(len(names), 1) - 0.4, -0.6)
    return fig


def figure_5_8(within: pd.DataFrame) -> Figure:
    """Correlation of contact time and affect in every run, with its intervals, by pattern.

    Parameters
    ----------
    within : DataFrame
        ``run``, ``pattern``, ``measure``, ``r`` and the limits of the printed interval (thick) and,
        where it was computed, of that for residuals that follow each other (thin).
    """
    estimate, low, high = INTERVALS["printed"]
    _, wide_low, wide_high = INTERVALS["ar1"]
    own = within[(within["measure"] == CONTACT_TIME) & within[estimate].notna()]
    groups = {name: own[own["pattern"] == name].sort_values(estimate) for name in _PATTERN_COLOURS}
    widths = [max(len(table), 1) + 1 for table in groups.values()]
    fig = new_figure("double", height_mm=75)
    panels = fig.subplots(1, len(groups), sharey=True, width_ratios=widths)
    for axes, (name, table) in zip(panels, groups.items(), strict=True):
        r = table[estimate].to_numpy(dtype=float)
        limits = table[[low, high]].to_numpy(dtype=float)
        at = np.arange(r.size)
        axes.vlines(at, limits[:, 0], limits[:, 1], color=_PATTERN_COLOURS[name], linewidth=1.8)
        if wide_low in table:
            wide = table[[wide_low, wide_high]].to_numpy(dtype=float)
            axes.vlines(at, wide[:, 0], wide[:, 1], color=_PATTERN_COLOURS[name], linewidth=0.6)
        axes.plot(at, r, "o", color=_PATTERN_COLOURS[name])
        axes.axhline(0.0, color=OKABE_ITO["black"], linewidth=0.5)
        axes.set_xticks(at, table["run"], rotation=90)
        axes.set_xlim(-0.7, max(r.size, 1) - 0.3)
        axes.set_title(f"{name.capitalize()} runs (n = {r.size})")
    panels[0].set_ylim(-1.05, 1.05)
    panels[0].set_ylabel("R of contact time and affect")
    return fig
