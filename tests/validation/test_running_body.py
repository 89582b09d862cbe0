"""The comparison with real runners: readers on files made here, and tables on known differences."""

import numpy as np
import pandas as pd
import pytest

from swaystride.validation import running_real
from swaystride.validation.running_body import (
    JointComparison,
    RunnerComparison,
    SimulatedStride,
    fitted_stride,
    matched_stride,
    simulated_stride,
    spread_deg,
)
from swaystride.validation.running_checks import joint_table, runner_checks, timing_table
from swaystride.validation.running_figures import figure_feet, figure_joints
from swaystride.validation.running_real import (
    JOINTS,
    N_PHASES,
    RealCurves,
    RealTrial,
    level_in_stance,
    marker_trials,
    stride_curves,
)

NAME = (
    "{}, eight runners at 2.5 m/s, usual simulated runner: "
    "share of the stride within 2 SD of the population"
)
PHASE = np.linspace(0.0, 1.0, N_PHASES)


@pytest.fixture
def comparison():
    rng = np.random.default_rng(1)
    shape = 30.0 * np.sin(2 * np.pi * PHASE)
    noise = rng.standard_normal((400, N_PHASES))
    real = RealCurves(
        "eight runners at 2.5 m/s",
        2.5,
        np.repeat(["A", "B"], 200),
        dict.fromkeys(JOINTS, shape + 2.0 * noise),
        duty_factor=np.array([0.37, 0.4]),
        stride_time_s=np.array([]),
    )
    trial = RealTrial(
        "A",
        2.5,
        np.array([0.75, 0.76, 0.78]),
        np.array([0.35, 0.36, 0.38]),
        np.array([0.09, 0.1, 0.11]),
        shape + noise[:3],
    )
    # One joint differs by a constant only, one leaves the band for a third of the stride.
    off = np.where(PHASE > 2 / 3, 12.0, 0.0)
    angles = {"hip": shape - 7.0, "knee": shape + off, "ankle": shape}
    simulated = SimulatedStride(2.5, 0.77, 0.39, 0.1, angles, shape + 1.0)
    pair = JointComparison(real, simulated, None, None, spread_deg(real))
    return RunnerComparison([pair], [(trial, simulated)])


def test_a_constant_is_taken_away_and_the_rest_is_judged(comparison):
    table = joint_table(comparison).set_index("joint")
    assert table.loc["hip", "constant_deg"] == pytest.approx(7.0, abs=0.1)
    assert table.loc["hip", "share_population"] == 1.0
    assert table.loc["knee", "share_population"] < 0.8
    assert table.loc["knee", "rms_deg"] == pytest.approx(12.0 * np.sqrt(2) / 3, rel=0.05)
    assert table.loc["knee", "share_strides"] == table.loc["knee", "share_population"]
    assert table.loc["knee", "largest_deg"] == pytest.approx(8.0, abs=0.5)
    assert table.loc["knee", "beyond_population_deg"] == pytest.approx(4.0, abs=0.7)
    checks = {check.quantity: check for check in reversed(runner_checks(comparison))}
    verdicts = {joint: checks[NAME.format(joint)].within for joint in JOINTS}
    assert verdicts == {"hip": "yes", "knee": "no", "ankle": "yes"}
    assert checks["stride time, s, at 2.5 m/s"].within == "yes"
    # Among the strides of the trial it is not, among the duty factors of the curves it is.
    duty = [c.within for c in runner_checks(comparison) if c.quantity == "duty factor, at 2.5 m/s"]
    assert duty == ["no", "yes"]


def test_timing_lists_every_quantity_that_was_measured(comparison):
    table = timing_table(comparison).set_index("quantity")
    assert table.loc["stride time, s", "median"] == 0.76
    assert table.loc["foot pitch, RMS from the mean real stride, deg", "simulated"] < 1.5
    assert len(figure_joints(comparison).axes) == 3
    assert len(figure_feet(comparison).axes) == 4


def test_foot_pitch_is_level_in_the_middle_of_the_stance():
    pitch = 5.0 + np.where(PHASE < 0.3, 0.0, -40.0)[None]
    level = level_in_stance(pitch, 0.3)
    assert level[0, 12] == 0.0
    assert level[0, 60] == -40.0


