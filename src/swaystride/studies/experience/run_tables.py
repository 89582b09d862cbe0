"""Tables of single runs: what each was like, its pattern, and associations within it."""

from __future__ import annotations

from typing import Final

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import HEART_RATE, MEASURES, SCALES

#: Measures that describe a run in the table of runs.
DESCRIBED: Final = (
    "speed_m_s",
    "stride_length_m",
    "stride_time_s",
    "contact_time_s",
    "flight_time_s",
    "duty_factor",
    HEART_RATE,
)
#: Intervals of a correlation within a run: estimate and limits. The printed one is of the correlation
#: itself, from windows taken as independent around a line of measure and time.
INTERVALS: Final = {
    "printed": ("r", "ci_low", "ci_high"),
    "given_time": ("r_partial", "ci_low_partial", "ci_high_partial"),
    "ar1": ("r", "ci_low_ar1", "ci_high_ar1"),
    "ar1_given_time": ("r_partial", "ci_low_partial_ar1", "ci_high_partial_ar1"),
    "block": ("r", "ci_low_block", "ci_high_block"),
    "block_given_time": ("r_partial", "ci_low_partial_block", "ci_high_partial_block"),
}
#: Groups of runs that are counted.
WITHIN_GROUPS: Final = ("all", "aerial", "terrestrial")


def runs_table(
    observations: pd.DataFrame,
    windows: pd.DataFrame,
    scores: pd.DataFrame,
    checks: pd.DataFrame,
) -> pd.DataFrame:
    """One row per run that the lab lists.

    Parameters
    ----------
    observations : DataFrame
        Analysed runs: measures, scales, ``pattern``, ``n_strides``, ``n_rejected``.
    windows : DataFrame
        Their windows, with ``run``.
    scores : DataFrame
        ``run``, ``n_ratings`` and the scores.
    checks : DataFrame
        What the import says of every run, see
        :meth:`swaystride.studies.experience.table_inputs.StageTables.checks`.

    Returns
    -------
    DataFrame
        ``run``, ``participant``, ``pattern``, what the run was like, the three scales, counts of
        strides, ratings and windows, ``missing_sensors``, and why it is left out (``excluded``).
    """
    table = checks[["run", "participant"]].copy()
    table["minutes"] = checks["duration_s"].to_numpy(dtype=float) / 60.0
    own = observations.set_index("run").reindex(table["run"])
    for name in ("pattern", *DESCRIBED, *SCALES, "n_strides", "n_rejected"):
        table[name] = own[name].to_numpy()
    ratings = scores.set_index("run")["n_ratings"]
    table["n_ratings"] = ratings.reindex(table["run"]).to_numpy()
    counts = windows.groupby("run").size()
    table["n_windows"] = counts.reindex(table["run"]).to_numpy()
    for name in ("n_strides", "n_rejected", "n_ratings", "n_windows"):
        table[name] = table[name].astype("Int64")
    table["missing_sensors"] = checks["missing_sensors"].fillna("").to_numpy()
    table["excluded"] = np.where(checks["excluded"], checks["reason"].fillna(""), "")
    return table.fillna({"pattern": ""})


def classes_table(observations: pd.DataFrame, truth: pd.DataFrame | None) -> pd.DataFrame:
    """Pattern of every run: as measured, at 12 km/h, and in truth.

    Parameters
    ----------
    observations : DataFrame
        ``run``, ``participant``, ``speed_m_s``, ``duty_factor``, ``pattern`` and
        ``duty_factor_at_12_km_h`` with ``pattern_at_12_km_h`` (missing where it is not computed).
    truth : DataFrame or None
        ``run``, ``duty_factor``, ``pattern`` of a simulated cohort.

    Returns
    -------
    DataFrame
        Those columns, then ``true_duty_factor``, ``true_pattern`` and ``agrees`` (1: the measured
        pattern is the true one); missing without truth.
    """
    columns = ["run", "participant", "speed_m_s", "duty_factor", "pattern"]
    adjusted = ["duty_factor_at_12_km_h", "pattern_at_12_km_h"]
    table = observations.reindex(columns=[*columns, *adjusted]).reset_index(drop=True)
    table["pattern_at_12_km_h"] = table["pattern_at_12_km_h"].astype(object).fillna("")
    table["true_duty_factor"] = np.nan
    table["true_pattern"] = ""
    table["agrees"] = pd.array([pd.NA] * len(table), dtype="Int64")
    if truth is not None and len(table):
        known = truth.set_index("run").loc[table["run"]]
        table["true_duty_factor"] = known["duty_factor"].to_numpy(dtype=float)
        table["true_pattern"] = known["pattern"].to_numpy()
        table["agrees"] = (table["pattern"] == table["true_pattern"]).astype("Int64")
    return table


