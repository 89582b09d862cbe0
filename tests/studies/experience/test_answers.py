"""Ratings and questionnaires as a lab keeps them: what is read, what is missing, what is wrong."""

import json

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.io.study_tables import write_study_table
from swaystride.studies.experience.answers import (
    AFFECT_TABLE,
    SCORE_TABLE,
    AnswerRules,
    AnswersError,
    RunChecks,
    known_until_s,
    read_answers,
    read_checks,
)
from swaystride.studies.experience.design import read_design

RULES = AnswerRules((-5, 5), (18, 126), (13, 97), "time_weighted")
EVENTS = ["start_s", "stop_s", "event", "sensor"]
NAMES = ["P01_01", "P01_02", "P02_01"]


class Lab:
    """Three runs of two people; every part can be spoilt before it is read."""

    def __init__(self, folder):
        self.folder = folder
        self.affect = {
            name: [(0, 1), (300, 2), (900, 3), (1500, 2)] for name in ("P01_01", "P01_02", "P02_01")
        }
        self.scores = [
            (*name.split("_"), which, score)
            for name in NAMES
            for which, score in (("paces", 97), ("fss", 71.5))
        ]
        self.files = {name: f"{name[:3]}/{name}_affect.tsv" for name in NAMES}
        self.exclude = dict.fromkeys(NAMES, "")
        nothing = pd.DataFrame(columns=EVENTS)
        self.checks = {name: RunChecks(False, 1800.0, nothing) for name in NAMES}

    def lose_ratings(self, name, start_s, stop_s=np.nan):
        events = pd.DataFrame([(start_s, stop_s, "data_loss", "ratings")], columns=EVENTS)
        self.checks[name] = RunChecks(False, 1800.0, events)

    def read(self):
        people = {"participant": ["P01", "P02"], "sex": "F", "age_years": 30, "height_m": 1.7}
        write_study_table(pd.DataFrame({**people, "mass_kg": 60}), self.folder / "participants.tsv")
        runs = pd.DataFrame([name.split("_") for name in NAMES], columns=["participant", "run"])
        runs["imu"] = [f"{name}.h5" for name in NAMES]
        runs["affect"] = [self.files[name] for name in NAMES]
        runs["exclude"] = [self.exclude[name] for name in NAMES]
        write_study_table(runs, self.folder / "runs.tsv")
        for name, rows in self.affect.items():
            path = self.folder / f"{name[:3]}/{name}_affect.tsv"
            path.parent.mkdir(exist_ok=True)
            write_study_table(pd.DataFrame(rows, columns=["time_s", "feeling_scale"]), path)
        columns = ["participant", "run", "questionnaire", "score"]
        write_study_table(
            pd.DataFrame(self.scores, columns=columns), self.folder / "questionnaires.tsv"
        )
        return read_answers(self.folder, read_design(self.folder), self.checks, RULES)

    def errors(self):
        with pytest.raises(AnswersError) as raised:
            self.read()
        lines = str(raised.value).splitlines()
        assert len(lines) == len(raised.value.errors)
        return lines


@pytest.fixture
def lab(tmp_path):
    return Lab(tmp_path)


def test_complete_answers_are_read_as_they_stand(lab):
    answers = lab.read()
    assert list(answers.affect) == list(AFFECT_TABLE)
    assert list(answers.scores) == list(SCORE_TABLE)
    assert len(answers.affect) == 12
    assert answers.affect.groupby("run")["feeling_scale"].sum().tolist() == [8.0] * 3
    assert answers.scores["run"].tolist() == NAMES
    assert answers.scores["participant"].tolist() == ["P01", "P01", "P02"]
    assert answers.scores["activity_enjoyment"].tolist() == [97.0] * 3
    assert answers.scores["flow"].tolist() == [71.5] * 3
    assert answers.scores["ratings_known_until_s"].tolist() == [1800.0] * 3
    assert answers.scores["n_ratings"].tolist() == [4] * 3
    assert answers.scores["reason"].tolist() == [""] * 3
    assert answers.findings.empty


def test_missing_answers_are_findings_and_empty_cells(lab):
    lab.files["P01_02"] = ""
    lab.scores = [row for row in lab.scores if row[:3] != ("P02", "01", "fss")]
    lab.scores[0] = (*lab.scores[0][:3], "")  # filled in by nobody
    answers = lab.read()
    scores = answers.scores.set_index("run")
    assert scores.loc["P01_01", ["activity_enjoyment", "flow"]].isna().tolist() == [True, False]
    assert scores.loc["P02_01", ["activity_enjoyment", "flow"]].isna().tolist() == [False, True]
    assert np.isnan(scores.loc["P01_02", "ratings_known_until_s"])
    assert scores["n_ratings"].tolist() == [4, 0, 4]
    assert scores["reason"].tolist() == ["no paces", "no ratings of affect", "no fss"]
    assert answers.findings["check"].tolist() == ["no_score", "no_affect", "no_score"]
    assert answers.findings["run"].tolist() == NAMES
    assert set(answers.findings["severity"]) == {"warning"}


def test_ratings_are_known_until_they_are_lost(lab):
    lab.lose_ratings("P01_01", 1200.0)
    lab.lose_ratings("P01_02", 1400.0, 1800.0)
    answers = lab.read()
    scores = answers.scores.set_index("run")
    assert scores["ratings_known_until_s"].tolist() == [1200.0, 1400.0, 1800.0]
    assert scores["n_ratings"].tolist() == [3, 3, 4]
    assert scores.loc["P01_01", "reason"] == "ratings lost from 1200 s on"
    assert answers.affect.groupby("run")["time_s"].max().tolist() == [900.0, 900.0, 1500.0]
    found = answers.findings["found"].tolist()
    assert found == [f"lost from {start} s on; 1 later ones unused" for start in (1200, 1400)]


