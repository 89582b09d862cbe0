"""Toe-off of a simulated runner with known events, and of rates in closed form."""

import numpy as np
import pytest
from closed_form_run import STILL, STRIDE, TOE_OFF, foot_signals

from swaystride.errors import RecordingError
from swaystride.gait.initial_contact import RUNNING_IMPACT, initial_contacts
from swaystride.gait.toe_off import PITCH_MINIMUM, RESULTANT_MINIMUM, toe_offs


def lateness_ms(foot, rule):
    gyr = np.linalg.norm(foot.gyr, axis=0)
    contacts = initial_contacts(foot.acc, gyr, foot.rate_hz, RUNNING_IMPACT)
    found_s = toe_offs(foot.pitch, gyr, contacts, foot.rate_hz, rule) / foot.rate_hz
    # the true toe-off after each contact
    after = np.searchsorted(foot.toe_off_s, contacts[:-1] / foot.rate_hz)
    return 1e3 * (found_s - foot.toe_off_s[after])


@pytest.mark.parametrize("side", [0, 1])
def test_the_pitch_minimum_is_the_true_toe_off(running_feet, side):
    late = lateness_ms(running_feet[side], PITCH_MINIMUM)
    assert np.isfinite(late).all()
    assert 0.0 < np.median(late) < 8.0
    assert late.std() < 10.0


def test_the_literal_rule_is_mid_stance(running_feet):
    for foot in running_feet:
        late = lateness_ms(foot, RESULTANT_MINIMUM)
        after = np.searchsorted(foot.toe_off_s, foot.contact_s[:-1])
        contact_ms = 1e3 * np.median(foot.toe_off_s[after] - foot.contact_s[:-1])
        assert -0.8 * contact_ms < np.median(late) < -0.4 * contact_ms


def test_closed_form():
    phase = np.arange(1200) / STRIDE
    _, gyr, pitch = foot_signals(phase)
    contacts = np.arange(0, 1200, STRIDE)
    found = toe_offs(pitch, gyr, contacts, 200.0, PITCH_MINIMUM)
    assert np.allclose(found, contacts[:-1] + TOE_OFF * STRIDE, atol=0.05)
    literal = toe_offs(pitch, gyr, contacts, 200.0, RESULTANT_MINIMUM)
    assert np.allclose(literal, contacts[:-1] + STILL * STRIDE, atol=0.05)


def test_an_instant_between_two_samples():
    """A parabola through three samples: the error of a smooth rate is far below a sample."""
    phase = (np.arange(1200) - 0.37) / STRIDE
    _, gyr, pitch = foot_signals(phase)
    found = toe_offs(pitch, gyr, np.arange(1, 1200, STRIDE), 200.0, PITCH_MINIMUM)
    assert np.allclose((found - 0.37) % STRIDE, TOE_OFF * STRIDE, atol=0.05)


def test_a_window_without_an_interior_minimum_gives_none():
    """A rate that falls throughout the window has its least value at the edge: no toe-off."""
    phase = (np.arange(700) / STRIDE) % 1.0
    falling = -10.0 * np.clip(phase, 0.0, 0.6)
    found = toe_offs(falling, abs(falling), [0, STRIDE, 2 * STRIDE], 200.0, PITCH_MINIMUM)
    assert np.isnan(found).all()
    assert found.shape == (2,)


def test_a_deeper_edge_does_not_hide_the_interior_minimum():
    phase = (np.arange(700) / STRIDE) % 1.0
    pitch = -8.0 * np.exp(-(((phase - 0.3) / 0.04) ** 2)) - 100.0 * np.clip(phase - 0.36, 0.0, 0.3)
    assert pitch[int(0.45 * STRIDE)] < -8.0
    found = toe_offs(pitch, abs(pitch), [0, STRIDE], 200.0, PITCH_MINIMUM)
    assert found == pytest.approx([0.3 * STRIDE], abs=1.0)


def test_contacts_that_do_not_fit():
    rate = np.zeros(100)
    with pytest.raises(RecordingError, match=r"rising samples from 0 to 99; found 10 to 120"):
        toe_offs(rate, rate, [10, 60, 120], 200.0, PITCH_MINIMUM)
    with pytest.raises(RecordingError, match="found a fall"):
        toe_offs(rate, rate, [10, 60, 50], 200.0, PITCH_MINIMUM)
    assert toe_offs(rate, rate, [10], 200.0, PITCH_MINIMUM).shape == (0,)
