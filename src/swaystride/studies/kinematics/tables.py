"""Tables of the chapter: people, noise, agreement, features, strides (table contract)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Final

import numpy as np
import pandas as pd

from swaystride.erkf.noise import NoiseSet
from swaystride.studies.kinematics.plan import (
    ANGLE_NAMES,
    FEATURES,
    JOINT_ANGLES,
    RELIABLE_ANGLES,
    SIDES,
    SOURCES,
    STRIDE_MEASURES,
)
from swaystride.studies.kinematics.summaries import TRIAL_KEYS, summary_table, trial_features
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.units import DEG_PER_RAD

#: Stems of Table 4.3 and the columns that fill them: the reading that fits the print best.
AGREEMENT_COLUMNS: Final = {
    "r2": "r2",
    "mad_deg": "mad_deg",
    "rmsd_deg": "rmsd_deg",
    "nrmsd_pct": "nrmsd_pct",
    "rmsd_no_offset_deg": "rmsd_ensemble_deg",
    "nrmsd_no_offset_pct": "nrmsd_ensemble_pct",
}
#: The other readings (register I-15, I-33), behind the printed columns.
ALTERNATIVE_COLUMNS: Final = {
    "bias_deg": "bias_deg",
    "mad_alt_deg": "mad_alt_deg",
    "r2_squared_correlation_alt": "r2_squared_correlation",
    "r2_raw_alt": "r2_raw",
    "rmsd_trial_alt_deg": "rmsd_trial_deg",
    "nrmsd_trial_alt_pct": "nrmsd_trial_pct",
    "rmsd_stride_alt_deg": "rmsd_stride_deg",
    "nrmsd_stride_alt_pct": "nrmsd_stride_pct",
}
#: What the print leaves open or has in other words: how accurate markers are (Table 4.8).
OPTIC_EXPECTATIONS: Final = {
    "hip_flexion": "accurate without offset",
    "hip_adduction": "accurate without offset",
    "knee_flexion": "accurate without offset",
    "ankle_dorsiflexion": "accurate without offset",
    "hip_rotation": "accurate with offset",
    "knee_adduction": "accurate with offset",
    "knee_rotation": "inaccurate",
    "ankle_inversion": "inaccurate",
    "ankle_rotation": "inaccurate",
}


def table_4_1(participants: pd.DataFrame) -> pd.DataFrame:
    """Running experience of the participants, then their bodies.

    Parameters
    ----------
    participants : DataFrame
        The lab's ``participants.tsv``.

    Returns
    -------
    DataFrame
        ``participant, years_running, typical_pace_min_per_km, race_5km_min`` as printed, then sex,
        age, height and mass.
    """
    columns = [
        "participant",
        "years_running",
        "typical_pace_min_per_km",
        "race_5km_min",
        "sex",
        "age_years",
        "height_m",
        "mass_kg",
    ]
    words = ["years_running", "typical_pace_min_per_km", "race_5km_min"]
    table = participants[columns].copy()
    table[words] = table[words].astype(object).where(table[words].notna(), "").astype(str)
    return table.reset_index(drop=True)


def table_4_2(running: Mapping[str, float | None], walking: NoiseSet) -> pd.DataFrame:
    """Noise parameters of the filter.

    Parameters
    ----------
    running : mapping of str to float or None
        Plain values of ``analysis.erkf.noise``, in force for this variant.
    walking : NoiseSet
        Of the source, for comparison.

    Returns
    -------
    DataFrame
        Columns as printed; a joint axis that is not used is missing. Then the walk of the gyroscope
        bias and the uncertainty of the contact point, which the print does not have.
    """
    known = {name: np.nan if value is None else value for name, value in running.items()}
    compared = asdict(walking)
    for name in ("gyr_sd", "hip_axis_sd", "knee_axis_sd"):
        radians = compared.pop("gyr_sd_rad_s" if name == "gyr_sd" else name)
        unit = "deg_s" if name == "gyr_sd" else "deg"
        compared[f"{name}_{unit}"] = np.nan if radians is None else radians * DEG_PER_RAD
    rows = []
    for gait, noise in (("running", known), ("walking", compared)):
        rows.append(
            {
                "gait": gait,
                "sigma_accel_m_s2": noise["acc_sd_m_s2"],
                "sigma_gyro_deg_s": noise["gyr_sd_deg_s"],
                "sigma_zupt_m_s": noise["zero_velocity_sd_m_s"],
                "sigma_joint_centre_ankle_m": noise["ankle_centre_sd_m"],
                "sigma_joint_centre_knee_m": noise["knee_centre_sd_m"],
                "sigma_joint_centre_hip_m": noise["hip_centre_sd_m"],
                "sigma_joint_axis_knee_deg": noise["knee_axis_sd_deg"],
                "sigma_joint_axis_hip_deg": noise["hip_axis_sd_deg"],
                "gyro_bias_walk_deg_s_rts": noise["gyr_bias_walk_rad_s_rts"] * DEG_PER_RAD,
                "contact_lever_m": noise["contact_lever_sd_m"],
            }
        )
    return pd.DataFrame(rows)


def table_4_3(agreement: pd.DataFrame) -> pd.DataFrame:
    """Agreement of the angle courses; the print's reading first, the other readings behind it.

    Parameters
    ----------
    agreement : DataFrame
        One row per trial, side and angle.

    Returns
    -------
    DataFrame
        Mean and SD over trials of R² (1 − SSE/SST after one constant), MAD (size of the mean
        difference), RMSD and NRMSD, and the latter two without the ensemble mean of the
        difference. Then bias and the other readings, ``*_alt``, and standard errors.
    """
    stems = {**AGREEMENT_COLUMNS, **ALTERNATIVE_COLUMNS}
    table = summary_table(agreement, "angle", RELIABLE_ANGLES, stems)
    return table.drop(columns=[f"{stem}_se" for stem in ALTERNATIVE_COLUMNS])


def table_4_5(strides: pd.DataFrame) -> pd.DataFrame:
    """Differences of the ranges of motion, stride by stride.

    Parameters
    ----------
    strides : DataFrame
        One row per stride, source and feature.

    Returns
    -------
    DataFrame
        RMSD and rRMSD of ErKF against OPTIC as printed, then bias (ErKF − OPTIC).
    """
    stems = {"rom_rmsd_deg": "rmsd", "rom_rrmsd_pct": "rrmsd_pct", "rom_bias_deg": "difference"}
    return summary_table(range_features(strides), "angle", RELIABLE_ANGLES, stems)


def range_features(strides: pd.DataFrame) -> pd.DataFrame:
    """Ranges of motion by trial, side and angle.

    Parameters
    ----------
    strides : DataFrame

    Returns
    -------
    DataFrame
        Of :func:`swaystride.studies.kinematics.summaries.trial_features`, with ``angle``.
    """
    ranges = strides[strides["feature"].isin([f"rom_{name}" for name in ANGLE_NAMES])]
    table = trial_features(ranges)
    return table.assign(angle=table["feature"].str.removeprefix("rom_"))


def table_4_6(strides: pd.DataFrame, options: TableOptions) -> pd.DataFrame:
    """Peaks and the angle at contact.

    Parameters
    ----------
    strides : DataFrame
    options : TableOptions
        A relative difference is left out where the OPTIC mean is not larger than its
        ``smallest_denominator_deg``.

    Returns
    -------
    DataFrame
        OPTIC, ErKF, RMSD and rRMSD as printed.
    """
    stems = {"optic_deg": "optic", "erkf_deg": "erkf", "rmsd_deg": "rmsd", "rrmsd_pct": "rrmsd_pct"}
    features = trial_features(strides[strides["feature"].isin(FEATURES)])
    table = summary_table(features, "feature", FEATURES, stems)
    small = ~(table["optic_deg_mean"].abs() > options.smallest_denominator_deg)
    table.loc[small, [f"rrmsd_pct_{part}" for part in ("mean", "sd", "se")]] = np.nan
    return table


def table_4_7(strides: pd.DataFrame) -> pd.DataFrame:
    """Stride length and width.

    The print's MD is OPTIC − ErKF of lengths, but ErKF − OPTIC of widths (register I-21); so is
    ours, and ``bias_m`` is ErKF − OPTIC of both. A relative difference of the width is not given,
    as in the print.

    Parameters
    ----------
    strides : DataFrame

    Returns
    -------
    DataFrame
        As printed, then bias, the bias in percent, and the signed width (positive: the foot lands
        on its own side of the other's line), which unlike the width is not biased upward.
    """
    features = trial_features(strides[strides["feature"].isin(STRIDE_MEASURES.values())])
    names = {feature: measure for measure, feature in STRIDE_MEASURES.items()}
    features["measure"] = features["feature"].map(names)
    is_width = features["measure"] == "stride_width"
    features["md"] = np.where(is_width, features["difference"], -features["difference"])
    features["bias_pct"] = 100.0 * features["difference"] / features["optic"]
    features.loc[is_width, ["rrmsd_pct", "bias_pct"]] = np.nan
    stems = {
        "optic_m": "optic",
        "erkf_m": "erkf",
        "md_m": "md",
        "rmsd_m": "rmsd",
        "rrmsd_pct": "rrmsd_pct",
        "bias_m": "difference",
        "bias_pct": "bias_pct",
    }
    table = summary_table(features, "measure", list(STRIDE_MEASURES), stems)
    signed = trial_features(strides[strides["feature"] == "stride_width_signed_m"])
    signed = signed.assign(measure="stride_width")
    columns = {"optic_signed_m": "optic", "erkf_signed_m": "erkf"}
    extra = summary_table(signed, "measure", ["stride_width"], columns)
    return table.merge(
        extra.drop(columns=["n_trials", *(f"{stem}_se" for stem in columns)]),
        on=["measure", "side"],
        how="left",
    )


def table_4_8(perturbation: pd.DataFrame, truth: pd.DataFrame | None) -> pd.DataFrame:
    """How accurate markers are expected to be, and how accurate they turned out.

    Parameters
    ----------
    perturbation : DataFrame
        Of all participants, from :func:`swaystride.mocap.perturbation.perturbed_angles`, with
        ``participant`` and ``trial``.
    truth : DataFrame or None
        Errors against the truth of a simulated cohort: ``source``, ``angle``, ``bias_deg``,
        ``rmsd_trial_deg``.

    Returns
    -------
    DataFrame
        ``angle, optic_expectation`` as printed; then, means over trials and sides: the largest
        offset and change of shape under a shifted joint centre, and against the truth the size of
        the bias and the RMSD after one constant of both sources (missing without truth).
    """
    rows = []
    shifted = _largest_by_trial(perturbation)
    for angle, words in OPTIC_EXPECTATIONS.items():
        own = shifted[shifted["angle"] == angle]
        row: dict[str, object] = {
            "angle": angle,
            "optic_expectation": words,
            "largest_offset_deg": own["offset_deg"].mean(),
            "largest_shape_deg": own["shape_deg"].mean(),
        }
        for source in SOURCES:
            bias = rmsd = float("nan")
            if truth is not None:
                errors = truth[(truth["angle"] == angle) & (truth["source"] == source)]
                bias, rmsd = errors["bias_deg"].abs().mean(), errors["rmsd_trial_deg"].mean()
            row |= {f"{source}_true_bias_deg": bias, f"{source}_true_rmsd_trial_deg": rmsd}
        rows.append(row)
    return pd.DataFrame(rows)


def with_angle_names(perturbation: pd.DataFrame) -> pd.DataFrame:
    """Name each angle as the tables do, and its side, instead of joint and axis.

    Parameters
    ----------
    perturbation : DataFrame
        ``joint`` such as ``left_knee`` and ``angle`` such as ``adduction``.

    Examples
    --------
    >>> frame = pd.DataFrame({"joint": ["left_knee"], "angle": ["adduction"]})
    >>> with_angle_names(frame)[["side", "angle"]].values.tolist()
    [['left', 'knee_adduction']]
    """
    names = {(angle.joint, angle.angle): angle.name for angle in JOINT_ANGLES}
    parts = perturbation["joint"].str.split("_", n=1, expand=True)
    keys = zip(parts[1], perturbation["angle"], strict=True)
    return perturbation.assign(side=parts[0], angle=[names[key] for key in keys])


def _largest_by_trial(perturbation: pd.DataFrame) -> pd.DataFrame:
    """Largest effect of any shift on each angle, by trial and side."""
    named = with_angle_names(perturbation)
    sizes = named.assign(offset_deg=named["offset_deg"].abs())
    keys = [*TRIAL_KEYS, "side", "angle"]
    return sizes.groupby(keys, sort=False)[["offset_deg", "shape_deg"]].max().reset_index()


def cohort_table(participants: pd.DataFrame) -> pd.DataFrame:
    """Who took part.

    Parameters
    ----------
    participants : DataFrame

    Returns
    -------
    DataFrame
        One row: ``n``, ``n_female``, mean and standard deviation (n − 1) of age, height and mass.
    """
    row: dict[str, float] = {
        "n": len(participants),
        "n_female": int((participants["sex"] == "F").sum()),
    }
    for name in ("age_years", "height_m", "mass_kg"):
        row[f"{name}_mean"] = participants[name].mean()
        row[f"{name}_sd"] = participants[name].std()
    return pd.DataFrame([row])


def agreement_by_trial(agreement: pd.DataFrame) -> pd.DataFrame:
    """Agreement of every single trial, for readers who look for the odd one.

    Parameters
    ----------
    agreement : DataFrame

    Returns
    -------
    DataFrame
        Trial, side, angle, strides, bias, R², RMSD raw and after one constant; rows by trial.
    """
    columns = [
        *TRIAL_KEYS,
        "side",
        "angle",
        "n_strides",
        "rom_deg",
        "bias_deg",
        "r2",
        "rmsd_deg",
        "rmsd_trial_deg",
        "rmsd_ensemble_deg",
    ]
    order = {side: at for at, side in enumerate(SIDES)}
    table = agreement[columns].assign(at=agreement["side"].map(order))
    return (
        table.sort_values([*TRIAL_KEYS, "at"], kind="stable")
        .drop(columns="at")
        .reset_index(drop=True)
    )
