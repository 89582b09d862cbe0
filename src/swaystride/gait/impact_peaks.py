"""Peak accelerations of shank, pelvis and head, and their attenuation on the way up (methods §7.2)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.gait.event_windows import window_maxima
from swaystride.gait.running_events import SIDES
from swaystride.units import GRAVITY_M_S2

PEAK_COLUMNS: Final = ("peak_tibial_g", "peak_pelvic_g", "peak_head_g")
ATTENUATION_COLUMNS: Final = (
    "attenuation_shank_pelvis",
    "attenuation_pelvis_head",
    "attenuation_shank_head",
)


@dataclass(frozen=True)
class ImpactWindow:
    """Where the peaks of shank and pelvis are sought; that of the head lies within the contact.

    Parameters
    ----------
    before_s, after_s : float
        Before and after initial contact.
    """

    before_s: float
    after_s: float


#: Methods §7.2 [N]; the print names no window.
IMPACT_WINDOW: Final = ImpactWindow(0.02, 0.10)


def impact_peaks(
    strides: pd.DataFrame,
    *,
    shank_acc_m_s2: Mapping[str, NDArray[np.floating]],
    pelvis_acc_m_s2: NDArray[np.floating] | None,
    head_acc_m_s2: NDArray[np.floating] | None,
    rate_hz: float,
    window: ImpactWindow,
) -> pd.DataFrame:
    """Peak longitudinal accelerations of every step, and the attenuation between them.

    The axis is fixed to the segment (vertical in standing), and gravity is part of the proper
    acceleration: in free fall it is zero.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`swaystride.gait.spatiotemporal.running_strides`; each begins with the step
        that is judged.
    shank_acc_m_s2 : mapping of str to ndarray, shape (n_samples,)
        Acceleration along the ``right`` and ``left`` shank, upward, after the low-pass.
    pelvis_acc_m_s2, head_acc_m_s2 : ndarray, shape (n_samples,), or None
        Along pelvis and head; None if the sensor is missing from the run.
    rate_hz : float
        Sampling rate.
    window : ImpactWindow

    Returns
    -------
    DataFrame
        A row per stride: ``peak_tibial_g``, ``peak_pelvic_g``, ``peak_head_g``;
        ``attenuation_shank_pelvis``, ``attenuation_pelvis_head``, ``attenuation_shank_head``:
        1 − proximal/distal of this very step (the mean of ratios is not the ratio of means).
        Missing where a sensor is.

    Raises
    ------
    RecordingError
        If a shank is missing.

    Examples
    --------
    >>> strides = pd.DataFrame({"side": ["right"], "start_s": [1.0], "toe_off_s": [1.2]})
    >>> shank = np.full(200, 9.80665)
    >>> shank[102] *= 8.0
    >>> peaks = impact_peaks(strides, shank_acc_m_s2={"right": shank, "left": shank},
    ...                      pelvis_acc_m_s2=np.full(200, 2 * 9.80665), head_acc_m_s2=None,
    ...                      rate_hz=100.0, window=IMPACT_WINDOW)
    >>> peaks["attenuation_shank_pelvis"].tolist(), peaks["attenuation_shank_head"].tolist()
    ([0.75], [nan])
    """
    missing = [side for side in SIDES if side not in shank_acc_m_s2]
    if missing:
        raise RecordingError(
            "a shank sensor is missing",
            place=f"{missing[0]} shank",
            expected="right and left",
            found=", ".join(shank_acc_m_s2) or "none",
        )
    contact = strides["start_s"].to_numpy(float)
    off = strides["toe_off_s"].to_numpy(float)
    begin, end = contact - window.before_s, contact + window.after_s
    nothing = np.full(contact.size, np.nan)
    tibial = nothing.copy()
    for side in SIDES:
        own = (strides["side"] == side).to_numpy()
        tibial[own] = window_maxima(shank_acc_m_s2[side], begin[own], end[own], rate_hz)
    pelvic = (
        nothing if pelvis_acc_m_s2 is None else window_maxima(pelvis_acc_m_s2, begin, end, rate_hz)
    )
    head = nothing if head_acc_m_s2 is None else window_maxima(head_acc_m_s2, contact, off, rate_hz)
    peaks = dict(zip(PEAK_COLUMNS, (tibial, pelvic, head), strict=True))
    pairs = ((tibial, pelvic), (pelvic, head), (tibial, head))
    lost = {
        name: 1.0 - proximal / distal
        for name, (distal, proximal) in zip(ATTENUATION_COLUMNS, pairs, strict=True)
    }
    in_g = {name: peak / GRAVITY_M_S2 for name, peak in peaks.items()}
    return pd.DataFrame(in_g | lost, index=strides.index)


def per_body_mass(peaks: pd.DataFrame, mass_kg: float) -> pd.DataFrame:
    """Peak accelerations per kilogram of the runner.

    Parameters
    ----------
    peaks : DataFrame
        As from :func:`impact_peaks`.
    mass_kg : float
        Of the body.

    Returns
    -------
    DataFrame
        ``peak_tibial_g_per_kg``, ``peak_pelvic_g_per_kg``, ``peak_head_g_per_kg``.

    Raises
    ------
    RecordingError
        If the mass is not positive.
    """
    if not mass_kg > 0.0:
        raise RecordingError("no body mass", expected="kilograms above 0", found=f"{mass_kg:g}")
    return pd.DataFrame({f"{name}_per_kg": peaks[name] / mass_kg for name in PEAK_COLUMNS})
