"""Correlations found over many sets of ratings against those of the population."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from rated_runs import BETWEEN, NAMES, measures, rated_runs, rating_model

from import_graph import REPOSITORY
from swaystride.simulate.experience_population import (
    attainable_population,
    population_correlations,
)
from swaystride.simulate.experience_rating_truth import RatingTruth, printed_associations
from swaystride.studies.experience import plan
from swaystride.studies.experience.recovery import (
    RECOVERY_COLUMNS,
    chance_findings,
    pooled_coverage,
    recovery_table,
)
from swaystride.studies.experience.recovery_rows import (
    RecoveryPlan,
    rated_again,
    recovery_rows,
    significant_rows,
)

KEYS = list(plan.MEASURE_KEYS)
BY_NAME = {measure.name: measure.key for measure in plan.MEASURES}
PLAN = RecoveryPlan(
    seeds=range(20), n_resamples=100, bootstrap_seed=1, start_s=600.0, mean="time_weighted"
)
TERRESTRIAL = ["P01_02", "P04_01", "P04_02", "P08_02", "P12_01"]


def published(name):
    return pd.read_csv(REPOSITORY / "data" / "published" / f"{name}.csv")


TABLES = {"all": published("table_5_3"), "aerial": published("table_5_4")}


@pytest.fixture(scope="module")
def study():
    """True measures, measured ones with some error and losses, truth and model of the ratings."""
    true = measures(KEYS)
    model = rating_model(unexplained_share=0.6)
    printed = printed_associations(TABLES["all"], published("study5_text"), BY_NAME, ())
    population = attainable_population(true.to_numpy(), printed, model.association)
    truth = RatingTruth(rated_runs(), tuple(KEYS), population, printed.between_scales)
    runs = true + 0.05 * np.random.default_rng(5).standard_normal(true.shape)
    runs.loc[["P02_02", "P09_01"], "heart_rate_bpm"] = np.nan
    runs.loc[["P03_01", "P06_03"], [key for key in KEYS if "head" in key]] = np.nan
    runs["pattern"] = np.where(runs.index.isin(TERRESTRIAL), "terrestrial", "aerial")
    # The order of the table is the study's own.
    return true, runs.rename_axis("run").reset_index().iloc[::-1], truth, model


@pytest.fixture(scope="module")
def table(study):
    true, runs, truth, model = study
    return recovery_table(runs, true, TABLES, truth, model, PLAN)


def rows_of(table):
    return table[table["n_runs"].notna()].set_index("quantity")


def test_every_starred_correlation_has_a_row(table):
    assert list(table) == list(RECOVERY_COLUMNS[1:])
    expected = {
        f"{group}/{BY_NAME[row.measure]}/{row.scale}": row.r
        for group, printed in TABLES.items()
        for row in printed[printed["significant"] == 1].itertuples()
    }
    assert rows_of(table)["printed"].to_dict() == expected


def test_rows_rest_on_their_runs(table):
    n_runs = rows_of(table)["n_runs"]
    head = n_runs.index.str.contains("head")
    everybody = n_runs.index.str.startswith("all/")
    assert set(n_runs[everybody & ~head]) == {23}
    assert set(n_runs[everybody & head]) == {21}
    assert set(n_runs[~everybody & ~head]) == {18}
    assert set(n_runs[~everybody & head]) == {16}


def test_medians_and_coverage_are_those_of_the_population(table):
    rows = rows_of(table)
    assert (rows["within"] == "yes").all()
    assert (rows["median"] - rows["truth"]).abs().max() < 0.1
    assert rows["identity_error"].max() < 1e-9
    np.testing.assert_allclose(rows["bias"], rows["mean"] - rows["truth"])
    pooled = table.set_index("quantity").loc["all/pooled coverage"]
    assert pooled["coverage"] == pytest.approx(pooled["coverage_expected"], abs=0.06)
    assert pooled["coverage"] == rows[rows.index.str.startswith("all/")]["coverage"].mean()


def test_truth_is_that_of_the_runs_of_the_row(study, table):
    true, _, truth, _ = study
    aerial = ~true.index.isin(TERRESTRIAL)
    population = truth.population
    expected = population_correlations(
        population.signal[aerial], np.diag(population.residual), true.to_numpy()[aerial]
    )
    found = rows_of(table)["truth"]
    at = KEYS.index("speed_m_s")
    assert found["aerial/speed_m_s/affective_valence"] == pytest.approx(expected[at, 0])
    assert found["all/peak_roll_rate_deg_s/flow"] == pytest.approx(
        truth.attainable("peak_roll_rate_deg_s", "flow")
    )


def test_a_strong_association_is_found(study):
    """Without a print to be reached: three measures explain half of each scale."""
    true, _, truth, model = study
    standard = (true - true.mean()) / true.std()
    signal = np.sqrt(0.5) * standard[["duty_factor", "ml_ratio", "knee_range_deg"]].to_numpy()
    strong = replace(
        truth, population=replace(truth.population, signal=signal, residual=0.5 * np.eye(3))
    )
    printed = pd.DataFrame(
        {
            "measure": ["Duty Factor", "ML Ratio of Pelvis Acceleration RMS", "Knee ROM"],
            "scale": list(plan.SCALES),
            "r": 0.7,
            "significant": 1,
        }
    )
    rows = significant_rows("all", printed, pd.Series(BY_NAME), true, true, pd.Index(NAMES))
    scores = rated_again(strong, model, PLAN, associated=True)
    found = recovery_rows(rows, scores, strong, model, PLAN)
    np.testing.assert_allclose(found["truth"], np.sqrt(0.5))
    np.testing.assert_allclose(found["median"], np.sqrt(0.5), atol=0.05)
    np.testing.assert_allclose(found["mean"], scores_mean(true, scores), atol=1e-12)


def scores_mean(true, scores):
    """Mean correlation by NumPy."""
    columns = ("duty_factor", "ml_ratio", "knee_range_deg")
    return [
        np.mean([np.corrcoef(true[key], one[:, at])[0, 1] for one in scores])
        for at, key in enumerate(columns)
    ]


def test_a_row_far_from_the_population_is_told(study):
    true, _, truth, model = study
    rows = significant_rows(
        "all", TABLES["all"].iloc[:0], pd.Series(BY_NAME), true, true, pd.Index(NAMES)
    )
    assert rows == []
    rows = significant_rows("all", TABLES["all"], pd.Series(BY_NAME), true, true, pd.Index(NAMES))
    scores = rated_again(truth, model, PLAN, associated=True)
    shifted = scores.copy()
    shifted[:, :, rows[0].scale] += 100.0 * true[KEYS[9]].to_numpy()
    found = recovery_rows(rows[:1], shifted, truth, model, PLAN)
    assert rows[0].name.startswith(f"all/{KEYS[9]}/")
    assert found["within"].tolist() == ["no"]
    assert found["coverage"].tolist() == [0.0]
    assert pooled_coverage(found, "x", judged=True)["within"].tolist() == ["no"]
    assert pooled_coverage(found, "x", judged=False)["within"].tolist() == ["reported"]


def test_chance_finds_one_in_twenty(study, table):
    rng = np.random.default_rng(3)
    scores = rng.standard_normal((60, 23, 3))
    independent = pd.DataFrame(rng.standard_normal((23, 12)))
    counts = chance_findings(independent, scores)
    assert counts.mean() / 36 == pytest.approx(0.05, abs=0.02)
    null = table.set_index("quantity").loc["null/significant correlations"]
    assert null["truth"] == pytest.approx(0.05 * 111)
    assert null["printed"] == 7
    assert null["mean"] == pytest.approx(5.55, abs=4.0)
    _, _, truth, model = study
    nothing = rated_again(truth, model, PLAN, associated=False)
    between = np.mean([np.corrcoef(one.T) for one in nothing], axis=0)
    np.testing.assert_allclose(between, BETWEEN, atol=0.12)
