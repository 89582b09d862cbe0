"""Compiled kernel: the two standing pendulums, which fall beyond a threshold and are caught."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

_UPRIGHT, _FALLING, _CAUGHT = 0, 1, 2


@njit(cache=True, fastmath=False)  # type: ignore[untyped-decorator, unused-ignore]
def integrate_falling_pendulums(
    normals: Array,
    noise_sd: Array,
    noise_memory: float,
    frequency_squared: float,
    stiffness: float,
    damping_s: float,
    delay_steps: int,
    step_s: float,
    start: Array,
    threshold: float,
    largest: float,
    reaction_steps: Indices,
    catch_steps: int,
) -> tuple[Array, Array, Indices]:
    """Integrate as :func:`integrate_pendulums` does, with losses of balance.

    While ``hypot(θ)`` of the two pendulums stays at or below the threshold, the arithmetic is that
    of :func:`integrate_pendulums`. From the first angle beyond it, ``θ̈ = frequency_squared sin θ``
    for the reaction time or until the inclination reaches `largest`; then each angle follows the
    quintic that continues angle, velocity and acceleration and is at rest at zero after
    `catch_steps`. The noise process runs on meanwhile, so that it needs one number per step.

    Parameters
    ----------
    normals, noise_sd, noise_memory, frequency_squared, stiffness, damping_s, delay_steps, step_s, start
        See :func:`integrate_pendulums`; two pendulums.
    threshold, largest : float
        Inclinations (rad) beyond which balance is lost and at which the body is caught.
    reaction_steps : array of int, shape (n,)
        Steps from each loss to its catch; ``n_steps // catch_steps + 1`` of them always suffice.
    catch_steps : int
        Steps of the catch, at least 1.

    Returns
    -------
    angle, rate : array, shape (2, n_steps + 1)
        ``rate[:, i + 1]`` takes ``angle[:, i]`` to ``angle[:, i + 1]``.
    loss_steps : array of int, shape (n_losses,)
        Indices of the first angle beyond the threshold, one per loss.
    """
    n_steps = normals.shape[1]
    angle = np.empty((2, n_steps + 1))
    rate = np.empty((2, n_steps + 1))
    noise = np.empty(2)
    # Angle, velocity · T and acceleration · T² where the catch begins, T its duration.
    onset = np.zeros((2, 3))
    loss_steps = np.empty(reaction_steps.size, dtype=np.int64)
    innovation = math.sqrt(1.0 - noise_memory * noise_memory)
    catch_s = catch_steps * step_s
    n_losses, phase, phase_end = 0, _UPRIGHT, 0
    for p in range(2):
        angle[p, 0] = start[p, 0]
        rate[p, 0] = start[p, 1]
        noise[p] = noise_sd[p] * normals[p, 0]
    for i in range(n_steps):
        if i > 0:
            for p in range(2):
                noise[p] = noise_memory * noise[p] + noise_sd[p] * innovation * normals[p, i]
        squared = angle[0, i] * angle[0, i] + angle[1, i] * angle[1, i]
        if phase == _CAUGHT and i == phase_end:
            phase = _UPRIGHT
        if phase == _UPRIGHT and squared > threshold * threshold:
            loss_steps[n_losses] = i
            phase, phase_end = _FALLING, i + reaction_steps[n_losses]
            n_losses += 1
        if phase == _FALLING and (i >= phase_end or squared >= largest * largest):
            phase, phase_end = _CAUGHT, i + catch_steps
            for p in range(2):
                falling = frequency_squared * math.sin(angle[p, i])
                onset[p, 0] = angle[p, i]
                # Euler's rate lives half a step before the angle.
                onset[p, 1] = (rate[p, i] + step_s * falling / 2.0) * catch_s
                onset[p, 2] = falling * catch_s * catch_s
        if phase == _UPRIGHT:
            j = max(i - delay_steps, 0)
            for p in range(2):
                torque = math.sin(angle[p, i]) - stiffness * angle[p, j] - damping_s * rate[p, j]
                rate[p, i + 1] = rate[p, i] + step_s * frequency_squared * (torque + noise[p])
                angle[p, i + 1] = angle[p, i] + step_s * rate[p, i + 1]
        elif phase == _FALLING:
            for p in range(2):
                rate[p, i + 1] = rate[p, i] + step_s * frequency_squared * math.sin(angle[p, i])
                angle[p, i + 1] = angle[p, i] + step_s * rate[p, i + 1]
        else:
            # Hermite polynomials with u the part of the catch that is over: (1 − u)³ times the
            # expansion at its beginning.
            u = 1.0 - (phase_end - i - 1) / catch_steps
            remaining = (1.0 - u) ** 3
            of_angle = remaining * (1.0 + u * (3.0 + 6.0 * u))
            of_velocity = remaining * u * (1.0 + 3.0 * u)
            of_acceleration = remaining * u * u / 2.0
            for p in range(2):
                angle[p, i + 1] = (
                    of_angle * onset[p, 0]
                    + of_velocity * onset[p, 1]
                    + of_acceleration * onset[p, 2]
                )
                rate[p, i + 1] = (angle[p, i + 1] - angle[p, i]) / step_s
    return angle, rate, loss_steps[:n_losses].copy()
