"""Offsets and ranges of the coordinates that follow the strides of each leg."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate._running_kernel import N_COORDINATES
from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.running_manner import RunVariability, curves
from swaystride.simulate.running_steps import RunSteps, correlated
from swaystride.simulate.running_stride_phase import phase_pieces, step_phase_pieces

Array = NDArray[np.float64]

#: Shape and sign of every coordinate, in the order of the kernel. Signs are for the right side and
#: for ISB axes: flexion of the knee is −α, of the elbow +α, a forward lean −α.
COORDINATES: Final = (
    ("hip_rotation", 1.0),
    ("knee_adduction", 1.0),
    ("knee_rotation", -1.0),
    ("shoulder_flexion", 1.0),
    ("shoulder_abduction", -1.0),
    ("shoulder_rotation", 1.0),
    ("elbow_flexion", 1.0),
    ("surge", 1.0),
    ("sway", 1.0),
    ("bob", 1.0),
    ("pelvis_tilt", -1.0),
    ("pelvis_obliquity", -1.0),
    ("pelvis_rotation", 1.0),
    ("trunk_lean", -1.0),
    ("trunk_bend", 1.0),
    ("trunk_rotation", 1.0),
    ("head_nod", -1.0),
    ("head_bend", 1.0),
    ("head_rotation", -1.0),
)
#: The head rotates and bends against the trunk by this share, so that it looks ahead [N].
HEAD_AGAINST: Final = 0.8


@dataclass(frozen=True)
class PhaseTables:
    """Coordinates that follow the strides of one leg.

    Parameters
    ----------
    contact_s : ndarray, shape (n,)
        First touches.
    phase : PiecewiseQuintic
        Phase of the strides.
    offset, amplitude : ndarray, shape (n, N_COORDINATES)
        Of every coordinate at every first touch.
    fourier : ndarray, shape (N_COORDINATES, 12)
        Shapes.
    strength : ndarray, shape (n, 3)
        Size of each impact for pelvis (m/s²), head (m/s²) and soft tissue (m/s).
    """

    contact_s: Array
    phase: PiecewiseQuintic
    offset: Array
    amplitude: Array
    fourier: Array
    strength: Array


def phase_tables(
    steps: RunSteps,
    side: int,
    strength: Array,
    *,
    variability: RunVariability,
    rng: np.random.Generator,
) -> PhaseTables:
    """Tables of the coordinates of one leg and the other arm, or of pelvis, trunk and head.

    Parameters
    ----------
    steps : RunSteps
        Steps of the run.
    side : int
        0 right, 1 left, 2 pelvis, trunk and head, which follow the steps of both legs.
    strength : ndarray, shape (n_steps, 3)
        Size of each impact for pelvis, head and soft tissue.
    variability : RunVariability
        Scatter.
    rng : numpy.random.Generator
        Source of the scatter.

    Returns
    -------
    PhaseTables
    """
    own = slice(side % 2, None, 2)
    contact, toe_off = steps.contact_s[own], steps.toe_off_s[own]
    both = step_phase_pieces(steps.contact_s)
    phase = both if side == 2 else phase_pieces(contact, toe_off)
    shift, size = usual_coordinates(steps.gait, steps.manner)
    offset, amplitude = shift[own], size[own]
    shape = offset.shape
    offset = offset + variability.joint_sd_rad * _noise(rng, shape, variability) * _ANGLES
    amplitude = amplitude * np.exp(variability.range_cv * _noise(rng, shape, variability))
    return signed_phase(side, contact, phase, offset, amplitude, strength[own])


def signed_phase(
    side: int,
    contact_s: Array,
    phase: PiecewiseQuintic,
    offset: Array,
    amplitude: Array,
    strength: Array,
) -> PhaseTables:
    """Phase of a leg from clinical offsets and ranges: shapes and the signs of ISB axes.

    β and γ of left limbs have the other sign. An arm swings with the leg of the other side: the
    left arm belongs to the right phase.

    Parameters
    ----------
    side : int
        0 right, 1 left, 2 both.
    contact_s : ndarray, shape (n,)
        First touches.
    phase : PiecewiseQuintic
        Phase of the strides.
    offset, amplitude : ndarray, shape (n, N_COORDINATES)
        As :func:`usual_coordinates` gives them.
    strength : ndarray, shape (n, 3)
        Sizes of the impacts.

    Returns
    -------
    PhaseTables
    """
    shapes = curves()
    mirrored = (0, 1, 2) if side == 1 else (4, 5)
    sign = np.where(np.isin(np.arange(N_COORDINATES), mirrored), -1.0, 1.0)
    sign *= np.array([sign for _, sign in COORDINATES])
    return PhaseTables(
        contact_s=contact_s,
        phase=phase,
        offset=offset * sign,
        amplitude=amplitude,
        fourier=np.stack([_shape(name, shapes) for name, _ in COORDINATES]) * sign[:, None],
        strength=strength,
    )


#: 1 for angles, 0 for lengths, 0.3 for pelvis, trunk and head, which scatter less [N].
_ANGLES: Final = np.array([1.0] * 7 + [0.0] * 3 + [0.3] * 9)


def _noise(rng: np.random.Generator, shape: tuple[int, ...], variability: RunVariability) -> Array:
    both = correlated(rng, 2 * shape[0], variability.memory, shape[1:])
    return np.asarray(both[::2])


def _shape(name: str, shapes: dict[str, Array]) -> Array:
    """Shape of a coordinate; the head moves against the trunk."""
    if name == "head_bend":
        return shapes["pelvis_obliquity"] * 0.0
    if name == "head_rotation":
        return shapes["trunk_rotation"]
    return shapes[name]


def usual_coordinates(gait: dict[str, Array], manner: dict[str, Array]) -> tuple[Array, Array]:
    """Offsets and ranges of all coordinates, flexion and lean positive, without scatter.

    Parameters
    ----------
    gait, manner : dict of str to ndarray, shape (n,)
        The usual runner, and how this one differs, at each step.

    Returns
    -------
    offset, amplitude : ndarray, shape (n, N_COORDINATES)
        In the order of :data:`COORDINATES`.
    """
    n = len(gait["surge_m"])
    offset, size = np.zeros((n, N_COORDINATES)), np.zeros((n, N_COORDINATES))
    size[:, 0] = gait["hip_rotation_range_rad"] * manner["hip_rotation_range"]
    size[:, 1] = gait["knee_adduction_range_rad"] * manner["knee_adduction_range"]
    size[:, 2] = gait["knee_rotation_range_rad"] * manner["knee_rotation_range"]
    swing = manner["arm_swing"]
    size[:, 3] = gait["shoulder_range_rad"] * swing
    offset[:, 3] = -0.2 * gait["shoulder_range_rad"]
    offset[:, 4] = gait["shoulder_abduction_rad"]
    size[:, 4] = 0.15 * gait["shoulder_range_rad"] * swing
    size[:, 5] = 0.3 * gait["shoulder_range_rad"] * swing
    size[:, 6] = gait["elbow_range_rad"] * swing
    offset[:, 6] = gait["elbow_rad"] + manner["elbow_rad"]
    size[:, 7], size[:, 8], size[:, 9] = 2 * gait["surge_m"], 2 * gait["sway_m"], 2 * gait["bob_m"]
    offset[:, 10] = gait["pelvis_tilt_rad"] + manner["pelvis_tilt_rad"]
    for i, name in enumerate(("tilt", "obliquity", "rotation")):
        size[:, 10 + i] = gait[f"pelvis_{name}_range_rad"] * manner["pelvis_range"]
    # Angles of the trunk are to the pelvis: its lean in space is the sum.
    offset[:, 13] = gait["trunk_lean_rad"] + manner["trunk_lean_rad"] - offset[:, 10]
    for i, name in enumerate(("lean", "bend", "rotation")):
        size[:, 13 + i] = gait[f"trunk_{name}_range_rad"] * manner["trunk_range"]
    offset[:, 16] = -gait["trunk_lean_rad"] - manner["trunk_lean_rad"]
    size[:, 16] = gait["head_nod_range_rad"] * manner["trunk_range"]
    size[:, 18] = HEAD_AGAINST * (size[:, 15] - size[:, 12])
    return offset, size
