"""The simulated cohort of the experience study: who runs, how often, in which pattern, how fast."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, overlay, plain_values
from swaystride.errors import ConfigurationError
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_cohort import (
    experience_tables,
    participant_names,
    pattern_of,
    run_names,
)
from swaystride.simulate.experience_parameters import cohort_from_config
from swaystride.simulate.experience_plans import planned_run
from swaystride.simulate.experience_profiles import pace_m_s
from swaystride.simulate.running_scatter import manner_scales
from swaystride.units import DEG_PER_RAD

CONFIG = REPOSITORY / "config" / "studies" / "experience.yaml"


@pytest.fixture(scope="module")
def people():
    return read_table(REPOSITORY / "data" / "published" / "table_5_1.csv")


@pytest.fixture(scope="module")
def tables(path_runners, people):
    return experience_tables(path_runners, people, 1)


@pytest.fixture(scope="module")
def plans(path_runners, tables):
    """Some runs at full length: what they are meant to be takes no simulation."""
    names = ("P01_01", "P01_02", "P04_01", "P11_01")
    return {name: planned_run(name, tables, path_runners, 1) for name in names}


def test_runs_are_as_many_as_printed(path_runners, tables):
    counts = np.array(path_runners.protocol.runs_per_participant)
    printed = load_text()
    assert len(counts) == printed["n_participants"]
    assert counts.sum() == len(run_names(path_runners)) == len(tables.runs) == printed["n_runs"]
    assert round(counts.mean(), 1) == printed["runs_per_participant_mean"]
    assert round(counts.std(), 1) == printed["runs_per_participant_sd"]
    assert (counts.min(), counts.max()) == (1, 5)
    patterns = [pattern_of(run, path_runners) for run in run_names(path_runners)]
    assert patterns.count("aerial") == printed["n_aerial_runs"]
    assert patterns.count("terrestrial") == printed["n_terrestrial_runs"]
    of_people = pd.Series(patterns).groupby([run[:3] for run in run_names(path_runners)]).nunique()
    assert (of_people == 2).sum() >= 2


def load_text():
    table = read_table(REPOSITORY / "data" / "published" / "study5_text.csv")
    return table.set_index("quantity")["value"]


def test_bodies_are_the_printed_ones(tables, people):
    ours = tables.participants
    assert ours["participant"].tolist() == [f"P{n:02d}" for n in people["participant"]]
    assert ours["sex"].tolist() == people["sex"].tolist()
    np.testing.assert_allclose(100.0 * ours["height_m"], people["height_cm"])
    assert ours["mass_kg"].tolist() == people["mass_kg"].tolist()
    assert ours["highest_level"].tolist() == people["highest_level"].tolist()


def test_heart_rate_and_head_are_lost_in_aerial_runs_only(path_runners, tables):
    """Tables 5.3 and 5.4 have 21 of 23 and 16 of 18 runs with them."""
    losses = path_runners.losses
    head = losses.head_lost_runs + losses.head_loose_runs
    assert len(losses.heart_rate_runs) == len(head) == 2
    assert len(losses.ratings_runs) == 1
    for run in (*losses.heart_rate_runs, *head):
        assert run in run_names(path_runners)
        assert pattern_of(run, path_runners) == "aerial"
    names = tables.runs["participant"] + "_" + tables.runs["run"]
    assert names[tables.runs["ecg"] == ""].tolist() == list(losses.heart_rate_runs)


def test_the_first_people_of_a_small_cohort_are_those_of_the_large_one(
    path_runners, people, tables
):
    protocol = replace(path_runners.protocol, runs_per_participant=(2, 2))
    small = replace(path_runners, protocol=protocol)
    ours = experience_tables(small, people, 1)
    assert participant_names(small) == ["P01", "P02"]
    pd.testing.assert_frame_equal(ours.runs, tables.runs.iloc[:4])
    pd.testing.assert_frame_equal(ours.participants, tables.participants.iloc[:2])
    one, same = (planned_run("P01_02", t, path_runners, 1) for t in (tables, ours))
    assert (one.manner, one.duty_factor, one.turn_s) == (same.manner, same.duty_factor, same.turn_s)


def test_duty_factors_are_clear_of_the_cut_offs(path_runners, plans):
    below, above = (load_text()[f"duty_factor_{n}"] for n in ("aerial_below", "terrestrial_above"))
    assert path_runners.duty.aerial_range[1] <= below - 0.0119
    assert path_runners.duty.terrestrial_range[0] >= above + 0.0119
    for plan in plans.values():
        ends = getattr(path_runners.duty, f"{plan.pattern}_range")
        assert ends[0] <= plan.duty_factor <= ends[1]


def test_speeds_are_those_of_the_steady_part_and_lower_in_the_turn(path_runners, plans):
    for plan in plans.values():
        fine = np.arange(0.0, 1800.0, 0.1)
        speed = plan.profile.speed_at(fine)
        steady = (
            (fine[:, None] > plan.steady_s[:, 0]) & (fine[:, None] < plan.steady_s[:, 1])
        ).any(1)
        assert speed[steady].mean() == pytest.approx(plan.speed_m_s, rel=1e-3)
        low, high = path_runners.pace.range_m_s
        assert low <= plan.speed_m_s <= high
        middle = sum(plan.turn_s) / 2.0
        assert plan.profile.speed_at(middle) < 0.9 * plan.speed_m_s
        assert speed.min() > 2.49
        turned = np.diff(plan.profile.heading_at(np.array(plan.turn_s)))[0]
        assert turned * DEG_PER_RAD == pytest.approx(180.0, abs=10.0)
        assert 6.0 <= plan.turn_s[1] - plan.turn_s[0] <= 10.0
        assert middle == pytest.approx(900.0, abs=20.0)


def test_some_runs_change_after_the_warm_up_and_some_do_not(path_runners, plans):
    """Without slow changes, only warm-up and fatigue are left (Figure 5.2)."""
    course = replace(path_runners.course, speed_slow_sd=0.0, manner_slow=0.0, change_share=0.5)
    cohort = replace(path_runners, course=course)
    people = read_table(REPOSITORY / "data" / "published" / "table_5_1.csv")
    tables = experience_tables(cohort, people, 1)
    changed = []
    for run in ("P01_01", "P05_01", "P06_01", "P06_02", "P06_03", "P12_01"):
        duty = planned_run(run, tables, cohort, 1).profile.changes["duty_factor"]
        changed.append(abs(duty[-1] - duty[len(duty) // 3 + 20]) > 2e-4)
    assert 0 < sum(changed) < len(changed)


def test_faster_levels_run_faster(path_runners):
    def speed(level, sex="M", is_terrestrial=False):
        none = replace(path_runners.pace, range_m_s=(1.0, 9.0))
        return pace_m_s(none, level=level, sex=sex, is_terrestrial=is_terrestrial, z=(0.0, 0.0))

    assert speed("recreational") < speed("recreationally competitive") < speed("college")
    assert speed("college", sex="F") < speed("college")
    assert speed("college", is_terrestrial=True) < speed("college")
    with pytest.raises(ConfigurationError, match="no speed for this level"):
        speed("olympic")


def test_a_manner_is_a_persons_own_with_something_of_the_run(path_runners, plans):
    """Most parts are nearer to those of the person's other run than to those of another person."""
    one, again, other = (plans[name].manner for name in ("P01_01", "P01_02", "P11_01"))
    closer = []
    for name in manner_scales(path_runners.person):
        if name != "duty_factor":
            value = getattr(one, name)
            assert value != getattr(again, name)
            closer.append(abs(value - getattr(again, name)) < abs(value - getattr(other, name)))
    assert np.mean(closer) > 0.6


