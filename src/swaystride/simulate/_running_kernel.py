"""Compiled kernel: segments of the running body from its generalised coordinates.

One row of the state per segment holds its orientation ``r_world_from_segment`` (9 numbers, row by
row), angular velocity and acceleration in its own axes, and position, velocity and acceleration of
its origin (the proximal joint) in the world. Segment axes are x anterior, y proximal, z right. The
slow plain twin stands in the tests.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.simulate._running_coordinates import (
    foot_coordinates,
    impact_pulse,
    periodic_coordinates,
    step_height,
)
from swaystride.simulate._running_jets import (
    Jet,
    add,
    arcsine,
    arctangent,
    mul,
    over,
    quintic,
    root,
    scaled,
    sine_cosine,
    sub,
)

Array = NDArray[np.float64]


class BodyTables(NamedTuple):
    """Everything that the kernel needs, as plain arrays; sides in the order right, left.

    Short rows are padded at their end with pieces that begin at infinity.

    Parameters
    ----------
    joints : array, shape (14, 3)
        Proximal joints of the segments (rows as in the state) in the axes of their parents.
    links : array, shape (2,)
        Lengths of thigh and shank.
    path : array, shape (4, n, 7)
        Start and coefficients of x, y and heading of the path, and of the belt.
    steps : array, shape (n, 7)
        See :func:`~swaystride.simulate._running_coordinates.step_height`.
    pulses : array, shape (5, 7)
        Pulses of pelvis and head, and wobbles of thigh, shank and pelvis.
    strength : array, shape (2, n, 3)
        Size of each impact for pelvis, head, and tissue.
    contact_s, phase, offset, amplitude, fourier : array
        See :func:`~swaystride.simulate._running_coordinates.periodic_coordinates`.
    pieces, stances, sole, edges : array
        See :func:`~swaystride.simulate._running_coordinates.foot_coordinates`.
    """

    joints: Array
    links: Array
    path: Array
    steps: Array
    pulses: Array
    strength: Array
    contact_s: Array
    phase: Array
    offset: Array
    amplitude: Array
    fourier: Array
    pieces: Array
    stances: Array
    sole: Array
    edges: Array


#: Rows of the state.
PELVIS, THIGHS, SHANKS, FEET, TRUNK, HEAD, UPPER_ARMS, FOREARMS, PATH = 0, 1, 3, 5, 7, 8, 9, 11, 13
N_ROWS = 14
#: Rows of the coordinates: of the phase of a leg the leg itself and the other arm, of the phase of
#: the steps (BODY) pelvis, trunk and head.
BODY = 2
HIP_ROTATION, KNEE_ADDUCTION, KNEE_ROTATION, SHOULDER, ELBOW, OSCILLATION = 0, 1, 2, 3, 6, 7
PELVIS_ANGLES, TRUNK_ANGLES, HEAD_ANGLES, N_COORDINATES = 10, 13, 16, 19
#: Channels that soft tissue follows: flexion of hips and knees, wobbles of thighs, shanks, pelvis.
N_CHANNELS = 9
N_CURSORS = 9


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _jet(q: Array, side: int, row: int) -> Jet:
    return q[side, row, 0], q[side, row, 1], q[side, row, 2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _carried(s: Array, parent: int, child: int, at: tuple[Jet, Jet, Jet]) -> None:
    """Origin of a segment at a (moving) point of another one."""
    (x, x1, x2), (y, y1, y2), (z, z1, z2) = at
    wx, wy, wz = s[parent, 9], s[parent, 10], s[parent, 11]
    ux, uy, uz = wy * z - wz * y, wz * x - wx * z, wx * y - wy * x
    vx, vy, vz = ux + x1, uy + y1, uz + z1
    tx, ty, tz = ux + 2 * x1, uy + 2 * y1, uz + 2 * z1
    ax = s[parent, 13] * z - s[parent, 14] * y + wy * tz - wz * ty + x2
    ay = s[parent, 14] * x - s[parent, 12] * z + wz * tx - wx * tz + y2
    az = s[parent, 12] * y - s[parent, 13] * x + wx * ty - wy * tx + z2
    for i in range(3):
        a, b, c = s[parent, 3 * i], s[parent, 3 * i + 1], s[parent, 3 * i + 2]
        s[child, 15 + i] = s[parent, 15 + i] + a * x + b * y + c * z
        s[child, 18 + i] = s[parent, 18 + i] + a * vx + b * vy + c * vz
        s[child, 21 + i] = s[parent, 21 + i] + a * ax + b * ay + c * az


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _fixed(joints: Array, row: int) -> tuple[Jet, Jet, Jet]:
    return (joints[row, 0], 0.0, 0.0), (joints[row, 1], 0.0, 0.0), (joints[row, 2], 0.0, 0.0)


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _turned(s: Array, parent: int, child: int, alpha: Jet, beta: Jet, gamma: Jet) -> None:
    """Orientation of a segment with the joint rotation Rz(α) Rx(β) Ry(γ) to another one."""
    sa, ca = math.sin(alpha[0]), math.cos(alpha[0])
    sb, cb = math.sin(beta[0]), math.cos(beta[0])
    sg, cg = math.sin(gamma[0]), math.cos(gamma[0])
    m00, m01, m02 = ca * cg - sa * sb * sg, -sa * cb, ca * sg + sa * sb * cg
    m10, m11, m12 = sa * cg + ca * sb * sg, ca * cb, sa * sg - ca * sb * cg
    m20, m21, m22 = -cb * sg, sb, cb * cg
    for i in range(3):
        a, b, c = s[parent, 3 * i], s[parent, 3 * i + 1], s[parent, 3 * i + 2]
        s[child, 3 * i] = a * m00 + b * m10 + c * m20
        s[child, 3 * i + 1] = a * m01 + b * m11 + c * m21
        s[child, 3 * i + 2] = a * m02 + b * m12 + c * m22
    a1, b1, g1 = alpha[1], beta[1], gamma[1]
    # Relative angular velocity in the axes of the segment, and how its components change.
    ux, uy, uz = -sg * cb * a1 + cg * b1, sb * a1 + g1, cg * cb * a1 + sg * b1
    dx = -sg * cb * alpha[2] + cg * beta[2] - cg * cb * g1 * a1 + sg * sb * b1 * a1 - sg * g1 * b1
    dy = sb * alpha[2] + gamma[2] + cb * b1 * a1
    dz = cg * cb * alpha[2] + sg * beta[2] - sg * cb * g1 * a1 - cg * sb * b1 * a1 + cg * g1 * b1
    wx, wy, wz = s[parent, 9], s[parent, 10], s[parent, 11]
    kx = m00 * wx + m10 * wy + m20 * wz
    ky = m01 * wx + m11 * wy + m21 * wz
    kz = m02 * wx + m12 * wy + m22 * wz
    s[child, 9], s[child, 10], s[child, 11] = kx + ux, ky + uy, kz + uz
    wx, wy, wz = s[parent, 12], s[parent, 13], s[parent, 14]
    s[child, 12] = m00 * wx + m10 * wy + m20 * wz + ky * uz - kz * uy + dx
    s[child, 13] = m01 * wx + m11 * wy + m21 * wz + kz * ux - kx * uz + dy
    s[child, 14] = m02 * wx + m12 * wy + m22 * wz + kx * uy - ky * ux + dz


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _foot_segment(q: Array, side: int, s: Array) -> None:
    """State of a foot from its coordinates (x, y, z, heading, roll, pitch)."""
    foot = FEET + side
    cy, sy = math.cos(q[side, 3, 0]), math.sin(q[side, 3, 0])
    cr, sr = math.cos(q[side, 4, 0]), math.sin(q[side, 4, 0])
    cp, sp = math.cos(q[side, 5, 0]), math.sin(q[side, 5, 0])
    # Columns: to the toes, up, to the right.
    s[foot, 0], s[foot, 3], s[foot, 6] = cy * cp + sy * sr * sp, sy * cp - cy * sr * sp, cr * sp
    s[foot, 1], s[foot, 4], s[foot, 7] = -cy * sp + sy * sr * cp, -sy * sp - cy * sr * cp, cr * cp
    s[foot, 2], s[foot, 5], s[foot, 8] = sy * cr, -cy * cr, -sr
    h1, r1, p1 = q[side, 3, 1], q[side, 4, 1], q[side, 5, 1]
    u0, u1, u2 = r1, h1 * sr, h1 * cr
    v0 = q[side, 4, 2]
    v1, v2 = q[side, 3, 2] * sr + h1 * cr * r1, q[side, 3, 2] * cr - h1 * sr * r1
    wx, wy, wz = cp * u0 + sp * u2, u1 - p1, cp * u2 - sp * u0
    # From axes x to the toes, y left, z up to x anterior, y up, z right.
    s[foot, 9], s[foot, 10], s[foot, 11] = wx, wz, -wy
    s[foot, 12] = cp * v0 + sp * v2 + p1 * wz
    s[foot, 13] = cp * v2 - sp * v0 - p1 * wx
    s[foot, 14] = -(v1 - q[side, 5, 2])
    for axis in range(3):
        for order in range(3):
            s[foot, 15 + 3 * order + axis] = q[side, axis, order]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _components(
    s: Array, parent: int, origin: int, target: int, at: int
) -> tuple[float, float, float]:
    x, y = s[target, at] - s[origin, at], s[target, at + 1] - s[origin, at + 1]
    z = s[target, at + 2] - s[origin, at + 2]
    return (
        s[parent, 0] * x + s[parent, 3] * y + s[parent, 6] * z,
        s[parent, 1] * x + s[parent, 4] * y + s[parent, 7] * z,
        s[parent, 2] * x + s[parent, 5] * y + s[parent, 8] * z,
    )


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _seen_from(s: Array, parent: int, origin: int, target: int) -> tuple[Jet, Jet, Jet]:
    """Way from a point to another one in the turning axes of a segment, with its derivatives."""
    x, y, z = _components(s, parent, origin, target, 15)
    x1, y1, z1 = _components(s, parent, origin, target, 18)
    x2, y2, z2 = _components(s, parent, origin, target, 21)
    ox, oy, oz = s[parent, 9], s[parent, 10], s[parent, 11]
    tx, ty, tz = oy * z - oz * y, oz * x - ox * z, ox * y - oy * x
    x1, y1, z1 = x1 - tx, y1 - ty, z1 - tz
    # ẅ = Rᵀa − 2 ω×ẇ − ω̇×w − ω×(ω×w)
    sx, sy, sz = 2 * x1 + tx, 2 * y1 + ty, 2 * z1 + tz
    x2 = x2 - (oy * sz - oz * sy) - (s[parent, 13] * z - s[parent, 14] * y)
    y2 = y2 - (oz * sx - ox * sz) - (s[parent, 14] * x - s[parent, 12] * z)
    z2 = z2 - (ox * sy - oy * sx) - (s[parent, 12] * y - s[parent, 13] * x)
    return (x, x1, x2), (y, y1, y2), (z, z1, z2)


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def two_link_angles(
    w: tuple[Jet, Jet, Jet], links: Array, hip_rotation: Jet, beta: Jet
) -> tuple[Jet, Jet, Jet]:
    """Flexion of the knee (α, negative) and flexion and adduction of the hip (α, β).

    The ankle is at `w` from the hip in pelvis axes. Prescribed are the rotation of the hip and the
    adduction β of the knee. The distance gives the knee, ``w² = a² + b² + 2ab cos α cos β``; then
    ``Rz(α) Rx(β)`` of the hip must take the leg, turned by the rotation of the hip, to `w`.
    """
    a, b = links[0], links[1]
    square = add(add(mul(w[0], w[0]), mul(w[1], w[1])), mul(w[2], w[2]))
    sine_b, cosine_b = sine_cosine(beta)
    shift = (square[0] - a * a - b * b, square[1], square[2])
    cosine = over(scaled(shift, 1.0 / (2.0 * a * b)), cosine_b)
    sine = scaled(root(sub((1.0, 0.0, 0.0), mul(cosine, cosine))), -1.0)
    knee = arctangent(sine, cosine)
    along = mul(cosine, cosine_b)
    leg_x, leg_z = scaled(mul(sine, cosine_b), b), scaled(sine_b, -b)
    leg_y = (-a - b * along[0], -b * along[1], -b * along[2])
    sine_g, cosine_g = sine_cosine(hip_rotation)
    turned_x = add(mul(cosine_g, leg_x), mul(sine_g, leg_z))
    turned_z = sub(mul(cosine_g, leg_z), mul(sine_g, leg_x))
    reach = root(add(mul(leg_y, leg_y), mul(turned_z, turned_z)))
    down = scaled(leg_y, -1.0)
    hip_beta = sub(arctangent(turned_z, down), arcsine(over(w[2], reach)))
    sine_b, cosine_b = sine_cosine(hip_beta)
    low = sub(mul(cosine_b, leg_y), mul(sine_b, turned_z))
    hip = sub(arctangent(w[1], w[0]), arctangent(low, turned_x))
    wrapped = hip[0]
    if wrapped > math.pi:
        wrapped -= 2.0 * math.pi
    elif wrapped < -math.pi:
        wrapped += 2.0 * math.pi
    return knee, (wrapped, hip[1], hip[2]), hip_beta


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _path_row(path: Array, time: float, piece: int, s: Array) -> None:
    """State of the frame that goes along the path: x forward, y up, z right."""
    for axis in range(2):
        jet = quintic(path, axis, piece, 1, time - path[axis, piece, 0])
        s[PATH, 15 + axis], s[PATH, 18 + axis], s[PATH, 21 + axis] = jet
    heading = quintic(path, 2, piece, 1, time - path[2, piece, 0])
    c, n = math.cos(heading[0]), math.sin(heading[0])
    for i in range(15):
        s[PATH, i] = 0.0
    s[PATH, 0], s[PATH, 2], s[PATH, 3], s[PATH, 5], s[PATH, 7] = c, n, n, -c, 1.0
    s[PATH, 10], s[PATH, 13] = heading[1], heading[2]
    s[PATH, 17] = s[PATH, 20] = s[PATH, 23] = 0.0


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _leg(joints: Array, links: Array, side: int, q: Array, s: Array, channels: Array) -> None:
    """Thigh and shank between the hip and the ankle."""
    thigh, shank = THIGHS + side, SHANKS + side
    _carried(s, PELVIS, thigh, _fixed(joints, thigh))
    w = _seen_from(s, PELVIS, thigh, FEET + side)
    rotation, adduction = _jet(q, side, HIP_ROTATION), _jet(q, side, KNEE_ADDUCTION)
    knee, hip, hip_beta = two_link_angles(w, links, rotation, adduction)
    _turned(s, PELVIS, thigh, hip, hip_beta, rotation)
    _carried(s, thigh, shank, _fixed(joints, shank))
    _turned(s, thigh, shank, knee, adduction, _jet(q, side, KNEE_ROTATION))
    for i in range(3):
        channels[2 * side, i], channels[2 * side + 1, i] = hip[i], -knee[i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _upper_body(joints: Array, q: Array, s: Array, nod: Jet) -> None:
    """Trunk, head and arms; the head is carried by a neck that gives way by `nod`."""
    i = TRUNK_ANGLES
    _carried(s, PELVIS, TRUNK, _fixed(joints, TRUNK))
    _turned(s, PELVIS, TRUNK, _jet(q, BODY, i), _jet(q, BODY, i + 1), _jet(q, BODY, i + 2))
    i = HEAD_ANGLES
    x, y, z = _fixed(joints, HEAD)
    _carried(s, TRUNK, HEAD, (x, add(y, nod), z))
    _turned(s, TRUNK, HEAD, _jet(q, BODY, i), _jet(q, BODY, i + 1), _jet(q, BODY, i + 2))
    still = (0.0, 0.0, 0.0)
    i = SHOULDER
    for side in range(2):
        # An arm swings with the opposite leg.
        other, arm, forearm = 1 - side, UPPER_ARMS + side, FOREARMS + side
        _carried(s, TRUNK, arm, _fixed(joints, arm))
        _turned(s, TRUNK, arm, _jet(q, other, i), _jet(q, other, i + 1), _jet(q, other, i + 2))
        _carried(s, arm, forearm, _fixed(joints, forearm))
        _turned(s, arm, forearm, _jet(q, other, ELBOW), still, still)


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def body_state(
    tables: BodyTables,
    time: float,
    cursors: Array,
    q: Array,
    foot: Array,
    s: Array,
    channels: Array,
) -> float:
    """Write the state of all segments at a time; gives the acceleration of the belt frame.

    Parameters
    ----------
    tables : BodyTables
        The motion.
    time : float
        Not before the time of the last call with these cursors.
    cursors : array of int, shape (4, N_CURSORS)
        Zeros at first.
    q, foot : array, shape (3, N_COORDINATES, 3) and (2, 6, 3)
        Generalised coordinates.
    s : array, shape (N_ROWS, 24)
        State of the segments.
    channels : array, shape (N_CHANNELS, 3)
        What soft tissue follows.
    """
    path = tables.path
    for i in range(3):
        starts = tables.steps[:, 0] if i == 2 else path[0 if i == 0 else 3, :, 0]
        cursor = cursors[3, i]
        while cursor + 1 < len(starts) and starts[cursor + 1] <= time:
            cursor += 1
        cursors[3, i] = cursor
    _path_row(path, time, cursors[3, 0], s)
    belt = cursors[3, 1]
    slip = quintic(path, 3, belt, 1, time - path[3, belt, 0])
    lift, nod, shaken = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for side in range(3):
        periodic_coordinates(
            side,
            time,
            tables.contact_s,
            tables.phase,
            tables.offset,
            tables.amplitude,
            tables.fourier,
            (OSCILLATION, N_COORDINATES) if side == BODY else (0, OSCILLATION),
            cursors,
            q,
        )
    for side in range(2):
        foot_coordinates(
            side, time, tables.pieces, tables.stances, tables.sole, tables.edges, cursors, foot
        )
        _foot_segment(foot, side, s)
        stride = cursors[side, 0]
        since = time - tables.contact_s[side, stride]
        pelvis, head = tables.strength[side, stride, 0], tables.strength[side, stride, 1]
        tissue = tables.strength[side, stride, 2]
        lift = add(lift, scaled(impact_pulse(tables.pulses, 0, since), pelvis))
        nod = add(nod, scaled(impact_pulse(tables.pulses, 1, since), head))
        shaken = add(shaken, scaled(impact_pulse(tables.pulses, 4, since), tissue))
        for kind in range(2):
            row = 4 + 2 * kind + side
            wobble = scaled(impact_pulse(tables.pulses, 2 + kind, since), tissue)
            channels[row, 0], channels[row, 1], channels[row, 2] = wobble
    channels[8, 0], channels[8, 1], channels[8, 2] = shaken
    i = OSCILLATION
    ahead = add(_jet(q, BODY, i), slip)
    high = add(add(_jet(q, BODY, i + 2), lift), step_height(tables.steps, time, cursors[3, 2]))
    _carried(s, PATH, PELVIS, (ahead, high, _jet(q, BODY, i + 1)))
    i = PELVIS_ANGLES
    _turned(s, PATH, PELVIS, _jet(q, BODY, i), _jet(q, BODY, i + 1), _jet(q, BODY, i + 2))
    for side in range(2):
        _leg(tables.joints, tables.links, side, q, s, channels)
    _upper_body(tables.joints, q, s, sub(nod, lift))
    result: float = slip[2]
    return result
