"""Rotations: conventions against hand-written matrices, and round trips."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from swaystride import rotations as rot

Array = NDArray[np.float64]
SEEDS = st.integers(0, 2**32 - 1)


def rx(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])


def ry(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def rz(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def hamilton(p: Array, q: Array) -> Array:
    """Product of two quaternions, scalar first, written out."""
    (a, u), (b, v) = (p[0], p[1:]), (q[0], q[1:])
    return np.concatenate([[a * b - u @ v], a * v + b * u + np.cross(u, v)])


def unit_quaternions(seed: int, n: int = 5) -> Array:
    q = np.random.default_rng(seed).normal(size=(n, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


@given(SEEDS)
def test_quaternion_products_are_matrix_products(seed: int) -> None:
    p, q = unit_quaternions(seed, 2)
    np.testing.assert_allclose(
        rot.matrix_from_quaternion(hamilton(p, q)),
        rot.matrix_from_quaternion(p) @ rot.matrix_from_quaternion(q),
        atol=1e-12,
    )


@given(SEEDS)
def test_quaternion_round_trip(seed: int) -> None:
    q = unit_quaternions(seed)
    back = rot.quaternion_from_matrix(rot.matrix_from_quaternion(q))
    assert (back[:, 0] >= 0).all()
    np.testing.assert_allclose(np.abs(np.sum(back * q, axis=1)), 1.0, atol=1e-12)


@given(SEEDS, st.floats(0.1, 10.0))
def test_the_length_of_a_quaternion_does_not_matter(seed: int, length: float) -> None:
    q = unit_quaternions(seed)
    np.testing.assert_allclose(
        rot.matrix_from_quaternion(length * q), rot.matrix_from_quaternion(q), atol=1e-12
    )


@given(arrays(np.float64, 3, elements=st.floats(-3.1, 3.1)))
def test_roll_pitch_yaw_is_yaw_then_pitch_then_roll(angles: Array) -> None:
    roll, pitch, yaw = angles
    np.testing.assert_allclose(
        rot.matrix_from_quaternion(rot.quaternion_from_roll_pitch_yaw(angles)),
        rz(yaw) @ ry(pitch) @ rx(roll),
        atol=1e-12,
    )


@given(arrays(np.float64, (4, 3), elements=st.floats(-1.8, 1.8)))
def test_log_undoes_exp_below_half_a_turn(vectors: Array) -> None:
    np.testing.assert_allclose(rot.log_map(rot.exp_map(vectors)), vectors, atol=1e-7)


@given(SEEDS)
def test_exp_undoes_log(seed: int) -> None:
    r = rot.matrix_from_quaternion(unit_quaternions(seed))
    np.testing.assert_allclose(rot.exp_map(rot.log_map(r)), r, atol=1e-7)


def test_exp_about_each_axis() -> None:
    for axis, matrix in enumerate((rx, ry, rz)):
        np.testing.assert_allclose(rot.exp_map(0.7 * np.eye(3)[axis]), matrix(0.7), atol=1e-12)


@given(arrays(np.float64, 3, elements=st.floats(-1.5, 1.5)))
def test_cardan_angles_are_z_then_x_then_y(angles: Array) -> None:
    alpha, beta, gamma = angles
    r = rot.matrix_from_cardan_zxy(angles)
    np.testing.assert_allclose(r, rz(alpha) @ rx(beta) @ ry(gamma), atol=1e-12)
    np.testing.assert_allclose(rot.cardan_zxy_from_matrix(r), angles, atol=1e-9)


@given(SEEDS)
def test_cardan_angles_of_any_rotation_give_it_back(seed: int) -> None:
    r = rot.matrix_from_quaternion(unit_quaternions(seed))
    np.testing.assert_allclose(
        rot.matrix_from_cardan_zxy(rot.cardan_zxy_from_matrix(r)), r, atol=1e-6
    )


SHAPES = [
    (rot.quaternion_from_matrix, (3, 3), (4,)),
    (rot.matrix_from_quaternion, (4,), (3, 3)),
    (rot.quaternion_from_roll_pitch_yaw, (3,), (4,)),
    (rot.exp_map, (3,), (3, 3)),
    (rot.log_map, (3, 3), (3,)),
    (rot.matrix_from_cardan_zxy, (3,), (3, 3)),
]


def valid_input(shape: tuple[int, ...], leading: tuple[int, ...]) -> Array:
    if shape == (3, 3):
        return np.broadcast_to(rz(0.4), (*leading, 3, 3)).copy()
    return np.full((*leading, *shape), 0.3)


@pytest.mark.parametrize(("function", "shape_in", "shape_out"), SHAPES)
@pytest.mark.parametrize("leading", [(), (0,), (1,), (2, 5)])
def test_any_leading_shape_and_nan_rows(
    function: Callable[[Array], Array],
    shape_in: tuple[int, ...],
    shape_out: tuple[int, ...],
    leading: tuple[int, ...],
) -> None:
    values = valid_input(shape_in, leading)
    out = function(values)
    assert out.shape == (*leading, *shape_out)
    assert np.isfinite(out).all()
    if leading == (2, 5):
        values[1, 2].flat[1] = np.nan
        again = function(values)
        assert np.isnan(again[1, 2]).all()
        again[1, 2] = out[1, 2]
        np.testing.assert_array_equal(again, out)


def test_a_wrong_shape_is_refused() -> None:
    with pytest.raises(ValueError, match=r"the last axes must be \(4,\), not \(3,\)"):
        rot.matrix_from_quaternion([1.0, 0.0, 0.0])
