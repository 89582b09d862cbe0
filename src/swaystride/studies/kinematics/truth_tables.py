"""What the document could not have: both sources against the truth of a simulated cohort."""

from __future__ import annotations

import pandas as pd

from swaystride.studies.kinematics.plan import (
    RANGE_ANGLES,
    SAGITTAL_ANGLES,
    SIDES,
    SOURCES,
    STRIDE_MEASURES,
)


def truth_angles(truth: pd.DataFrame) -> pd.DataFrame:
    """Errors of both sources by angle and side, means over trials.

    Parameters
    ----------
    truth : DataFrame
        Of all participants: ``source``, ``side``, ``angle``, ``bias_deg``, ``rmsd_deg``,
        ``rmsd_trial_deg`` (after one constant per trial), ``coverage_95`` and
        ``coverage_95_trial`` (after the constant; filter only).

    Returns
    -------
    DataFrame
        ``angle``, ``side``; for each source the bias with its SD over trials, RMSD as it is, and
        RMSD after one constant with its SD; ``erkf_coverage_95``, the share of the truth within
        the band of the filter, and the same after the constant; ``n_trials``.
    """
    rows = []
    for angle in RANGE_ANGLES:
        for side in SIDES:
            own = truth[(truth["angle"] == angle) & (truth["side"] == side)]
            row: dict[str, object] = {"angle": angle, "side": side}
            for source in SOURCES:
                errors = own[own["source"] == source]
                row |= {
                    f"{source}_bias_deg_mean": errors["bias_deg"].mean(),
                    f"{source}_bias_deg_sd": errors["bias_deg"].std(),
                    f"{source}_rmsd_deg_mean": errors["rmsd_deg"].mean(),
                    f"{source}_rmsd_trial_deg_mean": errors["rmsd_trial_deg"].mean(),
                    f"{source}_rmsd_trial_deg_sd": errors["rmsd_trial_deg"].std(),
                }
            filtered = own[own["source"] == "erkf"]
            row["erkf_coverage_95"] = filtered["coverage_95"].mean()
            row["erkf_coverage_95_trial"] = filtered["coverage_95_trial"].mean()
            row["n_trials"] = len(filtered)
            rows.append(row)
    return pd.DataFrame(rows)


def truth_summary(truth: pd.DataFrame) -> pd.DataFrame:
    """Errors after one constant per trial by source and plane.

    Parameters
    ----------
    truth : DataFrame

    Returns
    -------
    DataFrame
        ``source``, ``plane`` (``sagittal``, ``other``), mean over angles and sides of the means
        over trials, the largest of them, which angle and side that is, and the same means without
        the constant removed.
    """
    keys = ["source", "side", "angle"]
    means = truth.groupby(keys, sort=False)[["rmsd_deg", "rmsd_trial_deg"]].mean().reset_index()
    rows = []
    for source in SOURCES:
        for plane, in_plane in (("sagittal", True), ("other", False)):
            is_sagittal = means["angle"].isin(SAGITTAL_ANGLES)
            own = means[(means["source"] == source) & (is_sagittal == in_plane)]
            if own.empty:
                continue
            worst = own.iloc[int(own["rmsd_trial_deg"].to_numpy(dtype=float).argmax())]
            rows.append(
                {
                    "source": source,
                    "plane": plane,
                    "mean_rmsd_trial_deg": own["rmsd_trial_deg"].mean(),
                    "largest_rmsd_trial_deg": worst["rmsd_trial_deg"],
                    "largest_angle": f"{worst['side']} {worst['angle']}",
                    "mean_rmsd_deg": own["rmsd_deg"].mean(),
                    "largest_rmsd_deg": own["rmsd_deg"].max(),
                }
            )
    return pd.DataFrame(rows)


def truth_strides(strides: pd.DataFrame) -> pd.DataFrame:
    """Stride length and width of both sources against the truth.

    Parameters
    ----------
    strides : DataFrame
        ``participant``, ``trial``, ``side``, ``stride``, ``source``, ``measure``, ``estimate``,
        ``truth``, metres.

    Returns
    -------
    DataFrame
        ``measure``, ``side``, ``source``, number of strides, mean truth, bias, bias in percent of
        the mean truth, and root mean square error, over all strides.
    """
    frame = strides.assign(error=strides["estimate"] - strides["truth"])
    frame = frame[frame["error"].notna()].assign(squared=lambda table: table["error"] ** 2)
    rows = []
    for measure in STRIDE_MEASURES.values():
        for side in SIDES:
            for source in SOURCES:
                own = frame[
                    (frame["measure"] == measure)
                    & (frame["side"] == side)
                    & (frame["source"] == source)
                ]
                truth, bias = own["truth"].mean(), own["error"].mean()
                rows.append(
                    {
                        "measure": measure.removesuffix("_m"),
                        "side": side,
                        "source": source,
                        "n_strides": len(own),
                        "truth_m": truth,
                        "bias_m": bias,
                        "bias_pct": 100.0 * bias / truth,
                        "rmsd_m": own["squared"].mean() ** 0.5,
                    }
                )
    return pd.DataFrame(rows)
