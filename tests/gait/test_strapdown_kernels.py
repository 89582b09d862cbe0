import numpy as np
from closed_form_walk import walk
from scipy.spatial.transform import Rotation

from swaystride.gait._strapdown_kernels import (
    integrate_backward,
    orientation_with_tilt,
    velocity_between_epochs,
)
from swaystride.units import GRAVITY_M_S2


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def slow_orientation(gyr, step_s, start, epochs, ups, sds, start_sd, rate_noise):
    r, p = Rotation.from_quat(start, scalar_first=True), np.diag([start_sd**2, start_sd**2, 0.0])
    out, last = [], 0
    for k in range(gyr.shape[1]):
        if k:
            r = r * Rotation.from_rotvec(0.5 * (gyr[:, k - 1] + gyr[:, k]) * step_s)
        for e in np.flatnonzero(epochs == k):
            p = p + rate_noise**2 * step_s * (k - last) * np.eye(3)
            last = k
            h, y = skew([0.0, 0.0, 1.0]), r.apply(ups[e]) - [0.0, 0.0, 1.0]
            gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + sds[e] ** 2 * np.eye(3))
            r = Rotation.from_rotvec(gain @ y) * r
            p = (np.eye(3) - gain @ h) @ p
        out.append(r.as_matrix())
    return np.array(out)


def test_orientation_with_tilt_equals_its_slow_twin():
    rng = np.random.default_rng(3)
    gyr = rng.standard_normal((3, 120))
    epochs = np.array([0, 30, 31, 119])
    ups = rng.standard_normal((4, 3)) * 0.1 + [0.0, 0.0, 1.0]
    ups /= np.linalg.norm(ups, axis=1, keepdims=True)
    arguments = (
        gyr,
        0.01,
        np.array([1.0, 0.0, 0.0, 0.0]),
        epochs,
        ups,
        np.array([0.01, 0.05, 0.05, 0.05]),
    )
    fast = orientation_with_tilt(*arguments, 0.1, 0.02)
    matrices = Rotation.from_quat(fast, scalar_first=True).as_matrix()
    assert np.abs(matrices - slow_orientation(*arguments, 0.1, 0.02)).max() < 1e-12


def test_repeated_updates_bring_the_tilt_to_the_accelerometer():
    """A still sensor whose true up differs from the start: the filter goes there."""
    up = np.array([0.3, -0.2, 0.9])
    up /= np.linalg.norm(up)
    epochs = np.arange(0, 2000, 10)
    out = orientation_with_tilt(
        np.zeros((3, 2000)),
        0.01,
        np.array([1.0, 0.0, 0.0, 0.0]),
        epochs,
        np.tile(up, (len(epochs), 1)),
        np.full(len(epochs), 0.01),
        0.5,
        0.01,
    )
    seen = Rotation.from_quat(out[-1], scalar_first=True).apply(up)
    assert np.allclose(seen, [0.0, 0.0, 1.0], atol=1e-6)


def test_velocity_between_epochs_equals_its_slow_twin():
    rng = np.random.default_rng(4)
    acc = rng.standard_normal((3, 90)) + np.array([[0.0], [0.0], [GRAVITY_M_S2]])
    quaternions = rng.standard_normal((90, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    epochs, step_s = np.array([5, 40, 80]), 0.02
    force = Rotation.from_quat(quaternions, scalar_first=True).apply(acc.T) - [0, 0, GRAVITY_M_S2]
    slow = np.zeros((90, 3))
    for first, last in ((5, 40), (40, 80)):
        raw = np.concatenate(
            [
                np.zeros((1, 3)),
                np.cumsum(0.5 * step_s * (force[first:last] + force[first + 1 : last + 1]), axis=0),
            ]
        )
        share = np.arange(last - first + 1)[:, None] / (last - first)
        slow[first : last + 1] = raw - share * raw[-1]
    assert np.abs(velocity_between_epochs(acc, quaternions, step_s, epochs) - slow).max() < 1e-12


def test_integrating_backward_undoes_the_walk():
    own = walk(n_strides=2, rate_hz=1000.0)
    n = own.acc.shape[1]
    quaternion, velocity = np.empty((n, 4)), np.empty((n, 3))
    quaternion[-1], velocity[-1] = [1.0, 0.0, 0.0, 0.0], 0.0
    integrate_backward(own.acc, own.gyr, 1e-3, np.zeros(3), n - 1, quaternion, velocity)
    assert np.abs(velocity.T - own.velocity).max() < 2e-3
    assert (
        np.abs(Rotation.from_quat(quaternion, scalar_first=True).as_matrix() - own.matrix).max()
        < 1e-4
    )