def within_runs_table(within: pd.DataFrame) -> pd.DataFrame:
    """How often a measure and affect go together within runs.

    Parameters
    ----------
    within : DataFrame
        One row per run and measure: ``pattern``, ``r`` and the limits of :data:`INTERVALS`; limits
        that a variant does not compute are missing.

    Returns
    -------
    DataFrame
        One row per measure and kind of ``interval`` that was computed: ``measure`` (printed name),
        ``interval``, ``n_runs`` (with an estimate), median, least and largest correlation, and by
        group (``all``, ``aerial``, ``terrestrial``) the number of runs, and of those whose interval
        lies above and below zero.
    """
    rows = []
    for kind, (estimate, low, high) in INTERVALS.items():
        if low not in within or within[low].notna().sum() == 0:
            continue
        for measure in MEASURES:
            own = within[(within["measure"] == measure.key) & within[low].notna()]
            row: dict[str, object] = {"measure": measure.name, "interval": kind}
            row |= {
                "n_runs": len(own),
                "r_median": own[estimate].median(),
                "r_least": own[estimate].min(),
                "r_largest": own[estimate].max(),
            }
            for group in WITHIN_GROUPS:
                chosen = own if group == "all" else own[own["pattern"] == group]
                row |= {
                    f"n_{group}": len(chosen),
                    f"n_positive_{group}": int((chosen[low] > 0).sum()),
                    f"n_negative_{group}": int((chosen[high] < 0).sum()),
                }
            rows.append(row)
    groups = [
        f"{count}_{group}"
        for group in WITHIN_GROUPS
        for count in ("n", "n_positive", "n_negative")
        if (count, group) != ("n", "all")
    ]
    columns = ["measure", "interval", "n_runs", "r_median", "r_least", "r_largest", *groups]
    return pd.DataFrame(rows, columns=columns)


def confounded_share(within: pd.DataFrame) -> float:
    """Share of the significant correlations within runs that time explains.

    Parameters
    ----------
    within : DataFrame
        One row per run and measure.

    Returns
    -------
    float
        Of the rows whose printed interval lies on one side of zero, the share whose interval with
        time held constant does not; NaN where that was not computed.
    """
    _, low, high = INTERVALS["printed"]
    _, low_held, high_held = INTERVALS["given_time"]
    if low_held not in within:
        return float("nan")
    known = within[within[low].notna() & within[low_held].notna()]
    significant = known[(known[low] > 0) | (known[high] < 0)]
    if significant.empty:
        return float("nan")
    remains = (significant[low_held] > 0) | (significant[high_held] < 0)
    return float(1.0 - remains.mean())


def runs_are_alike(observations: pd.DataFrame) -> bool | None:
    """Whether mean affect differs less between the runs of a participant than between participants.

    Parameters
    ----------
    observations : DataFrame
        ``participant``, ``affective_valence``.

    Returns
    -------
    bool or None
        Whether the mean square between participants exceeds that within; None where nobody has two
        rated runs, or there is one participant.
    """
    rated = observations.dropna(subset=["affective_valence"])
    by_person = rated.groupby("participant")["affective_valence"]
    within_df = len(rated) - by_person.ngroups
    if within_df < 1 or by_person.ngroups < 2:
        return None
    value = rated["affective_valence"]
    inside = float(((value - by_person.transform("mean")) ** 2).sum()) / within_df
    outside = float(((by_person.transform("mean") - value.mean()) ** 2).sum())
    return outside / (by_person.ngroups - 1) > inside
