"""Ratings from the print to the files of a lab, and the truth beside them."""

import json
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from rated_runs import BETWEEN, NAMES, RUNNERS, measures, rated_runs, rating_model
from scipy.stats import t as student

from import_graph import REPOSITORY
from swaystride.errors import ConfigurationError, DesignError
from swaystride.simulate.experience_population import attainable_population
from swaystride.simulate.experience_rated_runs import as_tabled, true_run_measures
from swaystride.simulate.experience_rating_parameters import SCALES
from swaystride.simulate.experience_rating_truth import (
    AS_MEANT,
    RatingTruth,
    printed_associations,
    read_truth,
    write_answers,
    write_truth,
)
from swaystride.simulate.experience_ratings import draw_ratings
from swaystride.studies.experience import plan

KEYS = plan.MEASURE_KEYS
BY_NAME = {measure.name: measure.key for measure in plan.MEASURES}


def published(name):
    return pd.read_csv(REPOSITORY / "data" / "published" / f"{name}.csv")


@pytest.fixture(scope="module")
def printed():
    return printed_associations(published("table_5_3"), published("study5_text"), BY_NAME, ())


@pytest.fixture(scope="module")
def written(printed, tmp_path_factory):
    """A folder of answers and truth, and what was written there."""
    folder = tmp_path_factory.mktemp("raw")
    (folder / "truth").mkdir()
    runs, model = rated_runs(), rating_model()
    values = measures(KEYS).to_numpy().copy()
    values[:, 3] = 1.0  # a constant: no correlation
    population = attainable_population(values, printed, model.association)
    truth = RatingTruth(runs, KEYS, population, printed.between_scales)
    ratings = draw_ratings(
        model, runs, population.signal, population.residual, seed=7, cohort="ratings"
    )
    write_answers(folder, runs, ratings, ("paces", "fss"))
    write_truth(folder / "truth" / "population.json", truth, printed, ratings)
    return folder, truth, ratings


def test_scales_are_those_of_the_study():
    assert plan.SCALES == SCALES


def test_printed_values_are_taken_as_meant(printed):
    table = published("table_5_3").set_index(["measure", "scale"])["r"]
    for row, (name, key) in enumerate(BY_NAME.items()):
        assert KEYS[row] == key
        for column, scale in enumerate(SCALES):
            expected = AS_MEANT.get((name, scale), table[name, scale])
            assert printed.correlation[row, column] == expected
    np.testing.assert_array_equal(printed.between_scales, BETWEEN)
    assert printed.significant.sum() == published("table_5_3")["significant"].sum()


def test_the_exchanged_values_fit_their_own_effects_when_put_right(printed):
    """β/R is the standard deviation of the scale, the same in every row (register I-26)."""
    table = published("table_5_3").set_index(["measure", "scale"])
    column = table.xs("activity_enjoyment", level="scale")
    sd = (column["beta"] * column["r"]).sum() / (column["r"] ** 2).sum()
    for (name, scale), value in AS_MEANT.items():
        assert abs(table.loc[(name, scale), "r"] * sd - column.loc[name, "beta"]) > 1.0
        assert value * sd == pytest.approx(column.loc[name, "beta"], abs=0.1)


def test_p_values_give_the_runs_of_each_row(printed):
    """p follows from r and n; rows of the head and of heart rate have two runs fewer."""
    p = published("table_5_3").set_index(["measure", "scale"])["p"]
    off = []
    for name, key in BY_NAME.items():
        row = KEYS.index(key)
        for column, scale in enumerate(SCALES):
            r, n = printed.correlation[row, column], printed.n_runs[row]
            low, high = (
                2.0 * student.sf(np.sqrt(n - 2.0) * abs(x) / np.sqrt(1.0 - x**2), n - 2.0)
                for x in (abs(r) + 0.0051, max(abs(r) - 0.0051, 0.0))
            )
            off.append(not low - 0.001 <= p[name, scale] <= high + 0.001)
    assert not any(off)


