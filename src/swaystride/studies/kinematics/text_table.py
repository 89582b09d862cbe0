"""Numbers of the running text of the chapter, from this cohort."""

from __future__ import annotations

import numpy as np
import pandas as pd

from swaystride.studies.kinematics.representative import representative_trial, trial_rows
from swaystride.studies.kinematics.summaries import TRIAL_KEYS

#: Kilometres per hour in a metre per second.
_KM_H_PER_M_S = 3.6


def study4_text(
    planned: pd.DataFrame,
    strides: pd.DataFrame,
    agreement: pd.DataFrame,
    planar: pd.DataFrame,
    course: pd.DataFrame,
    energy_window_s: float | None,
) -> pd.DataFrame:
    """The quantities of ``study4_text.csv``, each by a stated rule.

    Parameters
    ----------
    planned : DataFrame
        ``participant`` and ``trial`` of every trial that the lab lists, once each.
    strides : DataFrame
        One row per counted stride, source and feature.
    agreement : DataFrame
        One row per analysed trial, side and angle.
    planar : DataFrame
        ``participant``, ``trial``, ``trio``, ``mean_deg``, ``sd_deg``.
    course : DataFrame
        From :func:`swaystride.studies.kinematics.course.trial_course`, with participant and trial.
    energy_window_s : float or None
        Window of the gyroscopic energy; None where another rule finds midstance.

    Returns
    -------
    DataFrame
        ``quantity, value, sd, unit`` as printed, then ``rule``.
    """
    counted = strides.drop_duplicates([*TRIAL_KEYS, "side", "stride"])
    analysed = agreement.drop_duplicates(list(TRIAL_KEYS))
    chosen = trial_rows(counted, *representative_trial(agreement))
    feet = chosen.groupby("side")["stride"].nunique()
    nan = float("nan")
    rows = [
        *(
            (f"planar_angle_{segment}", *_planar(planar, segment), "deg",
             "mean over trials and sides; sd: mean of the standard deviations within a trial")
            for segment in ("thigh", "shank", "foot")
        ),
        ("participants", planned["participant"].nunique(), nan, "", "listed by the lab"),
        ("trials_per_participant", planned.groupby("participant").size().max(), nan, "",
         "listed by the lab"),
        ("trials_excluded", len(planned) - len(analysed), nan, "", "listed but not analysed"),
        ("trials_analysed", len(analysed), nan, "", "with both sources"),
        ("strides_discarded_at_start", counted["stride"].min() - 1, nan, "", "of each foot"),
        ("gait_cycles_of_the_representative_trial", feet.min() if len(feet) else nan, nan, "",
         "of the foot that has fewer"),
        ("strides_analysed_more_than", len(counted), nan, "", "of both feet, all trials"),
        ("treadmill_speed", _KM_H_PER_M_S * course["belt_speed_m_s"].mean(), nan, "km/h",
         "mean over trials"),
        ("minimum_midstance_samples_per_stride", course["midstance_samples_per_stride"].min(), nan,
         "", "zero-velocity samples of a counted stride, mean of a foot's trial; smallest"),
        ("gyroscopic_energy_window", nan if energy_window_s is None else energy_window_s, nan, "s",
         "as configured; missing where another rule finds midstance"),
    ]  # fmt: skip
    table = pd.DataFrame(rows, columns=["quantity", "value", "sd", "unit", "rule"])
    return table.astype({"value": float, "sd": float})


def _planar(planar: pd.DataFrame, segment: str) -> tuple[float, float]:
    """Mean planar angle of a segment and its scatter within trials, degrees."""
    own = planar[planar["trio"].str.endswith(f"_{segment}")]
    if own.empty:
        return np.nan, np.nan
    return float(own["mean_deg"].mean()), float(own["sd_deg"].mean())
