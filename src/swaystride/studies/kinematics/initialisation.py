"""Where the filter starts and what it takes as known: from the markers, or from the sensors alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf.alignment import level_mounting
from swaystride.erkf.body import Body, lower_limb_body
from swaystride.erkf.imu_initialisation import (
    DISTAL_SHANK_CENTRES,
    CentreSearch,
    facing_forward,
    imu_centres,
    level_orientations,
    start_in_stance,
)
from swaystride.erkf.optical_initialisation import (
    mounting_from_static,
    optical_centres,
    optical_start,
)
from swaystride.erkf.start import Start, StartUncertainty
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.signals.segment_alignment import standing_vertical
from swaystride.studies.kinematics.optics import OpticalTrial

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

#: Rows of ``SEGMENTS`` that are feet, right and left.
FEET: tuple[int, int] = (SEGMENTS.index("right_foot"), SEGMENTS.index("left_foot"))


@dataclass(frozen=True)
class Initialisation:
    """How mounting, joint centres and start are found.

    Parameters
    ----------
    source : {"optical", "imu"}
        The markers, as printed, or the sensors alone.
    pelvis_right : tuple of float
        Axis of the pelvis sensor that is mounted to point right.
    axis_cutoff_hz : float
        Low-pass of the rates before main axes are sought.
    contact_height_m : float
        Height of a foot sensor above the contact point.
    heading_s : float
        From the sensors alone: time over which all segments face forward on average.
    """

    source: Literal["optical", "imu"]
    pelvis_right: tuple[float, float, float]
    axis_cutoff_hz: float
    contact_height_m: float
    heading_s: float


class Known(NamedTuple):
    """Result of :func:`initialise`: ``body``, ``sample`` at which the filter starts, ``start``."""

    body: Body
    sample: int
    start: Start


def initialise(
    acc_m_s2: Array,
    gyr_rad_s: Array,
    standing_acc_m_s2: Array,
    zero_velocity: Flags,
    optical: OpticalTrial,
    belt_speed_m_s: float,
    initialisation: Initialisation,
    search: CentreSearch,
    uncertainty: StartUncertainty,
) -> Known:
    """Body and start of one trial.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (7, 3, n)
        In running, rates without bias.
    standing_acc_m_s2 : ndarray, shape (7, 3, m)
    zero_velocity : ndarray of bool, shape (2, n)
        Right and left foot.
    optical : OpticalTrial
        Read only if the source is optical.
    belt_speed_m_s : float
    initialisation : Initialisation
    search : CentreSearch
        Read only if the sensors stand alone.
    uncertainty : StartUncertainty

    Returns
    -------
    Known
    """
    levers = contact_levers(acc_m_s2, zero_velocity, initialisation.contact_height_m)
    if initialisation.source == "optical":
        return _from_markers(
            gyr_rad_s,
            standing_acc_m_s2,
            levers,
            optical,
            belt_speed_m_s,
            initialisation,
            uncertainty,
        )
    return _from_sensors(
        acc_m_s2,
        gyr_rad_s,
        standing_acc_m_s2,
        levers,
        zero_velocity,
        optical.poses.rate_hz,
        initialisation,
        search,
        uncertainty,
    )


def contact_levers(acc_m_s2: Array, zero_velocity: Flags, height_m: float) -> dict[str, Array]:
    """Vectors from the foot sensors straight down, as gravity shows it in their stances.

    Parameters
    ----------
    acc_m_s2 : ndarray, shape (7, 3, n)
    zero_velocity : ndarray of bool, shape (2, n)
    height_m : float

    Returns
    -------
    dict of str to ndarray, shape (3,)
        For ``right_foot`` and ``left_foot``, in axes of the sensor.
    """
    found = {}
    for row, flags in zip(FEET, zero_velocity, strict=True):
        found[SEGMENTS[row]] = -height_m * standing_vertical(acc_m_s2[row][:, flags])
    return found


def _from_markers(
    gyr: Array,
    standing_acc: Array,
    levers: dict[str, Array],
    optical: OpticalTrial,
    belt_speed_m_s: float,
    initialisation: Initialisation,
    uncertainty: StartUncertainty,
) -> Known:
    """As printed (methods §1.7, §4.6)."""
    mounting = mounting_from_static(
        standing_acc,
        gyr,
        optical.r_world_from_segment_standing,
        pelvis_right=np.array(initialisation.pelvis_right),
        rate_hz=optical.poses.rate_hz,
        cutoff_hz=initialisation.axis_cutoff_hz,
    )
    body = lower_limb_body(mounting, optical_centres(optical.poses, mounting), levers)
    sample, start = optical_start(
        optical.poses,
        mounting,
        uncertainty,
        belt_speed_m_s=belt_speed_m_s,
        gyr_bias_rad_s=np.zeros((len(SEGMENTS), 3)),
    )
    return Known(body, sample, start)


def _from_sensors(
    acc: Array,
    gyr: Array,
    standing_acc: Array,
    levers: dict[str, Array],
    zero_velocity: Flags,
    rate_hz: float,
    initialisation: Initialisation,
    search: CentreSearch,
    uncertainty: StartUncertainty,
) -> Known:
    """Without markers (methods §1.7, §1.13)."""
    mounting = level_mounting(
        standing_acc,
        gyr,
        pelvis_right=np.array(initialisation.pelvis_right),
        rate_hz=rate_hz,
        cutoff_hz=initialisation.axis_cutoff_hz,
    )
    fits = imu_centres(acc, gyr, mounting, rate_hz, rough=DISTAL_SHANK_CENTRES, search=search)
    centres = {name: (fit.proximal_m, fit.distal_m) for name, fit in fits.items()}
    body = lower_limb_body(mounting, centres, levers)
    first = slice(0, round(initialisation.heading_s * rate_hz))
    orientation = level_orientations(acc[:, :, first], gyr[:, :, first], rate_hz)
    segments = facing_forward(orientation @ np.swapaxes(mounting, 1, 2), slice(None))
    sample, start = start_in_stance(
        segments @ mounting,
        gyr,
        zero_velocity,
        body,
        np.zeros((len(SEGMENTS), 3)),
        uncertainty,
    )
    return Known(body, sample, start)
