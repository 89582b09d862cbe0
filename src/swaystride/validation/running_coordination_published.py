"""Variability of coordination from the strides that the authors of ``running_markers_grf`` publish.

Eight runners at 2.5 m/s, joint angles of single strides. With the pelvis taken to be at rest, thigh,
shank and foot follow from them, which leaves the two couples of the leg; toe-off is taken at one
share of every stride. One of the eight, BMC01, has age, height and mass of RBDS001: our own joint
angles of that runner, put through the same steps, stand beside.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.vector_coding import (
    ANGULAR_DEVIATION,
    N_INTERVALS,
    PERIODS,
    coordination_variability,
)
from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES
from swaystride.mocap.marker_set import SIDES
from swaystride.units import DEG_PER_RAD
from swaystride.validation.running_increments import whole_strides
from swaystride.validation.running_optical import N_PHASES, OpticalRun, optical_runs
from swaystride.validation.running_real import JOINTS, stride_curves

Array = NDArray[np.float64]

#: Toe-off of RBDS001 at 2.5 m/s by the force plates, as a share of the stride; taken for all.
STANCE_SHARE: Final = 0.36
#: The runner of the published strides who is RBDS001, and the trial that our angles are from.
SAME_PERSON: Final = "BMC01"
_TRIAL: Final = "RBDS001 at 2.5 m/s"
_COUPLES: Final = ("foot_shank", "shank_thigh")


def increments_of_joints(flexion_deg: Mapping[str, Array], stance_share: float) -> dict[str, Array]:
    """Changes of thigh, shank and foot from the flexion of three joints, the pelvis at rest.

    Parameters
    ----------
    flexion_deg : mapping of str to ndarray, shape (n_strides, n_phases)
        ``hip``, ``knee``, ``ankle`` (dorsiflexion) from first touch to first touch.
    stance_share : float
        Of the stride.

    Returns
    -------
    dict of str to ndarray, shape (n_strides, 200)
        Degrees; 100 intervals of stance, 100 of swing.

    Examples
    --------
    >>> line = np.linspace(0.0, 100.0, 101)[None]
    >>> steps = increments_of_joints({"hip": line, "knee": 3 * line, "ankle": 0 * line}, 0.4)
    >>> steps["shank"][0, [0, -1]].round(6).tolist()
    [-0.8, -1.2]
    """
    thigh = flexion_deg["hip"]
    shank = thigh - flexion_deg["knee"]
    angles = {"thigh": thigh, "shank": shank, "foot": shank + flexion_deg["ankle"]}
    stance = np.linspace(0.0, stance_share, N_INTERVALS + 1)
    at = np.concatenate([stance, np.linspace(stance_share, 1.0, N_INTERVALS + 1)[1:]])
    phase = np.linspace(0.0, 1.0, thigh.shape[1])
    return {
        segment: np.diff([np.interp(at, phase, stride) for stride in curves], axis=1)
        for segment, curves in angles.items()
    }


def published_table(folder: Path) -> pd.DataFrame:
    """Eight values per runner from joint angles, the authors' and ours.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``runner``, ``angles`` (whose), ``strides``, and a column per couple and period, degrees.
        Runners with fewer strides than count are left out.
    """
    real = stride_curves(folder)
    rows = []
    for runner in np.unique(real.runner):
        own = real.runner == runner
        flexion = {joint: curves[own] for joint, curves in real.angle_deg.items()}
        rows.append({"runner": str(runner), "angles": "authors", **_values(flexion)})
    (same,) = (found for found in optical_runs(folder) if found.run.label == _TRIAL)
    for side in SIDES:
        flexion = _our_flexion(same, side)
        rows.append({"runner": f"RBDS001, {side}", "angles": "ours", **_values(flexion)})
    table = pd.DataFrame(rows)
    return table[table["strides"] >= ANGULAR_DEVIATION.least_strides].reset_index(drop=True)


def _values(flexion_deg: Mapping[str, Array]) -> dict[str, float]:
    """Number of strides, and the values of the two couples of the leg."""
    steps = increments_of_joints(flexion_deg, STANCE_SHARE)
    values = coordination_variability(steps, ANGULAR_DEVIATION)
    names = [f"{couple}_{period}" for couple in _COUPLES for period in PERIODS]
    return {"strides": len(steps["foot"]), **{name: values[name] for name in names}}


def _our_flexion(found: OpticalRun, side: str) -> dict[str, Array]:
    """Flexion of our own joint angles over the strides of a side."""
    strides = whole_strides(found.plates[side])
    start, stop = (strides[name].to_numpy(float) for name in ("start_s", "stop_s"))
    at = start[:, None] + np.linspace(0.0, 1.0, N_PHASES) * (stop - start)[:, None]
    angles = found.angles["medial_markers"]
    time = angles["time"].to_numpy()
    values = DEG_PER_RAD * angles["joint_angle"].to_numpy()[:, ANGLES.index("flexion")]
    return {
        joint: np.interp(at, time, values[JOINT_NAMES.index(f"{side}_{joint}")]) for joint in JOINTS
    }


def differences_from_same_person(table: pd.DataFrame) -> dict[str, float]:
    """Our values of a side minus those from the authors' curves of the same person.

    Parameters
    ----------
    table : DataFrame
        From :func:`published_table`.

    Returns
    -------
    dict of str to float
        The largest size over the eight values, degrees, by side.
    """
    names = [f"{couple}_{period}" for couple in _COUPLES for period in PERIODS]
    values = table.set_index("runner")[names]
    return {
        side: float(np.ptp([values.loc[f"RBDS001, {side}"], values.loc[SAME_PERSON]], axis=0).max())
        for side in SIDES
    }
