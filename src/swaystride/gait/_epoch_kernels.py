"""Compiled kernels of the smoother: prediction and filter between epochs, smoothing, carrying back.

The error has nine states: velocity, orientation (a small rotation in the world frame,
``r_true = Exp(d) r``), gyroscope bias.
"""

from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.gait._quaternion_kernels import matrix, rotated, skew, tilted, turned
from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]
Index = NDArray[np.int64]


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def _predict(
    acc: Array,
    gyr: Array,
    step_s: float,
    first: int,
    last: int,
    bias: Array,
    velocity_noise: Array,
    angle_noise: Array,
    orientation: Array,
    velocity: Array,
    force: Array,
) -> tuple[Array, Array]:
    """Strapdown from sample `first` to `last`, with transition and noise of the error between them.

    One step of the error (velocity v, orientation θ, bias b) is
    ``v += −dt [a]× (θ − dt R b / 2) + w_v``, ``θ += −dt R b + w_θ``, with the mean force a and the
    mean rotation R of the step. Accumulated over steps, the blocks stay simple: dv/dθ and cov(v, θ) are
    skew-symmetric, cov(θ) is a multiple of the identity.
    """
    sx = sy = sz = 0.0
    mx = my = mz = 0.0
    turn = 0.0
    c = np.zeros((3, 3))
    d = np.zeros((3, 3))
    vxx = vxy = vxz = vyy = vyz = vzz = 0.0
    q = (orientation[first, 0], orientation[first, 1], orientation[first, 2], orientation[first, 3])
    before = rotated(q, acc[0, first], acc[1, first], acc[2, first])
    v0, v1, v2 = velocity[first, 0], velocity[first, 1], velocity[first, 2]
    r0 = matrix(q)
    for k in range(first, last):
        q = turned(
            q,
            0.5 * (gyr[0, k] + gyr[0, k + 1]) - bias[0],
            0.5 * (gyr[1, k] + gyr[1, k + 1]) - bias[1],
            0.5 * (gyr[2, k] + gyr[2, k + 1]) - bias[2],
            step_s,
        )
        after = rotated(q, acc[0, k + 1], acc[1, k + 1], acc[2, k + 1])
        ax, ay, az = (
            0.5 * step_s * (before[0] + after[0]),
            0.5 * step_s * (before[1] + after[1]),
            0.5 * step_s * (before[2] + after[2]),
        )
        force[k, 0], force[k, 1], force[k, 2] = ax, ay, az
        # d -= dt [a]x c with the c of the middle of the step: half before c changes, half after
        hx, hy, hz = 0.5 * ax, 0.5 * ay, 0.5 * az
        for j in range(3):
            d[0, j] -= hy * c[2, j] - hz * c[1, j]
            d[1, j] -= hz * c[0, j] - hx * c[2, j]
            d[2, j] -= hx * c[1, j] - hy * c[0, j]
        w, x, y, z = q
        n00, n01, n02 = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
        n10, n11, n12 = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
        n20, n21, n22 = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
        half = 0.5 * step_s
        c[0, 0] -= half * (r0[0, 0] + n00)
        c[0, 1] -= half * (r0[0, 1] + n01)
        c[0, 2] -= half * (r0[0, 2] + n02)
        c[1, 0] -= half * (r0[1, 0] + n10)
        c[1, 1] -= half * (r0[1, 1] + n11)
        c[1, 2] -= half * (r0[1, 2] + n12)
        c[2, 0] -= half * (r0[2, 0] + n20)
        c[2, 1] -= half * (r0[2, 1] + n21)
        c[2, 2] -= half * (r0[2, 2] + n22)
        for j in range(3):
            d[0, j] -= hy * c[2, j] - hz * c[1, j]
            d[1, j] -= hz * c[0, j] - hx * c[2, j]
            d[2, j] -= hx * c[1, j] - hy * c[0, j]
        r0[0, 0], r0[0, 1], r0[0, 2] = n00, n01, n02
        r0[1, 0], r0[1, 1], r0[1, 2] = n10, n11, n12
        r0[2, 0], r0[2, 1], r0[2, 2] = n20, n21, n22
        # cov(v) += a mᵀ-terms of cov(v, θ) = −[m]x, of cov(θ) = turn · I, and of the noise itself
        dot = 2.0 * (ax * mx + ay * my + az * mz) + turn * (ax * ax + ay * ay + az * az)
        dot += velocity_noise[k]
        vxx += dot - 2.0 * ax * mx - turn * ax * ax
        vyy += dot - 2.0 * ay * my - turn * ay * ay
        vzz += dot - 2.0 * az * mz - turn * az * az
        vxy -= ax * my + ay * mx + turn * ax * ay
        vxz -= ax * mz + az * mx + turn * ax * az
        vyz -= ay * mz + az * my + turn * ay * az
        mx += turn * ax
        my += turn * ay
        mz += turn * az
        turn += angle_noise[k]
        sx += ax
        sy += ay
        sz += az
        v0 += ax
        v1 += ay
        v2 += az - step_s * GRAVITY_M_S2
        (
            orientation[k + 1, 0],
            orientation[k + 1, 1],
            orientation[k + 1, 2],
            orientation[k + 1, 3],
        ) = q
        velocity[k + 1, 0], velocity[k + 1, 1], velocity[k + 1, 2] = v0, v1, v2
        before = after
    transition = np.eye(9)
    transition[0:3, 3:6] = -skew(np.array([sx, sy, sz]))
    transition[0:3, 6:9] = d
    transition[3:6, 6:9] = c
    noise = np.zeros((9, 9))
    noise[0, 0], noise[0, 1], noise[0, 2] = vxx, vxy, vxz
    noise[1, 0], noise[1, 1], noise[1, 2] = vxy, vyy, vyz
    noise[2, 0], noise[2, 1], noise[2, 2] = vxz, vyz, vzz
    cross = -skew(np.array([mx, my, mz]))
    noise[0:3, 3:6] = cross
    noise[3:6, 0:3] = cross.T
    for axis in range(3, 6):
        noise[axis, axis] = turn
    return transition, noise


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def filter_epochs(
    acc: Array,
    gyr: Array,
    step_s: float,
    epoch_index: Index,
    is_rest: NDArray[np.bool_],
    lever: Array,
    start_covariance: Array,
    start_bias: Array,
    velocity_noise: Array,
    angle_noise: Array,
    bias_walk: float,
    stance_sd: Array,
    lever_sd: float,
    rest_sd: Array,
    gate: float,
    longest_unaided_s: float,
    orientation: Array,
    velocity: Array,
    force: Array,
) -> tuple[Array, Array, Array, Array, Array, NDArray[np.bool_]]:
    """Error-state Kalman filter whose measurements exist only at zero-velocity epochs.

    Parameters
    ----------
    acc, gyr : array, shape (3, n)
        m/s² and rad/s in the sensor frame.
    step_s : float
        Time step.
    epoch_index : array of int, shape (m,)
        Rising; the filter starts at the first.
    is_rest : array of bool, shape (m,)
        At rest velocity and turning are nil; in stance the contact point stands still.
    lever : array, shape (3,)
        From the sensor to the contact point, in m, sensor frame.
    start_covariance : array, shape (9, 9)
        Of velocity, orientation, gyroscope bias at the first epoch.
    start_bias : array, shape (3,)
        rad/s.
    velocity_noise, angle_noise : array, shape (n - 1,)
        Variance that each step adds to each component of velocity and orientation.
    bias_walk : float
        Random walk of the bias, rad/s/√s.
    stance_sd : array, shape (3,)
        Of the velocity of the contact point along world x, y, z.
    lever_sd : float
        Of the lever in m; with the rate it adds to `stance_sd`.
    rest_sd : array, shape (2,)
        Of the velocity (m/s) and of the mean rate (rad/s) at rest.
    gate : float
        An epoch in stance whose squared, normalised innovation is larger is not believed.
    longest_unaided_s : float
        After this time without any epoch the next one is believed in any case.
    orientation, velocity, force : array, shape (n, 4), (n, 3), (n, 3)
        State at the first epoch; filled from there to the last. Samples at epochs hold the updated
        state. `force` is the velocity that the specific force adds in each step.

    Returns
    -------
    transition, covariance, decay, gain : array, shape (m, 9, 9) or (m, 9)
        Of the step to each epoch; covariance after the update; ``I − K H``; ``Hᵀ S⁻¹ y``.
    bias : array, shape (m, 3)
        After the update.
    believed : array of bool, shape (m,)
    """
    m = len(epoch_index)
    transitions = np.empty((m, 9, 9))
    covariances = np.empty((m, 9, 9))
    decays = np.empty((m, 9, 9))
    gains = np.zeros((m, 9))
    biases = np.empty((m, 3))
    believed = np.ones(m, dtype=np.bool_)
    bias = start_bias.copy()
    p = start_covariance.copy()
    last_believed = epoch_index[0]
    for e in range(m):
        k = epoch_index[e]
        if e == 0:
            transitions[e] = np.eye(9)
        else:
            before = epoch_index[e - 1]
            transition, noise = _predict(
                acc,
                gyr,
                step_s,
                before,
                k,
                bias,
                velocity_noise,
                angle_noise,
                orientation,
                velocity,
                force,
            )
            walk = bias_walk * bias_walk * step_s * (k - before)
            for axis in range(6, 9):
                noise[axis, axis] += walk
            p = transition @ p @ transition.T + noise
            transitions[e] = transition
        q = (orientation[k, 0], orientation[k, 1], orientation[k, 2], orientation[k, 3])
        rate = gyr[:, k] - bias
        if is_rest[e]:
            h = np.zeros((6, 9))
            r = np.zeros((6, 6))
            y = np.empty(6)
            for axis in range(3):
                h[axis, axis] = h[3 + axis, 6 + axis] = 1.0
                r[axis, axis] = rest_sd[0] ** 2
                r[3 + axis, 3 + axis] = rest_sd[1] ** 2
                y[axis] = -velocity[k, axis]
                y[3 + axis] = rate[axis]
        else:
            h = np.zeros((3, 9))
            r = np.zeros((3, 3))
            y = np.empty(3)
            rolling = rotated(
                q,
                rate[1] * lever[2] - rate[2] * lever[1],
                rate[2] * lever[0] - rate[0] * lever[2],
                rate[0] * lever[1] - rate[1] * lever[0],
            )
            h[0:3, 3:6] = -skew(np.array([rolling[0], rolling[1], rolling[2]]))
            h[0:3, 6:9] = matrix(q) @ skew(lever)
            spread = lever_sd**2 * (rate[0] ** 2 + rate[1] ** 2 + rate[2] ** 2)
            for axis in range(3):
                h[axis, axis] = 1.0
                r[axis, axis] = stance_sd[axis] ** 2 + spread
                y[axis] = -velocity[k, axis] - rolling[axis]
        s = h @ p @ h.T + r
        weighted = np.linalg.solve(s, y)
        unaided = step_s * (k - last_believed)
        if not is_rest[e] and y @ weighted > gate and unaided <= longest_unaided_s:
            believed[e] = False
            decays[e] = np.eye(9)
            covariances[e] = p
            biases[e] = bias
            continue
        last_believed = k
        gain = np.linalg.solve(s, h @ p).T
        decay = np.eye(9) - gain @ h
        change = gain @ y
        p = decay @ p @ decay.T + gain @ r @ gain.T
        p = 0.5 * (p + p.T)
        decays[e] = decay
        gains[e] = h.T @ weighted
        covariances[e] = p
        q = tilted(q, change[3], change[4], change[5])
        orientation[k, 0], orientation[k, 1], orientation[k, 2], orientation[k, 3] = q
        for axis in range(3):
            velocity[k, axis] += change[axis]
            bias[axis] += change[6 + axis]
        biases[e] = bias
    return transitions, covariances, decays, gains, biases, believed


