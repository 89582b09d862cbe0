"""What the chapter states, and what this cohort shows (dissertation §4.4-4.6)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import pandas as pd

from swaystride.studies.kinematics.plan import POOR_OPTICAL_ANGLES, SAGITTAL_ANGLES
from swaystride.studies.kinematics.summaries import TRIAL_KEYS
from swaystride.studies.kinematics.table_options import TableOptions

#: Printed error of the stride length, percent: mean and SD over trials (Table 4.7).
PRINTED_LENGTH_ERROR_PCT: Final = (8.5, 1.1)
#: Share of the RMSD that "in large part" is taken to mean.
LARGE_PART: Final = 0.8
#: Planar angles of thigh and shank in the literature that the chapter cites (§4.5.1), degrees.
LITERATURE_PLANAR_DEG: Final = {"thigh": (10.0, 30.0), "shank": (7.0, 21.0)}


@dataclass(frozen=True, eq=False)
class Evidence:
    """Results of one cohort, as the claims ask for them.

    Parameters
    ----------
    tables : mapping of str to DataFrame
        ``table_4_3`` to ``table_4_8``, by name.
    course : DataFrame
        Drift and convergence by trial, side and angle.
    planar : DataFrame
        Planar angles by trial and trio.
    n_strides : int
        Counted strides of both feet.
    options : TableOptions
    """

    tables: dict[str, pd.DataFrame]
    course: pd.DataFrame
    planar: pd.DataFrame
    n_strides: int
    options: TableOptions

    def rows(self, table: str, angles: Sequence[str]) -> pd.DataFrame:
        """Rows of some angles, both sides."""
        frame = self.tables[table]
        return frame[frame["angle"].isin(angles)]


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
        From the evidence to whether each part holds.
    """

    text: str
    section: str
    parts: Callable[[Evidence], list[bool]]


def _each(values: pd.Series, limit: float, *, above: bool = False) -> list[bool]:
    """Whether each value is within a limit, its end included; a missing value is not."""
    return [bool(value >= limit if above else value <= limit) for value in values]


def _drift_is_arrested(e: Evidence) -> list[bool]:
    size = e.course["drift_erkf_deg"].abs()
    means = size.groupby([e.course["side"], e.course["angle"]], sort=False).mean()
    return _each(means, e.options.arrested_drift_deg)


def _integration_drifts_more(e: Evidence) -> list[bool]:
    sizes = e.course[["drift_erkf_deg", "drift_integrated_deg"]].abs()
    means = sizes.groupby([e.course["side"], e.course["angle"]], sort=False).mean()
    return [bool(raw > own) for own, raw in means.itertuples(index=False)]


def _converges(e: Evidence) -> list[bool]:
    """Every angle of both sides; a trial in which one cannot be judged does not hold."""
    trials = e.course.groupby(list(TRIAL_KEYS), sort=False)["strides_to_convergence"]
    return _each(trials.agg(lambda own: own.max(skipna=False)), e.options.convergence_strides)


def _at_least(table: str, column: str, limit: float) -> Callable[[Evidence], list[bool]]:
    return lambda e: _each(e.rows(table, SAGITTAL_ANGLES)[column], limit, above=True)


def _at_most(table: str, column: str, limit: float) -> Callable[[Evidence], list[bool]]:
    return lambda e: _each(e.rows(table, SAGITTAL_ANGLES)[column], limit)


def _all_at_most(table: str, column: str, limit: float) -> Callable[[Evidence], list[bool]]:
    return lambda e: _each(e.tables[table][column], limit)


def _without_offset(e: Evidence) -> list[bool]:
    rows = e.rows("table_4_3", SAGITTAL_ANGLES)
    degrees = _each(rows["rmsd_no_offset_deg_mean"], 1.5)
    return degrees + _each(rows["nrmsd_no_offset_pct_mean"], 3.2)


def _other_planes_fit_worse(e: Evidence) -> list[bool]:
    """Lower R² than any sagittal angle, for all; Table 4.8 decides nothing here."""
    lowest = e.rows("table_4_3", SAGITTAL_ANGLES)["r2_mean"].min()
    others = e.rows("table_4_3", ("hip_adduction", "knee_adduction", "hip_rotation"))
    return [bool(r2 < lowest) for r2 in others["r2_mean"]]


