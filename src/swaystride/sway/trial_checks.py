"""What a recording of somebody standing still must look like, whatever the sensor."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.units import DEG_PER_RAD

#: A lumbar sensor further than this from upright is not worn as the configuration says: belts
#: tilt by up to 36° (public recordings, see docs/validation.md), a mistaken axis by 90°.
LARGEST_TILT_DEG: Final = 45.0

#: Root mean square of the angular rate that nobody standing reaches: the hardest task of the
#: simulator (mean velocity 3.7 °/s) stays below 0.2 rad/s; degrees read as radians exceed it.
LARGEST_RATE_RAD_S: Final = 1.0


def check_standing_signals(
    acc_m_s2: NDArray[np.float64], gyr_rad_s: NDArray[np.float64], *, file: str
) -> None:
    """Refuse signals that no correctly worn and read sensor gives in quiet standing.

    Parameters
    ----------
    acc_m_s2, gyr_rad_s : ndarray, shape (3, n_samples)
        In body axes (x forward, y left, z up) by the configured alignment.
    file : str
        Named in the error.

    Raises
    ------
    RecordingError
        If gravity is not near the axis that is configured as up, the gyroscope never changes, or
        its rates are too large for standing.

    Examples
    --------
    >>> acc = np.tile([[9.81], [0.0], [0.0]], 10)
    >>> check_standing_signals(acc, np.zeros((3, 10)), file="P01_01.txt")
    Traceback (most recent call last):
    ...
    swaystride.errors.RecordingError: P01_01.txt: the sensor is not worn as configured; expected sensor_up within 45° of the vertical; found it 90° away (gravity along the forward axis)
    """
    mean = acc_m_s2.mean(axis=1)
    tilt_deg = float(np.arccos(mean[2] / np.linalg.norm(mean))) * DEG_PER_RAD
    if tilt_deg > LARGEST_TILT_DEG:
        names = ("forward", "left", "up")
        axis = int(np.argmax(np.abs(mean)))
        sign = "" if mean[axis] > 0 else "negative "
        raise RecordingError(
            "the sensor is not worn as configured",
            file=file,
            expected=f"sensor_up within {LARGEST_TILT_DEG:.0f}° of the vertical",
            found=f"it {tilt_deg:.0f}° away (gravity along the {sign}{names[axis]} axis)",
        )
    spread = gyr_rad_s.std(axis=1)
    if not spread.any():
        raise RecordingError(
            "the gyroscope never changes",
            file=file,
            expected="angular rates of a person who stands",
            found=f"the same value in all {gyr_rad_s.shape[1]} samples",
        )
    rms = float(np.sqrt((spread**2).sum()))
    if rms > LARGEST_RATE_RAD_S:
        raise RecordingError(
            "angular rates are too large for standing",
            file=file,
            expected=f"a root mean square below {LARGEST_RATE_RAD_S:g} rad/s",
            found=f"{rms:.2f} rad/s: are these degrees per second?",
        )
