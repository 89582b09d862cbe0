"""Tables 4.9 and 4.10: other algorithms as printed, and one row of this pipeline behind each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import pandas as pd

from swaystride.presentation.number_format import format_number
from swaystride.studies.kinematics.plan import SAGITTAL_ANGLES, SIDES

#: Metrics of our rows: name in the table, unit, column of the agreement, decimals.
_METRICS: Final = (
    ("r2", "", "r2", 2),
    ("rmsd", "deg", "rmsd_deg", 1),
    ("rmsd_no_constant", "deg", "rmsd_trial_deg", 1),
)
#: In the printed order, of those that the source compares.
_OTHERS: Final = ("hip_adduction", "hip_rotation", "knee_adduction")


def read_literature(path: Path) -> pd.DataFrame:
    """Read a printed table as text, so that cells such as ``<0.99`` stay what they are.

    Parameters
    ----------
    path : Path
        CSV in ``data/published``.
    """
    return pd.read_csv(path, dtype=str, keep_default_na=False)


def table_4_9(
    printed: pd.DataFrame, agreement: pd.DataFrame, duration_min: float, *, simulated: bool
) -> pd.DataFrame:
    """Sagittal plane.

    Parameters
    ----------
    printed : DataFrame
        From :func:`read_literature`.
    agreement : DataFrame
        One row per trial, side and angle.
    duration_min : float
        Median duration of a trial, minutes.
    simulated : bool
        Whether our rows rest on a simulated cohort.

    Returns
    -------
    DataFrame
        The printed rows unchanged; then R², RMSD and RMSD after one constant of this pipeline, for
        both sides; ``origin`` says where a row comes from.
    """
    rows = []
    for side in SIDES:
        for metric, unit, column, decimals in _METRICS:
            row = _own(agreement, duration_min) | {"metric": metric, "unit": unit, "side": side}
            for angle in SAGITTAL_ANGLES:
                own = _chosen(agreement, angle, side)[column]
                row[f"{angle}_mean"] = format_number(float(own.mean()), decimals, "plain")
                row[f"{angle}_sd"] = format_number(float(own.std()), decimals, "plain")
            rows.append(row)
    return _joined(printed, rows, simulated=simulated)


def table_4_10(
    printed: pd.DataFrame, agreement: pd.DataFrame, duration_min: float, *, simulated: bool
) -> pd.DataFrame:
    """Frontal and transverse planes.

    Parameters
    ----------
    printed : DataFrame
    agreement : DataFrame
    duration_min : float
    simulated : bool

    Returns
    -------
    DataFrame
        As :func:`table_4_9`, one row per angle, side and metric.
    """
    rows = []
    for angle in _OTHERS:
        for side in SIDES:
            for metric, unit, column, decimals in _METRICS:
                own = _chosen(agreement, angle, side)[column]
                rows.append(
                    _own(agreement, duration_min)
                    | {"angle": angle, "side": side, "metric": metric, "unit": unit}
                    | {
                        "mean": format_number(float(own.mean()), decimals, "plain"),
                        "sd": format_number(float(own.std()), decimals, "plain"),
                    }
                )
    return _joined(printed, rows, simulated=simulated)


def _own(agreement: pd.DataFrame, duration_min: float) -> dict[str, str]:
    """What our rows say of themselves."""
    return {
        "testing_scheme": "not applicable",
        "reference": "this pipeline",
        "participants": str(agreement["participant"].nunique()),
        "trial_duration": f"{duration_min:.3g} min",
        "algorithm": "Error-state Kalman filter",
    }


def _chosen(agreement: pd.DataFrame, angle: str, side: str) -> pd.DataFrame:
    return agreement[(agreement["angle"] == angle) & (agreement["side"] == side)]


def _joined(
    printed: pd.DataFrame, rows: Sequence[Mapping[str, str]], *, simulated: bool
) -> pd.DataFrame:
    """Printed rows, then ours, told apart in the last column."""
    ours = pd.DataFrame(rows, columns=list(printed.columns))
    return pd.concat(
        [
            printed.assign(origin="as printed"),
            ours.assign(origin="simulated" if simulated else "recorded"),
        ],
        ignore_index=True,
    )
