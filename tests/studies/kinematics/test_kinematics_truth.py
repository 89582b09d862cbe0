"""Errors against the truth: their identities, and the truth itself against the sensors."""

import numpy as np
import pytest
import xarray as xr

from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES
from swaystride.studies.kinematics.truth import (
    ANGLE_ERROR_COLUMNS,
    STRIDE_ERROR_COLUMNS,
    angle_errors,
    stride_errors,
    true_angles_deg,
    true_strides,
)


@pytest.fixture(scope="module")
def strides(estimated):
    return estimated("printed")[2]["strides"]


def test_true_strides_are_those_of_the_sensors_on_the_feet(known):
    """A tenth of a second after the touch the foot rests; also the place of the foot is close."""
    for side, row in zip(SIDES, (5, 6), strict=True):
        told = true_strides(known)[side]
        middle = told["touch_s"].to_numpy() + 0.1
        middle = middle[middle < known.motion.duration_s]
        place = known.sensor_position_m(middle)[:, row, :2]
        length = np.linalg.norm(np.diff(place, axis=0), axis=1)
        assert len(length) > 30
        assert np.abs(length - told["stride_length_m"].to_numpy()[: len(length)]).max() < 0.02
        assert np.isnan(told["stride_length_m"].iloc[-1])
        stances = known.motion.tables.stances[SIDES.index(side)]
        stances = stances[np.isin(stances[:, 0], told["touch_s"])]
        of_feet = np.linalg.norm(np.diff(stances[:, 3:5], axis=0), axis=1)
        assert np.abs(of_feet - told["stride_length_m"].to_numpy()[:-1]).max() < 0.02


def test_touches_are_those_of_the_motion_and_alternate(known):
    told = true_strides(known)
    for k, side in enumerate(SIDES):
        touch = told[side]["touch_s"].to_numpy()
        contact = known.motion.contacts_s(k)[0]
        assert np.isin(touch[touch >= 0.0], contact).all()
        assert len(touch) >= len(contact) - 1
    both = np.sort(np.concatenate([told[side]["touch_s"] for side in SIDES]))
    assert np.diff(both).min() > 0.25


def test_true_widths_are_distances_of_the_sensors_across(known):
    """The runner faces forward: width is the distance of the sensors of both feet to the side."""
    told = true_strides(known)
    across = {}
    for side, row in zip(SIDES, (5, 6), strict=True):
        middle = told[side]["touch_s"].to_numpy()[2:-2] + 0.1
        across[side] = known.sensor_position_m(middle)[:, row, 1].mean()
    for side in SIDES:
        width = told[side]["stride_width_m"].mean()
        assert width == pytest.approx(abs(across["left"] - across["right"]), abs=0.005)


def test_true_angles_are_those_of_the_motion(known):
    time_s = np.arange(0.0, 24.5, 0.005)
    angles = true_angles_deg(known.motion, time_s)
    assert angles.shape == (2, 9, len(time_s))
    joints = known.motion.states(time_s).joint_angles_rad()
    for s, side in enumerate(SIDES):
        for joint in ("hip", "knee"):
            told = np.degrees(joints[f"{joint}_{side}"])[:, 0]
            found = angles[s, ANGLE_NAMES.index(f"{joint}_flexion")]
            np.testing.assert_allclose(found, told, atol=0.5)


def test_a_perfect_estimate_has_no_error_and_a_shifted_one_a_bias(known, strides):
    time_s = np.arange(0.0, 24.5, 0.005)
    true = true_angles_deg(known.motion, time_s)
    rng = np.random.default_rng(2)
    scatter = rng.standard_normal(true.shape)
    made = xr.Dataset(
        {
            "angle_deg": (("source", "side", "angle", "time"), np.stack([true, true + 3.0 + scatter])),
            "angle_sd_deg": (("side", "angle", "time"), np.ones(true.shape)),
        },
        coords={"time": time_s},
    )  # fmt: skip
    errors = angle_errors(made, strides, known)
    assert tuple(errors) == ANGLE_ERROR_COLUMNS
    assert len(errors) == 36
    optic, erkf = (errors[errors["source"] == source] for source in SOURCES)
    assert optic[["bias_deg", "rmsd_deg", "rmsd_trial_deg"]].abs().to_numpy().max() < 1e-12
    assert optic[["coverage_95", "coverage_95_trial"]].isna().all(axis=None)
    np.testing.assert_allclose(erkf["bias_deg"], 3.0, atol=0.08)
    np.testing.assert_allclose(erkf["rmsd_trial_deg"], 1.0, atol=0.05)
    np.testing.assert_allclose(erkf["coverage_95_trial"], 0.95, atol=0.015)
    # P(|3 + z| <= 1.96)
    np.testing.assert_allclose(erkf["coverage_95"], 0.149, atol=0.025)
    turned = made.assign(angle_deg=made["angle_deg"] + 360.0)
    again = angle_errors(turned, strides, known)
    np.testing.assert_allclose(again["bias_deg"], errors["bias_deg"], atol=1e-9)


@pytest.mark.parametrize("variant", ["printed", "recommended"])
def test_the_error_is_made_of_bias_and_scatter(estimated, known, variant):
    estimates, _, tables = estimated(variant)
    errors = angle_errors(estimates, tables["strides"], known)
    np.testing.assert_allclose(
        errors["rmsd_deg"] ** 2, errors["bias_deg"] ** 2 + errors["rmsd_trial_deg"] ** 2
    )
    assert errors["coverage_95"].dropna().between(0.0, 1.0).all()


def test_strides_meet_the_truth_of_their_own_contact(known, strides):
    errors = stride_errors(strides, known)
    assert tuple(errors) == STRIDE_ERROR_COLUMNS
    measures = strides[strides["feature"].isin(["stride_length_m", "stride_width_m"])]
    assert len(errors) == len(measures)
    assert set(errors["side"]) == set(SIDES)
    for side in SIDES:
        told = true_strides(known)[side]
        own = errors[(errors["side"] == side) & (errors["measure"] == "stride_length_m")]
        assert set(own["truth"].dropna()) <= set(told["stride_length_m"])
        assert own.groupby("stride")["truth"].nunique().max() == 1
    late = strides.assign(initial_contact_s=strides["initial_contact_s"] + 0.3)
    assert stride_errors(late, known)["truth"].isna().all()