@njit(cache=True)  # type: ignore[untyped-decorator, unused-ignore]
def smooth_epochs(
    step_s: float,
    epoch_index: Index,
    transitions: Array,
    covariances: Array,
    decays: Array,
    gains: Array,
    velocity_noise: Array,
    angle_noise: Array,
    orientation: Array,
    velocity: Array,
    force: Array,
) -> Array:
    """Bryson-Frazier smoother at the epochs, carried back into the samples between them, in place.

    Between two epochs the adjoint runs with the transposed step, and the smoothed error follows
    ``x[k+1] = F x[k] + Q adjoint[k+1]``: exactly the sample-wise smoother, at a few additions a
    sample and without any covariance inside the stride.

    Parameters
    ----------
    step_s : float
        Time step.
    epoch_index : array of int, shape (m,)
    transitions, covariances, decays, gains : array
        As from :func:`filter_epochs`.
    velocity_noise, angle_noise : array, shape (n - 1,)
    orientation, velocity : array, shape (n, 4) and (n, 3)
        Filtered; smoothed on return.
    force : array, shape (n, 3)

    Returns
    -------
    array, shape (m, 3)
        What smoothing adds to the bias at each epoch.
    """
    m = len(epoch_index)
    before = np.zeros((m, 9))
    after = np.zeros((m, 9))
    for back in range(m):
        e = m - 1 - back
        if e < m - 1:
            after[e] = transitions[e + 1].T @ before[e + 1]
        before[e] = decays[e].T @ after[e] + gains[e]
    bias_change = np.zeros((m, 3))
    for e in range(m):
        x = covariances[e] @ after[e]
        bias_change[e] = x[6:9]
        first = epoch_index[e]
        if e == m - 1:
            q = (
                orientation[first, 0],
                orientation[first, 1],
                orientation[first, 2],
                orientation[first, 3],
            )
            q = tilted(q, x[3], x[4], x[5])
            (
                orientation[first, 0],
                orientation[first, 1],
                orientation[first, 2],
                orientation[first, 3],
            ) = q
            for axis in range(3):
                velocity[first, axis] += x[axis]
            break
        v0, v1, v2, t0, t1, t2 = x[0], x[1], x[2], x[3], x[4], x[5]
        b0, b1, b2 = step_s * x[6], step_s * x[7], step_s * x[8]
        l0, l1, l2 = after[e, 0], after[e, 1], after[e, 2]
        a0, a1, a2 = after[e, 3], after[e, 4], after[e, 5]
        q = (
            orientation[first, 0],
            orientation[first, 1],
            orientation[first, 2],
            orientation[first, 3],
        )
        turned = rotated(q, b0, b1, b2)
        for k in range(first, epoch_index[e + 1]):
            n = k + 1
            q1 = (orientation[n, 0], orientation[n, 1], orientation[n, 2], orientation[n, 3])
            q = tilted(q, t0, t1, t2)
            orientation[k, 0], orientation[k, 1], orientation[k, 2], orientation[k, 3] = q
            velocity[k, 0] += v0
            velocity[k, 1] += v1
            velocity[k, 2] += v2
            fx, fy, fz = force[k, 0], force[k, 1], force[k, 2]
            a0 -= fy * l2 - fz * l1
            a1 -= fz * l0 - fx * l2
            a2 -= fx * l1 - fy * l0
            turned1 = rotated(q1, b0, b1, b2)
            d0 = 0.5 * (turned[0] + turned1[0])
            d1 = 0.5 * (turned[1] + turned1[1])
            d2 = 0.5 * (turned[2] + turned1[2])
            m0, m1, m2 = t0 - 0.5 * d0, t1 - 0.5 * d1, t2 - 0.5 * d2
            v0 += velocity_noise[k] * l0 - (fy * m2 - fz * m1)
            v1 += velocity_noise[k] * l1 - (fz * m0 - fx * m2)
            v2 += velocity_noise[k] * l2 - (fx * m1 - fy * m0)
            t0 += angle_noise[k] * a0 - d0
            t1 += angle_noise[k] * a1 - d1
            t2 += angle_noise[k] * a2 - d2
            turned = turned1
            q = q1
    return bias_change
