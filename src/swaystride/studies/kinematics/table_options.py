"""Limits that the tables, claims and the course of a trial are judged by."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class TableOptions:
    """Section ``analysis.tables`` of the configuration.

    Parameters
    ----------
    significance_level : float
        Largest p called significant (caption of Figure 4.12).
    smallest_denominator_deg : float
        A relative difference is not reported where the mean is not larger (caption of Table 4.6).
    drift_window_s : float
        Length of the two windows, at the start and at the end of a trial, whose difference is the
        drift; at most a third of the trial.
    convergence_band_deg : float
        A stride is near the settled level if its median difference is within this much of it, or
        within three robust standard deviations if that is more.
    convergence_strides : int
        Strides within which the filter is said to converge (dissertation §4.4.2).
    arrested_drift_deg : float
        Largest drift of the filter that is called arrested.

    Examples
    --------
    >>> TableOptions(0.05, 2.0, 30.0, 1.0, 10, 5.0).convergence_strides
    10
    """

    significance_level: float
    smallest_denominator_deg: float
    drift_window_s: float
    convergence_band_deg: float
    convergence_strides: int
    arrested_drift_deg: float
