r"""Minimise a deviance over variance ratios that cannot be negative.

The search runs over :math:`u_i = \log(1 + m_i\gamma_i)` with :math:`m_i` the mean group size: near
zero it is linear in the ratio, so that a gradient at the boundary says whether a component
belongs there (on the scale of standard deviations it is always zero), and far from zero it is
logarithmic, where the deviance is close to a parabola.

Most of the work of an exact Hessian with many crossed factors is in the log-determinant. A
:class:`SplitObjective` gives everything else exactly; the missing part is then carried along by
symmetric rank-one updates (structured secants), renewed when a step fails, and exact again at the
end, where the conditions of a minimum are checked.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

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
# Promise and length of a step below which secants give way to the exact Hessian.
_NEAR = 1e-5
_NEAR_STEP = 2e-3
# Steps after which secants alone are too slow.
_MAX_SECANTS = 8
# Distance to a minimum already known at which another search that leads there may end.
_SAME_HILL = 0.1


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


class SplitObjective(Protocol):
    """A deviance with a part whose Hessian is costly."""

    def sketch(self, gamma: FloatArray) -> tuple[Derivatives, FloatArray]:
        """Everything but the costly part's Hessian at the ratios, and that part's gradient."""
        ...

    def costly_hessian(self, gamma: FloatArray) -> FloatArray:
        """The Hessian that is left out, shape (k, k)."""
        ...


@dataclass(frozen=True, eq=False)
class _Point:
    """Where the search stands, on the scale of u.

    `distance` and `secants` are the way and the steps since the Hessian was exact; `costly` holds
    gradient and (approximate) Hessian of the costly part.
    """

    u: FloatArray
    value: float
    gradient: FloatArray
    hessian: FloatArray
    costly: tuple[FloatArray, FloatArray] | None = None
    distance: float = 0.0
    secants: int = 0


class _OnU:
    """An objective as a function of u."""

    def __init__(self, objective: Objective | SplitObjective, size: FloatArray) -> None:
        self.objective, self.size = objective, size
        self.evaluations = 0

    def exact(self, u: FloatArray, gamma: FloatArray | None = None) -> _Point:
        """Everything exact."""
        gamma = np.expm1(u) / self.size if gamma is None else gamma
        jacobian = np.exp(u) / self.size
        self.evaluations += 1
        if callable(self.objective):
            value, gradient, hessian = self.objective(gamma)
            hessian = self._hessian(u, gradient, hessian)
            return _Point(u, value, gradient * jacobian, hessian)
        (value, gradient, known), slope = self.objective.sketch(gamma)
        known = self._hessian(u, gradient - slope, known)
        costly = self._hessian(u, slope, self.objective.costly_hessian(gamma))
        parts = (slope * jacobian, costly)
        return _Point(u, value, gradient * jacobian, known + costly, parts)

    def renewed(self, here: _Point) -> _Point:
        """The same point with an exact Hessian."""
        if here.costly is None or callable(self.objective):
            return here
        slope, model = here.costly
        gamma, jacobian = np.expm1(here.u) / self.size, np.exp(here.u) / self.size
        costly = self._hessian(here.u, slope / jacobian, self.objective.costly_hessian(gamma))
        hessian = here.hessian - model + costly
        return _Point(here.u, here.value, here.gradient, hessian, (slope, costly))

    def following(self, u: FloatArray, before: _Point) -> _Point:
        """Exact but for the costly Hessian, which follows from the point before by a secant."""
        if before.costly is None or callable(self.objective):
            return self.exact(u)
        self.evaluations += 1
        (value, gradient, known), slope = self.objective.sketch(np.expm1(u) / self.size)
        known = self._hessian(u, gradient - slope, known)
        jacobian, move = np.exp(u) / self.size, u - before.u
        slope = slope * jacobian
        model = _secant(before.costly[1], move, slope - before.costly[0])
        far = before.distance + float(np.abs(move).max(initial=0.0))
        return _Point(
            u, value, gradient * jacobian, known + model, (slope, model), far, before.secants + 1
        )

    def _hessian(self, u: FloatArray, gradient: FloatArray, hessian: FloatArray) -> FloatArray:
        """Hessian on the scale of u by the chain rule."""
        jacobian = np.exp(u) / self.size
        turned: FloatArray = hessian * np.outer(jacobian, jacobian) + np.diag(gradient * jacobian)
        return turned


def _secant(model: FloatArray, move: FloatArray, change: FloatArray) -> FloatArray:
    """Symmetric rank-one update after which the model explains the change of the gradient."""
    miss = change - model @ move
    scale = float(miss @ move)
    if abs(scale) <= 1e-8 * float(np.linalg.norm(miss) * np.linalg.norm(move)):
        return model
    return model + np.outer(miss, miss) / scale


def minimise_over_ratios(
    objective: Objective | SplitObjective,
    size: FloatArray,
    start: FloatArray,
    known: Minimum | None = None,
) -> Minimum:
    """Projected Newton method with analytic gradient and Hessian.

    Parameters
    ----------
    objective : callable or SplitObjective
        From ratios, shape (k,), to value, gradient and Hessian.
    size : array, shape (k,)
        Mean number of rows per level of each grouping factor.
    start : array, shape (k,)
        Ratios to start from.
    known : Minimum, optional
        Found from another start; the search ends where it can only lead there again.

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
    on_u = _OnU(objective, size)
    here = on_u.exact(np.log1p(start * size), start)
    for _ in range(_MAX_ITERATIONS):
        step = _newton_step(here)
        promise, length = _promise(here, step), float(np.abs(step).max(initial=0.0))
        if known is not None and _leads_to(known, here, promise, size):
            return replace(known, evaluations=known.evaluations + on_u.evaluations)
        near = promise <= _NEAR and length <= _NEAR_STEP
        if here.secants >= _MAX_SECANTS or (near and here.distance > _NEAR_STEP):
            here = on_u.renewed(here)
            continue
        if promise <= _PROMISE * (1.0 + abs(here.value)) and length < 1e-4:
            final = on_u.following(np.clip(here.u + step, 0.0, _MAX_U), here)
            hidden = _ROUNDING * (1.0 + abs(here.value))
            return _verified(final if final.value <= here.value + hidden else here, on_u)
        following = _line_search(on_u, here, step)
        if following is None:
            if here.distance == 0.0:
                break
            following = on_u.renewed(here)
        here = following
    return _verified(here, on_u)


