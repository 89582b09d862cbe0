"""Measures of one participant: every trial and foot under every condition of the four experiments."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import pandas as pd

from swaystride.errors import RecordingError
from swaystride.findings import FINDING_COLUMNS, Finding, findings_from_json
from swaystride.gait.foot_methods import FootMethod
from swaystride.gait.strides import distance_m, stride_table
from swaystride.gait.trajectory import foot_trajectory
from swaystride.studies.imu_design.conditions import Signals, limited
from swaystride.studies.imu_design.design import Imu
from swaystride.studies.imu_design.experiments import EXPERIMENTS, ExperimentSettings, effect_name
from swaystride.studies.imu_design.signals_file import load_signals
from swaystride.studies.imu_design.stride_differences import (
    DIFFERENCE_COLUMNS,
    difference_summary,
)

#: One row per trial, foot, experiment and condition.
METRIC_COLUMNS: Final = (
    "participant",
    "trial",
    "foot",
    "experiment",
    "condition",
    "level",
    "known_distance_m",
    "motion_start_s",
    "motion_stop_s",
    "distance_m",
    "n_strides",
    "loss_percent",
    *DIFFERENCE_COLUMNS,
)
STRIDE_COLUMNS: Final = (
    "participant",
    "trial",
    "foot",
    "imu",
    "start_s",
    "stop_s",
    "length_m",
    "angle_rad",
    "speed_m_s",
    "is_half",
)


@dataclass(frozen=True, eq=False)
class FootEstimate:
    """What one trajectory says.

    Parameters
    ----------
    strides : DataFrame
        From :func:`swaystride.gait.strides.stride_table`.
    motion_start_s, motion_stop_s : float
        End of the first rest and begin of the last one.
    findings : list of Finding
    """

    strides: pd.DataFrame
    motion_start_s: float
    motion_stop_s: float
    findings: list[Finding]


@dataclass(frozen=True, eq=False)
class ParticipantMeasures:
    """Tables of one participant.

    Parameters
    ----------
    conditions : DataFrame
        :data:`METRIC_COLUMNS`.
    strides : DataFrame
        :data:`STRIDE_COLUMNS`: strides of the recordings as they are.
    findings : DataFrame
        ``participant``, ``trial`` and the columns of a finding.
    """

    conditions: pd.DataFrame
    strides: pd.DataFrame
    findings: pd.DataFrame


def foot_estimate(signals: Signals, method: FootMethod) -> FootEstimate:
    """Trajectory and strides of one recording of one foot.

    Parameters
    ----------
    signals : Signals
    method : FootMethod

    Raises
    ------
    RecordingError
        If the recording holds no trajectory, for example because the foot never rests.
    """
    trajectory = foot_trajectory(signals.acc_m_s2, signals.gyr_rad_s, signals.rate_hz, method)
    return FootEstimate(
        stride_table(trajectory),
        float(trajectory.attrs["motion_start_s"]),
        float(trajectory.attrs["motion_stop_s"]),
        findings_from_json(trajectory.attrs["findings"]),
    )


def measure_participant(
    trials: pd.DataFrame, file: Path, method: FootMethod, settings: ExperimentSettings
) -> ParticipantMeasures:
    """Measure every recording of one participant under every condition.

    Parameters
    ----------
    trials : DataFrame
        Rows of the participant whose recording was imported
        (:func:`swaystride.studies.imu_design.design.usable_trials`).
    file : Path
        The participant's recordings, one in memory at a time.
    method : FootMethod
    settings : ExperimentSettings

    Returns
    -------
    ParticipantMeasures

    Raises
    ------
    RecordingError
        If a recording as it is holds no trajectory. A condition under which it holds none is a
        finding, and its row has no distance.
    """
    conditions: list[dict[str, object]] = []
    strides: list[pd.DataFrame] = []
    findings: list[dict[str, object]] = []
    for row in trials.to_dict("records"):
        key = {name: row[name] for name in ("participant", "trial", "foot")}
        signals, name = load_signals(file, row["recording"])
        recorded = _estimate_of_file(signals, method, name)
        strides.append(recorded.strides.assign(**key, imu=row["imu"]))
        measured, found = recording_conditions(signals, recorded, row["imu"], method, settings)
        common = {
            **key,
            "known_distance_m": row["distance_m"],
            "motion_start_s": recorded.motion_start_s,
            "motion_stop_s": recorded.motion_stop_s,
        }
        conditions += [{**common, **condition} for condition in measured]
        where = f"{row['foot']} foot, {row['imu']}"
        for finding in [*recorded.findings, *found]:
            place = ", ".join(filter(None, (where, finding.place)))
            located = {**asdict(finding), "file": name, "place": place}
            findings.append({"participant": row["participant"], "trial": row["trial"], **located})
    return ParticipantMeasures(
        pd.DataFrame(conditions, columns=list(METRIC_COLUMNS)),
        pd.concat(strides, ignore_index=True)[list(STRIDE_COLUMNS)]
        if strides
        else pd.DataFrame(columns=list(STRIDE_COLUMNS)),
        pd.DataFrame(findings, columns=["participant", "trial", *FINDING_COLUMNS]),
    )


def recording_conditions(
    signals: Signals,
    recorded: FootEstimate,
    imu: Imu,
    method: FootMethod,
    settings: ExperimentSettings,
) -> tuple[list[dict[str, object]], list[Finding]]:
    """Measure one recording under each condition of its IMU.

    Parameters
    ----------
    signals : Signals
        As recorded.
    recorded : FootEstimate
        Estimate from them; a condition that changes no sample shares it.
    imu : {"imu_1", "imu_2"}
    method : FootMethod
    settings : ExperimentSettings

    Returns
    -------
    conditions : list of dict
        ``experiment``, ``condition``, ``level``, ``loss_percent``, ``distance_m``, ``n_strides``
        and the differences from the baseline of the experiment; the last ones are missing where
        there is no estimate.
    findings : list of Finding
        Conditions without an estimate.
    """
    rows: list[dict[str, object]] = []
    findings: list[Finding] = []
    for experiment, (own, _) in EXPERIMENTS.items():
        if own != imu:
            continue
        baseline: FootEstimate | None = None
        for position, level in enumerate(settings.levels(experiment)):
            condition = effect_name(experiment, level, baseline=position == 0)
            changed, loss = limited(signals, experiment, level, settings)
            row: dict[str, object] = {
                "experiment": experiment,
                "condition": condition,
                "level": level,
                "loss_percent": loss,
            }
            rows.append(row)
            try:
                same = changed.same_as(signals)
                estimate = recorded if same else foot_estimate(changed, method)
            except RecordingError as error:
                reason = str(error)
                findings.append(
                    Finding("no_trajectory", "warning", "", condition, "a trajectory", reason)
                )
                continue
            if position == 0:
                baseline = estimate
            row["distance_m"] = distance_m(estimate.strides)
            row["n_strides"] = len(estimate.strides)
            if baseline is not None:
                row.update(difference_summary(baseline.strides, estimate.strides))
    return rows, findings


def _estimate_of_file(signals: Signals, method: FootMethod, file: str) -> FootEstimate:
    """Estimate of a recording as it is; an error names its file."""
    try:
        return foot_estimate(signals, method)
    except RecordingError as error:
        raise RecordingError(
            error.problem,
            file=file,
            place=error.place,
            expected=error.expected,
            found=error.found,
        ) from None
