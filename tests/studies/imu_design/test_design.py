"""The lab's two tables: what is named, what is refused, what is only reported."""

import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.studies.imu_design.design import design_findings, read_design, usable_trials
from swaystride.studies.imu_design.flow import study_flow


def test_recordings_are_named_by_trial_foot_and_imu(folder):
    trials = read_design(folder).trials
    assert trials["recording"].tolist()[:5] == [
        "trial_01_left_imu_1",
        "trial_01_left_imu_2",
        "trial_01_right_imu_1",
        "trial_01_right_imu_2",
        "trial_02_left_imu_1",
    ]
    assert trials["trial"].tolist()[0] == "01"


def test_a_missing_foot_and_a_missing_imu_are_findings(folder):
    found = design_findings(read_design(folder))
    rows = found[["participant", "trial", "check", "place", "found"]].values.tolist()
    assert rows == [
        ["A", "02", "missing_imu", "trial 02, left foot", "no imu_2"],
        ["A", "02", "missing_foot", "trial 02, right foot", "the other foot alone"],
        ["B", "01", "missing_foot", "trial 01, left foot", "the other foot alone"],
    ]
    assert (found["severity"] == "warning").all()


def test_only_imported_recordings_are_used(folder):
    trials = read_design(folder).trials
    own = trials[trials["participant"] == "A"]
    assert usable_trials(own, ["trial_01_right_imu_2"])["file"].tolist() == ["A/1_right_2.csv"]


def test_the_flow_adds_up(folder):
    design = read_design(folder)
    exclusions = pd.DataFrame(
        {"participant": ["A"], "trial": ["02"], "foot": ["left"], "imu": ["imu_2"],
         "reason": ["strap came off"]}
    )  # fmt: skip
    kept = design.trials[design.trials["exclude"] == ""]
    measured = kept[["participant", "trial", "foot", "imu"]].assign(reason="")
    measured.loc[measured["trial"] == "02", "reason"] = "no rest at the end"
    flow = {row["unit"]: row for row in study_flow(design, exclusions, measured)}
    assert flow["participants"]["analysed"] == 2
    assert (flow["trials"]["recorded"], flow["trials"]["analysed"]) == (3, 2)
    assert flow["trials"]["excluded"] == [{"reason": "no usable recording", "count": 1}]
    assert flow["recordings"]["planned"] == 12
    assert (flow["recordings"]["recorded"], flow["recordings"]["analysed"]) == (8, 6)
    assert flow["recordings"]["excluded"] == [
        {"reason": "no rest at the end", "count": 1},
        {"reason": "strap came off", "count": 1},
    ]


@pytest.mark.parametrize(
    ("file", "old", "new", "line"),
    [
        ("trials", "B\t01\tright\timu_1", "C\t01\tright\timu_1",
         "trials.tsv: line 8, column participant: participant is not in participants.tsv; found 'C'"),
        ("participants", "B\tM\t30\t1.81\t80\n", "B\tM\t30\t1.81\t80\nC\tF\t30\t1.81\t80\n",
         "participants.tsv: participant has no trials; found C"),
        ("participants", "1.62", "162",
         "participants.tsv: line 2, column height_m: cell does not fit its column; "
         "expected a number ≥ 0.5 ≤ 2.5; found '162'"),
        ("trials", "right\timu_1\tA/1", "both\timu_1\tA/1",
         "trials.tsv: line 4, column foot: cell does not fit its column; "
         "expected one of left, right; found 'both'"),
        ("trials", "imu_2\tA/1_left_2", "imu_3\tA/1_left_2",
         "trials.tsv: line 3, column imu: cell does not fit its column; "
         "expected one of imu_1, imu_2; found 'imu_3'"),
        ("trials", "A/1_right_1.csv\t100", "A/1_right_1.csv\t99",
         "trials.tsv: participant A, trial 01: one trial has two distances; "
         "expected the same distance_m for both feet and both IMUs; found 100, 99"),
        ("trials", "A/1_right_1.csv\t100", "A/1_right_1.csv\t",
         "trials.tsv: line 4, column distance_m: cell is empty; expected a number"),
        ("trials", "A/1_right_1.csv", "A/1_left_1.csv",
         "trials.tsv: lines 2, 4: two recordings name the same file; found A/1_left_1.csv"),
        ("trials", "A\t01\tright\timu_1", "A\t01\tleft\timu_1",
         "trials.tsv: line 4: row stands twice; found participant A, trial 01, foot left, imu imu_1"),
        ("trials", "distance_m", "distance",
         "trials.tsv: line 1: column 'distance_m' is missing"),
    ],
)  # fmt: skip
def test_wrong_tables_are_refused_with_their_place(folder, file, old, new, line):
    path = folder / f"{file}.tsv"
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(DesignError) as error:
        read_design(folder)
    assert line in str(error.value)


def test_a_recording_that_is_excluded_may_share_a_file(folder):
    path = folder / "trials.tsv"
    text = path.read_text(encoding="utf-8").replace("A/2_left_2.csv", "A/2_left_1.csv")
    path.write_text(text, encoding="utf-8")
    assert len(read_design(folder).trials) == 8
