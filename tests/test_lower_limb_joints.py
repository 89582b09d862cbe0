"""The one definition of joint angles: a round trip, signs, missing samples."""

import numpy as np

from swaystride.lower_limb_joints import (
    ANGLE_SIGNS,
    JOINT_NAMES,
    LOWER_LIMB_JOINTS,
    SEGMENTS,
    lower_limb_angles,
)
from swaystride.rotations import exp_map, matrix_from_cardan_zxy


def posed(raw):
    """Segments with raw Cardan angles (n, 6, 3) under a pelvis that lies anyhow."""
    r = np.empty((len(raw), len(SEGMENTS), 3, 3))
    r[:, 0] = exp_map([0.3, -1.0, 0.7])
    for row, (_, _, proximal, distal) in enumerate(LOWER_LIMB_JOINTS):
        above = r[:, SEGMENTS.index(proximal)]
        r[:, SEGMENTS.index(distal)] = above @ matrix_from_cardan_zxy(raw[:, row])
    return r


def test_round_trip_with_signs():
    raw = np.random.default_rng(1).uniform(-1.0, 1.0, (40, 6, 3))
    signs = np.array([ANGLE_SIGNS[kind, side] for kind, side, _, _ in LOWER_LIMB_JOINTS])
    np.testing.assert_allclose(lower_limb_angles(posed(raw)), raw * signs, atol=1e-12)


def test_flexed_knees_are_positive_and_toes_in_are_internal_on_both_sides():
    bent = np.zeros((1, 6, 3))
    bent[0, [2, 3], 0] = -1.0  # the shank turns backwards: about -z
    bent[0, [0, 1], 2] = [0.3, -0.3]  # z right, y up: the right thigh turns to the left
    found = dict(zip(JOINT_NAMES, lower_limb_angles(posed(bent))[0], strict=True))
    for side in ("right", "left"):
        assert found[f"{side}_knee"][0] > 0.9
        assert found[f"{side}_hip"][2] > 0.2


def test_a_whole_turn_is_unwrapped_across_missing_samples():
    raw = np.zeros((200, 6, 3))
    raw[:, 0, 0] = np.linspace(0.0, 7.0, 200)
    r = posed(raw)
    r[50:60, 0] = np.nan
    found = lower_limb_angles(r)[:, 0, 0]
    seen = np.isfinite(found)
    assert seen.sum() == 190
    np.testing.assert_allclose(found[seen], raw[seen, 0, 0], atol=1e-9)
