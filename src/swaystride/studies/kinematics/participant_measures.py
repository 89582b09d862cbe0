"""Measures of all trials of one participant, with the names of participant and trial in front."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import pandas as pd
import xarray as xr

from swaystride.findings import Finding
from swaystride.studies.kinematics.agreement import AGREEMENT_COLUMNS
from swaystride.studies.kinematics.measures import MeasureParameters, trial_measures

#: Columns of the tables after participant and trial.
COLUMNS: Final = {
    "strides": (
        "side",
        "stride",
        "initial_contact_s",
        "next_contact_s",
        "source",
        "feature",
        "value",
    ),
    "agreement": ("side", "angle", *AGREEMENT_COLUMNS),
    "curves": ("source", "side", "angle", "phase_pct", "mean_deg", "sd_deg"),
    "planar": ("trio", "mean_deg", "sd_deg"),
}


def participant_measures(
    participant: str, trials: Mapping[str, xr.Dataset], parameters: MeasureParameters
) -> tuple[dict[str, pd.DataFrame], list[tuple[str, Finding]]]:
    """Measure every trial.

    Parameters
    ----------
    participant : str
    trials : mapping of str to Dataset
        Estimates by trial.
    parameters : MeasureParameters

    Returns
    -------
    tables : dict of str to DataFrame
        ``strides``, ``agreement``, ``curves``, ``planar``; empty without trials.
    findings : list of (str, Finding)
        With the trial.
    """
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in COLUMNS}
    findings: list[tuple[str, Finding]] = []
    for trial, estimates in trials.items():
        measured = trial_measures(estimates, parameters)
        for name, tables in parts.items():
            table: pd.DataFrame = getattr(measured, name)
            tables.append(named(table, participant, trial))
        findings += [(trial, finding) for finding in measured.findings]
    joined = {name: joined_tables(tables, COLUMNS[name]) for name, tables in parts.items()}
    return joined, findings


def named(table: pd.DataFrame, participant: str, trial: str) -> pd.DataFrame:
    """Put participant and trial in front of a table of one trial.

    Parameters
    ----------
    table : DataFrame
    participant, trial : str
    """
    out = table.copy()
    out.insert(0, "participant", participant)
    out.insert(1, "trial", trial)
    return out


def joined_tables(tables: list[pd.DataFrame], columns: tuple[str, ...]) -> pd.DataFrame:
    """Join tables of trials; without any, an empty one with the columns that it would have.

    Parameters
    ----------
    tables : list of DataFrame
    columns : tuple of str
        After participant and trial.
    """
    if tables:
        return pd.concat(tables, ignore_index=True)
    return pd.DataFrame(columns=["participant", "trial", *columns])
