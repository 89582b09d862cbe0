"""How many participants, trials and strides were planned, recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

from swaystride.presentation.participant_flow import flow_line
from swaystride.studies.kinematics.summaries import TRIAL_KEYS


def study_flow(
    planned: pd.DataFrame, exclusions: pd.DataFrame, strides: pd.DataFrame
) -> list[dict[str, Any]]:
    """Count on the way to the analysis.

    Parameters
    ----------
    planned : DataFrame
        ``participant`` and ``trial`` of every trial that the lab lists, once each.
    exclusions : DataFrame
        Trials that the import left out: ``participant``, ``trial``, ``reason``; a trial may stand
        there more than once, and counts under its first reason.
    strides : DataFrame
        Counted strides: ``participant``, ``trial``, ``side``, ``stride``, in any number of rows.

    Returns
    -------
    list of dict
        For participants, trials and strides: ``unit``, ``planned``, ``recorded``, ``excluded``
        (list of reason and count), ``analysed``. As many trials are planned for everybody as the
        one has who has most.
    """
    keys = list(TRIAL_KEYS)
    listed = planned[keys].astype(str).drop_duplicates()
    used = strides[keys].astype(str).drop_duplicates()
    left_out = exclusions.astype(str).drop_duplicates(keys)
    left_out = left_out.merge(listed, on=keys).merge(used, on=keys, how="left", indicator="_used")
    left_out = left_out[left_out["_used"] == "left_only"]
    reasons = {
        str(why): int(n) for why, n in left_out["reason"].value_counts().sort_index().items()
    }
    unexplained = len(listed) - len(used) - len(left_out)
    if unexplained:
        reasons["no stride that both sources measured"] = unexplained
    people = listed["participant"].nunique()
    per_person = int(listed.groupby("participant").size().max()) if people else 0
    n_strides = len(strides.drop_duplicates([*keys, "side", "stride"]))
    idle = {"no usable trial": people - used["participant"].nunique()}
    return [
        flow_line("participants", people, idle),
        flow_line("trials", len(listed), reasons, planned=people * per_person),
        flow_line("strides", n_strides, {}),
    ]


def named_findings(findings: pd.DataFrame) -> pd.DataFrame:
    """Findings of all stages, each once, with the trial where no file is at fault.

    Parameters
    ----------
    findings : DataFrame
        ``participant``, ``trial`` and the columns of a finding, all text.

    Returns
    -------
    DataFrame
        The same columns.

    Examples
    --------
    >>> rows = {"participant": ["P01"] * 2, "trial": ["02"] * 2, "file": ["", ""]}
    >>> named_findings(pd.DataFrame(rows))["file"].tolist()
    ['P01, trial 02']
    """
    once = findings.drop_duplicates(ignore_index=True)
    trial = once["participant"] + ", trial " + once["trial"]
    return once.assign(file=once["file"].where(once["file"] != "", trial))
