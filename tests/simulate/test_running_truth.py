"""The file of truth gives the same motion back."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.simulate.running_markers import true_positions
from swaystride.simulate.running_sensors import USUAL_MOUNTING, sensor_places, wear_sensors
from swaystride.simulate.running_tissue import common_tissue, usual_tissue
from swaystride.simulate.running_truth import read_truth, write_truth


def test_poses_events_and_points_come_back_exactly(runs, usual_body, tmp_path):
    motion = runs(3.5, belt_dip=0.02)
    rng = np.random.default_rng(1)
    sensors = wear_sensors(
        usual_body,
        tuple(sensor_places()),
        mounting=USUAL_MOUNTING,
        tissue=usual_tissue(),
        common=common_tissue(rng),
        rng=rng,
    )
    write_truth(tmp_path / "run.npz", motion, {"sensors": sensors.skin})
    found, points = read_truth(tmp_path / "run.npz")
    assert found.body == motion.body
    assert found.duration_s == motion.duration_s
    time = np.linspace(0.0, 20.0, 500)
    ours, theirs = motion.states(time), found.states(time)
    for name in ("position_m", "acceleration_m_s2", "r_world_from_segment", "belt_m_s2"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name))
    np.testing.assert_array_equal(motion.belt_way_m(time), found.belt_way_m(time))
    for side in range(2):
        np.testing.assert_array_equal(motion.contacts_s(side)[0], found.contacts_s(side)[0])
    np.testing.assert_array_equal(
        true_positions(motion, sensors.skin, time), true_positions(found, points["sensors"], time)
    )


def test_truth_of_half_an_hour_is_small(runs, tmp_path):
    path = tmp_path / "run.npz"
    write_truth(path, runs(3.0, duration_s=60.0, belt_dip=0.02))
    assert path.stat().st_size * 30 < 25e6


@pytest.mark.parametrize("content", [b"", b"not a file"])
def test_another_file_is_refused(tmp_path, content):
    path = tmp_path / "run.npz"
    path.write_bytes(content)
    with pytest.raises(RecordingError, match=r"run\.npz"):
        read_truth(path)
