"""Contacts of a foot whose course is known, and of the simulated runner."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.mocap.foot_events import RUNNING_CONTACT, belt_speed, foot_contacts

RATE_HZ, SPEED_M_S = 200.0, 3.5
STRIDE_S, CONTACT_S = 0.7, 0.25


@pytest.fixture(scope="module")
def foot():
    """Heel and toe on a belt: flat and still from 0 to 0.25 s of each stride, else in the air."""
    t = np.arange(round(8.0 * RATE_HZ)) / RATE_HZ
    since = (t - 0.3) % STRIDE_S
    air = np.clip((since - CONTACT_S) / (STRIDE_S - CONTACT_S), 0.0, 1.0)
    # over the ground: one stride forward in the air, at rest at both ends to some derivatives
    step = air**2 * (3.0 - 2.0 * air)
    ground = ((t - 0.3) // STRIDE_S + step) * STRIDE_S * SPEED_M_S
    height = 0.25 * np.sin(np.pi * air) ** 1.2
    places = np.stack([ground - SPEED_M_S * t, np.zeros_like(t), height], axis=1)
    heel, toe = places[None] + [-0.06, 0.0, 0.04], places[None] + [0.14, 0.0, 0.03]
    touch = 0.3 + STRIDE_S * np.arange(1, 11)
    return heel, toe, touch


def contacts(heel, toe, **changes):
    speeds = {"running_speed_m_s": SPEED_M_S, "belt_speed_m_s": SPEED_M_S} | changes
    return foot_contacts(heel, toe, rate_hz=RATE_HZ, rule=RUNNING_CONTACT, file="run.c3d", **speeds)


def test_strides_and_contacts_of_a_known_foot(foot):
    heel, toe, touch = foot
    found = contacts(heel, toe)
    begin = found["initial_contact_s"].to_numpy()
    near = begin[np.argmin(np.abs(begin[:, None] - touch), axis=0)]
    # the threshold is passed a little before rest is reached, by the same time in every stride
    assert np.abs(near - touch).max() < 0.02
    np.testing.assert_allclose(np.diff(near), STRIDE_S, atol=1e-3)
    lasted = (found["toe_off_s"] - found["initial_contact_s"]).to_numpy()
    np.testing.assert_allclose(lasted, CONTACT_S, atol=0.02)


def test_over_ground_the_belt_stands_still(foot):
    """The same foot in the frame of the belt gives the same contacts."""
    heel, toe, _ = foot
    way = SPEED_M_S * np.arange(heel.shape[1])[None, :, None] / RATE_HZ * [1.0, 0.0, 0.0]
    lab, ground = contacts(heel, toe), contacts(heel + way, toe + way, belt_speed_m_s=0.0)
    np.testing.assert_allclose(lab, ground, atol=1e-3)


def test_the_belt_is_measured_by_the_foot(foot):
    assert belt_speed(foot[1][0], RATE_HZ) == pytest.approx(SPEED_M_S, rel=1e-3)


def test_a_contact_beside_a_gap_is_left_out(foot):
    heel, toe, touch = foot
    lost = toe.copy()
    frame = round(touch[3] * RATE_HZ)
    lost[0, frame - 5 : frame + 5] = np.nan
    whole, found = contacts(heel, toe), contacts(heel, lost)
    assert len(found) == len(whole) - 1
    assert np.abs(found["initial_contact_s"] - touch[3]).min() > 0.5
    # in mid-air a gap does no harm
    lost = toe.copy()
    middle = round((touch[3] + 0.5) * RATE_HZ)
    lost[0, middle - 5 : middle + 5] = np.nan
    assert len(contacts(heel, lost)) == len(whole)


def test_a_trial_without_running(foot):
    """A foot that rides on nothing, and a belt speed that is wrong."""
    heel, toe, _ = foot
    with pytest.raises(RecordingError, match=r"run\.c3d: no contact of the foot"):
        contacts(heel, toe, belt_speed_m_s=-SPEED_M_S)
    still = np.zeros_like(heel)
    with pytest.raises(RecordingError, match="no contact of the foot"):
        contacts(still, still)
    with pytest.raises(RecordingError, match="1 slow spells, none of them whole"):
        contacts(still, still, belt_speed_m_s=0.0)


def test_a_marker_that_is_never_seen(foot):
    heel, toe, _ = foot
    with pytest.raises(RecordingError, match=r"toe, marker 1 of 1: marker missing throughout"):
        contacts(heel, np.full_like(toe, np.nan))
