"""Axes of thirteen sensors from standing and walking: simulated people, closed forms, wrong sensors."""

from dataclasses import replace

import numpy as np
import pytest

from import_graph import REPOSITORY
from swaystride.configuration import load_yaml, plain_values
from swaystride.errors import RecordingError
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.sensor_alignment import (
    STANDING_AND_WALKING,
    SensorAlignment,
    align_sensors,
    alignment_findings,
)
from swaystride.rotations import exp_map
from swaystride.signals.segment_alignment import MainAxis
from swaystride.simulate import imu_design_parameters
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import RunnerManner
from swaystride.simulate.running_recording import recorded
from swaystride.simulate.running_sensors import (
    R_NOMINAL_FROM_SEGMENT,
    USUAL_MOUNTING,
    sensor_places,
    wear_sensors,
)
from swaystride.simulate.running_standing import StandingManner, standing_motion
from swaystride.simulate.running_tissue import common_tissue, usual_tissue
from swaystride.simulate.running_walk import walk_motion
from swaystride.units import GRAVITY_M_S2

RATE_HZ = 200.0
NAMES = tuple(sensor_places())
LEGS = [name for name in NAMES if name.split("_")[0] in ("thigh", "shank", "foot")]
MOUNTING = dict.fromkeys(NAMES, R_NOMINAL_FROM_SEGMENT.T)


def angle_deg(one, two):
    return np.degrees(np.arccos(np.clip(one @ two, -1.0, 1.0)))


@pytest.fixture(scope="module")
def calibrations():
    """Standing and walking of a simulated person, the true mountings and verticals of segments."""
    tree = load_yaml(REPOSITORY / "config" / "studies" / "imu_design.yaml")
    walks = imu_design_parameters.cohort_from_config(plain_values(tree["simulation"]))
    rng = np.random.default_rng(11)
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    manner = StandingManner(
        segment_sd_rad=np.radians(4.0),
        feet_apart_m=0.2,
        feet_sd_m=0.02,
        toe_out_rad=np.radians(7.0),
        toe_out_sd_rad=np.radians(3.0),
        knee_rad=np.radians(7.0),
        knee_sd_rad=np.radians(3.0),
        elbow_rad=np.radians(12.0),
        sway_m=0.003,
    )
    stand = standing_motion(body, manner, duration_s=6.0, rng=rng)
    course = replace(walks.course, distance_m=12.0)
    walk = walk_motion(body, RunnerManner(), 1.3, course=course, scatter=walks.stride, rng=rng)
    worn = wear_sensors(
        body,
        NAMES,
        mounting=USUAL_MOUNTING,
        tissue=usual_tissue(),
        common=common_tissue(rng),
        rng=rng,
    )
    signals = []
    for motion in (stand, walk):
        (chunk,) = recorded(motion, worn, rate_hz=RATE_HZ, rng=rng, chunk_s=100.0)
        pairs = zip(NAMES, chunk.acc_m_s2, chunk.gyr_rad_s, strict=True)
        signals.append({name: SegmentSignals(acc, gyr) for name, acc, gyr in pairs})
    poses = stand.states([3.0]).r_world_from_segment[0]
    mountings = {
        name: unit.r_sensor_from_body for name, unit in zip(NAMES, worn.units, strict=True)
    }
    up = {name: poses[sensor_places()[name].segment].T[:, 2] for name in NAMES}
    return (*signals, mountings, up)


def aligned(standing, walking, mounting=MOUNTING):
    return align_sensors(standing, walking, mounting, rate_hz=RATE_HZ, rule=STANDING_AND_WALKING)


def turned(signals, rotation):
    return SegmentSignals(rotation @ signals.acc_m_s2, rotation @ signals.gyr_rad_s)


def test_axes_of_a_simulated_person(calibrations):
    """Up within the bias of an accelerometer (20 mg, 1.1° per axis), right within some degrees."""
    standing, walking, mountings, up = calibrations
    found = aligned(standing, walking)
    assert list(found) == list(NAMES)
    for name, alignment in found.items():
        r_found_from_segment = alignment.r_anatomical_from_sensor @ mountings[name]
        assert np.allclose(r_found_from_segment @ r_found_from_segment.T, np.eye(3), atol=1e-9)
        assert angle_deg(r_found_from_segment[1], up[name]) < 4.0, name
        limit = 10.0 if name.startswith("thigh") else 6.0
        right = angle_deg(r_found_from_segment[2], np.array([0.0, 0.0, 1.0]))
        assert right < (limit if name in LEGS else 25.0), name
        assert (alignment.main is not None) == (name in LEGS)
    assert alignment_findings(found, STANDING_AND_WALKING, file="walk.h5") == []


