r"""Minimise a deviance over variance ratios that cannot be negative.

The search runs over :math:`u_i = \log(1 + m_i\gamma_i)` with :math:`m_i` the mean group size: near
zero it is linear in the ratio, so that a gradient at the boundary says whether a component
belongs there (on the scale of standard deviations it is always zero), and far from zero it is
logarithmic, where the deviance is close to a parabola.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.profiled_deviance import Derivatives, Objective

_MAX_STEP = 3.0
_MAX_U = 40.0
_MAX_ITERATIONS = 200
# Of the deviance: what the last Newton step still promised, and what rounding may hide.
_PROMISE = 1e-13
_ROUNDING = 1e-11
# What a Newton step may still promise at a point that counts as the minimum.
_RESOLVED = 1e-8


@dataclass(frozen=True)
class Minimum:
    """Where the deviance is smallest.

    Attributes
    ----------
    gamma : array, shape (k,)
    value : float
    converged : bool
        Whether the conditions of a minimum hold: zero slope for every positive ratio, a slope
        that is not negative for every zero.
    message : str
        What happened, in words.
    evaluations : int
    """

    gamma: FloatArray
    value: float
    converged: bool
    message: str
    evaluations: int


def minimise_over_ratios(objective: Objective, size: FloatArray, start: FloatArray) -> Minimum:
    """Projected Newton method with analytic gradient and Hessian.

    Parameters
    ----------
    objective : callable
        From ratios, shape (k,), to value, gradient and Hessian.
    size : array, shape (k,)
        Mean number of rows per level of each grouping factor.
    start : array, shape (k,)
        Ratios to start from.

    Returns
    -------
    Minimum

    Examples
    --------
    >>> def bowl(gamma):
    ...     target = np.array([2.0, -1.0])
    ...     return float(((gamma - target) ** 2).sum()), 2 * (gamma - target), 2 * np.eye(2)
    >>> minimum = minimise_over_ratios(bowl, np.ones(2), np.ones(2))
    >>> minimum.gamma.round(9).tolist(), minimum.converged
    ([2.0, 0.0], True)
    """
    u = np.log1p(start * size)
    here = _in_u(objective, u, size)
    evaluations = 1
    for _ in range(_MAX_ITERATIONS):
        step = _newton_step(u, here)
        promise = -0.5 * float(here[1] @ step)
        if promise <= _PROMISE * (1.0 + abs(here[0])) and np.abs(step).max(initial=0.0) < 1e-4:
            final = _in_u(objective, np.clip(u + step, 0.0, _MAX_U), size)
            evaluations += 1
            if final[0] <= here[0] + _ROUNDING * (1.0 + abs(here[0])):
                u, here = np.clip(u + step, 0.0, _MAX_U), final
            return _verified(u, here, size, evaluations)
        shrink = 1.0
        while True:
            trial = np.clip(u + shrink * step, 0.0, _MAX_U)
            there = _in_u(objective, trial, size)
            evaluations += 1
            if _is_acceptable(u, here, trial, there):
                break
            shrink *= 0.4
            if shrink < 1e-9:
                return _verified(u, here, size, evaluations)
        u, here = trial, there
    return _verified(u, here, size, evaluations)


def _in_u(objective: Objective, u: FloatArray, size: FloatArray) -> Derivatives:
    """Value, gradient and Hessian by the chain rule."""
    value, gradient, hessian = objective(np.expm1(u) / size)
    jacobian = np.exp(u) / size
    return (
        value,
        gradient * jacobian,
        hessian * np.outer(jacobian, jacobian) + np.diag(gradient * jacobian),
    )


def _newton_step(u: FloatArray, here: Derivatives) -> FloatArray:
    """Newton step over the components that are free to move, always downhill."""
    _, gradient, hessian = here
    free = (u > 0.0) | (gradient < 0.0)
    step = np.zeros_like(u)
    while free.any():
        curvature, axes = np.linalg.eigh(hessian[np.ix_(free, free)])
        floor = 1e-8 * max(float(np.abs(curvature).max()), 1e-4)
        step[:] = 0.0
        step[free] = -axes @ ((axes.T @ gradient[free]) / np.maximum(np.abs(curvature), floor))
        blocked = free & (u == 0.0) & (step < 0.0)
        if not blocked.any():
            break
        free &= ~blocked
        step[:] = 0.0
    longest = float(np.abs(step).max(initial=0.0))
    return step * min(1.0, _MAX_STEP / longest) if longest > 0.0 else step


def _is_acceptable(u: FloatArray, here: Derivatives, trial: FloatArray, there: Derivatives) -> bool:
    """Sufficient decrease, or a smaller slope where the decrease drowns in rounding."""
    if not np.isfinite(there[0]):
        return False
    if there[0] <= here[0] + 1e-4 * float(here[1] @ (trial - u)):
        return True
    hidden = there[0] <= here[0] + _ROUNDING * (1.0 + abs(here[0]))
    return hidden and _slope(trial, there) < _slope(u, here)


def _slope(u: FloatArray, here: Derivatives) -> float:
    """Largest slope that a component is free to follow (zero at a minimum)."""
    gradient = here[1]
    return float(np.abs(np.where(u > 0.0, gradient, np.minimum(gradient, 0.0))).max(initial=0.0))


def _verified(u: FloatArray, here: Derivatives, size: FloatArray, evaluations: int) -> Minimum:
    """Check the conditions of a minimum and say so."""
    slope = _slope(u, here)
    promise = -0.5 * float(here[1] @ _newton_step(u, here))
    free = u > 0.0
    lowest = float(np.linalg.eigvalsh(here[2][np.ix_(free, free)]).min(initial=np.inf))
    at_end = bool((u >= _MAX_U - 1.0).any())
    converged = promise <= _RESOLVED and lowest > -1e-6 and not at_end
    state = f"largest free slope {slope:.1e}, at most {promise:.1e} left to gain"
    if at_end:
        message = "a variance ratio grew without bound"
    elif converged:
        message = f"converged after {evaluations} evaluations; {state}"
    else:
        message = f"not converged after {evaluations} evaluations; {state}"
    return Minimum(np.expm1(u) / size, here[0], converged, message, evaluations)
