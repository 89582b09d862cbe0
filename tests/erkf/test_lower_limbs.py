"""Known truth of the rigid chain; signs of left and right; bad input."""

from dataclasses import replace

import numpy as np
import pytest
from rigid_chain import RUNNING, chain
from scipy.spatial.transform import Rotation

from swaystride.erkf.lower_limbs import estimate_lower_limbs
from swaystride.erkf.noise import RECOMMENDED_NOISE, WALKING, NoiseSet
from swaystride.erkf.options import PRINTED_OPTIONS, RECOMMENDED_OPTIONS
from swaystride.erkf.start import START_AT_REST, StartUncertainty
from swaystride.errors import RecordingError
from swaystride.recording import make_recording
from swaystride.units import RAD_PER_DEG

EXACT = StartUncertainty(1e-6, 1e-6, 1e-6, 1e-6, 1e-6)
ROUGH = StartUncertainty(0.005, 0.02, 0.02, 0.02, 0.5 * RAD_PER_DEG)
TWELVE = replace(PRINTED_OPTIONS, gyro_bias=True)


def with_errors(exact, acc_sd, gyr_sd, seed=3):
    """White noise, and a bias of 0.5 °/s on every axis."""
    rng = np.random.default_rng(seed)
    bias = 0.5 * RAD_PER_DEG * rng.choice([-1, 1], size=(7, 3, 1))
    return replace(
        exact,
        acc=exact.acc + acc_sd * rng.normal(size=exact.acc.shape),
        gyr=exact.gyr + gyr_sd * rng.normal(size=exact.gyr.shape) + bias,
    )


def matched(acc_sd, gyr_sd, rate_hz, acc_share=0.0, gyr_share=0.0):
    """Noise of the sensors, and constraints that are nearly exact, as they are in the chain."""
    return NoiseSet(
        reference_rate_hz=rate_hz,
        acc_sd_m_s2=acc_sd,
        gyr_sd_rad_s=gyr_sd,
        gyr_bias_walk_rad_s_rts=1e-6,
        acc_step_share=acc_share,
        gyr_step_share=gyr_share,
        zero_velocity_sd_m_s=1e-3,
        contact_lever_sd_m=0.02,
        tilt_sd=0.03,
        hip_centre_sd_m=1e-3,
        knee_centre_sd_m=1e-3,
        ankle_centre_sd_m=1e-3,
        hip_axis_sd=None,
        knee_axis_sd=1e-3,
    )


def estimated(moving, noise, options, start, method="filter"):
    return estimate_lower_limbs(
        moving.recording(),
        moving.body,
        moving.stance,
        noise,
        start=start,
        options=options,
        method=method,
    )


def errors_deg(found, moving):
    angles = found["joint_angle"].transpose("time", "joint", "angle").to_numpy()
    return (angles - moving.angles) / RAD_PER_DEG


def rms(values):
    return np.sqrt(np.mean(np.square(values)))


def test_exact_start_and_perfect_signals(walk):
    found = estimated(walk, WALKING, PRINTED_OPTIONS, walk.start(EXACT))
    assert rms(errors_deg(found, walk)) <= 0.05


@pytest.mark.parametrize(
    ("options", "method", "limit_deg"),
    [(PRINTED_OPTIONS, "filter", 1.0), (TWELVE, "filter", 0.3), (TWELVE, "smoother", 0.1)],
)
def test_noise_bias_and_a_wrong_start(walk, options, method, limit_deg):
    acc_sd, gyr_sd = 0.014, 0.07 * RAD_PER_DEG
    noisy = with_errors(walk, acc_sd, gyr_sd)
    noise = WALKING if options is PRINTED_OPTIONS else matched(acc_sd, gyr_sd, 100.0)
    start = noisy.start(ROUGH, 2.0 * RAD_PER_DEG, seed=5)
    assert rms(errors_deg(estimated(noisy, noise, options, start, method), noisy)) <= limit_deg


@pytest.mark.parametrize("method", ["filter", "smoother"])
def test_band_holds_the_truth_of_every_joint(walk, method):
    acc_sd, gyr_sd = 0.1, 1.0 * RAD_PER_DEG
    noisy = with_errors(walk, acc_sd, gyr_sd)
    start = noisy.start(ROUGH, 2.0 * RAD_PER_DEG, seed=5)
    found = estimated(noisy, matched(acc_sd, gyr_sd, 100.0), TWELVE, start, method)
    sd_deg = found["joint_angle_sd"].transpose("time", "joint", "angle").to_numpy() / RAD_PER_DEG
    within = np.abs(errors_deg(found, noisy)) <= 1.96 * sd_deg
    assert 0.90 <= within.mean() <= 0.98
    # the constant heading error of two segments makes single angles of one walk vary more
    assert within.mean(axis=0).min() > 0.8


