"""Mounting of seven sensors of the lower limbs, from standing and movement (methods §4.1-4.5).

Built on :mod:`swaystride.signals.segment_alignment`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.erkf.body import SEGMENTS
from swaystride.signals.filters import butterworth_lowpass
from swaystride.signals.segment_alignment import (
    anatomical_frame,
    main_axis,
    pointing_right,
    standing_vertical,
)

Array = NDArray[np.float64]


def level_mounting(
    standing_acc_m_s2: Array,
    moving_gyr_rad_s: Array,
    *,
    pelvis_right: Array,
    rate_hz: float,
    cutoff_hz: float,
    keep: NDArray[np.bool_] | None = None,
) -> Array:
    """Frames of the sensors from the sensors alone: up from standing, right from movement.

    Used as mounting, they take every segment to be upright and to face forward in standing
    (methods §4.1-4.5).

    Parameters
    ----------
    standing_acc_m_s2 : ndarray, shape (7, 3, n)
        In quiet standing.
    moving_gyr_rad_s : ndarray, shape (7, 3, m)
        In walking or running.
    pelvis_right : ndarray, shape (3,)
        Axis of the pelvis sensor that is mounted to point right.
    rate_hz : float
        Sampling rate.
    cutoff_hz : float
        Low-pass before the main axis is sought.
    keep : ndarray of bool, shape (m,), optional
        Samples of the movement that count, for example without turns of the path.

    Returns
    -------
    ndarray, shape (7, 3, 3)
        ``r_level_from_sensor``: rows x (forward), y (up), z (right).

    Raises
    ------
    RecordingError
        If nothing turns.
    """
    up = [standing_vertical(acc) for acc in standing_acc_m_s2]
    rate = butterworth_lowpass(
        moving_gyr_rad_s,
        cutoff_hz=cutoff_hz,
        rate_hz=rate_hz,
        order=2,
        direction="zero_lag",
        pad_s=0.5,
    )
    chosen = np.ones(rate.shape[2], dtype=np.bool_) if keep is None else keep
    frames = {0: anatomical_frame(up[0], pelvis_right)}
    for side in ("right", "left"):
        shank = SEGMENTS.index(f"{side}_shank")
        axis = main_axis(rate[shank], up[shank], chosen).axis
        right = pointing_right(axis, rate[shank][:, chosen], place=SEGMENTS[shank])
        swing = right @ rate[shank][:, chosen]
        frames[shank] = anatomical_frame(up[shank], right)
        for name in (f"{side}_thigh", f"{side}_foot"):
            j = SEGMENTS.index(name)
            axis = main_axis(rate[j], up[j], chosen).axis
            own = pointing_right(axis, rate[j][:, chosen], shank_rate=swing, place=name)
            frames[j] = anatomical_frame(up[j], own)
    return np.stack([frames[j] for j in range(len(SEGMENTS))])
