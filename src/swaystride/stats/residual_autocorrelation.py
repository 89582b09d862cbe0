r"""Autocorrelation of the errors of a linear model, from residuals that hide a part of it.

Residuals are less correlated than the errors, because the model takes up what looks like its
terms: with three coefficients and 60 rows, errors of ρ = .7 leave residuals of .6. So ρ is the one
whose expected residuals have the correlation that was found. With the residual maker M, the
correlation R of the errors and neighbours D,

.. math:: \frac{\mathrm{tr}(M D M R_\rho)}{\mathrm{tr}(M R_\rho)} = \frac{e^T D e}{e^T e},
    \qquad \sigma^2 = \frac{e^T e}{\mathrm{tr}(M R_\rho)} .

Both traces are polynomials in ρ, because errors at places i and j correlate by
:math:`\rho^{|i - j|}`. Without correlation, σ² has the usual divisor of a regression.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

#: Errors closer to a random walk than this cannot be told from one in a hundred rows.
LARGEST: Final = 0.99
_PRECISION = 1e-14


class AutoregressiveErrors(NamedTuple):
    """Errors that follow each other with correlation ρ.

    Attributes
    ----------
    rho : float
        Correlation of neighbours, 0 to :data:`LARGEST`.
    sd : float
        Standard deviation of one error.
    """

    rho: float
    sd: float


def autoregressive_errors(
    residuals: npt.ArrayLike, basis: npt.ArrayLike, place: npt.ArrayLike
) -> AutoregressiveErrors:
    """Correlation of neighbouring errors and their standard deviation.

    Negative correlation is taken for none.

    Parameters
    ----------
    residuals : array, shape (n,)
        Of a least-squares fit.
    basis : array, shape (n, p)
        Orthonormal columns that span the terms of the model.
    place : array of int, shape (n,)
        Place of each row in the series, rising; a place that is left out is a gap.

    Returns
    -------
    AutoregressiveErrors
        NaN if no two rows are neighbours, or no degree of freedom is left.

    Examples
    --------
    >>> level = np.full((6, 1), 6**-0.5)
    >>> found = autoregressive_errors([1.0, 0.5, -1.0, -0.5, 0.5, -0.5], level, range(6))
    >>> round(found.rho, 2)
    0.28
    """
    e, q, at = np.asarray(residuals, float), np.asarray(basis, float), np.asarray(place, int)
    n, p = q.shape
    lag = np.abs(at[:, None] - at[None, :])
    neighbours = 0.5 * (lag == 1)
    if n <= p or not neighbours.any():
        return AutoregressiveErrors(float("nan"), float("nan"))
    maker = np.eye(n) - q @ q.T
    neighbouring = np.bincount(lag.ravel(), (maker @ neighbours @ maker).ravel())
    everything = np.bincount(lag.ravel(), maker.ravel())
    powers = np.arange(len(everything))
    total = float(e @ e)
    found = float(e @ neighbours @ e) / total if total > 0.0 else 0.0

    def excess(rho: float) -> float:
        """Expected correlation of neighbouring residuals less the one found, times tr(MR)."""
        return float((neighbouring - found * everything) @ rho**powers)

    if excess(0.0) >= 0.0:
        rho = 0.0
    elif excess(LARGEST) <= 0.0:
        rho = LARGEST
    else:
        rho = float(brentq(excess, 0.0, LARGEST, xtol=_PRECISION, rtol=4.0 * np.finfo(float).eps))
    return AutoregressiveErrors(rho, float(np.sqrt(total / (everything @ rho**powers))))