def drawn(exact, acc_sd, gyr_sd, rng):
    """Noise, bias and start, all drawn from the distributions that the filter is told."""
    sd = ROUGH
    bias = sd.gyr_bias_rad_s * rng.normal(size=(7, 3, 1))
    turn = rng.normal(size=(7, 3)) * [sd.tilt_rad, sd.tilt_rad, sd.heading_rad]
    turned = Rotation.from_rotvec(turn) * Rotation.from_matrix(exact.rotation[0])
    start = replace(
        exact.start(ROUGH),
        position_m=exact.position[0] + sd.position_m * rng.normal(size=(7, 3)),
        velocity_m_s=exact.velocity[0] + sd.velocity_m_s * rng.normal(size=(7, 3)),
        q_world_from_sensor=turned.as_quat(scalar_first=True),
    )
    noisy = replace(
        exact,
        acc=exact.acc + acc_sd * rng.normal(size=exact.acc.shape),
        gyr=exact.gyr + gyr_sd * rng.normal(size=exact.gyr.shape) + bias,
    )
    return noisy, start


def coverage(exact, acc_sd, gyr_sd, method, shares, seeds):
    """Share of the samples whose 95 % band holds the truth, by angle, over seeds."""
    noise = matched(acc_sd, gyr_sd, exact.rate_hz, *shares)
    found = []
    for seed in range(seeds):
        noisy, start = drawn(exact, acc_sd, gyr_sd, np.random.default_rng(seed))
        result = estimated(noisy, noise, TWELVE, start, method)
        sd_rad = result["joint_angle_sd"].transpose("time", "joint", "angle").to_numpy()
        within = np.abs(errors_deg(result, noisy)) <= 1.96 * sd_rad / RAD_PER_DEG
        found.append(within.mean(axis=0))
    return np.mean(found, axis=0)


@pytest.fixture(scope="module")
def short_walk():
    return chain(duration_s=9.0, rate_hz=100.0)


@pytest.fixture(scope="module")
def short_run():
    return chain(RUNNING, duration_s=5.0, rate_hz=200.0)


RECOMMENDED_SHARES = (RECOMMENDED_NOISE.acc_step_share, RECOMMENDED_NOISE.gyr_step_share)


@pytest.mark.parametrize("method", ["filter", "smoother"])
@pytest.mark.parametrize("manner", ["short_walk", "short_run"])
def test_band_of_every_angle_where_noise_decides(manner, method, request):
    """Over 20 seeds of 15 s every angle was held at 95 to 100 % of the samples: rather too wide."""
    exact = request.getfixturevalue(manner)
    within = coverage(exact, 0.1, 1.0 * RAD_PER_DEG, method, RECOMMENDED_SHARES, 3)
    assert 0.94 <= within.mean() <= 0.995
    assert within.min() > 0.85


@pytest.mark.parametrize("method", ["filter", "smoother"])
@pytest.mark.parametrize("manner", ["short_walk", "short_run"])
def test_band_of_quiet_sensors_needs_the_error_of_integration(manner, method, request):
    """Over 20 seeds of 15 s the angles were held at 81 to 100 %, without shares at 5 to 100 %.

    What a step misses is no noise: it repeats in every stride. So the worst angles (flexions, of
    the smoother in walking) stay below 95 % and others are held always; their errors are 0.02°.
    """
    exact = request.getfixturevalue(manner)
    quiet = (0.014, 0.07 * RAD_PER_DEG)
    within = coverage(exact, *quiet, method, RECOMMENDED_SHARES, 1)
    without = coverage(exact, *quiet, method, (0.0, 0.0), 1)
    assert within.mean() > 0.92
    assert within.min() > 0.70
    assert without.mean() < 0.95
    assert without.min() < within.min() - 0.1


def test_recommended_options_find_the_bias_and_gate_little(walk):
    acc_sd, gyr_sd = 0.014, 0.07 * RAD_PER_DEG
    noisy = with_errors(walk, acc_sd, gyr_sd)
    start = noisy.start(ROUGH, 0.5 * RAD_PER_DEG, seed=5)
    noise = replace(matched(acc_sd, gyr_sd, 100.0), zero_velocity_sd_m_s=0.01)
    found = estimated(noisy, noise, RECOMMENDED_OPTIONS, start, "smoother")
    bias = np.mean(noisy.gyr - walk.gyr, axis=2)
    error = found["gyr_bias"].isel(time=-1).to_numpy() - bias
    assert rms(error) < 0.1 * RAD_PER_DEG
    assert rms(errors_deg(found, noisy)) < 0.2
    assert found["refused"].sum() < 0.02 * found["due"].sum()


