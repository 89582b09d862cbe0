"""Measures and answers joined by run and by window."""

import numpy as np
import pandas as pd
import pytest

from swaystride.gait.rating_windows import PRINTED_WINDOWS, sliding_windows
from swaystride.studies.experience.observations import (
    RUN_OBSERVATIONS,
    WINDOW_OBSERVATIONS,
    rows_of_runs,
    run_observations,
    window_observations,
)
from swaystride.studies.experience.patterns import PatternRules
from swaystride.studies.experience.plan import MEASURE_KEYS

RULES = PatternRules(0.276, 0.288, -0.033, "run_mean")
NAMES = ["P01_01", "P01_02", "P02_01"]


@pytest.fixture
def runs():
    table = pd.DataFrame({key: [1.0, 2.0, 3.0] for key in MEASURE_KEYS})
    table = table.assign(
        run=NAMES,
        participant=["P01", "P01", "P02"],
        n_strides=[1500, 1400, 1300],
        n_rejected=0,
        speed_m_s=[12 / 3.6, 12 / 3.6 + 0.5, 12 / 3.6 - 0.5],
        duty_factor=[0.25, 0.27, 0.30],
    )
    table.loc[2, "peak_head_g"] = np.nan
    return table


@pytest.fixture
def scores():
    # of another order, and with the ratings of one run lost after 20 minutes
    return pd.DataFrame(
        {
            "run": ["P02_01", "P01_01", "P01_02"],
            "participant": ["P02", "P01", "P01"],
            "activity_enjoyment": [90.0, 100.0, np.nan],
            "flow": [60.0, 70.0, 80.0],
            "ratings_known_until_s": [np.nan, 1200.0, 1800.0],
            "n_ratings": [0, 3, 2],
            "reason": "",
        }
    )


@pytest.fixture
def affect():
    rows = [("P01_01", 0.0, 1.0), ("P01_01", 900.0, 3.0), ("P01_01", 1100.0, 5.0), ("P01_02", 0.0, 2.0), ("P01_02", 700.0, 4.0)]  # fmt: skip
    return pd.DataFrame(rows, columns=["run", "time_s", "feeling_scale"])


def observed(runs, scores, affect, mean="time_weighted", rules=RULES):
    return run_observations(runs, scores, affect, warm_up_s=600.0, mean=mean, rules=rules)


def test_answers_stand_beside_the_measures_of_their_run(runs, scores, affect):
    table = observed(runs, scores, affect)
    assert list(table) == list(RUN_OBSERVATIONS)
    assert table["run"].tolist() == NAMES
    assert table["flow"].tolist() == [70.0, 80.0, 60.0]
    np.testing.assert_array_equal(table["activity_enjoyment"], [100.0, np.nan, 90.0])
    np.testing.assert_array_equal(table["peak_head_g"], [1.0, 2.0, np.nan])


def test_the_mean_rating_runs_from_the_warm_up_to_the_end_of_what_is_known(runs, scores, affect):
    weighted = observed(runs, scores, affect)["affective_valence"]
    first = (1.0 * 300 + 3.0 * 200 + 5.0 * 100) / 600
    second = (2.0 * 100 + 4.0 * 1100) / 1200
    np.testing.assert_allclose(weighted, [first, second, np.nan], atol=1e-12)
    simple = observed(runs, scores, affect, mean="simple")["affective_valence"]
    np.testing.assert_allclose(simple, [4.0, 4.0, np.nan], atol=1e-12)


def test_the_pattern_is_that_of_the_run_or_at_12_km_h(runs, scores, affect):
    table = observed(runs, scores, affect)
    assert table["pattern"].tolist() == ["aerial", "aerial", "terrestrial"]
    np.testing.assert_allclose(table["duty_factor_at_12_km_h"], [0.25, 0.2865, 0.2835], atol=1e-12)
    at_12 = ["aerial", "intermediate", "intermediate"]
    assert table["pattern_at_12_km_h"].tolist() == at_12
    by_12 = PatternRules(0.276, 0.288, -0.033, "at_12_km_h")
    assert observed(runs, scores, affect, rules=by_12)["pattern"].tolist() == at_12


def test_windows_have_the_rating_that_holds_for_most_of_them(runs, scores, affect):
    edges = sliding_windows(600.0, 1800.0, PRINTED_WINDOWS)
    parts = [
        pd.DataFrame({key: np.arange(len(edges), dtype=float) for key in MEASURE_KEYS}).assign(
            run=name, start_s=edges[:, 0], stop_s=edges[:, 1], n_strides=40
        )
        for name in NAMES
    ]
    windows = pd.concat(parts, ignore_index=True)
    table = window_observations(windows, observed(runs, scores, affect), scores, affect)
    assert list(table) == list(WINDOW_OBSERVATIONS)
    assert len(table) == 3 * len(edges)
    rating = {name: own["affective_valence"].to_numpy() for name, own in table.groupby("run")}
    middle = edges.mean(axis=1)
    held = np.select([middle < 900, middle < 1100, middle <= 1200], [1.0, 3.0, 5.0], np.nan)
    np.testing.assert_array_equal(rating["P01_01"], held)
    np.testing.assert_array_equal(rating["P01_02"], np.where(middle < 700, 2.0, 4.0))
    assert np.isnan(rating["P02_01"]).all()
    assert table.loc[0, ["participant", "pattern"]].tolist() == ["P01", "aerial"]


def test_runs_that_are_left_out_have_no_rows(tmp_path, runs, scores, affect):
    runs.iloc[:1].to_parquet(tmp_path / "P01_01.parquet")
    runs.iloc[:0].astype(object).to_parquet(tmp_path / "P01_02.parquet")
    table = rows_of_runs(tmp_path, ["P01_01", "P01_02"])
    assert observed(table, scores, affect)["run"].tolist() == ["P01_01"]
    none = rows_of_runs(tmp_path, ["P01_02"])
    nothing = observed(none, scores, affect)
    assert list(nothing) == list(RUN_OBSERVATIONS)
    assert nothing.empty
