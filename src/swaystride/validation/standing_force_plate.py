"""Standing on a force plate: our sway measures against those that the authors published.

Santos & Duarte (2016), PeerJ 4:e2648. AP is COPx, ML is COPy, in cm; the authors neither filter
nor detrend. Their area is the 95 % prediction ellipse; their velocity divides the path by n/rate,
ours by (n − 1)/rate.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.sway.metrics import sway_metrics
from swaystride.validation.force_plate_models import DATASET
from swaystride.validation.manifest import verified_files
from swaystride.validation.reliability_and_mixed_models import comparison_checks
from swaystride.validation.summary import Check

RATE_HZ: Final = 100.0


def force_plate_trials(folder: Path) -> pd.DataFrame:
    """Sway measures of the raw trials beside the authors' area and velocity.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        ``trial``, ``area_cm2``, ``velocity_cm_s`` and the authors' ``…_published``.
    """
    paths = verified_files(folder, DATASET)
    published = _published(paths).set_index("Trial")
    rows = []
    for path in paths:
        if not path.name.endswith(".txt.xz"):
            continue
        trial = path.name.removesuffix(".txt.xz")
        cop = pd.read_csv(path, sep="\t", usecols=["COPx[cm]", "COPy[cm]"])
        measures = sway_metrics(cop["COPx[cm]"], cop["COPy[cm]"], RATE_HZ)
        rows.append(
            {
                "trial": trial,
                "area_cm2": measures["ellipse_area_prediction"],
                "velocity_cm_s": measures["path_length"] / (len(cop) / RATE_HZ),
                "area_cm2_published": published.loc[trial, "COParea"],
                "velocity_cm_s_published": published.loc[trial, "COPvelo"],
            }
        )
    return pd.DataFrame(rows)


def force_plate_checks(trials: pd.DataFrame, comparison: pd.DataFrame) -> list[Check]:
    """Checks of this data set.

    Parameters
    ----------
    trials : DataFrame
        As from :func:`force_plate_trials`.
    comparison : DataFrame
        As from :func:`swaystride.validation.force_plate_models.force_plate_comparison`.
    """
    checks = [Check(DATASET, "raw trials computed", float(len(trials)), 100.0, "files at hand", 0)]
    for name in ("area_cm2", "velocity_cm_s"):
        error = (trials[name] / trials[f"{name}_published"] - 1).abs().max()
        quantity = f"largest relative error of {name}"
        checks.append(Check(DATASET, quantity, float(error), 0.0, "PeerJ 4:e2648, its table", 1e-9))
    return checks + comparison_checks(DATASET, comparison)


def force_plate_table(folder: Path) -> pd.DataFrame:
    """The authors' table of all trials, with the logarithms of area and velocity.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    table = _published(verified_files(folder, DATASET))
    table["logA"] = np.log(table["COParea"])
    table["logV"] = np.log(table["COPvelo"])
    return table


def _published(paths: list[Path]) -> pd.DataFrame:
    """The authors' own measures of every trial."""
    (path,) = [path for path in paths if path.name == "BDSinfoCOP.txt.gz"]
    table = pd.read_csv(path, sep="\t", low_memory=False)
    for name, levels in (
        ("Vision", ["Open", "Closed"]),
        ("Surface", ["Firm", "Foam"]),
        ("AgeGroup", ["Young", "Old"]),
    ):
        table[name] = pd.Categorical(table[name], categories=levels)
    return table
