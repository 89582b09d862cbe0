"""Peaks and attenuation: closed forms, missing sensors, and perfect sensors at the same points."""

import numpy as np
import pandas as pd
import pytest

from swaystride.errors import RecordingError
from swaystride.gait.impact_peaks import (
    ATTENUATION_COLUMNS,
    IMPACT_WINDOW,
    PEAK_COLUMNS,
    impact_peaks,
    per_body_mass,
)
from swaystride.gait.running_events import SIDES
from swaystride.gait.segment_signals import PRINTED_FILTERS, VERTICAL, lowpassed_parts
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.units import GRAVITY_M_S2

RATE_HZ = 500.0


def peaks_of(strides, along, rate_hz=RATE_HZ):
    return impact_peaks(
        strides,
        shank_acc_m_s2={side: along[f"shank_{side}"] for side in SIDES},
        pelvis_acc_m_s2=along.get("lumbar"),
        head_acc_m_s2=along.get("head"),
        rate_hz=rate_hz,
        window=IMPACT_WINDOW,
    )


def closed_form():
    """Steps every 0.35 s with shank peaks of 6, 10, 6, ... g, pelvis of 3 g, head of 2 g."""
    strides = pd.DataFrame(
        {"side": ["right", "left"] * 4, "start_s": 0.5 + 0.35 * np.arange(8)}
    ).assign(toe_off_s=lambda table: table["start_s"] + 0.2)
    time = np.arange(round(4.0 * RATE_HZ)) / RATE_HZ

    def pulses(heights_g, delay_s):
        centres = strides["start_s"].to_numpy() + delay_s
        shape = np.exp(-0.5 * ((time[:, None] - centres) / 0.005) ** 2)
        return GRAVITY_M_S2 * (shape @ np.broadcast_to(heights_g, centres.shape))

    right = np.where(strides["side"] == "right", 6.0, 0.0)
    left = np.where(strides["side"] == "left", 10.0, 0.0)
    along = {
        "shank_right": pulses(right, 0.02),
        "shank_left": pulses(left, 0.02),
        "lumbar": pulses(3.0, 0.05),
        "head": pulses(2.0, 0.15),
    }
    return strides, along


def test_peaks_and_attenuation_of_each_step():
    strides, along = closed_form()
    found = peaks_of(strides, along)
    assert tuple(found.columns) == PEAK_COLUMNS + ATTENUATION_COLUMNS
    assert np.allclose(found["peak_tibial_g"], [6.0, 10.0] * 4, rtol=1e-3)
    assert np.allclose(found["peak_pelvic_g"], 3.0, rtol=1e-3)
    assert np.allclose(found["peak_head_g"], 2.0, rtol=1e-3)
    assert np.allclose(found["attenuation_shank_pelvis"], [0.5, 0.7] * 4, atol=1e-3)
    assert np.allclose(found["attenuation_pelvis_head"], 1.0 / 3.0, atol=1e-3)
    # per step, then averaged: not the attenuation of the averages
    mean = found["attenuation_shank_pelvis"].mean()
    assert mean == pytest.approx(0.6, abs=1e-3)
    of_means = 1.0 - found["peak_pelvic_g"].mean() / found["peak_tibial_g"].mean()
    assert of_means == pytest.approx(0.625, abs=1e-3)


def test_scale_leaves_attenuation_alone():
    strides, along = closed_form()
    once, thrice = (peaks_of(strides, {k: f * v for k, v in along.items()}) for f in (1.0, 3.0))
    assert np.allclose(3.0 * once[list(PEAK_COLUMNS)], thrice[list(PEAK_COLUMNS)])
    assert np.allclose(once[list(ATTENUATION_COLUMNS)], thrice[list(ATTENUATION_COLUMNS)])


def test_a_head_sensor_that_is_missing_takes_only_its_own_values():
    strides, along = closed_form()
    whole = peaks_of(strides, along)
    along.pop("head")
    found = peaks_of(strides, along)
    gone = ["peak_head_g", "attenuation_pelvis_head", "attenuation_shank_head"]
    assert found[gone].isna().all(axis=None)
    pd.testing.assert_frame_equal(found.drop(columns=gone), whole.drop(columns=gone))


def test_lost_samples_take_their_steps():
    strides, along = closed_form()
    along["lumbar"][round(0.56 * RATE_HZ)] = np.nan
    found = peaks_of(strides, along)
    assert found["peak_pelvic_g"].isna().tolist() == [True] + [False] * 7


def test_a_missing_shank_and_a_body_without_mass():
    strides, along = closed_form()
    with pytest.raises(
        RecordingError, match=r"left shank: a shank sensor is missing; .* found right"
    ):
        impact_peaks(
            strides,
            shank_acc_m_s2={"right": along["shank_right"]},
            pelvis_acc_m_s2=None,
            head_acc_m_s2=None,
            rate_hz=RATE_HZ,
            window=IMPACT_WINDOW,
        )
    found = peaks_of(strides, along)
    per_kg = per_body_mass(found, 60.0)
    assert np.allclose(per_kg["peak_tibial_g_per_kg"], found["peak_tibial_g"] / 60.0)
    with pytest.raises(RecordingError, match="kilograms above 0; found nan"):
        per_body_mass(found, float("nan"))


@pytest.mark.parametrize("speed_km_h", [12.0, 14.0])
def test_simulated_peaks_are_those_of_perfect_sensors(thirteen_imus, speed_km_h):
    """After the same filter, per step and on average; without it the tibial peak is higher."""
    run = thirteen_imus(speed_km_h)
    strides = running_strides(run.events, RUNNING_STRIDES)
    strides = strides[strides["is_valid"]]
    sensors = ("shank_right", "shank_left", "lumbar", "head")
    cutoff = PRINTED_FILTERS.acc_cutoff_hz
    worn = {s: lowpassed_parts(run.signals[s].acc_m_s2[VERTICAL], cutoff, 500.0) for s in sensors}
    true = {s: lowpassed_parts(run.ideal[s][VERTICAL], cutoff, 500.0) for s in sensors}
    found, real = peaks_of(strides, worn), peaks_of(strides, true)
    for name in PEAK_COLUMNS:
        assert found[name].mean() == pytest.approx(real[name].mean(), rel=0.02), name
    assert np.allclose(found["peak_tibial_g"], real["peak_tibial_g"], rtol=0.03)
    raw = peaks_of(strides, {s: run.ideal[s][VERTICAL] for s in sensors})
    lost = 1.0 - real["peak_tibial_g"].mean() / raw["peak_tibial_g"].mean()
    assert 0.05 < lost < 0.35
    low, high = found["attenuation_shank_head"].quantile([0.0, 1.0])
    assert 0.3 < low < high < 0.95
