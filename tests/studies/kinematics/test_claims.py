"""Claims of the chapter hold on results that support them and fail on results that do not."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.studies.kinematics.claims import CLAIMS, Evidence, claims_table
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.tables import OPTIC_EXPECTATIONS

OPTIONS = TableOptions(0.05, 2.0, 30.0, 1.0, 10, 5.0)
#: Claims that the print itself breaks: Table 4.3 (knee 8.1° etc.), Tables 4.5 and 4.6 ("generally").
BROKEN_BY_THE_PRINT = {
    "RMSD of ranges of motion in the sagittal plane is below 5°.",
    "RMSD of peaks and of the angle at contact is below 4.5°.",
}


def printed(number):
    return pd.read_csv(REPOSITORY / "data" / "published" / f"table_4_{number}.csv")


@pytest.fixture
def evidence():
    """The printed tables, and the course, shifts and planar angles that the text reports."""
    lengths = printed(7)
    lengths["bias_m_mean"] = np.where(
        lengths["measure"] == "stride_length", -lengths["md_m_mean"], lengths["md_m_mean"]
    )
    poor = ("ankle_inversion", "knee_rotation", "ankle_rotation")
    shifts = pd.DataFrame({"angle": list(OPTIC_EXPECTATIONS)})
    moved = shifts["angle"].isin((*poor, "knee_adduction"))
    shifts["largest_offset_deg"] = np.where(moved, 5.0, 1.0)
    shifts["largest_shape_deg"] = np.where(shifts["angle"].isin(poor), 2.0, 0.2)
    rows = [
        (participant, "01", side, angle, 1.0, -200.0, 8.0)
        for participant in ("A", "B")
        for side in SIDES
        for angle in ANGLE_NAMES
    ]
    columns = (
        "participant trial side angle drift_erkf_deg drift_integrated_deg strides_to_convergence"
    )
    planar = pd.DataFrame({"trio": ["right_thigh", "left_shank"], "mean_deg": [13.5, 11.6]})
    return Evidence(
        {f"table_4_{n}": printed(n) for n in (3, 4, 5, 6)}
        | {"table_4_7": lengths, "table_4_8": shifts},
        pd.DataFrame(rows, columns=columns.split()),
        planar,
        1501,
        OPTIONS,
    )


def verdicts(evidence):
    return claims_table(evidence).set_index("claim")["reproduced"]


def test_the_print_supports_its_own_claims(evidence):
    found = verdicts(evidence)
    assert len(found) == len(CLAIMS)
    assert set(found[found != "yes"].index) == BROKEN_BY_THE_PRINT
    assert (found[list(BROKEN_BY_THE_PRINT)] == "partly").all()


def changed(evidence, table, **columns):
    frame = evidence.tables[table].assign(**columns)
    return replace(evidence, tables={**evidence.tables, table: frame})


@pytest.mark.parametrize(
    ("table", "columns", "claim"),
    [
        ("table_4_3", {"r2_mean": 0.94}, "R² of hip, knee and ankle flexion is at least .95."),
        (
            "table_4_3",
            {"rmsd_deg_mean": 9.0},
            "RMSD of hip, knee and ankle flexion is at most 7.7°.",
        ),
        ("table_4_7", {"bias_m_mean": 0.1}, "The filter shortens strides."),
        (
            "table_4_7",
            {"rrmsd_pct_mean": 1.0},
            "Their error is 8.5 % (within twice the printed SD).",
        ),
        ("table_4_7", {"rmsd_m_mean": 0.01}, "Stride width is poor: the RMSD exceeds the width."),
        (
            "table_4_4",
            {"significant": 0},
            "Ranges of motion that markers measure badly differ significantly from those of the filter.",
        ),
        (
            "table_4_4",
            {"erkf_deg_mean": 90.0},
            "Where markers are poor, the filter's range is nearer to the published one than theirs.",
        ),
        (
            "table_4_8",
            {"largest_offset_deg": 1.0},
            "Shifted joint centres move knee ab/adduction, knee and ankle rotation and ankle inversion most.",
        ),
    ],
)
def test_a_claim_fails_where_the_results_contradict_it(evidence, table, columns, claim):
    assert verdicts(changed(evidence, table, **columns))[claim] == "no"


def test_course_claims_fail_with_drift_and_late_convergence(evidence):
    drifting = evidence.course.assign(drift_erkf_deg=-300.0, strides_to_convergence=11.0)
    found = verdicts(replace(evidence, course=drifting))
    assert found.iloc[:3].tolist() == ["no", "no", "no"]


def test_a_value_that_is_missing_does_not_hold(evidence):
    claim = "Errors of the start are overcome within ten strides, in all trials."
    for unknown in (np.nan, np.inf):
        missing = evidence.course.assign(strides_to_convergence=unknown)
        assert verdicts(replace(evidence, course=missing))[claim] == "no"
        missing = evidence.course.copy()
        missing.loc[0, "strides_to_convergence"] = unknown
        assert verdicts(replace(evidence, course=missing))[claim] == "partly"


def test_one_more_significant_range_breaks_six_of_seven(evidence):
    table = evidence.tables["table_4_4"].copy()
    table.loc[:1, "significant"] = 1
    own = replace(evidence, tables={**evidence.tables, "table_4_4": table})
    text = (
        "All six of the former and at most one of the latter are significant (print: six of seven)."
    )
    assert verdicts(own)[text] == "partly"
    assert verdicts(own)["The others do not, but for left knee ab/adduction."] == "partly"


def test_few_strides_and_collinear_markers_are_seen(evidence):
    planar = evidence.planar.assign(mean_deg=3.0)
    found = verdicts(replace(evidence, n_strides=1500, planar=planar))
    assert found.iloc[-1] == "no"
    assert found.iloc[-2] == "no"
