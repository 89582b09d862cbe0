"""Slow plain twin of the filter: dense matrices, one stacked update per sample, textbook RTS."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from swaystride.erkf.constraints import ContactPoint, JointAxis, JointCentre, Tilt, ZeroVelocity
from swaystride.units import GRAVITY_M_S2


def skew(v):
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def exp(v):
    return Rotation.from_rotvec(v).as_matrix()


def right_jacobian(v):
    a = np.linalg.norm(v)
    s = skew(v)
    if a < 1e-6:
        return np.eye(3) - 0.5 * s + s @ s / 6.0
    return np.eye(3) - (1 - np.cos(a)) / a**2 * s + (a - np.sin(a)) / a**3 * s @ s


@dataclass
class Segment:
    """Nominal state with a rotation matrix in place of the quaternion."""

    p: np.ndarray
    v: np.ndarray
    r: np.ndarray
    b: np.ndarray

    @classmethod
    def of(cls, row):
        r = Rotation.from_quat(row[6:10], scalar_first=True).as_matrix()
        return cls(row[0:3].copy(), row[3:6].copy(), r, row[10:13].copy())

    def row(self):
        q = Rotation.from_matrix(self.r).as_quat(scalar_first=True)
        return np.concatenate([self.p, self.v, q, self.b])

    def plus(self, x):
        b = self.b + x[9:12] if len(x) > 9 else self.b
        return Segment(self.p + x[0:3], self.v + x[3:6], self.r @ exp(x[6:9]), b)


def minus(one, two, d):
    """Error that takes state `two` to state `one`."""
    turned = Rotation.from_matrix(two.r.T @ one.r).as_rotvec()
    return np.concatenate([one.p - two.p, one.v - two.v, turned, one.b - two.b])[:d]


def step(x, before, after, dt, midpoint, d):
    """Next state of one segment and the transition of its error."""
    rate = (0.5 * (before[3:] + after[3:]) if midpoint else before[3:]) - x.b
    turn, jr = exp(rate * dt), right_jacobian(rate * dt)
    force = 0.5 * (before[:3] + turn @ after[:3]) if midpoint else before[:3]
    acc = x.r @ force - np.array([0.0, 0.0, GRAVITY_M_S2])
    f = np.eye(12)
    f[0:3, 3:6] = dt * np.eye(3)
    f[3:6, 6:9] = -dt * x.r @ skew(force)
    f[6:9, 6:9] = turn.T
    f[6:9, 9:12] = -dt * jr
    if midpoint:
        f[3:6, 9:12] = 0.5 * dt**2 * x.r @ turn @ skew(after[:3]) @ jr
    f[0:3, 6:12] = 0.5 * dt * f[3:6, 6:12]
    new = Segment(x.p + dt * x.v + 0.5 * dt**2 * acc, x.v + dt * acc, x.r @ turn, x.b)
    return new, f[:d, :d]


def measured(constraint, states, signals):
    """Residual, Jacobians per segment (3, 12) and variance of a constraint, written out."""
    h = np.zeros((2, 3, 12))
    one = states[constraint.segments[0]]
    match constraint:
        case ZeroVelocity():
            h[0, :, 3:6] = np.eye(3)
            return -one.v, h, constraint.velocity_sd_m_s**2
        case ContactPoint():
            rate, lever = signals[constraint.foot, 3:6] - one.b, constraint.lever_m
            rolling = np.cross(rate, lever)
            h[0, :, 3:6], h[0, :, 6:9] = np.eye(3), -one.r @ skew(rolling)
            h[0, :, 9:12] = one.r @ skew(lever)
            noise = constraint.velocity_sd_m_s**2 + constraint.lever_sd_m**2 * rate @ rate
            noise += constraint.rate_sd_rad_s**2 * lever @ lever
            return -one.v - one.r @ rolling, h, noise
        case Tilt():
            up = one.r.T @ [0.0, 0.0, 1.0]
            a = signals[constraint.segment, 0:3]
            h[0, :, 6:9] = skew(up)
            return a / np.linalg.norm(a) - up, h, constraint.direction_sd**2
        case JointCentre() | JointAxis():
            two = states[constraint.segments[1]]
            u1, u2 = constraint.vectors
            h[0, :, 6:9], h[1, :, 6:9] = -one.r @ skew(u1), two.r @ skew(u2)
            gap = one.r @ u1 - two.r @ u2
            if isinstance(constraint, JointAxis):
                return -gap, h, constraint.chord_sd**2
            h[0, :, 0:3], h[1, :, 0:3] = np.eye(3), -np.eye(3)
            return -(one.p - two.p + gap), h, constraint.distance_sd_m**2
    raise TypeError(constraint)


def stacked(constraints, due, states, signals, d):
    """Residual, Jacobian and noise of all constraints of a sample."""
    residuals, rows, noise = [], [], []
    for constraint, now in zip(constraints, due, strict=True):
        if not now:
            continue
        residual, h, variance = measured(constraint, states, signals)
        block = np.zeros((3, d * len(states)))
        for side, place in enumerate(constraint.segments):
            block[:, d * place : d * (place + 1)] = h[side, :, :d]
        residuals.append(residual)
        rows.append(block)
        noise += [variance] * 3
    return np.concatenate(residuals), np.concatenate(rows), np.diag(noise)


def plain_filter(model, constraints, start, p):
    """All samples; returns what the smoother needs, by sample."""
    d = len(model.noise)
    states = [Segment.of(row) for row in start]
    m = len(states)
    q = np.diag(np.tile(model.noise, m))
    history = {name: [] for name in ("p0", "f", "x", "p", "update", "g")}
    for k, signals in enumerate(model.signals):
        f, g, x = np.eye(m * d), np.eye(m * d), np.zeros(m * d)
        states = list(states)
        if k:
            before = model.signals[k - 1]
            for j in range(m):
                o = slice(d * j, d * (j + 1))
                states[j], f[o, o] = step(
                    states[j], before[j], signals[j], model.step_s, model.midpoint, d
                )
            rough = np.zeros((m, d))
            rough[:, 3:6] = model.roughness[k, :, :1]
            rough[:, 6:9] = model.roughness[k, :, 1:]
            p = f @ p @ f.T + q + np.diag(rough.ravel())
        history["p0"].append(p)
        history["f"].append(f)
        if model.active[k].any():
            y, h, c = stacked(constraints, model.active[k], states, signals, d)
            gain = np.linalg.solve(h @ p @ h.T + c, h @ p).T
            decay = np.eye(m * d) - gain @ h
            p = decay @ p @ decay.T + gain @ c @ gain.T
            x = gain @ y
            states = [s.plus(x[d * j : d * (j + 1)]) for j, s in enumerate(states)]
            for j in range(m):
                o = slice(d * j + 6, d * j + 9)
                g[o, o] -= 0.5 * skew(x[o])
            p = g @ p @ g.T
            p = 0.5 * (p + p.T)
        history["x"].append(states)
        history["p"].append(p)
        history["update"].append(x)
        history["g"].append(g)
    return history


def plain_smoother(history, d):
    """Rauch-Tung-Striebel of the errors; returns smoothed states and covariances.

    The error before the update and reset of a sample is ``G⁻¹ x + update`` of that after them.
    """
    n = len(history["x"])
    states, covariances = [None] * n, [None] * n
    states[-1], covariances[-1] = history["x"][-1], history["p"][-1]
    x = np.zeros(len(history["update"][0]))
    for k in range(n - 2, -1, -1):
        p, f, predicted = history["p"][k], history["f"][k + 1], history["p0"][k + 1]
        back = np.linalg.solve(predicted, f @ p).T
        undo = np.linalg.inv(history["g"][k + 1])
        x = back @ (undo @ x + history["update"][k + 1])
        states[k] = [s.plus(x[d * j : d * (j + 1)]) for j, s in enumerate(history["x"][k])]
        before = undo @ covariances[k + 1] @ undo.T
        covariances[k] = p + back @ (before - predicted) @ back.T
    return states, covariances
