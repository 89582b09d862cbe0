"""Captions, notes and number formats of the tables of this study."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final

from swaystride.presentation.table_style import TableStyle
from swaystride.studies.kinematics.tables import AGREEMENT_COLUMNS, ALTERNATIVE_COLUMNS

_OVER_TRIALS: Final = (
    "Mean and standard deviation (n − 1) over trials; se: standard error over participants.",
)


def _decimals(stem: str) -> str:
    """R² with two decimals for people, metres with three, all else with one or two."""
    if stem.startswith("r2"):
        return "number:2:6"
    return "number:3:6" if stem.endswith("_m") else "number:1:6"


def _formats(stems: Iterable[str], parts: Iterable[str] = ("mean", "sd", "se")) -> dict[str, str]:
    """Formats of the columns ``<stem>_<part>``."""
    return {f"{stem}_{part}": _decimals(stem) for stem in stems for part in parts}


_COUNT: Final[Mapping[str, str]] = {"n_trials": "integer"}

TABLE_STYLES: Final = {
    "table_4_1": TableStyle(
        "Table 4.1. Running experience of the participants.",
        (),
        {"age_years": 0, "height_m": 2, "mass_kg": 1},
    ),
    "table_4_2": TableStyle(
        "Table 4.2. Noise parameters of the filter.",
        (
            "Joint axes: standard deviation of each component of the difference of both images, "
            "as an angle. The last two columns are not in the print.",
        ),
        {
            **dict.fromkeys(
                ("sigma_accel_m_s2", "sigma_joint_centre_ankle_m", "sigma_joint_centre_knee_m"),
                "number:3:6",
            ),
            **dict.fromkeys(
                ("sigma_joint_centre_hip_m", "gyro_bias_walk_deg_s_rts", "contact_lever_m"),
                "number:3:6",
            ),
            **dict.fromkeys(
                (
                    "sigma_gyro_deg_s",
                    "sigma_zupt_m_s",
                    "sigma_joint_axis_knee_deg",
                    "sigma_joint_axis_hip_deg",
                ),
                "number:2:6",
            ),
        },
    ),
    "table_4_3": TableStyle(
        "Table 4.3. Agreement of the joint angles of OPTIC and ErKF over whole trials.",
        (
            *_OVER_TRIALS,
            "r2: 1 − SSE/SST after one constant per trial; mad: size of the mean difference; "
            "no_offset: the trial's mean curve of the difference removed. These readings fit the "
            "print best; the columns with alt hold the others.",
        ),
        {
            **_formats(AGREEMENT_COLUMNS),
            **_formats(ALTERNATIVE_COLUMNS, ("mean", "sd")),
            **_COUNT,
        },
    ),
    "table_4_4": TableStyle(
        "Table 4.4. Ranges of motion of OPTIC and ErKF, beside a published comparison.",
        (
            "The columns reference are literature as printed, not of this cohort.",
            "p: paired t-test over trials; p_holm: corrected for all angles and sides; p_mixed: "
            "mixed model of the difference with an intercept of the runner.",
        ),
        {
            **_formats(("reference_deg",), ("mean", "sd")),
            **_formats(("optic_deg", "erkf_deg")),
            "difference_deg": "number:1:6",
            "t": "number:2:6",
            "df": "number:0:3",
            "df_mixed": "number:1:3",
            "p": "p:3:6",
            "p_holm": "p:3:6",
            "p_mixed": "p:3:6",
            "optic_poor": "integer",
            "significant": "integer",
            "n_participants": "integer",
            **_COUNT,
        },
    ),
    "table_4_5": TableStyle(
        "Table 4.5. Differences of ranges of motion between ErKF and OPTIC.",
        _OVER_TRIALS,
        {**_formats(("rom_rmsd_deg", "rom_rrmsd_pct", "rom_bias_deg")), **_COUNT},
    ),
    "table_4_6": TableStyle(
        "Table 4.6. Peaks and the angle at contact.",
        (
            *_OVER_TRIALS,
            "Peak extension and plantarflexion as positive numbers. A relative difference is left "
            "out where the OPTIC mean is too small.",
        ),
        {**_formats(("optic_deg", "erkf_deg", "rmsd_deg", "rrmsd_pct")), **_COUNT},
    ),
    "table_4_7": TableStyle(
        "Table 4.7. Stride length and width.",
        (
            *_OVER_TRIALS,
            "md: OPTIC − ErKF of the length, ErKF − OPTIC of the width, as in the print; bias: ErKF "
            "− OPTIC of both. signed: positive if the foot lands on its own side.",
        ),
        {
            **_formats(("optic_m", "erkf_m", "md_m", "rmsd_m", "rrmsd_pct", "bias_m", "bias_pct")),
            **_formats(("optic_signed_m", "erkf_signed_m"), ("mean", "sd")),
            **_COUNT,
        },
    ),
    "table_4_8": TableStyle(
        "Table 4.8. How accurate marker angles are expected to be, and how accurate they are.",
        (
            "largest: effect of any shift of a joint centre, mean over trials and sides. true: "
            "against the truth of a simulated cohort, size of the bias and RMSD after one constant.",
        ),
        dict.fromkeys(
            (
                "largest_offset_deg",
                "largest_shape_deg",
                "optic_true_bias_deg",
                "optic_true_rmsd_trial_deg",
                "erkf_true_bias_deg",
                "erkf_true_rmsd_trial_deg",
            ),
            "number:1:6",
        ),
    ),
    "table_4_9": TableStyle(
        "Table 4.9. Sagittal joint angles of other algorithms, as printed, and of this pipeline.",
        (
            "Values of the literature are as printed, R and R² mixed as there. The rows of this "
            "pipeline say in the column origin whether they rest on a simulated cohort.",
        ),
    ),
    "table_4_10": TableStyle(
        "Table 4.10. Frontal and transverse joint angles of other algorithms, as printed, and of "
        "this pipeline.",
        (
            "Values of the literature are as printed. The rows of this pipeline say in the column "
            "origin whether they rest on a simulated cohort.",
        ),
    ),
    "study4_text": TableStyle(
        "Numbers of the running text of chapter 4.",
        (),
        {"value": "number:2:6", "sd": "number:2:6"},
    ),
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
    "agreement_by_trial": TableStyle(
        "Agreement of OPTIC and ErKF in every trial.",
        (),
        {
            "n_strides": "integer",
            "r2": "number:2:6",
            **dict.fromkeys(
                ("rom_deg", "bias_deg", "rmsd_deg", "rmsd_trial_deg", "rmsd_ensemble_deg"),
                "number:1:6",
            ),
        },
    ),
    "claims": TableStyle("Statements of the chapter, and what this cohort shows."),
    "truth_angles": TableStyle(
        "Joint angles of markers and filter against the truth.",
        (
            "rmsd: as it is; rmsd_trial: after one constant per trial. Means over trials. "
            "coverage: share of the truth within the 95 % band of the filter, as it is and after the "
            "constant.",
        ),
        {
            **{
                f"{source}_{name}": "number:1:6"
                for source in ("optic", "erkf")
                for name in (
                    "bias_deg_mean",
                    "bias_deg_sd",
                    "rmsd_deg_mean",
                    "rmsd_trial_deg_mean",
                    "rmsd_trial_deg_sd",
                )
            },
            "erkf_coverage_95": "number:2:6",
            "erkf_coverage_95_trial": "number:2:6",
            **_COUNT,
        },
    ),
    "truth_summary": TableStyle(
        "Errors of markers and filter after one constant per trial, by plane.",
        ("Means over trials; mean and largest over angles and sides.",),
        dict.fromkeys(
            (
                "mean_rmsd_trial_deg",
                "largest_rmsd_trial_deg",
                "mean_rmsd_deg",
                "largest_rmsd_deg",
            ),
            "number:1:6",
        ),
    ),
    "truth_strides": TableStyle(
        "Stride length and width of markers and filter against the truth.",
        ("Truth: the same point of the foot, between the same instants.",),
        {
            "n_strides": "integer",
            "truth_m": "number:3:6",
            "bias_m": "number:3:6",
            "bias_pct": "number:1:6",
            "rmsd_m": "number:3:6",
        },
    ),
}
