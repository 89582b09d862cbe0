"""Heart of a runner: mean rates as printed, and electrocardiograms in which every beat is found."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.signals.heart_rate import heart_rate
from swaystride.simulate.experience_beats import (
    beat_times_s,
    electrocardiogram_v,
    mean_rate_bpm,
    mean_rate_of_beats_bpm,
)

STEADY = np.array([[60.0, 110.0], [130.0, 240.0]])


@pytest.fixture(params=[129.0, 160.0, 179.0])
def bpm(request):
    return request.param


@pytest.fixture
def beats(path_runners, bpm):
    return beat_times_s(
        path_runners.heart,
        bpm,
        duration_s=240.0,
        warm_up_s=60.0,
        steady=STEADY,
        rng=np.random.default_rng(int(bpm)),
    )


def test_means_have_the_printed_quartiles(path_runners):
    """Quartiles of 20000 runs; the number of people does not matter for the distribution."""
    z = np.random.default_rng(1).standard_normal((20000, 2))
    means = np.array([mean_rate_bpm(path_runners.heart, *pair) for pair in z.tolist()])
    np.testing.assert_allclose(
        np.quantile(means, [0.25, 0.5, 0.75]), [152.0, 160.0, 165.0], atol=0.4
    )
    assert 129.0 <= means.min() <= means.max() <= 179.0


def test_runs_of_a_person_are_alike(path_runners):
    rng = np.random.default_rng(2)
    person = np.repeat(rng.standard_normal(2000), 2)
    means = [
        mean_rate_bpm(path_runners.heart, z, own)
        for z, own in zip(person.tolist(), rng.standard_normal(4000).tolist(), strict=True)
    ]
    one, other = np.reshape(means, (-1, 2)).T
    assert np.corrcoef(one, other)[0, 1] == pytest.approx(path_runners.heart.person_share, abs=0.06)


def test_the_steady_part_has_the_drawn_mean(beats, bpm):
    assert mean_rate_of_beats_bpm(beats, STEADY) == pytest.approx(bpm, rel=0.002)
    assert np.diff(beats).min() > 0.25
    assert beats[0] < 1.0
    assert beats[-1] == pytest.approx(240.0, abs=1.0)


def test_the_rate_rises_in_the_warm_up(beats, path_runners):
    early, late = (
        mean_rate_of_beats_bpm(beats, np.array([part])) for part in ((0, 15), (200, 240))
    )
    assert late - early > 0.5 * path_runners.heart.rise_bpm


def test_every_beat_is_found_in_the_signal_of_the_strap(path_runners, beats, bpm):
    strap = path_runners.strap
    ecg = electrocardiogram_v(strap, beats, duration_s=240.0, rng=np.random.default_rng(3))
    assert len(ecg) == 240 * 130
    found = heart_rate(ecg, strap.rate_hz)
    assert found.findings == ()
    inner = beats[(beats > 0.5) & (beats < 239.5)]
    nearest = np.abs(found.peak_s[:, None] - inner).min(axis=0)
    assert nearest.max() < 0.012
    assert abs(len(found.peak_s) - len(beats)) <= 2
    assert mean_rate_of_beats_bpm(found.peak_s, STEADY) == pytest.approx(bpm, rel=0.002)


def test_a_signal_without_noise_is_a_sum_of_beats(path_runners, beats):
    quiet = replace(path_runners.strap, noise_v=0.0, wander_v=0.0, step_v=0.0, r_wave_log_sd=0.0)
    ecg = electrocardiogram_v(quiet, beats, duration_s=240.0, rng=np.random.default_rng(3))
    index = np.rint(beats * quiet.rate_hz).astype(int)
    index = index[index < len(ecg)]
    assert np.median(ecg[index]) == pytest.approx(quiet.r_wave_v, rel=0.2)
    assert np.median(np.abs(ecg)) < 0.15 * quiet.r_wave_v
