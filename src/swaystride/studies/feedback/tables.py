"""Tables 2.1-2.4 in the columns of data/published, and the searched models beside them."""

from __future__ import annotations

from typing import Final

import pandas as pd

from swaystride.studies.feedback.identities import (
    attainability,
    block_change_attainability,
)
from swaystride.studies.feedback.plan import FEATURES, MAXIMAL_TERMS

#: Term of the model -> its column in Table 2.2.
TABLE_2_2_COLUMNS: Final = {term: term.replace(":", "_x_") for term in MAXIMAL_TERMS}

#: Decimals of the printed tables.
EFFECT_DECIMALS: Final = {"estimate": 3, "ci_low": 3, "ci_high": 3, "p": 3}


def table_2_1(participants: pd.DataFrame) -> pd.DataFrame:
    """Demographics by group (Table 2.1); standard deviations are divided by n − 1.

    Parameters
    ----------
    participants : DataFrame
        As from :func:`swaystride.studies.feedback.design.read_design`.
    """
    rows = []
    for group in ("concurrent_first", "terminal_first"):
        people = participants[participants["order"] == group]
        rows.append(
            {
                "group": group,
                "n": len(people),
                "age_mean": people["age_years"].mean(),
                "age_sd": people["age_years"].std(),
                "n_female": int((people["sex"] == "F").sum()),
                "height_m_mean": people["height_m"].mean(),
                "height_m_sd": people["height_m"].std(),
                "mass_kg_mean": people["mass_kg"].mean(),
                "mass_kg_sd": people["mass_kg"].std(),
            }
        )
    return pd.DataFrame(rows)


def table_2_2(fixed_effects: pd.DataFrame, significance_level: float) -> pd.DataFrame:
    """Exponents and terms that our search and elimination keep (Table 2.2).

    Parameters
    ----------
    fixed_effects : DataFrame
        Fixed effects of all features, column ``model`` = ``searched``.
    significance_level : float
        ``yes*`` marks p below it.
    """
    rows = []
    for feature in FEATURES:
        chosen = fixed_effects.query("feature == @feature and model == 'searched'")
        p = chosen.set_index("term")["p"]
        row: dict[str, object] = {"feature": feature, "exponent": chosen["exponent"].iloc[0]}
        row["intercept"] = _inclusion(p, "Intercept", significance_level)
        for term, column in TABLE_2_2_COLUMNS.items():
            row[column] = _inclusion(p, term, significance_level)
        row["participant"] = "yes"
        rows.append(row)
    return pd.DataFrame(rows)


def table_2_3(contrasts: pd.DataFrame, printed: pd.DataFrame, last_trial: int) -> pd.DataFrame:
    """Effects of training and of removing feedback, at the printed exponents and terms.

    Parameters
    ----------
    contrasts : DataFrame
        Contrasts of all features (see :mod:`swaystride.studies.feedback.models`).
    printed : DataFrame
        data/published/table_2_3.csv, for the order of its rows and the identities among them.
    last_trial : int
        Trial number at which training effects are compared between features.

    Returns
    -------
    DataFrame
        The printed columns, then ``se``, ``df``, ``n``, ``refit_with`` (a term that the print
        shows although its model lacks it) and whether the printed row is jointly attainable.
    """
    keys = ["panel", "feature", "effect"]
    ours = contrasts[contrasts["model"] == "printed"].drop(
        columns=["model", "t", "last_training_trial"]
    )
    marks = attainability(printed, last_trial)
    table = printed[keys].merge(ours, on=keys, how="left", validate="one_to_one")
    table = table.merge(marks, on=keys, validate="one_to_one")
    first = [*keys[:2], "exponent", "effect", "estimate", "ci_low", "ci_high", "p"]
    last = ["se", "df", "n", "refit_with", "attainable", "attainable_reason"]
    return table[[*first, *last]]


