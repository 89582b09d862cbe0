"""The lab's tables and the model variables derived from them."""

from io import StringIO

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import DesignError
from swaystride.io.study_tables import write_study_table
from swaystride.studies.feedback.design import model_variables, read_design
from swaystride.studies.feedback.flow import participant_flow

PARTICIPANTS = """participant\torder\tage_years\tsex\theight_m\tmass_kg
A\tterminal_first\t71.5\tM\t1.80\t81
B\tconcurrent_first\t68\tF\t1.60\t60
"""

# A short session of one participant, and by hand what the models see of it (methods §8.3).
SESSION = """
trial block feedback   phase    set trial_in_set shown      | order block N  N_reset CR TR
1     1     terminal   baseline .   1            none       | 1     0     0  0       0  0
2     1     terminal   training 1   1            terminal   | 1     0     1  1       0  0
3     1     terminal   training 1   2            terminal   | 1     0     2  2       0  0
4     1     terminal   training 1   3            none       | 1     0     3  3       0  1
5     2     concurrent baseline .   1            none       | 1     1     3  0       0  0
6     2     concurrent training 1   1            concurrent | 1     1     4  1       0  0
7     2     concurrent training 1   2            concurrent | 1     1     5  2       0  0
8     2     concurrent training 1   3            none       | 1     1     6  3       1  0
"""


def session():
    rows = [line.replace("|", " ").split() for line in SESSION.strip().splitlines()]
    return pd.DataFrame(rows[1:], columns=rows[0])


def trials_table(participant="A"):
    table = session()
    return pd.DataFrame(
        {
            "participant": participant,
            "session_trial": table["trial"].astype(int),
            "block": table.iloc[:, 1].astype(int),
            "feedback": table["feedback"],
            "phase": table["phase"],
            "set": table["set"].replace(".", ""),
            "trial_in_set": table["trial_in_set"].astype(int),
            "feedback_shown": table["shown"],
            "file": [f"{participant}/{number}.txt" for number in table["trial"]],
        }
    )


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "participants.tsv").write_text(PARTICIPANTS, encoding="utf-8")
    other = trials_table("B").assign(feedback_shown="none")
    other["feedback"] = other["feedback"].map({"terminal": "concurrent", "concurrent": "terminal"})
    trials = pd.concat([trials_table("A"), other])
    write_study_table(trials, tmp_path / "trials.tsv")
    return tmp_path


@pytest.mark.parametrize(("coding", "column"), [("continue", "N"), ("reset", "N_reset")])
def test_model_variables_agree_with_a_table_written_by_hand(folder, coding, column):
    variables = model_variables(*read_design(folder), trial_number_coding=coding)
    own = variables[variables["participant"] == "A"]
    expected = session()
    for ours, theirs in (
        ("order", expected["order"]),
        ("block", expected.iloc[:, 8]),
        ("trial_number", expected[column]),
        ("concurrent_feedback_removed", expected["CR"]),
        ("terminal_feedback_removed", expected["TR"]),
    ):
        np.testing.assert_array_equal(own[ours], theirs.astype(float), err_msg=ours)
    assert own["age"].unique() == [71.5]
    assert own["sex"].unique() == [1.0]


def test_rows_may_stand_in_any_order(folder):
    participants, trials = read_design(folder)
    shuffled = trials.sample(frac=1.0, random_state=3)
    pd.testing.assert_frame_equal(
        model_variables(participants, shuffled, trial_number_coding="continue"),
        model_variables(participants, trials, trial_number_coding="continue"),
    )


def test_the_study_and_the_simulator_derive_the_same_variables(variables, design):
    """Two codes, written apart, from the same trials.tsv."""
    simulator = design.sort_values(["participant", "session_trial"], ignore_index=True)
    for name in (
        "order",
        "block",
        "trial_number",
        "concurrent_feedback_removed",
        "terminal_feedback_removed",
        "age",
        "sex",
    ):
        np.testing.assert_array_equal(variables[name], simulator[name], err_msg=name)


def test_the_published_design_has_708_trials(tables):
    participants, trials = tables
    per_person = trials.groupby("participant").size()
    assert len(participants) == 19
    assert len(trials) == 708
    assert per_person.tolist() == [36] * 7 + [38] * 12


def spoil(folder, file, old, new):
    path = folder / file
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "old", "new", "line"),
    [
        ("participants.tsv", "age_years", "age", "column 'age_years' is missing"),
        ("participants.tsv", "71.5", "old", "line 2, column age_years: .*; found 'old'"),
        ("participants.tsv", "71.5", "715", "expected a number ≥ 0 ≤ 120; found '715'"),
        ("participants.tsv", "\tM\t", "\tX\t", "line 2, column sex: .* one of F, M; found 'X'"),
        ("participants.tsv", "B\tcon", "A\tcon", "line 3: row stands twice; found participant A"),
        ("trials.tsv", "A\t2\t", "C\t2\t", "line 3, .* not in participants.tsv; found 'C'"),
        ("trials.tsv", "A\t3\t", "A\t2\t", "line 4: row stands twice"),
        ("participants.tsv", "A\tterminal", "A\tconcurrent", "block 1: .* contradicts the order"),
        ("participants.tsv", "A\tterm", "A 1\tterm", "without blanks and slashes; found 'A 1'"),
        ("participants.tsv", "sex\theight_m", "sex\tsex", "column 'sex' stands twice"),
        ("trials.tsv", "A/4.txt", "A/3.txt", "lines 4, 5: two trials name the same file"),
        ("trials.tsv", "A\t3\t1\tterm", "A\t3\t2\tterm", "blocks are mixed"),
        ("trials.tsv", "A\t3\t", "A\t3.5\t", "line 4, column session_trial: .* an integer"),
        ("trials.tsv", "baseline\t\t1\tnone", "baseline\t\t1\tterminal", "line 2, .* contradicts"),
        ("trials.tsv", "training\t1\t1", "trainin\t1\t1", "one of baseline, training; found 'tr"),
    ],
)
def test_a_wrong_table_is_one_line_with_file_and_place(folder, file, old, new, line):
    spoil(folder, file, old, new)
    with pytest.raises(DesignError, match=line) as caught:
        read_design(folder)
    assert file in str(caught.value)


def test_a_table_that_is_not_utf8_is_named(folder):
    path = folder / "participants.tsv"
    path.write_bytes(path.read_bytes().replace(b"A\t", b"J\xf6rg\t"))
    with pytest.raises(
        DesignError, match=r"participants\.tsv: not readable as text; expected UTF-8"
    ):
        read_design(folder)


def test_missing_and_empty_tables_are_named(folder):
    (folder / "trials.tsv").write_text("", encoding="utf-8")
    with pytest.raises(DesignError, match=r"trials\.tsv: file is empty"):
        read_design(folder)
    (folder / "trials.tsv").unlink()
    with pytest.raises(DesignError, match=r"trials\.tsv: no such file"):
        read_design(folder)


def test_a_participant_without_trials_is_an_error(folder):
    spoil(folder, "participants.tsv", "B\t", "Z\t")
    with pytest.raises(DesignError):
        read_design(folder)


def test_the_flow_adds_up(folder):
    participants, trials = read_design(folder)
    exclusions = pd.read_csv(
        StringIO("participant,trial,reason\nA,trial_02,gap\nA,trial_03,gap\nB,trial_01,fell\n")
    )
    people, counted = participant_flow(participants, trials, exclusions)
    assert people["analysed"] == 2
    assert counted["recorded"] == 16
    assert counted["analysed"] == 13
    assert counted["excluded"] == [{"reason": "fell", "count": 1}, {"reason": "gap", "count": 2}]
