"""Significance of the ranges of motion: SciPy's t, and the mixed model of a balanced design."""

import kinematics_results as made
import numpy as np
import pandas as pd
import pytest
from scipy.stats import ttest_1samp, ttest_rel

from import_graph import REPOSITORY
from swaystride.studies.kinematics.range_tests import mixed_test, paired_test, table_4_4
from swaystride.studies.kinematics.table_options import TableOptions
from swaystride.studies.kinematics.tables import range_features

OPTIONS = TableOptions(0.05, 2.0, 30.0, 1.0, 10, 5.0)
PRINTED = pd.read_csv(REPOSITORY / "data" / "published" / "table_4_4.csv")


@pytest.fixture(scope="module")
def strides():
    return made.frames()["strides"]


def test_t_and_p_are_those_of_scipy(strides):
    table = table_4_4(strides, PRINTED, OPTIONS).set_index(["angle", "side"])
    trials = range_features(strides)
    for angle, side in (("hip_flexion", "right"), ("ankle_dorsiflexion", "left")):
        own = trials[(trials["angle"] == angle) & (trials["side"] == side)]
        expected = ttest_rel(own["erkf"], own["optic"])
        row = table.loc[(angle, side)]
        assert row["t"] == pytest.approx(expected.statistic)
        assert (row["p"], row["df"]) == pytest.approx((expected.pvalue, 4))
        assert row["significant"] == int(expected.pvalue < 0.05)


def test_reference_columns_are_those_of_the_print(strides):
    table = table_4_4(strides, PRINTED, OPTIONS)
    columns = ["reference_deg_mean", "reference_deg_sd", "optic_poor"]
    np.testing.assert_array_equal(table[columns], PRINTED[columns])


def test_too_few_or_equal_trials_have_no_test():
    one = pd.DataFrame({"participant": ["A"], "optic": [1.0], "erkf": [2.0], "difference": [1.0]})
    assert np.isnan(paired_test(one)["p"])
    assert np.isnan(mixed_test(one)["p_mixed"])
    same = pd.concat([one, one])
    assert np.isnan(paired_test(same)["p"])
    assert np.isnan(mixed_test(same)["p_mixed"])


def test_in_a_balanced_design_the_mixed_model_tests_the_means_of_the_runners():
    """Two trials each: the intercept's t is that of the runners' means, with n − 1 df."""
    rng = np.random.default_rng(1)
    people = np.repeat(list("ABCDE"), 2)
    difference = np.repeat(rng.normal(3, 2, 5), 2) + rng.normal(0, 0.5, 10)
    frame = pd.DataFrame({"participant": people, "difference": difference})
    found = mixed_test(frame)
    expected = ttest_1samp(frame.groupby("participant")["difference"].mean(), 0.0)
    assert found["p_mixed"] == pytest.approx(expected.pvalue, rel=1e-4)
    assert found["df_mixed"] == pytest.approx(4, rel=1e-3)


def test_differences_below_the_scatter_are_not_significant():
    rows = [
        (person, "01", side, number, source, f"rom_{angle}", 50 + shift)
        for person, shift_of in (("A", 1.0), ("B", -1.0), ("C", 0.2))
        for side in ("right", "left")
        for angle in ("hip_flexion",)
        for number in (11, 12)
        for source, shift in (("optic", 0.0), ("erkf", shift_of))
    ]
    columns = ["participant", "trial", "side", "stride", "source", "feature", "value"]
    table = table_4_4(pd.DataFrame(rows, columns=columns), PRINTED, OPTIONS)
    assert table.loc[table["angle"] == "hip_flexion", "significant"].tolist() == [0, 0]
    assert table.loc[table["angle"] == "hip_flexion", "n_participants"].tolist() == [3, 3]
