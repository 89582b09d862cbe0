"""Results of a simulated cohort beside the population that it was drawn from."""

from __future__ import annotations

import pandas as pd


def truth_table(results: pd.DataFrame, population: pd.DataFrame) -> pd.DataFrame:
    """Put every result beside its population value.

    Parameters
    ----------
    results : DataFrame
        All results of the cohort.
    population : DataFrame
        ``quantity`` and ``value``, as the simulator writes them.

    Returns
    -------
    DataFrame
        ``quantity``, ``population``, ``estimate``, the participant-level interval, ``covered``
        (``yes``, ``no``, or empty without an interval).
    """
    kept = ["quantity", "estimate", "participant_ci_low", "participant_ci_high"]
    joined = population.rename(columns={"value": "population"}).merge(results[kept], on="quantity")
    inside = joined["population"].between(
        joined["participant_ci_low"], joined["participant_ci_high"]
    )
    known = joined["participant_ci_low"].notna()
    joined["covered"] = inside.map({True: "yes", False: "no"}).where(known, "")
    joined["quantity"] = joined["quantity"].str.removeprefix("study3_text/")
    return joined[["quantity", "population", *kept[1:], "covered"]]
