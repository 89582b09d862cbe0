"""Tables of people, definitions and associations between runs (table contract)."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import MEASURES, SCALES

#: Groups of runs and the printed tables of their associations.
GROUP_TABLES: Final = {"all": "table_5_3", "aerial": "table_5_4"}
#: Columns of Tables 5.3 and 5.4: those of the print, then ours.
ASSOCIATION_COLUMNS: Final = (
    "measure",
    "scale",
    "r",
    "beta",
    "p",
    "significant",
    "n",
    "ci_low",
    "ci_high",
    "q",
    "ci_low_cluster",
    "ci_high_cluster",
    "n_participants",
    "rating_sd",
)
#: Table 5.2: measure, printed definition, our column with its unit, and what is done in detail.
_DEFINITIONS: Final = (
    ("stride_time", "time between initial contacts of the same side", "stride_time_s", "s",
     "from one initial contact to the next of the same foot"),
    ("contact_time", "time between initial contact and toe-off of the same side",
     "contact_time_s", "s", "toe-off less the contact before it"),
    ("flight_time", "time between toe-off and initial contact of opposite sides",
     "flight_time_s", "s", "contact of the other foot less toe-off; negative where both are down"),
    ("duty_factor", "contact time / stride time", "duty_factor", "1",
     "of each stride, then averaged"),
    ("stride_length", "distance between initial contacts of the same side", "stride_length_m", "m",
     "horizontal, from zero velocity to zero velocity of the foot that is on the ground"),
    ("speed", "stride length / stride time", "speed_m_s", "m/s", "of each stride, then averaged"),
)  # fmt: skip


def table_5_1(participants: pd.DataFrame) -> pd.DataFrame:
    """The runners.

    Parameters
    ----------
    participants : DataFrame
        The lab's ``participants.tsv``.

    Returns
    -------
    DataFrame
        As printed: ``participant, sex, age, height_cm, mass_kg, highest_level, current_level``.
    """
    levels = {
        name: participants[name].astype(object).where(participants[name].notna(), "").astype(str)
        for name in ("highest_level", "current_level")
    }
    return pd.DataFrame(
        {
            "participant": participants["participant"].astype(str),
            "sex": participants["sex"],
            "age": participants["age_years"].astype(float),
            "height_cm": 100.0 * participants["height_m"].astype(float),
            "mass_kg": participants["mass_kg"].astype(float),
            **levels,
        }
    ).reset_index(drop=True)


def table_5_2() -> pd.DataFrame:
    """Definitions of the spatiotemporal measures.

    Returns
    -------
    DataFrame
        ``measure, definition`` as printed, then ``column`` of our tables, ``unit`` and ``here``:
        what is done in detail. Every measure is the mean over the strides of each side, then of
        both sides.

    Examples
    --------
    >>> table_5_2()["measure"].tolist()[:2]
    ['stride_time', 'contact_time']
    """
    columns = ["measure", "definition", "column", "unit", "here"]
    return pd.DataFrame(list(_DEFINITIONS), columns=columns)


def association_table(
    associations: pd.DataFrame, group: str, significance_level: float
) -> pd.DataFrame:
    """Table 5.3 (all runs) or 5.4 (aerial runs).

    Parameters
    ----------
    associations : DataFrame
        Of all groups: ``group, measure, scale, n, r, ci_low, ci_high, p, q, beta, rating_sd,
        ci_low_cluster, ci_high_cluster, n_participants``; measures by their keys.
    group : {"all", "aerial"}
    significance_level : float
        Largest p called significant.

    Returns
    -------
    DataFrame
        :data:`ASSOCIATION_COLUMNS`, rows in the printed order, measures by their printed names. An
        association that could not be estimated has a row without numbers.
    """
    names = {measure.key: measure.name for measure in MEASURES}
    own = associations[associations["group"] == group]
    order = pd.MultiIndex.from_product([list(names), SCALES], names=["measure", "scale"])
    table = own.set_index(["measure", "scale"]).reindex(order).reset_index()
    table["measure"] = table["measure"].map(names)
    known = table["p"].notna()
    table["significant"] = (table["p"] <= significance_level).astype("Int64").where(known)
    counts = dict.fromkeys(("n", "n_participants"), "Int64")
    return table.reindex(columns=list(ASSOCIATION_COLUMNS)).astype(counts)


def wide_associations(table: pd.DataFrame) -> pd.DataFrame:
    """R, β and p of the three scales side by side, as the print has them.

    Parameters
    ----------
    table : DataFrame
        From :func:`association_table`.

    Returns
    -------
    DataFrame
        ``measure``, then ``r_<scale>``, ``beta_<scale>`` and ``p_<scale>`` of every scale.
    """
    rows = table["measure"].drop_duplicates().to_list()
    wide: dict[str, object] = {"measure": rows}
    for scale in SCALES:
        own = table[table["scale"] == scale].set_index("measure").loc[rows]
        for name in ("r", "beta", "p"):
            wide[f"{name}_{scale}"] = own[name].to_numpy(dtype=float)
    return pd.DataFrame(wide)


def cohort_table(participants: pd.DataFrame, runs: pd.DataFrame) -> pd.DataFrame:
    """Who took part, and how often.

    Parameters
    ----------
    participants : DataFrame
    runs : DataFrame
        The lab's ``runs.tsv``.

    Returns
    -------
    DataFrame
        One row: ``n``, ``n_female``, ``n_runs``, mean and standard deviation (n − 1) of age, height,
        mass and of the number of runs of a participant.
    """
    counts = runs.groupby(runs["participant"].astype(str)).size()
    per_person = counts.reindex(participants["participant"].astype(str), fill_value=0)
    row: dict[str, float] = {
        "n": len(participants),
        "n_female": int((participants["sex"] == "F").sum()),
        "n_runs": len(runs),
    }
    columns = {
        **{name: participants[name] for name in ("age_years", "height_m", "mass_kg")},
        "runs_per_participant": per_person,
    }
    for name, values in columns.items():
        numbers = values.to_numpy(dtype=float)
        row[f"{name}_mean"] = float(numbers.mean())
        row[f"{name}_sd"] = float(np.std(numbers, ddof=1)) if numbers.size > 1 else float("nan")
    return pd.DataFrame([row])
