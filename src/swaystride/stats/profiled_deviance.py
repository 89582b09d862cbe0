r"""The deviance of a linear mixed model as a function of its variance ratios.

With :math:`V = \sigma^2 H`, :math:`H = I + \sum_i \gamma_i Z_i Z_i^T`, minus twice the
log-likelihood is, up to constants,

.. math:: \nu \log\sigma^2 + \log\det(\gamma) + S(\gamma) / \sigma^2

where :math:`S = y^T P y` is the generalised residual sum of squares after the fixed effects are
profiled out, and either :math:`\nu = n`, :math:`\log\det = \log|H|` (ML) or :math:`\nu = n - p`,
:math:`\log\det = \log|H| + \log|X^T H^{-1} X|` (REML). Everything that a fit, an interval or the
Satterthwaite method needs follows from `logdet` and `S` with their first and second derivatives
(:class:`DevianceParts`), whoever computes them: :mod:`~swaystride.stats.one_factor` for a single
grouping factor, :mod:`~swaystride.stats.crossed_factors` for any number.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from swaystride.stats.grouping_factor import FloatArray


@dataclass(frozen=True)
class DevianceParts:
    """The two parts of the deviance with derivatives with respect to k variance ratios.

    Attributes
    ----------
    logdet, s : float
    logdet_gradient, s_gradient : array, shape (k,)
    logdet_hessian, s_hessian : array, shape (k, k)
    """

    logdet: float
    logdet_gradient: FloatArray
    logdet_hessian: FloatArray
    s: float
    s_gradient: FloatArray
    s_hessian: FloatArray


@dataclass(frozen=True)
class Solution:
    """Fixed and random effects at given variance ratios, in the basis Q of the fixed effects.

    Attributes
    ----------
    shift : array, shape (p,)
        Coefficients on Q that are added to those of ordinary least squares.
    precision : array, shape (p, p)
        ``Q.T @ inv(H) @ Q``.
    random : tuple of array
        Predicted random effects, one array per grouping factor.
    residual : array, shape (n,)
        What neither fixed nor random effects explain.
    """

    shift: FloatArray
    precision: FloatArray
    random: tuple[FloatArray, ...]
    residual: FloatArray


class BoundResponse(Protocol):
    """A design together with one response from which ordinary least squares is removed."""

    def parts(self, gamma: FloatArray, *, reml: bool) -> DevianceParts:
        """Parts of the deviance at the variance ratios, shape (k,)."""
        ...

    def value(self, gamma: FloatArray, *, reml: bool) -> tuple[float, float]:
        """Log-determinant and generalised residual sum of squares alone."""
        ...

    def solution(self, gamma: FloatArray) -> Solution:
        """Effects at the variance ratios."""
        ...


Derivatives = tuple[float, FloatArray, FloatArray]
Objective = Callable[[FloatArray], Derivatives]


def profiled(parts: DevianceParts, nu: int) -> Derivatives:
    r"""Deviance with :math:`\sigma^2 = S/\nu` profiled out, with gradient and Hessian.

    Parameters
    ----------
    parts : DevianceParts
    nu : int
        n for ML, n - p for REML.

    Returns
    -------
    float, array of shape (k,), array of shape (k, k)
        Including the constants, so that the value is minus twice the log-likelihood, except for
        the REML term ``log|X.T X|`` (see :attr:`MixedDesign.log_det_xtx`).

    Examples
    --------
    >>> zero = np.zeros(1)
    >>> parts = DevianceParts(0.0, zero, np.zeros((1, 1)), 5.0, zero, np.zeros((1, 1)))
    >>> round(profiled(parts, 5)[0], 6)  # 5 (1 + log 2 pi)
    14.189385
    """
    relative = parts.s_gradient / parts.s
    value = profiled_value(parts.logdet, parts.s, nu)
    gradient = parts.logdet_gradient + nu * relative
    hessian = parts.logdet_hessian + nu * (parts.s_hessian / parts.s - np.outer(relative, relative))
    return value, gradient, hessian


def profiled_value(logdet: float, s: float, nu: int) -> float:
    """Deviance with the residual variance profiled out, see :func:`profiled`.

    Parameters
    ----------
    logdet, s : float
        Log-determinant and generalised residual sum of squares.
    nu : int
        n for ML, n - p for REML.

    Returns
    -------
    float

    Examples
    --------
    >>> round(profiled_value(0.0, 5.0, 5), 6)
    14.189385
    """
    return logdet + nu * (1.0 + float(np.log(2.0 * np.pi * s / nu)))


def at_residual_variance(parts: DevianceParts, nu: int, sigma2: float) -> Derivatives:
    """Deviance with the residual variance held fixed.

    Parameters
    ----------
    parts : DevianceParts
    nu : int
    sigma2 : float

    Returns
    -------
    float, array of shape (k,), array of shape (k, k)

    Examples
    --------
    >>> zero = np.zeros(1)
    >>> parts = DevianceParts(0.0, zero, np.zeros((1, 1)), 5.0, zero, np.zeros((1, 1)))
    >>> at_residual_variance(parts, 5, 1.0)[0] == profiled(parts, 5)[0]
    True
    """
    value = nu * np.log(2.0 * np.pi * sigma2) + parts.logdet + parts.s / sigma2
    gradient = parts.logdet_gradient + parts.s_gradient / sigma2
    return float(value), gradient, parts.logdet_hessian + parts.s_hessian / sigma2


def at_component_variance(
    parts: DevianceParts, nu: int, gamma: FloatArray, index: int, variance: float
) -> Derivatives:
    r"""Deviance with one variance component held fixed, :math:`\sigma^2 = v/\gamma_i`.

    Parameters
    ----------
    parts : DevianceParts
        At `gamma`.
    nu : int
    gamma : array, shape (k,)
        ``gamma[index]`` is positive.
    index : int
        Which component is fixed.
    variance : float
        Its value, positive.

    Returns
    -------
    float, array of shape (k,), array of shape (k, k)
        Infinite where the ratio is zero.

    Examples
    --------
    >>> zero = np.zeros(1)
    >>> parts = DevianceParts(0.0, zero, np.zeros((1, 1)), 5.0, zero, np.zeros((1, 1)))
    >>> value, slope, _ = at_component_variance(parts, 5, np.ones(1), 0, 1.0)
    >>> value == at_residual_variance(parts, 5, 1.0)[0], slope.tolist()
    (True, [0.0])
    """
    ratio = float(gamma[index])
    if ratio <= 0.0:
        return np.inf, parts.logdet_gradient, parts.logdet_hessian
    value, gradient, hessian = at_residual_variance(parts, nu, variance / ratio)
    gradient, hessian = gradient.copy(), hessian.copy()
    gradient[index] += parts.s / variance - nu / ratio
    hessian[index, :] += parts.s_gradient / variance
    hessian[:, index] += parts.s_gradient / variance
    hessian[index, index] += nu / ratio**2
    return value, gradient, hessian
