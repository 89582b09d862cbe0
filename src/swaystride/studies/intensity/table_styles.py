"""Captions, notes and number formats of the tables of this study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from swaystride.presentation.table_style import TableStyle

_TWO_INTERVALS: Final = (
    "ci: interval of the printed model; participant_ci: 95 % interval over patients, who alone "
    "were drawn at random."
)

_FORMATS: Final[Mapping[str, str | int]] = {
    "p": "p:6",
    "se": "number:4:7",
    "df": 1,
    "n": "integer",
}


def _numbers(*columns: str) -> dict[str, str | int]:
    """Three decimals for people, more in the CSV: differences to the print are taken from it."""
    limits = ("ci_low", "ci_high", "participant_ci_low", "participant_ci_high")
    return {column: _FORMATS.get(column, "number:3:6") for column in (*columns, *limits, "n")}


TABLE_STYLES: Final = {
    "table_3_1": TableStyle(
        "Table 3.1. The five levels of the rating scale, in our own words.",
        (),
        {"rating": "integer"},
    ),
    "table_3_2": TableStyle(
        "Table 3.2. Linear relationship between the therapists' ratings and the difficulty of the "
        "exercise, one dimension at a time.",
        (_TWO_INTERVALS,),
        _numbers("estimate", "p", "se", "df"),
    ),
    "table_3_3": TableStyle(
        "Table 3.3. Marginal correlation of each feature of sway with the ratings of trials.",
        (_TWO_INTERVALS,),
        _numbers("r", "p"),
    ),
    "study3_text": TableStyle(
        "Numbers of the running text of chapter 3.",
        (_TWO_INTERVALS, "Shares and accuracies are in percent."),
        _numbers("value", "p", "se", "df"),
    ),
    "cohort": TableStyle(
        "Patients and therapists.",
        ("Standard deviations are divided by n − 1.",),
        {
            "n": "integer",
            "n_female": "integer",
            "age_mean": 1,
            "age_sd": 1,
            "experience_mean": 1,
            "experience_sd": 1,
        },
    ),
    "rating_counts": TableStyle(
        "Ratings of each kind, and their distribution over the scale in percent.",
        (),
        {"n": "integer", "pairs": "integer", **{f"share_{k}": 1 for k in range(1, 6)}},
    ),
    "variance_components": TableStyle(
        "Variance components of the therapists' ratings, in both forms of the decomposition.",
        ("The ICC is the share of the components that do not contain the rater.",),
        {"variance": 4, "share": 3, "icc": 3},
    ),
    "prediction": TableStyle(
        "Ratings predicted from sway and from self-ratings: in sample, as printed, and for patients "
        "left out of the fit.",
        (
            "Percentages are shares of ratings; predicted_4_is_pt_5: of those predicted as 4, rated 5.",
            "participant_ci: 95 % interval over patients; the prediction is fitted anew in each "
            "resample.",
        ),
        {
            **{
                f"{kind}{end}": "number:3:6"
                for kind in ("in_sample", "left_out")
                for end in ("", "_participant_ci_low", "_participant_ci_high")
            },
            "n": "integer",
        },
    ),
    "dropped_features": TableStyle(
        "Features that the prediction dropped because the others determine them.",
    ),
    "coverage": TableStyle(
        "Printed values that lie within the intervals of this cohort.",
        (),
        {
            "n": "integer",
            "n_model_ci": "integer",
            "in_model_ci": "integer",
            "n_participant_ci": "integer",
            "in_participant_ci": "integer",
        },
    ),
    "claims": TableStyle("Claims of the chapter's prose, and what this cohort shows."),
    "truth": TableStyle(
        "Results of the simulated cohort beside the values of the population that it was drawn from.",
        ("One cohort of ten patients scatters widely; see results/recovery for many cohorts.",),
        {
            "population": "number:3:6",
            "estimate": "number:3:6",
            "participant_ci_low": "number:3:6",
            "participant_ci_high": "number:3:6",
        },
    ),
}
