"""Compiled kernel: signals of sensors and positions of markers on the segments of the body."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.simulate._running_kernel import (
    FEET,
    N_CHANNELS,
    N_COORDINATES,
    N_CURSORS,
    N_ROWS,
    THIGHS,
    BodyTables,
    body_state,
)

Array = NDArray[np.float64]

BLOCK = 64


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def segment_states(tables: BodyTables, times: Array) -> tuple[Array, Array, Array, Array]:
    """Coordinates (n, 3, ·, 3), states (n, N_ROWS, 24), soft-tissue channels, belt acceleration."""
    n = len(times)
    q = np.zeros((n, 3, N_COORDINATES, 3))
    foot = np.zeros((2, 6, 3))
    states = np.zeros((n, N_ROWS, 24))
    channels = np.zeros((n, N_CHANNELS, 3))
    belt = np.zeros(n)
    cursors = np.zeros((4, N_CURSORS), dtype=np.int64)
    for i in range(n):
        belt[i] = body_state(tables, times[i], cursors, q[i], foot, states[i], channels[i])
    return q, states, channels, belt


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def longest_falls(tables: BodyTables, duration_s: float, step_s: float, limit_m: float) -> Array:
    """How much too high the hips are for legs of a length, at most, in each step of the pelvis, m.

    Negative where every leg reaches; minus infinity for steps outside the recording.
    """
    q = np.zeros((3, N_COORDINATES, 3))
    foot = np.zeros((2, 6, 3))
    states = np.zeros((N_ROWS, 24))
    channels = np.zeros((N_CHANNELS, 3))
    cursors = np.zeros((4, N_CURSORS), dtype=np.int64)
    most = np.full(len(tables.steps), -np.inf)
    for i in range(int(duration_s / step_s) + 1):
        body_state(tables, i * step_s, cursors, q, foot, states, channels)
        for side in range(2):
            hip, ankle = THIGHS + side, FEET + side
            x = states[ankle, 15] - states[hip, 15]
            y = states[ankle, 16] - states[hip, 16]
            allowed = np.sqrt(max(limit_m**2 - x * x - y * y, 0.0))
            step = cursors[3, 2]
            most[step] = max(most[step], states[hip, 17] - states[ankle, 17] - allowed)
    return most


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def sensor_signals(
    tables: BodyTables,
    start_s: float,
    rate_hz: float,
    first: int,
    n: int,
    rows: Array,
    points: Array,
    tissue: Array,
    gravity: float,
    out: Array,
) -> None:
    """Ideal signals of sensors on soft tissue, in axes that move with the tissue.

    Parameters
    ----------
    tables : BodyTables
        The motion.
    start_s, rate_hz, first, n : float, float, int, int
        Samples ``first … first + n − 1`` of a series that starts at a time.
    rows : array of int, shape (n_sensors, 4)
        Row of the segment and the three channels that the tissue follows.
    points : array, shape (n_sensors, 3)
        Place on the segment.
    tissue : array, shape (n_sensors, 6, 3)
        What the tissue does per unit of each channel: displacements along x, y and z (rows 0-2,
        columns are channels) and rotation (row 3) about an axis (row 4); reference values of the
        channels (row 5).
    gravity : float
        g.
    out : array, shape (n_sensors, 6, n)
        Proper acceleration and angular velocity.
    """
    q = np.zeros((3, N_COORDINATES, 3))
    foot = np.zeros((2, 6, 3))
    states = np.zeros((N_ROWS, 24))
    channels = np.zeros((N_CHANNELS, 3))
    cursors = np.zeros((4, N_CURSORS), dtype=np.int64)
    # Blocks that stay in the cache: one sample touches far-apart places of all channels.
    block = np.empty((len(rows), 6, BLOCK))
    for begin in range(0, n, BLOCK):
        lasts = min(BLOCK, n - begin)
        for i in range(lasts):
            time = start_s + (first + begin + i) / rate_hz
            slip = body_state(tables, time, cursors, q, foot, states, channels)
            for k in range(len(rows)):
                _sensor(k, rows, points, tissue, states, channels, slip, gravity, i, block)
        for k in range(len(rows)):
            for j in range(6):
                for i in range(lasts):
                    out[k, j, begin + i] = block[k, j, i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def _sensor(
    k: int,
    rows: Array,
    points: Array,
    tissue: Array,
    states: Array,
    channels: Array,
    slip: float,
    gravity: float,
    i: int,
    out: Array,
) -> None:
    """One sample of one sensor."""
    s = rows[k, 0]
    x, y, z = points[k, 0], points[k, 1], points[k, 2]
    x1 = y1 = z1 = x2 = y2 = z2 = angle = rate = 0.0
    for j in range(3):
        row = rows[k, 1 + j]
        c0, c1, c2 = channels[row, 0] - tissue[k, 5, j], channels[row, 1], channels[row, 2]
        tx, ty, tz = tissue[k, 0, j], tissue[k, 1, j], tissue[k, 2, j]
        x, x1, x2 = x + tx * c0, x1 + tx * c1, x2 + tx * c2
        y, y1, y2 = y + ty * c0, y1 + ty * c1, y2 + ty * c2
        z, z1, z2 = z + tz * c0, z1 + tz * c1, z2 + tz * c2
        angle += tissue[k, 3, j] * c0
        rate += tissue[k, 3, j] * c1
    wx, wy, wz = states[s, 9], states[s, 10], states[s, 11]
    tx, ty, tz = wy * z - wz * y + 2 * x1, wz * x - wx * z + 2 * y1, wx * y - wy * x + 2 * z1
    gx, gy, gz = states[s, 21] - slip, states[s, 22], states[s, 23] + gravity
    ax = states[s, 0] * gx + states[s, 3] * gy + states[s, 6] * gz
    ay = states[s, 1] * gx + states[s, 4] * gy + states[s, 7] * gz
    az = states[s, 2] * gx + states[s, 5] * gy + states[s, 8] * gz
    ax += states[s, 13] * z - states[s, 14] * y + wy * tz - wz * ty + x2
    ay += states[s, 14] * x - states[s, 12] * z + wz * tx - wx * tz + y2
    az += states[s, 12] * y - states[s, 13] * x + wx * ty - wy * tx + z2
    # Seen from axes turned about the unit axis u: c v − s u×v + (1−c)(u·v) u.
    ux, uy, uz = tissue[k, 4, 0], tissue[k, 4, 1], tissue[k, 4, 2]
    c, n = math.cos(angle), math.sin(angle)
    part = (1.0 - c) * (ux * ax + uy * ay + uz * az)
    out[k, 0, i] = c * ax - n * (uy * az - uz * ay) + part * ux
    out[k, 1, i] = c * ay - n * (uz * ax - ux * az) + part * uy
    out[k, 2, i] = c * az - n * (ux * ay - uy * ax) + part * uz
    part = (1.0 - c) * (ux * wx + uy * wy + uz * wz) + rate
    out[k, 3, i] = c * wx - n * (uy * wz - uz * wy) + part * ux
    out[k, 4, i] = c * wy - n * (uz * wx - ux * wz) + part * uy
    out[k, 5, i] = c * wz - n * (ux * wy - uy * wx) + part * uz


@njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def marker_positions(
    tables: BodyTables,
    times: Array,
    rows: Array,
    points: Array,
    tissue: Array,
    out: Array,
) -> None:
    """Positions of points on soft tissue in the world, shape (n, n_points, 3).

    Parameters as in :func:`sensor_signals`; rotation of the tissue does not move a point.
    """
    q = np.zeros((3, N_COORDINATES, 3))
    foot = np.zeros((2, 6, 3))
    states = np.zeros((N_ROWS, 24))
    channels = np.zeros((N_CHANNELS, 3))
    cursors = np.zeros((4, N_CURSORS), dtype=np.int64)
    for i in range(len(times)):
        body_state(tables, times[i], cursors, q, foot, states, channels)
        for k in range(len(rows)):
            s = rows[k, 0]
            x, y, z = points[k, 0], points[k, 1], points[k, 2]
            for j in range(3):
                c = channels[rows[k, 1 + j], 0] - tissue[k, 5, j]
                x += tissue[k, 0, j] * c
                y += tissue[k, 1, j] * c
                z += tissue[k, 2, j] * c
            for axis in range(3):
                a = 3 * axis
                turned = states[s, a] * x + states[s, a + 1] * y + states[s, a + 2] * z
                out[i, k, axis] = states[s, 15 + axis] + turned
