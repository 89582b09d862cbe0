"""The optical comparison with real runners: readers on files made here, tables on known curves."""

import numpy as np
import pandas as pd
import pytest

from swaystride.marker_recording import make_marker_recording
from swaystride.validation.running_optical_checks import curve_checks, event_checks
from swaystride.validation.running_optical_figures import figure_angles
from swaystride.validation.running_optical_methods import earliest_peaks, foot_signals
from swaystride.validation.running_optical_recording import (
    RATE_HZ,
    measured,
    read_markers,
    relabelled,
)
from swaystride.validation.running_optical_tables import curve_table

PHASE = np.linspace(0.0, 100.0, 101)


def curve(trial, angle, ours, theirs, joint="knee", side="right"):
    return pd.DataFrame(
        {
            "trial": trial,
            "centres": "medial_markers",
            "side": side,
            "joint": joint,
            "angle": angle,
            "phase_percent": PHASE,
            "ours_deg": ours,
            "authors_deg": theirs,
        }
    )


def wave(shift_percent=0.0):
    turn = 2.0 * np.pi * (PHASE - shift_percent) / 100.0
    return 40.0 * np.sin(turn) + 10.0 * np.cos(2 * turn)


def test_markers_of_a_file_in_world_axes(tmp_path):
    """X forward, Y up and Z right in mm become x forward, y left and z up in m."""
    path = tmp_path / "run.txt"
    path.write_text("Time\tR.KneeX\tR.KneeY\tR.KneeZ\n0.0\t1000\t500\t200\n0.007\t\t\t\n")
    recording = read_markers(path)
    assert recording.attrs["rate_hz"] == RATE_HZ
    position = recording["position"].sel(marker="R.Knee").to_numpy()
    np.testing.assert_allclose(position[:, 0], [1.0, -0.2, 0.5])
    assert np.isnan(position[:, 1]).all()


def test_exchanged_labels_are_exchanged_back():
    position = np.arange(9.0).reshape(3, 3, 1)
    recording = make_marker_recording(
        position, markers=["A", "B", "C"], rate_hz=150.0, rate_source="argument"
    )
    found = relabelled(recording, (("A", "C"),))
    np.testing.assert_array_equal(found["position"].sel(marker="A"), position[2])
    np.testing.assert_array_equal(found["position"].sel(marker="B"), position[1])


def test_measures_of_a_standing_runner():
    """Lengths between markers, widths without the two markers."""
    places = {}
    for letter, y in (("R", -0.1), ("L", 0.1)):
        places |= {
            f"{letter}.ASIS": (0.0, y, 1.0),
            f"{letter}.Knee": (0.0, 1.6 * y, 0.5),
            f"{letter}.Knee.Medial": (0.0, 0.4 * y, 0.5),
            f"{letter}.Ankle": (0.0, 1.5 * y, 0.1),
            f"{letter}.Ankle.Medial": (0.0, y, 0.1),
        }
    position = np.repeat(np.array(list(places.values()))[:, :, None], 4, axis=2)
    static = make_marker_recording(
        position, markers=list(places), rate_hz=150.0, rate_source="argument"
    )
    body = measured(static)
    assert body.leg_length_m == pytest.approx((0.9, 0.9))
    assert body.knee_width_m == pytest.approx((0.102, 0.102))
    assert body.ankle_width_m == pytest.approx((0.032, 0.032))


def test_constants_and_phases_are_told_apart():
    samples = pd.concat(
        [
            curve("A", "flexion", wave() + 7.0, wave()),
            curve("A", "adduction", wave(-1.5), wave()),
        ]
    )
    constant, early = curve_table(samples).to_dict("records")
    assert constant["offset_deg"] == pytest.approx(7.0)
    assert constant["rmsd_deg"] == pytest.approx(0.0, abs=1e-9)
    assert constant["shift_percent"] == pytest.approx(0.0)
    # ours runs ahead by 1.5 %: our strides begin later
    assert early["rmsd_deg"] > 2.0
    assert early["shift_percent"] == pytest.approx(1.5)
    assert early["in_phase_rmsd_deg"] < 0.1


