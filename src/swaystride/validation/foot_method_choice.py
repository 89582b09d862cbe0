"""How much the recommended foot method owes to having been chosen on the recordings it is shown on.

Three of its values are varied together on a grid. For every trial the best setting is taken from
all other trials and applied to the one left out: what is pooled from these is the error of a method
that has not seen its trial.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from typing import Any, Final

import numpy as np
import pandas as pd

from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.strides import stride_lengths_at
from swaystride.gait.trajectory import foot_trajectory
from swaystride.validation.foot_recording import FootRecording
from swaystride.validation.summary import Check, reported

#: The grid: values of RECOMMENDED that were compared on foot_imu_vicon, around the chosen ones.
GRID: Final[Mapping[str, tuple[float, ...]]] = {
    "lever_height_m": (0.09, 0.11, 0.13),
    "acc_step_share": (0.2, 0.3, 0.4),
    "gyr_step_share": (0.0, 0.1, 0.2),
}


def errors_on_grid(recordings: list[FootRecording]) -> pd.DataFrame:
    """Error of every given stride under every setting of the grid.

    Parameters
    ----------
    recordings : list of FootRecording

    Returns
    -------
    DataFrame
        ``trial``, ``gait`` and one column of errors in m for each setting, named by its position.
    """
    parts = []
    for recording in recordings:
        rows: dict[str, Any] = {"trial": recording.trial, "gait": recording.gait}
        for number, values in enumerate(product(*GRID.values())):
            setting: dict[str, Any] = dict(zip(GRID, values, strict=True))
            method = replace(RECOMMENDED, **setting)
            trajectory = foot_trajectory(
                recording.acc_m_s2, recording.gyr_rad_s, recording.rate_hz, method
            )
            lengths = stride_lengths_at(trajectory, recording.instants_s)
            rows[str(number)] = lengths - recording.reference_m
        parts.append(pd.DataFrame(rows))
    return pd.concat(parts, ignore_index=True)


def leave_one_trial_out(errors: pd.DataFrame) -> pd.DataFrame:
    """Errors of each trial under the setting that is best on all other trials.

    Best is the smallest sum over gaits of the root mean square error.

    Parameters
    ----------
    errors : DataFrame
        As from :func:`errors_on_grid`.

    Returns
    -------
    DataFrame
        ``trial``, ``gait``, ``setting`` and ``error_m``, one row per stride.

    Examples
    --------
    >>> table = pd.DataFrame({"trial": ["a", "b"], "gait": "run", "0": [0.1, 0.3], "1": [0.2, 0.2]})
    >>> leave_one_trial_out(table)["error_m"].tolist()
    [0.2, 0.3]
    """
    settings = [name for name in errors.columns if name not in ("trial", "gait")]
    parts = []
    for trial, own in errors.groupby("trial", sort=False):
        others = errors[errors["trial"] != trial]
        squares = others[settings].pow(2).groupby(others["gait"]).mean()
        best = str(squares.pow(0.5).sum().idxmin())
        kept = own[["trial", "gait"]].assign(setting=best, error_m=own[best])
        parts.append(kept)
    return pd.concat(parts, ignore_index=True)


def choice_checks(dataset: str, recordings: list[FootRecording]) -> list[Check]:
    """Pooled errors with every trial left out of the choice, by gait; reported, not judged.

    Parameters
    ----------
    dataset : str
        Name of the data set.
    recordings : list of FootRecording
    """
    left_out = leave_one_trial_out(errors_on_grid(recordings))
    checks = []
    for gait, own in left_out.groupby("gait"):
        error = own["error_m"].to_numpy(dtype=np.float64)
        note = f"best of {np.prod([len(v) for v in GRID.values()])} settings on the other trials"
        for name, value in (("RMSE", np.sqrt(np.mean(error**2))), ("bias", np.mean(error))):
            quantity = f"{gait}: {name} with the trial left out of the choice, m"
            checks.append(reported(dataset, quantity, float(value), note))
    return checks
