"""Truth of the simulated kinematics study: motions, and what the participant wore, in one file.

Poses are not stored: segments, sensors, markers and contacts of the feet are evaluated at any time.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.rotations import exp_map
from swaystride.simulate._running_points import segment_states
from swaystride.simulate.running_markers import true_positions
from swaystride.simulate.running_motion import RunningMotion
from swaystride.simulate.running_tissue import SkinPoints
from swaystride.simulate.running_truth import (
    Arrays,
    motion_arrays,
    motion_from_arrays,
    points_arrays,
    points_from_arrays,
    reading_truth,
)

Array = NDArray[np.float64]
Phase = Literal["standing", "running"]

#: Phases of a trial, in the order in which they are recorded.
PHASES: Final[tuple[Phase, Phase]] = ("standing", "running")
_FORMAT: Final = "swaystride-kinematics-truth-1"


@dataclass(frozen=True)
class WornEquipment:
    """Sensors and markers of one participant, the same in all trials.

    Parameters
    ----------
    sensors, markers : tuple of str
        Names as in the files, in the order of all arrays.
    sensor_points, marker_points : SkinPoints
        Where they are and how soft tissue moves them.
    r_sensor_from_segment : ndarray, shape (n_sensors, 3, 3)
        Mounting: from axes of the segment, turned with the soft tissue, to axes of the sensor.
    """

    sensors: tuple[str, ...]
    markers: tuple[str, ...]
    sensor_points: SkinPoints
    marker_points: SkinPoints
    r_sensor_from_segment: Array


@dataclass(frozen=True)
class RecordingTruth:
    """Truth of one standing or running recording; times are those of the IMUs.

    Parameters
    ----------
    motion : RunningMotion
        What the participant did: true joint angles are ``motion.states(t).joint_angles_rad()``,
        first and last touches of a foot ``motion.contacts_s(side)``.
    worn : WornEquipment
        What the participant wore.
    marker_start_s : float
        Time of the first frame of the cameras.
    """

    motion: RunningMotion
    worn: WornEquipment
    marker_start_s: float

    def sensor_position_m(self, time_s: ArrayLike) -> Array:
        """Positions of the sensors in the frame of the belt.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Rising times.

        Returns
        -------
        ndarray, shape (n, n_sensors, 3)
        """
        time = np.asarray(time_s, dtype=np.float64)
        return true_positions(self.motion, self.worn.sensor_points, time)

    def marker_position_m(self, time_s: ArrayLike) -> Array:
        """Positions of the markers in the frame of the belt.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Rising times.

        Returns
        -------
        ndarray, shape (n, n_markers, 3)
        """
        time = np.asarray(time_s, dtype=np.float64)
        return true_positions(self.motion, self.worn.marker_points, time)

    def r_world_from_sensor(self, time_s: ArrayLike) -> Array:
        """Orientations of the sensors, which turn with the soft tissue.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Rising times.

        Returns
        -------
        ndarray, shape (n, n_sensors, 3, 3)
        """
        skin = self.worn.sensor_points
        time = np.asarray(time_s, dtype=np.float64)
        _, states, channels, _ = segment_states(self.motion.tables, time)
        r_world_from_segment = states[:, skin.rows[:, 0], :9].reshape(len(time), -1, 3, 3)
        followed = channels[:, skin.rows[:, 1:], 0] - skin.tissue[:, 5]
        angle = np.sum(followed * skin.tissue[:, 3], axis=-1)
        r_segment_from_skin = exp_map(angle[..., None] * skin.tissue[:, 4])
        r_skin_from_sensor = np.swapaxes(self.worn.r_sensor_from_segment, 1, 2)
        return np.asarray(r_world_from_segment @ r_segment_from_skin @ r_skin_from_sensor)


@dataclass(frozen=True)
class ParticipantTruth:
    """Truth of one participant.

    Parameters
    ----------
    participant : str
        Name.
    worn : WornEquipment
        Sensors and markers.
    recordings : dict of (str, str) to RecordingTruth
        By trial (``01`` …) and phase (``standing``, ``running``).
    """

    participant: str
    worn: WornEquipment
    recordings: dict[tuple[str, Phase], RecordingTruth]

    @property
    def trials(self) -> list[str]:
        """Names of the trials."""
        return sorted({trial for trial, _ in self.recordings})

    def recording(self, trial: str, phase: Phase = "running") -> RecordingTruth:
        """Return the truth of one recording.

        Parameters
        ----------
        trial : str
            Name of the trial.
        phase : {"running", "standing"}
            Which of its two recordings.
        """
        return self.recordings[trial, phase]


def write_truth(path: Path | str, truth: ParticipantTruth) -> None:
    """Write the truth of one participant.

    Parameters
    ----------
    path : path or str
        File to write, ``.npz``; its folder is made.
    truth : ParticipantTruth
        What was simulated.
    """
    worn = truth.worn
    head = {
        "format": _FORMAT,
        "note": "simulated by swaystride, not a measurement",
        "participant": truth.participant,
        "sensors": worn.sensors,
        "markers": worn.markers,
        "marker_start_s": {
            _key(*names): recording.marker_start_s for names, recording in truth.recordings.items()
        },
    }
    arrays: Arrays = {
        "head": np.array(json.dumps(head)),
        "r_sensor_from_segment": worn.r_sensor_from_segment,
    }
    arrays |= points_arrays({"sensors": worn.sensor_points, "markers": worn.marker_points})
    for names, recording in truth.recordings.items():
        for name, array in motion_arrays(recording.motion).items():
            arrays[f"{_key(*names)}/{name}"] = array
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        np.savez_compressed(file, **arrays)


def read_truth(path: Path | str) -> ParticipantTruth:
    """Read the truth of one participant.

    Parameters
    ----------
    path : path or str
        From :func:`write_truth`.

    Returns
    -------
    ParticipantTruth

    Raises
    ------
    RecordingError
        If the file is not such a file.
    """
    with reading_truth(path, "the kinematics study"):
        with np.load(Path(path), allow_pickle=False) as file:
            arrays: Arrays = {name: file[name] for name in file.files}
        head = json.loads(str(arrays["head"]))
        points = points_from_arrays(arrays)
        worn = WornEquipment(
            sensors=tuple(head["sensors"]),
            markers=tuple(head["markers"]),
            sensor_points=points["sensors"],
            marker_points=points["markers"],
            r_sensor_from_segment=arrays["r_sensor_from_segment"],
        )
        recordings: dict[tuple[str, Phase], RecordingTruth] = {}
        for key, marker_start_s in head["marker_start_s"].items():
            trial, phase = key.split("/")
            own = {
                name.removeprefix(f"{key}/"): array
                for name, array in arrays.items()
                if name.startswith(f"{key}/")
            }
            recordings[trial, phase] = RecordingTruth(motion_from_arrays(own), worn, marker_start_s)
    return ParticipantTruth(head["participant"], worn, recordings)


def _key(trial: str, phase: str) -> str:
    return f"{trial}/{phase}"
