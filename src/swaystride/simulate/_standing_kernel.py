"""Compiled kernel: inverted pendulums with delayed control and coloured torque noise."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]


@njit(cache=True, fastmath=False)  # type: ignore[untyped-decorator, unused-ignore]
def integrate_pendulums(
    normals: Array,
    noise_sd: Array,
    noise_memory: float,
    frequency_squared: float,
    stiffness: float,
    damping_s: float,
    delay_steps: int,
    step_s: float,
    start: Array,
) -> tuple[Array, Array]:
    """Integrate independent pendulums by semi-implicit Euler, torques in units of m·g·h.

    Per pendulum ``θ̈ = frequency_squared (sin θ − stiffness θ(t−τ) − damping_s θ̇(t−τ) + n)``. The
    noise n is an Ornstein-Uhlenbeck process, exactly discretised and started in its stationary
    state: ``n[0] = sd·ξ[0]``, ``n[i] = memory·n[i−1] + sd·√(1 − memory²)·ξ[i]``. Before the start
    the body rests at its starting angle with its starting rate.

    Parameters
    ----------
    normals : array, shape (n_pendulums, n_steps)
        Standard normal numbers ξ.
    noise_sd : array, shape (n_pendulums,)
        Standard deviation of n.
    noise_memory : float
        ``exp(−step_s / T_n)``.
    frequency_squared : float
        ``g / (inertia_factor · h)`` in 1/s².
    stiffness, damping_s : float
        Control gains over m·g·h.
    delay_steps : int
        Delay of the control in steps.
    step_s : float
        Time step.
    start : array, shape (n_pendulums, 2)
        Starting angle (rad) and rate (rad/s).

    Returns
    -------
    angle, rate : array, shape (n_pendulums, n_steps + 1)
        ``rate[:, i + 1]`` takes ``angle[:, i]`` to ``angle[:, i + 1]``.
    """
    n_pendulums, n_steps = normals.shape
    angle = np.empty((n_pendulums, n_steps + 1))
    rate = np.empty((n_pendulums, n_steps + 1))
    noise = np.empty(n_pendulums)
    innovation = math.sqrt(1.0 - noise_memory * noise_memory)
    for p in range(n_pendulums):
        angle[p, 0] = start[p, 0]
        rate[p, 0] = start[p, 1]
        noise[p] = noise_sd[p] * normals[p, 0]
    # The pendulums advance side by side: their chains of dependent operations then overlap.
    for i in range(n_steps):
        j = max(i - delay_steps, 0)
        for p in range(n_pendulums):
            if i > 0:
                noise[p] = noise_memory * noise[p] + noise_sd[p] * innovation * normals[p, i]
            torque = math.sin(angle[p, i]) - stiffness * angle[p, j] - damping_s * rate[p, j]
            rate[p, i + 1] = rate[p, i] + step_s * frequency_squared * (torque + noise[p])
            angle[p, i + 1] = angle[p, i] + step_s * rate[p, i + 1]
    return angle, rate
