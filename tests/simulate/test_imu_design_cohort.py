"""Participants, trials and mean speeds of the simulated cohort."""

from dataclasses import replace

import numpy as np
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values, validate
from swaystride.errors import ConfigurationError
from swaystride.simulate.imu_design_cohort import (
    imu_design_tables,
    mean_speeds,
    participant_names,
    person_of,
)
from swaystride.simulate.imu_design_parameters import cohort_from_config

CONFIG = REPOSITORY / "config" / "studies" / "imu_design.yaml"


def sized(runners, n):
    return replace(runners, protocol=replace(runners.protocol, n_participants=n))


def test_the_configuration_fits_its_schema():
    schema = load_yaml(REPOSITORY / "workflow" / "schemas" / "imu_design.schema.yaml")
    validate(load_yaml(CONFIG), schema, file=CONFIG)


def test_tables_are_those_of_a_lab(runners):
    tables = imu_design_tables(runners, 3)
    people, trials = tables.participants, tables.trials
    assert people["participant"].tolist() == participant_names(runners)
    assert people["sex"].value_counts().to_dict() == {"F": 3, "M": 3}
    assert round(people["age_years"].mean(), 1) == 24.2
    assert round(people["age_years"].std(), 1) == 6.0
    assert people["height_m"].between(1.45, 2.0).all()
    assert len(trials) == 6 * 10 * 2 * 2
    assert trials["file"].is_unique
    first = trials.iloc[0]
    assert first["file"] == "P01/P01_01_left_imu_1.csv"
    assert (first["distance_m"], first["exclude"]) == (100.0, "")


@pytest.mark.parametrize("seed", range(20))
def test_two_walks_and_eight_runs_at_rising_speeds(runners, seed):
    for name in participant_names(runners):
        speeds = mean_speeds(name, runners, seed)
        assert (np.diff(speeds) > 0).all()
        assert 1.1 < speeds[0] < speeds[1] < 1.85
        assert 2.15 < speeds[2] < 2.75
        assert 5.1 < speeds[-1] <= 6.4


def test_speeds_differ_between_people(runners):
    first, second = (mean_speeds(name, runners, 1) for name in ("P01", "P02"))
    assert (first != second).all()


def test_nobody_depends_on_how_many_take_part(runners):
    large, small = (imu_design_tables(sized(runners, n), 5) for n in (9, 2))
    ours = large.participants["participant"].isin(["P01", "P02"])
    assert large.participants[ours].equals(small.participants)
    trials = large.trials["participant"].isin(["P01", "P02"])
    assert large.trials[trials].equals(small.trials)
    for name in ("P01", "P02"):
        one, other = (person_of(name, 1.7, sized(runners, n), 5) for n in (9, 2))
        np.testing.assert_array_equal(one.feet[0].sensor_m, other.feet[0].sensor_m)
        assert one.feet[1].manner == other.feet[1].manner


def test_a_single_walk_is_the_slow_one(runners):
    protocol = replace(runners.protocol, n_walking=1, n_running=2)
    speeds = mean_speeds("P01", replace(runners, protocol=protocol), 1)
    assert len(speeds) == 3
    assert speeds[0] < 1.4


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: s["sensors"]["imu_1"].update(model="abacus"), "sensors.imu_1.model"),
        (lambda s: s["foot"].pop("sole"), "foot: keys do not match"),
        (lambda s: s["foot"]["stride"].pop("time_cv"), "foot.stride: keys do not match"),
        (lambda s: s["sensors"].pop("imu_2"), "simulation: keys do not match"),
    ],
)
def test_a_faulty_configuration_is_told(change, message):
    section = plain_values(load_yaml(CONFIG)["simulation"])
    change(section)
    with pytest.raises(ConfigurationError, match=message):
        cohort_from_config(section)
