"""Measures of postural sway (dissertation §2.3.3 and Table 3.3; spec §8.2)."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError
from swaystride.stats.prediction_ellipse import prediction_factor

#: z-score of the printed ellipse, π·z²·√(λ₁λ₂). "z-score for a 95 % confidence level" is read
#: two-sided (1.960² = 3.842); it encloses 85 % of Gaussian sway, not 95 %, see
#: ``ellipse_area_prediction``.
ELLIPSE_Z: Final = 1.9599639845400545

SWAY_MEASURE_UNITS: Final[dict[str, str]] = {
    "phi_rms": "deg",
    "ap_rms": "deg",
    "ml_rms": "deg",
    "phi_mv": "deg/s",
    "ap_mv": "deg/s",
    "ml_mv": "deg/s",
    "path_length": "deg",
    "ellipse_area": "deg²",
    "ellipse_area_prediction": "deg²",
}


def sway_metrics(ap_deg: ArrayLike, ml_deg: ArrayLike, rate_hz: float) -> dict[str, float]:
    """Compute the sway measures of one trial.

    The trajectory may be of any kind (trunk angles in degrees, centre of pressure in cm); the
    units of the results follow. Nothing is filtered or detrended here.

    Parameters
    ----------
    ap_deg, ml_deg : array_like, shape (n_samples,)
        Anterior-posterior and medio-lateral coordinate, at least 4 samples.
    rate_hz : float
        Sampling rate. The duration is that between first and last sample, (n − 1)/rate.

    Returns
    -------
    dict of str to float
        ``phi_rms``, ``ap_rms``, ``ml_rms``: root mean square about the mean (divided by n);
        ``phi_mv``, ``ap_mv``, ``ml_mv``: mean speed; ``path_length``; ``ellipse_area`` with the
        printed constant; ``ellipse_area_prediction``, the 95 % prediction ellipse (exact for
        Gaussian data; Schubert & Kirchner 2014). Covariances are divided by n − 1.

    Raises
    ------
    RecordingError
        If samples are missing, too few, or the coordinates differ in length.

    Examples
    --------
    >>> measures = sway_metrics([0.0, 3.0, 3.0, 0.0], [0.0, 0.0, 4.0, 4.0], rate_hz=1.0)
    >>> measures["path_length"], round(measures["phi_mv"], 4), measures["phi_rms"]
    (10.0, 3.3333, 2.5)
    """
    ap, ml = _checked(ap_deg, ml_deg)
    n_samples = ap.size
    duration_s = (n_samples - 1) / rate_hz
    step_ap, step_ml = np.diff(ap), np.diff(ml)
    path_length = float(np.hypot(step_ap, step_ml).sum())
    ap_rms, ml_rms = float(ap.std()), float(ml.std())
    # det(cov) = λ₁λ₂; the clip covers rounding for sway along a line.
    root_det = float(np.sqrt(max(np.linalg.det(np.cov(ap, ml)), 0.0)))
    return {
        "phi_rms": float(np.hypot(ap_rms, ml_rms)),
        "ap_rms": ap_rms,
        "ml_rms": ml_rms,
        "phi_mv": path_length / duration_s,
        "ap_mv": float(np.abs(step_ap).sum()) / duration_s,
        "ml_mv": float(np.abs(step_ml).sum()) / duration_s,
        "path_length": path_length,
        "ellipse_area": float(np.pi * ELLIPSE_Z**2 * root_det),
        "ellipse_area_prediction": float(np.pi * prediction_factor(n_samples) * root_det),
    }


def _checked(
    ap_deg: ArrayLike, ml_deg: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both coordinates as arrays, or the error that says what is wrong with them."""
    ap = np.asarray(ap_deg, dtype=np.float64)
    ml = np.asarray(ml_deg, dtype=np.float64)
    if ap.ndim != 1 or ap.shape != ml.shape or ap.size < 4:
        raise RecordingError(
            "sway coordinates do not match",
            expected="two one-dimensional arrays of equal length, at least 4 samples",
            found=f"shapes {ap.shape} and {ml.shape}",
        )
    n_missing = int(np.count_nonzero(~np.isfinite(ap) | ~np.isfinite(ml)))
    if n_missing:
        raise RecordingError(
            "sway coordinates have missing samples", expected="none", found=str(n_missing)
        )
    return ap, ml
