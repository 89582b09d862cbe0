"""Result tables of the study, in the rows and columns of the printed ones (table contract)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.intensity.design import SELF, IntensityDesign
from swaystride.studies.intensity.plan import (
    DIMENSIONS,
    FEATURES,
    RATING_LEVELS,
    TRANSFORMS,
)

#: Quantities of the running text, in the order of study3_text.csv.
TEXT_QUANTITIES: Final = (
    "icc_pt_per_trial",
    "icc_pt_per_exercise",
    "spearman_self_vs_pt_per_exercise",
    "pt_minus_self_mean_difference_per_trial",
    "pt_minus_self_mean_difference_per_exercise",
    "difference_sd_per_trial",
    "difference_sd_per_exercise",
    "pt_minus_self_between_trial_variance_difference",
    "self_predicts_pt_accuracy_per_trial_percent",
    "self_predicts_pt_accuracy_per_exercise_percent",
    "self_5_agrees_with_pt_per_trial_percent",
    "self_5_agrees_with_pt_per_exercise_percent",
    "self_4_is_pt_5_per_trial_percent",
    "self_4_is_pt_5_per_exercise_percent",
    "spearman_kinematics_vs_pt_per_trial",
    "spearman_kinematics_vs_pt_per_exercise",
    "kinematics_predicts_pt_accuracy_per_trial_percent",
    "kinematics_predicts_pt_accuracy_per_exercise_percent",
    "kinematics_5_agrees_with_pt_per_exercise_percent",
    "kinematics_4_is_pt_5_per_exercise_percent",
    "kinematics_4_is_pt_4_per_exercise_percent",
)

#: What the five levels mean, in our own words (Table 3.1 has the wording that raters saw).
SCALE_LEVELS: Final = (
    (1, "firm and sure on my feet", "stands alone, still"),
    (2, "slightly shaky", "sways a little; somebody should be near"),
    (3, "shaky enough to fear a loss of balance", "sways clearly; somebody must be close"),
    (4, "sure that balance will be lost", "needs a hand or a step, but not in the first half"),
    (5, "balance was lost", "steps out in the first half, or cannot be held"),
)

_EXTRA: Final = ("se", "df", "n", "participant_ci_low", "participant_ci_high")


def table_3_1() -> pd.DataFrame:
    """The five levels of the scale, for patients and for therapists."""
    return pd.DataFrame(
        SCALE_LEVELS, columns=["rating", "for_balance_participants", "for_therapists"]
    )


def table_3_2(results: pd.DataFrame) -> pd.DataFrame:
    """Effects of the four dimensions of difficulty.

    Parameters
    ----------
    results : DataFrame
        From :func:`swaystride.studies.intensity.difficulty.difficulty`.

    Returns
    -------
    DataFrame
        ``aspect, rating, estimate, ci_low, ci_high, p`` as printed, then ``se``, ``df``, ``n`` and
        the participant-level interval.
    """
    keys = [(d, level) for level in RATING_LEVELS for d in DIMENSIONS]
    rows = _chosen(results, [f"table_3_2/{d}/{level}" for d, level in keys])
    rows.insert(0, "aspect", [d for d, _ in keys])
    rows.insert(1, "rating", [level for _, level in keys])
    return rows[["aspect", "rating", "estimate", "ci_low", "ci_high", "p", *_EXTRA]]


def table_3_3(results: pd.DataFrame) -> pd.DataFrame:
    """Marginal correlations of the features with the ratings of trials.

    Parameters
    ----------
    results : DataFrame
        From :func:`swaystride.studies.intensity.kinematics.correlations`.

    Returns
    -------
    DataFrame
        ``feature, transform, r, p`` as printed, then both intervals and ``n``.
    """
    keys = [(feature, transform) for transform in TRANSFORMS for feature in FEATURES]
    rows = _chosen(results, [f"table_3_3/{feature}/{transform}" for feature, transform in keys])
    rows.insert(0, "feature", [feature for feature, _ in keys])
    rows.insert(1, "transform", [transform for _, transform in keys])
    rows = rows.rename(columns={"estimate": "r"})
    intervals = ["ci_low", "ci_high", "participant_ci_low", "participant_ci_high"]
    return rows[["feature", "transform", "r", "p", *intervals, "n"]]


def study3_text(results: pd.DataFrame) -> pd.DataFrame:
    """All numbers of the running text.

    Parameters
    ----------
    results : DataFrame
        Of reliability, self-ratings and predictions together.

    Returns
    -------
    DataFrame
        ``quantity, value, ci_low, ci_high, p`` as printed, then ``se``, ``df``, ``n`` and the
        participant-level interval.
    """
    rows = _chosen(results, [f"study3_text/{name}" for name in TEXT_QUANTITIES])
    rows.insert(0, "quantity", list(TEXT_QUANTITIES))
    rows = rows.rename(columns={"estimate": "value"})
    return rows[["quantity", "value", "ci_low", "ci_high", "p", *_EXTRA]]


def cohort_table(design: IntensityDesign) -> pd.DataFrame:
    """Who took part: patients by group, and therapists.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``group``, ``n``, ``n_female``, ``age_mean``, ``age_sd``, ``experience_mean``,
        ``experience_sd``; standard deviations are divided by n − 1.
    """
    people = design.participants
    rows: list[dict[str, object]] = []
    for group, own in people.groupby("group", sort=True):
        rows.append(
            {
                "group": str(group),
                "n": len(own),
                "n_female": int((own["sex"] == "F").sum()),
                "age_mean": own["age_years"].mean(),
                "age_sd": own["age_years"].std(),
            }
        )
    experience = design.raters["experience_years"]
    rows.append(
        {
            "group": "therapists",
            "n": len(design.raters),
            "experience_mean": experience.mean(),
            "experience_sd": experience.std(),
        }
    )
    columns = ["group", "n", "n_female", "age_mean", "age_sd", "experience_mean", "experience_sd"]
    return pd.DataFrame(rows, columns=columns).astype({"n_female": "Int64"})


def rating_counts(design: IntensityDesign) -> pd.DataFrame:
    """How many ratings of each kind there are, and how they are spread over the scale.

    Parameters
    ----------
    design : IntensityDesign

    Returns
    -------
    DataFrame
        ``rating`` (kind), ``rater``, ``n``, ``pairs`` (of patient and rater), and the share of
        each level in percent.
    """
    ratings = design.ratings[design.ratings["rating"].notna()]
    rows: list[dict[str, object]] = []
    for level in RATING_LEVELS:
        kind = ratings["trial"].isna() == (level == "per_exercise")
        for who in ("therapists", SELF):
            own = ratings[kind & ((ratings["rater"] == SELF) == (who == SELF))]
            shares = own["rating"].astype(int).value_counts(normalize=True)
            rows.append(
                {
                    "rating": level,
                    "rater": who,
                    "n": len(own),
                    "pairs": len(own[["participant", "rater"]].drop_duplicates()),
                    **{f"share_{k}": 100.0 * float(shares.get(k, 0.0)) for k in range(1, 6)},
                }
            )
    return pd.DataFrame(rows)


def coverage_table(
    tables: dict[str, pd.DataFrame], printed: dict[str, pd.DataFrame]
) -> pd.DataFrame:
    """How many printed values lie within the two kinds of intervals of this cohort.

    Parameters
    ----------
    tables : dict of str to DataFrame
        ``table_3_2``, ``table_3_3`` and ``study3_text`` of this cohort.
    printed : dict of str to DataFrame
        The same as printed.

    Returns
    -------
    DataFrame
        ``table``, ``n``, ``in_model_ci``, ``n_model_ci``, ``in_participant_ci``.
    """
    value = {"table_3_2": "estimate", "table_3_3": "r", "study3_text": "value"}
    rows = []
    for name, table in tables.items():
        target = printed[name][value[name]].to_numpy(dtype=float)
        inside = {}
        for kind in ("", "participant_"):
            low, high = (
                table[f"{kind}ci_low"].to_numpy(float),
                table[f"{kind}ci_high"].to_numpy(float),
            )
            inside[kind] = int(((low <= target) & (target <= high)).sum())
        rows.append(
            {
                "table": name,
                "n": len(table),
                "n_model_ci": int(table["ci_low"].notna().sum()),
                "in_model_ci": inside[""],
                "n_participant_ci": int(table["participant_ci_low"].notna().sum()),
                "in_participant_ci": inside["participant_"],
            }
        )
    return pd.DataFrame(rows)


def _chosen(results: pd.DataFrame, keys: list[str]) -> pd.DataFrame:
    """Rows of these quantities, in this order; a quantity that is missing is empty."""
    rows = results.set_index("quantity").reindex(keys).reset_index(drop=True)
    return rows.replace({np.inf: np.nan})
