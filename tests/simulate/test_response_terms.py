"""Terms of the response surface against plain arithmetic."""

import numpy as np

from swaystride.simulate.response_terms import monomials, scatter_terms, slopes

EXPONENTS = np.array([[0, 0, 0], [1, 0, 2], [0, 3, 1]])


def test_monomials_match_plain_powers():
    points = np.random.default_rng(4).uniform(-1, 1, size=(7, 3))
    plain = np.prod(points[:, None, :] ** EXPONENTS, axis=2)
    np.testing.assert_allclose(monomials(points, EXPONENTS), plain, rtol=1e-13)


def test_slopes_match_central_differences():
    points = np.random.default_rng(5).uniform(-1, 1, size=(7, 3))
    for j in range(3):
        step = 1e-6 * np.eye(3)[j]
        central = (monomials(points + step, EXPONENTS) - monomials(points - step, EXPONENTS)) / 2e-6
        np.testing.assert_allclose(slopes(points, EXPONENTS, j), central, atol=1e-8)


def test_scatter_terms_stay_where_they_were_fitted():
    inside = scatter_terms(np.array([-1.0, 1.0]), np.array([1.0, -1.0]))
    beyond = scatter_terms(np.array([-4.0, 2.0]), np.array([3.0, -7.0]))
    assert np.array_equal(inside, beyond)
