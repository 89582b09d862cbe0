"""The lab's four tables: what is derived from them, what is refused, what is only reported."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.intensity.design import difficulty_codes, read_design
from swaystride.studies.intensity.flow import study_flow
from swaystride.studies.intensity.observations import (
    analysed_ratings,
    analysed_sway,
    expected_ratings,
    rating_findings,
)

PARTICIPANTS = """participant\tgroup\tage_years\tsex\theight_m\tmass_kg
A\tolder_adult\t71.5\tM\t1.80\t81
B\tvestibular\t48\tF\t1.60\t60
"""
RATERS = """rater\texperience_years
R1\t12
R2\t3
R3\t30
"""
TRIALS = """participant\texercise\texercise_order\ttrial\tsurface\tstance\tvision\thead\tfile
A\tfoam-tandem\t1\t1\tfoam\ttandem\teyes_open\tyaw\tA/1_1.txt
A\tfoam-tandem\t1\t2\tfoam\ttandem\teyes_open\tyaw\tA/1_2.txt
A\tfoam-tandem\t1\t3\tfoam\ttandem\teyes_open\tyaw\tA/1_3.txt
A\tfirm-apart\t2\t1\tfirm\tfeet_apart\teyes_closed\tnone\tA/2_1.txt
A\tfirm-apart\t2\t2\tfirm\tfeet_apart\teyes_closed\tnone\tA/2_2.txt
A\tfirm-apart\t2\t3\tfirm\tfeet_apart\teyes_closed\tnone\tA/2_3.txt
B\tfirm-apart\t1\t1\tfirm\tfeet_apart\teyes_closed\tnone\tB/1_1.txt
B\tfirm-apart\t1\t2\tfirm\tfeet_apart\teyes_closed\tnone\tB/1_2.txt
"""
RATINGS = """participant\texercise\ttrial\trater\trating
A\tfoam-tandem\t1\tR1\t4
A\tfoam-tandem\t1\tself\t2
A\tfoam-tandem\t1\tR2\t5
A\tfoam-tandem\t2\tR1\t
A\tfoam-tandem\t2\tself\t3
A\tfoam-tandem\t\tR1\t4
A\tfoam-tandem\t\tself\t1
A\tfirm-apart\t3\tR2\t1
B\tfirm-apart\t1\tR1\t2
B\tfirm-apart\t1\tself\t
"""

# What the analysis sees of these, written by hand.
ANALYSED = """
A foam-tandem 1 per_trial    R1 4 2 2 4 1 2
A foam-tandem 1 per_trial    R2 5 2 2 4 1 2
A foam-tandem . per_exercise R1 4 1 2 4 1 2
A firm-apart  3 per_trial    R2 1 . 1 1 2 1
B firm-apart  1 per_trial    R1 2 . 1 1 2 1
"""


@pytest.fixture
def folder(tmp_path):
    for name, text in (
        ("participants", PARTICIPANTS),
        ("raters", RATERS),
        ("trials", TRIALS),
        ("ratings", RATINGS),
    ):
        (tmp_path / f"{name}.tsv").write_text(text, encoding="utf-8")
    return tmp_path


def test_the_analysed_ratings_agree_with_a_table_written_by_hand(folder):
    found = analysed_ratings(read_design(folder))
    expected = [line.split() for line in ANALYSED.strip().splitlines()]
    assert len(found) == len(expected)
    for row, wanted in zip(found.to_dict("records"), expected, strict=True):
        texts = [row[name] for name in ("participant", "exercise", "rating_level", "rater")]
        assert texts == [wanted[0], wanted[1], wanted[3], wanted[4]]
        numbers = [row["trial"], *list(row.values())[5:]]
        for number, text in zip(numbers, [wanted[2], *wanted[5:]], strict=True):
            assert (pd.isna(number) and text == ".") or number == float(text)
    assert list(found)[5:] == [
        "rating", "self_rating", "surface", "stance", "visual_input", "head_movements",
    ]  # fmt: skip


def test_every_level_of_difficulty_has_its_code():
    stances = ["feet_apart", "feet_together", "partial_tandem", "tandem", "single_leg"]
    heads = ["none", "pitch", "yaw", "none", "none"]
    table = pd.DataFrame(
        {
            "exercise": list("abcde"),
            "surface": ["firm", "foam", "firm", "foam", "firm"],
            "stance": stances,
            "vision": ["eyes_open", "eyes_closed"] * 2 + ["eyes_open"],
            "head": heads,
        }
    )
    codes = difficulty_codes(table)
    assert codes["surface"].tolist() == [1, 2, 1, 2, 1]
    assert codes["stance"].tolist() == [1, 2, 3, 4, 5]
    assert codes["visual_input"].tolist() == [1, 2, 1, 2, 1]
    assert codes["head_movements"].tolist() == [1, 2, 2, 1, 1]


def test_recordings_are_named_by_order_and_trial(folder):
    trials = read_design(folder).trials
    assert trials["recording"].tolist()[2:5] == [
        "exercise_01_trial_3",
        "exercise_02_trial_1",
        "exercise_02_trial_2",
    ]


def test_sway_is_joined_by_the_name_of_the_recording(folder, plan):
    design = read_design(folder)
    features = dict.fromkeys(
        ("phi_rms", "ap_rms", "ml_rms", "phi_mv", "ap_mv", "ml_mv", "path_length"), 1.0
    )
    measures = pd.DataFrame(
        {
            "participant": ["A", "B"],
            "trial": ["exercise_02_trial_3", "exercise_01_trial_2"],
            "duration_s": [30.0, 12.0],
            **features,
            "ellipse_area": [2.0, 3.0],
            "ellipse_area_prediction": [4.0, 5.0],
        }
    )
    sway = analysed_sway(design, measures, plan)
    assert sway[["participant", "exercise", "trial"]].values.tolist() == [
        ["A", "firm-apart", 3],
        ["B", "firm-apart", 2],
    ]
    assert sway["ellipse_area"].tolist() == [2.0, 3.0]


def spoil(folder, file, old, new):
    path = folder / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "old", "new", "line"),
    [
        (
            "ratings.tsv", "R2\t5\n", "R2\t6\n",
            "ratings.tsv: line 4, column rating: cell does not fit its column; "
            "expected an integer ≥ 1 ≤ 5; found '6'",
        ),
        (
            "ratings.tsv", "R2\t5\n", "R2\t4.5\n",
            "ratings.tsv: line 4, column rating: cell does not fit its column; "
            "expected an integer ≥ 1 ≤ 5; found '4.5'",
        ),
        (
            "ratings.tsv", "1\tR2\t5", "1\tR1\t5",
            "ratings.tsv: line 4: row stands twice; "
            "found participant A, exercise foam-tandem, trial 1, rater R1",
        ),
        (
            "ratings.tsv", "\tself\t1\n", "\tR1\t1\n",
            "ratings.tsv: line 8: row stands twice; "
            "found participant A, exercise foam-tandem, trial , rater R1",
        ),
        (
            "ratings.tsv", "1\tR2\t5", "1\tR9\t5",
            "ratings.tsv: line 4, column rater: rater is not in raters.tsv; found 'R9'",
        ),
        (
            "ratings.tsv", "A\tfirm-apart\t3", "B\tfirm-apart\t3",
            "ratings.tsv: line 9: rating of a trial that is not in trials.tsv; "
            "found B, firm-apart, 3",
        ),
        (
            "ratings.tsv", "A\tfoam-tandem\t\tR1", "B\tfoam-tandem\t\tR1",
            "ratings.tsv: line 7: rating of an exercise that is not in trials.tsv; "
            "found B, foam-tandem",
        ),
        (
            "raters.tsv", "R3\t30", "self\t30",
            "raters.tsv: a therapist cannot be called self; expected self only in ratings.tsv",
        ),
        (
            "trials.tsv", "A\tfirm-apart\t2\t3\tfirm\tfeet_apart", "A\tfirm-apart\t2\t3\tfoam\tfeet_apart",
            "trials.tsv: exercise firm-apart: exercise stands for two combinations; expected one "
            "combination of surface, stance, vision and head everywhere; found "
            "firm feet_apart eyes_closed none; foam feet_apart eyes_closed none",
        ),
        (
            "trials.tsv", "A\tfirm-apart\t2\t3", "A\tfirm-apart\t3\t3",
            "trials.tsv: participant A, exercise firm-apart: "
            "exercises and their order do not match one to one",
        ),
        (
            "trials.tsv", "A/2_3.txt", "A/2_2.txt",
            "trials.tsv: lines 6, 7: two trials name the same file; found A/2_2.txt",
        ),
        (
            "trials.tsv", "B\tfirm-apart\t1\t1", "C\tfirm-apart\t1\t1",
            "trials.tsv: line 8, column participant: participant is not in participants.tsv; "
            "found 'C'",
        ),
        (
            "trials.tsv", "\t2\t3\tfirm", "\t2\t4\tfirm",
            "trials.tsv: line 7, column trial: cell does not fit its column; "
            "expected an integer ≥ 1 ≤ 3; found '4'",
        ),
        (
            "participants.tsv", "B\tvestibular", "B\thealthy",
            "participants.tsv: line 3, column group: cell does not fit its column; "
            "expected one of older_adult, vestibular; found 'healthy'",
        ),
    ],
)  # fmt: skip
def test_a_wrong_table_is_one_line_with_file_and_place(folder, file, old, new, line):
    spoil(folder, file, old, new)
    with pytest.raises(DesignError) as caught:
        read_design(folder)
    assert str(caught.value) == f"{folder}/{line}"


def test_wide_ratings_are_recognised_and_the_way_out_is_named(folder):
    wide = "participant\texercise\ttrial\tR1\tR2\tself\nA\tfoam-tandem\t1\t4\t5\t2\n"
    (folder / "ratings.tsv").write_text(wide, encoding="utf-8")
    with pytest.raises(DesignError) as caught:
        read_design(folder)
    assert str(caught.value) == (
        f"{folder}/ratings.tsv: line 1: ratings are in wide form; expected one row per rating: "
        "participant, exercise, trial, rater, rating (pandas: table.melt(id_vars=['participant', "
        "'exercise', 'trial'], var_name='rater', value_name='rating')); "
        "found columns that are raters: R1, R2, self"
    )


def test_the_way_out_of_wide_ratings_works(folder):
    long = pd.read_csv(folder / "ratings.tsv", sep="\t", dtype=str, keep_default_na=False)
    key = ["participant", "exercise", "trial"]
    wide = long.set_index([*key, "rater"])["rating"].unstack(fill_value="").reset_index()  # noqa: PD010
    melted = wide.melt(id_vars=key, var_name="rater", value_name="rating")
    before = analysed_ratings(read_design(folder))
    melted.to_csv(folder / "ratings.tsv", sep="\t", index=False)
    after = analysed_ratings(read_design(folder))
    order = ["participant", "exercise", "trial", "rater"]
    pd.testing.assert_frame_equal(
        after.sort_values(order, ignore_index=True), before.sort_values(order, ignore_index=True)
    )


def test_a_single_rater_is_an_error(folder):
    text = (folder / "ratings.tsv").read_text(encoding="utf-8")
    kept = [line for line in text.splitlines() if "\tR2\t" not in line]
    (folder / "ratings.tsv").write_text("\n".join(kept) + "\n", encoding="utf-8")
    with pytest.raises(DesignError) as caught:
        read_design(folder)
    assert str(caught.value) == (
        f"{folder}/ratings.tsv: no two therapists rated: raters and patients cannot be told apart; "
        "expected ratings by two therapists or more; found R1"
    )


def test_what_is_incomplete_is_a_finding(folder):
    findings = rating_findings(read_design(folder))
    assert list(findings) == ["participant", "trial", *FINDING_COLUMNS]
    assert set(findings["severity"]) == {"warning"}
    rows = findings[["participant", "check", "file", "place", "found"]].values.tolist()
    assert rows[:3] == [
        ["", "rater_without_ratings", "raters.tsv", "rater R3", "none"],
        ["B", "few_raters", "ratings.tsv", "", "one: no comparison between raters"],
        ["B", "missing_trial", "trials.tsv", "exercise firm-apart", "1, 2"],
    ]
    missing = {(row[0], row[1], row[3]): row[4] for row in rows[3:]}
    assert missing == {
        ("A", "missing_rating", "rater R1"): "2; missing: foam-tandem trial 2, "
        "foam-tandem trial 3, firm-apart trial 1, …",
        ("A", "missing_rating", "rater R2"): "2; missing: foam-tandem trial 2, "
        "foam-tandem trial 3, firm-apart trial 1, …",
        ("B", "missing_rating", "rater R1"): "1; missing: firm-apart trial 2, firm-apart",
        ("A", "missing_self_rating", "rater self"): "3; missing: foam-tandem trial 3, "
        "firm-apart trial 1, firm-apart trial 2, …",
        ("B", "missing_self_rating", "rater self"): "0; missing: firm-apart trial 1, "
        "firm-apart trial 2, firm-apart",
    }


def test_a_complete_cohort_has_no_findings(tmp_path, make_cohort, write_tables):
    write_tables(tmp_path, make_cohort(1, raters_per_patient=4))
    assert rating_findings(read_design(tmp_path)).empty


def test_the_flow_adds_up(folder):
    exclusions = pd.DataFrame(
        {"participant": ["A"], "trial": ["exercise_01_trial_2"], "reason": ["gap"]}
    )
    flow = {line["unit"]: line for line in study_flow(read_design(folder), exclusions)}
    assert flow["participants"]["analysed"] == 2
    assert flow["therapists"]["excluded"] == [{"reason": "rated nobody", "count": 1}]
    assert (flow["trials"]["planned"], flow["trials"]["recorded"]) == (9, 8)
    assert flow["trials"]["excluded"] == [{"reason": "gap", "count": 1}]
    counts = {
        name: [flow[name]["planned"], flow[name]["recorded"], flow[name]["analysed"]]
        for name in list(flow)[3:]
    }
    assert counts == {
        "ratings of trials": [14, 5, 4],
        "ratings of exercises": [5, 1, 1],
        "self-ratings of trials": [8, 3, 2],
        "self-ratings of exercises": [3, 1, 1],
    }
    for line in flow.values():
        lost = sum(reason["count"] for reason in line["excluded"])
        assert line["analysed"] == line["recorded"] - lost


def test_expected_ratings_hold_every_rating_once(design):
    expected = expected_ratings(design)
    assert (expected["status"] == "given").all()
    assert len(expected) == len(design.ratings)
    np.testing.assert_array_equal(
        expected["rating"].value_counts().sort_index(),
        design.ratings["rating"].value_counts().sort_index(),
    )
