"""Runners, what is measured on them, and trials of the simulated kinematics cohort."""

from dataclasses import asdict, fields, replace

import numpy as np
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, overlay, plain_values, validate
from swaystride.errors import ConfigurationError
from swaystride.simulate.kinematics_cohort import (
    body_of,
    kinematics_tables,
    manner_of,
    participant_names,
    reported_history,
    trial_names,
    true_measures,
)
from swaystride.simulate.kinematics_parameters import cohort_from_config
from swaystride.simulate.kinematics_recordings import lost_marker
from swaystride.simulate.running_manner import RunnerManner
from swaystride.simulate.running_scatter import RunnerScatter

CONFIG = REPOSITORY / "config" / "studies" / "kinematics.yaml"


def sized(cohort, n):
    return replace(cohort, protocol=replace(cohort.protocol, n_participants=n))


def test_the_configuration_fits_its_schema():
    schema = load_yaml(REPOSITORY / "workflow" / "schemas" / "kinematics.schema.yaml")
    validate(load_yaml(CONFIG), schema, file=CONFIG)


def test_tables_are_those_of_a_lab(treadmill_runners):
    tables = kinematics_tables(treadmill_runners, 3)
    people, trials = tables.participants, tables.trials
    assert people.columns.tolist() == [
        "participant",
        "sex",
        "age_years",
        "height_m",
        "mass_kg",
        "leg_length_right_m",
        "leg_length_left_m",
        "knee_width_right_m",
        "knee_width_left_m",
        "ankle_width_right_m",
        "ankle_width_left_m",
        "years_running",
        "typical_pace_min_per_km",
        "race_5km_min",
    ]
    assert people["participant"].tolist() == participant_names(treadmill_runners)
    assert people["sex"].tolist() == ["M"] * 6
    assert round(people["age_years"].mean(), 1) == 36.8
    assert round(people["age_years"].std(), 1) == 10.6
    assert people["height_m"].between(1.62, 1.82).all()
    assert len(trials) == 6 * 2 * 4
    assert trials["file"].is_unique
    assert (trials["exclude"] == "").all()
    own = trials[(trials["participant"] == "P02") & (trials["trial"] == "01")].set_index("kind")
    assert own["file"].to_dict() == {
        "running_imu": "P02/P02_01_running.h5",
        "running_markers": "P02/P02_01_running.c3d",
        "standing_imu": "P02/P02_01_standing.h5",
        "standing_markers": "P02/P02_01_standing.c3d",
    }
    assert own["belt_speed_m_s"].round(4).tolist() == [3.8889, 3.8889, 0.0, 0.0]


def test_legs_are_measured_with_a_small_error(treadmill_runners):
    measuring = treadmill_runners.measuring
    people = kinematics_tables(sized(treadmill_runners, 30), 1).participants
    for measure, sd in (
        ("leg_length", measuring.leg_length_sd_m),
        ("knee_width", measuring.width_sd_m),
        ("ankle_width", measuring.width_sd_m),
    ):
        true = [
            true_measures(body_of(height, mass), measuring)[measure]
            for height, mass in zip(people["height_m"], people["mass_kg"], strict=True)
        ]
        sides = people[[f"{measure}_right_m", f"{measure}_left_m"]].to_numpy()
        error = sides - np.array(true)[:, None]
        assert np.abs(error).max() < 2.0 * sd + 6e-4
        assert np.std(error) > 0.6 * sd
        assert (sides[:, 0] != sides[:, 1]).any()


def test_an_exact_tape_finds_what_the_body_has(treadmill_runners):
    measuring = replace(treadmill_runners.measuring, leg_length_sd_m=0.0, width_sd_m=0.0)
    people = kinematics_tables(replace(treadmill_runners, measuring=measuring), 1).participants
    assert (people["leg_length_right_m"] == people["leg_length_left_m"]).all()
    assert people["leg_length_right_m"].rank().equals(people["height_m"].rank())


def test_history_is_written_as_people_write_it(treadmill_runners):
    people = kinematics_tables(sized(treadmill_runners, 60), 2).participants
    assert people["years_running"].str.fullmatch(r">15|\d+").all()
    time = r"\d{1,2}:[0-5]\d"
    assert people["typical_pace_min_per_km"].str.fullmatch(f"{time}(-{time})?").all()
    assert people["race_5km_min"].str.fullmatch(f"({time})?").all()
    for some in (
        people["years_running"] == ">15",
        people["typical_pace_min_per_km"].str.contains("-"),
        people["race_5km_min"] == "",
    ):
        assert 0 < some.sum() < 30


