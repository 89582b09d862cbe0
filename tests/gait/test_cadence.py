import numpy as np
import pytest
from closed_form_walk import walk

from swaystride.gait.cadence import local_stride_s
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.stillness import stillness_rad_s


@pytest.mark.parametrize(
    ("stride_s", "stance_s"), [(0.46, 0.1), (0.7, 0.2), (1.1, 0.4), (1.6, 0.7)]
)
@pytest.mark.parametrize("rate_hz", [62.5, 200.0, 1000.0])
def test_one_stride_is_found_and_not_two(stride_s, stance_s, rate_hz):
    own = walk(n_strides=20, stride_s=stride_s, stance_s=stance_s, roll_rad_s=0.5, rate_hz=rate_hz)
    movement = stillness_rad_s(
        own.acc,
        own.gyr,
        rate_hz,
        window_s=RECOMMENDED.stillness_window_s,
        acc_m_s2_per_rad_s=RECOMMENDED.stillness_acc_m_s2_per_rad_s,
    )
    centre_s, found_s = local_stride_s(movement, rate_hz)
    inside = (centre_s > 1.5 + 2.0) & (centre_s < 1.5 + 20 * stride_s - 2.0)
    assert inside.any()
    assert np.allclose(found_s[inside], stride_s, atol=0.03)


@pytest.mark.parametrize("rate_hz", [59.8, 99.8, 100.6, 119.5, 148.15, 256.7, 1259.26])
def test_any_measured_rate_will_do(rate_hz):
    time = np.arange(round(20 * rate_hz)) / rate_hz
    _, stride_s = local_stride_s(1.5 + np.cos(2 * np.pi * time / 0.7), rate_hz)
    assert np.allclose(stride_s, 0.7, atol=0.02)


def test_noise_has_no_rhythm_and_a_short_recording_no_window():
    noise = 1.0 + 0.2 * np.random.default_rng(3).random(3000)
    _, found_s = local_stride_s(noise, 100.0)
    assert np.isnan(found_s).all()
    assert local_stride_s(np.ones(100), 100.0)[1].size == 0
