"""Ratings of runs: margins, affect over time, and what runs share."""

from dataclasses import replace

import numpy as np
import pytest
from rated_runs import BETWEEN, NAMES, RUNNERS, rated_runs, rating_model

from swaystride.errors import ConfigurationError
from swaystride.gait.rating_windows import check_ratings
from swaystride.simulate.experience_rating_parameters import (
    SCALES,
    AffectCourse,
    AssociationModel,
    ratings_from_config,
)
from swaystride.simulate.experience_ratings import RatedRuns, draw_ratings, run_scores

RUNS, MODEL = rated_runs(), rating_model()
NO_SIGNAL = np.zeros((len(NAMES), 3))


def drawn(seed, model=MODEL, runs=RUNS, signal=NO_SIGNAL, cohort="ratings"):
    return draw_ratings(model, runs, signal, BETWEEN, seed=seed, cohort=cohort)


def scores(ratings, mean="time_weighted"):
    return run_scores(ratings, RUNS, start_s=600.0, mean=mean)[list(SCALES)].to_numpy()


@pytest.fixture(scope="module")
def many():
    """100 sets of ratings of the same runs."""
    return [drawn(seed) for seed in range(100)]


def test_margins_and_correlations_of_the_scales_are_those_asked_for(many):
    values = np.stack([scores(ratings) for ratings in many]).reshape(-1, 3)
    n = len(values)
    for column, margins in zip(values.T, MODEL.margins, strict=True):
        assert column.mean() == pytest.approx(margins.mean, abs=4.0 * margins.sd / np.sqrt(n))
        assert column.std() == pytest.approx(margins.sd, rel=4.0 / np.sqrt(2.0 * n) + 0.01)
        assert column.min() >= margins.lowest
        assert column.max() <= margins.highest + 1e-12
    np.testing.assert_allclose(np.corrcoef(values.T), BETWEEN, atol=4.0 / np.sqrt(n))


def test_answers_are_whole_numbers_at_times_of_a_run(many):
    counts = []
    for ratings in many:
        assert ratings.scores.dtype.kind == "i"
        for series in ratings.affect:
            assert series.rating.dtype.kind == "i"
            check_ratings(series.time_s, series.rating, run_s=1800.0, lowest=0.0, highest=5.0)
            assert 0.0 <= series.time_s[0] <= 60.0
            assert np.all(np.diff(series.time_s) >= 20.0 - 0.1)
        whole = np.array(RUNS.known_until_s) == 1800.0
        counts += [len(ratings.affect[at].rating) for at in np.flatnonzero(whole)]
    assert (min(counts), max(counts)) == (2, 14)
    assert np.mean(counts) == pytest.approx(8.0, abs=0.3)


def test_the_mean_over_time_stays_with_what_the_run_is_worth(many):
    """Correlations of run means lose little to whole numbers at odd times."""
    worth = np.concatenate([ratings.latent[:, 0] for ratings in many])
    said = np.concatenate([scores(ratings)[:, 0] for ratings in many])
    assert np.corrcoef(worth, said)[0, 1] > 0.975
    assert abs(np.mean(said - worth)) < 0.02


def test_some_runs_keep_one_rating_and_others_change(many):
    constant = np.mean([np.ptp(series.rating) == 0 for r in many for series in r.affect])
    assert 0.1 < constant < 0.4


def test_without_changes_the_rating_is_the_nearest_whole_number():
    model = replace(MODEL, course=replace(MODEL.course, steady_share=1.0))
    ratings = drawn(3, model)
    for series, worth in zip(ratings.affect, ratings.latent[:, 0], strict=True):
        assert np.all(series.rating == np.clip(np.rint(worth), 0, 5))


def test_lost_ratings_are_not_there():
    whole = replace(RUNS, known_until_s=[1800.0] * len(NAMES))
    at = NAMES.index("P10_02")
    lost = 0
    for seed in range(5):
        kept, all_of_it = drawn(seed).affect[at], drawn(seed, runs=whole).affect[at]
        early = all_of_it.time_s <= 1500.0
        np.testing.assert_array_equal(kept.time_s, all_of_it.time_s[early])
        np.testing.assert_array_equal(kept.rating, all_of_it.rating[early])
        lost += np.sum(~early)
    assert lost > 0


