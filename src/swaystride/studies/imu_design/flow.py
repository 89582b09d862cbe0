"""How many participants, trials and recordings were recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

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
        _unit("participants", people, {"no usable trial": people - kept_people}),
        _unit("trials", len(trials), {"no usable recording": len(trials) - len(kept_trials)}),
        _unit(
            "recordings",
            len(design.trials[list(KEYS)]),
            reasons,
            planned=len(trials) * len(FEET) * len(IMUS),
        ),
    ]


def _unit(
    name: str, recorded: int, excluded: dict[str, int], *, planned: int | None = None
) -> dict[str, Any]:
    """One line of the flow; reasons without a case are left out."""
    return {
        "unit": name,
        "planned": planned,
        "recorded": recorded,
        "excluded": [{"reason": reason, "count": n} for reason, n in excluded.items() if n],
        "analysed": recorded - sum(excluded.values()),
    }