def _other_planes_differ_less(e: Evidence) -> list[bool]:
    """Hip ab/adduction as it is, the other two without offset (Table 4.8), below the sagittal mean."""
    limit = e.rows("table_4_3", SAGITTAL_ANGLES)["rmsd_deg_mean"].mean()
    hip = e.rows("table_4_3", ("hip_adduction",))["rmsd_deg_mean"]
    rest = e.rows("table_4_3", ("knee_adduction", "hip_rotation"))["rmsd_no_offset_deg_mean"]
    return _each(hip, limit) + _each(rest, limit)


def _poor_ranges_differ(e: Evidence) -> list[bool]:
    table = e.tables["table_4_4"]
    return [bool(s) for s in table.loc[table["optic_poor"] == 1, "significant"]]


def _good_ranges_agree(e: Evidence) -> list[bool]:
    table = e.tables["table_4_4"]
    good = table[table["optic_poor"] == 0]
    exception = (good["angle"] == "knee_adduction") & (good["side"] == "left")
    return [bool(row != 1) for row in good.loc[~exception, "significant"]]


def _six_of_seven(e: Evidence) -> list[bool]:
    table = e.tables["table_4_4"]
    significant = table[table["significant"] == 1]
    poor = int((significant["optic_poor"] == 1).sum())
    return [poor == 2 * len(POOR_OPTICAL_ANGLES), len(significant) - poor <= 1]


def _filter_is_nearer(e: Evidence) -> list[bool]:
    table = e.tables["table_4_4"]
    poor = table[table["optic_poor"] == 1]
    reference = poor["reference_deg_mean"]
    own = (poor["erkf_deg_mean"] - reference).abs()
    optic = (poor["optic_deg_mean"] - reference).abs()
    return [bool(nearer) for nearer in own < optic]


def _lengths(e: Evidence) -> pd.DataFrame:
    table = e.tables["table_4_7"]
    return table[table["measure"] == "stride_length"]


def _strides_are_short(e: Evidence) -> list[bool]:
    return [bool(bias < 0) for bias in _lengths(e)["bias_m_mean"]]


def _length_error_as_printed(e: Evidence) -> list[bool]:
    mean, sd = PRINTED_LENGTH_ERROR_PCT
    return [bool(abs(x - mean) <= 2.0 * sd) for x in _lengths(e)["rrmsd_pct_mean"]]


def _length_error_is_offset(e: Evidence) -> list[bool]:
    rows = _lengths(e)
    shares = rows["bias_m_mean"].abs() / rows["rmsd_m_mean"]
    return _each(shares, LARGE_PART, above=True)


def _widths_are_poor(e: Evidence) -> list[bool]:
    table = e.tables["table_4_7"]
    rows = table[table["measure"] == "stride_width"]
    return [bool(x) for x in rows["rmsd_m_mean"] > rows["optic_m_mean"]]


def _shifts_move(e: Evidence) -> list[bool]:
    """More than they move any sagittal angle."""
    offsets = e.tables["table_4_8"].set_index("angle")["largest_offset_deg"]
    limit = offsets[list(SAGITTAL_ANGLES)].max()
    return [bool(offsets[name] > limit) for name in ("knee_adduction", *POOR_OPTICAL_ANGLES)]


def _shifts_reshape(e: Evidence) -> list[bool]:
    """More than they reshape hip rotation and knee ab/adduction."""
    shapes = e.tables["table_4_8"].set_index("angle")["largest_shape_deg"]
    limit = shapes[["hip_rotation", "knee_adduction"]].max()
    return [bool(shapes[name] > limit) for name in POOR_OPTICAL_ANGLES]


def _nearly_collinear(e: Evidence) -> list[bool]:
    parts = []
    for segment, (low, high) in LITERATURE_PLANAR_DEG.items():
        own = e.planar[e.planar["trio"].str.endswith(f"_{segment}")]["mean_deg"]
        if len(own):
            parts.append(bool(low <= own.mean() <= high))
    return parts


