"""Agreement of waveforms whose offset, gain and delay are known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.studies.kinematics.agreement import AGREEMENT_COLUMNS, waveform_agreement

STRIDE, N = 140, 12
START = np.arange(0, N * STRIDE, STRIDE)
STOP = START + STRIDE
PHASE = 2 * np.pi * np.arange(N * STRIDE + 1) / STRIDE
AMPLITUDE = 30.0


def compare(difference, start=START, stop=STOP):
    optic = AMPLITUDE * np.sin(PHASE)
    return waveform_agreement(optic, optic + difference, start, stop)


@given(st.floats(-20, 20), st.floats(0.2, 2.0))
def test_offset_and_gain(offset, gain):
    """d = offset + (g − 1) A sin: every measure in closed form."""
    wave = (gain - 1.0) * AMPLITUDE * np.sin(PHASE)
    found = compare(offset + wave)
    centred = abs(gain - 1.0) * AMPLITUDE / np.sqrt(2)
    assert found["n_strides"] == N
    assert found["rom_deg"] == pytest.approx(2 * AMPLITUDE)
    assert found["bias_deg"] == pytest.approx(offset, abs=1e-9)
    assert found["mad_deg"] == pytest.approx(abs(offset), abs=1e-9)
    assert found["rmsd_trial_deg"] == pytest.approx(centred, abs=1e-9)
    assert found["rmsd_stride_deg"] == pytest.approx(centred, abs=1e-9)
    assert found["rmsd_deg"] == pytest.approx(np.hypot(offset, centred), abs=1e-9)
    assert found["r2"] == pytest.approx(1 - (gain - 1) ** 2, abs=1e-9)
    assert found["r2_squared_correlation"] == pytest.approx(1.0, abs=1e-9)
    assert found["r2_raw"] == pytest.approx(
        1 - (gain - 1) ** 2 - 2 * offset**2 / AMPLITUDE**2, abs=1e-9
    )
    # the mean curve takes all that repeats, up to its interpolation between percents
    assert found["rmsd_ensemble_deg"] < 1e-3 * AMPLITUDE
    if abs(offset) > abs(gain - 1) * AMPLITUDE:
        assert found["mad_alt_deg"] == pytest.approx(abs(offset), abs=1e-9)


@given(st.floats(0.0, np.pi))
def test_delay(delay):
    """sin(φ − δ): r = cos δ, and 1 − SSE/SST = 2 cos δ − 1."""
    found = compare(AMPLITUDE * (np.sin(PHASE - delay) - np.sin(PHASE)))
    assert found["r2_squared_correlation"] == pytest.approx(np.cos(delay) ** 2, abs=1e-9)
    assert found["r2"] == pytest.approx(2 * np.cos(delay) - 1, abs=1e-9)
    assert found["rmsd_deg"] == pytest.approx(AMPLITUDE * np.sqrt(1 - np.cos(delay)), abs=1e-6)
    assert found["bias_deg"] == pytest.approx(0.0, abs=1e-9)
    # the mean absolute value of a sine is 2/π of its amplitude
    half = 2 * AMPLITUDE * np.sin(delay / 2)
    assert found["mad_alt_deg"] == pytest.approx(2 / np.pi * half, abs=1e-2)


def test_three_kinds_of_offset():
    """One constant, one per stride and a curve: each removal takes its own kind."""
    rng = np.random.default_rng(2)
    own = np.repeat(rng.standard_normal(N), STRIDE)
    own = np.append(own - own.mean(), 0.0)
    curve = 3.0 * np.cos(3 * PHASE)
    found = compare(5.0 + own + curve)
    wave, steps = 3.0 / np.sqrt(2), own[:-1].std()
    assert found["rmsd_trial_deg"] == pytest.approx(np.hypot(wave, steps), rel=1e-6)
    assert found["rmsd_stride_deg"] == pytest.approx(wave, rel=1e-6)
    assert found["rmsd_ensemble_deg"] == pytest.approx(steps, rel=1e-3)
    assert found["rmsd_deg"] == pytest.approx(np.sqrt(25 + wave**2 + steps**2), rel=1e-6)


@given(st.integers(0, 10_000), st.floats(-30, 30))
def test_identities_that_the_printed_table_breaks(seed, offset):
    rng = np.random.default_rng(seed)
    noise = np.cumsum(rng.standard_normal(PHASE.size)) * 0.1
    found = compare(offset + noise)
    squared = found["bias_deg"] ** 2 + found["rmsd_trial_deg"] ** 2
    assert found["rmsd_deg"] ** 2 == pytest.approx(squared, rel=1e-9)
    assert found["mad_alt_deg"] >= found["mad_deg"] - 1e-12
    assert found["rmsd_deg"] >= found["mad_alt_deg"] - 1e-12
    assert found["rmsd_stride_deg"] <= found["rmsd_trial_deg"] + 1e-12
    assert found["rmsd_ensemble_deg"] <= found["rmsd_trial_deg"] * (1 + 1e-3) + 1e-3
    assert found["r2_raw"] <= found["r2"] + 1e-12
    for name in ("rmsd", "rmsd_ensemble", "rmsd_trial", "rmsd_stride"):
        expected = 100 * found[f"{name}_deg"] / found["rom_deg"]
        assert found[f"n{name}_pct"] == pytest.approx(expected)


def test_only_the_strides_that_count_are_read():
    """Samples outside of them may be anything, and strides need not be neighbours or of one length."""
    rng = np.random.default_rng(7)
    optic, erkf = rng.standard_normal((2, 600))
    start, stop = np.array([20, 200, 311]), np.array([150, 311, 420])
    inside = np.concatenate([np.arange(a, b) for a, b in zip(start, stop, strict=True)])
    found = waveform_agreement(optic, erkf, start, stop)
    d = (erkf - optic)[inside]
    assert found["rmsd_deg"] == pytest.approx(np.sqrt(np.mean(d**2)))
    assert found["mad_alt_deg"] == pytest.approx(np.mean(np.abs(d)))
    r = np.corrcoef(optic[inside], erkf[inside])[0, 1]
    assert found["r2_squared_correlation"] == pytest.approx(r**2)
    per_stride = [np.var((erkf - optic)[a:b]) * (b - a) for a, b in zip(start, stop, strict=True)]
    assert found["rmsd_stride_deg"] == pytest.approx(np.sqrt(sum(per_stride) / inside.size))
    outside = np.setdiff1d(np.arange(600), np.r_[inside, stop])
    optic[outside], erkf[outside] = np.nan, 1e6
    assert waveform_agreement(optic, erkf, start, stop) == found


def test_a_stride_with_a_missing_sample_is_left_out():
    optic = AMPLITUDE * np.sin(PHASE)
    erkf = optic + np.append(np.repeat(np.arange(N), STRIDE), 0.0)
    optic[5 * STRIDE + 3] = np.nan
    found = waveform_agreement(optic, erkf, START, STOP)
    assert found["n_strides"] == N - 1
    assert found["bias_deg"] == pytest.approx((N * (N - 1) / 2 - 5) / (N - 1))


def test_nothing_to_compare():
    empty = waveform_agreement(np.full(300, np.nan), np.zeros(300), [0, 100], [100, 200])
    assert tuple(empty) == AGREEMENT_COLUMNS
    assert empty["n_strides"] == 0
    assert np.isnan(list(empty.values())[1:]).all()


def test_a_joint_that_does_not_move_has_no_r2():
    found = waveform_agreement(np.full(300, 4.0), np.full(300, 6.0), [0, 100], [100, 200])
    assert found["rmsd_deg"] == 2.0
    assert np.isnan([found[name] for name in ("r2", "r2_raw", "nrmsd_pct")]).all()


def test_bad_input():
    with pytest.raises(RecordingError, match=r"found shapes \(10,\) and \(9,\)"):
        waveform_agreement(np.zeros(10), np.zeros(9), [0], [5])
    with pytest.raises(RecordingError, match="expected samples from 0 to 10; found 0 to 11"):
        waveform_agreement(np.zeros(10), np.zeros(10), [0], [11])
