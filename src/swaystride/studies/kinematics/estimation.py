"""Joint angles of one trial from the markers and from the filter, beside each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from swaystride.erkf.imu_initialisation import CentreSearch
from swaystride.erkf.lower_limbs import estimate_lower_limbs
from swaystride.erkf.noise import NoiseSet
from swaystride.erkf.options import FilterOptions
from swaystride.erkf.start import StartUncertainty
from swaystride.findings import Finding, findings_from_json
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.gyroscopic_energy import EnergyRule, energy_zero_velocity
from swaystride.gait.initial_contact import InitialContactRule, initial_contacts
from swaystride.gait.integration import integrated_orientation
from swaystride.gait.zero_velocity import find_zero_velocity
from swaystride.lower_limb_joints import SEGMENTS, Side, lower_limb_angles
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.recording import AXES, Recording, make_recording
from swaystride.rotations import matrix_from_quaternion
from swaystride.studies.kinematics.equipment import Markers
from swaystride.studies.kinematics.estimate_findings import belt_speed, refused_constraints
from swaystride.studies.kinematics.imported_trials import TrialRecordings
from swaystride.studies.kinematics.initialisation import FEET, Initialisation, Known, initialise
from swaystride.studies.kinematics.optics import (
    OpticalMethod,
    OpticalTrial,
    calibrated_person,
    optical_trial,
)
from swaystride.studies.kinematics.plan import ANGLE_NAMES, JOINT_ANGLES, SIDES, SOURCES, places
from swaystride.units import DEG_PER_RAD

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class FilterMethod:
    """One variant of the filter.

    Parameters
    ----------
    method : {"filter", "smoother"}
    zero_velocity : {"gyroscopic_energy", "stillness"}
        Samples of a stance at which a foot is taken to stand still: as printed, or as in the
        recommended foot trajectory.
    contacts : InitialContactRule
    energy : EnergyRule
        Both are read by the first of these rules only.
    initialisation : Initialisation
    centres : CentreSearch
    start : StartUncertainty
    noise : NoiseSet
    options : FilterOptions
    """

    method: Literal["filter", "smoother"]
    zero_velocity: Literal["gyroscopic_energy", "stillness"]
    contacts: InitialContactRule
    energy: EnergyRule
    initialisation: Initialisation
    centres: CentreSearch
    start: StartUncertainty
    noise: NoiseSet
    options: FilterOptions


def estimate_trial(
    trial: TrialRecordings,
    person: Anthropometrics,
    belt_speed_m_s: float,
    optical_method: OpticalMethod,
    method: FilterMethod,
    markers: Markers,
) -> tuple[xr.Dataset, list[Finding]]:
    """Estimate one trial.

    Parameters
    ----------
    trial : TrialRecordings
    person : Anthropometrics
    belt_speed_m_s : float
    optical_method : OpticalMethod
    method : FilterMethod
    markers : Markers

    Returns
    -------
    estimates : Dataset
        ``angle_deg`` (source, side, angle, time) and ``angle_sd_deg`` (side, angle, time), NaN
        before the filter starts and where a marker is missing; ``integrated_deg``, gyroscopes
        alone, within half a turn of the markers;
        ``foot_position_m`` (source, side, axis, time) in the frame of the belt; ``zero_velocity``,
        ``foot_acc_m_s2``, ``foot_gyr_rad_s`` and ``foot_pitch_rate_rad_s`` (side, time);
        ``planar_angle_deg`` (trio, time); times are those of the vendor's file. Attributes ``rate_hz``, ``belt_speed_m_s``,
        ``first_usable_s`` (first sample in the vendor's file).
    findings : list of Finding
        Of the optical side, constraints that were refused, and a belt speed that the markers
        contradict.
    """
    optical = optical_trial(
        trial.markers, calibrated_person(trial.standing_markers, person, optical_method), markers
    )
    rate_hz = float(trial.running.attrs["rate_hz"])
    acc = trial.running["acc"].to_numpy()
    bias = trial.standing["gyr"].to_numpy().mean(axis=2, keepdims=True)
    gyr = trial.running["gyr"].to_numpy() - bias
    still = zero_velocity(acc, gyr, rate_hz, method)
    known = initialise(
        acc,
        gyr,
        trial.standing["acc"].to_numpy(),
        still,
        optical,
        belt_speed_m_s,
        method.initialisation,
        method.centres,
        method.start,
    )
    usable = make_recording(
        rate_hz=rate_hz,
        rate_source="time stamps",
        sensors=SEGMENTS,
        acc_m_s2=acc[:, :, known.sample :],
        gyr_rad_s=gyr[:, :, known.sample :],
        source_file=str(trial.running.attrs["source_file"]),
    )
    filtered = estimate_lower_limbs(
        usable,
        known.body,
        still[:, known.sample :],
        method.noise,
        start=known.start,
        options=method.options,
        method=method.method,
    )
    estimates = _beside_each_other(
        optical, filtered, known, acc, gyr, still, trial.running["time"].to_numpy(), belt_speed_m_s
    )
    estimates.attrs["first_usable_s"] = float(trial.running.attrs["start_s"])
    # those of the markers themselves were told by the import
    told = set(findings_from_json(trial.markers.attrs["findings"]))
    seen = findings_from_json(optical.angles.attrs["findings"])
    new = [finding for finding in seen if finding not in told]
    return estimates, [*new, *refused_constraints(filtered), *belt_speed(estimates)]


def zero_velocity(acc: Array, gyr: Array, rate_hz: float, method: FilterMethod) -> Flags:
    """Samples at which each foot is taken to stand still.

    Parameters
    ----------
    acc, gyr : ndarray, shape (7, 3, n)
        m/s² and rad/s.
    rate_hz : float
    method : FilterMethod

    Returns
    -------
    ndarray of bool, shape (2, n)
        Right and left.
    """
    flags = []
    for row in FEET:
        if method.zero_velocity == "stillness":
            flags.append(find_zero_velocity(acc[row], gyr[row], rate_hz, RECOMMENDED).flags)
            continue
        contacts = initial_contacts(
            np.linalg.norm(acc[row], axis=0),
            np.linalg.norm(gyr[row], axis=0),
            rate_hz,
            method.contacts,
            place=SEGMENTS[row].replace("_", " "),
        )
        flags.append(energy_zero_velocity(gyr[row], rate_hz, contacts, method.energy).flags)
    return np.stack(flags)


def contact_times_s(running: Recording, rule: InitialContactRule) -> dict[Side, Array]:
    """Initial contacts of both feet on the clock of the file.

    Parameters
    ----------
    running : Recording
        Sensors in the order of ``SEGMENTS``.
    rule : InitialContactRule

    Returns
    -------
    dict of str to ndarray
    """
    time_s = running["time"].to_numpy()
    rate_hz = float(running.attrs["rate_hz"])
    acc, gyr = (np.linalg.norm(running[name].to_numpy(), axis=1) for name in ("acc", "gyr"))
    return {
        side: time_s[initial_contacts(acc[row], gyr[row], rate_hz, rule, place=f"{side} foot")]
        for row, side in zip(FEET, SIDES, strict=True)
    }


def integrated_angles(gyr_rad_s: Array, rate_hz: float, known: Known) -> Array:
    """Joint angles by integration of the gyroscopes alone, from the start of the filter.

    Parameters
    ----------
    gyr_rad_s : ndarray, shape (7, 3, n)
        From the start on, without bias.
    rate_hz : float
    known : Known

    Returns
    -------
    ndarray, shape (n, 6, 3)
        Radians.
    """
    mounting = known.body.r_anatomical_from_sensor
    segments = [
        matrix_from_quaternion(integrated_orientation(gyr, rate_hz, start)) @ mounting[j].T
        for j, (gyr, start) in enumerate(
            zip(gyr_rad_s, known.start.q_world_from_sensor, strict=True)
        )
    ]
    return lower_limb_angles(np.stack(segments, axis=1))


def table_angles(joint_angles_rad: Array) -> Array:
    """Angles by side and name of the tables.

    Parameters
    ----------
    joint_angles_rad : ndarray, shape (n, 6, 3)

    Returns
    -------
    ndarray, shape (2, 9, n)
        Degrees; every series within 180° of nil on average.
    """
    degrees = _by_side_and_name(joint_angles_rad) * DEG_PER_RAD
    with np.errstate(invalid="ignore"):
        middle = np.nanmedian(degrees, axis=2, keepdims=True)
    return np.asarray(degrees - 360.0 * np.round(middle / 360.0))


def _by_side_and_name(by_joint: Array) -> Array:
    """Values (n, 6, 3) of the joints in the order of the tables, (2, 9, n)."""
    rows = [[by_joint[(slice(None), *places(a, side))] for a in JOINT_ANGLES] for side in SIDES]
    return np.array(rows)


def _padded(values: Array, before: int) -> Array:
    """Missing values in front, along the last axis."""
    return np.concatenate([np.full((*values.shape[:-1], before), np.nan), values], axis=-1)


def _integrated_beside(from_markers: Array, gyr: Array, rate_hz: float, known: Known) -> Array:
    """Angles of the gyroscopes alone, in degrees, within half a turn of those of the markers.

    A difference of orientations is no more, however often the integration went round.
    """
    integrated = table_angles(integrated_angles(gyr[:, :, known.sample :], rate_hz, known))
    beside = np.nan_to_num(from_markers[:, :, known.sample :])
    return np.asarray(beside + (integrated - beside + 180.0) % 360.0 - 180.0)


def _on_the_belt(position_m: Array, belt_way_m: Array) -> Array:
    """Positions (n, points, 3) of the laboratory in the frame of the belt, (points, 3, n)."""
    way = np.zeros((len(belt_way_m), 1, 3))
    way[:, 0, 0] = belt_way_m
    return np.asarray((position_m + way).transpose(1, 2, 0))


def _beside_each_other(
    optical: OpticalTrial,
    filtered: xr.Dataset,
    known: Known,
    acc: Array,
    gyr: Array,
    still: Flags,
    time_s: Array,
    belt_speed_m_s: float,
) -> xr.Dataset:
    """Estimates of both sources with names."""
    rate_hz = optical.poses.rate_hz
    order = ("time", "joint", "angle")
    from_markers = table_angles(optical.angles["joint_angle"].transpose(*order).to_numpy())
    from_filter = table_angles(filtered["joint_angle"].transpose(*order).to_numpy())
    spread = _by_side_and_name(filtered["joint_angle_sd"].transpose(*order).to_numpy())
    drift = _integrated_beside(from_markers, gyr, rate_hz, known)
    seen = _on_the_belt(optical.poses.sensor_position_m[:, FEET], belt_speed_m_s * time_s)
    walked = filtered["position"].to_numpy()[list(FEET)]
    pitch = [known.body.r_anatomical_from_sensor[row][2] @ gyr[row] for row in FEET]
    by_source = ("source", "side", "angle", "time")
    by_side = ("side", "time")
    float32 = np.float32
    data = {
        "angle_deg": (
            by_source,
            np.stack([from_markers, _padded(from_filter, known.sample)]).astype(float32),
        ),
        "angle_sd_deg": (
            by_source[1:],
            _padded(spread * DEG_PER_RAD, known.sample).astype(float32),
        ),
        "integrated_deg": (by_source[1:], _padded(drift, known.sample).astype(float32)),
        "foot_position_m": (
            ("source", "side", "axis", "time"),
            np.stack([seen, _padded(walked, known.sample)]),
        ),
        "zero_velocity": (by_side, still),
        "foot_acc_m_s2": (by_side, np.linalg.norm(acc[list(FEET)], axis=1).astype(float32)),
        "foot_gyr_rad_s": (by_side, np.linalg.norm(gyr[list(FEET)], axis=1).astype(float32)),
        "foot_pitch_rate_rad_s": (by_side, np.array(pitch).astype(float32)),
        "planar_angle_deg": (
            ("trio", "time"),
            (optical.angles["planar_angle"].sel(vertex="first").to_numpy() * DEG_PER_RAD).astype(
                float32
            ),
        ),
    }
    coords: Mapping[str, object] = {
        "source": list(SOURCES),
        "side": list(SIDES),
        "angle": list(ANGLE_NAMES),
        "axis": list(AXES),
        "trio": [str(name) for name in optical.angles["trio"].to_numpy()],
        "time": time_s,
    }
    attributes = {"rate_hz": rate_hz, "belt_speed_m_s": belt_speed_m_s}
    return xr.Dataset(data, coords=coords, attrs=attributes)
