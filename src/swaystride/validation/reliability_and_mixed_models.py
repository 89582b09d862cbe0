"""Reliability and mixed models on public tables, against R.

Five tables of ratings (Shrout & Fleiss 1979; ``anxiety`` and ``video`` of irr; ``posturo`` of
isotone, balance scores of people; ``pingouin``, wines) and four tables for mixed models (Dyestuff,
Penicillin and Pastes of lme4; ``ctsib`` of faraway, a balance scale). ``reliability_reference.csv``
beside this module holds what R printed: irr for the closed formulas, lme4 for the fits.

lme4 stops near the minimum: on complete tables, where REML has a closed form, its standard
deviations are off by up to 3e-5 of themselves, while its criterion is right to all printed digits.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files
from io import StringIO
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model
from swaystride.stats.reliability import intraclass_correlation, two_way_icc
from swaystride.validation.manifest import verified_files
from swaystride.validation.summary import Check

DATASET: Final = "reliability_and_mixed_models"

#: Largest accepted difference by kind of quantity: an absolute part plus a share of the reference.
TOLERANCES: Final[Mapping[str, tuple[float, float]]] = {
    "icc": (1e-10, 0.0),
    "limit": (1e-6, 0.0),
    "F": (1e-6, 0.0),
    "r": (1e-10, 0.0),
    "p": (0.0, 1e-8),
    "criterion": (1e-6, 0.0),
    "lme4 icc": (1e-6, 0.0),
    "estimate": (1e-8, 1e-7),
    "se": (0.0, 5e-5),
    "sd": (0.0, 5e-5),
    "df": (0.0, 1e-5),
    "variance": (1e-6, 1e-5),
}
#: Between REML and the closed formula, both ours.
_CLOSED_FORM_TOLERANCE: Final = 1e-10
#: Kinds whose checks are joined, because single values tell a reader little.
_JOINED: Final = {"icc": "other ICCs", "limit": "limits", "F": "F values", "p": "p-values"}

_RATINGS: Final = {
    "shrout_fleiss_1979": ("shrout_fleiss_1979.csv", ["J1", "J2", "J3", "J4"]),
    "anxiety": ("anxiety_irr.csv", ["rater1", "rater2", "rater3"]),
    "video": ("video_irr.csv", ["rater1", "rater2", "rater3", "rater4"]),
    "posturo": ("posturo_isotone.csv", ["SOT.1", "SOT.2", "SOT.3"]),
}
_MODELS: Final = {
    "dyestuff": ("Dyestuff_lme4.csv", "Yield ~ 1 + (1|Batch)"),
    "penicillin": ("Penicillin_lme4.csv", "diameter ~ 1 + (1|plate) + (1|sample)"),
    "pastes": ("Pastes_lme4.csv", "strength ~ 1 + (1|sample) + (1|batch)"),
    "ctsib": ("ctsib_faraway.csv", "CTSIB ~ Surface*Vision + (1|Subject)"),
}
_CTSIB_TERMS: Final = (
    "(Intercept)",
    "Surfacenorm",
    "Visiondome",
    "Visionopen",
    "Surfacenorm:Visiondome",
    "Surfacenorm:Visionopen",
)

Values = Mapping[str, Mapping[str, float]]


def load_reference(dataset: str) -> pd.DataFrame:
    """What R printed for one `dataset`: ``set``, ``quantity``, ``kind``, ``value``, ``source``."""
    name = "reliability_reference.csv"
    text = files("swaystride.validation").joinpath(name).read_text(encoding="utf-8")
    table = pd.read_csv(StringIO(text))
    return table[table["dataset"] == dataset].drop(columns="dataset").reset_index(drop=True)


def compared(dataset: str, values: Values) -> pd.DataFrame:
    """Every reference value of a data set beside ours.

    Parameters
    ----------
    dataset : str
        Name in the table of references.
    values : mapping
        Ours: by set, then by quantity.

    Returns
    -------
    DataFrame
        ``set, quantity, kind, value, reference, difference, tolerance, source``.
    """
    table = load_reference(dataset).rename(columns={"value": "reference"})
    ours = [
        values[name][quantity]
        for name, quantity in zip(table["set"], table["quantity"], strict=True)
    ]
    absolute, relative = np.array([TOLERANCES[kind] for kind in table["kind"]]).T
    table["tolerance"] = absolute + relative * table["reference"].abs()
    table.insert(3, "value", ours)
    table.insert(5, "difference", table["value"] - table["reference"])
    return table[
        ["set", "quantity", "kind", "value", "reference", "difference", "tolerance", "source"]
    ]


def comparison_checks(dataset: str, table: pd.DataFrame) -> list[Check]:
    """Checks of a comparison; closed ICC(2,1) and fits singly, other closed formulas joined.

    Parameters
    ----------
    dataset : str
        Name of the data set.
    table : DataFrame
        As from :func:`compared`.
    """
    joined = table["kind"].isin(_JOINED) & (table["quantity"] != "ICC(2,1)")
    checks = []
    for name, rows in table.groupby("set", sort=False):
        alone = rows[~joined[rows.index]].set_index("quantity")
        for quantity, row in alone.to_dict("index").items():
            numbers = (row["value"], row["reference"], row["source"], row["tolerance"])
            checks.append(Check(dataset, f"{name}: {quantity}", *numbers))
        if "ICC(2,1)" in alone.index:
            reml, closed = alone.loc[["ICC(2,1) by REML", "ICC(2,1)"], "value"].tolist()
            label = f"{name}: ICC(2,1) by REML, closed form"
            checks.append(Check(dataset, label, reml, closed, "ours", _CLOSED_FORM_TOLERANCE))
        for kind, group in rows[joined[rows.index]].groupby("kind", sort=False):
            worst = float((group["difference"].abs() / group["tolerance"]).max())
            label = f"{name}: largest difference over tolerance, {len(group)} {_JOINED[str(kind)]}"
            checks.append(Check(dataset, label, worst, 0.0, group["source"].iloc[0], 1.0))
    return checks


def rating_values(ratings: FloatArray) -> dict[str, float]:
    """Closed formulas and the crossed REML fit of complete ratings, by quantity.

    Parameters
    ----------
    ratings : array, shape (n_targets, n_raters)
    """
    closed = two_way_icc(ratings, level=0.95)
    values = {}
    for name, row in closed.iterrows():
        values[str(name)] = float(row["icc"])
        values[f"{name}: F"] = float(row["f"])
        values[f"{name}: lower limit"] = float(row["ci_low"])
        values[f"{name}: upper limit"] = float(row["ci_high"])
    target, rater = np.indices(ratings.shape)
    table = pd.DataFrame(
        {"target": target.ravel(), "rater": rater.ravel(), "y": np.ravel(ratings).astype(float)}
    )
    fit = fit_mixed_model("y ~ 1 + (1|target) + (1|rater)", table)
    icc = intraclass_correlation(fit.variance_components, "rater")
    k = ratings.shape[1]
    return values | {
        "variance of targets": float(fit.variance_components["target"]),
        "variance of raters": float(fit.variance_components["rater"]),
        "residual variance": float(fit.variance_components["Residual"]),
        "ICC(2,1) by REML": icc,
        "ICC(2,k) by REML": k * icc / (1.0 + (k - 1) * icc),
        "REML criterion": -2.0 * fit.loglik,
        "mean": float(fit.estimates.beta[0]),
    }


def model_values(
    fit: MixedModelFit, terms: Sequence[str], groups: Sequence[str]
) -> dict[str, float]:
    """Estimates, variances and criterion of a REML fit, under the names that R gives them.

    Parameters
    ----------
    fit : MixedModelFit
    terms : sequence of str
        Names of the fixed effects in their order.
    groups : sequence of str
        Names of the grouping factors in the order of the formula.
    """
    effects = fit.fixed_effects(df="satterthwaite")
    values = {
        f"{term}: {quantity}": float(value)
        for quantity in ("estimate", "se", "df")
        for term, value in zip(terms, effects[quantity], strict=True)
    }
    names = [*(f"of {group}" for group in groups), "of residual"]
    for name, variance in zip(names, fit.variance_components, strict=True):
        values[f"SD {name}"] = float(np.sqrt(variance))
        values[f"variance {name}"] = float(variance)
    values["residual variance"] = values.pop("variance of residual")
    values["REML criterion"] = -2.0 * fit.loglik
    return values


def reliability_comparison(folder: Path) -> pd.DataFrame:
    """Our values of every set of this data set beside those of R.

    Parameters
    ----------
    folder : Path
        Folder with public recordings.

    Returns
    -------
    DataFrame
        As from :func:`compared`.
    """
    paths = {path.name: path for path in verified_files(folder, DATASET)}
    tables = {name: pd.read_csv(paths[file])[columns] for name, (file, columns) in _RATINGS.items()}
    wines = pd.read_csv(paths["pingouin_icc.csv"])
    tables["pingouin"] = wines.pivot_table(index="Wine", columns="Judge", values="Scores")
    values = {name: rating_values(table.to_numpy(dtype=float)) for name, table in tables.items()}
    for name, (file, formula) in _MODELS.items():
        fit = fit_mixed_model(formula, pd.read_csv(paths[file]))
        terms = _CTSIB_TERMS if name == "ctsib" else ("mean",)
        groups = [group.lower() for group in fit.n_groups]
        values[name] = model_values(fit, terms, groups)
    return compared(DATASET, values)
