"""Figure of the optical joint angles of a real runner over the authors' own."""

from __future__ import annotations

from typing import Final

import pandas as pd
from matplotlib.figure import Figure

from swaystride.lower_limb_joints import ANGLES
from swaystride.mocap.marker_set import SIDES
from swaystride.presentation.figure_style import OKABE_ITO, new_figure

_JOINTS: Final = ("hip", "knee", "ankle")
_COLOURS: Final = {"right": "blue", "left": "vermillion"}
_TITLES: Final = ("flexion, dorsiflexion", "adduction, inversion", "internal rotation")


def figure_angles(samples: pd.DataFrame, trial: str) -> Figure:
    """All nine angles of a trial, right and left; ours after one constant per curve.

    Parameters
    ----------
    samples : DataFrame
        From :func:`swaystride.validation.running_optical_tables.curve_samples`.
    trial : str
        Which one.
    """
    shown = samples[(samples["trial"] == trial) & (samples["centres"] == "medial_markers")]
    curves = dict(list(shown.groupby(["joint", "angle", "side"])))
    fig = new_figure("double", height_mm=130)
    panels = fig.subplots(len(_JOINTS), len(ANGLES), sharex=True)
    for row, joint in zip(panels, _JOINTS, strict=True):
        for axes, angle in zip(row, ANGLES, strict=True):
            for side in SIDES:
                curve = curves[joint, angle, side]
                constant = (curve["ours_deg"] - curve["authors_deg"]).mean()
                colour = OKABE_ITO[_COLOURS[side]]
                axes.plot(curve["phase_percent"], curve["authors_deg"], color=colour, lw=2.5,
                          alpha=0.35, label=f"{side}, authors")  # fmt: skip
                axes.plot(curve["phase_percent"], curve["ours_deg"] - constant, color=colour,
                          lw=0.9, label=f"{side}, ours after a constant")  # fmt: skip
        row[0].set_ylabel(f"{joint}, degrees")
    for axes, title in zip(panels[0], _TITLES, strict=True):
        axes.set_title(title)
    for axes in panels[-1]:
        axes.set_xlabel("% of the stride")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=2)
    return fig
