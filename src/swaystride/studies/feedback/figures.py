"""Figures 2.1-2.3 of the chapter, the effects beside the print, and the residuals of the models."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.special import ndtri

from swaystride.presentation.figure_style import OKABE_ITO, new_figure
from swaystride.studies.feedback.plan import FEATURES

#: Colour and marker of the three feedback conditions, the same in every figure.
CONDITIONS = {
    "none": ("no feedback", OKABE_ITO["black"], "o"),
    "concurrent": ("concurrent feedback", OKABE_ITO["blue"], "s"),
    "terminal": ("terminal feedback", OKABE_ITO["vermillion"], "^"),
}


def figure_feedback_displays(
    concurrent_deg: NDArray[np.float64], terminal_deg: NDArray[np.float64], *, instant: int
) -> Figure:
    """Both feedback displays (Figure 2.1).

    Parameters
    ----------
    concurrent_deg : ndarray, shape (2, n_samples)
        AP and ML lean of a trial with concurrent feedback, forward and right positive.
    terminal_deg : ndarray, shape (2, n_samples)
        The same of the trial that a participant sees before a trial with terminal feedback.
    instant : int
        Sample at which the concurrent display is shown.
    """
    now = (concurrent_deg - concurrent_deg.mean(axis=1, keepdims=True))[:, instant]
    trace = terminal_deg - terminal_deg.mean(axis=1, keepdims=True)
    half_width = 1.15 * float(max(np.abs(now).max(), np.abs(trace).max()))
    fig = new_figure("double", height_mm=82)
    left, right = fig.subplots(1, 2, sharex=True, sharey=True)
    left.plot(now[1], now[0], "o", color=OKABE_ITO["blue"], markersize=9)
    left.set_title("Concurrent: the lean of this instant")
    right.plot(trace[1], trace[0], color=OKABE_ITO["vermillion"], linewidth=0.8)
    right.set_title("Terminal: the whole of the previous trial")
    for axes in (left, right):
        axes.axhline(0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
        axes.axvline(0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
        axes.set_aspect("equal")
        axes.set_xlabel("medio-lateral lean, deg (right +)")
        axes.set_xlim(-half_width, half_width)
        axes.set_ylim(-half_width, half_width)
    left.set_ylabel("anterior-posterior lean, deg (forward +)")
    return fig


def display_trials(trials: pd.DataFrame) -> tuple[str, str]:
    """Which trials of one participant Figure 2.1 shows.

    Parameters
    ----------
    trials : DataFrame
        Analysed trials of one participant: ``trial``, ``session_trial``, ``feedback_shown``.

    Returns
    -------
    concurrent, terminal : str
        The first trial with concurrent feedback, and the trial before the first one with terminal
        feedback (its trace is what that display shows). Without such trials: the first trial.
    """
    session = trials.sort_values("session_trial")
    names, shown = session["trial"].tolist(), session["feedback_shown"].tolist()
    concurrent = shown.index("concurrent") if "concurrent" in shown else 0
    terminal = max(shown.index("terminal") - 1, 0) if "terminal" in shown else 0
    return names[concurrent], names[terminal]


def figure_trial_structure(trials: pd.DataFrame) -> Figure:
    """Sequence of the trials of one session, one row per order of the blocks (Figure 2.2).

    Parameters
    ----------
    trials : DataFrame
        Model variables (``order``, ``session_trial``, ``phase``, ``feedback_shown``); the longest
        session of each order is drawn.
    """
    fig = new_figure("double", height_mm=55)
    axes = fig.subplots()
    labels = []
    for row, (order, name) in enumerate(((0.0, "concurrent first"), (1.0, "terminal first"))):
        group = trials[trials["order"] == order]
        if group.empty:
            continue
        longest = group.groupby("participant").size().idxmax()
        session = group[group["participant"] == longest]
        for shown, (_, colour, _) in CONDITIONS.items():
            for phase, alpha in (("baseline", 0.35), ("training", 1.0)):
                chosen = session[(session["feedback_shown"] == shown) & (session["phase"] == phase)]
                axes.bar(
                    chosen["session_trial"],
                    np.full(len(chosen), 0.6),
                    width=0.82,
                    bottom=-row - 0.3,
                    color=colour,
                    alpha=alpha,
                )
        labels.append((-row, name))
    axes.set_yticks([y for y, _ in labels], [name for _, name in labels])
    axes.set_ylim(-1.5, 0.5)
    axes.set_xlabel("trial of the session")
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    handles = [_patch(OKABE_ITO["black"], "baseline, no feedback", alpha=0.35)]
    handles += [
        _patch(colour, f"training, {label}") for _, (label, colour, _) in CONDITIONS.items()
    ]
    _legend_above(axes, ncols=2, handles=handles)
    return fig


def figure_exemplar_measured(observed: pd.DataFrame) -> Figure:
    """Phi RMS of one participant, trial by trial (Figure 2.3a).

    Parameters
    ----------
    observed : DataFrame
        Trials of one participant: ``session_trial``, ``feedback``, ``feedback_shown``, ``phi_rms``.
    """
    fig = new_figure("double", height_mm=62)
    axes = fig.subplots()
    _shade_blocks(axes, observed)
    for shown, (label, colour, marker) in CONDITIONS.items():
        chosen = observed[observed["feedback_shown"] == shown]
        axes.plot(chosen["session_trial"], chosen["phi_rms"], marker, color=colour, label=label)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("trial of the session")
    axes.set_ylabel("Phi RMS, deg")
    _legend_above(axes, ncols=3)
    return fig


def figure_exemplar_predicted(predictions: pd.DataFrame, confidence_level: float) -> Figure:
    """Predicted Phi RMS of the same participant (Figure 2.3b).

    The band holds only the three effects of interest (trial number, removal of concurrent and of
    terminal feedback): it says how well those are known, not how a trial scatters.

    Parameters
    ----------
    predictions : DataFrame
        ``session_trial``, ``feedback``, ``feedback_shown``, ``fitted`` and ``interest_se`` (both
        on the log scale).
    confidence_level : float
    """
    z = float(ndtri(0.5 + confidence_level / 2))
    fig = new_figure("double", height_mm=62)
    axes = fig.subplots()
    _shade_blocks(axes, predictions)
    for _, block in predictions.groupby("feedback"):
        low = np.exp(block["fitted"] - z * block["interest_se"])
        high = np.exp(block["fitted"] + z * block["interest_se"])
        axes.fill_between(
            block["session_trial"], low, high, color=OKABE_ITO["sky_blue"], alpha=0.35, linewidth=0
        )
        axes.plot(
            block["session_trial"], np.exp(block["fitted"]), color=OKABE_ITO["black"], linewidth=0.8
        )
    for shown, (label, colour, marker) in CONDITIONS.items():
        chosen = predictions[predictions["feedback_shown"] == shown]
        axes.plot(
            chosen["session_trial"], np.exp(chosen["fitted"]), marker, color=colour, label=label
        )
    axes.set_ylim(bottom=0)
    axes.set_xlabel("trial of the session")
    axes.set_ylabel("predicted Phi RMS, deg")
    _legend_above(axes, ncols=3)
    return fig


def figure_effects(reproduced: pd.DataFrame, printed: pd.DataFrame) -> Figure:
    """Every effect of Table 2.3 with its interval, the print beside it.

    Parameters
    ----------
    reproduced, printed : DataFrame
        Table 2.3, ours (with ``attainable``) and as printed.
    """
    keys = ["panel", "feature", "effect"]
    both = printed.merge(reproduced, on=keys, suffixes=("_printed", ""), validate="one_to_one")
    columns = [
        ("training", "concurrent", "training, concurrent"),
        ("training", "terminal_minus_concurrent", "training,\nterminal − concurrent"),
        ("removal", "concurrent", "removal of\nconcurrent feedback"),
        ("removal", "terminal", "removal of\nterminal feedback"),
    ]
    fig = new_figure("double", height_mm=78)
    panels = fig.subplots(1, 4, sharey=True)
    for axes, (panel, effect, title) in zip(panels, columns, strict=True):
        rows = both[(both["panel"] == panel) & (both["effect"] == effect)]
        y = -np.arange(len(rows), dtype=np.float64)
        _intervals(axes, rows, y + 0.14, "_printed", OKABE_ITO["orange"], "D")
        _intervals(axes, rows, y - 0.14, "", OKABE_ITO["blue"], "o")
        axes.axvline(0, color=OKABE_ITO["black"], linewidth=0.6, zorder=0)
        axes.set_title(title)
        free = rows["attainable"].astype(bool).tolist()
        names = [FEATURES[str(feature)][0] for feature in rows["feature"]]
        marks = ["" if ok else " †" for ok in free]
        if axes is panels[0]:
            axes.set_yticks(y, [f"{name}{mark}" for name, mark in zip(names, marks, strict=True)])
        else:
            axes.tick_params(axis="y", length=0)
            for at, mark in zip(y, marks, strict=True):
                axes.text(1.0, at, mark, transform=axes.get_yaxis_transform(), va="center")
        axes.set_xlabel("effect on the log")
    handles = [
        _line(OKABE_ITO["orange"], "D", "printed"),
        _line(OKABE_ITO["blue"], "o", "reproduced"),
    ]
    panels[0].legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.13), ncols=2)
    return fig


def figure_residuals(predictions: pd.DataFrame) -> Figure:
    """Residuals of the models at the printed terms: against the fit, and against the normal.

    Parameters
    ----------
    predictions : DataFrame
        ``feature``, ``fitted``, ``residual`` (log scale), all features.
    """
    fig = new_figure("double", height_mm=88)
    grid = fig.subplots(2, len(FEATURES))
    for column, (feature, (label, _)) in enumerate(FEATURES.items()):
        rows = predictions[predictions["feature"] == feature]
        residual = rows["residual"].to_numpy()
        top, bottom = grid[0, column], grid[1, column]
        dots: dict[str, Any] = {"color": OKABE_ITO["blue"], "markersize": 1.4, "alpha": 0.5}
        top.plot(rows["fitted"], residual, ".", **dots)
        top.axhline(0, color=OKABE_ITO["black"], linewidth=0.6)
        top.set_title(f"ln {label}")
        top.set_xlabel("fitted")
        ordered = np.sort(residual) / residual.std()
        quantile = ndtri((np.arange(ordered.size) + 0.5) / ordered.size)
        bottom.plot(quantile, ordered, ".", **dots)
        bottom.axline((0, 0), slope=1, color=OKABE_ITO["black"], linewidth=0.6)
        bottom.set_xlabel("normal quantile")
    grid[0, 0].set_ylabel("residual")
    grid[1, 0].set_ylabel("standardised residual")
    return fig


def _intervals(
    axes: Axes, rows: pd.DataFrame, y: NDArray[np.float64], suffix: str, colour: str, marker: str
) -> None:
    """Estimates with their confidence intervals, one per line."""
    axes.hlines(y, rows[f"ci_low{suffix}"], rows[f"ci_high{suffix}"], color=colour, linewidth=1.0)
    axes.plot(rows[f"estimate{suffix}"], y, marker, color=colour, markersize=3)


def _shade_blocks(axes: Axes, trials: pd.DataFrame) -> None:
    """Tint and name the two blocks of a session."""
    for index, (_, block) in enumerate(trials.groupby("block_index", sort=True)):
        first, last = block["session_trial"].min() - 0.5, block["session_trial"].max() + 0.5
        if index:
            axes.axvspan(first, last, color="#F1F1F1", zorder=0, linewidth=0)
        axes.text(
            (first + last) / 2,
            0.02,
            f"{block['feedback'].iloc[0]} block",
            transform=axes.get_xaxis_transform(),
            ha="center",
            va="bottom",
            color="#555555",
        )


def _legend_above(axes: Axes, *, ncols: int, **legend: Any) -> None:
    """Legend above the axes, which leaves the figure's own margin to the mark of a simulation."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=ncols, **legend)


def _patch(colour: str, label: str, alpha: float = 1.0) -> Any:
    from matplotlib.patches import Patch

    return Patch(color=colour, label=label, alpha=alpha)


def _line(colour: str, marker: str, label: str) -> Any:
    from matplotlib.lines import Line2D

    return Line2D([], [], color=colour, marker=marker, label=label)
