"""Tables of the lab, sound and not."""

import pytest

from swaystride.errors import DesignError
from swaystride.studies.kinematics.design import KINDS, read_design


def test_a_sound_design(sound_lab):
    design = sound_lab.design
    assert design.trial_names("P01") == ["01"]
    files = design.files("P01", "01")
    assert tuple(files) == KINDS
    assert all((sound_lab.folder / file).is_file() for file in files.values())
    assert design.belt_speed_m_s("P01", "01") == pytest.approx(14.0 / 3.6, abs=1e-3)
    assert design.exclusion("P01", "01") == ""


def test_somebody_who_is_not_in_the_table(sound_lab):
    assert sound_lab.design.person("P01")["sex"] in ("F", "M")
    message = r"^participants.tsv: no such participant; expected P01; found 'P99'$"
    with pytest.raises(DesignError, match=message):
        sound_lab.design.person("P99")


@pytest.fixture
def tables(sound_lab, tmp_path):
    """A design of one's own: call with the name of a table and a change of its text."""
    for name in ("participants.tsv", "trials.tsv"):
        (tmp_path / name).write_text((sound_lab.folder / name).read_text())

    def change(name, edit):
        path = tmp_path / f"{name}.tsv"
        lines = [line.split("\t") for line in path.read_text().splitlines()]
        path.write_text("".join("\t".join(line) + "\n" for line in edit(lines)))
        return read_design(tmp_path)

    return change


def renamed(lines):
    return [lines[0], *(["P07", *line[1:]] for line in lines[1:])]


def refiled(row, file):
    def edit(lines):
        at = lines[0].index("file")
        return [[*line[:at], file, *line[at + 1 :]] if n == row else line for n, line in enumerate(lines)]  # fmt: skip

    return edit


def on_another_belt(lines):
    at = {name: lines[0].index(name) for name in ("kind", "belt_speed_m_s")}
    return [[*line[: at["belt_speed_m_s"]], "3.5", *line[at["belt_speed_m_s"] + 1 :]] if line[at["kind"]] == "running_markers" else line for line in lines]  # fmt: skip


def without(column):
    def edit(lines):
        at = lines[0].index(column)
        return [line[:at] + line[at + 1 :] for line in lines]

    return edit


def with_a_second_trial(lines, **changes):
    """A trial 02; by default all of its files are others."""
    at = {name: lines[0].index(name) for name in ("trial", "file", "kind", "exclude")}
    more = []
    for line in lines[1:]:
        other = list(line)
        other[at["trial"]] = "02"
        if not changes.get("same", lambda kind: False)(line[at["kind"]]):
            other[at["file"]] = line[at["file"]].replace("_01_", "_02_")
        other[at["exclude"]] = changes.get("exclude", "")
        more.append(other)
    return lines + more


@pytest.mark.parametrize(
    ("table", "edit", "message"),
    [
        ("trials", renamed, r"trials.tsv: line 2, column participant: participant is not in participants.tsv; found 'P07'"),
        ("trials", lambda t: t[:1], "trials.tsv"),
        ("trials", lambda t: [*t, t[1]], "trials.tsv: .*"),
        ("participants", lambda t: [*t, ["P02", *t[1][1:]]], "participants.tsv: participant has no trials; found P02"),
        ("participants", lambda t: [*t, t[1]], "participants.tsv: "),
        ("participants", without("leg_length_right_m"), "participants.tsv: .*leg_length_right_m"),
        ("participants", without("sex"), "participants.tsv: .*sex"),
        ("trials", without("belt_speed_m_s"), "trials.tsv: .*belt_speed_m_s"),
        ("trials", without("kind"), "trials.tsv: .*kind"),
        ("trials", lambda t: [t[0], [*t[1][:2], "walking_imu", *t[1][3:]], *t[2:]], "line 2, column kind.*walking_imu"),
        ("trials", on_another_belt, r"trials.tsv: lines 2 and 3, column belt_speed_m_s: one run has two speeds of the belt; found 3.88889 and 3.5"),
        ("trials", refiled(1, "P01/P01_01_running.c3d"), "trials.tsv: lines 2, 3: two trials name the same file"),
    ],
)  # fmt: skip
def test_a_table_that_contradicts_itself(tables, table, edit, message):
    with pytest.raises(DesignError, match=message):
        tables(table, edit)


def test_two_trials_with_one_run_are_refused_and_told_where(tables):
    with pytest.raises(DesignError, match=r"lines 2, 6: two trials name the same file; found P01/"):
        tables("trials", lambda t: with_a_second_trial(t, same=lambda kind: kind == "running_imu"))


def test_one_standing_may_serve_several_trials(tables):
    same = {"same": lambda kind: kind.startswith("standing")}
    design = tables("trials", lambda t: with_a_second_trial(t, **same))
    assert design.trial_names("P01") == ["01", "02"]
    assert design.files("P01", "02")["standing_imu"] == design.files("P01", "01")["standing_imu"]


def test_a_trial_that_is_left_out_may_name_any_file(tables):
    changes = {"same": lambda kind: True, "exclude": "shoe lost"}
    design = tables("trials", lambda t: with_a_second_trial(t, **changes))
    assert design.exclusion("P01", "02") == "shoe lost"
    assert design.exclusion("P01", "01") == ""


def test_the_column_of_reasons_may_be_missing(tables):
    assert tables("trials", without("exclude")).exclusion("P01", "01") == ""


def test_no_speed_without_a_run(tables):
    design = tables("trials", lambda t: [t[0], *t[2:]])
    assert design.belt_speed_m_s("P01", "01") == 0.0
    assert "running_imu" not in design.files("P01", "01")