CLAIMS: Final[Sequence[Claim]] = (
    Claim("The filter arrests the drift of every angle (mean size over trials within the limit of the configuration).", "§4.4.2", _drift_is_arrested),
    Claim("Integration of the gyroscopes drifts further than the filter.", "§4.4.2, Figure 4.9", _integration_drifts_more),
    Claim("Errors of the start are overcome within ten strides, in all trials.", "§4.4.2, Figure 4.10", _converges),
    Claim("R² of hip, knee and ankle flexion is at least .95.", "§4.5.2.1", _at_least("table_4_3", "r2_mean", 0.95)),
    Claim("RMSD of hip, knee and ankle flexion is at most 7.7°.", "§4.5.2.1", _at_most("table_4_3", "rmsd_deg_mean", 7.7)),
    Claim("Without the offset it is at most 1.5° and 3.2 % (ensemble of the difference removed).", "§4.5.2.1", _without_offset),
    Claim("R² of the angles in the other planes is lower.", "§4.5.2.2", _other_planes_fit_worse),
    Claim("Their RMSD is smaller than the mean of the sagittal ones (knee ab/adduction and hip rotation without offset).", "§4.5.2.2", _other_planes_differ_less),
    Claim("Ranges of motion that markers measure badly differ significantly from those of the filter.", "§4.5.3, Figure 4.12", _poor_ranges_differ),
    Claim("The others do not, but for left knee ab/adduction.", "§4.5.3", _good_ranges_agree),
    Claim("All six of the former and at most one of the latter are significant (print: six of seven).", "Figure 4.12", _six_of_seven),
    Claim("Where markers are poor, the filter's range is nearer to the published one than theirs.", "§4.5.3", _filter_is_nearer),
    Claim("RMSD of ranges of motion is at most 7.7°.", "§4.5.3, Table 4.5", _all_at_most("table_4_5", "rom_rmsd_deg_mean", 7.7)),
    Claim("RMSD of ranges of motion in the sagittal plane is below 5°.", "§4.5.3, Table 4.5", _at_most("table_4_5", "rom_rmsd_deg_mean", 5.0)),
    Claim("RMSD of peaks and of the angle at contact is below 4.5°.", "§4.5.3, Table 4.6", _all_at_most("table_4_6", "rmsd_deg_mean", 4.5)),
    Claim("The filter shortens strides.", "Table 4.7", _strides_are_short),
    Claim("Their error is 8.5 % (within twice the printed SD).", "Table 4.7", _length_error_as_printed),
    Claim("It is in large part an offset (at least four fifths of the RMSD).", "§4.5.3", _length_error_is_offset),
    Claim("Stride width is poor: the RMSD exceeds the width.", "§4.5.3, Table 4.7", _widths_are_poor),
    Claim("Shifted joint centres move knee ab/adduction, knee and ankle rotation and ankle inversion most.", "§4.4.1, Figure 4.8", _shifts_move),
    Claim("They change the shape of knee and ankle rotation and ankle inversion, hardly that of hip rotation and knee ab/adduction.", "§4.5.1, Figure 4.8", _shifts_reshape),
    Claim("Planar angles of thigh and shank lie in the published range (10 to 30° and 7 to 21°).", "§4.5.1", _nearly_collinear),
    Claim("More than 1500 strides are analysed.", "§4.3.4", lambda e: [e.n_strides > 1500]),
)  # fmt: skip


def claims_table(evidence: Evidence) -> pd.DataFrame:
    """Judge every claim; one that no result concerns is left out.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    DataFrame
        ``claim``, ``section``, ``holds`` (parts of the claim that hold), ``reproduced`` (``yes``,
        ``partly``, ``no``).
    """
    rows = []
    for claim in CLAIMS:
        parts = claim.parts(evidence)
        if not parts:
            continue
        held = sum(parts)
        verdict = "yes" if held == len(parts) else "partly" if held else "no"
        rows.append((claim.text, claim.section, f"{held} of {len(parts)}", verdict))
    return pd.DataFrame(rows, columns=["claim", "section", "holds", "reproduced"])
