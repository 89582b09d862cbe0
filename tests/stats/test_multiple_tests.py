"""Many tests at once: statsmodels, and a case by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from statsmodels.stats.multitest import multipletests

from swaystride.stats.multiple_tests import benjamini_hochberg, holm


@settings(max_examples=25)
@given(st.integers(0, 2**32 - 1), st.integers(0, 30))
def test_both_corrections_are_those_of_statsmodels(seed, n):
    """Ties, ones and tests that were not done among them."""
    rng = np.random.default_rng(seed)
    p = np.round(rng.uniform(size=n) ** 2, 2)
    p[rng.uniform(size=n) < 0.2] = np.nan
    known = np.isfinite(p)
    for ours, method in ((holm, "holm"), (benjamini_hochberg, "fdr_bh")):
        corrected = ours(p)
        assert np.array_equal(np.isfinite(corrected), known)
        if known.any():
            expected = multipletests(p[known], method=method)[1]
            np.testing.assert_allclose(corrected[known], expected, atol=1e-14)


def test_holm_by_hand():
    """0.01·3, then max with 0.02·2, then max with 0.5·1; a missing value is not counted."""
    assert holm(np.array([0.5, 0.01, np.nan, 0.02])).tolist() == pytest.approx(
        [0.5, 0.03, np.nan, 0.04], nan_ok=True
    )
