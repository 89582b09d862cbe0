"""What the prose of the chapter claims, and what this cohort shows (§2.4-2.5)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import pandas as pd

from swaystride.studies.feedback.plan import FEATURES

Panel = Literal["training", "removal", "block_change"]

ANGLES = ("phi_rms", "ap_rms", "ml_rms", "ellipse_area")
REMAINING_ANGLES = ("phi_rms", "ap_rms", "ellipse_area")


@dataclass(frozen=True)
class Claim:
    """One statement of the prose, as a question to the contrasts.

    Parameters
    ----------
    text : str
        The statement, in our words.
    section : str
        Where the chapter makes it.
    panel, effect : str
        Which contrast decides.
    features : sequence of str
        Features for which the statement is made.
    holds : callable
        Contrast and significance level to whether the statement holds for one feature.
    """

    text: str
    section: str
    panel: Panel
    effect: str
    features: Sequence[str]
    holds: Callable[[Mapping[str, float], float], bool]


def _decrease(row: Mapping[str, float], alpha: float) -> bool:
    return bool(row["estimate"] < 0 and row["p"] < alpha)


def _increase(row: Mapping[str, float], alpha: float) -> bool:
    return bool(row["estimate"] > 0 and row["p"] < alpha)


def _none(row: Mapping[str, float], alpha: float) -> bool:
    return bool(row["p"] >= alpha)


CLAIMS = (
    Claim(
        "Sway angles fall with the number of trials with concurrent feedback.",
        "§2.4", "training", "concurrent", ANGLES, _decrease,
    ),
    Claim(
        "Mean velocity rises with the number of trials with concurrent feedback.",
        "§2.4", "training", "concurrent", ("phi_mv",), _increase,
    ),
    Claim(
        "Sway angles fall at the same rate with terminal as with concurrent feedback.",
        "§2.4", "training", "terminal_minus_concurrent", REMAINING_ANGLES, _none,
    ),
    Claim(
        "Mean velocity falls more (or rises less) with terminal than with concurrent feedback.",
        "§2.4", "training", "terminal_minus_concurrent", ("phi_mv",), _decrease,
    ),
    Claim(
        "Removing concurrent feedback raises the sway angles again.",
        "§2.4", "removal", "concurrent", ANGLES, _increase,
    ),
    Claim(
        "Removing concurrent feedback lowers velocity and path length again.",
        "§2.4", "removal", "concurrent", ("phi_mv", "path_length"), _decrease,
    ),
    Claim(
        "Removing terminal feedback changes nothing.",
        "§2.4", "removal", "terminal", tuple(FEATURES), _none,
    ),
    Claim(
        "At the end of a first block with terminal feedback, sway angles are below baseline.",
        "§2.4, §2.5.2", "block_change", "terminal", REMAINING_ANGLES, _decrease,
    ),
    Claim(
        "At the end of a first block with concurrent feedback, sway angles are as at baseline.",
        "§2.5.2", "block_change", "concurrent", ANGLES, _none,
    ),
    Claim(
        "At the end of the first block mean velocity and path length are below baseline (concurrent).",
        "§2.4", "block_change", "concurrent", ("phi_mv", "path_length"), _decrease,
    ),
    Claim(
        "At the end of the first block mean velocity and path length are below baseline (terminal).",
        "§2.4", "block_change", "terminal", ("phi_mv", "path_length"), _decrease,
    ),
    Claim(
        "Mean velocity falls more over a first block with terminal than with concurrent feedback.",
        "§2.4", "block_change", "terminal_minus_concurrent", ("phi_mv",), _decrease,
    ),
)  # fmt: skip


def claims_table(contrasts: pd.DataFrame, significance_level: float) -> pd.DataFrame:
    """Judge every claim against the contrasts at the printed exponents and terms.

    Parameters
    ----------
    contrasts : DataFrame
        Contrasts of all features.
    significance_level : float
        The chapter's α.

    Returns
    -------
    DataFrame
        ``claim``, ``section``, ``reproduced`` (yes, partly or no), ``holds_for`` (of how many
        features) and ``evidence`` (estimate and p of each feature).
    """
    keys = ["panel", "effect", "feature"]
    printed = contrasts[contrasts["model"] == "printed"].set_index(keys)
    ours = {
        key: {"estimate": float(estimate), "p": float(p)}
        for key, estimate, p in zip(printed.index, printed["estimate"], printed["p"], strict=True)
    }
    rows = []
    for claim in CLAIMS:
        evidence, held = [], 0
        for feature in claim.features:
            row = ours[claim.panel, claim.effect, feature]
            held += claim.holds(row, significance_level)
            p = "p < 0.001" if row["p"] < 0.001 else f"p = {row['p']:.3f}"
            evidence.append(f"{FEATURES[feature][0]} {row['estimate']:+.3f} ({p})")
        verdict = "yes" if held == len(claim.features) else "partly" if held else "no"
        rows.append(
            {
                "claim": claim.text,
                "section": claim.section,
                "reproduced": verdict,
                "holds_for": f"{held} of {len(claim.features)}",
                "evidence": "; ".join(evidence),
            }
        )
    return pd.DataFrame(rows)