def test_what_cannot_be_a_cohort_is_refused(path_runners, people):
    tree = plain_values(load_yaml(CONFIG)["simulation"])
    tree["cohort"]["losses"]["heart_rate_runs"] = ["P2/2"]
    with pytest.raises(ConfigurationError, match="not the name of a run"):
        cohort_from_config(tree)
    with pytest.raises(ConfigurationError, match="everybody runs at least once"):
        replace(path_runners.protocol, runs_per_participant=(1, 0))
    many = replace(path_runners.protocol, runs_per_participant=(1,) * 13)
    with pytest.raises(ConfigurationError, match="more participants than were printed"):
        experience_tables(replace(path_runners, protocol=many), people, 1)
    with pytest.raises(ConfigurationError, match="keys do not match"):
        cohort_from_config({"cohort": {}})


def test_the_demo_is_a_small_cohort():
    tree = load_yaml(CONFIG)
    demo = overlay(tree, tree["scales"]["demo"]["changes"], file=CONFIG, name="demo")
    cohort = cohort_from_config(plain_values(demo["simulation"]))
    assert len(run_names(cohort)) < 8
    patterns = {pattern_of(run, cohort) for run in run_names(cohort)}
    assert patterns == {"aerial", "terrestrial"}
    assert cohort.protocol.warm_up_s < cohort.course.turn_s < cohort.protocol.duration_s
