"""Captions, notes and number formats of the tables of this study."""

from __future__ import annotations

from typing import Final

from swaystride.presentation.table_style import TableStyle
from swaystride.studies.experience.plan import SCALES
from swaystride.studies.experience.tables import wide_associations

_SCALE_WORDS: Final = {
    "affective_valence": "Affective valence",
    "activity_enjoyment": "Activity enjoyment",
    "flow": "Flow",
}
_ASSOCIATION_FORMATS: Final = {
    "r": "number:2:6",
    "beta": "number:2:6",
    "p": "p:3:6",
    "ci_low": "number:2:6",
    "ci_high": "number:2:6",
    "q": "p:3:6",
    "ci_low_cluster": "number:2:6",
    "ci_high_cluster": "number:2:6",
    "rating_sd": "number:2:6",
}
_ASSOCIATION_NOTES: Final = (
    "R: Pearson correlation over runs. β: difference of the rating, in units of the scale, for a "
    "difference of one standard deviation of the measure (the caption of the print has it the "
    "other way round, register I-29). p: two-sided test of R, not corrected.",
    "The CSV holds a row per measure and scale, with n, intervals, q and the SD of the rating.",
)


def _association_style(number: str, runs: str) -> TableStyle:
    """Style of Tables 5.3 and 5.4: long in the CSV, wide as the print for people."""
    wide: dict[str, str | int] = {}
    labels = {"measure": "Measure"}
    for scale in SCALES:
        wide |= {f"r_{scale}": 2, f"beta_{scale}": 2, f"p_{scale}": "p:3"}
        word = _SCALE_WORDS[scale]
        labels |= {f"r_{scale}": f"{word}: R", f"beta_{scale}": "β", f"p_{scale}": "p"}
    return TableStyle(
        f"Table {number}. Associations between kinematic measures and scales of experience, {runs}.",
        _ASSOCIATION_NOTES,
        _ASSOCIATION_FORMATS,
        wide_associations,
        wide,
        labels,
    )


_LIMIT_COLUMNS: Final = (
    "stride_time_ms",
    "contact_time_ms",
    "stride_length_pct",
    "initial_contact_bias_ms",
    "initial_contact_sd_ms",
    "hip_range_deg",
    "knee_range_deg",
    "inclination_deg",
    "ml_shank_foot_deg",
    "ml_thigh_deg",
    "peak_tibial_pct",
)

TABLE_STYLES: Final = {
    "table_5_1": TableStyle(
        "Table 5.1. The runners.", (), {"age": 0, "height_cm": "number:0:1", "mass_kg": 1}
    ),
    "table_5_2": TableStyle(
        "Table 5.2. Spatiotemporal measures and their definitions.",
        (
            "Columns measure and definition: the print. Every measure is the mean over the strides "
            "of each side, then of both sides.",
        ),
    ),
    "table_5_3": _association_style("5.3", "all runs"),
    "table_5_4": _association_style("5.4", "aerial runs"),
    "study5_text": TableStyle(
        "Numbers of the running text.",
        ("Intervals of correlations by Fisher's transformation; the print has none.",),
        {"value": "number:3:6", "ci_low": "number:3:6", "ci_high": "number:3:6", "p": "p:3:6"},
    ),
    "cohort": TableStyle(
        "Participants and their runs.",
        ("Mean and standard deviation (n − 1).",),
        {
            "n": "integer",
            "n_female": "integer",
            "n_runs": "integer",
            "age_years_mean": 1,
            "age_years_sd": 1,
            "height_m_mean": "number:2:4",
            "height_m_sd": "number:2:4",
            "mass_kg_mean": 1,
            "mass_kg_sd": 1,
            "runs_per_participant_mean": "number:1:4",
            "runs_per_participant_sd": "number:1:4",
        },
    ),
    "runs": TableStyle(
        "Every run.",
        (
            "Means over the steady part: after the warm-up, without the turn and lost data. "
            "n_rejected: strides with implausible times.",
        ),
        {
            "minutes": 1,
            "speed_m_s": "number:2:6",
            "stride_length_m": "number:2:6",
            "stride_time_s": "number:3:6",
            "contact_time_s": "number:3:6",
            "flight_time_s": "number:3:6",
            "duty_factor": "number:3:6",
            "heart_rate_bpm": "number:0:3",
            "affective_valence": "number:2:6",
            "activity_enjoyment": "number:0:3",
            "flow": "number:0:3",
        },
    ),
    "classes": TableStyle(
        "Running patterns.",
        (
            "pattern: by the mean duty factor of the run, printed cut-offs. at 12 km/h: the duty "
            "factor moved along the common slope to the speed of the cut-offs, where the variant "
            "does so. true: of the simulated motion.",
        ),
        {
            "speed_m_s": "number:2:6",
            "duty_factor": "number:4:6",
            "duty_factor_at_12_km_h": "number:4:6",
            "true_duty_factor": "number:4:6",
        },
    ),
    "within_runs": TableStyle(
        "Correlations with affect within runs.",
        (
            "Counts of runs whose 95 % interval lies above (positive) or below (negative) zero.",
            "printed: bootstrap of the linear model of measure and time, windows taken as "
            "independent. given_time: correlation with time held constant. ar1: residuals that follow "
            "each other; block: residuals drawn in blocks.",
        ),
        {"r_median": "number:2:6", "r_least": "number:2:6", "r_largest": "number:2:6"},
    ),
    "claims": TableStyle("Claims of the chapter.", ("holds: parts of the claim that hold.",)),
    "truth_errors": TableStyle(
        "Errors of every run against the truth.",
        (
            "Estimate − truth of the mean of the run. Of the axes the largest error over the "
            "sensors stands here. outside: how many errors exceed their limit.",
        ),
        {
            **dict.fromkeys(_LIMIT_COLUMNS, "number:1:6"),
            "stride_time_ms": "number:2:6",
            "duty_factor": "number:4:6",
        },
    ),
    "truth_summary": TableStyle(
        "Errors of every measure against the truth, over the runs.",
        (
            "Estimate − truth of the mean of a run: mean (bias), SD and largest, in the unit of the "
            "measure. The limit is what this repository asks of its recommended method, for every "
            "run.",
        ),
        {
            "truth_mean": "number:3:6",
            "bias": "number:4:6",
            "sd": "number:4:6",
            "worst": "number:4:6",
            "worst_judged": "number:3:6",
            "limit": "number:3:6",
        },
    ),
    "attainable": TableStyle(
        "Printed, attainable and measured correlations.",
        (
            "Attainable: the correlation of the population that the ratings were drawn from, the "
            "nearest set to the print that can exist. Measured: this cohort.",
        ),
        dict.fromkeys(
            ("r_printed", "r_attainable", "distance", "r_measured", "difference"), "number:2:6"
        ),
    ),
    "null_cohort": TableStyle(
        "Significant rows by chance.",
        (
            "null: ratings drawn without any association with the measures, same runs. q: after "
            "Benjamini-Hochberg, where it is computed.",
        ),
        {
            "expected_by_chance": 1,
            "largest_r_cohort": "number:2:6",
            "largest_r_null": "number:2:6",
        },
    ),
}
