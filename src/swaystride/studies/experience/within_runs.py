"""Associations within single runs: a measure and affect over sliding windows (D§5.3.4.2).

Windows are not independent: they overlap, a rating holds for minutes, and measure and rating may
both drift with time. The model is ``rating ~ 1 + measure + time``; intervals are those of a
parametric bootstrap (:mod:`swaystride.stats.parametric_bootstrap`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError, ModelError
from swaystride.simulate.seeds import generator
from swaystride.stats.parametric_bootstrap import (
    ErrorKind,
    SeriesDraws,
    bootstrap_trends,
    series_draws,
)
from swaystride.stats.trend_fit import TrendFit, fit_trend
from swaystride.studies.experience.plan import MEASURE_KEYS

Array = NDArray[np.float64]
RATING: Final = "affective_valence"

#: Columns of the limits by kind of errors: alone, then given time.
LIMITS: Final[dict[ErrorKind, tuple[str, str, str, str]]] = {
    "independent": ("ci_low", "ci_high", "ci_low_partial", "ci_high_partial"),
    "ar1": ("ci_low_ar1", "ci_high_ar1", "ci_low_partial_ar1", "ci_high_partial_ar1"),
    "block": ("ci_low_block", "ci_high_block", "ci_low_partial_block", "ci_high_partial_block"),
}
WITHIN_COLUMNS: Final = (
    "run",
    "participant",
    "pattern",
    "measure",
    "n_windows",
    "r",
    *LIMITS["independent"][:2],
    "r_partial",
    *LIMITS["independent"][2:],
    "p_time",
    "rho",
    *LIMITS["ar1"],
    *LIMITS["block"],
    "reason",
)
_WORDS: Final = ("run", "participant", "pattern", "measure", "reason")
EXCLUDED_COLUMNS: Final = ("run", "group", "reason")
SUMMARY_COLUMNS: Final = (
    "measure",
    "errors",
    "n_runs",
    "n_significant",
    "n_positive",
    "share_significant",
    "n_stay_given_time",
)


@dataclass(frozen=True)
class WithinRules:
    """How associations within runs are estimated.

    Parameters
    ----------
    level : float
        Confidence level.
    n_draws : int
    seed : int
    errors : tuple of {"independent", "ar1", "block"}
        Which intervals are computed; that of independent errors is the printed one.
    block_windows : int
        Windows of a block of residuals.
    least_windows : int
        A run with fewer rated windows is left out.

    Raises
    ------
    ConfigurationError
        If a block is as long as the shortest run.
    """

    level: float
    n_draws: int
    seed: int
    errors: tuple[ErrorKind, ...]
    block_windows: int
    least_windows: int

    def __post_init__(self) -> None:
        if self.block_windows >= self.least_windows:
            raise ConfigurationError(
                "a block is as long as the shortest run",
                place="analysis.model.within.least_windows",
                expected=f"more than {self.block_windows} windows",
                found=str(self.least_windows),
            )


def within_runs(
    windows: pd.DataFrame, runs: pd.DataFrame, rules: WithinRules, *, step_s: float
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Every measure against affect in every run whose affect varies.

    Parameters
    ----------
    windows : DataFrame
        A row per window: ``run, start_s, stop_s``, the measures and ``affective_valence``.
    runs : DataFrame
        A row per measured run: ``run, participant, pattern``.
    rules : WithinRules
    step_s : float
        From one window to the next.

    Returns
    -------
    within : DataFrame
        :data:`WITHIN_COLUMNS`, a row per run and measure. What cannot be estimated, or is not asked
        for, is missing; the former has its ``reason``.
    excluded : DataFrame
        Runs that are left out: ``run``, ``group`` (their pattern), ``reason``.
    """
    rows, excluded = [], []
    described = zip(*(runs[name] for name in ("run", "participant", "pattern")), strict=True)
    for run, participant, pattern in described:
        own = windows[(windows["run"] == run) & windows[RATING].notna()]
        reason = reason_to_exclude(own[RATING].to_numpy(dtype=float), rules)
        if reason:
            excluded.append((run, pattern, reason))
            continue
        named = {"run": run, "participant": participant, "pattern": pattern}
        draws = run_draws(str(run), len(own), rules)
        rows += [named | row for row in _run_rows(own, draws, rules, step_s)]
    numbers = dict.fromkeys((name for name in WITHIN_COLUMNS if name not in _WORDS), "float64")
    return (
        pd.DataFrame(rows, columns=list(WITHIN_COLUMNS)).astype({**numbers, "n_windows": "int64"}),
        pd.DataFrame(excluded, columns=list(EXCLUDED_COLUMNS)),
    )


