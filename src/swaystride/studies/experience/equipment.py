"""What the runners wear: labels of the sensors, and how each is meant to be mounted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError
from swaystride.studies.experience.plan import SENSORS

Array = NDArray[np.float64]

#: Axes of a mounting are perpendicular within this cosine.
_PERPENDICULAR = 1e-6


@dataclass(frozen=True)
class Equipment:
    """Sensors of a run.

    Parameters
    ----------
    labels : dict of str to str
        Label in the vendor's file of each of :data:`~swaystride.studies.experience.plan.SENSORS`.
    mounting : dict of str to ndarray, shape (3, 3)
        ``r_anatomical_from_sensor`` of each as it is meant to be worn.
    """

    labels: dict[str, str]
    mounting: dict[str, Array]

    def name_of(self, label: str) -> str | None:
        """Sensor with this label, or None.

        Parameters
        ----------
        label : str
        """
        return next((name for name, own in self.labels.items() if own == label), None)


def equipment(
    labels: Mapping[str, str], axes: Mapping[str, Mapping[str, Sequence[float]]]
) -> Equipment:
    """Equipment from the configuration.

    Parameters
    ----------
    labels : mapping of str to str
        Plain values of ``analysis.sensors``.
    axes : mapping
        Plain value of ``analysis.alignment.mounting``: axes of the sensor that point ``forward``
        and ``up``, for ``every`` sensor, and for single ones that are worn otherwise.

    Returns
    -------
    Equipment

    Raises
    ------
    ConfigurationError
        If a sensor is unknown, a label stands twice, or two axes are not perpendicular.
    """
    place = "analysis.alignment.mounting"
    unknown = sorted(set(axes) - {"every", *SENSORS})
    if unknown or "every" not in axes:
        raise ConfigurationError(
            "sensors of the mounting",
            place=place,
            expected="every, and any of " + ", ".join(SENSORS),
            found=", ".join(axes),
        )
    if len(set(labels.values())) < len(labels):
        raise ConfigurationError(
            "two sensors have one label", place="analysis.sensors", found=", ".join(labels.values())
        )
    mounting = {
        name: _rotation(axes.get(name, axes["every"]), f"{place}: {name}") for name in SENSORS
    }
    return Equipment({name: labels[name] for name in SENSORS}, mounting)


def _rotation(axes: Mapping[str, Sequence[float]], place: str) -> Array:
    """Rows: forward, up, to the right."""
    try:
        forward, up = (
            np.asarray(axes[name], dtype=np.float64) / np.linalg.norm(axes[name])
            for name in ("forward", "up")
        )
        perpendicular = forward.shape == up.shape == (3,) and abs(forward @ up) < _PERPENDICULAR
    except (KeyError, TypeError, ValueError):
        perpendicular = False
    if not perpendicular:
        raise ConfigurationError(
            "axes of a sensor",
            place=place,
            expected="forward and up, three numbers each, perpendicular",
            found=str(dict(axes)),
        )
    return np.stack([forward, up, np.cross(forward, up)])
