import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from swaystride.errors import RecordingError
from swaystride.gait.gyroscopic_energy import (
    CENTRED_ENERGY,
    PRINTED_ENERGY,
    energy_zero_velocity,
    gyroscopic_energy,
)
from swaystride.gait.initial_contact import RUNNING_IMPACT, initial_contacts

STRIDE = 140


@given(hnp.arrays(float, (3, 30), elements=st.floats(-30, 30)))
def test_energy_is_the_sum_over_the_window(gyr):
    """Five samples at 200 Hz, from the labelled one on or around it."""
    squared = np.sum(gyr**2, axis=0)
    forward = [squared[k : k + 5].sum() for k in range(30)]
    centred = [squared[max(k - 2, 0) : k + 3].sum() for k in range(30)]
    assert np.allclose(gyroscopic_energy(gyr, 200.0, 0.02, "start"), forward, atol=1e-8)
    assert np.allclose(gyroscopic_energy(gyr, 200.0, 0.02, "centre"), centred, atol=1e-8)
    size = np.linalg.norm(gyr, axis=0)
    assert np.allclose(gyroscopic_energy(size, 200.0, 0.02, "start"), forward, atol=1e-8)


def run(n_strides, seed=None, rate_hz=200.0):
    """Rate of a foot that is stillest at 0.15 of a stride, and nearly as still at 0.7."""
    stride = round(0.7 * rate_hz)
    phase = (np.arange((n_strides + 1) * stride) / stride) % 1.0
    gyr = 8.0 * np.sin(np.pi * (phase - 0.15)) ** 2 * np.abs(np.cos(np.pi * (phase - 0.2)))
    if seed is not None:
        gyr = gyr + 0.3 * np.random.default_rng(seed).random(gyr.size)
    return gyr, np.arange(0, n_strides * stride, stride)


@pytest.mark.parametrize("n_strides", [2, 7, 60])
@pytest.mark.parametrize(("rate_hz", "each"), [(200.0, 5.0), (500.0, 12.5), (128.0, 3.2)])
def test_the_average_time_per_stride_is_met_exactly(n_strides, rate_hz, each):
    gyr, contacts = run(n_strides, seed=n_strides, rate_hz=rate_hz)
    found = energy_zero_velocity(gyr, rate_hz, contacts, CENTRED_ENERGY)
    assert found.flags.sum() == np.ceil(each * n_strides - 1e-9) + found.n_fallback
    energy = gyroscopic_energy(gyr, rate_hz, 0.02, "centre")
    below = found.flags & (energy < found.threshold_rad2_s2)
    assert below.sum() == np.ceil(each * n_strides - 1e-9)


def test_only_stances_are_candidates_and_each_has_a_still_sample():
    gyr, contacts = run(30, seed=1)
    gyr += 0.5 * (np.arange(gyr.size) // STRIDE % 3)
    swing = np.arange(gyr.size) % STRIDE > 0.6 * STRIDE
    gyr[swing] = 0.0
    found = energy_zero_velocity(gyr, 200.0, contacts, CENTRED_ENERGY)
    still = np.flatnonzero(found.flags)
    assert (still % STRIDE < 0.35 * STRIDE).all()
    assert set(still // STRIDE) == set(range(30))
    # two thirds of the stances turn faster than the threshold throughout
    assert found.n_fallback == 20
    own = np.bincount(still // STRIDE)
    assert np.sort(own)[:20].tolist() == [1] * 20
    energy = gyroscopic_energy(gyr, 200.0, 0.02, "centre")
    alone = [k for k in still if own[k // STRIDE] == 1]
    for k in alone:
        begin = k // STRIDE * STRIDE
        assert energy[k] == energy[begin : begin + 49].min()


def test_the_printed_window_leads_by_half_its_length():
    gyr, contacts = run(20)
    centred, printed = (
        np.flatnonzero(energy_zero_velocity(gyr, 200.0, contacts, rule).flags)
        for rule in (CENTRED_ENERGY, PRINTED_ENERGY)
    )
    assert np.array_equal(printed, centred - 2)
    assert centred[:5].tolist() == [19, 20, 21, 22, 23]


def test_a_missed_contact_does_not_stretch_the_stance():
    gyr, contacts = run(10, seed=2)
    found = energy_zero_velocity(gyr, 200.0, np.delete(contacts, 5), CENTRED_ENERGY)
    assert (np.flatnonzero(found.flags) % STRIDE < 0.35 * STRIDE).all()
    assert not found.flags[contacts[5] : contacts[6]].any()


def test_a_stance_that_the_recording_cuts_has_no_still_sample():
    gyr, contacts = run(6, seed=3)
    cut = gyr[: contacts[5] + 20]
    found = energy_zero_velocity(cut, 200.0, contacts, CENTRED_ENERGY)
    assert not found.flags[contacts[5] :].any()
    assert found.flags.sum() == 25 + found.n_fallback


def test_a_simulated_foot_is_still_in_the_middle_of_its_true_stances(running_feet):
    for foot in running_feet:
        size = np.linalg.norm(foot.gyr, axis=0)
        contacts = initial_contacts(foot.acc, size, 200.0, RUNNING_IMPACT)
        found = energy_zero_velocity(foot.gyr, 200.0, contacts, CENTRED_ENERGY)
        at_s = np.flatnonzero(found.flags) / 200.0
        stance = np.searchsorted(foot.contact_s, at_s) - 1
        lasted = (
            (foot.toe_off_s[foot.toe_off_s > foot.contact_s[0]])[stance] - foot.contact_s[stance]
        )
        share = (at_s - foot.contact_s[stance]) / lasted
        assert share.min() > 0.2
        assert share.max() < 0.6
        assert len(np.unique(stance)) == len(contacts)


@pytest.mark.parametrize("contacts", [[], [5], [50, 20]])
def test_without_strides_there_is_no_threshold(contacts):
    with pytest.raises(RecordingError, match="two rising contacts or more"):
        energy_zero_velocity(np.ones(100), 200.0, contacts, CENTRED_ENERGY)