def _line_search(on_u: _OnU, here: _Point, step: FloatArray) -> _Point | None:
    """The first acceptable point along the step; after a failure the Hessian is made exact."""
    shrink = 1.0
    while shrink >= 1e-9:
        there = on_u.following(np.clip(here.u + shrink * step, 0.0, _MAX_U), here)
        if _is_acceptable(here, there):
            return on_u.renewed(there) if shrink < 1.0 and there.distance > 0.0 else there
        if here.distance > 0.0:
            return None
        shrink *= 0.4
    return None


def _promise(here: _Point, step: FloatArray) -> float:
    """What the step gains if the deviance is a parabola."""
    return -0.5 * float(here.gradient @ step)


def _leads_to(known: Minimum, here: _Point, promise: float, size: FloatArray) -> bool:
    """Whether the search is close to a known minimum and cannot get below it."""
    apart = float(np.abs(here.u - np.log1p(known.gamma * size)).max(initial=0.0))
    lowest = here.value - 2.0 * promise
    return apart <= _SAME_HILL and lowest >= known.value - _NEAR


def _newton_step(here: _Point) -> FloatArray:
    """Newton step over the components that are free to move, always downhill."""
    u, gradient, hessian = here.u, here.gradient, here.hessian
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


def _is_acceptable(here: _Point, there: _Point) -> bool:
    """Sufficient decrease, or a smaller slope where the decrease drowns in rounding."""
    if not np.isfinite(there.value):
        return False
    if there.value <= here.value + 1e-4 * float(here.gradient @ (there.u - here.u)):
        return True
    hidden = there.value <= here.value + _ROUNDING * (1.0 + abs(here.value))
    return hidden and _slope(there) < _slope(here)


def _slope(here: _Point) -> float:
    """Largest slope that a component is free to follow (zero at a minimum)."""
    free = np.where(here.u > 0.0, here.gradient, np.minimum(here.gradient, 0.0))
    return float(np.abs(free).max(initial=0.0))


def _verified(here: _Point, on_u: _OnU) -> Minimum:
    """Check the conditions of a minimum and say so."""
    if here.distance > _NEAR_STEP:
        here = on_u.renewed(here)
    slope, promise = _slope(here), _promise(here, _newton_step(here))
    free = here.u > 0.0
    lowest = float(np.linalg.eigvalsh(here.hessian[np.ix_(free, free)]).min(initial=np.inf))
    at_end = bool((here.u >= _MAX_U - 1.0).any())
    converged = promise <= _RESOLVED and lowest > -1e-6 and not at_end
    state = f"largest free slope {slope:.1e}, at most {promise:.1e} left to gain"
    if at_end:
        message = "a variance ratio grew without bound"
    elif converged:
        message = f"converged after {on_u.evaluations} evaluations; {state}"
    else:
        message = f"not converged after {on_u.evaluations} evaluations; {state}"
    gamma = np.expm1(here.u) / on_u.size
    return Minimum(gamma, here.value, converged, message, on_u.evaluations)
