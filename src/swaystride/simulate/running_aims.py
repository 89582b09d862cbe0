"""Hip and knee flexion of real runners, which placement and swing of the simulated one aim at.

The curves depend on the speed: a faster runner keeps the hip extended for longer and bends the knee
later and further, which no scaling of a slow runner's curve gives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.running_body import RunnerBody
from swaystride.simulate.running_manner import fourier
from swaystride.simulate.running_stride_phase import phase_pieces

Array = NDArray[np.float64]

#: Phase by which the toe-off of the model's foot, which rolls on a rigid sole, is best put later in the
#: curves than the force plates have it; chosen on the curves of running_markers_grf. Spec §9.1 likewise
#: found 0.33 best at a duty factor of 0.28.
TOE_OFF_LAG: Final = 0.02


@dataclass(frozen=True)
class AimCurves:
    """Curves of real runners at some speeds, scaled to a range of 1.

    Parameters
    ----------
    speed_m_s, duty_factor : ndarray, shape (n,)
        Of the runners.
    mean : dict of str to ndarray, shape (n,)
        Mean flexion of hip and knee over their ranges.
    shape : dict of str to ndarray, shape (n, 12)
        Fourier coefficients of hip and knee.
    """

    speed_m_s: Array
    duty_factor: Array
    mean: dict[str, Array]
    shape: dict[str, Array]

    def weights(self, speed_m_s: ArrayLike) -> Array:
        """Share of every row at any speeds, linear between them.

        Parameters
        ----------
        speed_m_s : array_like
            Speeds of shape (...).

        Returns
        -------
        ndarray, shape (..., n)
        """
        speed = np.asarray(speed_m_s, dtype=np.float64)
        own = np.eye(len(self.speed_m_s))
        return np.stack([np.interp(speed, self.speed_m_s, row) for row in own], axis=-1)


@cache
def aim_curves() -> AimCurves:
    """Curves of ``running_aims.csv`` in this folder."""
    table = pd.read_csv(Path(__file__).with_name("running_aims.csv")).drop(columns="source")
    mean, shape = {}, {}
    for joint in ("hip", "knee"):
        own = table[table["coordinate"] == f"{joint}_flexion"]
        rows = own.loc[:, "a1":].to_numpy(dtype=np.float64)
        ranges = [np.ptp(fourier(row, np.linspace(0.0, 1.0, 2001))[0]) for row in rows]
        mean[joint] = own["a0"].to_numpy(dtype=np.float64) / ranges
        shape[joint] = rows / np.array(ranges)[:, None]
    return AimCurves(
        own["speed_m_s"].to_numpy(np.float64), own["duty_factor"].to_numpy(np.float64), mean, shape
    )


def aim_phase(contact_s: ArrayLike, toe_off_s: ArrayLike, speed_m_s: ArrayLike) -> PiecewiseQuintic:
    """Phase of the strides of one foot in the curves of its speed.

    Parameters
    ----------
    contact_s, toe_off_s : array_like, shape (n,)
        First and last touches in turn.
    speed_m_s : array_like, scalar or shape (n,)
        Speed of the strides.

    Returns
    -------
    PiecewiseQuintic
    """
    aims = aim_curves()
    duty = aims.weights(speed_m_s) @ aims.duty_factor
    return phase_pieces(contact_s, toe_off_s, usual_toe_off=duty + TOE_OFF_LAG, usual_duty=duty)


def aim_angles(
    hip_range_rad: ArrayLike, knee_range_rad: ArrayLike, phase: ArrayLike, speed_m_s: ArrayLike
) -> tuple[Array, Array]:
    """Flexion of thigh (against the vertical) and knee in the mean curves of real runners.

    Parameters
    ----------
    hip_range_rad, knee_range_rad : array_like
        Ranges of the flexion.
    phase : array_like
        Phase of the stride.
    speed_m_s : array_like
        Speed; all four have shapes that broadcast to that of the phase.

    Returns
    -------
    thigh_rad, knee_rad : ndarray

    Examples
    --------
    The knee bends more in swing than in stance:

    >>> _, knee = aim_angles(1.1, 1.7, [0.15, 0.68], 3.5)
    >>> bool(knee[1] > 2 * knee[0])
    True
    """
    aims = aim_curves()
    phase = np.asarray(phase, dtype=np.float64)
    weights = np.broadcast_to(aims.weights(speed_m_s), (*phase.shape, len(aims.speed_m_s)))
    flexion = []
    for joint, size in (("hip", hip_range_rad), ("knee", knee_range_rad)):
        rows = [fourier(row, phase.ravel())[0].reshape(phase.shape) for row in aims.shape[joint]]
        wave = np.sum(weights * (np.stack(rows, axis=-1) + aims.mean[joint]), axis=-1)
        flexion.append(np.asarray(size) * wave)
    return flexion[0], flexion[1]


def aim_way(
    body: RunnerBody,
    hip_range_rad: ArrayLike,
    knee_range_rad: ArrayLike,
    phase: ArrayLike,
    speed_m_s: ArrayLike,
) -> tuple[Array, Array]:
    """Ankle from the hip, forward and up, for the mean curves of hip and knee.

    Parameters
    ----------
    body : RunnerBody
        Lengths.
    hip_range_rad, knee_range_rad : array_like
        Ranges of the flexion.
    phase : array_like
        Phase of the stride.
    speed_m_s : array_like
        Speed.

    Returns
    -------
    forward_m, up_m : ndarray
    """
    thigh, knee = aim_angles(hip_range_rad, knee_range_rad, phase, speed_m_s)
    shank = thigh - knee
    forward = body.thigh_m * np.sin(thigh) + body.shank_m * np.sin(shank)
    return forward, -body.thigh_m * np.cos(thigh) - body.shank_m * np.cos(shank)