def test_only_sagittal_curves_of_the_same_runner_are_judged():
    off = 5.0 * np.sin(2 * np.pi * PHASE / 100.0)
    samples = pd.concat(
        [
            curve("RBDS001 at 2.5 m/s", "flexion", wave() + 5.0, wave()),
            curve("RBDS001 at 3.5 m/s", "flexion", wave() + off, wave()),
            curve("RBDS0041 at 2.5 m/s", "flexion", wave() + off, wave()),
            curve("RBDS001 at 2.5 m/s", "adduction", wave() + off, wave()),
            curve("RBDS001 at 2.5 m/s", "adduction", wave(), wave(), joint="hip"),
        ]
    )
    checks = curve_checks(curve_table(samples))
    assert [check.within for check in checks] == ["yes", "no", "reported", "reported"]
    assert checks[3].value == pytest.approx(np.std(off))
    assert checks[3].reference_source.startswith("right knee")


def test_events_are_judged_by_single_strides_and_contacts():
    row = {
        "trial": "A at 2.5 m/s",
        "side": "left",
        "contacts": 40,
        "unpaired": 1,
        "touch_bias_ms": 5.0,
        "touch_sd_ms": 2.0,
        "toe_off_bias_ms": -3.0,
        "toe_off_sd_ms": 2.0,
        "contact_time_rms_ms": 19.0,
        "stride_time_rms_ms": 5.1,
    }
    verdicts = [check.within for check in event_checks(pd.DataFrame([row]))]
    assert verdicts == ["no", "yes", "reported", "reported", "no"]


def test_figure_lays_ours_over_theirs_without_the_constant():
    samples = pd.concat(
        [
            curve("A", angle, wave() + 9.0, wave(), joint, side)
            for joint in ("hip", "knee", "ankle")
            for angle in ("flexion", "adduction", "internal_rotation")
            for side in ("right", "left")
        ]
    )
    fig = figure_angles(samples, "A")
    assert len(fig.axes) == 9
    for axes in fig.axes:
        theirs, ours = (line.get_ydata() for line in axes.get_lines()[:2])
        np.testing.assert_allclose(ours, theirs, atol=1e-9)


def test_the_earliest_of_several_peaks_between_samples():
    t = np.arange(300) / 150.0
    signals = [-((t - 1.0123) ** 2), -((t - 1.0345) ** 2)]
    error = earliest_peaks(signals, np.array([1.0, 0.01, 1.99]), 150.0)
    assert error[0] == pytest.approx(0.0123)
    assert np.isnan(error[1:]).all()


def test_signals_of_a_foot_that_swings():
    """Forward and backward ends of a swing about the sacrum, and the lowest point of the heel."""
    t = np.arange(600) / 150.0
    swing = np.stack([0.4 * np.sin(6 * t), 0 * t, 0.1 - 0.05 * np.cos(6 * (t - 0.1))], axis=1)
    way = np.stack([3.0 * t, 0 * t, 0 * t], axis=1)
    signals = foot_signals(swing + way, swing + way, way, 150.0)
    forward, backward = np.pi / 12 + np.array([1, 1.5]) * np.pi / 3
    ((heel,), (lowest,)) = list(signals["touch"].values())[:2]
    ((toe,), *_) = signals["toe_off"].values()
    assert earliest_peaks([heel], np.array([forward]), 150.0) == pytest.approx([0.0], abs=1e-4)
    assert earliest_peaks([toe], np.array([backward]), 150.0) == pytest.approx([0.0], abs=1e-4)
    low = 0.1 + np.pi / 3
    assert earliest_peaks([lowest], np.array([low]), 150.0) == pytest.approx([0.0], abs=1e-4)
