"""What worn sensors record: truth of their point, chunks, ranges, converter, standing still."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.simulate._running_points import segment_states
from swaystride.simulate.inertial_sensor import measure
from swaystride.simulate.running_markers import true_positions
from swaystride.simulate.running_recording import (
    CLIPPING_RATE_HZ,
    SIMULATION_RATE_HZ,
    ideal_signals,
    n_samples,
    near_range,
    recorded,
    with_midpoints,
)
from swaystride.simulate.running_sensors import (
    USUAL_MOUNTING,
    sensor_places,
    wear_sensors,
)
from swaystride.simulate.running_tissue import CHANNELS, common_tissue, usual_tissue
from swaystride.simulate.sampling import filter_reach
from swaystride.units import GRAVITY_M_S2


@pytest.fixture(scope="module")
def sensors(usual_body):
    rng = np.random.default_rng(6)
    return wear_sensors(
        usual_body,
        tuple(sensor_places()),
        mounting=USUAL_MOUNTING,
        tissue=usual_tissue(),
        common=common_tissue(rng),
        rng=rng,
    )


def test_thirteen_places_on_thirteen_segments():
    places = sensor_places()
    assert len(places) == 13
    assert len({place.segment for place in places.values()}) == 13
    high = {name for name, place in places.items() if place.high_range}
    assert high == {"foot_right", "foot_left", "shank_right", "shank_left"}


def test_signals_are_those_of_the_moving_point(runs, sensors):
    motion = runs(3.0, belt_dip=0.02)
    rate = 2000.0
    signals = ideal_signals(motion, sensors.skin, rate, 10000, 400)
    time = (10000 + np.arange(400)) / rate
    step = 2e-5
    places = [true_positions(motion, sensors.skin, time + shift) for shift in (-step, 0.0, step)]
    acceleration = (places[2] - 2 * places[1] + places[0]) / step**2
    _, _, channels, belt = segment_states(motion.tables, time)
    pull = acceleration + np.array([0.0, 0.0, GRAVITY_M_S2])
    pull[..., 0] -= belt[:, None]
    for k in range(13):
        # The acceleration of the point has its size whatever the orientation of the sensor.
        expected = np.linalg.norm(pull[:, k], axis=1)
        error = np.abs(np.linalg.norm(signals[k, :3], axis=0) - expected)
        assert np.median(error) < 1e-4
        assert error.max() < 0.05
    assert channels.shape[1] == 1 + max(max(row) for row in CHANNELS)


def test_tissue_has_about_the_size_that_it_should(runs, sensors):
    motion = runs(3.5)
    time = np.linspace(5.0, 10.0, 4000)
    skin = sensors.skin
    moving = true_positions(motion, skin, time)
    still = true_positions(motion, replace(skin, tissue=0.0 * skin.tissue), time)
    shift = moving - still
    for k, (name, low, high) in enumerate(
        (("lumbar", 1.0, 13.0), ("thigh", 5.0, 40.0), ("thigh", 5.0, 40.0), ("shank", 1.0, 15.0))
    ):
        assert sensors.names[k].startswith(name)
        size = 1e3 * np.ptp(np.linalg.norm(shift[:, k], axis=1))
        assert low < size < high


def test_chunks_join_without_a_seam(runs, sensors):
    motion = runs(3.0)
    whole = ideal_signals(motion, sensors.skin, 2000.0, 0, 3000)
    parts = [ideal_signals(motion, sensors.skin, 2000.0, first, 1000) for first in (0, 1000, 2000)]
    np.testing.assert_array_equal(whole, np.concatenate(parts, axis=2))
    chunks = list(
        recorded(motion, sensors, rate_hz=500.0, rng=np.random.default_rng(1), chunk_s=6.0)
    )
    assert [chunk.first for chunk in chunks] == [0, 3000, 6000, 9000]
    assert sum(chunk.acc_m_s2.shape[2] for chunk in chunks) == n_samples(motion, 500.0) == 10000
    quiet = recorded_without_noise(motion, sensors)
    for chunk in chunks:
        n = chunk.acc_m_s2.shape[2]
        at = slice(chunk.first, chunk.first + n)
        for k, model in enumerate(sensors.models):
            error = chunk.acc_m_s2[k] - quiet[k][0][:, at]
            step = 2 * model.acc_range_m_s2 / 2**model.acc_adc_bits
            noise = model.acc_noise_density_m_s2_rthz * np.sqrt(250.0)
            assert np.std(error) == pytest.approx(np.hypot(noise, step / np.sqrt(12)), rel=0.1)


def recorded_without_noise(motion, sensors):
    reach = filter_reach(SIMULATION_RATE_HZ, 500.0)
    ideal = ideal_signals(motion, sensors.skin, SIMULATION_RATE_HZ, -reach, 39997 + 2 * reach)
    results = []
    for k, (model, unit) in enumerate(zip(sensors.models, sensors.units, strict=True)):
        silent = replace(
            model,
            acc_noise_density_m_s2_rthz=0.0,
            gyr_noise_density_deg_s_rthz=0.0,
            acc_adc_bits=40,
            gyr_adc_bits=40,
        )
        results.append(
            measure(
                silent,
                unit,
                acc_m_s2=ideal[k, :3],
                gyr_rad_s=ideal[k, 3:],
                rate_hz=SIMULATION_RATE_HZ,
                output_rate_hz=500.0,
                rng=np.random.default_rng(0),
            )
        )
    return results


def test_ranges_and_steps_of_the_converter(runs, sensors):
    motion = runs(5.5)
    (chunk,) = recorded(motion, sensors, rate_hz=200.0, rng=np.random.default_rng(2))
    assert chunk.acc_m_s2.dtype == np.float32
    for k, model in enumerate(sensors.models):
        assert np.abs(chunk.acc_m_s2[k]).max() <= model.acc_range_m_s2 * (1 + 1e-6)
        step = 2 * model.acc_range_m_s2 / 2**model.acc_adc_bits
        counts = chunk.acc_m_s2[k].astype(np.float64) / step
        assert np.abs(counts - np.rint(counts)).max() < 1e-2
    feet = [k for k, name in enumerate(sensors.names) if name.startswith("foot")]
    assert np.abs(chunk.acc_m_s2[feet]).max() > 10.0 * GRAVITY_M_S2


def test_a_sensor_near_its_range_clips_at_4_khz(runs, sensors):
    motion = runs(3.0)
    k = sensors.names.index("shank_right")
    # A shank sensor that ends at 60 m/s², about half of its peaks.
    low = replace(sensors.models[k], acc_range_m_s2=60.0)
    models = (*sensors.models[:k], low, *sensors.models[k + 1 :])
    narrow = replace(sensors, models=models)
    usual, clipped = (
        next(recorded(motion, worn, rate_hz=500.0, rng=np.random.default_rng(2)))
        for worn in (sensors, narrow)
    )
    others = np.arange(len(models)) != k
    np.testing.assert_array_equal(clipped.acc_m_s2[others], usual.acc_m_s2[others])
    # Against exact signals at 4 kHz, clipped there.
    reach = filter_reach(CLIPPING_RATE_HZ, 500.0)
    n = 8 * (n_samples(motion, 500.0) - 1) + 1 + 2 * reach
    exact = ideal_signals(motion, sensors.skin, CLIPPING_RATE_HZ, -reach, n)[k]
    expected, turned = measure(
        replace(low, acc_noise_density_m_s2_rthz=0.0, gyr_noise_density_deg_s_rthz=0.0),
        sensors.units[k],
        acc_m_s2=exact[:3],
        gyr_rad_s=exact[3:],
        rate_hz=CLIPPING_RATE_HZ,
        output_rate_hz=500.0,
        rng=np.random.default_rng(0),
    )
    noise = low.acc_noise_density_m_s2_rthz * np.sqrt(250.0)
    assert np.abs(clipped.acc_m_s2[k] - expected).max() < 6 * noise
    noise = np.radians(low.gyr_noise_density_deg_s_rthz) * np.sqrt(250.0)
    assert np.abs(clipped.gyr_rad_s[k] - turned).max() < 6 * noise


def test_signals_at_2_khz_leave_nothing_between_them(runs, sensors):
    motion = runs(3.0)
    coarse = ideal_signals(motion, sensors.skin, 2000.0, 0, 20001)
    exact = ideal_signals(motion, sensors.skin, 4000.0, 0, 40001)
    apart = np.abs(with_midpoints(coarse) - exact)
    largest = np.abs(coarse).max(axis=2)
    assert (np.percentile(apart, 99.5, axis=2) < 1e-3 * largest).all()
    # The acceleration of a joint jumps a little when a foot lands or leaves.
    assert (apart.max(axis=2) < 0.05 * largest).all()
    # Where nothing is near its range, nothing beyond it was missed.
    assert (np.abs(exact).max(axis=2) < 1.02 * largest).all()
    assert not near_range(sensors, 0.5 * coarse).any()
    assert near_range(sensors, 30.0 * coarse).all()


def test_mountings_keep_their_limits(usual_body):
    rng = np.random.default_rng(8)
    for _ in range(20):
        worn = wear_sensors(
            usual_body,
            tuple(sensor_places()),
            mounting=USUAL_MOUNTING,
            tissue={},
            common=common_tissue(rng),
            rng=rng,
        )
        for name, unit in zip(worn.names, worn.units, strict=True):
            # Nominal axes x forward, y left, z up are x, −z, y of the segment.
            nominal = unit.r_sensor_from_body[:, [0, 2, 1]] * [1.0, -1.0, 1.0]
            angle = np.degrees(np.arccos(np.clip((np.trace(nominal) - 1) / 2, -1, 1)))
            assert angle < 26.0
            if name == "lumbar":
                left = nominal[1]
                assert abs(np.degrees(np.arctan2(left[0], left[1]))) < 3.1
        np.testing.assert_array_equal(worn.skin.tissue[:, :4], 0.0)
