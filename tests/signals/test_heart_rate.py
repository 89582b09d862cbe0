"""Heart rate on beats whose times are known."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.signals.heart_rate import RECOMMENDED, heart_rate


def beats(
    times_s: np.ndarray, duration_s: float, rate_hz: float, noise: float, seed: int
) -> np.ndarray:
    """QRS complexes and T waves at given times, baseline wander and noise."""
    time = np.arange(int(duration_s * rate_hz)) / rate_hz
    ecg = 0.3 * np.sin(2 * np.pi * 0.25 * time)
    for at in times_s:
        near = np.abs(time - at) < 0.6
        lag = time[near] - at
        ecg[near] += np.exp(-((lag / 0.018) ** 2)) - 0.3 * np.exp(-(((lag - 0.04) / 0.018) ** 2))
        ecg[near] += 0.2 * np.exp(-(((lag - 0.25) / 0.05) ** 2))
    return ecg + np.random.default_rng(seed).normal(0, noise, len(time))


@settings(max_examples=25, deadline=None)
@given(
    mean_rr_s=st.floats(0.35, 1.3),
    variation=st.floats(0, 0.05),
    rate_hz=st.sampled_from([125.0, 130.16, 250.0]),
    seed=st.integers(0, 2**32 - 1),
)
def test_every_beat_is_found_at_its_time(
    mean_rr_s: float, variation: float, rate_hz: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    times = 0.4 + np.cumsum(mean_rr_s * (1 + variation * rng.uniform(-1, 1, 40)))
    found = heart_rate(beats(times, times[-1] + 0.6, rate_hz, 0.01, seed), rate_hz)
    apart = np.abs(found.peak_s[:, None] - times)
    assert abs(len(found.peak_s) - len(times)) <= 1
    assert (apart.min(axis=0) < 1.5 / rate_hz).mean() >= 0.9
    assert np.median(apart.min(axis=1)) < 0.75 / rate_hz
    assert found.mean_bpm == pytest.approx(60 / np.diff(times).mean(), rel=1e-2)


def test_ectopic_beats_count() -> None:
    rr = np.tile([0.8, 0.8, 0.5, 1.1], 20)
    times = 1.0 + np.cumsum(rr)
    found = heart_rate(beats(times, times[-1] + 1, 130.0, 0.01, 1), 130.0)
    assert found.mean_bpm == pytest.approx(75.0, rel=1.5e-2)
    assert len(found.rr_s) >= len(rr) - 2
    assert (found.rr_s < 0.6).sum() >= 19


def test_no_interval_spans_a_drop_out() -> None:
    times = np.arange(0.5, 60.0, 0.8)
    ecg = beats(times, 60.0, 130.0, 0.01, 2)
    ecg[int(20.0 * 130) : int(20.9 * 130)] = np.nan
    found = heart_rate(ecg, 130.0)
    assert found.mean_bpm == pytest.approx(75.0, rel=1e-3)
    assert found.rr_s.max() < 0.83
    assert found.coverage == pytest.approx((len(times) - 1 - 2) * 0.8 / 60, abs=0.03)
    bridged = ecg.copy()
    bridged[3000] = np.nan
    np.testing.assert_array_equal(heart_rate(bridged, 130.0).rr_s, found.rr_s)


def test_a_short_stretch_is_not_used_and_said() -> None:
    ecg = beats(np.arange(0.5, 60.0, 0.8), 60.0, 130.0, 0.01, 3)
    ecg[390:520] = np.nan
    (finding,) = heart_rate(ecg, 130.0, file="run.csv").findings
    assert (finding.check, finding.file) == ("ecg_short_stretch", "run.csv")
    assert finding.found == "1 shorter stretches, 3.0 s in all, not used"


def test_what_cannot_be_an_interval_is_left_out_and_said() -> None:
    times = np.delete(np.arange(0.5, 60.0, 0.8), [30, 31, 32])
    ecg = beats(times, 60.0, 130.0, 0.01, 4)
    found = heart_rate(ecg, 130.0)
    assert found.mean_bpm == pytest.approx(75.0, rel=1e-3)
    assert [finding.check for finding in found.findings] == ["long_rr_interval"]
    strict = heart_rate(ecg, 130.0, method=replace(RECOMMENDED, shortest_rr_s=1.0))
    assert "early_r_peak" in [finding.check for finding in strict.findings]
    assert np.diff(strict.peak_s).min() >= 1.0


def test_low_coverage_is_said() -> None:
    ecg = beats(np.arange(0.5, 30.0, 0.8), 60.0, 130.0, 0.001, 5)
    ecg[(31 * 130) :] = np.nan
    checks = [finding.check for finding in heart_rate(ecg, 130.0).findings]
    assert "ecg_coverage" in checks


def test_signals_without_beats() -> None:
    with pytest.raises(RecordingError) as caught:
        heart_rate(np.zeros(1300), 130.0, file="run.csv")
    assert str(caught.value) == (
        "run.csv: no heart beats; expected two R-peaks within 2 s; found 0 R-peaks in 10.0 s"
    )
    with pytest.raises(RecordingError, match="no heart beats"):
        heart_rate(np.full(1300, np.nan), 130.0)
    with pytest.raises(RecordingError, match="the sampling rate is too low for R-peaks"):
        heart_rate(np.zeros(1300), 50.0)


def test_the_unit_does_not_matter() -> None:
    ecg = beats(np.arange(0.5, 30.0, 0.7), 30.0, 130.0, 0.02, 6)
    np.testing.assert_array_equal(
        heart_rate(ecg, 130.0).peak_s, heart_rate(ecg * 1e-3, 130.0).peak_s
    )
