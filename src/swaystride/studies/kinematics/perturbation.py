"""Shifted joint centres of one trial: what they do to the angles, and the curves of Figure 4.8."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.gait.stride_curves import N_PHASES, ensemble, stride_curves
from swaystride.lower_limb_joints import Side
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.perturbation import Person, perturbation_table, shifted_angles
from swaystride.studies.kinematics.plan import ANGLE_NAMES, JOINT_ANGLES, SIDES, places
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]

#: Name in ``shifted`` and ``direction`` of the curves without a shift, whose sign is 0.
UNSHIFTED: Final = "none"
#: Columns of both tables.
PERTURBATION_COLUMNS: Final = (
    "shifted",
    "direction",
    "shift_m",
    "joint",
    "angle",
    "offset_deg",
    "shape_deg",
)
CURVE_COLUMNS: Final = ("shifted", "direction", "sign", "side", "angle", "phase_pct", "mean_deg")


@dataclass(frozen=True)
class PerturbationRule:
    """Which strides are computed again (config/studies/kinematics.yaml, ``analysis.perturbation``).

    Parameters
    ----------
    n_dropped : int
        Strides at the start that are left out.
    n_strides : int
        Strides of each foot after them.
    """

    n_dropped: int
    n_strides: int


@dataclass(frozen=True, eq=False)
class TrialPerturbation:
    """Tables of one trial, without columns for participant and trial.

    Parameters
    ----------
    table : DataFrame
        As from :func:`swaystride.mocap.perturbation.perturbed_angles`.
    curves : DataFrame
        ``shifted``, ``direction``, ``sign``, ``side``, ``angle``, ``phase_pct``, ``mean_deg``; those
        without a shift first.
    """

    table: pd.DataFrame
    curves: pd.DataFrame


def trial_perturbation(
    recording: MarkerRecording,
    person: Person,
    contact_s: dict[Side, ArrayLike],
    rule: PerturbationRule,
) -> TrialPerturbation:
    """Shift the joint centres of one trial.

    Parameters
    ----------
    recording : MarkerRecording
        Clean markers of the whole trial.
    person : Person
        How it was calibrated.
    contact_s : dict of str to array_like
        Initial contacts of both feet in the clock of the markers, rising, the first ones of the
        recording included.
    rule : PerturbationRule

    Returns
    -------
    TrialPerturbation

    Raises
    ------
    RecordingError
        If a foot has no stride after the dropped ones, or contacts lie outside the recording.
    """
    chosen = {side: _chosen(contact_s[side], rule, side) for side in SIDES}
    time_s = recording["time"].to_numpy()
    begin_s = min(float(contacts[0]) for contacts in chosen.values())
    end_s = max(float(contacts[-1]) for contacts in chosen.values())
    if begin_s < time_s[0] or end_s > time_s[-1]:
        raise RecordingError(
            "contacts lie outside the markers",
            expected=f"between {time_s[0]:.2f} and {time_s[-1]:.2f} s",
            found=f"{begin_s:.2f} to {end_s:.2f} s",
        )
    first = int(np.searchsorted(time_s, begin_s, side="right")) - 1
    stop = int(np.searchsorted(time_s, end_s, side="left")) + 1
    part = recording.isel(time=slice(first, stop))
    samples = np.arange(stop - first, dtype=np.float64)
    at = {side: np.interp(chosen[side], time_s[first:stop], samples) for side in SIDES}
    reference, shifted = shifted_angles(part, person)
    curves = [_curves(reference, at, (UNSHIFTED, UNSHIFTED, 0))]
    curves += [
        _curves(one.joint_angle_rad, at, (one.shifted, one.direction, one.sign)) for one in shifted
    ]
    return TrialPerturbation(
        perturbation_table(reference, shifted), pd.concat(curves, ignore_index=True)
    )


def _chosen(contact_s: ArrayLike, rule: PerturbationRule, side: Side) -> Array:
    """Contacts of the strides that are computed again."""
    contacts = np.asarray(contact_s, dtype=np.float64)
    chosen = contacts[rule.n_dropped : rule.n_dropped + rule.n_strides + 1]
    if chosen.size < 2:
        raise RecordingError(
            "no strides to shift joint centres in",
            place=f"{side} foot",
            expected=f"strides after the first {rule.n_dropped}",
            found=f"{max(contacts.size - 1, 0)} strides",
        )
    return chosen


def _curves(angles_rad: Array, at: dict[Side, Array], key: tuple[str, str, int]) -> pd.DataFrame:
    """Mean curves of all angles under one shift."""
    means = []
    for side in SIDES:
        rows = np.array([places(angle, side) for angle in JOINT_ANGLES])
        own = angles_rad[rows[:, 0], rows[:, 1]] * DEG_PER_RAD
        means.append(ensemble(stride_curves(own, at[side][:-1], at[side][1:]))[0])
    each = len(ANGLE_NAMES) * N_PHASES
    shifted, direction, sign = key
    return pd.DataFrame(
        {
            "shifted": shifted,
            "direction": direction,
            "sign": sign,
            "side": np.repeat(SIDES, each),
            "angle": np.tile(np.repeat(ANGLE_NAMES, N_PHASES), len(SIDES)),
            "phase_pct": np.tile(np.arange(N_PHASES), len(SIDES) * len(ANGLE_NAMES)),
            "mean_deg": np.concatenate(means).ravel(),
        }
    )
