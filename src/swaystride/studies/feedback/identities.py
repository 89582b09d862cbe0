"""Which printed effects can hold together (spec §10, I-02c).

The six features are functions of one trajectory: Phi² = AP² + ML², the elliptical area is a
constant times AP·ML·√(1 − ρ²), and the path length is the mean velocity times a fixed duration.
Effects on their logarithms are therefore bound to each other. This module holds the printed
effects of Table 2.3 against these identities, within the rounding of the print.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product

import numpy as np
import pandas as pd
from numpy.typing import NDArray

Interval = tuple[float, float]

#: Half a unit of the last printed decimal.
ROUNDING = 0.0005

FREE = "free: taken as the truth of the simulated cohort"


def attainability(printed: pd.DataFrame, last_training_trial: int) -> pd.DataFrame:
    """Mark the rows of printed Table 2.3 that contradict an identity.

    Parameters
    ----------
    printed : DataFrame
        ``data/published/table_2_3.csv``.
    last_training_trial : int
        Trial number N at which training effects are compared, as β·N^a: exponents differ between
        features, so that the effects themselves cannot be compared.

    Returns
    -------
    DataFrame
        ``panel``, ``feature``, ``effect``, ``attainable`` and ``attainable_reason``, in the order
        of the print.
    """
    rows = {
        (str(row["panel"]), str(row["feature"]), str(row["effect"])): (
            float(row["estimate"]),
            float(row["exponent"]),
        )
        for row in printed.to_dict("records")
    }
    verdicts = []
    for panel, feature, effect in rows:
        ok, reason = _verdict(rows, panel, feature, effect, last_training_trial)
        verdicts.append((panel, feature, effect, ok, reason))
    columns = ["panel", "feature", "effect", "attainable", "attainable_reason"]
    return pd.DataFrame(verdicts, columns=columns)


def block_change_attainability(
    printed: pd.DataFrame, text: pd.DataFrame, last_training_trial: int
) -> pd.DataFrame:
    """Mark the values of the text on the first block that Table 2.3 contradicts.

    The difference between the blocks is that of the training effects over all trials plus that
    of the two removals (spec §8.3).

    Parameters
    ----------
    printed, text : DataFrame
        ``data/published/table_2_3.csv`` and ``table_2_4.csv``.
    last_training_trial : int
        Trial number N at the end of the block.

    Returns
    -------
    DataFrame
        ``effect``, ``feature``, ``attainable`` and ``attainable_reason`` for every row of `text`.
    """
    rows = {
        (str(row["panel"]), str(row["feature"]), str(row["effect"])): row
        for row in printed.to_dict("records")
    }
    verdicts = []
    for row in text.to_dict("records"):
        effect, feature, value = str(row["effect"]), str(row["feature"]), float(row["estimate"])
        if effect != "terminal_minus_concurrent" or np.isnan(value):
            verdicts.append((effect, feature, True, ""))
            continue
        training = rows["training", feature, effect]
        scale = last_training_trial ** float(training["exponent"])
        removal = [
            float(rows["removal", feature, name]["estimate"]) for name in ("terminal", "concurrent")
        ]
        implied = float(training["estimate"]) * scale + removal[0] - removal[1]
        slack = ROUNDING * (scale + 3)
        ok = abs(implied - value) <= slack
        verb = "follows from" if ok else "does not follow from"
        reason = f"{verb} Table 2.3: printed {value:.3f}, implied {implied:.3f} ± {slack:.3f}"
        verdicts.append((effect, feature, ok, reason))
    columns = ["effect", "feature", "attainable", "attainable_reason"]
    return pd.DataFrame(verdicts, columns=columns)


def _verdict(
    rows: Mapping[tuple[str, str, str], tuple[float, float]],
    panel: str,
    feature: str,
    effect: str,
    last: int,
) -> tuple[bool, str]:
    """Whether one printed effect agrees with what the others imply, and why."""

    def interval(name: str, kind: str = effect) -> Interval:
        """Printed effect at the end of the block, as the interval that rounding leaves."""
        estimate, exponent = rows[panel, name, kind]
        scale = last**exponent if panel == "training" else 1.0
        return (estimate - ROUNDING) * scale, (estimate + ROUNDING) * scale

    if feature in {"ap_rms", "ml_rms", "phi_mv"}:
        return True, FREE
    if feature == "path_length":
        implied, why = interval("phi_mv"), "PL = MV × duration"
    elif feature == "ellipse_area":
        ap, ml = interval("ap_rms"), interval("ml_rms")
        implied, why = (ap[0] + ml[0], ap[1] + ml[1]), "EA ∝ AP × ML at unchanged correlation"
    else:
        why = "Phi² = AP² + ML²"
        base = "concurrent" if effect == "terminal_minus_concurrent" else None
        implied = _implied_phi(interval, effect, base)
    low, high = interval(feature)
    ok = low <= implied[1] and high >= implied[0]
    verb = "agrees with" if ok else "contradicts"
    at = f" at trial {last}" if panel == "training" else ""
    reason = (
        f"{verb} {why}: printed {(low + high) / 2:.3f}{at}, "
        f"implied {implied[0]:.3f} to {implied[1]:.3f}"
    )
    return ok, reason


def _implied_phi(
    interval: Callable[[str, str], Interval], effect: str, base: str | None
) -> Interval:
    """Range of the change of ln Phi over every share of AP in Phi² before the change.

    For a difference of two changes, `base` is the change that it is added to; both start from the
    same share.
    """
    share = np.linspace(0.0, 1.0, 201)
    changes = []
    for ap, ml in product(interval("ap_rms", effect), interval("ml_rms", effect)):
        if base is None:
            changes.append(_phi_change(share, ap, ml))
            continue
        for ap_base, ml_base in product(interval("ap_rms", base), interval("ml_rms", base)):
            after = _phi_change(share, ap_base + ap, ml_base + ml)
            changes.append(after - _phi_change(share, ap_base, ml_base))
    return float(np.min(changes)), float(np.max(changes))


def _phi_change(share: NDArray[np.float64], ap: float, ml: float) -> NDArray[np.float64]:
    """Change of ln Phi when ln AP changes by `ap` and ln ML by `ml`."""
    return np.asarray(0.5 * np.log(share * np.exp(2 * ap) + (1 - share) * np.exp(2 * ml)))
