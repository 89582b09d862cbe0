"""Slow plain twin of the epoch smoother: dense matrices, every sample, textbook RTS recursion."""

import numpy as np
from scipy.spatial.transform import Rotation

from swaystride.units import GRAVITY_M_S2


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def smooth_every_sample(
    acc,
    gyr,
    step_s,
    epochs,
    is_rest,
    lever,
    p0,
    start,
    bias_walk,
    qv,
    qw,
    stance_sd,
    lever_sd,
    rest_sd,
):
    """Filter forward with one transition per sample, then Rauch-Tung-Striebel over all samples.

    Returns rotation matrices (n, 3, 3), velocities (n, 3) and biases (n, 3) from the first epoch to
    the last; no gate.
    """
    first, last = epochs[0], epochs[-1]
    n = last - first + 1
    rotation, velocity = np.empty((n, 3, 3)), np.empty((n, 3))
    bias, predicted_p, filtered_p = np.empty((n, 3)), np.empty((n, 9, 9)), np.empty((n, 9, 9))
    step_f, update = np.empty((n, 9, 9)), np.zeros((n, 9))
    r, v, b, p = (
        Rotation.from_quat(start, scalar_first=True).as_matrix(),
        np.zeros(3),
        np.zeros(3),
        p0,
    )
    which = {k: e for e, k in enumerate(epochs)}
    since = first
    for i in range(n):
        k = first + i
        if i > 0:
            rate = 0.5 * (gyr[:, k - 1] + gyr[:, k]) - b
            r1 = r @ Rotation.from_rotvec(rate * step_s).as_matrix()
            force = 0.5 * (r @ acc[:, k - 1] + r1 @ acc[:, k])
            f = np.eye(9)
            f[0:3, 3:6] = -step_s * skew(force)
            f[3:6, 6:9] = -step_s * 0.5 * (r + r1)
            f[0:3, 6:9] = 0.5 * f[0:3, 3:6] @ f[3:6, 6:9]
            v = v + step_s * (force - np.array([0.0, 0.0, GRAVITY_M_S2]))
            r = r1
            q = np.diag([qv[k - 1]] * 3 + [qw[k - 1]] * 3 + [0.0] * 3)
            if k in which:
                q[6:9, 6:9] = bias_walk**2 * step_s * (k - since) * np.eye(3)
                since = k
            p = f @ p @ f.T + q
            step_f[i] = f
        predicted_p[i] = p
        if k in which:
            rate = gyr[:, k] - b
            if is_rest[which[k]]:
                h = np.zeros((6, 9))
                h[0:3, 0:3] = h[3:6, 6:9] = np.eye(3)
                noise = np.diag([rest_sd[0] ** 2] * 3 + [rest_sd[1] ** 2] * 3)
                y = np.concatenate([-v, rate])
            else:
                h = np.zeros((3, 9))
                rolling = r @ np.cross(rate, lever)
                h[:, 0:3], h[:, 3:6], h[:, 6:9] = np.eye(3), -skew(rolling), r @ skew(lever)
                noise = np.diag(np.square(stance_sd)) + lever_sd**2 * (rate @ rate) * np.eye(3)
                y = -v - rolling
            gain = p @ h.T @ np.linalg.inv(h @ p @ h.T + noise)
            x = gain @ y
            decay = np.eye(9) - gain @ h
            p = decay @ p @ decay.T + gain @ noise @ gain.T
            v, b = v + x[0:3], b + x[6:9]
            r = Rotation.from_rotvec(x[3:6]).as_matrix() @ r
            update[i] = x
        rotation[i], velocity[i], bias[i], filtered_p[i] = r, v, b, p
    x = np.zeros(9)
    smoothed = [np.array(a) for a in (rotation, velocity, bias)]
    for i in range(n - 1, -1, -1):
        smoothed[0][i] = Rotation.from_rotvec(x[3:6]).as_matrix() @ rotation[i]
        smoothed[1][i] = velocity[i] + x[0:3]
        smoothed[2][i] = bias[i] + x[6:9]
        if i:
            back = filtered_p[i - 1] @ step_f[i].T @ np.linalg.inv(predicted_p[i])
            x = back @ (x + update[i])
    return smoothed
