"""Ranges of motion: closed forms, invariances, and simulated runners."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.gait.running_events import RECOMMENDED_EVENTS, SIDES, running_events
from swaystride.gait.segment_ranges import (
    EARLY_STANCE,
    WHOLE_STANCE,
    integrated,
    joint_ranges_deg,
    peak_roll_rates_deg_s,
    periodic_curves,
)
from swaystride.gait.segment_signals import ML, PRINTED_FILTERS, filtered
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.gait.stride_curves import stride_curves

RATE_HZ = 500.0
STRIDES = np.array([[0.1, 0.8], [0.8, 1.5], [1.5, 2.2]])


def swinging(amplitude_deg, n=1200, phase=0.3):
    """Angular rate of a sine of the period of the strides."""
    turn = 2.0 * np.pi / 0.7
    return np.radians(amplitude_deg) * turn * np.cos(turn * np.arange(n) / RATE_HZ + phase)


@settings(max_examples=30)
@given(st.floats(1.0, 60.0), st.floats(-0.5, 0.5), st.floats(0.0, 6.0))
def test_a_sine_has_twice_its_amplitude_whatever_the_bias(amplitude_deg, bias_rad_s, phase):
    rate = swinging(amplitude_deg, phase=phase) + bias_rad_s
    found = joint_ranges_deg(rate, np.zeros(1200), STRIDES[:, 0], STRIDES[:, 1], RATE_HZ)
    assert np.allclose(found, 2.0 * amplitude_deg, rtol=2e-3)


def test_only_the_difference_counts():
    own, common = swinging(20.0), swinging(35.0, phase=1.7)
    args = (STRIDES[:, 0], STRIDES[:, 1], RATE_HZ)
    alone = joint_ranges_deg(own, np.zeros(1200), *args)
    assert np.allclose(joint_ranges_deg(own + common, common, *args), alone)
    assert np.allclose(joint_ranges_deg(common, own + common, *args), alone)


def test_curves_begin_and_end_alike():
    curves = periodic_curves(swinging(20.0) + 0.1, STRIDES[:, 0], STRIDES[:, 1], RATE_HZ)
    assert curves.shape == (3, 101)
    assert np.allclose(curves[:, [0, -1]], 0.0)


def test_a_gap_takes_its_stride():
    rate = swinging(20.0)
    rate[500:520] = np.nan
    found = joint_ranges_deg(rate, np.zeros(1200), STRIDES[:, 0], STRIDES[:, 1], RATE_HZ)
    assert np.isnan(found).tolist() == [False, True, False]
    assert np.allclose(found[[0, 2]], 40.0, rtol=2e-3)
    assert np.isnan(integrated(rate, RATE_HZ)).sum() == 20


def test_segments_of_unequal_length():
    with pytest.raises(RecordingError, match="one length; found 1200 and 1100"):
        joint_ranges_deg(swinging(20.0), np.zeros(1100), [0.1], [0.8], RATE_HZ)


def test_roll_rates_of_either_direction_count():
    strides = pd.DataFrame({"start_s": [0.1, 0.8], "toe_off_s": [0.3, 1.0]})
    roll = np.zeros(1200)
    roll[75], roll[145], roll[420] = -4.0, 9.0, 3.0  # early, late, early
    early, whole = (
        peak_roll_rates_deg_s(roll, strides, RATE_HZ, window)
        for window in (EARLY_STANCE, WHOLE_STANCE)
    )
    assert np.allclose(np.radians(early), [4.0, 3.0])
    assert np.allclose(np.radians(whole), [9.0, 3.0])


def ranges_of(run):
    """Found ranges, and those of the true joint angles and of the rates of the bones."""
    events = running_events(
        {side: run.signals[f"foot_{side}"] for side in SIDES},
        run.signals["lumbar"],
        rate_hz=run.rate_hz,
        rule=RECOMMENDED_EVENTS,
    )
    strides = running_strides(events, RUNNING_STRIDES)
    names = ("lumbar", "thigh_right", "thigh_left", "shank_right", "shank_left")
    worn = [filtered(run.signals[n], run.rate_hz, PRINTED_FILTERS).gyr_rad_s[ML] for n in names]
    for k, side in enumerate(SIDES):
        own = strides[(strides["side"] == side) & strides["is_valid"]]
        edges = own["start_s"].to_numpy(), own["stop_s"].to_numpy()
        for joint, distal, proximal in (("hip", 1 + k, 0), ("knee", 3 + k, 1 + k)):
            angle = run.joint_angles_rad[f"{joint}_{side}"][:, 0]
            curves = np.degrees(stride_curves(angle, *(run.rate_hz * e for e in edges)))
            yield (
                joint_ranges_deg(worn[distal], worn[proximal], *edges, run.rate_hz).mean(),
                joint_ranges_deg(
                    run.rate_z[distal], run.rate_z[proximal], *edges, run.rate_hz
                ).mean(),
                np.ptp(curves, axis=1).mean(),
            )


@pytest.mark.parametrize("speed_km_h", [12.0, 14.0])
def test_sensors_on_bone_see_the_range_of_the_bones(thirteen_imus, speed_km_h):
    """What remains to the joint angle: three-dimensional turning that one rate cannot see."""
    for found, of_rates, of_angle in ranges_of(thirteen_imus(speed_km_h, tissue=False)):
        assert abs(found - of_rates) < 1.0
        assert abs(found - of_angle) < 4.0


@pytest.mark.parametrize("speed_km_h", [12.0, 14.0])
def test_soft_tissue_costs_some_degrees(thirteen_imus, speed_km_h):
    for found, of_rates, of_angle in ranges_of(thirteen_imus(speed_km_h)):
        assert abs(found - of_rates) < 3.0
        assert abs(found - of_angle) < 5.0
