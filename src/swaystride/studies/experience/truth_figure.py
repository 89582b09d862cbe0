"""Errors of every run of a simulated cohort against the truth, beside their limits."""

from __future__ import annotations

from dataclasses import asdict
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.experience.table_options import TruthLimits
from swaystride.studies.experience.truth_tables import judged_errors

_TITLES: Final = {
    "stride_time_ms": "Stride time (ms)",
    "contact_time_ms": "Contact time (ms)",
    "duty_factor": "Duty factor",
    "stride_length_pct": "Stride length (%)",
    "initial_contact_bias_ms": "Initial contact, bias (ms)",
    "initial_contact_sd_ms": "Initial contact, SD (ms)",
    "hip_range_deg": "Hip range (°)",
    "knee_range_deg": "Knee range (°)",
    "inclination_deg": "Inclination of sensors (°)",
    "ml_shank_foot_deg": "ML axis, shank and foot (°)",
    "ml_thigh_deg": "ML axis, thigh (°)",
    "peak_tibial_pct": "Peak tibial acceleration (%)",
}


def figure_truth(errors: pd.DataFrame, limits: TruthLimits) -> Figure:
    """One panel per limit, one column of points per run.

    Parameters
    ----------
    errors : DataFrame
        Of all runs, see :func:`swaystride.studies.experience.truth_tables.judged_errors`.
    limits : TruthLimits
    """
    judged = judged_errors(errors, limits)
    runs = list(dict.fromkeys(errors["run"]))
    place = {run: at for at, run in enumerate(runs)}
    fig = new_figure("double", height_mm=170)
    grid = fig.subplots(4, 3, sharex=True)
    for axes, (kind, limit) in zip(grid.flat, asdict(limits).items(), strict=True):
        own = judged[judged["kind"] == kind]
        at = own["run"].map(place).to_numpy(dtype=float)
        error = own["error"].to_numpy(dtype=float)
        inside = own["within"].to_numpy(dtype=bool)
        low = -limit if not error.size or np.nanmin(error) < 0 else 0.0
        axes.axhspan(low, limit, color=OKABE_ITO["bluish_green"], alpha=0.15, linewidth=0)
        axes.plot(at[inside], error[inside], "o", color=OKABE_ITO["blue"], markersize=2.5)
        axes.plot(at[~inside], error[~inside], "D", color=OKABE_ITO["vermillion"], markersize=3.5)
        axes.set_title(_TITLES[kind])
        axes.margins(y=0.1)
    for axes in grid[-1]:
        axes.set_xticks(range(len(runs)), runs, rotation=90, fontsize=5.5)
        axes.set_xlim(-0.7, len(runs) - 0.3)
    for axes in grid[:, 0]:
        axes.set_ylabel("error")
    return fig