def test_another_mounting_changes_the_axes_of_the_sensor_only(calibrations):
    """Legs strapped on otherwise by 40°, which nobody said: their signals come out as before."""
    standing, walking, _, _ = calibrations
    found = aligned(standing, walking)
    twist = exp_map(np.radians(40.0) * np.array([0.0, 0.0, 1.0]))
    other = aligned(
        standing | {name: turned(standing[name], twist) for name in LEGS},
        walking | {name: turned(walking[name], twist) for name in LEGS},
    )
    for name in LEGS:
        again = other[name].r_anatomical_from_sensor @ twist
        assert np.allclose(again, found[name].r_anatomical_from_sensor, atol=1e-4)


def test_signals_keep_their_precision_and_size(calibrations):
    standing, walking, _, _ = calibrations
    found = aligned(standing, walking)["shank_right"].turned(standing["shank_right"])
    assert found.acc_m_s2.dtype == np.float32
    assert np.allclose(
        np.linalg.norm(found.acc_m_s2, axis=0),
        np.linalg.norm(standing["shank_right"].acc_m_s2, axis=0),
        rtol=1e-5,
    )
    assert found.acc_m_s2.mean(axis=1)[1] == pytest.approx(GRAVITY_M_S2, abs=0.5)


@pytest.mark.parametrize("name", ["lumbar", "foot_left", "head"])
def test_a_sensor_that_is_turned_over(calibrations, name):
    standing, walking, _, _ = calibrations
    over = np.diag([1.0, -1.0, -1.0])
    changed = {name: turned(standing[name], over)}
    with pytest.raises(
        RecordingError, match=rf"{name}: the sensor is not mounted as said; .* within 60°"
    ):
        aligned(standing | changed, walking | {name: turned(walking[name], over)})


def test_a_shank_sensor_that_faces_backwards(calibrations):
    standing, walking, _, _ = calibrations
    back = np.diag([-1.0, -1.0, 1.0])
    with pytest.raises(RecordingError, match="shank_left: movement and mounting disagree"):
        aligned(
            standing | {"shank_left": turned(standing["shank_left"], back)},
            walking | {"shank_left": turned(walking["shank_left"], back)},
        )


def test_no_walking_and_a_missing_sensor(calibrations):
    standing, walking, _, _ = calibrations
    with pytest.raises(RecordingError, match="no walking to find the medio-lateral axis"):
        aligned(standing, {})
    # trunk, head and arms need none
    upper = {name: standing[name] for name in ("lumbar", "sternum", "head", "wrist_left")}
    whole = aligned(standing, walking)
    for name, alignment in aligned(upper, {}).items():
        frame = alignment.r_anatomical_from_sensor
        assert np.allclose(frame, whole[name].r_anatomical_from_sensor, atol=0.05)
    # without its shank a thigh takes its side from the mounting
    lame = {name: signals for name, signals in standing.items() if name != "shank_right"}
    thigh = aligned(lame, walking)["thigh_right"].r_anatomical_from_sensor
    assert np.allclose(thigh, whole["thigh_right"].r_anatomical_from_sensor, atol=0.05)
    with pytest.raises(RecordingError, match="head: no mounting is known"):
        aligned(upper, {}, {name: MOUNTING[name] for name in upper if name != "head"})


def still(n, name="lumbar"):
    up = R_NOMINAL_FROM_SEGMENT[:, 1]
    acc = np.repeat(GRAVITY_M_S2 * up[:, None], n, axis=1)
    return {name: SegmentSignals(acc, np.zeros((3, n)))}


def test_the_quietest_part_of_standing_is_taken():
    """Somebody leans over before and after: the still part in between decides."""
    standing = still(2000)
    signals = standing["lumbar"]
    lean = exp_map(np.array([0.0, 0.4, 0.0]))
    for part in (slice(0, 600), slice(1400, 2000)):
        signals.acc_m_s2[:, part] = lean @ signals.acc_m_s2[:, part]
        signals.gyr_rad_s[1, part] = 0.3
    found = aligned(standing, {})["lumbar"].r_anatomical_from_sensor
    assert np.allclose(found, R_NOMINAL_FROM_SEGMENT.T, atol=1e-9)


def test_standing_that_is_too_short():
    with pytest.raises(RecordingError, match=r"3 s without missing samples; found 2\.5 s"):
        aligned(still(500), {})
    holed = still(1000)
    holed["lumbar"].acc_m_s2[:, ::400] = np.nan
    with pytest.raises(RecordingError, match="3 samples missing"):
        aligned(holed, {})


def test_doubtful_axes_are_findings():
    axis = np.array([0.0, 0.0, 1.0])
    weak = SensorAlignment(np.eye(3), MainAxis(axis, 0.75, 0.1, 0.01))
    slanted = SensorAlignment(np.eye(3), MainAxis(axis, 0.9, 0.3, 0.01))
    found = alignment_findings(
        {
            "thigh_left": weak,
            "shank_left": weak,
            "foot_left": slanted,
            "head": SensorAlignment(np.eye(3), None),
        },
        STANDING_AND_WALKING,
        file="walk.h5",
    )
    assert [(f.check, f.place, f.found) for f in found] == [
        ("main_axis_weak", "shank_left", "75 % of the rate about one axis"),
        ("main_axis_not_horizontal", "foot_left", "17°"),
    ]
