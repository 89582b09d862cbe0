"""Average joint axes: found again in another person, mirrored, averaged, and those that are shipped."""

import numpy as np
import optical_person
import pytest

from swaystride.errors import RecordingError
from swaystride.mocap.joint_axes import (
    FALLBACK_SHIFT_M,
    RECIPES,
    average_joint_axes,
    person_axes,
    public_joint_axes,
)
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT
from swaystride.mocap.static_calibration import OpticalOptions, static_model


@pytest.mark.parametrize("recipe", RECIPES)
def test_a_person_gets_the_own_centres_back(static, with_medial, recipe):
    axes = average_joint_axes([person_axes(static, with_medial, recipe)], "the person", recipe)
    both = [
        static_model(
            static,
            with_medial,
            optical_person.BODY,
            options=OpticalOptions(centres, "axes", True, "malleoli"),
            axes=axes,
        )
        for centres in ("average_axes", "medial_markers")
    ]
    for joint, centre in both[0].standing_centre_m.items():
        np.testing.assert_allclose(centre, both[1].standing_centre_m[joint], atol=1e-9)
    knee, ankle = (both[0].standing_centre_m[f"right_{kind}"] for kind in ("knee", "ankle"))
    assert ankle == pytest.approx([0.0, -optical_person.SHANK_M, 0.0])
    assert np.linalg.norm(knee) == pytest.approx(optical_person.THIGH_M, rel=0.02)


def test_a_pelvis_forward_axis_points_where_the_person_looks(static, with_medial):
    knee, ankle = person_axes(static, with_medial, "pelvis_forward")
    # lateral to medial along z; the shank markers lean outwards by the difference of the widths
    lean = np.arctan2(
        optical_person.KNEE_OUT_M - optical_person.ANKLE_OUT_M, optical_person.SHANK_M
    )
    np.testing.assert_allclose(knee, [0.0, -np.sin(lean), -np.cos(lean)], atol=1e-9)
    np.testing.assert_allclose(ankle, knee, atol=1e-9)


def test_average_and_scatter():
    people = [np.array([[a, 0.0, -1.0], [0.0, 0.0, -1.0]]) for a in (-0.1, 0.1)]
    axes = average_joint_axes(people, "two", "spine_plane")
    np.testing.assert_allclose(axes.knee, [0.0, 0.0, -1.0], atol=1e-12)
    np.testing.assert_allclose(axes.knee_sd, [np.sqrt(0.02), 0.0, 0.0])
    # two people say little about the scatter
    np.testing.assert_allclose(axes.centre_shift_m("knee", 0.06), FALLBACK_SHIFT_M)
    many = average_joint_axes(people * 3, "six", "spine_plane")
    np.testing.assert_allclose(many.centre_shift_m("knee", 0.06), 0.06 * many.knee_sd)


@pytest.mark.parametrize("recipe", RECIPES)
def test_shipped_axes_are_unit_vectors_with_their_people(recipe):
    axes = public_joint_axes(recipe)
    assert axes.n_people == 2
    assert "Fukuchi" in axes.source
    for axis in (axes.knee, axes.ankle):
        assert np.linalg.norm(axis) == pytest.approx(1.0)
        assert axis[2] < -0.7


def test_no_medial_landmarks(static):
    with pytest.raises(RecordingError, match=r"static\.c3d: no medial landmarks"):
        person_axes(static, CONVENTIONAL_GAIT, "spine_plane")
