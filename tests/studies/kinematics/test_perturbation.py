"""Shifted joint centres of some strides of a rigid person."""

import numpy as np
import pandas as pd
import pytest
from optical_person import BODY, HIPS_M, moving, standing

from swaystride.errors import RecordingError
from swaystride.mocap.joint_axes import public_joint_axes
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT
from swaystride.mocap.perturbation import Person, perturbed_angles
from swaystride.mocap.static_calibration import PRINTED_OPTIONS
from swaystride.studies.kinematics.perturbation import (
    UNSHIFTED,
    PerturbationRule,
    trial_perturbation,
)
from swaystride.studies.kinematics.plan import JOINT_ANGLES, SIDES

#: Strides of 0.3 s that have nothing to do with the motion: any cut will do.
CONTACT_S = {"right": 0.1 + 0.3 * np.arange(6), "left": 0.22 + 0.3 * np.arange(6)}


@pytest.fixture(scope="module")
def person():
    return Person(
        standing(),
        CONVENTIONAL_GAIT,
        BODY,
        PRINTED_OPTIONS,
        public_joint_axes("spine_plane"),
        HIPS_M,
    )


@pytest.fixture(scope="module")
def motion():
    return moving()


@pytest.fixture(scope="module")
def found(person, motion):
    return trial_perturbation(motion[0], person, CONTACT_S, PerturbationRule(1, 3))


def test_the_table_is_that_of_the_strides_alone(found, person, motion):
    """From the first right contact after one stride to the last left one: 0.4 to 1.42 s."""
    part = motion[0].isel(time=slice(80, 285))
    pd.testing.assert_frame_equal(found.table, perturbed_angles(part, person))


def test_eighteen_shifts_and_none(found):
    keys = found.curves.drop_duplicates(["shifted", "direction", "sign"])
    assert len(keys) == 19
    assert keys.iloc[0][["shifted", "direction", "sign"]].tolist() == [UNSHIFTED, UNSHIFTED, 0]
    assert len(found.curves) == 19 * 18 * 101
    assert found.curves["mean_deg"].notna().all()


def test_a_shift_moves_what_is_downstream(found):
    """An ankle leaves the hip alone; a knee that is put forward is flexed."""
    wide = found.curves.set_index(["shifted", "direction", "sign", "side", "angle"])["mean_deg"]
    for side in SIDES:
        hip = wide.loc["ankle", "AP", 1, side, "hip_flexion"].to_numpy()
        assert np.allclose(hip, wide.loc[UNSHIFTED, UNSHIFTED, 0, side, "hip_flexion"], atol=1e-9)
        ahead, back = (
            wide.loc["knee", "AP", sign, side, "knee_flexion"].mean() for sign in (1, -1)
        )
        own = wide.loc[UNSHIFTED, UNSHIFTED, 0, side, "knee_flexion"].mean()
        assert back < own < ahead


def test_offsets_of_curves_agree_with_the_table(found):
    """Mean over the strides against mean over the samples between first and last contact."""
    curves = found.curves.set_index(["shifted", "direction", "sign", "side", "angle"])["mean_deg"]
    table = found.table.assign(sign=np.sign(found.table["shift_m"]).astype(int)).set_index(
        ["shifted", "direction", "sign", "joint", "angle"]
    )["offset_deg"]
    for angle in JOINT_ANGLES[3:6]:
        shifted = curves.loc["knee", "ML", 1, "right", angle.name].to_numpy()
        own = curves.loc[UNSHIFTED, UNSHIFTED, 0, "right", angle.name].to_numpy()
        offset = table.loc["knee", "ML", 1, f"right_{angle.joint}", angle.angle]
        assert (shifted - own).mean() == pytest.approx(offset, abs=0.3)


def test_too_few_strides_or_markers(person, motion):
    with pytest.raises(RecordingError, match="right foot: no strides to shift joint centres in"):
        trial_perturbation(motion[0], person, CONTACT_S, PerturbationRule(5, 20))
    late = {side: contacts + 5.0 for side, contacts in CONTACT_S.items()}
    with pytest.raises(RecordingError, match=r"between 0\.00 and 2\.00 s; found 5\.40 to 6\.42 s"):
        trial_perturbation(motion[0], person, late, PerturbationRule(1, 3))
