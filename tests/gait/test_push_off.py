"""End of push-off: closed forms, invariances, and simulated runners who turn on in swing."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.gait.push_off import PUSH_OFF_END, push_off_ends
from swaystride.gait.toe_off import PITCH_MINIMUM, toe_offs

RATE_HZ = 500.0
STRIDE = 350


def pitch_rate(later, end_s=0.22, n_strides=4):
    """Falls from 0.1 s after contact to -8 rad/s at `end_s`, then to `later` at 0.3 s, and back."""
    time = (np.arange(n_strides * STRIDE) % STRIDE) / RATE_HZ
    return np.interp(time, [0.0, 0.1, end_s, 0.3, 0.5, 0.7], [0.0, 0.0, -8.0, later, 0.0, 0.0])


@settings(max_examples=30)
@given(st.floats(-0.9, 0.08), st.floats(0.18, 0.26))
def test_what_the_foot_does_in_swing_does_not_matter(share, end_s):
    """The corner is found within 15 ms (a filter of 20 Hz), the smallest rate at 0.3 s.

    `share` of the slope of push-off is that of early swing.
    """
    contacts = STRIDE * np.arange(4)
    rate = pitch_rate(-8.0 * (1.0 + share * (0.3 - end_s) / (end_s - 0.1)), end_s)
    found_s = (push_off_ends(rate, contacts, RATE_HZ, PUSH_OFF_END) - contacts[:-1]) / RATE_HZ
    assert np.allclose(found_s, end_s, atol=0.015)
    if share > 0.03:
        lowest = toe_offs(rate, abs(rate), contacts, RATE_HZ, PITCH_MINIMUM) - contacts[:-1]
        assert np.all(lowest / RATE_HZ > 0.28)


def test_size_of_the_rate_and_an_offset_do_not_matter():
    contacts = STRIDE * np.arange(4)
    once, other = (
        push_off_ends(rate, contacts, RATE_HZ, PUSH_OFF_END)
        for rate in (pitch_rate(-8.5), 2.5 * pitch_rate(-8.5) + 0.3)
    )
    assert np.allclose(once, other)


def test_no_fall_and_no_strides():
    """A rate that rises throughout, and one that falls to the end of the window."""
    contacts = [0, STRIDE, 2 * STRIDE]
    ramp = np.arange(3.0 * STRIDE)
    assert np.isnan(push_off_ends(ramp, contacts, RATE_HZ, PUSH_OFF_END)).all()
    falling = -((np.arange(3.0 * STRIDE) % STRIDE) ** 2)
    assert np.isnan(push_off_ends(falling, contacts, RATE_HZ, PUSH_OFF_END)).all()
    assert push_off_ends(ramp, [5], RATE_HZ, PUSH_OFF_END).shape == (0,)


@pytest.mark.parametrize("side", [0, 1])
def test_the_end_of_push_off_is_the_true_toe_off(running_feet, side):
    foot = running_feet[side]
    contacts = np.round(foot.rate_hz * foot.contact_s).astype(int)
    found_s = push_off_ends(foot.pitch, contacts, foot.rate_hz, PUSH_OFF_END) / foot.rate_hz
    after = np.searchsorted(foot.toe_off_s, foot.contact_s[:-1])
    late_ms = 1e3 * (found_s - foot.toe_off_s[after])
    assert np.isfinite(late_ms).all()
    assert abs(late_ms.mean()) < 8.0
    assert late_ms.std() < 5.0
