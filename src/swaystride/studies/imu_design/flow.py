"""How many participants, trials and recordings were recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

from swaystride.presentation.participant_flow import flow_line
from swaystride.studies.imu_design.design import FEET, IMUS, KEYS, ImuDesign


def study_flow(
    design: ImuDesign, exclusions: pd.DataFrame, measured: pd.DataFrame
) -> list[dict[str, Any]]:
    """Count on the way to the analysis.

    Parameters
    ----------
    design : ImuDesign
    exclusions : DataFrame
        Recordings left out by the import: ``participant``, ``trial``, ``foot``, ``imu``, ``reason``.
    measured : DataFrame
        Recordings that were measured, with ``reason``: empty, or why the measures are not used
        (:func:`swaystride.studies.imu_design.observations.recording_verdicts`).

    Returns
    -------
    list of dict
        For participants, trials and recordings: ``unit``, ``planned``, ``recorded``, ``excluded``
        (list of reason and count), ``analysed``.
    """
    used = measured[measured["reason"] == ""]
    trials = design.trials[["participant", "trial"]].drop_duplicates()
    kept_trials = used[["participant", "trial"]].drop_duplicates()
    people, kept_people = len(design.participants), used["participant"].nunique()
    left_out = pd.concat([exclusions["reason"], measured.loc[measured["reason"] != "", "reason"]])
    reasons = {str(reason): int(n) for reason, n in left_out.value_counts().sort_index().items()}
    return [
        flow_line("participants", people, {"no usable trial": people - kept_people}),
        flow_line("trials", len(trials), {"no usable recording": len(trials) - len(kept_trials)}),
        flow_line(
            "recordings",
            len(design.trials[list(KEYS)]),
            reasons,
            planned=len(trials) * len(FEET) * len(IMUS),
        ),
    ]
