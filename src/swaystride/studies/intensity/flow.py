"""How many participants, trials and ratings were recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

from swaystride.studies.intensity.design import SELF, IntensityDesign


def study_flow(design: IntensityDesign, exclusions: pd.DataFrame) -> list[dict[str, Any]]:
    """Count on the way to the analysis.

    Parameters
    ----------
    design : IntensityDesign
    exclusions : DataFrame
        Excluded recordings with ``participant``, ``trial`` and ``reason``.

    Returns
    -------
    list of dict
        For participants, therapists, trials, therapists' ratings and self-ratings: ``unit``,
        ``planned``, ``recorded``, ``excluded`` (list of reason and count), ``analysed``.
    """
    ratings = design.ratings
    own = ratings["rater"] == SELF
    whole = ratings["trial"].isna()
    active = ratings.loc[~own & ratings["rating"].notna(), "rater"].nunique()
    lost = exclusions.groupby("participant").size()
    done = design.trials.groupby("participant").size()
    gone = int((lost.reindex(done.index).fillna(0) == done).sum())
    reasons = exclusions["reason"].value_counts(sort=False).sort_index()
    return [
        _unit("participants", len(done), {"no usable trial": gone}),
        _unit("therapists", len(design.raters), {"rated nobody": len(design.raters) - active}),
        _unit("trials", len(design.trials), {str(k): int(n) for k, n in reasons.items()}),
        *(
            _unit(name, int(rows.sum()), {"missing": int(ratings.loc[rows, "rating"].isna().sum())})
            for name, rows in (
                ("ratings of trials", ~own & ~whole),
                ("ratings of exercises", ~own & whole),
                ("self-ratings of trials", own & ~whole),
                ("self-ratings of exercises", own & whole),
            )
        ),
    ]


def _unit(name: str, recorded: int, excluded: dict[str, int]) -> dict[str, Any]:
    """One line of the flow; reasons without a case are left out."""
    return {
        "unit": name,
        "planned": None,
        "recorded": recorded,
        "excluded": [{"reason": reason, "count": n} for reason, n in excluded.items() if n],
        "analysed": recorded - sum(excluded.values()),
    }
