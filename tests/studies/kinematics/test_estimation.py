"""Estimates of a trial: their shape, and how far they are from the truth."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.gait.stride_curves import stride_curves
from swaystride.studies.kinematics.estimate_files import (
    add_estimates,
    load_estimates,
    start_estimates,
    usable_trials,
)
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES
from swaystride.studies.kinematics.truth import angle_errors, stride_errors, true_angles_deg

SAGITTAL = ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
SHAPES = {
    "angle_deg": ("source", "side", "angle", "time"),
    "angle_sd_deg": ("side", "angle", "time"),
    "integrated_deg": ("side", "angle", "time"),
    "foot_position_m": ("source", "side", "axis", "time"),
    "zero_velocity": ("side", "time"),
    "foot_acc_m_s2": ("side", "time"),
    "foot_gyr_rad_s": ("side", "time"),
    "foot_pitch_rate_rad_s": ("side", "time"),
    "planar_angle_deg": ("trio", "time"),
}


def first_known(values):
    """First sample at which everything is there."""
    return int(np.argmax(np.isfinite(values).all(axis=tuple(range(values.ndim - 1)))))


@pytest.mark.parametrize("variant", ["printed", "recommended"])
def test_estimates_have_the_shape_that_later_stages_read(estimated, variant):
    estimates, _, _ = estimated(variant)
    assert {name: estimates[name].dims for name in estimates.data_vars} == SHAPES
    for name, labels in (("source", SOURCES), ("side", SIDES), ("angle", ANGLE_NAMES)):
        assert tuple(estimates[name].values) == tuple(labels)
    trios = {f"{side}_{part}" for part in ("thigh", "shank", "foot") for side in SIDES}
    assert set(map(str, estimates["trio"].values)) == trios
    np.testing.assert_allclose(estimates["time"].values, np.arange(4900) / 200.0)
    assert estimates["zero_velocity"].dtype == bool
    for name in ("angle_deg", "angle_sd_deg", "integrated_deg"):
        assert estimates[name].dtype == np.float32
    assert estimates.attrs["rate_hz"] == 200.0
    assert estimates.attrs["first_usable_s"] == 0.0
    assert estimates.attrs["belt_speed_m_s"] == pytest.approx(14.0 / 3.6, abs=1e-3)


@pytest.mark.parametrize("variant", ["printed", "recommended"])
def test_the_filter_is_known_from_its_start_on(estimated, variant):
    estimates, _, _ = estimated(variant)
    filtered = estimates["angle_deg"].sel(source="erkf").values
    start = first_known(filtered)
    assert start < 200
    assert np.isnan(filtered[..., :start]).all()
    for values in (
        filtered,
        estimates["angle_sd_deg"].values,
        estimates["integrated_deg"].values,
        estimates["foot_position_m"].sel(source="erkf").values,
    ):
        assert np.isfinite(values[..., start:]).all()
    assert (estimates["angle_sd_deg"].values[..., start:] > 0.0).all()


def test_a_foot_rests_once_in_a_stride(estimated, known):
    for variant, least, most in (("printed", 4, 12), ("recommended", 0.9, 30)):
        flags = estimated(variant)[0]["zero_velocity"].values
        for side in range(2):
            n_stances = len(known.motion.contacts_s(side)[0])
            starts = np.count_nonzero(np.diff(flags[side].astype(int)) == 1)
            assert 0.9 * n_stances <= starts <= 2.0 * n_stances
            assert least <= flags[side].sum() / n_stances <= most


def test_findings_of_the_markers_are_not_told_again(estimated, sound_lab):
    """The import reports every gap once; four variants need not repeat them."""
    assert len(sound_lab.tables.findings) > 0
    for variant in ("printed", "recommended"):
        checks = [finding.check for finding in estimated(variant)[1]]
        assert not any(check.startswith("marker_gap") for check in checks)
        assert not {"constraint_refused", "belt_speed_contradicts_markers"} & set(checks)


def test_recommended_angles_follow_the_truth_after_one_constant(estimated, known, last_strides):
    estimates, _, tables = estimated("recommended")
    errors = angle_errors(estimates, last_strides(tables["strides"]), known)
    ours = errors[errors["source"] == "erkf"].set_index(["angle", "side"])["rmsd_trial_deg"]
    assert len(ours) == 18
    assert ours.loc[list(SAGITTAL)].max() < 3.0
    assert ours.max() < 5.0


def test_recommended_strides_are_as_long_and_wide_as_the_true_ones(estimated, known, last_strides):
    errors = stride_errors(last_strides(estimated("recommended")[2]["strides"]), known)
    errors["error"] = errors["estimate"] - errors["truth"]
    for source, length, width in (("erkf", 0.015, 0.025), ("optic", 0.0005, 0.003)):
        own = errors[errors["source"] == source].groupby("measure")
        assert own.size().tolist() == [30, 30]
        bias = own["error"].mean() / own["truth"].mean()
        assert abs(bias["stride_length_m"]) < length
        assert np.sqrt((own["error"].agg(lambda e: (e**2).mean()))["stride_width_m"]) < width


def test_optical_strides_are_right_within_millimetres(estimated, known):
    errors = stride_errors(estimated("printed")[2]["strides"], known)
    own = errors[errors["source"] == "optic"].dropna()
    assert len(own) > 60
    assert np.abs(own["estimate"] - own["truth"]).max() < 0.005


def test_recommended_is_nearer_to_the_truth_than_printed(estimated, known, last_strides):
    rmsd = {}
    for variant in ("printed", "recommended"):
        estimates, _, tables = estimated(variant)
        errors = angle_errors(estimates, last_strides(tables["strides"]), known)
        rmsd[variant] = errors[errors["source"] == "erkf"]["rmsd_trial_deg"].median()
    assert rmsd["recommended"] < 0.5 * rmsd["printed"]


def test_integrated_angles_start_right_and_drift(estimated, known):
    """Of the printed variant, which starts from the markers."""
    estimates = estimated("printed")[0]
    integrated = estimates["integrated_deg"].values.astype(float)
    start = first_known(integrated)
    optic = estimates["angle_deg"].sel(source="optic").values[..., start]
    np.testing.assert_allclose(integrated[..., start], optic, atol=0.01)
    error = integrated - true_angles_deg(known.motion, estimates["time"].values)
    # the curve of the hip is followed at once, wherever the markers put its zero
    hip = ANGLE_NAMES.index("hip_flexion")
    assert error[:, hip, start : start + 150].std(axis=1).max() < 1.5
    moved = np.abs(error[..., -200:].mean(axis=2) - error[..., start : start + 200].mean(axis=2))
    assert moved.max() > 5.0
    assert moved.max() < 60.0


def test_curves_of_both_sources_repeat_with_the_stride(estimated):
    """Strides of one foot are alike: contacts lie on the clock of the angles."""
    estimates, _, tables = estimated("recommended")
    strides = tables["strides"].query("side == 'right' and source == 'erkf'")
    contacts = np.unique(strides["initial_contact_s"])
    samples = np.rint(contacts * 200.0).astype(int)
    knee = estimates["angle_deg"].sel(side="right", angle="knee_flexion").values.astype(float)
    curves = stride_curves(knee, samples[:-1], samples[1:])
    for source in curves:
        spread = np.nanstd(source, axis=-2 if source.shape[-1] == 101 else -1)
        assert np.nanmedian(spread) < 4.0
        assert np.ptp(np.nanmean(source, axis=0)) > 60.0


def test_estimates_come_back_from_their_file(estimated, tmp_path):
    estimates, _, _ = estimated("recommended")
    path = tmp_path / "P01.nc"
    start_estimates(path)
    assert usable_trials(path) == []
    add_estimates(path, "02", estimates.isel(time=slice(100, 150)))
    add_estimates(path, "01", estimates)
    assert usable_trials(path) == ["01", "02"]
    back = load_estimates(path, "01")
    assert back.attrs == estimates.attrs
    for name in estimates.data_vars:
        assert back[name].dtype == estimates[name].dtype, name
        np.testing.assert_array_equal(back[name].values, estimates[name].values)
    assert load_estimates(path, "02").sizes["time"] == 50
    with pytest.raises(RecordingError, match=r"P01\.nc: group 03: no estimates of this trial"):
        load_estimates(path, "03")
    start_estimates(path)
    assert usable_trials(path) == []
