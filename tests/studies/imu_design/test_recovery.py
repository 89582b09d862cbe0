"""Recovery over many cohorts: means, coverage, and the verdicts on what must be seen."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.studies.imu_design.experiments import EXPERIMENTS, effect_names
from swaystride.studies.imu_design.plan import TABLES
from swaystride.studies.imu_design.recovery import (
    EXPECTATIONS,
    KNOWN_DEVIATIONS,
    RECOVERY_COLUMNS,
    recovery_table,
    slopes_by_seed,
)

PRINTED = {name: pd.read_csv(REPOSITORY / f"data/published/{name}.csv") for name in TABLES.values()}


@pytest.fixture
def cohorts(slopes, settings):
    """400 cohorts that scatter about the printed slopes with the printed standard error."""
    rng = np.random.default_rng(3)
    rows = []
    for seed in range(400):
        for experiment in EXPERIMENTS:
            names = effect_names(experiment, settings)
            for name, truth in zip(names, slopes[experiment], strict=True):
                slope, se = truth + 0.2 * rng.standard_normal(), 0.2
                p = 0.001 if abs(slope) > 1.96 * se else 0.5
                rows.append(
                    (experiment, "subject", name, slope, se, p, slope - 0.392, slope + 0.392, seed)
                )
    columns = [
        "experiment",
        "model",
        "effect",
        "slope_pct_per_m_s",
        "se",
        "p",
        "ci_low",
        "ci_high",
        "seed",
    ]
    return pd.DataFrame(rows, columns=columns)


def test_cohorts_about_the_print_recover_it(cohorts):
    table = recovery_table(cohorts, PRINTED, 0.05).set_index("quantity")
    assert (*table.columns,) == tuple(name for name in RECOVERY_COLUMNS if name != "quantity")
    assert len(table) == 22
    assert table["truth"].isna().all()
    np.testing.assert_allclose(table["mean"], table["printed"], atol=0.04)
    np.testing.assert_allclose(table["empirical_sd"], 0.2, rtol=0.15)
    assert table["coverage"].between(0.92, 0.98).all()
    assert set(table["within"]) == {"yes", "reported"}
    assert table.loc["table_a1/24g", "within"] == "reported"
    assert table.loc["table_a1/24g", "share_significant"] > 0.7


def test_a_slope_of_the_wrong_sign_fails(cohorts):
    turned = cohorts.assign(slope_pct_per_m_s=-cohorts["slope_pct_per_m_s"])
    table = recovery_table(turned, PRINTED, 0.05).set_index("quantity")
    assert table.loc["table_a1/6g", "within"] == "no"
    assert table.loc["table_a1/baseline_100g", "within"] == "no"
    assert table.loc["table_a1/75g", "within"] == "yes"
    assert table.loc["table_a1/16g", "within"] == "explained"


def test_only_what_is_judged_can_be_a_known_deviation():
    assert {tuple(quantity.split("/")) for quantity in KNOWN_DEVIATIONS} <= set(EXPECTATIONS)


def test_only_the_printed_model_is_judged(cohorts):
    other = cohorts.assign(model="subject_and_trial")
    table = recovery_table(pd.concat([cohorts, other]), PRINTED, 0.05)
    ours = table[table["variant"] == "printed, subject and trial"]
    assert len(ours) == 22
    assert set(ours["within"]) == {"reported"}


def test_slopes_stand_beside_the_print_by_seed(cohorts):
    few = cohorts[cohorts["seed"] < 3]
    table = slopes_by_seed(few, PRINTED, "subject")
    assert list(table) == ["table", "effect", "printed", "seed_0", "seed_1", "seed_2"]
    six = table[table["effect"] == "6g"].iloc[0]
    assert six["printed"] == -5.70
    own = few[(few["effect"] == "6g") & (few["seed"] == 2)]
    assert six["seed_2"] == own["slope_pct_per_m_s"].item()


def test_expectations_name_rows_of_the_print():
    for table, effect in EXPECTATIONS:
        assert effect in set(PRINTED[table]["effect"])
