"""Markers: places, noise, gaps, laboratory frame, and those that sit on sensors."""

import numpy as np
import pytest

from swaystride.simulate.running_markers import (
    FACE_MARKERS,
    USUAL_CAMERAS,
    filmed,
    marker_places,
    true_positions,
    wear_markers,
)
from swaystride.simulate.running_sensors import USUAL_MOUNTING, sensor_places, wear_sensors
from swaystride.simulate.running_tissue import common_tissue, usual_tissue


@pytest.fixture(scope="module")
def worn(usual_body):
    """Sensors and markers, on skin or on bone."""

    def of(tissue=True, place_sd_m=0.004):
        rng = np.random.default_rng(3)
        common = common_tissue(rng)
        sizes = usual_tissue() if tissue else {}
        sensors = wear_sensors(
            usual_body,
            tuple(sensor_places()),
            mounting=USUAL_MOUNTING,
            tissue=sizes,
            common=common,
            rng=rng,
        )
        return sensors, wear_markers(
            usual_body, sensors, place_sd_m=place_sd_m, tissue=sizes, common=common, rng=rng
        )

    return of


def test_forty_five_markers_of_which_seven_sit_on_sensors(runs, worn):
    sensors, markers = worn()
    assert len(marker_places()) == 38
    assert len(markers.names) == len(set(markers.names)) == 45
    time = np.linspace(3.0, 4.0, 50)
    motion = runs(3.0)
    on_sensors = true_positions(motion, sensors.skin, time)
    on_markers = true_positions(motion, markers.skin, time)
    for sensor, marker in FACE_MARKERS.items():
        np.testing.assert_array_equal(
            on_sensors[:, sensors.names.index(sensor)], on_markers[:, markers.names.index(marker)]
        )


def test_markers_on_bone_are_rigid_and_lead_to_the_hips(runs, worn, usual_body):
    motion = runs(3.0)
    _, markers = worn(tissue=False, place_sd_m=0.0)
    time = np.linspace(2.0, 6.0, 300)
    place = dict(
        zip(
            markers.names,
            np.moveaxis(true_positions(motion, markers.skin, time), 1, 0),
            strict=True,
        )
    )
    for one, other in (("RTHI", "RKNE"), ("LTIB", "LANK"), ("LASI", "RPSI"), ("RHEE", "RTOE")):
        assert np.ptp(np.linalg.norm(place[one] - place[other], axis=1)) < 1e-12
    # Spec §5.3 and §5.4 (Hara et al. 2016) from the pelvis markers, leg length 0.9 m.
    left = place["LASI"] - place["RASI"]
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    back = (place["LPSI"] + place["RPSI"]) / 2 - place["RASI"]
    up = np.cross(left, back)
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    forward = np.cross(left, up)
    middle = (place["LASI"] + place["RASI"]) / 2
    hip = middle + (0.011 - 0.0567) * forward - (0.008 + 0.0774) * left + (-0.009 - 0.0702) * up
    true = motion.states(time).position_m[:, 1]
    assert np.abs(hip - true).max() < 0.003
    ankle = motion.states(time).position_m[:, 5]
    assert np.linalg.norm(place["RANK"] - ankle, axis=1).max() == pytest.approx(0.045, abs=1e-9)


def test_cameras_add_noise_and_gaps_in_the_laboratory(runs, worn):
    motion = runs(3.0, duration_s=60.0, belt_dip=0.02)
    _, markers = worn()
    chunks = list(
        filmed(
            motion,
            markers,
            rate_hz=200.0,
            errors=USUAL_CAMERAS,
            rng=np.random.default_rng(4),
            chunk_s=25.0,
        )
    )
    assert [chunk.first for chunk in chunks] == [0, 5000, 10000]
    film = np.concatenate([chunk.position_m for chunk in chunks])
    assert film.shape == (12000, 45, 3)
    # The runner stays over the belt.
    assert np.nanmax(np.abs(film[..., 0])) < 1.5
    time = np.arange(12000) / 200.0
    truth = true_positions(motion, markers.skin, time)
    truth[..., 0] -= motion.belt_way_m(time)[:, None]
    assert np.nanstd(film - truth) == pytest.approx(0.3e-3, rel=0.01)
    lost = np.isnan(film).any(axis=2)
    assert np.array_equal(lost, np.isnan(film).all(axis=2))
    assert 0.01 < lost.mean() < 0.03
    assert (lost.mean(axis=0) < 0.045).all()
