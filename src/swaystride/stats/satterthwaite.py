r"""Satterthwaite's degrees of freedom from the analytic information of the variance parameters.

For a contrast with variance :math:`v(\theta) = l^T \mathrm{cov}(\hat\beta) l` of the variance
parameters :math:`\theta`, :math:`df = 2 v^2 / (g^T A g)` with g the gradient of v and A the
inverse of the observed information (Kuznetsova et al. 2017, lmerTest, but without numerical
derivatives). Components estimated as zero are left out, as they are in effect by lmerTest, whose
scale of standard deviations has no slope there.
"""

from __future__ import annotations

import numpy as np

from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_fit import DesignFit, ols_residual, structure_of

# Relative eigenvalue below which a direction of the information counts as flat.
_FLAT = 1e-12


def satterthwaite_df(fit: DesignFit, contrasts: FloatArray) -> FloatArray:
    """Degrees of freedom of single-degree contrasts of the fixed effects.

    Parameters
    ----------
    fit : DesignFit
    contrasts : array, shape (m, p)
        One contrast per row.

    Returns
    -------
    array, shape (m,)

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> from swaystride.stats.mixed_fit import fit_design
    >>> table = pd.DataFrame({"who": list("aabbccdd")})
    >>> y = np.array([1.0, 2, 4, 5, 8, 9, 3, 2])
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), y)
    >>> satterthwaite_df(fit, np.array([[1.0]])).round(6).tolist()  # groups - 1
    [3.0]
    """
    active = fit.gamma > 0.0
    covariance = variance_parameter_covariance(fit)
    slopes = structure_of(fit.design).precision_slopes(fit.gamma)[active]
    weights = np.linalg.solve(fit.precision, np.linalg.solve(fit.design.R.T, contrasts.T))
    variance = np.einsum("ij,jk,ik->i", contrasts, fit.covariance, contrasts)
    gradient = fit.sigma2 * np.einsum("am,kab,bm->mk", weights, slopes, weights)
    gradient = np.column_stack([gradient * fit.gamma[active], variance])
    df: FloatArray = 2.0 * variance**2 / np.einsum("mi,ij,mj->m", gradient, covariance, gradient)
    return df


def variance_parameter_covariance(fit: DesignFit) -> FloatArray:
    r"""Asymptotic covariance of the logarithms of positive ratios and of the residual variance.

    Parameters
    ----------
    fit : DesignFit

    Returns
    -------
    array, shape (k + 1, k + 1)
        Rows and columns of the k positive ratios :math:`\log\gamma_i`, then
        :math:`\log\sigma^2`.

    Examples
    --------
    >>> import pandas as pd
    >>> from swaystride.stats.mixed_design import design_from_terms
    >>> from swaystride.stats.mixed_fit import fit_design
    >>> table = pd.DataFrame({"who": list("aabbcc")})
    >>> fit = fit_design(design_from_terms(table, [], ["who"]), np.array([1.0, 2, 4, 5, 8, 9]))
    >>> float(variance_parameter_covariance(fit)[-1, -1].round(6))  # 2 / (n - groups)
    0.666667
    """
    active = fit.gamma > 0.0
    bound = structure_of(fit.design).bind(ols_residual(fit.design, fit.response))
    parts = bound.parts(fit.gamma, reml=fit.reml)
    gamma, k = fit.gamma[active], int(active.sum())
    information = np.empty((k + 1, k + 1))
    curvature = parts.logdet_hessian + parts.s_hessian / fit.sigma2
    information[:k, :k] = curvature[np.ix_(active, active)] * np.outer(gamma, gamma)
    information[:k, k] = information[k, :k] = -parts.s_gradient[active] * gamma / fit.sigma2
    information[k, k] = fit.nu
    values, vectors = np.linalg.eigh(0.5 * information)
    keep = values > _FLAT * values.max()
    covariance: FloatArray = (vectors[:, keep] / values[keep]) @ vectors[:, keep].T
    return covariance
