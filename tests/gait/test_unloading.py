"""End of unloading: closed forms, invariances, simulated runners."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.gait.unloading import UNLOADED, unloading_ends
from swaystride.rotations import exp_map
from swaystride.units import GRAVITY_M_S2

RATE_HZ = 500.0
STRIDE = 350
CONTACTS = STRIDE * np.arange(5)


def pelvis(contact_s, n_strides=5, in_flight_g=0.0):
    """A half sine per step whose mean is gravity, and what swinging legs do in flight."""
    step_s = STRIDE / RATE_HZ / 2.0
    time = (np.arange(n_strides * STRIDE) / RATE_HZ) % step_s
    top = np.pi / 2.0 * step_s / contact_s
    push = np.where(time < contact_s, top * np.sin(np.pi * time / contact_s), in_flight_g)
    return GRAVITY_M_S2 * np.stack([0 * push, push, 0 * push])


@settings(max_examples=30)
@given(st.floats(0.15, 0.26))
def test_the_end_of_a_half_sine_is_found(contact_s):
    found_s = (unloading_ends(pelvis(contact_s), CONTACTS, RATE_HZ, UNLOADED) - CONTACTS[:-1]) / 500
    assert found_s == pytest.approx(contact_s, abs=0.006)


@settings(max_examples=20)
@given(st.floats(-0.4, 0.1))
def test_what_happens_in_flight_hardly_matters(in_flight_g):
    acc = pelvis(0.2, in_flight_g=in_flight_g)
    found_s = (unloading_ends(acc, CONTACTS, RATE_HZ, UNLOADED) - CONTACTS[:-1]) / RATE_HZ
    assert found_s == pytest.approx(0.2, abs=0.013)


def test_axes_of_the_sensor_do_not_matter():
    acc = pelvis(0.2)
    turned = exp_map(np.array([0.4, -1.0, 0.7])) @ acc
    assert unloading_ends(turned, CONTACTS, RATE_HZ, UNLOADED) == pytest.approx(
        unloading_ends(acc, CONTACTS, RATE_HZ, UNLOADED), abs=1e-6
    )


def test_who_never_flies_has_no_toe_off():
    walking = pelvis(0.2)
    walking[1] = GRAVITY_M_S2 * (1.0 + 0.3 * np.sin(2 * np.pi * np.arange(walking.shape[1]) / 175))
    assert np.isnan(unloading_ends(walking, CONTACTS, RATE_HZ, UNLOADED)).all()
    assert unloading_ends(walking, [5], RATE_HZ, UNLOADED).shape == (0,)


@pytest.mark.parametrize("speed_km_h", [9.0, 12.0, 16.0])
def test_simulated_runners_leave_the_ground_then(thirteen_imus, speed_km_h):
    """Their flight is free fall by construction: a check of the code, not of the idea."""
    run = thirteen_imus(speed_km_h)
    acc = run.signals["lumbar"].acc_m_s2
    for side in ("right", "left"):
        own = run.events[run.events["side"] == side].dropna()
        contacts = np.rint(RATE_HZ * own["initial_contact_s"].to_numpy()).astype(int)
        found_s = unloading_ends(acc, contacts, RATE_HZ, UNLOADED) / RATE_HZ
        late_ms = 1e3 * (found_s - own["toe_off_s"].to_numpy()[:-1])
        assert abs(late_ms.mean()) < 5.0
        assert late_ms.std() < 3.0
