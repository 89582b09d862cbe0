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

from swaystride.stats.mixed_model import fit_mixed_model
from swaystride.sway.metrics import sway_metrics
from swaystride.validation.manifest import verified_files
from swaystride.validation.summary import Check

DATASET: Final = "standing_force_plate"
RATE_HZ: Final = 100.0

#: R 4.2.2, lme4 1.1-31, lmerTest 3.1-3 on log(COParea) ~ Vision*Surface + AgeGroup + (1|Subject),
#: REML: estimate, standard error, Satterthwaite df, all printed digits.
M1_REFERENCE: Final = {
    "(Intercept)": (0.59457773577, 0.05556748037, 185.5650525),
    "VisionClosed": (0.04966486608, 0.02558582139, 1761.0054511),
    "SurfaceFoam": (1.94969491441, 0.02572901950, 1762.6435669),
    "AgeGroupOld": (0.30395362869, 0.07812023992, 157.6197137),
    "VisionClosed:SurfaceFoam": (0.16193392073, 0.03640203031, 1761.0266474),
}
M1_VARIANCES: Final = {"Subject": 0.2338502487, "Residual": 0.1595906616}
M1_REML_CRITERION: Final = 2428.836182
_LME4: Final = "lme4 1.1-31, lmerTest 3.1-3"


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


def force_plate_checks(trials: pd.DataFrame, all_trials: pd.DataFrame) -> list[Check]:
    """Checks of this data set.

    Parameters
    ----------
    trials : DataFrame
        As from :func:`force_plate_trials`.
    all_trials : DataFrame
        As from :func:`force_plate_table`, for the mixed model.
    """
    checks = [Check(DATASET, "raw trials computed", float(len(trials)), 100.0, "files at hand", 0)]
    for name in ("area_cm2", "velocity_cm_s"):
        error = (trials[name] / trials[f"{name}_published"] - 1).abs().max()
        quantity = f"largest relative error of {name}"
        checks.append(Check(DATASET, quantity, float(error), 0.0, "PeerJ 4:e2648, its table", 1e-9))
    return checks + _mixed_model_checks(all_trials)


def force_plate_table(folder: Path) -> pd.DataFrame:
    """The authors' table of all trials, with the log of the area.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.
    """
    table = _published(verified_files(folder, DATASET))
    table["logA"] = np.log(table["COParea"])
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


def _mixed_model_checks(table: pd.DataFrame) -> list[Check]:
    """Model M1 on all trials against lme4, to the digits that it printed."""
    fit = fit_mixed_model("logA ~ Vision*Surface + AgeGroup + (1|Subject)", table, reml=True)
    effects = fit.fixed_effects(df="satterthwaite")
    checks = []
    ours = effects[["estimate", "se", "df"]].to_numpy(dtype=np.float64)
    for (name, reference), values in zip(M1_REFERENCE.items(), ours, strict=True):
        for quantity, value, printed in zip(
            ("estimate", "se", "df"), values.tolist(), reference, strict=True
        ):
            tolerance = 1e-5 * printed if quantity == "df" else 2e-6
            label = f"M1 {name}: {quantity}"
            checks.append(Check(DATASET, label, value, printed, _LME4, tolerance))
    for name, variance in M1_VARIANCES.items():
        value = float(fit.variance_components[name])
        checks.append(Check(DATASET, f"M1 variance: {name}", value, variance, _LME4, 1e-6))
    criterion = -2 * fit.loglik
    checks.append(Check(DATASET, "M1 REML criterion", criterion, M1_REML_CRITERION, _LME4, 1e-6))
    return checks
