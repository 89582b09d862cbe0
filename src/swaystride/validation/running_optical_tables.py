"""Tables of the real runners: our curves against the authors', markers against force plates."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.lower_limb_joints import ANGLES, JOINT_NAMES, Side
from swaystride.mocap.foot_events import RUNNING_CONTACT, ContactRule
from swaystride.mocap.joint_axes import JointAxes, Recipe, average_joint_axes, person_axes
from swaystride.mocap.marker_set import SIDES
from swaystride.units import GRAVITY_M_S2
from swaystride.validation.running_optical import (
    CONTACT_N,
    N_PHASES,
    ONE_STRIDE,
    OpticalRun,
    authors_curve,
    marker_contacts,
    mean_curves,
    optical_runs,
    processed_table,
)
from swaystride.validation.running_optical_recording import (
    CLUSTERS,
    FORCE_RATE_HZ,
    RUNS,
    read_markers,
    runner_file,
    vertical_force,
)

Array = NDArray[np.float64]

#: Contacts by markers and by force plates are the same within this time.
_PAIRED_S: Final = 0.1


def curve_samples(folder: Path) -> pd.DataFrame:
    """Our mean curves and the authors', sample by sample.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``centres`` (way to knee and ankle centres), ``side``, ``joint``, ``angle``,
        ``phase_percent`` of the stride from first touch, ``ours_deg``, ``authors_deg``.
    """
    parts = []
    phase = np.linspace(0.0, 100.0, N_PHASES)
    for found in optical_runs(folder):
        for centres in found.angles:
            for side in SIDES:
                curves = mean_curves(found, centres, side)
                for joint in ("hip", "knee", "ankle"):
                    for a, angle in enumerate(ANGLES):
                        columns = {
                            "trial": found.run.label,
                            "centres": centres,
                            "side": side,
                            "joint": joint,
                            "angle": angle,
                            "phase_percent": phase,
                            "ours_deg": curves[JOINT_NAMES.index(f"{side}_{joint}"), a],
                            "authors_deg": authors_curve(folder, found.run, side, joint, angle),
                        }
                        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def curve_table(samples: pd.DataFrame) -> pd.DataFrame:
    """Agreement of every curve.

    Parameters
    ----------
    samples : DataFrame
        From :func:`curve_samples`.

    Returns
    -------
    DataFrame
        ``trial``, ``centres``, ``side``, ``joint``, ``angle``, ``offset_deg`` (ours minus theirs),
        ``rmsd_deg`` after that constant, ``in_phase_rmsd_deg`` after a shift of the phase besides,
        ``shift_percent`` (of the stride; positive: our first touch is later), ``correlation``,
        ``range_deg``, ``range_authors_deg``.
    """
    rows: list[dict[str, object]] = []
    keys = ["trial", "centres", "side", "joint", "angle"]
    for _, curve in samples.groupby(keys, sort=False):
        ours, theirs = (curve[f"{who}_deg"].to_numpy(np.float64) for who in ("ours", "authors"))
        rows.append(
            {
                **{key: str(curve[key].iloc[0]) for key in keys},
                "offset_deg": float(np.mean(ours - theirs)),
                "rmsd_deg": float(np.std(ours - theirs)),
                **_in_phase(ours, theirs),
                "correlation": float(np.corrcoef(ours, theirs)[0, 1]),
                "range_deg": float(np.ptp(ours)),
                "range_authors_deg": float(np.ptp(theirs)),
            }
        )
    return pd.DataFrame(rows)


def _in_phase(ours: Array, theirs: Array) -> dict[str, float]:
    """What is left when the definitions of first touch are made equal: shift within ±4 %."""
    phase = np.linspace(0.0, 100.0, N_PHASES)
    shifts = np.arange(-40, 41) / 10.0
    left = [np.std(np.interp(phase - k, phase, ours, period=100.0) - theirs) for k in shifts]
    best = int(np.argmin(left))
    return {"in_phase_rmsd_deg": float(left[best]), "shift_percent": float(shifts[best])}


def event_table(folder: Path, rule: ContactRule = RUNNING_CONTACT) -> pd.DataFrame:
    """Events of each foot from markers against the force plates, milliseconds.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    rule : ContactRule
        By default the one that is recommended.

    Returns
    -------
    DataFrame
        ``trial``, ``side``, ``contacts`` (paired), ``unpaired``, mean and standard deviation of the
        errors of first touch, toe-off and contact time, mean and root mean square of the error of
        single stride times.
    """
    rows = []
    for found in optical_runs(folder):
        for side in SIDES if found.plates else ():
            plate = found.plates[side].to_numpy()
            ours = marker_contacts(found.recording, found.run, side, rule).to_numpy()
            nearest = np.argmin(np.abs(ours[:, :1] - plate[:, 0]), axis=1)
            paired = np.abs(ours[:, 0] - plate[nearest, 0]) < _PAIRED_S
            contact, off = (ours - plate[nearest])[paired].T
            near = np.diff(ours[paired, 0])
            stride = np.diff(contact)[near < ONE_STRIDE * np.median(near)]
            rows.append(
                {
                    "trial": found.run.label,
                    "side": side,
                    "contacts": int(paired.sum()),
                    "unpaired": int(len(ours) + len(plate) - 2 * paired.sum()),
                    "touch_bias_ms": 1e3 * contact.mean(),
                    "touch_sd_ms": 1e3 * contact.std(),
                    "toe_off_bias_ms": 1e3 * off.mean(),
                    "toe_off_sd_ms": 1e3 * off.std(),
                    "contact_time_bias_ms": 1e3 * (off - contact).mean(),
                    "contact_time_rms_ms": 1e3 * float(np.sqrt(((off - contact) ** 2).mean())),
                    "stride_time_bias_ms": 1e3 * float(stride.mean()),
                    "stride_time_rms_ms": 1e3 * float(np.sqrt((stride**2).mean())),
                }
            )
    return pd.DataFrame(rows)


def force_difference(folder: Path, found: OpticalRun, side: Side) -> float:
    """How far the authors' mean vertical force is from the force plates, N/kg (root mean square).

    The shape of the force in stance is a fingerprint: it tells whether the published mean is of the
    runner in the trial.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    found : OpticalRun
        With force plates.
    side : {"right", "left"}
    """
    force = vertical_force(folder, found.run)
    per_kg = force / (force.mean() / GRAVITY_M_S2)
    time = np.arange(len(force)) / FORCE_RATE_HZ
    contact = found.plates[side]
    begin, end = (contact[name].to_numpy() for name in ("initial_contact_s", "toe_off_s"))
    share = np.linspace(0.0, 1.0, N_PHASES)
    at = begin[:, None] + share * (end - begin)[:, None]
    ours = np.interp(at, time, per_kg).mean(axis=0)
    table = processed_table(runner_file(folder, found.run.processed))
    column = f"{side[0].upper()}grfY{round(10 * found.run.speed_m_s)}"
    theirs = table[column].dropna().to_numpy(dtype=np.float64)
    theirs = theirs[theirs > CONTACT_N / (force.mean() / GRAVITY_M_S2)]
    return float(
        np.sqrt(np.mean((np.interp(share, np.linspace(0, 1, len(theirs)), theirs) - ours) ** 2))
    )


def recomputed_axes(folder: Path, recipe: Recipe) -> JointAxes:
    """Average joint axes of the static trials at hand.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    recipe : {"spine_plane", "pelvis_forward"}
        Of the knee axis frame.
    """
    files = dict.fromkeys(run.static for run in RUNS)
    people = [
        person_axes(read_markers(runner_file(folder, name)), CLUSTERS, recipe) for name in files
    ]
    return average_joint_axes(people, "static trials at hand", recipe)
