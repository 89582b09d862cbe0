"""Compiled kernel: generalised coordinates of the running body, with two derivatives.

Times rise from call to call; cursors remember the piece that the last call was in. The plain
twins are :meth:`swaystride.simulate.foot_motion.FootMotion.pose` and NumPy sums in the tests.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

from swaystride.simulate._running_jets import (
    Jet,
    add,
    chain,
    mul,
    quintic,
    scaled,
    sine_cosine,
    smooth_step,
)

Array = NDArray[np.float64]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def periodic_coordinates(
    side: int,
    time: float,
    contact_s: Array,
    phase: Array,
    offset: Array,
    amplitude: Array,
    fourier: Array,
    rows: tuple[int, int],
    cursors: Array,
    q: Array,
) -> None:
    """Write the coordinates that follow the strides of one leg, or the steps, into ``q[side]``.

    ``offset + amplitude · Σ a_k cos 2πks + b_k sin 2πks`` with k = 1 to 6 and the phase s. Offset
    and amplitude go from stride to stride with least jerk. Moves cursors 0 (stride) and 1 (piece).

    Parameters
    ----------
    side : int
        0 right, 1 left, 2 both.
    time : float
        Not before that of the last call.
    contact_s : array, shape (3, n)
        First touches.
    phase : array, shape (3, m, 7)
        Start and coefficients of the pieces of the phase.
    offset, amplitude : array, shape (3, n, n_coordinates)
        At every first touch.
    fourier : array, shape (3, n_coordinates, 13)
        a1, b1, …, a6, b6, and the highest harmonic that is not zero.
    rows : tuple of int
        First coordinate to write, and the one after the last.
    cursors : array, shape (4, n_cursors)
        Where the last call was.
    q : array, shape (3, n_coordinates, 3)
        Values and derivatives.
    """
    stride, piece = cursors[side, 0], cursors[side, 1]
    while stride + 2 < contact_s.shape[1] and contact_s[side, stride + 1] <= time:
        stride += 1
    while piece + 1 < phase.shape[1] and phase[side, piece + 1, 0] <= time:
        piece += 1
    cursors[side, 0], cursors[side, 1] = stride, piece
    s = quintic(phase, side, piece, 1, time - phase[side, piece, 0])
    lasts = contact_s[side, stride + 1] - contact_s[side, stride]
    blend = smooth_step(((time - contact_s[side, stride]) / lasts, 1.0 / lasts, 0.0))
    turn = scaled(s, 2.0 * math.pi)
    c1, s1 = math.cos(turn[0]), math.sin(turn[0])
    for row in range(rows[0], rows[1]):
        value = first = second = 0.0
        c, n = 1.0, 0.0
        for k in range(int(fourier[side, row, 12])):
            c, n = c * c1 - n * s1, n * c1 + c * s1
            a, b = fourier[side, row, 2 * k], fourier[side, row, 2 * k + 1]
            wave = a * c + b * n
            value += wave
            first += (k + 1) * (b * c - a * n)
            second -= (k + 1) * (k + 1) * wave
        shape = chain(turn, value, first, second)
        low, high = amplitude[side, stride, row], amplitude[side, stride + 1, row]
        size = (low + (high - low) * blend[0], (high - low) * blend[1], (high - low) * blend[2])
        moved = mul(size, shape)
        low, high = offset[side, stride, row], offset[side, stride + 1, row]
        q[side, row, 0] = moved[0] + low + (high - low) * blend[0]
        q[side, row, 1] = moved[1] + (high - low) * blend[1]
        q[side, row, 2] = moved[2] + (high - low) * blend[2]


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def impact_pulse(pulses: Array, kind: int, since_s: float) -> Jet:
    """Damped oscillation that an impact starts: rises smoothly, fades smoothly.

    A row of `pulses` holds frequency (Hz), damping ratio, delay, duration of the rise, begin and end of the
    fading (s), and amplitude.
    """
    since = since_s - pulses[kind, 2]
    if since <= 0.0 or since >= pulses[kind, 5]:
        return 0.0, 0.0, 0.0
    natural = 2.0 * math.pi * pulses[kind, 0]
    decay = -pulses[kind, 1] * natural
    turning = natural * math.sqrt(1.0 - pulses[kind, 1] * pulses[kind, 1])
    size = pulses[kind, 6] * math.exp(decay * since)
    s, c = math.sin(turning * since), math.cos(turning * since)
    first = size * (decay * s + turning * c)
    second = 2.0 * decay * first - natural * natural * size * s
    wave = (size * s, first, second)
    if since < pulses[kind, 3]:
        wave = mul(wave, smooth_step((since / pulses[kind, 3], 1.0 / pulses[kind, 3], 0.0)))
    if since > pulses[kind, 4]:
        rate = 1.0 / (pulses[kind, 5] - pulses[kind, 4])
        gone = smooth_step(((since - pulses[kind, 4]) * rate, rate, 0.0))
        wave = mul(wave, (1.0 - gone[0], -gone[1], -gone[2]))
    return wave


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def step_height(steps: Array, time: float, step: int) -> Jet:
    """Height of the pelvis: forces of two half waves in stance, free fall in flight.

    A row of `steps` holds begin, duration of the stance, height and velocity at the begin, the two
    amplitudes (m/s²) and g.
    """
    lasts, height, velocity = steps[step, 1], steps[step, 2], steps[step, 3]
    first, second, fall = steps[step, 4], steps[step, 5], steps[step, 6]
    since = time - steps[step, 0]
    falling = (
        height + velocity * since - 0.5 * fall * since * since,
        velocity - fall * since,
        -fall,
    )
    x = min(since, lasts)
    rate = math.pi / lasts
    s, c = math.sin(rate * x), math.cos(rate * x)
    # Twice integrated sin(x) and sin(2x), with nothing at the begin.
    gain = (first * (1.0 - c) + second * s * s) / rate
    moved = (first * (x - s / rate) + second * (x / 2.0 - s * c / (2.0 * rate))) / rate
    if since <= lasts:
        wave = (moved, gain, first * s + second * 2.0 * s * c)
    else:
        wave = (moved + gain * (since - lasts), gain, 0.0)
    result: Jet = add(falling, wave)
    return result


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def rolling(sole: Array, edges: Array, pitch: float) -> tuple[float, float, float, float]:
    """Integral of the support function, its value and two derivatives (sole.Sole.rolling).

    `sole` holds (up, back, at level, corner radius), a row of `edges` angle, length, half width.
    """
    sine, cosine = math.sin(pitch), math.cos(pitch)
    wave, turned = sole[0] * cosine + sole[1] * sine, sole[0] * sine - sole[1] * cosine
    integral, s, s1, s2 = turned + sole[3] * pitch - sole[2], wave + sole[3], -turned, -wave
    for edge in range(len(edges)):
        w = edges[edge, 2]
        k = math.pi / w
        share = 1.0 / (k * k - 1.0)
        scale = edges[edge, 1] / (2.0 * w)
        past = pitch - edges[edge, 0]
        if past <= -w:
            continue
        if past > w:
            size = -2.0 * math.sin(w) * k * k * share * scale
            slow_s, slow_c = -size * math.cos(past), size * math.sin(past)
            integral += scale * 2.0 * w - slow_s
            s, s1, s2 = s - slow_c, s1 + slow_s, s2 + slow_c
        else:
            u = past + w
            size = scale * k * k * share
            slow_s, slow_c = size * math.sin(u), size * math.cos(u)
            fast_s, fast_c = scale * share * math.sin(k * u), scale * share * math.cos(k * u)
            integral += scale * u + fast_s / k - slow_s
            s += scale + fast_c - slow_c
            s1 += slow_s - k * fast_s
            s2 += slow_c - k * k * fast_c
    return integral, s, s1, s2


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # type: ignore[untyped-decorator, unused-ignore]
def foot_coordinates(
    side: int,
    time: float,
    pieces: Array,
    stances: Array,
    sole: Array,
    edges: Array,
    cursors: Array,
    q: Array,
) -> None:
    """Write ankle x, y, z, heading, roll and pitch of a foot into ``q[side]``, as FootMotion.pose.

    Parameters
    ----------
    side : int
        0 right, 1 left.
    time : float
        Not before that of the last call.
    pieces : array, shape (2, 6, m, 7)
        Start and coefficients of the pieces of x, y, z (in swing), heading, roll and pitch.
    stances : array, shape (2, n, 8)
        Contact, toe-off, arrest, place (2) and excess velocity (3).
    sole, edges : array
        See :func:`rolling`.
    cursors : array, shape (4, n_cursors)
        Uses the cursors 2 to 8.
    q : array, shape (2, 6, 3)
        Values and derivatives.
    """
    stance = cursors[side, 8]
    while stance + 1 < stances.shape[1] and stances[side, stance + 1, 0] <= time:
        stance += 1
    cursors[side, 8] = stance
    swings = time >= stances[side, stance, 1]
    for i in range(0 if swings else 3, 6):
        piece = cursors[side, 2 + i]
        while piece + 1 < pieces.shape[2] and pieces[side, i, piece + 1, 0] <= time:
            piece += 1
        cursors[side, 2 + i] = piece
        c0, c1 = pieces[side, i, piece, 1], pieces[side, i, piece, 2]
        c2, c3 = pieces[side, i, piece, 3], pieces[side, i, piece, 4]
        c4, c5 = pieces[side, i, piece, 5], pieces[side, i, piece, 6]
        u = time - pieces[side, i, piece, 0]
        q[side, i, 0] = ((((c5 * u + c4) * u + c3) * u + c2) * u + c1) * u + c0
        q[side, i, 1] = (((5 * c5 * u + 4 * c4) * u + 3 * c3) * u + 2 * c2) * u + c1
        q[side, i, 2] = ((20 * c5 * u + 12 * c4) * u + 6 * c3) * u + 2 * c2
    if swings:
        return
    pitch = (q[side, 5, 0], q[side, 5, 1], q[side, 5, 2])
    integral, s, s1, s2 = rolling(sole, edges, pitch[0])
    along = chain(pitch, -integral, -s, -s1)
    high = chain(pitch, s, s1, s2)
    sine, cosine = sine_cosine((q[side, 4, 0], q[side, 4, 1], q[side, 4, 2]))
    left, up = scaled(mul(high, sine), -1.0), mul(high, cosine)
    c, n = math.cos(q[side, 3, 0]), math.sin(q[side, 3, 0])
    for order in range(3):
        q[side, 0, order] = c * along[order] - n * left[order]
        q[side, 1, order] = n * along[order] + c * left[order]
        q[side, 2, order] = up[order]
    q[side, 0, 0] += stances[side, stance, 3]
    q[side, 1, 0] += stances[side, stance, 4]
    since, lasts = time - stances[side, stance, 0], stances[side, stance, 2]
    if since < lasts:
        turn = 2.0 * math.pi * since / lasts
        quarter = lasts / (4.0 * math.pi**2)
        moved = since - since**2 / (2 * lasts) - lasts / 2 + quarter * (1.0 - math.cos(turn))
        speed = 1.0 - since / lasts + math.sin(turn) / (2.0 * math.pi)
        slowing = -(1.0 - math.cos(turn)) / lasts
        for axis in range(3):
            excess = stances[side, stance, 5 + axis]
            q[side, axis, 0] += moved * excess
            q[side, axis, 1] += speed * excess
            q[side, axis, 2] += slowing * excess
