"""Terms of the response surface of standing sway."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: The scatter of single trials is described up to this (logarithmic) ratio of the noise torques.
MAX_LN_NOISE_RATIO: Final = 1.0


def monomials(scaled: Array, exponents: NDArray[np.int64]) -> Array:
    """Terms of the polynomials at scaled inputs.

    Parameters
    ----------
    scaled : ndarray, shape (..., n_inputs)
        Inputs, scaled to −1…1.
    exponents : ndarray of int, shape (n_terms, n_inputs)
        Power of each input in each term.

    Returns
    -------
    ndarray, shape (..., n_terms)

    Examples
    --------
    >>> monomials(np.array([[2.0, 3.0]]), np.array([[0, 0], [1, 0], [1, 2]])).tolist()
    [[1.0, 2.0, 18.0]]
    """
    degree = int(exponents.max())
    # Powers by repeated multiplication: exact at zero and much faster than ``**``.
    powers = np.ones((degree + 1, *scaled.shape))
    for d in range(1, degree + 1):
        powers[d] = powers[d - 1] * scaled
    terms = np.ones((*scaled.shape[:-1], len(exponents)))
    for j in range(scaled.shape[-1]):
        terms *= np.moveaxis(powers[exponents[:, j], ..., j], 0, -1)
    return terms


def slopes(scaled: Array, exponents: NDArray[np.int64], j: int) -> Array:
    """Derivatives of the terms with respect to one scaled input.

    Parameters
    ----------
    scaled, exponents : ndarray
        As for :func:`monomials`.
    j : int
        The input.

    Returns
    -------
    ndarray, shape (..., n_terms)

    Examples
    --------
    >>> slopes(np.array([[2.0, 3.0]]), np.array([[0, 0], [1, 0], [1, 2]]), 1).tolist()
    [[0.0, 0.0, 12.0]]
    """
    lowered = exponents.copy()
    lowered[:, j] = np.maximum(lowered[:, j] - 1, 0)
    return monomials(scaled, lowered) * exponents[:, j]


def scatter_terms(scaled_activity: Array, ln_noise_ratio: Array) -> Array:
    """Terms of the scatter of single trials.

    A cubic in the activity (a slower body wanders less often to and fro within a trial) and a
    parabola in the ratio of the noise torques (the velocity follows the direction that sways
    more). Both are clipped to where they were fitted.

    Parameters
    ----------
    scaled_activity : ndarray, shape (n,)
        Activity, scaled to −1…1 over the fitted range.
    ln_noise_ratio : ndarray, shape (n,)
        ``ln_noise_ap − ln_noise_ml``.

    Returns
    -------
    ndarray, shape (n, 6)

    Examples
    --------
    >>> scatter_terms(np.array([0.5]), np.array([3.0])).tolist()
    [[1.0, 0.5, 0.25, 0.125, 1.0, 1.0]]
    """
    a = np.clip(scaled_activity, -1.0, 1.0)
    r = np.clip(ln_noise_ratio, -MAX_LN_NOISE_RATIO, MAX_LN_NOISE_RATIO)
    return np.stack([np.ones_like(a), a, a**2, a**3, r, r**2], axis=-1)
