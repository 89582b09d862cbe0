"""Events and coordination of real runners: sensors, strides and tables on motions made here."""

import numpy as np
import pandas as pd
import pytest

from swaystride.gait.segment_signals import ML, SegmentSignals
from swaystride.gait.vector_coding import ANGULAR_DEVIATION, coordination_variability
from swaystride.lower_limb_joints import SEGMENTS
from swaystride.units import GRAVITY_M_S2
from swaystride.validation.running_coordination import (
    expected_few_strides_ratio,
    few_strides_ratio,
    textbook_variability,
)
from swaystride.validation.running_coordination_published import increments_of_joints
from swaystride.validation.running_increments import (
    increments_from_angles,
    increments_from_rates,
    whole_strides,
)
from swaystride.validation.running_measure_checks import (
    STRIDE_TIME_MS,
    invariance_checks,
    sensor_event_checks,
    wide_coordination,
)
from swaystride.validation.running_measure_figures import figure_coordination, figure_events
from swaystride.validation.running_optical_recording import RUNS
from swaystride.validation.running_sensor_events import (
    METHODS,
    sensor_event_table,
    sensor_strides,
    stride_errors,
)
from swaystride.validation.running_sensors import MarkerSensors, sagittal_angle, sensor_signals

FRAMES_HZ, RATE_HZ = 150.0, 500.0
STRIDE_S = 0.7


def planar(angle):
    """Segments that turn about the axis to the right: forward axis up by `angle`."""
    c, s, zero = np.cos(angle), np.sin(angle), np.zeros_like(angle)
    rows = [[c, -s, zero], [zero, zero, zero - 1.0], [s, c, zero]]
    return np.moveaxis(np.array(rows), 2, 0)


def test_a_sensor_on_a_wheel():
    """Centripetal acceleration and gravity in turning axes, and the rate of the wheel."""
    rate, radius = 7.0, 0.3
    angle = rate * np.arange(300) / FRAMES_HZ
    place = radius * np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    found = sensor_signals(place, planar(angle), FRAMES_HZ, RATE_HZ)
    at = rate * np.arange(found.acc_m_s2.shape[1]) / RATE_HZ
    inside = slice(20, -20)
    expected = [GRAVITY_M_S2 * np.sin(at) - rate**2 * radius, GRAVITY_M_S2 * np.cos(at), 0.0 * at]
    assert np.allclose(found.acc_m_s2[:, inside], np.array(expected)[:, inside], atol=2e-3)
    assert np.allclose(found.gyr_rad_s[:, inside].T, [0.0, 0.0, rate], atol=1e-6)
    assert np.allclose(sagittal_angle(planar(angle), FRAMES_HZ, RATE_HZ), at, atol=1e-9)


def swinging_runner(duration_s=21.0):
    """Segments that swing in the sagittal plane, each with other harmonics and slow changes."""
    time = np.arange(int(duration_s * FRAMES_HZ)) / FRAMES_HZ
    phase = 2.0 * np.pi * time / STRIDE_S
    segments, pitch = {}, {}
    for k, name in enumerate(SEGMENTS):
        drift = 1.0 + 0.1 * np.sin((0.3 + 0.07 * k) * time)
        angle = drift * (0.4 * np.sin(phase + k) + 0.1 * np.sin(2 * phase + 2 * k))
        turns = planar(angle)
        segments[name] = sensor_signals(np.zeros((time.size, 3)), turns, FRAMES_HZ, RATE_HZ)
        pitch[name] = sagittal_angle(turns, FRAMES_HZ, RATE_HZ)
    return MarkerSensors(RUNS[0], segments, pitch, RATE_HZ)


def test_rates_and_angles_tell_the_same_in_one_plane():
    """Changes of angles, but for the drift that is taken away: the angle after a stride differs."""
    start = np.arange(1, 28) * STRIDE_S
    strides = whole_strides(pd.DataFrame({"initial_contact_s": start, "toe_off_s": start + 0.27}))
    runner = swinging_runner()
    rates, angles = (
        f(runner, "left", strides) for f in (increments_from_rates, increments_from_angles)
    )
    for segment, steps in rates.items():
        assert steps.shape == (26, 200)
        left = steps - angles[segment]
        part = np.r_[np.full(100, 0.27), np.full(100, STRIDE_S - 0.27)] / 100 / STRIDE_S
        drift = angles[segment].sum(axis=1)[:, None] * part
        assert np.allclose(left, -drift, atol=0.003)
        assert np.abs(angles[segment]).max() > 0.5


