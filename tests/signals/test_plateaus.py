import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from swaystride.signals.plateaus import flattened_share, plateau_variance


def test_a_clipped_run_has_the_variance_of_its_whole_excess():
    """Over the run of L steps the integral of the excess has the SD share · level · L."""
    signal = np.concatenate([np.zeros(5), np.full(7, 10.0), np.zeros(5)])[None, :]
    variance = plateau_variance(signal, least_level=5.0, excess_share=0.1)
    assert np.flatnonzero(variance).tolist() == list(range(5, 11))
    assert np.isclose(variance.sum(), (0.1 * 10.0 * 6) ** 2)


@given(st.floats(2.0, 50.0), st.integers(1, 2))
def test_short_runs_and_flat_signals_below_the_range_are_not_clipped(level, steps):
    signal = np.zeros((1, 30))
    signal[0, 10 : 10 + steps + 1] = level
    assert not plateau_variance(signal, least_level=1.0, excess_share=0.1).any()
    still = np.full((3, 30), level)
    assert not plateau_variance(still, least_level=level + 1.0, excess_share=0.1).any()


def test_both_signs_and_all_channels_count():
    signal = np.zeros((2, 40))
    signal[0, 5:10] = 8.0
    signal[1, 20:25] = -8.0
    assert flattened_share(signal, least_level=4.0) == 8 / 39
