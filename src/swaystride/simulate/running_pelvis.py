"""Height of the pelvis of a runner: pushed up in stance, falling freely in flight.

In a stance of duration C the vertical acceleration is

    −g + F₁ sin(πτ/C) + F₂ sin(2πτ/C),

in flight −g. F₁ gives the change of velocity that the next flight needs, F₂ (small) the change of
height. For equal steps of duration S this is the half wave of the methods, F₁ = πgS/(2C).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.units import GRAVITY_M_S2

Array = NDArray[np.float64]


def rise_over_contact_m(contact_time_s: ArrayLike, step_time_s: ArrayLike) -> Array:
    """Mean height over a step above that at contact, for equal steps (usually negative).

    Parameters
    ----------
    contact_time_s, step_time_s : array_like
        Duration of the stance and from contact to contact.

    Returns
    -------
    ndarray

    Examples
    --------
    >>> round(float(rise_over_contact_m(0.2, 0.35)), 4)
    -0.0132
    """
    c, s = np.asarray(contact_time_s), np.asarray(step_time_s)
    flight = s - c
    fall = GRAVITY_M_S2
    # In stance: v₀ = −g·flight/2, twice integrated forces; in flight: a parabola from the same height.
    force = np.pi * fall * s / (2.0 * c)
    stance = -fall * flight * c**2 / 4.0 - fall * c**3 / 6.0
    stance = stance + force * c**3 * (1.0 / (2.0 * np.pi) - 2.0 / np.pi**3)
    return np.asarray((stance + fall * flight**3 / 12.0) / s)


def pelvis_steps(contact_s: ArrayLike, toe_off_s: ArrayLike, mean_height_m: ArrayLike) -> Array:
    """Rows of the steps for the kernel.

    Parameters
    ----------
    contact_s, toe_off_s : array_like, shape (n,)
        First and last touch of all steps of both feet in turn; every stance ends before the next
        begins.
    mean_height_m : array_like, shape (n,)
        Wanted mean height over each step.

    Returns
    -------
    ndarray, shape (n - 1, 7)
        Begin, duration of the stance, height and velocity then, F₁, F₂ and g.
    """
    contact, toe_off = np.asarray(contact_s), np.asarray(toe_off_s)
    lasts = (toe_off - contact)[:-1]
    step = np.diff(contact)
    flight = step - lasts
    usual = np.convolve(np.pad(step, 4, mode="edge"), np.full(9, 1.0 / 9.0), mode="valid")
    usual_contact = np.convolve(np.pad(lasts, 4, mode="edge"), np.full(9, 1.0 / 9.0), mode="valid")
    height = np.asarray(mean_height_m, dtype=np.float64)[:-1]
    height = height - rise_over_contact_m(usual_contact, usual)
    g = GRAVITY_M_S2
    leaving = np.diff(height, append=height[-1]) / flight + g * flight / 2.0
    landing = np.concatenate([[-leaving[0]], (leaving - g * flight)[:-1]])
    first = np.pi * ((leaving - landing) / lasts + g) / 2.0
    # Height at toe-off as at contact: (v₀ − gC/2)C + F₁C²/π + F₂C²/(2π) = 0.
    second = -2.0 * np.pi * ((landing - g * lasts / 2.0) / lasts + first / np.pi)
    return np.stack(
        [contact[:-1], lasts, height, landing, first, second, np.full_like(height, g)], axis=-1
    )


def still_pelvis(height_m: float) -> Array:
    """Row of a pelvis that stays at one height, for walking and standing.

    Parameters
    ----------
    height_m : float
        Height.
    """
    return np.array([[0.0, 1e9, height_m, 0.0, 0.0, 0.0, 0.0]])


def pelvis_height(steps: Array, time_s: ArrayLike) -> Array:
    """Height at any times: the plain twin of the kernel, without derivatives.

    Parameters
    ----------
    steps : ndarray, shape (n, 7)
        From :func:`pelvis_steps`.
    time_s : array_like
        Times.

    Returns
    -------
    ndarray
    """
    time = np.asarray(time_s, dtype=np.float64)
    row = np.maximum(np.searchsorted(steps[:, 0], time, side="right") - 1, 0)
    begin, lasts, height, velocity, first, second, fall = np.moveaxis(steps[row], -1, 0)
    since = time - begin
    x = np.minimum(since, lasts)
    turn = np.pi / lasts
    s, c = np.sin(turn * x), np.cos(turn * x)
    moved = (first * (x - s / turn) + second * (x / 2.0 - s * c / (2.0 * turn))) / turn
    gain = (first * (1.0 - c) + second * s * s) / turn
    return np.asarray(
        height + velocity * since - fall * since**2 / 2.0 + moved + gain * (since - x)
    )