def test_answers_beyond_the_ends_are_moved_there_and_counted():
    high = replace(MODEL.affective_valence, mean=5.0)
    enjoyed = replace(MODEL.activity_enjoyment, mean=126.0)
    ratings = drawn(1, replace(MODEL, affective_valence=high, activity_enjoyment=enjoyed))
    assert ratings.n_clipped[0] > 10
    assert ratings.n_clipped[1] == np.sum(np.rint(ratings.latent[:, 1]) > 126)
    assert ratings.scores[:, 0].max() == 126
    assert max(series.rating.max() for series in ratings.affect) == 5


def test_the_signal_is_added_in_standard_deviations():
    signal = np.outer(np.linspace(-1.0, 1.0, len(NAMES)), [0.5, -0.3, 0.2])
    sd = [margins.sd for margins in MODEL.margins]
    np.testing.assert_allclose(drawn(2, signal=signal).latent - drawn(2).latent, signal * sd)


def test_the_same_seed_gives_the_same_answers_whatever_other_runs_there_are():
    one, again = drawn(4), drawn(4)
    np.testing.assert_array_equal(one.latent, again.latent)
    kept = [k for k, runner in enumerate(RUNNERS) if runner != "P06"]
    fewer = RatedRuns(
        *([column[k] for k in kept] for column in (NAMES, RUNNERS, RUNS.duration_s)),
        [RUNS.known_until_s[k] for k in kept],
        RUNS.settled_s,
    )
    part = draw_ratings(MODEL, fewer, NO_SIGNAL[kept], BETWEEN, seed=4, cohort="ratings")
    np.testing.assert_array_equal(part.latent, one.latent[kept])
    np.testing.assert_array_equal(part.scores, one.scores[kept])
    for series, at in zip(part.affect, kept, strict=True):
        np.testing.assert_array_equal(series.rating, one.affect[at].rating)
    assert not np.isclose(drawn(5).latent, one.latent).any()
    assert not np.isclose(drawn(4, cohort="null").latent, one.latent).any()


@pytest.mark.parametrize("share", [0.0, 0.4])
def test_runs_of_a_runner_share_what_they_should(share):
    runners = [f"P{k:03d}" for k in range(400)]
    names = [f"{runner}_{k}" for k in (1, 2) for runner in runners]
    runs = RatedRuns(names, runners * 2, [1800.0] * 800, [1800.0] * 800, 600.0)
    model = rating_model(runner_share=share)
    latent = draw_ratings(model, runs, np.zeros((800, 3)), BETWEEN, seed=1, cohort="x").latent
    for values, sd in zip(latent.T, (0.88, 14.0, 7.8), strict=True):
        assert np.corrcoef(values[:400], values[400:])[0, 1] == pytest.approx(share, abs=0.15)
        assert values.std() == pytest.approx(sd, rel=0.1)
    np.testing.assert_allclose(np.corrcoef(latent.T), BETWEEN, atol=0.15)


def test_a_short_run_has_ratings_that_fit_into_it():
    runs = RatedRuns(["P01_01"], ["P01"], [90.0], [90.0], 600.0)
    for seed in range(20):
        ratings = draw_ratings(MODEL, runs, NO_SIGNAL[:1], BETWEEN, seed=seed, cohort="ratings")
        series = ratings.affect[0]
        check_ratings(series.time_s, series.rating, run_s=90.0, lowest=0.0, highest=5.0)


def plain(model):
    """Parameters as they stand in a configuration."""
    return {name: dict(vars(getattr(model, name))) for name in ("association", *SCALES, "course")}


def test_parameters_come_from_the_configuration():
    assert ratings_from_config(plain(MODEL)) == MODEL
    values = plain(MODEL)
    values["course"]["pace"] = 1.0
    with pytest.raises(ConfigurationError, match=r"simulation\.ratings\.course"):
        ratings_from_config(values)
    values = plain(MODEL)
    del values["flow"]
    with pytest.raises(ConfigurationError, match=r"simulation\.ratings: keys do not match"):
        ratings_from_config(values)


def test_parameters_out_of_range_are_refused():
    with pytest.raises(ConfigurationError, match="unexplained_share: not a share"):
        AssociationModel("plain", 0.0, 0.0, ())
    with pytest.raises(ConfigurationError, match="runner_share: not a share"):
        AssociationModel("plain", 0.5, 1.2, ())
    with pytest.raises(ConfigurationError, match="no number of ratings fits"):
        AffectCourse(0, 5, 60.0, 20.0, 0.1, 0.3, 0.3, 300.0)
