"""Captions, notes and number formats of the tables of this study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from swaystride.presentation.table_style import TableStyle

#: Three decimals for people, more in the CSV: differences to the print are taken from it.
_EFFECTS: Final[Mapping[str, str | int]] = {
    "exponent": 1,
    "estimate": "number:3:6",
    "ci_low": "number:3:6",
    "ci_high": "number:3:6",
    "p": "p:6",
    "se": "number:4:7",
    "df": 1,
    "n": "integer",
}

TABLE_STYLES: Final = {
    "table_2_1": TableStyle(
        "Table 2.1. Participants by order of the feedback blocks.",
        ("Standard deviations are divided by n − 1.",),
        {
            "n": "integer",
            "age_mean": 2,
            "age_sd": 2,
            "n_female": "integer",
            "height_m_mean": 3,
            "height_m_sd": 3,
            "mass_kg_mean": 1,
            "mass_kg_sd": 1,
        },
    ),
    "table_2_2": TableStyle(
        "Table 2.2. Exponent on the trial number and terms kept by the search.",
        ("yes*: included and significant; yes: included; no: eliminated by AIC.",),
        {"exponent": 1},
    ),
    "table_2_3": TableStyle(
        "Table 2.3. Effects of training and of removing feedback on the log of each feature, "
        "first block, at the printed exponents and terms.",
        (
            "Training: per unit of N^a. terminal in the removal panel is the effect of removing "
            "terminal feedback itself.",
            "attainable: whether the printed value can hold together with the printed effects on "
            "AP RMS, ML RMS and MV.",
        ),
        _EFFECTS,
    ),
    "table_2_3_searched": TableStyle(
        "Effects of Table 2.3 at the exponents and terms that our own search chose.",
        ("Estimates of training scale with N^a and cannot be compared across exponents.",),
        _EFFECTS,
    ),
    "table_2_4": TableStyle(
        "Table 2.4. Change of the log of each feature from baseline to the end of the first block.",
        ("The last trial of a block is without feedback.",),
        _EFFECTS,
    ),
    "coverage": TableStyle(
        "Printed estimates of Table 2.3 that the confidence intervals of this cohort cover.",
        (),
        {"n": "integer", "covered": "integer"},
    ),
    "claims": TableStyle(
        "Claims of the chapter's prose, and what this cohort shows.",
        ("Judged on the effects at the printed exponents and terms.",),
    ),
    "truth": TableStyle(
        "Effects of the simulated cohort beside the truth that it was drawn from.",
        ("One cohort: a covered truth proves little; see results/recovery for many cohorts.",),
        {
            "exponent": 1,
            "truth": "number:3:6",
            "estimate": "number:3:6",
            "ci_low": "number:3:6",
            "ci_high": "number:3:6",
            "difference_in_se": 2,
        },
    ),
}
