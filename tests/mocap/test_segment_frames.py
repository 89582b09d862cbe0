"""Frames of points: closed forms, an independent fit, planar angles."""

import numpy as np
from scipy.spatial.transform import Rotation

from swaystride.mocap.segment_frames import (
    mean_rotation,
    pelvis_frame,
    planar_angles,
    rigid_fit,
    trio_frame,
)


def test_rigid_fit_agrees_with_scipy(rng):
    template = rng.standard_normal((5, 3))
    turns = Rotation.random(20, rng=rng).as_matrix()
    points = np.einsum("nab,mb->mna", turns, template) + rng.standard_normal((20, 3))
    noisy = points + 0.1 * rng.standard_normal(points.shape)
    r, origin, residual = rigid_fit(noisy, template)
    for n in range(20):
        centred = noisy[:, n] - noisy[:, n].mean(axis=0)
        expected, rssd = Rotation.align_vectors(centred, template - template.mean(axis=0))
        np.testing.assert_allclose(r[n], expected.as_matrix(), atol=1e-9)
        np.testing.assert_allclose(residual[n], rssd / np.sqrt(5), atol=1e-9)
    _, _, exact = rigid_fit(points, template)
    assert exact.max() < 1e-12
    np.testing.assert_allclose(
        np.einsum("nab,mb->mna", r, template).mean(axis=0) + origin, noisy.mean(axis=0), atol=1e-9
    )


def test_flat_points_are_not_mirrored(rng):
    """Three points have no handedness; the fit must still be a rotation."""
    template = rng.standard_normal((3, 3))
    turn = Rotation.random(rng=rng).as_matrix()
    r, _, _ = rigid_fit((template @ turn.T)[:, None], template)
    np.testing.assert_allclose(r[0], turn, atol=1e-9)


def test_pelvis_of_somebody_who_faces_left():
    front = np.array([[[0.12, 0.0, 1.0]], [[-0.12, 0.0, 1.0]]])
    back = front * [0.4, 1.0, 1.0] + [0.0, -0.16, 0.0]
    r, origin = pelvis_frame(front, back)
    np.testing.assert_allclose(r[0].T, [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(origin[0], [0.0, 0.0, 1.0])


def test_trio_frame_has_its_axes_in_the_plane(rng):
    p, w, d = rng.standard_normal((3, 50, 3))
    r = trio_frame(p, w, d)
    np.testing.assert_allclose(np.linalg.det(r), 1.0)
    x = r[..., 0]
    for side in (p - d, w - d):
        np.testing.assert_allclose(np.sum(x * side, axis=1), 0.0, atol=1e-9)
    assert (np.sum(r[..., 2] * (w - d), axis=1) > 0).all()


def test_planar_angles_of_a_triangle_sum_to_its_outer_angle(rng):
    p, w, d = rng.standard_normal((3, 50, 3))
    first, last, middle = planar_angles(p, w, d)
    u, v = p - w, d - w
    inner = np.arccos(np.sum(u * v, 1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1))
    np.testing.assert_allclose(middle, np.pi - inner, atol=1e-7)
    np.testing.assert_allclose(first + last + inner, np.pi, atol=1e-7)


def test_mean_rotation_of_turns_about_one_axis():
    turns = Rotation.from_rotvec(np.outer([0.1, 0.2, 0.6], [0.0, 0.0, 1.0])).as_matrix()
    mean = Rotation.from_matrix(mean_rotation(turns)).as_rotvec()
    angles = np.array([0.1, 0.2, 0.6])
    expected = np.arctan2(np.sin(angles).sum(), np.cos(angles).sum())
    np.testing.assert_allclose(mean, [0.0, 0.0, expected], atol=1e-12)
