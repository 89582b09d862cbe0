"""How many participants, trials and ratings were recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

from swaystride.presentation.participant_flow import flow_line
from swaystride.studies.intensity.design import SELF, TRIALS_PER_EXERCISE, IntensityDesign
from swaystride.studies.intensity.observations import expected_ratings


def study_flow(design: IntensityDesign, exclusions: pd.DataFrame) -> list[dict[str, Any]]:
    """Count on the way to the analysis.

    Parameters
    ----------
    design : IntensityDesign
    exclusions : DataFrame
        Excluded recordings with ``participant``, ``trial`` and ``reason``. Ratings of an excluded
        recording stay: they need no sway.

    Returns
    -------
    list of dict
        For participants, therapists, trials, therapists' ratings and self-ratings: ``unit``,
        ``planned``, ``recorded``, ``excluded`` (list of reason and count), ``analysed``.
    """
    expected = expected_ratings(design)
    own, whole = expected["rater"] == SELF, expected["trial"].isna()
    rated = set(expected.loc[~own & (expected["status"] == "given"), "participant"])
    active = expected.loc[~own & (expected["status"] == "given"), "rater"].nunique()
    exercises = design.trials[["participant", "exercise"]].drop_duplicates()
    reasons = exclusions["reason"].value_counts(sort=False).sort_index()
    people, raters = len(design.participants), len(design.raters)
    return [
        flow_line("participants", people, {"no rating by a therapist": people - len(rated)}),
        flow_line("therapists", raters, {"rated nobody": raters - active}),
        flow_line(
            "trials",
            len(design.trials),
            {str(reason): int(count) for reason, count in reasons.items()},
            planned=TRIALS_PER_EXERCISE * len(exercises),
        ),
        *(
            _rating_unit(name, expected[rows])
            for name, rows in (
                ("ratings of trials", ~own & ~whole),
                ("ratings of exercises", ~own & whole),
                ("self-ratings of trials", own & ~whole),
                ("self-ratings of exercises", own & whole),
            )
        ),
    ]


def _rating_unit(name: str, expected: pd.DataFrame) -> dict[str, Any]:
    """Ratings of one kind: expected, with a row, empty, given."""
    recorded = int((expected["status"] != "no row").sum())
    empty = int((expected["status"] == "empty").sum())
    return flow_line(name, recorded, {"missing rating": empty}, planned=len(expected))
