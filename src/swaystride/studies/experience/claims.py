"""What the chapter states, and what this cohort shows (dissertation §5.4-5.6)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import pandas as pd

from swaystride.studies.experience.plan import MEASURES, SCALES
from swaystride.studies.experience.table_options import TableOptions

Group = Literal["all", "aerial"]

GROUPS: Final[tuple[Group, Group]] = ("all", "aerial")
AFFECT, ENJOYMENT, FLOW = SCALES
SPATIOTEMPORAL: Final = (
    "Speed", "Stride Length", "Stride Time", "Contact Time", "Flight Time", "Duty Factor",
)  # fmt: skip
COORDINATION: Final = tuple(m.name for m in MEASURES if m.name.endswith("Coordination Variability"))
ARMS: Final = tuple(m.name for m in MEASURES if m.name.startswith("Arm "))
STABILITY: Final = tuple(m.name for m in MEASURES if "Ratio of Pelvis" in m.name)
ATTENUATION: Final = tuple(m.name for m in MEASURES if m.name.endswith("Attenuation"))
PELVIC_AND_HEAD: Final = ("Peak Pelvic Acceleration", "Peak Head Acceleration")
LOWER_BODY_PEAKS: Final = ("Peak Tibial Acceleration", "Peak Pelvic Acceleration")


@dataclass(frozen=True, eq=False)
class Evidence:
    """Results of one cohort, as the claims ask for them.

    Parameters
    ----------
    associations : mapping of str to DataFrame
        Tables 5.3 (``all``) and 5.4 (``aerial``): ``measure``, ``scale``, ``r``, ``p``.
    within : DataFrame
        From :func:`swaystride.studies.experience.run_tables.within_runs_table`.
    confounded_share : float
        From :func:`swaystride.studies.experience.run_tables.confounded_share`; may be missing.
    text : DataFrame
        ``quantity``, ``value``, ``p`` of the running text.
    patterns : Series
        Pattern of every analysed run.
    runs_are_alike : bool or None
        Whether affect differs less within participants than between them; None where nobody has
        two runs.
    options : TableOptions
    """

    associations: dict[Group, pd.DataFrame]
    within: pd.DataFrame
    confounded_share: float
    text: pd.DataFrame
    patterns: pd.Series
    runs_are_alike: bool | None
    options: TableOptions

    def rows(
        self, group: Group, scale: str | None = None, measures: Sequence[str] | None = None
    ) -> pd.DataFrame:
        """Estimated associations of a group, a scale, some measures."""
        table = self.associations[group]
        table = table[table["p"].notna()]
        if scale is not None:
            table = table[table["scale"] == scale]
        return table if measures is None else table[table["measure"].isin(measures)]

    def significant(
        self, group: Group, scale: str | None = None, measures: Sequence[str] | None = None
    ) -> pd.DataFrame:
        """Those of them that are significant."""
        table = self.rows(group, scale, measures)
        return table[table["p"] <= self.options.significance_level]

    def quantity(self, name: str, column: str = "value") -> float:
        """A number of the running text."""
        return float(self.text.loc[self.text["quantity"] == name, column].iloc[0])


@dataclass(frozen=True)
class Claim:
    """One statement of the chapter.

    Parameters
    ----------
    text : str
        The statement, in our words.
    section : str
        Where it is made.
    parts : callable
        From the evidence to whether each part holds; no part: it cannot be tested.
    """

    text: str
    section: str
    parts: Callable[[Evidence], list[bool]]


def _found(scale: str, sign: int, *rows: tuple[Group, str]) -> Callable[[Evidence], list[bool]]:
    """Each row that was estimated is significant in the stated direction."""

    def parts(e: Evidence) -> list[bool]:
        found = [e.rows(group, scale, [measure]) for group, measure in rows]
        level = e.options.significance_level
        return [
            bool(row["p"].iloc[0] <= level and sign * row["r"].iloc[0] > 0)
            for row in found
            if len(row)
        ]

    return parts


def _both(measure: str) -> tuple[tuple[Group, str], tuple[Group, str]]:
    return (("all", measure), ("aerial", measure))


def _absent(
    scale: str, measures: Sequence[str], groups: Sequence[Group] = GROUPS
) -> Callable[[Evidence], list[bool]]:
    """No row of these is significant; one part per group and measure that was estimated."""

    def parts(e: Evidence) -> list[bool]:
        level = e.options.significance_level
        return [bool(p > level) for group in groups for p in e.rows(group, scale, measures)["p"]]

    return parts


def _only(scale: str, measure: str) -> Callable[[Evidence], list[bool]]:
    """Nothing else is significant with the scale."""
    return lambda e: [set(e.significant(group, scale)["measure"]) <= {measure} for group in GROUPS]


def _scales_correlate(e: Evidence) -> list[bool]:
    level, o = e.options.significance_level, e.options
    moderate = o.moderate_r <= e.quantity("r_fss_paces") < o.strong_r
    if any(np.isnan(e.quantity(name, "p")) for name in ("r_fss_paces", "r_fs_fss", "r_fs_paces")):
        return []
    return [
        moderate and e.quantity("r_fss_paces", "p") <= level,
        e.quantity("r_fs_fss", "p") > level,
        e.quantity("r_fs_paces", "p") > level,
    ]


def _affect_is_neutral_or_good(e: Evidence) -> list[bool]:
    return [e.quantity("feeling_scale_min") >= 0]


def _repeated_runs_are_alike(e: Evidence) -> list[bool]:
    return [] if e.runs_are_alike is None else [e.runs_are_alike]


def _no_run_between(e: Evidence) -> list[bool]:
    """Register I-30: every run is of one pattern or the other."""
    return [bool((e.patterns != "intermediate").all())] if len(e.patterns) else []


def _most_are_aerial(e: Evidence) -> list[bool]:
    return [bool((e.patterns == "aerial").mean() > e.options.majority)] if len(e.patterns) else []


def _more_in_aerial_runs(e: Evidence) -> list[bool]:
    if e.rows("aerial").empty:
        return []
    return [len(e.significant("aerial")) > len(e.significant("all"))]


def _scales_differ(e: Evidence) -> list[bool]:
    """No measure is significant with all three scales."""
    held = []
    for group in GROUPS:
        scales = e.significant(group).groupby("measure")["scale"].nunique()
        held.append(not bool((scales == len(SCALES)).any()))
    return held


def _coordination_is_idle(e: Evidence) -> list[bool]:
    """At most one of twelve in each group."""
    return [len(e.significant(group, AFFECT, COORDINATION)) <= 1 for group in GROUPS]


def _some_run_is_significant(e: Evidence) -> list[bool]:
    own = e.within[e.within["interval"] == "printed"]
    return [bool(n > 0) for n in own["n_positive_all"] + own["n_negative_all"]]


def _no_majority(e: Evidence) -> list[bool]:
    """Per measure: in no group are more than half of the runs significant with one sign."""
    own = e.within[e.within["interval"] == "printed"]
    consistent = pd.Series(False, index=own.index)
    for group, total in (
        ("all", "n_runs"),
        ("aerial", "n_aerial"),
        ("terrestrial", "n_terrestrial"),
    ):
        most = own[[f"n_positive_{group}", f"n_negative_{group}"]].max(axis=1)
        consistent |= most > e.options.majority * own[total]
    return [not held for held in consistent]


def _time_confounds(e: Evidence) -> list[bool]:
    share = e.confounded_share
    return [] if np.isnan(share) else [share > e.options.majority]


def _nothing(_: Evidence) -> list[bool]:
    """No part: these recordings cannot say it."""
    return []


PTA, PTA_KG = "Peak Tibial Acceleration", "Peak Tibial Acceleration Per BW"
SHANK_PELVIS, PELVIS_HEAD = "Shank-to-Pelvis Attenuation", "Pelvis-to-Head Attenuation"
SHANK_HEAD, PHA = "Shank-to-Head Attenuation", "Peak Head Acceleration"
ROLL, ARM_VERTICAL = "Foot Peak Roll Rate", "Arm Vertical Acceleration RMS"
SHANK_THIGH = "Shank-Thigh MS Coordination Variability"

CLAIMS: Final = (
    Claim("Flow and enjoyment are moderately correlated, affect with neither.", "§5.4.1", _scales_correlate),
    Claim("Affect lies between neutral and very good.", "§5.4.1", _affect_is_neutral_or_good),
    Claim("Affect of repeated runs of one runner is more alike than that of different runners.", "§5.4.1", _repeated_runs_are_alike),
    Claim("Most runs are aerial.", "§5.4.2", _most_are_aerial),
    Claim("No run lies between the cut-offs.", "§5.3.4.2, §5.4.2", _no_run_between),
    Claim("More associations are significant in aerial runs than in all runs.", "§5.5", _more_in_aerial_runs),
    Claim("Different measures belong to each scale: none is significant with all three.", "§5.5, §5.6", _scales_differ),
    Claim("Terrestrial runs may have other associations than aerial ones.", "§5.5", _nothing),
    Claim("Heart rate is not associated with affect.", "§5.5.1", _absent(AFFECT, ["Heart Rate"])),
    Claim("Higher affect with lower speed, aerial runs.", "§5.5.1", _found(AFFECT, -1, ("aerial", "Speed"))),
    Claim("Higher affect with smaller hip range and foot roll rate, aerial runs.", "§5.5.1", _found(AFFECT, -1, ("aerial", "Hip ROM"), ("aerial", ROLL))),
    Claim("Affect is not associated with knee range and the other spatiotemporal measures.", "§5.5.1", _absent(AFFECT, ["Knee ROM", *SPATIOTEMPORAL[1:]])),
    Claim("Higher affect with lower peak tibial acceleration (per body weight in all runs; both in aerial runs).", "§5.5.1", _found(AFFECT, -1, ("all", PTA_KG), ("aerial", PTA), ("aerial", PTA_KG))),
    Claim("Higher affect with more attenuation from shank to pelvis.", "§5.5.1", _found(AFFECT, 1, *_both(SHANK_PELVIS))),
    Claim("Higher affect with less attenuation from pelvis to head, aerial runs only.", "§5.5.1", lambda e: _found(AFFECT, -1, ("aerial", PELVIS_HEAD))(e) + _absent(AFFECT, [PELVIS_HEAD], ("all",))(e)),
    Claim("Affect is not associated with peak pelvic and head acceleration.", "§5.5.1", _absent(AFFECT, PELVIC_AND_HEAD)),
    Claim("Higher affect with a larger vertical share of pelvis acceleration, aerial runs.", "§5.5.1", _found(AFFECT, 1, ("aerial", STABILITY[0]))),
    Claim("Coordination variability is hardly associated with affect (at most one of twelve).", "§5.5.1", _coordination_is_idle),
    Claim("Higher affect with less shank-thigh variability in mid-stance, all runs.", "§5.5.1", _found(AFFECT, -1, ("all", SHANK_THIGH))),
    Claim("Arm movement is not associated with affect.", "§5.5.1", _absent(AFFECT, ARMS)),
    Claim("Higher enjoyment with more attenuation from shank to head.", "§5.5.2", _found(ENJOYMENT, 1, *_both(SHANK_HEAD))),
    Claim("Enjoyment is associated with nothing else.", "§5.5.2", _only(ENJOYMENT, SHANK_HEAD)),
    Claim("Higher enjoyment with more attenuation of the lower body (the tables have none, register I-28).", "abstract, §5.6", _found(ENJOYMENT, 1, *_both(SHANK_PELVIS))),
    Claim("Higher flow with higher peak head acceleration.", "§5.5.3", _found(FLOW, 1, *_both(PHA))),
    Claim("Higher flow with higher foot roll rate.", "§5.5.3", _found(FLOW, 1, *_both(ROLL))),
    Claim("Higher flow with more vertical arm movement.", "§5.5.3", _found(FLOW, 1, *_both(ARM_VERTICAL))),
    Claim("Higher flow with longer flight and smaller duty factor, aerial runs.", "§5.5.3", lambda e: _found(FLOW, 1, ("aerial", "Flight Time"))(e) + _found(FLOW, -1, ("aerial", "Duty Factor"))(e)),
    Claim("Flow is not associated with spatiotemporal measures in all runs.", "§5.5.3", _absent(FLOW, SPATIOTEMPORAL, ("all",))),
    Claim("Flow is not associated with heart rate, speed, tibial and pelvic peaks, attenuation, stability and coordination variability.", "§5.5.3", _absent(FLOW, ["Heart Rate", "Speed", *LOWER_BODY_PEAKS, *ATTENUATION, *STABILITY, *COORDINATION])),
    Claim("Every measure has a significant correlation with affect within at least one run.", "§5.4.3", _some_run_is_significant),
    Claim("No measure has it, with one sign, in the majority of all, aerial or terrestrial runs.", "§5.4.3", _no_majority),
    Claim("Many of them are confounded with time (most are not significant once time is held constant).", "§5.4.3", _time_confounds),
    Claim("Reporting affect during the run may have changed enjoyment and flow.", "§5.5.5", _nothing),
)  # fmt: skip


def claims_table(evidence: Evidence) -> pd.DataFrame:
    """Judge every claim.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    DataFrame
        ``claim``, ``section``, ``holds`` (parts of the claim that hold), ``reproduced`` (``yes``,
        ``partly``, ``no``, ``not testable``).
    """
    rows = []
    for claim in CLAIMS:
        parts = claim.parts(evidence)
        held = sum(parts)
        verdict = "yes" if held == len(parts) else "partly" if held else "no"
        holds = f"{held} of {len(parts)}"
        if not parts:
            holds, verdict = "", "not testable"
        rows.append((claim.text, claim.section, holds, verdict))
    return pd.DataFrame(rows, columns=["claim", "section", "holds", "reproduced"])
