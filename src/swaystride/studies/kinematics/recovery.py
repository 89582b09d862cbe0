"""How well a simulated cohort's joint angles and strides are recovered, variant by variant.

Unlike a mixed model's effects, every trial has a truth of its own: the spread is over the trials of
one cohort, not over cohorts.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.kinematics.plan import RANGE_ANGLES, SIDES
from swaystride.studies.kinematics.summaries import TRIAL_KEYS

RECOVERY_COLUMNS: Final = (
    "variant",
    "quantity",
    "truth",
    "mean",
    "bias",
    "empirical_sd",
    "model_se",
    "coverage",
    "n_cohorts",
    "n_trials",
    "rmsd_after_constant",
)


def recovery_table(truth: pd.DataFrame, strides: pd.DataFrame, variant: str) -> pd.DataFrame:
    """Errors of the filter in one variant.

    Parameters
    ----------
    truth : DataFrame
        Errors of angles by trial: ``source``, ``side``, ``angle``, ``bias_deg``,
        ``rmsd_trial_deg``, ``coverage_95``.
    strides : DataFrame
        ``source``, ``measure``, ``side``, ``estimate``, ``truth`` of every stride.
    variant : str

    Returns
    -------
    DataFrame
        :data:`RECOVERY_COLUMNS`. For an angle ``<side>/<angle>_deg`` the bias, its standard
        deviation over trials, the share of the truth within the filter's 95 % band, and the RMSD
        after one constant. For a stride measure the means over trials, bias and standard
        deviation of the trials' biases.
    """
    rows: list[dict[str, object]] = []
    filtered = truth[truth["source"] == "erkf"]
    for angle in RANGE_ANGLES:
        for side in SIDES:
            own = filtered[(filtered["angle"] == angle) & (filtered["side"] == side)]
            rows.append(
                {
                    "quantity": f"{side}/{angle}_deg",
                    "bias": own["bias_deg"].mean(),
                    "empirical_sd": own["bias_deg"].std(),
                    "coverage": own["coverage_95"].mean(),
                    "n_trials": len(own),
                    "rmsd_after_constant": own["rmsd_trial_deg"].mean(),
                }
            )
    own_strides = strides[(strides["source"] == "erkf") & strides["estimate"].notna()]
    for (measure, foot), own in own_strides.groupby(["measure", "side"], sort=False):
        trials = own.groupby(list(TRIAL_KEYS), sort=False)[["estimate", "truth"]].mean()
        bias = trials["estimate"] - trials["truth"]
        rows.append(
            {
                "quantity": f"{foot}/{measure}",
                "truth": trials["truth"].mean(),
                "mean": trials["estimate"].mean(),
                "bias": bias.mean(),
                "empirical_sd": bias.std(),
                "n_trials": len(trials),
            }
        )
    table = pd.DataFrame(rows).assign(variant=variant, n_cohorts=1)
    return table.reindex(columns=list(RECOVERY_COLUMNS), fill_value=np.nan)
