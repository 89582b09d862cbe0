"""Measures and answers side by side: a row per run, and a row per window of a run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.gait.rating_windows import RatingMean, mean_rating, window_ratings
from swaystride.studies.experience.patterns import (
    PatternRules,
    duty_factor_at_12_km_h,
    running_patterns,
)
from swaystride.studies.experience.plan import MEASURE_KEYS, SCALES

_PATTERN_COLUMNS: Final = ("pattern", "duty_factor_at_12_km_h", "pattern_at_12_km_h")
RUN_OBSERVATIONS: Final = (
    "run",
    "participant",
    "n_strides",
    "n_rejected",
    *MEASURE_KEYS,
    *SCALES,
    *_PATTERN_COLUMNS,
)
WINDOW_OBSERVATIONS: Final = (
    "run",
    "participant",
    "pattern",
    "start_s",
    "stop_s",
    "n_strides",
    *MEASURE_KEYS,
    "affective_valence",
)


def rows_of_runs(folder: Path, runs: Sequence[str]) -> pd.DataFrame:
    """Tables of single runs below each other; those of runs that are left out have no rows.

    Parameters
    ----------
    folder : Path
        Holds ``<run>.parquet``.
    runs : sequence of str
        Names, one at least.
    """
    tables = [pd.read_parquet(folder / f"{run}.parquet") for run in runs]
    filled = [table for table in tables if len(table)]
    return pd.concat(filled, ignore_index=True) if filled else tables[0]


def run_observations(
    runs: pd.DataFrame,
    scores: pd.DataFrame,
    affect: pd.DataFrame,
    *,
    warm_up_s: float,
    mean: RatingMean,
    rules: PatternRules,
) -> pd.DataFrame:
    """Measures, answers and pattern of every measured run.

    Parameters
    ----------
    runs : DataFrame
        One row per run: ``run, participant, n_strides, n_rejected`` and the measures.
    scores, affect : DataFrame
        See :class:`swaystride.studies.experience.answers.Answers`.
    warm_up_s : float
        The mean of the ratings begins here; it ends where they are no longer known.
    mean : {"time_weighted", "simple"}
        See :func:`swaystride.gait.rating_windows.mean_rating`.
    rules : PatternRules

    Returns
    -------
    DataFrame
        :data:`RUN_OBSERVATIONS`, in the order of `runs`.
    """
    series = _series(affect)
    answers = scores.set_index("run").reindex(runs["run"])
    until = answers["ratings_known_until_s"].to_numpy(dtype=float)
    means = [
        mean_rating(*series[run], warm_up_s, end, mean=mean) if run in series else np.nan
        for run, end in zip(runs["run"], until, strict=True)
    ]
    as_run = runs["duty_factor"].to_numpy(dtype=float)
    at_12 = duty_factor_at_12_km_h(as_run, runs["speed_m_s"].to_numpy(dtype=float), rules)
    patterns = {
        "run_mean": running_patterns(as_run, rules),
        "at_12_km_h": running_patterns(at_12, rules),
    }
    return runs.assign(
        affective_valence=np.asarray(means, dtype=float),
        activity_enjoyment=answers["activity_enjoyment"].to_numpy(dtype=float),
        flow=answers["flow"].to_numpy(dtype=float),
        pattern=pd.Series(patterns[rules.pattern_by], index=runs.index, dtype="str"),
        duty_factor_at_12_km_h=at_12,
        pattern_at_12_km_h=pd.Series(patterns["at_12_km_h"], index=runs.index, dtype="str"),
    )[list(RUN_OBSERVATIONS)]


def window_observations(
    windows: pd.DataFrame, runs: pd.DataFrame, scores: pd.DataFrame, affect: pd.DataFrame
) -> pd.DataFrame:
    """Measures and rating of affect of every window.

    Parameters
    ----------
    windows : DataFrame
        ``run, start_s, stop_s, n_strides`` and the measures.
    runs : DataFrame
        From :func:`run_observations`.
    scores, affect : DataFrame
        See :class:`swaystride.studies.experience.answers.Answers`.

    Returns
    -------
    DataFrame
        :data:`WINDOW_OBSERVATIONS`; the rating is missing where none is known.
    """
    series = _series(affect)
    until = scores.set_index("run")["ratings_known_until_s"]
    edges = windows[["start_s", "stop_s"]].to_numpy(dtype=float)
    rating = np.full(len(windows), np.nan)
    for run, (rated_s, values) in series.items():
        own = (windows["run"] == run).to_numpy()
        rating[own] = window_ratings(
            rated_s, values, edges[own], known_until_s=float(until.loc[run])
        )
    described = runs.set_index("run")
    return windows.assign(
        affective_valence=rating,
        **{name: windows["run"].map(described[name]) for name in ("participant", "pattern")},
    )[list(WINDOW_OBSERVATIONS)]


def pattern_counts(patterns: pd.Series) -> dict[str, int]:
    """Number of runs by pattern, those between the cut-offs and without one included.

    Parameters
    ----------
    patterns : Series of str

    Examples
    --------
    >>> pattern_counts(pd.Series(["aerial", "aerial", "", "intermediate"]))
    {'aerial': 2, 'intermediate': 1, 'terrestrial': 0, 'unknown': 1}
    """
    names = {"aerial": "aerial", "intermediate": "intermediate", "terrestrial": "terrestrial"}
    names["unknown"] = ""
    return {name: int((patterns == value).sum()) for name, value in names.items()}


def _series(affect: pd.DataFrame) -> dict[str, tuple[pd.Series, pd.Series]]:
    """Times and ratings of each run that has any."""
    groups = affect.groupby("run", sort=False)
    return {str(run): (own["time_s"], own["feeling_scale"]) for run, own in groups}
