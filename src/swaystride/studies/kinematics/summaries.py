"""Strides to trials, trials to rows: means, standard deviations and errors of the result tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.kinematics.plan import SIDES, SOURCES

#: What names a trial.
TRIAL_KEYS: Final = ("participant", "trial")

TRIAL_FEATURE_COLUMNS: Final = (
    *TRIAL_KEYS,
    "side",
    "feature",
    "n_strides",
    "optic",
    "erkf",
    "difference",
    "rmsd",
    "rrmsd_pct",
)


def trial_features(strides: pd.DataFrame) -> pd.DataFrame:
    """Features of both sources by trial and side, and how far they lie apart stride by stride.

    Parameters
    ----------
    strides : DataFrame
        One row per stride, source and feature: ``participant``, ``trial``, ``side``, ``stride``,
        ``source``, ``feature``, ``value``.

    Returns
    -------
    DataFrame
        :data:`TRIAL_FEATURE_COLUMNS`: number of strides that both sources have, mean of each
        source, mean of ErKF minus OPTIC, root mean square of the difference over strides, and that
        over the size of the OPTIC mean in percent (dissertation §4.3.4.3).
    """
    keys = [*TRIAL_KEYS, "side", "feature"]
    wide = strides.pivot_table(
        index=[*keys, "stride"], columns="source", values="value", sort=False
    )
    wide = wide.reindex(columns=list(SOURCES)).dropna().reset_index()
    wide["difference"] = wide["erkf"] - wide["optic"]
    wide["squared"] = wide["difference"] ** 2
    table = (
        wide.groupby(keys, sort=False)
        .agg(
            n_strides=("stride", "size"),
            optic=("optic", "mean"),
            erkf=("erkf", "mean"),
            difference=("difference", "mean"),
            rmsd=("squared", "mean"),
        )
        .reset_index()
    )
    table["rmsd"] = np.sqrt(table["rmsd"])
    table["rrmsd_pct"] = 100.0 * table["rmsd"] / table["optic"].abs()
    return table[list(TRIAL_FEATURE_COLUMNS)]


def summary_table(
    trials: pd.DataFrame, key: str, names: Sequence[str], columns: Mapping[str, str]
) -> pd.DataFrame:
    """Mean and standard deviation over trials, in the order of a printed table.

    Parameters
    ----------
    trials : DataFrame
        One row per trial, `key` and ``side``.
    key : str
        Column that names a row beside the side: ``angle``, ``feature`` or ``measure``.
    names : sequence of str
        Its values in the printed order; each has a row per side, right before left.
    columns : mapping of str to str
        Stem of the result columns to the column of `trials`.

    Returns
    -------
    DataFrame
        `key`, ``side``, then ``<stem>_mean`` and ``<stem>_sd`` (n − 1, over trials) of each stem,
        then ``<stem>_se``, the standard error of the mean over participants (their trials are
        averaged first, because trials of one person are alike), and ``n_trials``.
    """
    rows = []
    for name in names:
        for side in SIDES:
            own = trials[(trials[key] == name) & (trials["side"] == side)]
            row: dict[str, object] = {key: name, "side": side}
            for stem, column in columns.items():
                row[f"{stem}_mean"], row[f"{stem}_sd"] = own[column].mean(), own[column].std()
            for stem, column in columns.items():
                row[f"{stem}_se"] = participant_error(own, column)
            row["n_trials"] = len(own)
            rows.append(row)
    return pd.DataFrame(rows)


def participant_error(trials: pd.DataFrame, column: str) -> float:
    """Standard error of a mean over participants, each with the mean of the own trials.

    Parameters
    ----------
    trials : DataFrame
        With ``participant``.
    column : str

    Examples
    --------
    >>> frame = pd.DataFrame({"participant": ["A", "A", "B"], "x": [1.0, 3.0, 4.0]})
    >>> participant_error(frame, "x")
    1.0
    """
    people = trials.groupby("participant", sort=False)[column].mean()
    values = people.dropna().to_numpy(dtype=float)
    return float(values.std(ddof=1) / values.size**0.5) if values.size > 1 else float("nan")
