"""Joint angles: formula of the library, derivatives against finite differences."""

import numpy as np
import pytest
from plain_erkf import Segment
from scipy.spatial.transform import Rotation

from swaystride.erkf._angle_kernels import angle_variance, joint_angles
from swaystride.rotations import cardan_zxy_from_matrix


def drawn(seed):
    rng = np.random.default_rng(seed)
    states = rng.normal(size=(2, 13))
    between = Rotation.from_euler("ZXY", rng.uniform(-1, 1, size=3))
    first = Rotation.from_rotvec(rng.normal(size=3))
    mounts = Rotation.from_rotvec(rng.normal(size=(2, 3)))
    # first * mount^T is the anatomical frame of the proximal segment
    second = first * mounts[0].inv() * between * mounts[1]
    states[0, 6:10], states[1, 6:10] = (r.as_quat(scalar_first=True) for r in (first, second))
    return states, mounts.as_matrix(), between.as_matrix()


def angles_of(states, mounts):
    angles, jacobian = np.empty(3), np.empty((3, 6))
    joint_angles(states[0], states[1], mounts[0], mounts[1], angles, jacobian)
    return angles, jacobian


@pytest.mark.parametrize("seed", range(5))
def test_angles_and_their_derivatives(seed):
    states, mounts, between = drawn(seed)
    angles, jacobian = angles_of(states, mounts)
    np.testing.assert_allclose(angles, cardan_zxy_from_matrix(between), atol=1e-12)
    for side in range(2):
        for c in range(3):
            ends = []
            for h in (-1e-5, 1e-5):
                moved = states.copy()
                moved[side] = Segment.of(states[side]).plus(h * np.eye(12)[6 + c]).row()
                ends.append(angles_of(moved, mounts)[0])
            slope = (ends[1] - ends[0]) / 2e-5
            np.testing.assert_allclose(jacobian[:, 3 * side + c], slope, atol=1e-6)


@pytest.mark.parametrize("d", [9, 12])
def test_variance_takes_the_rotations_of_both_segments(d):
    rng = np.random.default_rng(d)
    factor, jacobian, out = rng.normal(size=(3 * d, 3 * d)), rng.normal(size=(3, 6)), np.empty(3)
    p = factor @ factor.T
    angle_variance(p, 2, 0, d, jacobian, out)
    rows = np.r_[2 * d + 6 : 2 * d + 9, 6:9]
    np.testing.assert_allclose(out, np.diag(jacobian @ p[np.ix_(rows, rows)] @ jacobian.T))
