"""How many participants, runs and strides were recorded, excluded and analysed."""

from __future__ import annotations

from typing import Any

import pandas as pd

from swaystride.presentation.participant_flow import flow_line
from swaystride.studies.experience.table_inputs import participant_of


def study_flow(
    runs: pd.DataFrame, exclusions: pd.DataFrame, measured: pd.DataFrame, scores: pd.DataFrame
) -> list[dict[str, Any]]:
    """Count on the way to the analysis.

    Parameters
    ----------
    runs : DataFrame
        ``run`` of every run that the lab lists, once each.
    exclusions : DataFrame
        Runs that were left out: ``run``, ``reason``; a run may stand there more than once, and
        counts under its first reason.
    measured : DataFrame
        One row per measured run: ``run``, ``n_strides``, ``n_rejected``, ``heart_rate_bpm`` and
        ``peak_head_g`` (missing where the recording was lost).
    scores : DataFrame
        ``run``, ``n_ratings``.

    Returns
    -------
    list of dict
        For participants, runs, strides, and the parts of runs that a lab may lose: ``unit``,
        ``planned``, ``recorded``, ``excluded`` (list of reason and count), ``analysed``.
    """
    listed = runs["run"].astype(str)
    used = measured[measured["n_strides"] > 0]
    left_out = exclusions.drop_duplicates("run")
    left_out = left_out[left_out["run"].isin(listed) & ~left_out["run"].isin(used["run"])]
    counts = left_out["reason"].value_counts().sort_index()
    reasons = {str(why): int(n) for why, n in counts.items()}
    unexplained = len(listed) - len(used) - len(left_out)
    if unexplained:
        reasons["no stride after the warm-up"] = unexplained
    people = {participant_of(name) for name in listed}
    runners = {participant_of(name) for name in used["run"]}
    n_kept, n_rejected = (int(used[name].sum()) for name in ("n_strides", "n_rejected"))
    rated = scores.loc[scores["run"].isin(used["run"]), "n_ratings"]
    lost = {
        "runs with heart rate": ("no heart rate", used["heart_rate_bpm"].isna()),
        "runs with head sensor": ("no head sensor, or badly attached", used["peak_head_g"].isna()),
        "runs with ratings of affect": ("no rating", ~(rated > 0)),
    }
    return [
        flow_line("participants", len(people), {"no usable run": len(people) - len(runners)}),
        flow_line("runs", len(listed), reasons),
        flow_line("strides", n_kept + n_rejected, {"implausible times": n_rejected}),
        *(
            flow_line(unit, len(used), {reason: int(is_lost.sum())})
            for unit, (reason, is_lost) in lost.items()
        ),
    ]


def named_findings(findings: pd.DataFrame) -> pd.DataFrame:
    """Findings of all stages, each once, with the run where no file is at fault.

    Parameters
    ----------
    findings : DataFrame
        ``run`` and the columns of a finding, all text.

    Returns
    -------
    DataFrame
        The same columns.

    Examples
    --------
    >>> rows = {"run": ["P01_02"] * 2, "file": ["", ""]}
    >>> named_findings(pd.DataFrame(rows))["file"].tolist()
    ['run P01_02']
    """
    once = findings.drop_duplicates(ignore_index=True)
    return once.assign(file=once["file"].where(once["file"] != "", "run " + once["run"]))