def test_other_losses_do_not_concern_the_ratings():
    rows = [(100.0, 200.0, "data_loss", "Head"), (300.0, 310.0, "turn", ""), (5.0, 9.0, "data_loss", "heart rate")]  # fmt: skip
    assert known_until_s(pd.DataFrame(rows, columns=EVENTS), 1800.0) == 1800.0


def test_a_run_that_is_left_out_is_not_read(lab):
    lab.checks["P02_01"] = RunChecks(True, float("nan"), pd.DataFrame(columns=EVENTS))
    lab.affect["P02_01"] = [(0, 77)]
    answers = lab.read()
    assert answers.scores["run"].tolist() == NAMES[:2]
    assert set(answers.affect["run"]) == set(NAMES[:2])


def test_no_ratings_at_all_leave_tables_with_their_columns(lab):
    lab.files = dict.fromkeys(NAMES, "")
    answers = lab.read()
    assert list(answers.affect) == list(AFFECT_TABLE)
    assert answers.affect.empty


@pytest.mark.parametrize(
    ("ratings", "line"),
    [
        ([(0, 1), (1801, 2)], "a rating was given outside the run; expected 0 to 1800; found 1801"),
        ([(0, 1), (-5, 2)], "the ratings are not in the order of time"),
        ([(-5, 1), (10, 2)], "rating 1: a rating was given outside the run"),
        ([(0, 1), (60, 6)], "rating 2: a rating lies outside the scale; expected -5 to 5; found 6"),
        ([(0, 1), (60, 2), (60, 3)], "line 4: row stands twice; found time_s 60"),
        ([(90, 1), (60, 2)], "rating 2: the ratings are not in the order of time"),
        ([(0, 1), (60, "good")], "line 3, column feeling_scale: cell does not fit its column"),
        ([(0, 1), (60, 2.5)], "expected an integer; found '2.5'"),
        ([(0, 1), (60, "")], "line 3, column feeling_scale: cell is empty"),
        ([("1:20", 1)], "line 2, column time_s: cell does not fit its column"),
        ([], "table has no rows"),
    ],
)
def test_ratings_that_cannot_be_right_are_errors(lab, ratings, line):
    lab.affect["P01_02"] = ratings
    (error,) = lab.errors()
    assert error.startswith("P01/P01_02_affect.tsv: ")
    assert line in error


@pytest.mark.parametrize(
    ("row", "line"),
    [
        (("P03", "01", "fss", 70), "line 8: run is not in runs.tsv; expected a run of a participant that is listed there; found P03_01"),
        (("P01", "01", "sam", 70), "line 8: unknown questionnaire; expected paces or fss; found 'sam'"),
        (("P01", "01", "fss", 71.5), "line 8: fss of run P01_01 stands twice; expected one score; found lines 3 and 8"),
        (("P01", "01", "fss", ""), "line 8: fss of run P01_01 stands twice"),
    ],
)  # fmt: skip
def test_lines_of_questionnaires_that_cannot_be_right_are_errors(lab, row, line):
    lab.scores.append(row)
    (error,) = lab.errors()
    assert error.startswith("questionnaires.tsv: ")
    assert line in error


@pytest.mark.parametrize(
    ("score", "line"),
    [
        (127, "line 2: score outside its scale; expected 18 to 126; found 127"),
        (17.9, "score outside its scale"),
        ("12,5", "line 2: score is no number; expected 18 to 126, or nothing; found '12,5'"),
        ("inf", "score is no number"),
    ],
)
def test_scores_outside_their_scale_and_unreadable_ones_are_errors(lab, score, line):
    lab.scores[0] = (*lab.scores[0][:3], score)
    (error,) = lab.errors()
    assert line in error


def test_all_errors_are_listed_together_each_on_its_line(lab):
    lab.affect["P01_01"] = [(0, 9)]
    lab.affect["P02_01"] = [(0, 1), (2000, 1)]
    lab.scores[0] = (*lab.scores[0][:3], 4)
    lab.scores[3] = (*lab.scores[3][:3], "?")
    lab.scores.append(("P09", "01", "fss", 50))
    lines = lab.errors()
    files = [line.split(":")[0] for line in lines]
    assert files == ["P01/P01_01_affect.tsv", "P02/P02_01_affect.tsv", *["questionnaires.tsv"] * 3]
    assert not any(str(lab.folder) in line for line in lines)


def test_a_file_that_is_named_and_not_there_is_an_error(lab):
    lab.files["P01_02"] = "P01/elsewhere.tsv"
    assert lab.errors() == ["P01/elsewhere.tsv: no such file"]


def test_without_the_table_of_questionnaires_nothing_is_read(lab):
    lab.read()
    (lab.folder / "questionnaires.tsv").unlink()
    with pytest.raises(DesignError, match=r"questionnaires\.tsv: no such file"):
        read_answers(lab.folder, read_design(lab.folder), lab.checks, RULES)


def test_checks_of_the_import_are_read_from_its_files(tmp_path):
    said = {"P01_01": (False, 1800.5), "P01_02": (True, None)}
    for name, (excluded, duration_s) in said.items():
        text = json.dumps({"run": name, "excluded": excluded, "duration_s": duration_s})
        (tmp_path / f"{name}.json").write_text(text)
    events = pd.DataFrame([(1.0, 2.0, "turn", "")], columns=EVENTS)
    events.to_parquet(tmp_path / "P01_01.parquet")
    checks = read_checks(list(said), tmp_path, tmp_path)
    assert (checks["P01_01"].excluded, checks["P01_01"].duration_s) == (False, 1800.5)
    pd.testing.assert_frame_equal(checks["P01_01"].events, events)
    assert checks["P01_02"].excluded
