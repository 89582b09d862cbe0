"""Counts on the way to the analysis add up."""

import pandas as pd

from swaystride.studies.experience.flow import named_findings, study_flow

RUNS = pd.DataFrame({"run": ["A_1", "A_2", "B_1", "C_1"]})


def measured(*runs, head=(), heart=()):
    return pd.DataFrame(
        {
            "run": list(runs),
            "n_strides": 1000,
            "n_rejected": 10,
            "heart_rate_bpm": [float("nan") if run in heart else 150.0 for run in runs],
            "peak_head_g": [float("nan") if run in head else 2.0 for run in runs],
        }
    )


def exclusions(*rows):
    return pd.DataFrame(rows, columns=["run", "reason"])


def scores(*counts):
    return pd.DataFrame({"run": RUNS["run"], "n_ratings": list(counts)})


def test_every_excluded_run_has_a_reason():
    left_out = exclusions(("B_1", "sensor missing"), ("B_1", "again"))
    people, runs, strides, heart, head, rated = study_flow(
        RUNS,
        left_out,
        measured("A_1", "A_2", head=["A_2"], heart=["A_1", "A_2"]),
        scores(5, 0, 3, 3),
    )
    assert (people["recorded"], people["analysed"]) == (3, 1)
    assert (runs["recorded"], runs["analysed"]) == (4, 2)
    assert runs["excluded"] == [
        {"reason": "sensor missing", "count": 1},
        {"reason": "no stride after the warm-up", "count": 1},
    ]
    assert (strides["recorded"], strides["analysed"]) == (2020, 2000)
    assert (heart["recorded"], heart["analysed"]) == (2, 0)
    assert (head["recorded"], head["analysed"]) == (2, 1)
    assert rated["excluded"] == [{"reason": "no rating", "count": 1}]


def test_a_sound_cohort_loses_nothing():
    lines = study_flow(RUNS, exclusions(), measured(*RUNS["run"]), scores(5, 5, 5, 5))
    assert [line["analysed"] for line in lines] == [3, 4, 4000, 4, 4, 4]
    assert [line["excluded"] for line in lines if line["unit"] != "strides"] == [[]] * 5


def test_a_run_whose_strides_were_all_rejected_is_not_analysed():
    table = measured("A_1", "A_2", "B_1", "C_1")
    table.loc[3, "n_strides"] = 0
    _, runs, *_ = study_flow(RUNS, exclusions(), table, scores(5, 5, 5, 5))
    assert runs["excluded"] == [{"reason": "no stride after the warm-up", "count": 1}]


def test_findings_are_listed_once_and_named():
    rows = pd.DataFrame({"run": ["A_1", "A_1", "B_1"], "file": ["", "", "b.h5"]})
    assert named_findings(rows)["file"].tolist() == ["run A_1", "b.h5"]