def test_recording_and_result_share_names_and_time(walk):
    found = estimated(walk, WALKING, PRINTED_OPTIONS, walk.start(EXACT))
    assert list(found["joint"].to_numpy()[:3]) == ["right_hip", "left_hip", "right_knee"]
    assert found.attrs == {"rate_hz": 100.0, "method": "filter"}
    # the orientation of a segment is that of its sensor times the mounting
    k, j = 40, 3
    q = found["orientation"].isel(segment=j, time=k).to_numpy()
    sensor = found["sensor_orientation"].isel(segment=j, time=k).to_numpy()
    expected = Rotation.from_quat(sensor, scalar_first=True)
    expected *= Rotation.from_matrix(walk.body.r_anatomical_from_sensor[j].T)
    between = expected.inv() * Rotation.from_quat(q, scalar_first=True)
    assert between.magnitude() < 1e-12
    # positions move at the walking speed, through every re-centring
    travelled = found["position"].isel(segment=0, axis=0).to_numpy()
    assert travelled[-1] - travelled[0] == pytest.approx(
        walk.position[-1, 0, 0] - walk.position[0, 0, 0], abs=0.1
    )
    assert np.abs(np.diff(travelled)).max() < 0.05


def test_mirrored_motion_gives_the_same_angles_on_the_other_side():
    """Half a stride later, the left leg does what the right leg did: signs agree."""
    moving = chain(RUNNING, duration_s=3.5, rate_hz=200.0)
    found = estimated(moving, WALKING, PRINTED_OPTIONS, moving.start(EXACT))
    angles = found["joint_angle"] / RAD_PER_DEG
    knees = angles.sel(joint=["right_knee", "left_knee"], angle="flexion")
    assert (knees.max("time") > 60.0).all()
    assert (knees.min("time") > 0.0).all()
    assert rms(errors_deg(found, moving)) < 0.1


def test_neutral_angles_are_subtracted(walk):
    joints = list(walk.body.joints)
    joints[4] = replace(joints[4], neutral_rad=np.array([0.1, 0.0, -0.2]))
    body = replace(walk.body, joints=tuple(joints))
    one, two = (
        estimated(replace(walk, body=b), WALKING, PRINTED_OPTIONS, walk.start(EXACT))
        for b in (walk.body, body)
    )
    change = (one["joint_angle"] - two["joint_angle"]).isel(time=5)
    np.testing.assert_allclose(change.sel(joint="right_ankle"), [0.1, 0.0, -0.2], atol=1e-12)
    assert not change.sel(joint="left_ankle").any()


def call(recording, walk, **changes):
    arguments = {
        "zero_velocity": walk.stance,
        "noise": WALKING,
        "start": walk.start(START_AT_REST),
        "options": PRINTED_OPTIONS,
    } | changes
    return estimate_lower_limbs(recording, walk.body, **arguments)


def test_a_missing_sample_is_an_error_with_sensor_and_time(walk):
    recording = walk.recording().copy(deep=True)
    recording["gyr"][3, 0, 250:280] = np.nan
    with pytest.raises(RecordingError, match=r"right_shank, t = 2\.50 s: .*found 30 missing"):
        call(recording, walk)


def test_one_sensor_per_segment_is_needed(walk):
    six = make_recording(
        rate_hz=100.0,
        rate_source="argument",
        sensors=walk.body.segments[:6],
        acc_m_s2=walk.acc[:6],
        gyr_rad_s=walk.gyr[:6],
    )
    with pytest.raises(RecordingError, match=r"expected pelvis, .*left_foot; found pelvis"):
        call(six, walk)


@pytest.mark.parametrize(
    "changes",
    [
        {"zero_velocity": np.zeros((2, 5), bool)},
        {"zero_velocity": np.zeros((2, 3000))},
        {"still": np.zeros((2, 3000), bool)},
    ],
)
def test_flags_must_fit(walk, changes):
    with pytest.raises(RecordingError, match="does not fit the recording"):
        call(walk.recording(), walk, **changes)


def test_a_start_without_orientation_is_an_error(walk):
    start = replace(walk.start(EXACT), q_world_from_sensor=np.zeros((7, 4)))
    with pytest.raises(RecordingError, match="first sample: the start of the filter"):
        call(walk.recording(), walk, start=start)
