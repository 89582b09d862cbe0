"""What the markers of one trial say: joint angles, joint centres, sensors, planar angles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from swaystride.erkf.optical_initialisation import OpticalPoses
from swaystride.lower_limb_joints import JOINT_NAMES
from swaystride.marker_recording import MarkerRecording, marker_positions
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.joint_axes import Recipe, public_joint_axes
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT
from swaystride.mocap.optical_angles import angles_of, segment_poses
from swaystride.mocap.perturbation import Person
from swaystride.mocap.segment_frames import mean_rotation
from swaystride.mocap.static_calibration import OpticalOptions, static_model
from swaystride.rotations import matrix_from_quaternion
from swaystride.studies.kinematics.equipment import Markers

Array = NDArray[np.float64]


@dataclass(frozen=True)
class OpticalMethod:
    """How markers become joint angles.

    Parameters
    ----------
    options : OpticalOptions
    axis_recipe : {"spine_plane", "pelvis_forward"}
        Frame in which the average knee axis is given.
    """

    options: OpticalOptions
    axis_recipe: Recipe


@dataclass(frozen=True, eq=False)
class OpticalTrial:
    """One trial as the markers show it.

    Parameters
    ----------
    angles : Dataset
        From :func:`swaystride.mocap.optical_angles.angles_of`.
    poses : OpticalPoses
        Segments, joint centres and sensors in the laboratory.
    r_world_from_segment_standing : ndarray, shape (7, 3, 3)
        Mean over the standing.
    """

    angles: xr.Dataset
    poses: OpticalPoses
    r_world_from_segment_standing: Array


def calibrated_person(
    standing: MarkerRecording, person: Anthropometrics, method: OpticalMethod
) -> Person:
    """Everything that calibrates a participant.

    Parameters
    ----------
    standing : MarkerRecording
    person : Anthropometrics
    method : OpticalMethod

    Returns
    -------
    Person
    """
    return Person(
        standing, CONVENTIONAL_GAIT, person, method.options, public_joint_axes(method.axis_recipe)
    )


def optical_trial(running: MarkerRecording, calibrated: Person, markers: Markers) -> OpticalTrial:
    """Joint angles, joint centres and sensors from the clean markers of a trial.

    Parameters
    ----------
    running : MarkerRecording
        Clean, at the samples of the sensors.
    calibrated : Person
    markers : Markers

    Returns
    -------
    OpticalTrial

    Raises
    ------
    RecordingError
        If the static trial is none, or contradicts the measures of the person.
    """
    model = static_model(
        calibrated.static,
        calibrated.markers,
        calibrated.body,
        options=calibrated.options,
        axes=calibrated.axes,
    )
    angles = angles_of(running, model)
    rotation = matrix_from_quaternion(
        angles["orientation"].transpose("time", "segment", "component").to_numpy()
    )
    faces = marker_positions(running, markers.faces.in_order())
    poses = OpticalPoses(
        rotation,
        {name: angles["joint_centre"].sel(joint=name).to_numpy().T for name in JOINT_NAMES},
        np.ascontiguousarray(faces.transpose(2, 0, 1)),
        float(running.attrs["rate_hz"]),
    )
    still = segment_poses(calibrated.static, model)[0]
    still = still[np.isfinite(still).all(axis=(1, 2, 3))]
    standing = np.stack([mean_rotation(still[:, j]) for j in range(still.shape[1])])
    return OpticalTrial(angles, poses, standing)
