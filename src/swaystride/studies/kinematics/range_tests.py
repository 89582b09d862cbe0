"""Table 4.4: ranges of motion of both sources, and whether they differ."""

from __future__ import annotations

import numpy as np
import pandas as pd
from scipy.special import stdtr

from swaystride.errors import ModelError
from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.stats.multiple_tests import holm
from swaystride.studies.kinematics.plan import POOR_OPTICAL_ANGLES, RANGE_ANGLES, SIDES
from swaystride.studies.kinematics.summaries import participant_error
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.tables import range_features


def table_4_4(strides: pd.DataFrame, printed: pd.DataFrame, options: TableOptions) -> pd.DataFrame:
    """Ranges of motion beside the published comparison, with a test of their difference.

    The source does not name its test: a paired t-test over trials fills ``significant``. Two
    trials of one runner are alike, though, so a mixed model of the difference with an intercept of
    the runner stands behind it (``p_mixed``), and Holm's correction for the eighteen tests
    (``p_holm``).

    Parameters
    ----------
    strides : DataFrame
        One row per stride, source and feature.
    printed : DataFrame
        The printed table: its reference columns are literature and are copied.
    options : TableOptions

    Returns
    -------
    DataFrame
        Columns as printed, then ``difference_deg`` (ErKF − OPTIC), ``t``, ``df``, ``p``,
        ``p_holm``, ``p_mixed``, ``df_mixed``, standard errors over participants and counts.
    """
    trials = range_features(strides)
    reference = printed.set_index(["angle", "side"])
    rows = []
    for angle in RANGE_ANGLES:
        for side in SIDES:
            own = trials[(trials["angle"] == angle) & (trials["side"] == side)]
            test = paired_test(own)
            row: dict[str, object] = {"angle": angle, "side": side}
            for part in ("mean", "sd"):
                name = f"reference_deg_{part}"
                row[name] = reference.loc[(angle, side), name]
            for source in ("optic", "erkf"):
                row[f"{source}_deg_mean"] = own[source].mean()
                row[f"{source}_deg_sd"] = own[source].std()
            row["optic_poor"] = int(angle in POOR_OPTICAL_ANGLES)
            row["significant"] = int(test["p"] < options.significance_level)
            row["difference_deg"] = own["difference"].mean()
            row |= test
            row |= mixed_test(own)
            for source in ("optic", "erkf"):
                row[f"{source}_deg_se"] = participant_error(own, source)
            row["n_trials"], row["n_participants"] = len(own), own["participant"].nunique()
            rows.append(row)
    table = pd.DataFrame(rows)
    after_p = list(table).index("p") + 1
    table.insert(after_p, "p_holm", holm(table["p"].to_numpy(dtype=float)))
    return table


def paired_test(trials: pd.DataFrame) -> dict[str, float]:
    """Student's t of ErKF against OPTIC, paired by trial.

    Parameters
    ----------
    trials : DataFrame
        ``optic`` and ``erkf``, one row per trial.

    Returns
    -------
    dict
        ``t``, ``df``, ``p``; missing with fewer than two trials, or if all differ by the same.

    Examples
    --------
    >>> frame = pd.DataFrame({"optic": [1.0, 2.0, 3.0], "erkf": [2.0, 4.0, 6.0]})
    >>> {name: round(x, 3) for name, x in paired_test(frame).items()}
    {'t': 3.464, 'df': 2.0, 'p': 0.074}
    """
    difference = (trials["erkf"] - trials["optic"]).to_numpy(dtype=float)
    if difference.size < 2 or np.ptp(difference) == 0.0:
        return {"t": np.nan, "df": np.nan, "p": np.nan}
    df = difference.size - 1
    t = difference.mean() / (difference.std(ddof=1) / np.sqrt(difference.size))
    return {"t": float(t), "df": float(df), "p": float(2.0 * stdtr(df, -abs(t)))}


def mixed_test(trials: pd.DataFrame) -> dict[str, float]:
    """Intercept of the difference in a mixed model with an intercept of the runner.

    Parameters
    ----------
    trials : DataFrame
        ``participant`` and ``difference``, one row per trial.

    Returns
    -------
    dict
        ``p_mixed`` and Satterthwaite's ``df_mixed``; missing where such a model cannot be fitted
        (one runner, one trial each, or no scatter).
    """
    missing = {"p_mixed": np.nan, "df_mixed": np.nan}
    counts = trials["participant"].value_counts()
    if len(counts) < 2 or counts.max() < 2 or np.ptp(trials["difference"].to_numpy()) == 0.0:
        return missing
    try:
        fit = fit_mixed_model("difference ~ 1 + (1|participant)", trials, reml=True)
        row = fit.fixed_effects(df="satterthwaite").iloc[0]
    except ModelError:
        return missing
    return {"p_mixed": float(row["p"]), "df_mixed": float(row["df"])}
