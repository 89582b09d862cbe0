"""What the document could not have: measures of a simulated cohort against their truth."""

from __future__ import annotations

from dataclasses import asdict
from typing import Final, NamedTuple

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import MEASURE_KEYS, MEASURES, SENSORS
from swaystride.studies.experience.table_options import TruthLimits

_MS_PER_S: Final = 1000.0
#: Ends of the names of measures and the units that they stand for; the longer ones first.
_UNITS: Final = {
    "_g_per_kg": "g/kg",
    "_deg_s": "°/s",
    "_m_s": "m/s",
    "_ms": "ms",
    "_deg": "°",
    "_bpm": "1/min",
    "_g": "g",
    "_m": "m",
    "_s": "s",
    **dict.fromkeys(("_early_stance", "_mid_stance", "_late_stance", "_terminal_swing"), "°"),
}


class Judged(NamedTuple):
    """How an error is laid beside a limit.

    Parameters
    ----------
    limit : str
        Field of :class:`swaystride.studies.experience.table_options.TruthLimits`.
    unit : str
        Of the limit: ``%`` is relative to the truth.
    factor : float
        From the unit of the error to that of the limit.
    """

    limit: str
    unit: str
    factor: float = 1.0


def _judged() -> dict[str, Judged]:
    """What is judged, by measure of the table of errors."""
    alignment = {
        f"alignment_{sensor}_vertical_deg": Judged("inclination_deg", "°") for sensor in SENSORS
    }
    for sensor in SENSORS:
        segment = sensor.split("_")[0]
        if segment in ("foot", "shank"):
            alignment[f"alignment_{sensor}_ml_deg"] = Judged("ml_shank_foot_deg", "°")
        elif segment == "thigh":
            alignment[f"alignment_{sensor}_ml_deg"] = Judged("ml_thigh_deg", "°")
    return {
        "stride_time_s": Judged("stride_time_ms", "ms", _MS_PER_S),
        "initial_contact_bias_ms": Judged("initial_contact_bias_ms", "ms"),
        "initial_contact_sd_ms": Judged("initial_contact_sd_ms", "ms"),
        "contact_time_s": Judged("contact_time_ms", "ms", _MS_PER_S),
        "duty_factor": Judged("duty_factor", ""),
        "stride_length_m": Judged("stride_length_pct", "%"),
        "hip_range_deg": Judged("hip_range_deg", "°"),
        "knee_range_deg": Judged("knee_range_deg", "°"),
        "peak_tibial_g": Judged("peak_tibial_pct", "%"),
        **alignment,
    }


JUDGED: Final = _judged()


def judged_errors(errors: pd.DataFrame, limits: TruthLimits) -> pd.DataFrame:
    """Errors that have a limit, in the unit of the limit.

    Parameters
    ----------
    errors : DataFrame
        Of all runs: ``run``, ``measure``, ``estimate``, ``truth``, ``error``.
    limits : TruthLimits

    Returns
    -------
    DataFrame
        ``run``, ``measure``, ``kind`` (field of the limits), ``unit``, ``error``, ``limit``,
        ``within``; what has no error (a bias, an angle between axes) is its own error.
    """
    own = errors[errors["measure"].isin(JUDGED)].reset_index(drop=True)
    rules = [JUDGED[name] for name in own["measure"]]
    error = own["error"].fillna(own["estimate"]).to_numpy(dtype=float)
    relative = np.array([rule.unit == "%" for rule in rules], dtype=bool)
    factor = np.array([rule.factor for rule in rules], dtype=float)
    truth = np.where(relative, own["truth"].to_numpy(dtype=float), 1.0)
    scaled = np.where(relative, 100.0 * error / truth, factor * error)
    most = asdict(limits)
    table = own[["run", "measure"]].assign(
        kind=[rule.limit for rule in rules],
        unit=[rule.unit for rule in rules],
        error=scaled,
        limit=[most[rule.limit] for rule in rules],
    )
    return table.assign(within=table["error"].abs() <= table["limit"])


def truth_errors(errors: pd.DataFrame, limits: TruthLimits) -> pd.DataFrame:
    """Judged errors of every run side by side.

    Parameters
    ----------
    errors : DataFrame
        See :func:`judged_errors`.
    limits : TruthLimits

    Returns
    -------
    DataFrame
        ``run``, one column per limit (the largest of the sensors for the axes), and ``outside``:
        how many of them exceed their limit.
    """
    judged = judged_errors(errors, limits)
    kinds = list(asdict(limits))
    runs = list(dict.fromkeys(errors["run"]))
    judged = judged[judged["error"].notna()]
    largest = judged.loc[judged["error"].abs().groupby([judged["run"], judged["kind"]]).idxmax()]
    wide = largest.pivot_table(index="run", columns="kind", values="error")
    wide = wide.reindex(index=runs, columns=kinds)
    outside = (~largest["within"]).groupby(largest["run"]).sum().reindex(runs, fill_value=0)
    return wide.reset_index().assign(outside=outside.to_numpy(dtype=int))


def truth_summary(errors: pd.DataFrame, limits: TruthLimits) -> pd.DataFrame:
    """Errors of every measure over the runs, beside their limits.

    Parameters
    ----------
    errors : DataFrame
        See :func:`judged_errors`.
    limits : TruthLimits

    Returns
    -------
    DataFrame
        ``measure``, ``n_runs``, ``truth_mean``, ``bias``, ``sd``, ``worst`` and ``unit`` (the
        measure's own), ``worst_run``; for judged ones ``worst_judged``, ``limit``, ``limit_unit``
        and ``within`` (``yes`` if every run is within the limit, else ``no``).
    """
    judged = judged_errors(errors, limits)
    names = {measure.key: measure.name for measure in MEASURES}
    rows = []
    for key in _ordered(errors["measure"]):
        own = errors[errors["measure"] == key]
        error = own["error"].fillna(own["estimate"])
        known = error.notna()
        at = int(error.abs().fillna(-1.0).to_numpy(dtype=float).argmax())
        row: dict[str, object] = {
            "measure": names.get(key, key.replace("_", " ")),
            "n_runs": int(known.sum()),
            "truth_mean": own["truth"].mean(),
            "bias": error.mean(),
            "sd": error.std(),
            "worst": error.iloc[at],
            "unit": unit_of(key),
            "worst_run": own["run"].iloc[at] if known.any() else "",
            "worst_judged": np.nan,
            "limit": np.nan,
            "limit_unit": "",
            "within": "",
        }
        beside = judged[(judged["measure"] == key) & judged["error"].notna()]
        if len(beside):
            row |= {
                "worst_judged": beside["error"].abs().max(),
                "limit": beside["limit"].iloc[0],
                "limit_unit": beside["unit"].iloc[0],
                "within": "yes" if beside["within"].all() else "no",
            }
        rows.append(row)
    return pd.DataFrame(rows)


def unit_of(measure: str) -> str:
    """Unit of a measure, from the end of its name.

    Parameters
    ----------
    measure : str

    Examples
    --------
    >>> unit_of("peak_tibial_g_per_kg"), unit_of("hip_range_deg_bone"), unit_of("duty_factor")
    ('g/kg', '°', '')
    """
    name = measure.removesuffix("_bone").removesuffix("_unfiltered")
    return next((unit for end, unit in _UNITS.items() if name.endswith(end)), "")


def _ordered(measures: pd.Series) -> list[str]:
    """Measures of the tables in their order, then the rest as it comes."""
    found = list(dict.fromkeys(measures))
    return [key for key in MEASURE_KEYS if key in found] + [
        key for key in found if key not in MEASURE_KEYS
    ]
