import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.signals.plateaus import flattened_share, restore_plateaus


def peaks(n_samples=400, size=12.0, noise=0.0):
    """Two humps and two dips."""
    rng = np.random.default_rng(2)
    signal = size * np.sin(np.linspace(0.0, 4.0 * np.pi, n_samples)) ** 3
    return (signal + noise * rng.standard_normal(n_samples))[None, :]


def test_a_clipped_parabola_is_restored_exactly():
    """Flanks as steep as the parabola at the edge: the closed form of the run."""
    t = np.arange(41.0)
    hidden = np.maximum(10.0 + 0.5 * (t - 10.0) * (1.0 - (t - 10.0) / 20.0), 0.0)
    clipped = np.where((t >= 10) & (t <= 30), 10.0, np.where(t < 10, 5 + 0.5 * t, 25 - 0.5 * t))
    restored, variance = restore_plateaus(clipped[None, :], least_level=5.0)
    assert np.allclose(restored[0, 10:31], hidden[10:31])
    assert np.array_equal(restored[0, :10], clipped[:10])
    assert np.flatnonzero(variance).tolist() == list(range(10, 30))
    assert variance.sum() == pytest.approx((0.5 * 0.5 * 20 / 6 * 20) ** 2)


@pytest.mark.parametrize("limit", [5.0, 7.0, 9.0])
@pytest.mark.parametrize("n_samples", [120, 400, 2000])
def test_much_of_what_clipping_took_is_put_back(limit, n_samples):
    hidden = peaks(n_samples)
    clipped = np.clip(hidden, -limit, limit)
    restored, variance = restore_plateaus(clipped, least_level=4.0)
    lost = np.abs(hidden - clipped).sum()
    assert np.abs(hidden - restored).sum() < 0.6 * lost
    assert flattened_share(clipped, least_level=4.0) > 0.0
    assert variance.max() > 0.0


@pytest.mark.parametrize("n_samples", [120, 400, 2000, 20000])
@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_smooth_peaks_stay_as_they_are(n_samples, noise):
    signal = peaks(n_samples, noise=noise)
    restored, variance = restore_plateaus(signal, least_level=4.0)
    assert restored is signal
    assert not variance.any()


@given(st.floats(2.0, 50.0), st.integers(1, 2))
def test_short_runs_and_flat_signals_below_the_range_are_not_clipped(level, steps):
    signal = np.zeros((1, 30))
    signal[0, 10 : 10 + steps + 1] = level
    assert not restore_plateaus(signal, least_level=1.0)[1].any()
    still = np.full((3, 30), level)
    assert not restore_plateaus(still, least_level=level + 1.0)[1].any()


def test_both_signs_and_all_channels_count():
    signal = np.zeros((2, 40))
    signal[0, 4:12] = [4.0, 8.0, 8.0, 8.0, 8.0, 8.0, 6.0, 2.0]
    signal[1, 20:27] = [-4.0, -8.0, -8.0, -8.0, -8.0, -8.0, -4.0]
    assert flattened_share(signal, least_level=4.0) == 8 / 39
    restored, _ = restore_plateaus(signal, least_level=4.0)
    assert restored[0, 5:10].min() >= 8.0
    assert restored[0].max() > 8.0
    assert restored[1].min() < -8.0
