"""Ratios of root mean squares: closed form, and what must not change them."""

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.gait.segment_signals import PRINTED_FILTERS, SegmentSignals, filtered
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides
from swaystride.gait.stability_ratios import RATIO_COLUMNS, stability_ratios

SEEDS = st.integers(0, 2**32 - 1)
STRIDES = pd.DataFrame({"start_s": [0.0, 0.7, 1.4], "stop_s": [0.7, 1.4, 2.1]})


@settings(max_examples=40)
@given(SEEDS, st.floats(0.1, 100.0))
def test_squares_add_up_to_one_and_scale_does_not_matter(seed, scale):
    acc = np.random.default_rng(seed).standard_normal((3, 250))
    ratios = stability_ratios(STRIDES, acc, 100.0, remove_mean=False)
    assert np.allclose((ratios**2).sum(axis=1), 1.0)
    scaled = stability_ratios(STRIDES, scale * acc, 100.0, remove_mean=False)
    assert np.allclose(ratios, scaled)


@settings(max_examples=40)
@given(SEEDS)
def test_a_constant_does_not_matter_once_the_mean_is_removed(seed):
    """Gravity and the bias of an accelerometer are constants; raw ratios are full of gravity."""
    rng = np.random.default_rng(seed)
    acc = rng.standard_normal((3, 250))
    shifted = acc + np.array([[0.3], [9.81], [-0.2]])
    ratios, other = (
        stability_ratios(STRIDES, signal, 100.0, remove_mean=True) for signal in (acc, shifted)
    )
    assert np.allclose(ratios, other, atol=1e-7)
    raw = stability_ratios(STRIDES, shifted, 100.0, remove_mean=False)
    assert (raw["vertical_ratio"] > 0.95).all()


def test_exchanged_axes_exchange_their_ratios():
    acc = np.random.default_rng(2).standard_normal((3, 250))
    ratios = stability_ratios(STRIDES, acc, 100.0, remove_mean=True)
    turned = stability_ratios(STRIDES, acc[[2, 1, 0]], 100.0, remove_mean=True)
    assert np.allclose(ratios["ap_ratio"], turned["ml_ratio"])
    assert np.allclose(ratios["vertical_ratio"], turned["vertical_ratio"])


def test_nothing_moves_and_lost_samples():
    still = stability_ratios(STRIDES, np.ones((3, 250)), 100.0, remove_mean=True)
    assert still.isna().all(axis=None)
    acc = np.random.default_rng(2).standard_normal((3, 250))
    acc[0, 100] = np.nan
    assert stability_ratios(STRIDES, acc, 100.0, remove_mean=True).isna().any(axis=1).tolist() == [
        False,
        True,
        False,
    ]


def test_a_simulated_run_is_mostly_vertical(thirteen_imus):
    """Those of the worn sensor are those of a perfect one at its place."""
    run = thirteen_imus(14.0)
    strides = running_strides(run.events, RUNNING_STRIDES)
    pelvis = filtered(run.signals["lumbar"], run.rate_hz, PRINTED_FILTERS)
    found = stability_ratios(strides, pelvis.acc_m_s2, run.rate_hz, remove_mean=True).mean()
    perfect = SegmentSignals(run.ideal["lumbar"][:3], run.ideal["lumbar"][3:])
    perfect = filtered(perfect, run.rate_hz, PRINTED_FILTERS)
    ideal = stability_ratios(strides, perfect.acc_m_s2, run.rate_hz, remove_mean=True).mean()
    assert found.idxmax() == "vertical_ratio"
    for name in RATIO_COLUMNS:
        assert found[name] == pytest.approx(ideal[name], abs=0.01)