def test_strides_with_jumps_are_left_out(tmp_path, monkeypatch):
    curve = 20.0 * np.sin(2 * np.pi * PHASE)
    jump = np.where(PHASE > 0.5, 170.0, curve)
    table = {"Time": np.arange(N_PHASES)}
    for stride, hip in (("1", curve), ("2", jump)):
        table |= {f"Hip_Z_{stride}": -hip, f"Knee_Z_{stride}": curve, f"Ankle_Z_{stride}": -curve}
    path = tmp_path / "XYZ01angs.txt"
    pd.DataFrame(table).to_csv(path, sep="\t", index=False)
    monkeypatch.setattr(running_real, "verified_files", lambda folder, dataset: [path])
    found = stride_curves(tmp_path)
    assert found.runner.tolist() == ["XYZ01"]
    for joint in JOINTS:
        np.testing.assert_allclose(found.angle_deg[joint][0], curve)


def test_touches_and_heights_come_from_forces_and_markers(tmp_path, monkeypatch):
    # Two feet in turn: a half wave of force in 0.25 of every 0.375 s, the right foot low then.
    duration, stride, stance = 20.0, 0.75, 0.25
    time = np.arange(int(duration * 300)) / 300.0
    within = np.mod(time - 0.1, stride / 2)
    force = np.where(within < stance, 1500.0 * np.sin(np.pi * within / stance), 0.0)
    forces = pd.DataFrame({"Fy": force})
    frames = np.arange(int(duration * 150)) / 150.0
    phase = np.mod(frames - 0.1, stride) / stride
    low = np.where(phase < 0.5, 0.0, 200.0)
    markers = {}
    for name, x, y in (
        ("R.Heel.Top", 0.0, low),
        ("R.Heel.Bottom", 0.0, low),
        ("R.MT1", 200.0, low),
        ("R.MT5", 200.0, low),
        ("L.MT1", 200.0, 200.0 - low),
        *(
            (spine, 0.0, 950.0 + 45.0 * np.sin(2 * np.pi * frames / (stride / 2)))
            for spine in (
                "R.ASIS",
                "L.ASIS",
                "R.PSIS",
                "L.PSIS",
            )
        ),
    ):
        for axis, value in zip("XYZ", (x, y, 0.0), strict=True):
            markers[f"{name}{axis}"] = np.broadcast_to(value, frames.shape)
    paths = []
    for name in ("RBDS001runT25", "RBDS0041runT252"):
        for suffix, table in (("markers", pd.DataFrame(markers)), ("forces", forces)):
            ending = "" if (name.endswith("252") and suffix == "markers") else suffix
            path = tmp_path / f"{name}{ending}.txt"
            table.to_csv(path, sep="\t", index=False)
            paths.append(path)
    monkeypatch.setattr(running_real, "verified_files", lambda folder, dataset: paths)
    for trial in marker_trials(tmp_path):
        np.testing.assert_allclose(trial.stride_time_s, stride, atol=0.004)
        # 50 N of 1500 N are passed a little after the begin and before the end.
        np.testing.assert_allclose(trial.duty_factor, stance / stride, atol=0.02)
        np.testing.assert_allclose(trial.oscillation_m, 0.09, rtol=0.05)
        np.testing.assert_allclose(trial.foot_pitch_deg, 0.0, atol=1e-9)


def test_the_simulated_stride_is_one_stride():
    stride = simulated_stride(2.5)
    for curve in (*stride.angle_deg.values(), stride.foot_pitch_deg):
        assert curve.shape == (N_PHASES,)
        assert curve[0] == pytest.approx(curve[-1], abs=1e-6)


def test_a_matched_stride_has_the_timing_of_the_real_runner():
    curves = dict.fromkeys(JOINTS, np.zeros((2, N_PHASES)))
    none, times = np.array([]), np.array([0.70, 0.68])
    assert matched_stride(RealCurves("", 3.0, np.array(["A"]), curves, none, none)) is None
    real = RealCurves("", 3.0, np.array(["A"]), curves, np.array([0.36]), times)
    stride = matched_stride(real)
    assert stride.duty_factor == pytest.approx(0.36, abs=1e-3)
    assert stride.stride_time_s == pytest.approx(0.69, abs=1e-3)


def test_fitted_runners_stand_for_the_speeds_that_were_fitted():
    curves = dict.fromkeys(JOINTS, np.zeros((2, N_PHASES)))
    none = np.array([])
    real = RealCurves("", 3.5, np.array(["A"]), curves, none, none)
    fitted, usual = fitted_stride(real), simulated_stride(3.5)
    assert fitted.duty_factor - usual.duty_factor == pytest.approx(0.008, abs=1e-3)
    assert fitted.foot_pitch_deg.min() < usual.foot_pitch_deg.min() - 4.0
    assert fitted_stride(RealCurves("", 2.5, np.array(["A"]), curves, none, none)) is None
