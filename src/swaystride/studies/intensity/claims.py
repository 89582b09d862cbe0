"""What the prose of the chapter claims, and what this cohort shows (§3.4-3.5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import pandas as pd

from swaystride.stats.reliability import reliability_class
from swaystride.studies.intensity.plan import DIMENSIONS, FEATURES, RATING_LEVELS

Values = Mapping[str, float]


@dataclass(frozen=True)
class Claim:
    """One statement of the prose.

    Parameters
    ----------
    text : str
        The statement, in our words.
    section : str
        Where the chapter makes it.
    parts : callable
        From estimates, p-values and the significance level to whether each part holds.
    """

    text: str
    section: str
    parts: Callable[[Values, Values, float], list[bool]]


def _good(v: Values, p: Values, alpha: float) -> list[bool]:
    return [
        reliability_class(v[f"study3_text/icc_pt_{level}"]) == "good" for level in RATING_LEVELS
    ]


def _harder_is_higher(v: Values, p: Values, alpha: float) -> list[bool]:
    keys = [
        f"table_3_2/{d}/{level}"
        for level in RATING_LEVELS
        for d in DIMENSIONS
        if d != "head_movements"
    ]
    return [v[key] > 0 and p[key] < alpha for key in keys]


def _head_is_lower(v: Values, p: Values, alpha: float) -> list[bool]:
    keys = [f"table_3_2/head_movements/{level}" for level in RATING_LEVELS]
    return [v[key] < 0 and p[key] < alpha for key in keys]


def _self_is_lower(v: Values, p: Values, alpha: float) -> list[bool]:
    key = "study3_text/pt_minus_self_mean_difference"
    return [v[f"{key}_{level}"] > 0 and p[f"{key}_{level}"] < alpha for level in RATING_LEVELS]


def _self_varies_less(v: Values, p: Values, alpha: float) -> list[bool]:
    key = "study3_text/pt_minus_self_between_trial_variance_difference"
    return [v[key] > 0 and p[key] < alpha]


def _self_correlates(v: Values, p: Values, alpha: float) -> list[bool]:
    key = "study3_text/spearman_self_vs_pt_per_exercise"
    return [v[key] > 0 and p[key] < alpha]


def _all_features(v: Values, p: Values, alpha: float) -> list[bool]:
    keys = [f"table_3_3/{f}/{t}" for t in ("none", "log") for f in FEATURES]
    return [v[key] > 0 and p[key] < alpha for key in keys]


def _ml_is_highest(v: Values, p: Values, alpha: float) -> list[bool]:
    pairs = [("ml_rms", "ap_rms"), ("ml_rms", "phi_rms"), ("ml_mv", "ap_mv"), ("ml_mv", "phi_mv")]
    return [
        v[f"table_3_3/{a}/{t}"] > v[f"table_3_3/{b}/{t}"] for t in ("none", "log") for a, b in pairs
    ]


def _log_is_higher(v: Values, p: Values, alpha: float) -> list[bool]:
    return [v[f"table_3_3/{f}/log"] > v[f"table_3_3/{f}/none"] for f in FEATURES]


def _area_gains_most(v: Values, p: Values, alpha: float) -> list[bool]:
    gain = {f: v[f"table_3_3/{f}/log"] - v[f"table_3_3/{f}/none"] for f in FEATURES}
    return [max(gain, key=lambda f: gain[f]) == "ellipse_area"]


def _sway_beats_self_per_exercise(v: Values, p: Values, alpha: float) -> list[bool]:
    return [_accuracy(v, "kinematics", "per_exercise") > _accuracy(v, "self", "per_exercise")]


def _sway_beats_self_per_trial(v: Values, p: Values, alpha: float) -> list[bool]:
    return [_accuracy(v, "kinematics", "per_trial") > _accuracy(v, "self", "per_trial")]


def _accuracy(v: Values, source: str, level: str) -> float:
    return v[f"study3_text/{source}_predicts_pt_accuracy_{level}_percent"]


def _self_5_and_4(v: Values, p: Values, alpha: float) -> list[bool]:
    return [
        v[f"study3_text/{name}_{level}_percent"] > 100.0 / 3.0
        for name in ("self_5_agrees_with_pt", "self_4_is_pt_5")
        for level in RATING_LEVELS
    ]


def _predicted_5(v: Values, p: Values, alpha: float) -> list[bool]:
    five = v["study3_text/kinematics_5_agrees_with_pt_per_exercise_percent"]
    return [five > v["study3_text/kinematics_4_is_pt_4_per_exercise_percent"]]


def _predicted_4(v: Values, p: Values, alpha: float) -> list[bool]:
    five = v["study3_text/kinematics_4_is_pt_5_per_exercise_percent"]
    return [five > v["study3_text/kinematics_4_is_pt_4_per_exercise_percent"]]


CLAIMS: Final = (
    Claim(
        "Ratings of trials and of exercises are of good inter-rater reliability.", "§3.4.1", _good
    ),
    Claim(
        "Ratings rise with the difficulty of surface, stance and vision.",
        "§3.4.1",
        _harder_is_higher,
    ),
    Claim("Ratings fall with head movement.", "§3.4.1", _head_is_lower),
    Claim("Self-ratings correlate with the therapists' ratings.", "§3.4.2", _self_correlates),
    Claim("Patients rate themselves lower than therapists do.", "§3.4.2", _self_is_lower),
    Claim("Self-ratings vary less between trials of an exercise.", "§3.4.2", _self_varies_less),
    Claim(
        "Where patients give a 5 or a 4, therapists mostly give a 5 (more than a third).",
        "§3.4.2",
        _self_5_and_4,
    ),
    Claim("Every feature of sway correlates with the ratings.", "§3.4.3", _all_features),
    Claim("ML correlates more than AP and Phi.", "§3.5.3", _ml_is_highest),
    Claim("Logarithms of the features correlate more.", "§3.5.3", _log_is_higher),
    Claim("The elliptical area gains most from the logarithm.", "§3.5.3", _area_gains_most),
    Claim(
        "Predictions from sway agree more often than self-ratings: exercises.",
        "§3.5.3",
        _sway_beats_self_per_exercise,
    ),
    Claim(
        "Predictions from sway agree more often than self-ratings: trials "
        "(the printed numbers say the opposite, register I-10).",
        "§3.5.3",
        _sway_beats_self_per_trial,
    ),
    Claim("A predicted 5 agrees more often than a predicted 4.", "§3.4.3", _predicted_5),
    Claim("A predicted 4 is a therapist's 5 more often than a 4.", "§3.4.3", _predicted_4),
)


def claims_table(results: pd.DataFrame, significance_level: float) -> pd.DataFrame:
    """Judge every claim.

    Parameters
    ----------
    results : DataFrame
        All results of the cohort.
    significance_level : float

    Returns
    -------
    DataFrame
        ``claim``, ``section``, ``holds`` (parts of the claim that hold), ``reproduced`` (``yes``,
        ``partly``, ``no``).
    """
    by_quantity = results.set_index("quantity")
    names = [str(name) for name in by_quantity.index]
    values = dict(zip(names, by_quantity["estimate"].astype(float), strict=True))
    p = dict(zip(names, by_quantity["p"].astype(float), strict=True))
    rows = []
    for claim in CLAIMS:
        parts = claim.parts(values, p, significance_level)
        held = sum(parts)
        verdict = "yes" if held == len(parts) else "partly" if held else "no"
        rows.append((claim.text, claim.section, f"{held} of {len(parts)}", verdict))
    return pd.DataFrame(rows, columns=["claim", "section", "holds", "reproduced"])
