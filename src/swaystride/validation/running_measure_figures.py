"""Figures of the measures of a run on real runners: errors of single contacts, variability."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import OKABE_ITO, new_figure

_SHOWN: Final = {
    "printed": "printed",
    "recommended": "recommended",
    "sharpest_peak": "sharpest peak within 60 ms",
}
_COLOURS: Final = ("vermillion", "blue", "bluish_green")
_PERIODS: Final = (34, 67, 100, 167)


def figure_events(errors: pd.DataFrame) -> Figure:
    """Errors of every initial contact and toe-off, foot by foot.

    Parameters
    ----------
    errors : DataFrame
        From :func:`swaystride.validation.running_sensor_events.single_errors`, one cut-off.
    """
    feet = list(dict.fromkeys(zip(errors["trial"], errors["side"], strict=True)))
    fig = new_figure("double", height_mm=110)
    panels = fig.subplots(2, 1, sharex=True)
    for axes, name in zip(panels, ("initial_contact", "toe_off"), strict=True):
        for k, (method, label) in enumerate(_SHOWN.items()):
            own = errors[errors["method"] == method]
            for place, (trial, side) in enumerate(feet):
                late = own.loc[(own["trial"] == trial) & (own["side"] == side), name].to_numpy()
                x = place + 0.25 * (k - 1) + np.linspace(-0.09, 0.09, late.size)
                axes.plot(x, late, ".", ms=2.5, color=OKABE_ITO[_COLOURS[k]],
                          label=label if place == 0 else None)  # fmt: skip
        axes.axhline(0.0, color="black", lw=0.6)
        axes.set_ylabel(f"{name.replace('_', ' ')},\nsensor − plate, ms")
    names = [f"{trial}\n{side}".replace(" at ", "\n") for trial, side in feet]
    panels[-1].set_xticks(range(len(feet)), names)
    handles, labels = panels[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=3)
    return fig


def figure_coordination(curves: pd.DataFrame) -> Figure:
    """Variability of three couples over stance and swing, a line per trial.

    Parameters
    ----------
    curves : DataFrame
        From :func:`swaystride.validation.running_coordination.variability_curves`.
    """
    couples = list(dict.fromkeys(curves["couple"]))
    fig = new_figure("double", height_mm=75)
    panels = fig.subplots(1, len(couples), sharey=True)
    colours = ("vermillion", "orange", "blue", "sky_blue")
    for axes, couple in zip(panels, couples, strict=True):
        own = curves[curves["couple"] == couple]
        for colour, (trial, line) in zip(colours, own.groupby("trial", sort=False), strict=False):
            axes.plot(line["phase_percent"], line["variability_deg"], lw=1.0, label=trial,
                      color=OKABE_ITO[colour])  # fmt: skip
        for edge in _PERIODS:
            axes.axvline(edge, color="0.8", lw=0.6, zorder=0)
        axes.set_title(couple)
        axes.set_xlabel("% of stance, then of swing + 100")
    panels[0].set_ylabel("variability, degrees")
    handles, labels = panels[0].get_legend_handles_labels()
    fig.legend(handles, labels, loc="outside lower center", ncols=2)
    return fig
