"""Many simulated cohorts, from raw files to slopes, beside the printed Tables A1 to A4.

Nobody knows the true slopes: the simulator puts in feet and sensors, not errors. The mean over the
cohorts stands for them where the model's standard errors and intervals are judged.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final, Literal

import numpy as np
import pandas as pd

from swaystride.studies.imu_design.experiments import ExperimentName
from swaystride.studies.imu_design.plan import SLOPE, TABLES

Expectation = Literal["negative", "degrades", "unchanged"]

#: What every simulated cohort should show: the conclusions of the paper that do not hang on the
#: scatter of single trials (its own power for 24 g, 750 °/s and 62.5 Hz is about a half).
EXPECTATIONS: Final[Mapping[tuple[str, str], Expectation]] = {
    ("table_a1", "baseline_100g"): "negative",
    ("table_a1", "75g"): "unchanged",
    ("table_a1", "50g"): "unchanged",
    ("table_a1", "16g"): "degrades",
    ("table_a1", "10g"): "degrades",
    ("table_a1", "6g"): "degrades",
    ("table_a2", "baseline_2000dps"): "negative",
    ("table_a2", "1500dps"): "unchanged",
    ("table_a2", "1000dps"): "unchanged",
    ("table_a2", "500dps"): "degrades",
    ("table_a3", "baseline_1000hz"): "negative",
    ("table_a4", "baseline_1000hz"): "negative",
    ("table_a4", "500hz"): "unchanged",
    ("table_a4", "250hz"): "unchanged",
    ("table_a4", "125hz"): "unchanged",
    ("table_a4", "62.5hz"): "unchanged",
}

#: Expectations that the simulated feet do not meet, with the reason: they count as explained.
KNOWN_DEVIATIONS: Final[Mapping[str, str]] = {
    "table_a1/16g": "peaks of acceleration stay below those of the paper, because the ringing of "
    "strap and shoe is not simulated: the slope is two thirds of the printed one",
}

#: Share of the cohorts that must show it.
SHARE_EXPECTED: Final = 0.8

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
    "printed",
    "mean_minus_printed",
    "share_significant",
    "share_as_expected",
    "within",
)


def slopes_by_seed(
    cohorts: pd.DataFrame, printed: Mapping[str, pd.DataFrame], model: str
) -> pd.DataFrame:
    """Slopes of every cohort beside the printed ones.

    Parameters
    ----------
    cohorts : DataFrame
        Effects of all cohorts (:func:`swaystride.studies.imu_design.models.effects`) with ``seed``.
    printed : mapping of str to DataFrame
        Tables A1 to A4 as printed, by name.
    model : str
        Which of the two models.

    Returns
    -------
    DataFrame
        ``table``, ``effect``, ``printed``, then one column per seed.
    """
    own = cohorts[cohorts["model"] == model]
    rows = []
    for experiment, table in TABLES.items():
        wide = _wide(own, experiment, SLOPE)
        known = printed[table].set_index("effect")[SLOPE]
        for effect in wide.columns:
            first = {"table": table, "effect": effect, "printed": known.get(effect, np.nan)}
            rows.append({**first, **{f"seed_{seed}": x for seed, x in wide[effect].items()}})
    return pd.DataFrame(rows)


def recovery_table(
    cohorts: pd.DataFrame, printed: Mapping[str, pd.DataFrame], alpha: float
) -> pd.DataFrame:
    """Mean, scatter, standard errors and coverage of every slope, under both models.

    Parameters
    ----------
    cohorts : DataFrame
        Effects of all cohorts with ``seed``.
    printed : mapping of str to DataFrame
        Tables A1 to A4 as printed.
    alpha : float
        Significance level.

    Returns
    -------
    DataFrame
        :data:`RECOVERY_COLUMNS`. ``truth`` and ``bias`` are empty; ``coverage`` is the share of the
        cohorts whose interval holds the mean over the cohorts; ``within`` is ``yes``, ``no`` or
        ``explained`` (:data:`KNOWN_DEVIATIONS`) for the printed model where :data:`EXPECTATIONS`
        say what must be seen, else ``reported``.
    """
    rows = []
    for model in cohorts["model"].unique():
        own = cohorts[cohorts["model"] == model]
        for experiment, table in TABLES.items():
            parts = {
                name: _wide(own, experiment, name)
                for name in (SLOPE, "se", "p", "ci_low", "ci_high")
            }
            known = printed[table].set_index("effect")[SLOPE]
            for effect in parts[SLOPE].columns:
                columns = {name: part[effect] for name, part in parts.items()}
                expected = EXPECTATIONS.get((table, effect)) if model == "subject" else None
                quantity = f"{table}/{effect}"
                row = {
                    "variant": f"printed, {model.replace('_', ' ')}",
                    "quantity": quantity,
                    **_summary(columns, float(known.get(effect, np.nan)), alpha, expected),
                }
                if row["within"] == "no" and quantity in KNOWN_DEVIATIONS:
                    row["within"] = "explained"
                rows.append(row)
    return pd.DataFrame(rows, columns=list(RECOVERY_COLUMNS))


def _summary(
    columns: Mapping[str, pd.Series], printed: float, alpha: float, expected: Expectation | None
) -> dict[str, object]:
    """One slope over the cohorts."""
    slope, p = columns[SLOPE], columns["p"]
    mean = float(slope.mean())
    significant = p < alpha
    shown = {
        "negative": slope < 0,
        "degrades": significant & (slope < 0),
        "unchanged": ~significant,
        None: None,
    }[expected]
    share = float("nan") if shown is None else float(shown.mean())
    verdict = "reported" if shown is None else "yes" if share >= SHARE_EXPECTED else "no"
    return {
        "truth": float("nan"),
        "mean": mean,
        "bias": float("nan"),
        "empirical_sd": float(slope.std()),
        "model_se": float(columns["se"].mean()),
        "coverage": float(((columns["ci_low"] <= mean) & (mean <= columns["ci_high"])).mean()),
        "n_cohorts": len(slope),
        "printed": printed,
        "mean_minus_printed": mean - printed,
        "share_significant": float(significant.mean()),
        "share_as_expected": share,
        "within": verdict,
    }


def _wide(cohorts: pd.DataFrame, experiment: ExperimentName, column: str) -> pd.DataFrame:
    """One row per seed, one column per effect in its order."""
    own = cohorts[cohorts["experiment"] == experiment]
    order = list(dict.fromkeys(own["effect"]))
    return own.pivot_table(index="seed", columns="effect", values=column)[order]
