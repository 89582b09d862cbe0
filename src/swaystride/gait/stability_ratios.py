"""Share of each direction in the movement of the pelvis: ratios of root mean squares (methods §7.2)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.gait.event_windows import stride_rms

#: In the order of the axes of a segment: forward, up, to the right.
RATIO_COLUMNS: Final = ("ap_ratio", "vertical_ratio", "ml_ratio")


def stability_ratios(
    strides: pd.DataFrame,
    pelvis_acc_m_s2: NDArray[np.floating],
    rate_hz: float,
    *,
    remove_mean: bool,
) -> pd.DataFrame:
    """Root mean square of each component of the pelvis acceleration over that of the resultant.

    Parameters
    ----------
    strides : DataFrame
        With ``start_s`` and ``stop_s``.
    pelvis_acc_m_s2 : ndarray, shape (3, n_samples)
        In anatomical axes, after the low-pass.
    rate_hz : float
        Sampling rate.
    remove_mean : bool
        Whether the mean over the stride is subtracted from each component first; otherwise gravity
        fills the vertical ratio (methods §7.2: subtracted [N]).

    Returns
    -------
    DataFrame
        ``ap_ratio``, ``vertical_ratio``, ``ml_ratio`` per stride; their squares add up to 1.

    Examples
    --------
    >>> phase = 2 * np.pi * np.arange(400) / 100
    >>> acc = np.stack([3 * np.sin(phase), 9.8 + 4 * np.cos(phase), 0 * phase])
    >>> strides = pd.DataFrame({"start_s": [0.0], "stop_s": [2.0]})
    >>> ratios = stability_ratios(strides, acc, 100.0, remove_mean=True)
    >>> ratios.iloc[0].round(3).tolist()
    [0.6, 0.8, 0.0]
    """
    rms = stride_rms(
        pelvis_acc_m_s2, strides["start_s"], strides["stop_s"], rate_hz, remove_mean=remove_mean
    )
    resultant = np.sqrt(np.sum(rms**2, axis=0))
    ratios = rms / np.where(resultant > 0.0, resultant, np.nan)
    return pd.DataFrame(dict(zip(RATIO_COLUMNS, ratios, strict=True)), index=strides.index)
