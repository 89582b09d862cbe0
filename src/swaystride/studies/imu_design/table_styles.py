"""Captions, notes and number formats of the tables of this study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from swaystride.presentation.table_style import TableStyle

_EFFECT_FORMATS: Final[Mapping[str, str | int]] = {
    "slope_pct_per_m_s": "number:2:6",
    "p": "p:3:6",
    "ci_low": "number:2:6",
    "ci_high": "number:2:6",
    "se": "number:3:6",
    "df": 1,
    "n": "integer",
    "n_trials": "integer",
    "n_participants": "integer",
}
_EFFECT_NOTES: Final = (
    "Slopes in percent of the distance per m/s. The first row is the slope of the baseline, the "
    "others are differences from it.",
    "REML, Satterthwaite's p, 95 % profile intervals.",
)


def _effects(number: int, what: str) -> TableStyle:
    """Style of one of Tables A1 to A4."""
    return TableStyle(
        f"Table A{number}. Effect of speed on the distance error and {what}.",
        _EFFECT_NOTES,
        _EFFECT_FORMATS,
    )


TABLE_STYLES: Final = {
    "table_1": TableStyle(
        "Table 1. The two IMUs: specification, and largest readings of the recordings.",
        ("The rate is the median over the recordings; at range: recordings that reach it.",),
        {
            "rate_hz": "number:0:3",
            "accelerometer_range_g": 0,
            "gyro_range_deg_s": 0,
            "n_recordings": "integer",
            "peak_acc_g": 1,
            "peak_gyr_deg_s": 0,
            "n_acc_at_range": "integer",
            "n_gyr_at_range": "integer",
        },
    ),
    "table_a1": _effects(1, "of the accelerometer's range"),
    "table_a2": _effects(2, "of the gyroscope's range"),
    "table_a3": _effects(3, "of the sampling rate, samples left out (method 1)"),
    "table_a4": _effects(4, "of the sampling rate, decimation (method 2)"),
    "imu_design_text": TableStyle(
        "Numbers of the running text of Potter et al. (2019).",
        ("value_added: by the difference from the baseline of the same trial.",),
        {"value": "number:2:6", "value_added": "number:2:6"},
    ),
    "model_comparison": TableStyle(
        "Effects with a random intercept of the subject, as printed, and with one of the trial "
        "besides.",
        ("All conditions of a trial share its error, which the printed model takes as noise.",),
        {
            **{
                f"{name}{suffix}": form
                for suffix in ("", "_with_trial")
                for name, form in (
                    ("slope_pct_per_m_s", "number:2:6"),
                    ("se", "number:3:6"),
                    ("df", 1),
                    ("p", "p:3:6"),
                )
            },
            "se_ratio": 2,
        },
    ),
    "variance_components": TableStyle(
        "Standard deviations of the random parts of both models.",
        (),
        {"sd_pct": "number:2:6"},
    ),
    "requirements": TableStyle(
        "What each experiment asks of an IMU.",
        (
            "added: judged by the difference from the baseline of the same trial.",
            "A level is missing where even the baseline has an error beyond the limit.",
        ),
        {
            "level_needed": "number:1:3",
            "loss_limit_percent": "number:2:6",
            "level_needed_added": "number:1:3",
            "loss_limit_added_percent": "number:2:6",
            "level_not_significant": "number:1:3",
            "n_beyond_at_baseline": "integer",
            "n_trials": "integer",
            "largest_error_at_baseline_pct": 1,
            "largest_error_pct": 1,
        },
    ),
    "recommendation": TableStyle("Recommendation, from the results of this cohort."),
    "cohort": TableStyle(
        "Participants.",
        ("Standard deviations are divided by n − 1.",),
        {
            "n": "integer",
            "n_female": "integer",
            "age_years_mean": 1,
            "age_years_sd": 1,
            "height_m_mean": 2,
            "height_m_sd": 2,
            "mass_kg_mean": 1,
            "mass_kg_sd": 1,
        },
    ),
    "speeds": TableStyle(
        "Trials: mean speed, strides and distance error of the recordings as they are.",
        (),
        {
            "n": "integer",
            "speed_mean_m_s": 2,
            "speed_min_m_s": 2,
            "speed_max_m_s": 2,
            "imu_1_error_pct": 2,
            "imu_1_strides_per_foot": 1,
            "imu_2_error_pct": 2,
            "imu_2_strides_per_foot": 1,
        },
    ),
    "claims": TableStyle("Claims of the paper, and what this cohort shows."),
    "truth": TableStyle(
        "Stride length and angle of the simulated recordings against the truth.",
        (
            "Error: estimate over the true displacement of the same sensor between the same "
            "instants, in percent. Half strides are left out.",
        ),
        {
            "n_strides": "integer",
            "mean_length_m": 2,
            "mean_error_percent": 2,
            "sd_error_percent": 2,
            "median_error_percent": 2,
            "rms_error_percent": 2,
            "median_angle_error_deg": 2,
        },
    ),
}
