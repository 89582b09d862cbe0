"""Verdicts on the public foot recordings: limits, and what is only reported."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.validation import foot_imu_mocap_walk, foot_imu_vicon
from swaystride.validation.foot_errors import pooled_errors, trial_table
from swaystride.validation.foot_strides import METHODS, FootTrial, all_strides
from swaystride.validation.manifest import verified_files
from swaystride.validation.plane_alignment import align_in_plane
from swaystride.validation.summary import Check, reported

#: Largest accepted pooled errors by gait, in metres: better than every existing result at hand.
VICON_LIMITS: Final = {
    "run": {"rmse_m": 0.033, "bias_m": 0.010},
    "walk": {"rmse_m": 0.028, "bias_m": 0.005},
    "other": {"rmse_m": 0.022},
}
MOCAP_LIMITS: Final = {"walk": {"rmse_m": 0.050}}

_LIMIT: Final = "largest accepted error of this library"
#: Strides of each gait in the 22 trials.
_VICON_STRIDES: Final = {"run": 187, "walk": 276, "other": 28}
_WORDS: Final = {
    "rmse_m": "RMSE of stride length, m",
    "bias_m": "bias, m",
    "sd_m": "SD of the error, m",
    "median_abs_m": "median absolute error, m",
    "median_trial_rmse_m": "median RMSE of a trial, m",
}


def vicon_checks(trials: Sequence[FootTrial], folder: Path) -> list[Check]:
    """Checks of ``foot_imu_vicon``.

    Parameters
    ----------
    trials : sequence of FootTrial
    folder : Path
        Folder with public recordings.
    """
    dataset, strides = foot_imu_vicon.DATASET, all_strides(list(trials))
    counts = strides["gait"].value_counts()
    checks = [Check(dataset, "trials computed", float(len(trials)), 22.0, "files at hand", 0.0)]
    checks += [
        Check(dataset, f"{gait}: strides", float(counts.get(gait, 0)), float(n), "files at hand", 0)
        for gait, n in _VICON_STRIDES.items()
    ]
    return [
        *checks,
        *_frame_checks(trials, folder),
        *limit_checks(dataset, strides, VICON_LIMITS),
        *distance_checks(dataset, trials),
    ]


def mocap_checks(trials: Sequence[FootTrial]) -> list[Check]:
    """Checks of ``foot_imu_mocap_walk``.

    Parameters
    ----------
    trials : sequence of FootTrial
    """
    dataset, strides = foot_imu_mocap_walk.DATASET, all_strides(list(trials))
    checks = [Check(dataset, "strides of both feet", float(len(strides)), 57.0, "files at hand", 0)]
    checks += limit_checks(dataset, strides, MOCAP_LIMITS)
    for foot, rows in strides.groupby("trial", sort=False):
        for marker in (foot_imu_mocap_walk.HEEL_MARKER, *foot_imu_mocap_walk.OTHER_MARKERS):
            is_heel = marker == foot_imu_mocap_walk.HEEL_MARKER
            column = "reference_m" if is_heel else f"reference_{marker.lower()}_m"
            errors = pooled_errors(rows, "length_m", column)
            note = f"bias {1000 * errors['bias_m']:+.0f} mm, {len(rows)} strides"
            label = f"{foot}: RMSE against {marker}, m"
            checks.append(reported(dataset, label, errors["rmse_m"], note))
    return checks + distance_checks(dataset, trials)


def hand_of_paths(trials: Sequence[FootTrial]) -> pd.DataFrame:
    """Remaining distance of our path from the optical one after a rotation and a reflection.

    Parameters
    ----------
    trials : sequence of FootTrial

    Returns
    -------
    DataFrame
        ``trial``, ``rotated_m``, ``mirrored_m``.
    """
    rows = []
    for trial in trials:
        paths = trial.path_at_frames, trial.recording.path_m
        rotated, mirrored = (align_in_plane(*paths, mirrored=hand).rms_m for hand in (False, True))
        rows.append((trial.recording.trial, rotated, mirrored))
    return pd.DataFrame(rows, columns=["trial", "rotated_m", "mirrored_m"])


def _frame_checks(trials: Sequence[FootTrial], folder: Path) -> list[Check]:
    """What the files say of their frame, and the hand of the paths."""
    dataset = foot_imu_vicon.DATASET
    paths = [path for path in verified_files(folder, dataset) if path.suffix == ".mat"]
    frames = pd.DataFrame([foot_imu_vicon.sensor_frame_residual(path) for path in paths])
    hands = hand_of_paths(trials)
    n_right = float((hands["rotated_m"] < hands["mirrored_m"]).sum())
    return [
        Check(
            dataset,
            "acc_n − R(euler) acc − (0, 0, 9.8) in the files, 99th percentile, m/s²",
            float(frames["difference_m_s2"].max()),
            0.0,
            "proper acceleration in a frame with z down",
            0.01,
        ),
        reported(
            dataset,
            "acceleration along the file's z at rest, largest, m/s²",
            float(frames["rest_z_m_s2"].max()),
            "below 0: it points up along -z",
        ),
        Check(
            dataset,
            "paths that fit Vicon by a rotation better than by a reflection",
            n_right,
            float(len(hands)),
            "all trials",
            0.0,
        ),
        reported(
            dataset,
            "distance of the aligned path from Vicon's: median RMS of a trial, m",
            float(np.median(hands["rotated_m"])),
            "best turn and shift in the plane",
        ),
    ]


def limit_checks(
    dataset: str, strides: pd.DataFrame, limits: Mapping[str, Mapping[str, float]]
) -> list[Check]:
    """Pooled errors of ours against their limits, everybody else's reported.

    Parameters
    ----------
    dataset : str
    strides : DataFrame
        As from :func:`swaystride.validation.foot_strides.all_strides`.
    limits : mapping
        Gait → quantity (``rmse_m`` or ``bias_m``) → largest accepted absolute value.
    """
    checks = []
    for gait, limits_of_gait in limits.items():
        chosen = strides[strides["gait"] == gait]
        ours = pooled_errors(chosen, "length_m")
        checks += [
            Check(dataset, f"{gait}: {_WORDS[quantity]}", ours[quantity], 0.0, _LIMIT, limit)
            for quantity, limit in limits_of_gait.items()
        ]
        for quantity in ("rmse_m", "bias_m", "sd_m", "median_abs_m", "median_trial_rmse_m"):
            if quantity not in limits_of_gait:
                note = f"{int(ours['n'])} strides"
                checks.append(
                    reported(dataset, f"{gait}: {_WORDS[quantity]}", ours[quantity], note)
                )
        for column, name in list(METHODS.items())[1:]:
            theirs = pooled_errors(chosen, column)
            if theirs["n"] > 0:
                checks += [
                    reported(dataset, f"{gait}: {_WORDS[quantity]}: {name}", theirs[quantity], "")
                    for quantity in ("rmse_m", "bias_m")
                ]
    if strides["gaitmap_m"].isna().all():
        note = "no numbers of gaitmap at hand; `make peers`, then `make validation`"
        checks.append(reported(dataset, "strides with a length by gaitmap", 0.0, note))
    return checks


def distance_checks(dataset: str, trials: Sequence[FootTrial]) -> list[Check]:
    """Sums of stride lengths, and strides between our own epochs; all reported.

    Parameters
    ----------
    dataset : str
    trials : sequence of FootTrial
    """
    error = trial_table(trials)["distance_error_percent"].abs()
    given = all_strides(list(trials))
    own = pd.concat(
        [trial.own_strides.assign(trial=trial.recording.trial) for trial in trials],
        ignore_index=True,
    )
    own_errors = pooled_errors(own, "length_m")
    note = (
        f"{len(own)} strides found by the library, half strides included; {len(given)} were given"
    )
    return [
        reported(dataset, "distance of a trial: median absolute error, %", error.median(), ""),
        reported(dataset, "distance of a trial: largest absolute error, %", error.max(), ""),
        reported(dataset, "own strides: RMSE, m", own_errors["rmse_m"], note),
        reported(dataset, "own strides: bias, m", own_errors["bias_m"], note),
    ]
