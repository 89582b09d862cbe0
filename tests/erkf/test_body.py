"""The body: axes from mountings, centres from poses, unknown names."""

import numpy as np
import pytest

from swaystride.erkf.body import SEGMENTS, centres_in_sensors, lower_limb_body
from swaystride.errors import RecordingError
from swaystride.rotations import exp_map


def body(**options):
    mounting = exp_map(np.random.default_rng(1).normal(size=(7, 3)))
    names = [f"{side}_{kind}" for side in ("right", "left") for kind in ("hip", "knee", "ankle")]
    centres = {name: (np.zeros(3), np.ones(3)) for name in names}
    return lower_limb_body(mounting, centres, {}, **options)


def test_default_axes_are_the_anatomical_z_of_hips_and_knees():
    made = body()
    for joint in made.joints:
        if joint.kind == "ankle":
            assert joint.proximal_axis is None
            continue
        for segment, axis in (
            (joint.proximal, joint.proximal_axis),
            (joint.distal, joint.distal_axis),
        ):
            r = made.r_anatomical_from_sensor[SEGMENTS.index(segment)]
            np.testing.assert_allclose(r @ axis, [0.0, 0.0, 1.0], atol=1e-12)


def test_given_axes_replace_all_defaults():
    made = body(axes={"left_knee": (np.ones(3), np.ones(3))})
    assert [j.name for j in made.joints if j.proximal_axis is not None] == ["left_knee"]


def test_unknown_segment():
    with pytest.raises(RecordingError, match=r"expected pelvis, .*; found tail"):
        body().index("tail")


def test_centres_seen_from_a_moving_sensor(walk):
    joint = walk.body.joints[2]
    j = walk.body.index(joint.proximal)
    r, p = walk.rotation[:, j], walk.position[:, j]
    centre = p + r @ joint.proximal_centre_m
    centre[7] = np.nan
    np.testing.assert_allclose(centres_in_sensors(centre, p, r), joint.proximal_centre_m, atol=1e-9)