def test_a_missing_contact_makes_no_stride():
    contacts = pd.DataFrame(
        {"initial_contact_s": [0.0, 0.7, 2.1, 2.8], "toe_off_s": [0.3, 1, 2.4, 3]}
    )
    assert whole_strides(contacts)["start_s"].tolist() == [0.0, 2.1]


def scattered(n=40, scatter=0.05, seed=3):
    """Changes of four segments about a mean that turns from interval to interval."""
    rng = np.random.default_rng(seed)
    turn = np.linspace(0.0, 9.0, 200)
    return {
        segment: np.cos(turn + k) + scatter * rng.standard_normal((n, 200))
        for k, segment in enumerate(("pelvis", "thigh", "shank", "foot"))
    }


def test_the_formula_by_other_means():
    steps = scattered()
    ours = coordination_variability(steps, ANGULAR_DEVIATION)
    assert textbook_variability(steps) == pytest.approx(ours, abs=1e-9)


def test_few_strides_look_alike():
    """The mean of a standard deviation, for normal scatter; nothing for as many as there are."""
    for n in (40, 25):
        steps = scattered(n)
        assert few_strides_ratio(steps) == pytest.approx(expected_few_strides_ratio(n), abs=0.01)
    assert few_strides_ratio(scattered(15)) == pytest.approx(1.0, abs=1e-12)


def test_segments_from_joints():
    """A known thigh, shank and foot, given as hip, knee and ankle, come back."""
    phase = np.linspace(0.0, 1.0, 2001)
    thigh, shank, foot = (30.0 * np.sin(2 * np.pi * phase + k)[None] for k in range(3))
    steps = increments_of_joints({"hip": thigh, "knee": thigh - shank, "ankle": foot - shank}, 0.36)
    stance, swing = np.linspace(0, 0.36, 101), np.linspace(0.36, 1, 101)
    for k, name in enumerate(("thigh", "shank", "foot")):
        expected = [np.diff(30.0 * np.sin(2 * np.pi * at + k)) for at in (stance, swing)]
        assert np.allclose(steps[name][0], np.concatenate(expected), atol=1e-3)


def bumps(time, at, width):
    return np.exp(-(((time[:, None] - at) / width) ** 2)).sum(axis=1)


def landing_runner():
    """Feet that land every 0.7 s in turn and push off 0.25 s later."""
    time = np.arange(7500) / RATE_HZ
    right = 0.5 + STRIDE_S * np.arange(20)
    landings = {"right": right, "left": right + STRIDE_S / 2}
    segments = {}
    for side, at in landings.items():
        acc, gyr = np.zeros((3, time.size)), np.zeros((3, time.size))
        acc[1] = 10.0 + 100.0 * bumps(time, at, 0.012) + 30.0 * bumps(time, at - 0.05, 0.08)
        gyr[ML] = 6.0 * bumps(time, at + 0.55, 0.12) - 8.0 * bumps(time, at + 0.25, 0.06)
        segments[f"{side}_foot"] = SegmentSignals(acc, gyr)
    acc = np.zeros((3, time.size))
    acc[1] = 12.0 + 8.0 * np.cos(4 * np.pi * (time - right[0] - 0.12) / STRIDE_S)
    segments["pelvis"] = SegmentSignals(acc, np.zeros_like(acc))
    return MarkerSensors(RUNS[0], segments, {}, RATE_HZ), landings


def test_landings_that_are_known():
    runner, landings = landing_runner()
    strides = sensor_strides(runner, METHODS["printed"])
    for side, at in landings.items():
        own = strides[(strides["side"] == side) & strides["is_valid"]]
        assert len(own) >= 17
        nearest = np.abs(own["start_s"].to_numpy()[:, None] - at).min(axis=1)
        assert nearest.max() < 0.004
        assert np.allclose(own["stride_time_s"], STRIDE_S, atol=0.003)
        assert np.allclose(own["contact_time_s"], 0.25, atol=0.02)


