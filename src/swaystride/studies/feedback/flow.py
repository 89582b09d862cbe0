"""How many participants and trials were planned, recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd


def participant_flow(
    participants: pd.DataFrame, trials: pd.DataFrame, exclusions: pd.DataFrame
) -> list[dict[str, Any]]:
    """Count participants and trials on their way to the analysis.

    Parameters
    ----------
    participants, trials : DataFrame
        As from :func:`swaystride.studies.feedback.design.read_design`.
    exclusions : DataFrame
        Excluded trials with ``participant``, ``trial`` and ``reason``.

    Returns
    -------
    list of dict
        For participants and for trials: ``unit``, ``planned``, ``recorded``, ``excluded`` (list
        of reason and count) and ``analysed``.
    """
    reasons = exclusions["reason"].value_counts(sort=False).sort_index()
    lost = exclusions.groupby("participant").size().reindex(participants["participant"]).fillna(0)
    done = trials.groupby("participant").size().reindex(participants["participant"])
    gone = int((lost == done).sum())
    left_out = [{"reason": "no usable trial", "count": gone}] if gone else []
    return [
        {
            "unit": "participants",
            "planned": None,
            "recorded": len(participants),
            "excluded": left_out,
            "analysed": len(participants) - gone,
        },
        {
            "unit": "trials",
            "planned": None,
            "recorded": len(trials),
            "excluded": [
                {"reason": str(reason), "count": int(count)} for reason, count in reasons.items()
            ],
            "analysed": len(trials) - len(exclusions),
        },
    ]
