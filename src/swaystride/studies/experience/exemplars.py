"""Which runs the figures of single runs show, by stated rules."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
import pandas as pd

CONTACT_TIME: Final = "contact_time_s"


def steady_span(strides: pd.DataFrame) -> tuple[float, float]:
    """Begin of the first and end of the last stride that counts.

    Parameters
    ----------
    strides : DataFrame
        ``start_s``, ``stop_s``, ``is_steady``.

    Returns
    -------
    tuple of float
        Seconds; of all strides where none counts.

    Examples
    --------
    >>> table = pd.DataFrame({"start_s": [0.0, 1.0, 2.0], "stop_s": [1.0, 2.0, 3.0],
    ...                       "is_steady": [False, True, True]})
    >>> steady_span(table)
    (1.0, 3.0)
    """
    own = strides[strides["is_steady"].to_numpy(dtype=bool)]
    own = own if len(own) else strides
    return float(own["start_s"].min()), float(own["stop_s"].max())


def duty_factor_changes(strides: pd.DataFrame) -> tuple[float, float]:
    """How much the duty factor changes in the warm-up, and after it.

    Parameters
    ----------
    strides : DataFrame
        Of one run: ``start_s``, ``stop_s``, ``duty_factor``, ``is_steady``.

    Returns
    -------
    tuple of float
        Size of the change from the first third of the warm-up to the first third of the steady
        part, and from that to the last third of the steady part; zero where there is no stride.
    """
    begin_s, end_s = steady_span(strides)
    third_s = (end_s - begin_s) / 3.0
    start = strides["start_s"]
    warm = strides.loc[start < begin_s / 3.0, "duty_factor"].mean()
    first = strides.loc[start.between(begin_s, begin_s + third_s), "duty_factor"].mean()
    last = strides.loc[start >= end_s - third_s, "duty_factor"].mean()
    early, late = np.nan_to_num([abs(first - warm), abs(last - first)])
    return float(early), float(late)


def four_runs(strides: Mapping[str, pd.DataFrame]) -> list[str]:
    """Runs of Figure 5.2: two that change in the warm-up, one that changes after it, one that does not.

    Parameters
    ----------
    strides : mapping of str to DataFrame
        By run.

    Returns
    -------
    list of str
        The two largest changes in the warm-up, of the others the largest change after it, and of
        the rest the smallest sum; fewer if there are fewer runs.
    """
    changes = {run: duty_factor_changes(table) for run, table in strides.items()}
    left = sorted(changes, key=lambda run: -changes[run][0])
    chosen, left = left[:2], left[2:]
    if left:
        later = max(left, key=lambda run: changes[run][1])
        chosen.append(later)
        left.remove(later)
    if left:
        chosen.append(min(left, key=lambda run: sum(changes[run])))
    return chosen


def most_rated_run(affect: pd.DataFrame, runs: list[str]) -> str:
    """Run of Figure 5.3: the one whose rating changes most often, the first of equal ones.

    Parameters
    ----------
    affect : DataFrame
        ``run``, ``time_s``, ``feeling_scale``.
    runs : list of str
        To choose from.
    """
    ordered = affect.sort_values("time_s", kind="stable")
    changes = ordered.groupby("run")["feeling_scale"].agg(lambda own: int((own.diff() != 0).sum()))
    counts = {run: int(changes.get(run, 0)) for run in runs}
    return max(runs, key=lambda run: counts[run])


def confounded_run(within: pd.DataFrame) -> pd.Series[Any] | None:
    """Run of Figure 5.9: the largest positive correlation of contact time and affect.

    Parameters
    ----------
    within : DataFrame
        ``run``, ``measure``, ``r``, ``ci_low``, ``ci_high``.

    Returns
    -------
    Series or None
        Its row: of the significant positive ones the one that keeps least when time is held
        constant, else the largest; None where no run has an estimate.
    """
    own = within[(within["measure"] == CONTACT_TIME) & within["r"].notna()]
    if own.empty:
        return None
    positive = own[own["ci_low"] > 0]
    if len(positive) and "r_partial" in positive and positive["r_partial"].notna().any():
        lost = (positive["r"] - positive["r_partial"]).fillna(-np.inf)
        return positive.iloc[int(lost.to_numpy(dtype=float).argmax())]
    return own.iloc[int(own["r"].to_numpy(dtype=float).argmax())]