def table_2_3_searched(contrasts: pd.DataFrame, printed: pd.DataFrame) -> pd.DataFrame:
    """The effects of Table 2.3 at the exponent and terms that our own search chose.

    Parameters
    ----------
    contrasts : DataFrame
        Contrasts of all features.
    printed : DataFrame
        data/published/table_2_3.csv, for the order of its rows.
    """
    keys = ["panel", "feature", "effect"]
    ours = contrasts[contrasts["model"] == "searched"]
    table = printed[keys].merge(ours, on=keys, how="left", validate="one_to_one")
    first = [*keys[:2], "exponent", "effect", "estimate", "ci_low", "ci_high", "p"]
    return table[[*first, "se", "df", "n", "refit_with"]]


def table_2_4(contrasts: pd.DataFrame, printed: pd.DataFrame, text: pd.DataFrame) -> pd.DataFrame:
    """Change from baseline to the end of the first block.

    The printed table repeats Table 2.3 (spec I-01); this is the contrast that its text describes.

    Parameters
    ----------
    contrasts : DataFrame
        Contrasts of all features.
    printed, text : DataFrame
        data/published/table_2_3.csv and table_2_4.csv: whether a value of the text can follow
        from Table 2.3.
    """
    ours = contrasts.query("model == 'printed' and panel == 'block_change'")
    last_trial = int(ours["last_training_trial"].iloc[0])
    marks = block_change_attainability(printed, text, last_trial)
    ours = ours.merge(marks, on=["effect", "feature"], how="left")
    order = ["concurrent", "terminal", "terminal_minus_concurrent"]
    ours = ours.sort_values("effect", key=lambda name: name.map(order.index), kind="stable")
    first = ["effect", "feature", "p", "estimate", "ci_low", "ci_high"]
    last = ["exponent", "se", "df", "n", "refit_with", "attainable", "attainable_reason"]
    return ours[[*first, *last]].reset_index(drop=True)


def coverage_of_print(table: pd.DataFrame, printed: pd.DataFrame) -> pd.DataFrame:
    """How many printed estimates the intervals of this cohort cover.

    Parameters
    ----------
    table : DataFrame
        Table 2.3 of this cohort, with ``attainable``.
    printed : DataFrame
        data/published/table_2_3.csv.

    Returns
    -------
    DataFrame
        ``printed_rows`` (jointly attainable or not), ``n`` and ``covered``.
    """
    keys = ["panel", "feature", "effect"]
    both = printed[[*keys, "estimate"]].merge(table, on=keys, suffixes=("_printed", ""))
    inside = both["estimate_printed"].between(both["ci_low"], both["ci_high"])
    attainable = both["attainable"].astype(bool)
    rows = [
        {"printed_rows": name, "n": int(chosen.sum()), "covered": int((inside & chosen).sum())}
        for name, chosen in (("jointly attainable", attainable), ("not attainable", ~attainable))
    ]
    return pd.DataFrame(rows)


def table_truth(contrasts: pd.DataFrame, truth: pd.DataFrame) -> pd.DataFrame:
    """Effects of a simulated cohort beside the truth that it was drawn from.

    Parameters
    ----------
    contrasts : DataFrame
        Contrasts of all features.
    truth : DataFrame
        ``panel``, ``feature``, ``effect`` and ``truth``, written by the simulator.

    Returns
    -------
    DataFrame
        Truth, estimate, difference in standard errors, and whether the interval covers the truth.
    """
    keys = ["panel", "feature", "effect"]
    ours = contrasts[contrasts["model"] == "printed"]
    table = truth[[*keys, "truth"]].merge(ours, on=keys, how="left", validate="one_to_one")
    table["difference_in_se"] = (table["estimate"] - table["truth"]) / table["se"]
    table["covered"] = table["truth"].between(table["ci_low"], table["ci_high"])
    columns = ["exponent", "truth", "estimate", "ci_low", "ci_high", "difference_in_se", "covered"]
    return table[[*keys, *columns]]


def _inclusion(p: pd.Series, term: str, significance_level: float) -> str:
    """How Table 2.2 writes a term: yes* (significant), yes (included) or no."""
    if term not in p.index:
        return "no"
    return "yes*" if p[term] < significance_level else "yes"