def table_of_strides(late_s=0.0, off_s=0.0, first=0, n=30):
    start = STRIDE_S * np.arange(first, n)
    parts = []
    for k, side in enumerate(("right", "left")):
        touch = start + k * STRIDE_S / 2 + late_s
        off = start + k * STRIDE_S / 2 + 0.25 + off_s
        columns = {
            "side": side,
            "start_s": touch,
            "toe_off_s": off,
            "stride_time_s": STRIDE_S,
            "contact_time_s": off - touch,
            "step_time_s": STRIDE_S / 2,
            "duty_factor": (off - touch) / STRIDE_S,
            "is_valid": True,
        }
        parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def test_errors_of_strides_with_a_partner():
    errors = stride_errors(table_of_strides(0.004, -0.016), table_of_strides(first=5))
    assert len(errors) == 50
    means = errors.groupby("side")[["initial_contact", "toe_off", "contact_time"]].mean()
    assert np.allclose(means, [4.0, -16.0, -20.0])
    assert np.allclose(errors["duty_factor"], -0.02 / STRIDE_S)
    assert np.allclose(errors[["stride_time", "step_time"]], 0.0)


def known_errors(n=38):
    """Three feet; the recommended toe-off of one of them scatters by 9 ms, contacts are 20 ms short."""
    parts = []
    sign = np.where(np.arange(n) % 2, 1.0, -1.0)
    for foot, scatter in enumerate((2.0, 9.0, 3.0)):
        for method in METHODS:
            columns = {
                "trial": f"trial {foot}",
                "cutoff_hz": 60.0,
                "method": method,
                "side": "left",
                "initial_contact": -5.0 + sign,
                "toe_off": -25.0 + scatter * sign,
                "stride_time": 0.5 * sign + (1.5 if foot == 2 else 0.0),
                "contact_time": -20.0 + (scatter - 1.0) * sign,
                "step_time": 0.0 * sign,
                "duty_factor": -0.03 + 0.0 * sign,
                "found": n + 1,
                "plates": n + 2,
            }
            parts.append(pd.DataFrame(columns))
    return pd.concat(parts, ignore_index=True)


def test_feet_are_judged_by_their_median_and_stride_times_one_by_one():
    table = sensor_event_table(known_errors())
    row = table[(table["trial"] == "trial 1") & (table["method"] == "recommended")].iloc[0]
    assert row["toe_off_bias_ms"] == pytest.approx(-25.0)
    assert row["toe_off_sd_ms"] == pytest.approx(9.0)
    assert row["stride_time_rms_ms"] == pytest.approx(0.5)
    assert (row["found"], row["plates"], row["paired"]) == (39, 40, 38)
    checks = sensor_event_checks(table)
    judged = {check.quantity: check for check in checks if check.within != "reported"}
    assert [c.within for c in judged.values() if c.tolerance == STRIDE_TIME_MS] == [
        "yes",
        "yes",
        "no",
    ]
    medians = {name: c.value for name, c in judged.items() if "median of 3 feet" in name}
    assert len(medians) == 6
    assert medians[
        "sensor events (recommended), toe-off, SD: median of 3 feet, ms"
    ] == pytest.approx(3)
    assert not any("literal" in name or "sharpest" in name for name in judged)


def test_rounding_is_judged_and_the_largest_side_counts():
    row = {"trial": "A", "shuffled_deg": 0.0, "exchanged_deg": 0.0, "few_strides_expected": 0.97}
    rows = [
        {**row, "textbook_deg": 1e-13, "few_strides_ratio": 0.96},
        {**row, "textbook_deg": 1e-6, "few_strides_ratio": 0.97},
    ]
    verdicts = [check.within for check in invariance_checks(pd.DataFrame(rows))]
    assert verdicts == ["no", "yes", "yes", "yes"]


def test_means_of_both_sides_and_figures():
    rows = [
        ("A", side, n, couple, "late_stance", value, value + 0.1, 0.01)
        for side, n, value in (("right", 37, 2.0), ("left", 38, 4.0))
        for couple in ("foot-shank", "thigh-pelvis")
    ]
    names = ["trial", "side", "strides", "couple", "period", "variability_deg", "from_angles_deg"]
    wide = wide_coordination(pd.DataFrame(rows, columns=[*names, "ellipse_deg2"]))
    assert wide["variability_deg"].tolist() == [3.0, 3.0]
    assert wide["strides"].tolist() == [75, 75]
    curve = pd.DataFrame({"phase_percent": np.arange(200.0), "variability_deg": 2.0})
    curves = pd.concat([curve.assign(trial=t, couple=c) for t in "AB" for c in ("x", "y")])
    panels = figure_coordination(curves).axes
    assert [
        len([line for line in a.get_lines() if len(line.get_xdata()) == 200]) for a in panels
    ] == [2, 2]
    dots = figure_events(known_errors()).axes[0].get_lines()
    assert sum(len(line.get_xdata()) for line in dots if len(line.get_xdata()) > 2) == 3 * 3 * 38