def test_a_table_that_lacks_a_row_is_refused():
    table, text = published("table_5_3"), published("study5_text")
    gone = (table["measure"] == "Knee ROM") & (table["scale"] == "flow")
    with pytest.raises(ConfigurationError, match="correlation is missing; expected Knee ROM flow"):
        printed_associations(table[~gone], text, BY_NAME, ())
    with pytest.raises(ConfigurationError, match="correlation is missing; expected r_fs_fss"):
        printed_associations(table, text[text["quantity"] != "r_fs_fss"], BY_NAME, ())


def test_rows_may_be_aimed_at_with_the_opposite_sign(printed):
    args = (published("table_5_3"), published("study5_text"), BY_NAME)
    turned = printed_associations(*args, ("attenuation_shank_head",)).correlation
    at = KEYS.index("attenuation_shank_head")
    np.testing.assert_array_equal(turned[at], -printed.correlation[at])
    others = np.arange(len(KEYS)) != at
    np.testing.assert_array_equal(turned[others], printed.correlation[others])
    with pytest.raises(ConfigurationError, match=r"reversed_measures: not a measure.*found pace"):
        printed_associations(*args, ("pace",))


def test_answers_stand_where_a_lab_keeps_them(written):
    folder, _, ratings = written
    for name, runner, series in zip(NAMES, RUNNERS, ratings.affect, strict=True):
        table = pd.read_csv(folder / runner / f"{name}_affect.tsv", sep="\t")
        assert list(table) == ["time_s", "feeling_scale"]
        np.testing.assert_allclose(table["time_s"], series.time_s)
        np.testing.assert_array_equal(table["feeling_scale"], series.rating)
    answers = pd.read_csv(folder / "questionnaires.tsv", sep="\t", dtype={"run": str})
    assert list(answers) == ["participant", "run", "questionnaire", "score"]
    for at, name in enumerate(("paces", "fss")):
        own = answers[answers["questionnaire"] == name]
        assert list(own["participant"] + "_" + own["run"]) == NAMES
        np.testing.assert_array_equal(own["score"], ratings.scores[:, at])


def test_truth_comes_back_as_it_was_written(written):
    folder, truth, _ = written
    again = read_truth(folder / "truth" / "population.json")
    assert again.measures == truth.measures
    assert again.runs == truth.runs
    for name, value in vars(truth.population).items():
        np.testing.assert_allclose(getattr(again.population, name), value, equal_nan=True)
    np.testing.assert_array_equal(again.between_scales, truth.between_scales)
    assert np.isnan(again.attainable(KEYS[3], "flow"))
    assert again.attainable("peak_head_g", "flow") == truth.attainable("peak_head_g", "flow")


def test_truth_that_cannot_be_read_is_named(written, tmp_path):
    tree = json.loads((written[0] / "truth" / "population.json").read_text(encoding="utf-8"))
    del tree["residual"]
    file = tmp_path / "population.json"
    file.write_text(json.dumps(tree), encoding="utf-8")
    with pytest.raises(DesignError, match=r"population\.json: truth of the ratings cannot be read"):
        read_truth(file)


def test_true_measures_are_read_and_lost_ones_are_left_out(tmp_path):
    table = measures(KEYS)
    for name in NAMES:
        values = {"measures": dict(table.loc[name])}
        (tmp_path / f"{name}.json").write_text(json.dumps(values), encoding="utf-8")
    read = true_run_measures(tmp_path, NAMES, KEYS)
    pd.testing.assert_frame_equal(read, table)
    lost = SimpleNamespace(
        heart_rate_runs=("P02_02",),
        head_lost_runs=("P06_03",),
        head_loose_runs=("P03_01", "P99_01"),
    )
    kept = as_tabled(read, SimpleNamespace(losses=lost))
    missing = {key: set(kept.index[kept[key].isna()]) for key in KEYS}
    assert missing["heart_rate_bpm"] == {"P02_02"}
    head = {key for key in KEYS if missing[key] == {"P06_03", "P03_01"}}
    assert head == {
        "peak_head_g",
        "peak_head_g_per_kg",
        "attenuation_shank_head",
        "attenuation_pelvis_head",
    }
    assert not any(missing[key] for key in set(KEYS) - head - {"heart_rate_bpm"})
    with pytest.raises(DesignError, match=r"P99_01\.json: truth of a run is incomplete"):
        true_run_measures(tmp_path, ["P99_01"], KEYS)
