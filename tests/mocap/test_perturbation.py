"""Shifted joint centres: signs and closed forms on a rigid person."""

import numpy as np
import pytest
from optical_person import BODY, HIPS_M, SHANK_M, THIGH_M

from swaystride.mocap.joint_axes import FALLBACK_SHIFT_M
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT
from swaystride.mocap.perturbation import Person, perturbed_angles


@pytest.fixture(scope="module")
def table(static, motion, own_axes, printed):
    person = Person(static, CONVENTIONAL_GAIT, BODY, printed, own_axes, HIPS_M)
    return perturbed_angles(motion[0].isel(time=slice(0, 200)), person)


@pytest.fixture(scope="module")
def still(static, own_axes, printed):
    """Offsets of a person who stands, where they have a closed form."""
    person = Person(static, CONVENTIONAL_GAIT, BODY, printed, own_axes, HIPS_M)
    found = perturbed_angles(static, person)
    return found.set_index(["shifted", "direction", "shift_m", "joint", "angle"])[
        "offset_deg"
    ].sort_index()


def test_six_shifts_of_three_joints_on_all_angles(table):
    assert len(table) == 3 * 6 * 18
    assert set(table["shift_m"].abs()) == {FALLBACK_SHIFT_M}


@pytest.mark.parametrize("side", ["right", "left"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_offsets_in_standing(still, side, sign):
    """A knee centre that is put forward flexes hip and knee and dorsiflexes the ankle."""
    d = sign * FALLBACK_SHIFT_M
    thigh, shank = np.degrees(np.arctan2(d, THIGH_M)), np.degrees(np.arctan2(d, SHANK_M))
    ahead = still.loc["knee", "AP", d]
    assert ahead[f"{side}_hip", "flexion"] == pytest.approx(thigh, abs=1e-6)
    assert ahead[f"{side}_knee", "flexion"] == pytest.approx(thigh + shank, abs=1e-6)
    assert ahead[f"{side}_ankle", "flexion"] == pytest.approx(shank, abs=1e-6)
    outward = still.loc["knee", "ML", d]
    assert outward[f"{side}_hip", "adduction"] == pytest.approx(-thigh, abs=1e-6)
    assert outward[f"{side}_knee", "adduction"] == pytest.approx(thigh + shank, abs=1e-6)
    hip = still.loc["hip", "AP", d]
    assert hip[f"{side}_hip", "flexion"] == pytest.approx(-thigh, abs=1e-6)
    ankle = still.loc["ankle", "AP", d]
    assert ankle[f"{side}_knee", "flexion"] == pytest.approx(-shank, abs=1e-6)


def test_nothing_upstream_of_a_shift_changes(table):
    upstream = table[(table["shifted"] == "ankle") & table["joint"].str.endswith("hip")]
    assert upstream[["offset_deg", "shape_deg"]].abs().max().max() < 1e-9


def test_offsets_of_opposite_shifts_are_opposite(table):
    wide = table.pivot_table(
        index=["shifted", "direction", "joint", "angle"], columns="shift_m", values="offset_deg"
    )
    together = wide.sum(axis=1).abs().max()  # of second order
    assert together < 0.1 * wide.abs().max().max()