def reason_to_exclude(rating: Array, rules: WithinRules) -> str:
    """Why a run says nothing about associations within it, or nothing.

    Parameters
    ----------
    rating : ndarray, shape (n_windows,)
        Known ratings of its windows.
    rules : WithinRules
    """
    if rating.size == 0:
        return "no ratings"
    if rating.size < rules.least_windows:
        return "too few windows"
    return "" if np.ptp(rating) > 0.0 else "constant affect"


def run_draws(run: str, n_windows: int, rules: WithinRules) -> SeriesDraws:
    """Random numbers of one run, the same for all measures and whatever other runs there are.

    Parameters
    ----------
    run : str
    n_windows : int
    rules : WithinRules
    """
    seed = int(generator(rules.seed, "within_runs", run).integers(2**63))
    return series_draws(
        n_windows, n_draws=rules.n_draws, block_length=rules.block_windows, seed=seed
    )


def _run_rows(
    windows: pd.DataFrame, draws: SeriesDraws, rules: WithinRules, step_s: float
) -> list[dict[str, object]]:
    """Rows of all measures of one run."""
    middle = windows[["start_s", "stop_s"]].to_numpy(dtype=float).mean(axis=1)
    place = np.rint((middle - middle[0]) / step_s).astype(np.intp)
    rating = windows[RATING].to_numpy(dtype=float)
    rows: dict[str, dict[str, object]] = {}
    fits: dict[str, TrendFit] = {}
    for measure in MEASURE_KEYS:
        values = windows[measure].to_numpy(dtype=float)
        known = int(np.isfinite(values).sum())
        rows[measure] = {"measure": measure, "n_windows": known, "reason": ""}
        try:
            _require_windows(known, rules)
            fits[measure] = fit = fit_trend(values, rating, middle, place)
        except ModelError as error:
            rows[measure]["reason"] = str(error)
            continue
        rows[measure] |= {"r": fit.r, "r_partial": fit.r_partial, "p_time": fit.p_time}
        if "ar1" in rules.errors:
            rows[measure]["rho"] = fit.autoregressive.rho
    for kind in rules.errors:
        found = bootstrap_trends(list(fits.values()), draws, kind=kind, level=rules.level)
        for measure, limits in zip(fits, found, strict=True):
            rows[measure].update(
                zip(LIMITS[kind], (*limits.alone, *limits.given_time), strict=True)
            )
    return list(rows.values())


def _require_windows(known: int, rules: WithinRules) -> None:
    """Refuse a measure that is known in too few windows."""
    if known < rules.least_windows:
        raise ModelError(
            "too few windows",
            expected=f"{rules.least_windows} or more with a value",
            found=str(known),
        )


def significant_within(within: pd.DataFrame) -> pd.DataFrame:
    """How often a measure and affect go together within runs, and how often still given time.

    Parameters
    ----------
    within : DataFrame
        From :func:`within_runs`.

    Returns
    -------
    DataFrame
        A row per ``measure`` and kind of ``errors`` that was computed: ``n_runs`` (with an
        estimate), ``n_significant`` (the interval leaves out zero), of which ``n_positive``;
        ``share_significant`` of the runs; ``n_stay_given_time``, those whose partial correlation
        has the same sign and an interval that leaves out zero too.
    """
    rows = []
    for kind, (low, high, low_given_time, high_given_time) in LIMITS.items():
        known = within[within[low].notna()]
        for measure, own in known.groupby("measure", sort=False):
            above, below = own[low] > 0.0, own[high] < 0.0
            stays = (above & (own[low_given_time] > 0.0)) | (below & (own[high_given_time] < 0.0))
            n = int((above | below).sum())
            rows.append(
                {
                    "measure": measure, "errors": kind, "n_runs": len(own), "n_significant": n,
                    "n_positive": int(above.sum()), "share_significant": n / len(own),
                    "n_stay_given_time": int(stays.sum()),
                }
            )  # fmt: skip
    return pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS))
