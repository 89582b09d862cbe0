"""What the printed correlations can be at all, and what chance gives without any association."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import MEASURES, SCALES
from swaystride.studies.experience.tables import GROUP_TABLES

_KEYS: Final = ["group", "measure", "scale"]


def attainable_table(
    population: pd.DataFrame, associations: pd.DataFrame, significance_level: float
) -> pd.DataFrame:
    """Printed, attainable and measured correlations.

    Parameters
    ----------
    population : DataFrame
        ``group``, ``measure`` (key), ``scale``, ``printed`` and ``attainable``: the correlation of
        the population that the ratings were drawn from.
    associations : DataFrame
        Of this cohort: ``group``, ``measure``, ``scale``, ``r``, ``ci_low``, ``ci_high``, ``p``.
    significance_level : float

    Returns
    -------
    DataFrame
        ``group``, ``measure`` (printed name), ``scale``, ``r_printed``, ``r_attainable``,
        ``distance`` (attainable − printed), ``r_measured``, ``difference`` (measured −
        attainable), ``covered`` (1: the interval holds the attainable value) and ``significant``.
    """
    columns = [*_KEYS, "r", "ci_low", "ci_high", "p"]
    table = population.merge(associations[columns], on=_KEYS, how="left")
    rank = {measure.key: at for at, measure in enumerate(MEASURES)}
    orders = (dict(zip(GROUP_TABLES, range(len(GROUP_TABLES)), strict=True)), rank)
    table = table.assign(
        at_group=table["group"].map(orders[0]),
        at_measure=table["measure"].map(orders[1]),
        at_scale=table["scale"].map({scale: at for at, scale in enumerate(SCALES)}),
    ).sort_values(["at_group", "at_measure", "at_scale"], kind="stable")
    known = table["r"].notna()
    inside = table["attainable"].between(table["ci_low"], table["ci_high"])
    names = {measure.key: measure.name for measure in MEASURES}
    return pd.DataFrame(
        {
            "group": table["group"],
            "measure": table["measure"].map(names),
            "scale": table["scale"],
            "r_printed": table["printed"],
            "r_attainable": table["attainable"],
            "distance": table["attainable"] - table["printed"],
            "r_measured": table["r"],
            "difference": table["r"] - table["attainable"],
            "covered": inside.astype("Int64").where(known),
            "significant": (table["p"] <= significance_level).astype("Int64").where(known),
        }
    ).reset_index(drop=True)


def null_cohort_table(
    cohort: pd.DataFrame, null: pd.DataFrame, published: pd.DataFrame, significance_level: float
) -> pd.DataFrame:
    """How many rows are significant in the cohort, in one without associations, and in print.

    Parameters
    ----------
    cohort, null : DataFrame
        Associations of the cohort, and of ratings that have nothing to do with the measures.
    published : DataFrame
        Printed Tables 5.3 and 5.4, with ``group``, ``scale`` and ``significant``.
    significance_level : float

    Returns
    -------
    DataFrame
        By ``group`` and ``scale``: ``n_rows``, ``expected_by_chance`` (level times rows), the
        numbers of significant rows ``n_printed``, ``n_cohort``, ``n_null``, those that stay so
        after Benjamini-Hochberg (``n_cohort_q``, ``n_null_q``), and the largest size of a
        correlation in both.
    """
    rows = []
    for group in GROUP_TABLES:
        for scale in SCALES:
            row: dict[str, object] = {"group": group, "scale": scale}
            drawn = {"cohort": _chosen(cohort, group, scale), "null": _chosen(null, group, scale)}
            n_rows = int(drawn["cohort"]["p"].notna().sum())
            print_rows = _chosen(published, group, scale)
            row |= {
                "n_rows": n_rows,
                "expected_by_chance": significance_level * n_rows,
                "n_printed": int(print_rows["significant"].sum()),
            }
            for name, own in drawn.items():
                row[f"n_{name}"] = int((own["p"] <= significance_level).sum())
            for name, own in drawn.items():
                known = "q" in own and own["q"].notna().any()
                row[f"n_{name}_q"] = int((own["q"] <= significance_level).sum()) if known else pd.NA
            for name, own in drawn.items():
                row[f"largest_r_{name}"] = own["r"].abs().max() if len(own) else np.nan
            rows.append(row)
    table = pd.DataFrame(rows)
    return table.astype({f"n_{name}_q": "Int64" for name in ("cohort", "null")})


def printed_associations(tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Printed Tables 5.3 and 5.4 below each other, measures by their keys.

    Parameters
    ----------
    tables : dict of str to DataFrame
        By group.

    Returns
    -------
    DataFrame
        The printed columns and ``group``.
    """
    keys = {measure.name: measure.key for measure in MEASURES}
    parts = [table.assign(group=group) for group, table in tables.items()]
    joined = pd.concat(parts, ignore_index=True)
    return joined.assign(measure=joined["measure"].map(keys))


def _chosen(table: pd.DataFrame, group: str, scale: str) -> pd.DataFrame:
    return table[(table["group"] == group) & (table["scale"] == scale)]
