"""Intensity of arm movement: root mean square of the acceleration of an arm (methods §7.2)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.event_windows import stride_rms
from swaystride.units import GRAVITY_M_S2

#: In the order of the axes of a segment: forward, up, to the right.
ARM_COLUMNS: Final = ("arm_ap_rms_g", "arm_vertical_rms_g", "arm_ml_rms_g")


def arm_intensity(
    strides: pd.DataFrame,
    arm_acc_m_s2: NDArray[np.floating],
    rate_hz: float,
    *,
    remove_mean: bool,
) -> pd.DataFrame:
    """Root mean square of each component of the acceleration of an arm, per stride.

    Parameters
    ----------
    strides : DataFrame
        With ``start_s`` and ``stop_s``.
    arm_acc_m_s2 : ndarray, shape (3, n_samples)
        Of upper arm or wrist (the print does not say which), in anatomical axes, after the low-pass.
    rate_hz : float
        Sampling rate.
    remove_mean : bool
        Whether the mean over the stride is subtracted first. Printed is the root mean square; with
        gravity in it the components also tell how the arm hangs.

    Returns
    -------
    DataFrame
        ``arm_ap_rms_g``, ``arm_vertical_rms_g``, ``arm_ml_rms_g``.

    Examples
    --------
    >>> still = np.array([[0.0], [9.80665], [0.0]]).repeat(100, axis=1)
    >>> strides = pd.DataFrame({"start_s": [0.1], "stop_s": [0.8]})
    >>> arm_intensity(strides, still, 100.0, remove_mean=False).iloc[0].round(9).tolist()
    [0.0, 1.0, 0.0]
    """
    rms = stride_rms(
        arm_acc_m_s2, strides["start_s"], strides["stop_s"], rate_hz, remove_mean=remove_mean
    )
    in_g = rms / GRAVITY_M_S2
    return pd.DataFrame(dict(zip(ARM_COLUMNS, in_g, strict=True)), index=strides.index)
