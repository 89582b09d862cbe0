"""Truth of the simulated IMU-design study: what was simulated, and the poses that follow from it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from swaystride.simulate.foot_kinematics import point_position, point_velocity, r_world_from_foot
from swaystride.simulate.foot_motion import FootMotion, FootPose
from swaystride.simulate.foot_person import Foot, Person
from swaystride.simulate.foot_pieces import foot_motion
from swaystride.simulate.foot_stances import FootStances
from swaystride.simulate.foot_trial import FootTrial
from swaystride.simulate.imu_design_cohort import IMUS
from swaystride.simulate.sole import Sole, SoleEdge

Array = NDArray[np.float64]

_FORMAT: Final = "swaystride-foot-truth-1"


@dataclass(frozen=True)
class FootTruth:
    """Truth of one foot in one trial; times from the start of the recording.

    Parameters
    ----------
    motion : FootMotion
        What the foot did.
    sensor_m : ndarray, shape (2, 3)
        Both sensors from the ankle, in axes of the foot.
    r_sensor_from_foot : ndarray, shape (3, 3)
        Mounting of both.
    start_s, stop_s, duration_s : float
        When the movement of the person began and ended, and the length of the recording.
    distance_m, mean_speed_m_s : float
        From rest to rest.
    """

    motion: FootMotion
    sensor_m: Array
    r_sensor_from_foot: Array
    start_s: float
    stop_s: float
    duration_s: float
    distance_m: float
    mean_speed_m_s: float

    @property
    def stances(self) -> FootStances:
        """Where and how the foot stood."""
        return self.motion.stances

    @property
    def contact_s(self) -> Array:
        """First touch of each step."""
        return self.stances.contact_s[1:]

    @property
    def toe_off_s(self) -> Array:
        """Last touch before each step."""
        return self.stances.toe_off_s[:-1]

    def pose(self, time_s: ArrayLike) -> FootPose:
        """Position and angles of the foot with two derivatives at any times."""
        return self.motion.pose(time_s)

    def sensor_position_m(self, imu: str, time_s: ArrayLike) -> Array:
        """Position of a sensor in the world.

        Parameters
        ----------
        imu : str
            ``imu_1`` or ``imu_2``.
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        return point_position(self.pose(time_s), self.sensor_m[IMUS.index(imu)]).T

    def sensor_velocity_m_s(self, imu: str, time_s: ArrayLike) -> Array:
        """Velocity of a sensor in the world.

        Parameters
        ----------
        imu : str
            ``imu_1`` or ``imu_2``.
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        ndarray, shape (n, 3)
        """
        return point_velocity(self.pose(time_s), self.sensor_m[IMUS.index(imu)]).T

    def r_world_from_sensor(self, time_s: ArrayLike) -> Array:
        """Orientation of the sensors.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Times.

        Returns
        -------
        ndarray, shape (n, 3, 3)
        """
        r = np.moveaxis(r_world_from_foot(self.pose(time_s)), -1, 0)
        return np.asarray(r @ self.r_sensor_from_foot.T)

    def strides(self) -> pd.DataFrame:
        """Strides of the foot, from stance to stance.

        Returns
        -------
        DataFrame
            ``start_s``, ``stop_s`` (first touches; the first stride starts with the rise of its
            heel), ``length_m`` (between the places of the level foot), ``angle_rad`` to the next
            stride, ``is_half`` for the first and the last.
        """
        stances = self.stances
        steps = np.stack([np.diff(stances.x_m), np.diff(stances.y_m)])
        cross = steps[0, :-1] * steps[1, 1:] - steps[1, :-1] * steps[0, 1:]
        angle = np.arctan2(np.abs(cross), np.sum(steps[:, :-1] * steps[:, 1:], axis=0))
        half = np.zeros(steps.shape[1], dtype=bool)
        half[[0, -1]] = True
        return pd.DataFrame(
            {
                "start_s": np.concatenate([stances.heel_off_s[:1], stances.contact_s[1:-1]]),
                "stop_s": stances.contact_s[1:],
                "length_m": np.hypot(*steps),
                "angle_rad": np.append(angle, np.nan),
                "is_half": half,
            }
        )


@dataclass(frozen=True)
class ParticipantTruth:
    """Truth of one participant.

    Parameters
    ----------
    participant : str
        Name.
    feet : dict of (str, str) to FootTruth
        By trial (``01`` …) and foot (``left``, ``right``).
    """

    participant: str
    feet: dict[tuple[str, str], FootTruth]

    def foot(self, trial: str, foot: str) -> FootTruth:
        """Return the truth of one foot in one trial."""
        return self.feet[trial, foot]


def write_truth(
    path: Path | str,
    participant: str,
    person: Person,
    trials: Mapping[str, FootTrial],
    *,
    distance_m: float,
) -> None:
    """Write what was simulated of one participant, as JSON that loses no digit.

    Parameters
    ----------
    path : path or str
        File to write.
    participant : str
        Name.
    person : Person
        Feet.
    trials : mapping of str to FootTrial
        What the feet did.
    distance_m : float
        From rest to rest.
    """
    content = {
        "format": _FORMAT,
        "note": "simulated by swaystride, not a measurement",
        "participant": participant,
        "distance_m": distance_m,
        "feet": {foot.side: _foot_content(foot) for foot in person.feet},
        "trials": {name: _trial_content(trial) for name, trial in trials.items()},
    }
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def read_truth(path: Path | str) -> ParticipantTruth:
    """Read the truth of one participant.

    Parameters
    ----------
    path : path or str
        From :func:`write_truth`.

    Returns
    -------
    ParticipantTruth
    """
    content = json.loads(Path(path).read_text(encoding="utf-8"))
    feet = {}
    for side, values in content["feet"].items():
        edges = tuple(SoleEdge(**edge) for edge in values["sole"].pop("edges"))
        sole = Sole(edges, **values["sole"])
        for trial, of_trial in content["trials"].items():
            stances = FootStances(
                **{k: np.array(v, dtype=np.float64) for k, v in of_trial[side].items()}
            )
            feet[trial, side] = FootTruth(
                motion=foot_motion(sole, stances),
                sensor_m=np.array(values["sensor_m"]),
                r_sensor_from_foot=np.array(values["r_sensor_from_foot"]),
                distance_m=content["distance_m"],
                mean_speed_m_s=content["distance_m"] / (of_trial["stop_s"] - of_trial["start_s"]),
                **{k: of_trial[k] for k in ("start_s", "stop_s", "duration_s")},
            )
    return ParticipantTruth(content["participant"], feet)


def _foot_content(foot: Foot) -> dict[str, Any]:
    return {
        "sole": asdict(foot.sole),
        "sensor_m": foot.sensor_m.tolist(),
        "r_sensor_from_foot": foot.r_sensor_from_foot.tolist(),
    }


def _trial_content(trial: FootTrial) -> dict[str, Any]:
    """Times and both feet; what a stance does not have is null."""
    content: dict[str, Any] = {
        "start_s": trial.start_s,
        "stop_s": trial.stop_s,
        "duration_s": trial.duration_s,
    }
    for side in ("left", "right"):
        stances = getattr(trial, side)
        content[side] = {
            name: [None if np.isnan(v) else v for v in getattr(stances, name).tolist()]
            for name in FootStances.names()
        }
    return content