def test_a_typical_pace_is_not_faster_than_a_race(treadmill_runners):
    history = replace(treadmill_runners.history, pace_range_share=0.0, no_race_share=0.0)

    def seconds(text):
        minutes, rest = text.split(":")
        return 60 * int(minutes) + int(rest)

    rng = np.random.default_rng(1)
    for _ in range(50):
        told = reported_history(history, 30.0, rng)
        pace, race = seconds(told["typical_pace_min_per_km"]), seconds(told["race_5km_min"])
        assert pace > race / 5.0


def test_nobody_depends_on_how_many_take_part(treadmill_runners):
    large, small = (kinematics_tables(sized(treadmill_runners, n), 5) for n in (9, 2))
    for name in ("participants", "trials"):
        table = getattr(large, name)
        ours = table[table["participant"].isin(["P01", "P02"])]
        assert ours.equals(getattr(small, name))
    again = kinematics_tables(sized(treadmill_runners, 2), 5)
    assert again.participants.equals(small.participants)
    other = kinematics_tables(sized(treadmill_runners, 2), 6)
    assert not other.participants.equals(small.participants)


def test_runners_differ_and_the_trials_of_one_are_alike(treadmill_runners):
    one, again, other = (
        np.array(list(asdict(manner_of(name, trial, treadmill_runners, 1)).values()))
        for name, trial in (("P01", "01"), ("P01", "02"), ("P02", "01"))
    )
    varied = one != again
    assert varied.sum() == len(fields(RunnerScatter)) - 1
    assert np.mean(np.abs(one - again)[varied] < np.abs(one - other)[varied]) > 0.75


def test_without_scatter_everybody_is_the_usual_runner(treadmill_runners):
    nobody = RunnerScatter(**{f.name: 0.0 for f in fields(RunnerScatter)})
    cohort = replace(treadmill_runners, person=nobody)
    assert manner_of("P01", "01", cohort, 1) == RunnerManner()


@pytest.mark.parametrize("seed", range(5))
def test_two_trials_of_the_cohort_have_failed_optics(treadmill_runners, seed):
    lost = {
        f"{name}/{trial}": lost_marker(name, trial, treadmill_runners, seed)
        for name in participant_names(treadmill_runners)
        for trial in trial_names(treadmill_runners)
    }
    failed = {trial: marker for trial, marker in lost.items() if marker is not None}
    assert set(failed) == set(treadmill_runners.protocol.failed_optics)
    assert len(failed) == 2
    assert set(failed.values()) <= set(treadmill_runners.protocol.failed_markers)


def test_a_demo_has_failed_optics_of_its_own():
    tree = load_yaml(CONFIG)
    changes = tree["scales"]["demo"]["changes"]
    demo = cohort_from_config(
        plain_values(overlay(tree, changes, name="demo", file=CONFIG)["simulation"])
    )
    trials = {f"{name}/{trial}" for name in participant_names(demo) for trial in trial_names(demo)}
    assert len(trials) == 4
    assert len(trials & set(demo.protocol.failed_optics)) == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda s: s["cohort"].pop("bodies"), "cohort: keys do not match"),
        (lambda s: s["runner"]["person"].pop("trial_share"), "runner.person: keys do not match"),
        (lambda s: s["equipment"].pop("marker_place_sd_m"), "simulation: keys do not match"),
        (lambda s: s.pop("runner"), "simulation: keys do not match"),
        (
            lambda s: s["cohort"]["protocol"].update(failed_optics=["P03-02"]),
            "failed_optics: .*P03/02; found 'P03-02'",
        ),
        (
            lambda s: s["cohort"]["protocol"].update(failed_markers=["KNEE"]),
            "failed_markers: .*found 'KNEE'",
        ),
        (
            lambda s: s["cohort"]["protocol"].update(failed_markers=[]),
            "failed_markers: .*at least one marker",
        ),
    ],
)
def test_a_faulty_configuration_is_told(change, message):
    section = plain_values(load_yaml(CONFIG)["simulation"])
    change(section)
    with pytest.raises(ConfigurationError, match=message):
        cohort_from_config(section)
