"""Markers at the samples of the sensors; findings of gaps counted."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.rotations import exp_map
from swaystride.studies.kinematics.alignment_in_time import ClockRules, clock_delay_s, shifted
from swaystride.studies.kinematics.trial_import import gap_counts

RATE_HZ = 200.0
RULES = ClockRules(10.0, 2.0, 0.8, 0.0025)
LABELS = tuple("abcdefg")


@given(delay=st.floats(-0.3, 0.3), n_frames=st.integers(2, 80), n_samples=st.integers(1, 100))
def test_a_straight_way_is_shifted_exactly(delay, n_frames, n_samples):
    """Linear between frames, missing outside the film."""
    found = shifted(np.arange(float(n_frames))[None, None], delay, RATE_HZ, n_samples)[0, 0]
    at = np.arange(n_samples) - delay * RATE_HZ
    clear = (np.abs(at) > 1e-4) & (np.abs(at - (n_frames - 1)) > 1e-4)
    inside = (at > 0.0) & (at < n_frames - 1)
    np.testing.assert_array_equal(np.isfinite(found)[clear], inside[clear])
    np.testing.assert_allclose(found[inside & clear], at[inside & clear], atol=1e-5)


def test_without_a_delay_nothing_changes():
    film = np.random.default_rng(1).standard_normal((3, 3, 40))
    film[1, :, 7:9] = np.nan
    np.testing.assert_array_equal(shifted(film, 0.0, RATE_HZ, 40), film)
    longer = shifted(film, 0.0, RATE_HZ, 45)
    np.testing.assert_array_equal(longer[..., :40], film)
    assert np.isnan(longer[..., 40:]).all()
    np.testing.assert_array_equal(shifted(film, 0.0, RATE_HZ, 30), film[..., :30])


@pytest.mark.parametrize("frames", [-12, -1, 1, 20])
def test_whole_frames_are_moved_not_mixed(frames):
    film = np.random.default_rng(1).standard_normal((2, 3, 60))
    film[0, :, 30] = np.nan
    found = shifted(film, frames / RATE_HZ, RATE_HZ, 60)
    expected = np.full_like(film, np.nan)
    if frames > 0:
        expected[..., frames:] = film[..., :-frames]
    else:
        expected[..., :frames] = film[..., -frames:]
    np.testing.assert_array_equal(found, expected)


def test_a_missing_frame_is_missing_on_both_sides_of_it_and_no_further():
    film = np.arange(20.0)[None, None].repeat(2, axis=0)
    film[0, 0, 10] = np.nan
    found = shifted(film, 0.25 / RATE_HZ, RATE_HZ, 20)
    assert np.flatnonzero(np.isnan(found[0, 0])).tolist() == [0, 10, 11]
    assert np.flatnonzero(np.isnan(found[1, 0])).tolist() == [0]
    np.testing.assert_allclose(found[1, 0, 1:], np.arange(1, 20) - 0.25)


@pytest.fixture(scope="module")
def turning():
    """Seven segments that turn about axes of their own by independent slow noise."""
    rng = np.random.default_rng(4)
    time_s = np.arange(0.0, 12.0, 1.0 / RATE_HZ)
    waves = rng.uniform(0.3, 3.0, (7, 12, 1))
    phase = rng.uniform(0.0, 6.0, (7, 12, 1))
    angle = 0.25 * np.sin(2.0 * np.pi * waves * time_s + phase).sum(axis=1)
    rate = np.gradient(angle, 1.0 / RATE_HZ, axis=1)
    axis = rng.standard_normal((7, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    rotation = exp_map((angle[:, :, None] * axis[:, None]).transpose(1, 0, 2))
    return rate[:, None] * axis[:, :, None], rotation


def delayed(gyr, rotation, frames):
    """Sensors late by some frames."""
    return gyr[..., : gyr.shape[2] - frames], rotation[frames:]


@pytest.mark.parametrize("frames", [0, 3, 40, 190])
def test_a_delay_is_found_and_reported(turning, frames):
    gyr, rotation = delayed(*turning, frames)
    delay_s, findings = clock_delay_s(gyr, rotation, RATE_HZ, RULES, LABELS, "run.h5")
    assert delay_s == pytest.approx(frames / RATE_HZ, abs=5e-4)
    if not frames:
        assert findings == []
        return
    assert [finding.check for finding in findings] == ["clocks_out_of_step"]
    assert findings[0].file == "run.h5"
    assert " late; " in findings[0].found


def test_a_delay_beyond_half_of_what_is_looked_for_is_refused(turning):
    gyr, rotation = delayed(*turning, 300)
    with pytest.raises(RecordingError, match=r"out of step by too much; .* 1\.50 s or more$"):
        clock_delay_s(gyr, rotation, RATE_HZ, RULES, LABELS, "run.h5")


def test_mounting_does_not_matter(turning):
    gyr, rotation = turning
    mounted = np.einsum("jik,jkn->jin", exp_map(np.random.default_rng(5).normal(0, 1, (7, 3))), gyr)
    assert clock_delay_s(mounted, rotation, RATE_HZ, RULES, LABELS, "run.h5") == (0.0, [])


def test_exchanged_sensors_are_named(turning):
    gyr, rotation = turning
    other = gyr[[0, 2, 1, 3, 4, 5, 6]]
    with pytest.raises(RecordingError, match=r"run\.h5: b, c: .*found b moves like the left thigh"):
        clock_delay_s(other, rotation, RATE_HZ, RULES, LABELS, "run.h5")


def test_a_sensor_with_a_movement_of_its_own_is_named(turning):
    gyr, rotation = turning
    other = gyr.copy()
    other[4] = np.random.default_rng(9).standard_normal(other[4].shape)
    with pytest.raises(RecordingError, match=r"run\.h5: e: sensor and markers show different"):
        clock_delay_s(other, rotation, RATE_HZ, RULES, LABELS, "run.h5")


def gap(check, place, severity="info"):
    return Finding(check, severity, "run.c3d", place, "no gap", "3 frames")


def test_gaps_are_counted():
    other = Finding("packet_loss", "warning", "run.h5", "t = 1 s", "no gap", "4 packets")
    filled = [gap("marker_gap_filled", f"{m}, t = 1 s") for m in ("RKNE", "LTOE", "RKNE")]
    stays = [gap("marker_gap_stays", "LANK, t = 2 s", "warning")]
    found = gap_counts([filled[0], other, *stays, *filled[1:]])
    assert found[0] == other
    assert [(f.check, f.severity, f.found) for f in found[1:]] == [
        ("marker_gap_filled", "info", "3 gaps of 2 markers, 2 of them of RKNE"),
        ("marker_gap_stays", "warning", "1 gaps of 1 markers, 1 of them of LANK"),
    ]
    assert {f.file for f in found[1:]} == {"run.c3d"}


def test_without_gaps_there_is_nothing_to_count():
    assert gap_counts([]) == []
