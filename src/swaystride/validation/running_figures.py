"""Figures of the simulated runner over real ones."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.validation.running_body import (
    JointComparison,
    RunnerComparison,
    SimulatedStride,
    offset_curve,
)
from swaystride.validation.running_real import JOINTS, N_PHASES, RealTrial

_PHASE: Final = np.linspace(0.0, 100.0, N_PHASES)
_NAMES: Final = {"hip": "hip flexion", "knee": "knee flexion", "ankle": "ankle dorsiflexion"}


def figure_joints(comparison: RunnerComparison) -> Figure:
    """Sagittal joint curves: real strides with mean and band, the simulated one over them.

    Parameters
    ----------
    comparison : RunnerComparison
    """
    n = len(comparison.curves)
    fig = new_figure("double", height_mm=46 * n + 14)
    panels = fig.subplots(n, len(JOINTS), sharex=True, squeeze=False)
    for row, pair in zip(panels, comparison.curves, strict=True):
        for axes, joint in zip(row, JOINTS, strict=True):
            _draw_joint(axes, pair, joint)
        row[1].set_title(pair.real.label)
        row[0].set_ylabel("degrees")
    for axes, joint in zip(panels[-1], JOINTS, strict=True):
        axes.set_xlabel(f"{_NAMES[joint]}, % of the stride")
    shown = dict(zip(*reversed(panels[0, 0].get_legend_handles_labels()), strict=True))
    shown |= dict(zip(*reversed(panels[-1, 0].get_legend_handles_labels()), strict=True))
    fig.legend(list(shown.values()), list(shown), loc="outside lower center", ncols=3)
    return fig


def _draw_joint(axes: Axes, pair: JointComparison, joint: str) -> None:
    strides = pair.real.angle_deg[joint]
    mean, sd = strides.mean(axis=0), strides.std(axis=0, ddof=1)
    blue, red = OKABE_ITO["blue"], OKABE_ITO["vermillion"]
    if pair.population_sd_deg:
        wide = 2.0 * pair.population_sd_deg[joint]
        axes.fill_between(
            _PHASE, mean - wide, mean + wide, color="0.88", lw=0, label="± 2 SD of eight runners"
        )
    axes.fill_between(
        _PHASE,
        mean - 2 * sd,
        mean + 2 * sd,
        color=blue,
        alpha=0.25,
        lw=0,
        label="± 2 SD of these strides",
    )
    for k, runner in enumerate(np.unique(pair.real.runner)):
        own = strides[pair.real.runner == runner].mean(axis=0)
        axes.plot(_PHASE, own, color="0.5", lw=0.5, label="each runner" if k == 0 else None)
    axes.plot(_PHASE, mean, color=blue, lw=1.0, label="real, mean")
    curve = offset_curve(pair.real, pair.usual, joint)
    axes.plot(_PHASE, curve, color=red, lw=1.2, label="simulated, usual")
    axes.axvline(100 * pair.usual.duty_factor, color="0.5", lw=0.5)
    for other, style, label in (
        (pair.matched, "--", "simulated, matched timing"),
        (pair.fitted, ":", "simulated, fitted to these"),
    ):
        if other is not None:
            curve = offset_curve(pair.real, other, joint)
            axes.plot(_PHASE, curve, color=red, lw=1.0, ls=style, label=label)


def figure_feet(comparison: RunnerComparison) -> Figure:
    """Foot pitch over the stride, and stride time, duty factor and bobbing beside it.

    Parameters
    ----------
    comparison : RunnerComparison
    """
    fig = new_figure("double", height_mm=95)
    n = len(comparison.trials)
    grid = fig.add_gridspec(2, 6)
    for k, (real, simulated) in enumerate(comparison.trials):
        width = 6 // n
        axes = fig.add_subplot(grid[0, width * k : width * (k + 1)])
        _draw_pitch(axes, real, simulated)
        if k == 0:
            axes.set_ylabel("foot pitch, degrees")
            handles = axes.get_legend_handles_labels()
    quantities = [
        (name, label)
        for name, label in (
            ("stride_time_s", "stride time, s"),
            ("duty_factor", "duty factor"),
            ("oscillation_m", "pelvis, vertical range, m"),
        )
        if any(np.isfinite(getattr(real, name)).any() for real, _ in comparison.trials)
    ]
    width = 6 // len(quantities)
    for k, (name, label) in enumerate(quantities):
        axes = fig.add_subplot(grid[1, width * k : width * (k + 1)])
        for row, (real, simulated) in enumerate(comparison.trials):
            values = np.asarray(getattr(real, name))
            axes.plot(values, np.full(len(values), row), "|", color=OKABE_ITO["blue"])
            if not np.isnan(values).all():
                axes.plot(getattr(simulated, name), row, "o", color=OKABE_ITO["vermillion"], ms=4)
        axes.set_yticks(range(n), [real.label for real, _ in comparison.trials])
        axes.set_ylim(-0.5, n - 0.5)
        axes.set_xlabel(label)
        if k > 0:
            axes.set_yticklabels([])
    fig.legend(*handles, loc="outside lower center", ncols=3)
    return fig


def _draw_pitch(axes: Axes, real: RealTrial, simulated: SimulatedStride) -> None:
    pitch = real.foot_pitch_deg
    mean, sd = pitch.mean(axis=0), pitch.std(axis=0, ddof=1)
    blue, red = OKABE_ITO["blue"], OKABE_ITO["vermillion"]
    axes.fill_between(_PHASE, mean - 2 * sd, mean + 2 * sd, color=blue, alpha=0.2, lw=0)
    axes.plot(_PHASE, mean, color=blue, lw=1.0, label="real, mean ± 2 SD; each stride")
    axes.plot(_PHASE, simulated.foot_pitch_deg, color=red, lw=1.2, label="simulated")
    axes.set_title(f"{real.label}, {real.speed_m_s:g} m/s")
    axes.set_xlabel("% of the stride")
