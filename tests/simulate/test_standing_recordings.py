"""One recorded trial of any duration: its length, its truth, its losses."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.io.reading import read_recording
from swaystride.signals.filters import butterworth_lowpass
from swaystride.simulate.inertial_sensor import MTX, draw_unit
from swaystride.simulate.loss_of_balance import LossOfBalance
from swaystride.simulate.standing_body import StandingParameters, lean_angles_deg
from swaystride.simulate.standing_model import TrialSettings
from swaystride.simulate.standing_recordings import (
    lost_packets,
    standing_motion,
    true_loss_times,
    true_measures,
    true_sway,
    write_standing_recording,
)
from swaystride.simulate.worn_sensor import RadioLoss, SensorPlacement
from swaystride.sway.metrics import sway_metrics

TRIAL = TrialSettings(
    simulation_rate_hz=1000.0,
    warm_up_s=20.0,
    duration_s=30.0,
    rate_hz=100.0,
    cutoff_hz=3.0,
    filter_order=2,
    filter_pad_s=3.0,
)
BODY = StandingParameters(
    mass_kg=70.0,
    pendulum_height_m=0.9,
    inertia_factor=1.1,
    stiffness_ratio=1.20,
    damping_nm_s_rad=220.0,
    delay_s=0.14,
    noise_ap_nm=9.0,
    noise_ml_nm=8.0,
    noise_time_s=0.7,
    noise_coupling=0.0,
    lean_drift_deg=0.2,
    lean_drift_period_s=60.0,
    breathing_deg=0.05,
    breathing_hz=0.25,
)
RAIL = LossOfBalance(6.0, 0.3, 0.5, largest_deg=20.0, catch_s=1.0)
PLACEMENT = SensorPlacement(0.523, 0.6, 0.1, tilt_sd_deg=0.0, heading_sd_deg=0.0)
RADIO = RadioLoss(
    n_lost_trials=0,
    hole_share=0.5,
    hole_s=(2.0, 8.0),
    end_fraction=(0.3, 0.9),
    few_packets_share=0.0,
    few_packets=3,
)
#: A sensor whose noise and errors vanish beside its smallest step.
IDEAL = replace(
    MTX,
    acc_noise_density_m_s2_rthz=0.0,
    gyr_noise_density_deg_s_rthz=0.0,
    acc_bias_sd_m_s2=0.0,
    gyr_bias_sd_deg_s=0.0,
    scale_error=0.0,
    misalignment_sd_deg=0.0,
    acc_adc_bits=24,
    gyr_adc_bits=24,
)


def write(path, motion, *, radio=RADIO, link_lost=False):
    return write_standing_recording(
        path,
        motion,
        height_m=1.7,
        placement=PLACEMENT,
        sensor=IDEAL,
        unit=draw_unit(IDEAL, tilt_sd_deg=0.0, heading_sd_deg=0.0, rng=np.random.default_rng(0)),
        trial=TRIAL,
        radio=radio,
        link_lost=link_lost,
        rng=np.random.default_rng(1),
    )


@pytest.mark.parametrize("duration_s", [None, 30.0, 12.34, 4.0])
def test_a_trial_is_as_long_as_asked(tmp_path, duration_s):
    motion = standing_motion(BODY, TRIAL, np.random.default_rng(2), duration_s=duration_s)
    n_samples = round((duration_s or 30.0) * 100)
    ap, ml = true_sway(motion, TRIAL)
    assert ap.shape == ml.shape == (n_samples,)
    file = tmp_path / "new" / "P01.txt"
    assert write(file, motion) == {"radio": "complete", "n_lost_packets": 0}
    assert read_recording(file).sizes["time"] == n_samples


def test_the_truth_is_that_of_the_samples_in_the_file(tmp_path):
    rng = np.random.default_rng(3)
    motion = standing_motion(BODY, TRIAL, rng, duration_s=20.0, loss_of_balance=RAIL)
    assert len(true_loss_times(motion, TRIAL)) > 0
    write(tmp_path / "P01.txt", motion)
    gyr = read_recording(tmp_path / "P01.txt")["gyr"].to_numpy()[0]
    # The pitch rate is the derivative of the true angle, here by differences over 20 ms; a file
    # that began a sample earlier or later would fit it much worse.
    ap, ml = true_sway(motion, TRIAL)
    pitch_rate = np.rad2deg(gyr[1]) / np.cos(np.deg2rad(ml))
    differences = np.gradient(ap, 0.01)
    misfit = [np.std((np.roll(pitch_rate, shift) - differences)[5:-5]) for shift in (-1, 0, 1)]
    assert misfit[1] < 0.6 * min(misfit[0], misfit[2])
    assert np.corrcoef(pitch_rate, differences)[0, 1] > 0.999


def test_measures_are_those_of_the_filtered_true_sway():
    motion = standing_motion(BODY, TRIAL, np.random.default_rng(4), duration_s=25.0)
    ap, ml = (
        butterworth_lowpass(
            angle, cutoff_hz=3.0, rate_hz=100.0, order=2, direction="zero_lag", pad_s=3.0
        )
        for angle in true_sway(motion, TRIAL)
    )
    assert true_measures(motion, TRIAL) == pytest.approx(sway_metrics(ap, ml, 100.0), rel=1e-12)


def test_loss_times_point_into_the_recording():
    found = 0
    for seed in range(10):
        rng = np.random.default_rng(seed)
        motion = standing_motion(BODY, TRIAL, rng, duration_s=15.0, loss_of_balance=RAIL)
        inclination = np.hypot(*lean_angles_deg(motion.angle_rad))
        ap, ml = true_sway(motion, TRIAL)
        for time_s in true_loss_times(motion, TRIAL):
            found += 1
            assert 0.0 <= time_s <= 14.99
            # Drift and breathing add up to 0.4° to the inclination that decides.
            assert np.hypot(ap, ml)[int(time_s * 100)] == pytest.approx(6.0, abs=0.6)
            assert inclination[round(time_s * 1000) + 100] == pytest.approx(6.0, abs=0.6)
    assert found > 3


def test_losses_beside_the_recording_are_not_counted():
    motion = standing_motion(BODY, TRIAL, np.random.default_rng(5), duration_s=10.0)
    # The filter reaches 0.1 s to both sides; the last sample is at 9.99 s.
    motion = replace(motion, loss_times_s=(0.0, 0.0995, 0.1, 4.1, 10.09, 10.0905, 10.19))
    assert true_loss_times(motion, TRIAL) == pytest.approx((0.0, 4.0, 9.99))


@pytest.mark.parametrize("n_samples", [150, 500, 3000])
def test_what_the_radio_loses_fits_into_the_trial(n_samples):
    kinds = set()
    for seed in range(60):
        radio = replace(RADIO, few_packets_share=0.5)
        kind, lost = lost_packets(
            n_samples, 100.0, radio, link_lost=seed % 2 == 0, rng=np.random.default_rng(seed)
        )
        kinds.add(kind)
        runs = np.flatnonzero(np.diff(np.concatenate([[0], lost.astype(int), [0]])))
        lengths = runs[1::2] - runs[::2]
        assert not lost[0]
        if kind == "hole":
            assert not lost[-1]
            assert lengths.size == 1
            assert min(200, n_samples - 2) <= lengths[0] <= 800
        elif kind == "ends early":
            assert runs[-1] == n_samples
            assert 0.09 * n_samples <= lengths[0] <= 0.71 * n_samples
        elif kind == "few packets":
            assert not lost[-1]
            assert set(lengths) == {1}
            assert 1 <= lengths.size <= 3
        else:
            assert not lost.any()
    assert kinds == {"hole", "ends early", "few packets", "complete"}
