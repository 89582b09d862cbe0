"""Ellipse that is to hold new points of a bivariate normal distribution (Schubert & Kirchner 2014)."""

from __future__ import annotations

from scipy.special import fdtri


def prediction_factor(n_samples: int, probability: float = 0.95) -> float:
    """Squared radius, in standard deviations, of a bivariate prediction ellipse.

    ``2 (n² − 1) / (n (n − 2)) · F(probability; 2, n − 2)``; tends to the χ² quantile with 2 degrees
    of freedom (5.991 for 95 %) as n grows.

    Parameters
    ----------
    n_samples : int
        Samples that the ellipse was computed from.
    probability : float
        Share of new points that it is to hold.

    Examples
    --------
    >>> round(prediction_factor(10**7), 3)
    5.991
    """
    n = n_samples
    quantile = float(fdtri(2, n - 2, probability))
    return 2.0 * (n**2 - 1) / (n * (n - 2)) * quantile
