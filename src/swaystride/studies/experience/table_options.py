"""Limits that the tables, claims and figures are judged by."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from swaystride.configuration import from_mapping


@dataclass(frozen=True)
class TruthLimits:
    """Largest errors asked of the recommended method, for every run.

    Parameters
    ----------
    stride_time_ms, contact_time_ms, duty_factor, stride_length_pct : float
        Of the mean of the run; the length as a share of the truth.
    initial_contact_bias_ms, initial_contact_sd_ms : float
        Over the strides of a run.
    hip_range_deg, knee_range_deg : float
        Against the rigid segment that carries the sensor.
    inclination_deg : float
        Vertical axis of an aligned sensor.
    ml_shank_foot_deg, ml_thigh_deg : float
        Medio-lateral axis of an aligned sensor.
    peak_tibial_pct : float
        Against the point that carries the sensor, after the same filter.
    """

    stride_time_ms: float
    contact_time_ms: float
    duty_factor: float
    stride_length_pct: float
    initial_contact_bias_ms: float
    initial_contact_sd_ms: float
    hip_range_deg: float
    knee_range_deg: float
    inclination_deg: float
    ml_shank_foot_deg: float
    ml_thigh_deg: float
    peak_tibial_pct: float


@dataclass(frozen=True)
class TableOptions:
    """Section ``analysis.tables`` of the configuration, and the cut-offs of the patterns.

    Parameters
    ----------
    significance_level : float
        Largest p called significant (dissertation, captions of Tables 5.3 and 5.4).
    moderate_r, strong_r : float
        Correlations from here on are moderate, strong (§5.3.4.2).
    majority : float
        A share above it is the majority of runs (§5.4.3).
    aerial_below, terrestrial_above : float
        Duty factors that divide the patterns (§5.3.4.2).
    limits : TruthLimits
    """

    significance_level: float
    moderate_r: float
    strong_r: float
    majority: float
    aerial_below: float
    terrestrial_above: float
    limits: TruthLimits


def table_options(tables: Mapping[str, Any], cutoffs: Mapping[str, float]) -> TableOptions:
    """Options from the configuration.

    Parameters
    ----------
    tables : mapping
        Plain values of ``analysis.tables``.
    cutoffs : mapping
        ``aerial_below`` and ``terrestrial_above``, the cut-offs of the classes.

    Raises
    ------
    ConfigurationError
        If a key is missing or unknown.
    """
    limits = from_mapping(TruthLimits, tables["limits"], place="analysis.tables.limits")
    values = {**tables, **cutoffs, "limits": limits}
    return from_mapping(TableOptions, values, place="analysis.tables")
