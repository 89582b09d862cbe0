import numpy as np
import pandas as pd
import pytest

from swaystride.errors import ModelError
from swaystride.stats.block_layout import block_layout
from swaystride.stats.grouping_factor import grouping_factor
from swaystride.stats.mixed_design import MixedDesign, design_from_terms, model_matrix


def test_levels_of_an_interaction_are_the_observed_combinations():
    frame = pd.DataFrame({"a": list("vvuuu"), "b": [2, 1, 1, 1, 2]})
    factor = grouping_factor(frame, "a:b")
    assert list(factor.levels) == ["u:1", "u:2", "v:1", "v:2"]
    assert [factor.levels[at] for at in factor.codes] == ["v:2", "v:1", "u:1", "u:1", "u:2"]
    assert factor.is_nested_in(grouping_factor(frame, "a"))
    assert not grouping_factor(frame, "a").is_nested_in(factor)


def test_three_way_interaction_equals_a_pasted_column(crossed):
    frame = crossed()
    pasted = frame[["p", "e", "r"]].astype(str).agg("|".join, axis=1)
    expected = pd.factorize(pasted)[0]
    codes = grouping_factor(frame, "p:e:r").codes
    assert len(set(zip(codes, expected, strict=True))) == len(set(expected)) == codes.max() + 1


def test_sums_within_levels_equal_the_indicator_product(crossed):
    frame = crossed()
    factor = grouping_factor(frame, "p:r")
    values = np.random.default_rng(0).normal(size=(len(frame), 3))
    indicator = np.eye(factor.n_levels)[factor.codes]
    np.testing.assert_allclose(factor.sum_rows(values), indicator.T @ values, atol=1e-13)


def test_products_of_terms_are_products_of_columns():
    frame = pd.DataFrame({"a": [1.0, 2, 3], "b": [4, 5, 6]})
    expected = [[1, 1, 4, 16], [1, 2, 10, 50], [1, 3, 18, 108]]
    assert model_matrix(frame, ["a", "a:b", "a:b:b"]).tolist() == expected


def test_the_carrier_takes_all_nested_factors_into_its_blocks(crossed):
    frame = crossed()
    design = design_from_terms(frame, ["x"], ["p", "p:e", "r", "p:r", "p:e:r"])
    layout = block_layout(design)
    assert layout.interior == (0, 1, 3, 4)
    assert layout.border == (2,)
    assert layout.n_blocks == 6


def _frame() -> pd.DataFrame:
    rng = np.random.default_rng(3)
    frame = pd.DataFrame({"u": rng.normal(size=12), "v": rng.normal(size=12)})
    frame["w"] = frame["u"] - 2 * frame["v"]
    frame["zero"], frame["who"], frame["word"] = 0.0, np.repeat(list("abcd"), 3), "x"
    frame["other"], frame["row"], frame["one"] = frame["who"] + "!", range(12), 1
    frame["gap"] = frame["u"].where(frame["u"] < 1)
    return frame


@pytest.mark.parametrize(
    ("terms", "groups", "line"),
    [
        (["u", "v", "w"], ["who"], "the fixed effects are collinear; found w is given by u, v"),
        (["u", "zero"], ["who"], "the fixed effect zero is zero in every row"),
        (["u", "word"], ["who"], "the column word is not numeric"),
        (["q"], ["who"], "there is no column q; expected one of u, v, w"),
        (["gap"], ["who"], "the column gap is missing in"),
        (["u"], ["row"], "the random intercept of row cannot be told from the residual"),
        (["u"], ["one"], "the grouping factor one has 1 level; expected 2 or more"),
        (["u"], ["who", "other"], "the grouping factors who and other divide the rows in the same"),
        (["u"], ["nobody"], "there is no column nobody"),
    ],
)
def test_refusals_name_the_column(terms, groups, line):
    with pytest.raises(ModelError) as error:
        design_from_terms(_frame(), terms, groups)
    assert line in str(error.value)
    assert "\n" not in str(error.value)


def test_no_rows_and_too_few_rows_are_refused():
    with pytest.raises(ModelError, match="there are no rows"):
        design_from_terms(_frame().iloc[:0], ["u"], ["who"])
    with pytest.raises(ModelError, match="there are no rows"):
        MixedDesign(np.empty((0, 1)), ("Intercept",), ())
    with pytest.raises(ModelError, match="3 rows cannot carry 3 fixed effects"):
        design_from_terms(_frame().iloc[[0, 1, 4]], ["u", "v"], ["who"])
    infinite = np.array([[1.0], [np.inf], [1.0]])
    with pytest.raises(ModelError, match="the column Intercept is not finite in 1 of 3 rows"):
        MixedDesign(infinite, ("Intercept",), ())


def test_badly_scaled_but_independent_columns_are_accepted():
    n = np.arange(1.0, 31.0)
    X = np.column_stack([np.ones(30), n**5, 1e-9 * n, 1e3 + n**0.1])
    design = MixedDesign(X, tuple("abcd"), ())
    norm = np.abs(X).max(axis=0)
    np.testing.assert_allclose(design.Q @ design.R / norm, X / norm, atol=1e-12)
