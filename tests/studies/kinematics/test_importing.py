"""Import of a sound trial against the truth."""

import numpy as np
import pytest

from swaystride.lower_limb_joints import SEGMENTS
from swaystride.recording import list_recordings
from swaystride.studies.kinematics.importing import EXCLUSION_COLUMNS


@pytest.fixture(scope="module")
def recordings(sound_lab):
    return sound_lab.recordings()


def test_a_sound_trial_is_usable_and_nothing_but_gaps_is_reported(sound_lab):
    tables = sound_lab.tables
    assert tables.n_usable == 1
    assert tables.exclusions.empty
    assert list(tables.exclusions) == list(EXCLUSION_COLUMNS)
    assert set(tables.findings["check"]) <= {"marker_gap", "marker_gap_filled", "marker_gap_stays"}
    assert tables.findings["check"].is_unique
    assert tables.summary == f"1 trials usable, 0 excluded, {len(tables.findings)} findings"


def test_seven_sensors_come_in_the_order_of_the_segments(recordings, known):
    running = recordings.running
    assert [str(name) for name in running["sensor"].values] == list(SEGMENTS)
    assert running.attrs["start_s"] == 0.0
    assert recordings.standing["gyr"].shape[:2] == (7, 3)
    for side, foot in enumerate(("right_foot", "left_foot")):
        rate = np.linalg.norm(running["gyr"].sel(sensor=foot).values, axis=0)
        contact, toe_off = known.motion.contacts_s(side)
        starts = contact[contact < toe_off[-1]]
        middle = (starts + toe_off[np.searchsorted(toe_off, starts)]) / 2.0
        quiet = rate[np.rint(middle * 200.0).astype(int)]
        assert np.median(quiet) < 0.3 * np.median(rate)


def test_markers_lie_on_the_clock_of_the_sensors(recordings, known):
    """A marker on a sensor is where the sensor is; the cameras may start 2 ms early or late."""
    markers, running = recordings.markers, recordings.running
    np.testing.assert_array_equal(markers["time"].values, running["time"].values)
    faces = ["IMUP", "RIMF", "LIMF"]
    sensor = [SEGMENTS.index(name) for name in ("pelvis", "right_foot", "left_foot")]
    seen = np.moveaxis(markers["position"].sel(marker=faces).values, -1, 0)
    time_s = running["time"].values[10:-10]

    def missed_m(offset_s):
        at = time_s + offset_s
        true = known.sensor_position_m(at)[:, sensor]
        true[..., 0] -= known.motion.belt_way_m(at)[:, None]
        return np.sqrt(np.nanmean((seen[10:-10] - true) ** 2))

    assert 5e-4 < abs(known.marker_start_s) < 2e-3
    assert missed_m(known.marker_start_s) < 1e-3
    assert missed_m(0.0) < 5.0 * abs(known.marker_start_s)
    assert missed_m(known.marker_start_s + 0.005) > 4e-3


def test_only_markers_that_are_needed_stay(recordings, analysis):
    names = set(map(str, recordings.markers["marker"].values))
    assert set(analysis("printed")["markers"]["faces"].values()) <= names
    assert "C7" not in names


def test_a_trial_that_the_lab_leaves_out_is_not_read(lab):
    def leave_out(trials):
        trials.loc[1, "exclude"] = "treadmill stopped"
        return trials

    lab.change_table("trials", leave_out)
    for kind in ("running_imu", "running_markers", "standing_imu", "standing_markers"):
        lab.file(kind).unlink()
    tables = lab.import_all()
    assert tables.n_usable == 0
    assert tables.exclusions.loc[0, "reason"] == "treadmill stopped"
    assert list_recordings(lab.folder / "recordings.nc") == []
