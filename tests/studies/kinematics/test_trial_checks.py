"""Checks of single recordings of a trial, on made signals."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.marker_recording import make_marker_recording
from swaystride.recording import make_recording
from swaystride.studies.kinematics.trial_checks import (
    UnusableTrialError,
    require_overlap,
    require_same_rate,
    require_standing,
    without_frozen,
)


def sensors(n=1000, rate_hz=200.0, gyr_sd_rad_s=0.02, start_s=0.0):
    rng = np.random.default_rng(3)
    made = make_recording(
        rate_hz=rate_hz,
        rate_source="simulation",
        sensors=("pelvis", "left_shank"),
        acc_m_s2=rng.standard_normal((2, 3, n)),
        gyr_rad_s=gyr_sd_rad_s * rng.standard_normal((2, 3, n)),
    )
    made.attrs["start_s"] = start_s
    return made


def film(n, rate_hz=200.0):
    return make_marker_recording(
        np.zeros((1, 3, n)), markers=("RKNE",), rate_hz=rate_hz, rate_source="simulation"
    )


def test_noise_is_not_frozen():
    recording = sensors()
    same, findings = without_frozen(recording, 0.02, "run.h5")
    assert findings == []
    np.testing.assert_array_equal(same["acc"].values, recording["acc"].values)


@pytest.mark.parametrize(("n", "taken"), [(3, False), (4, False), (5, True), (400, True)])
def test_repeated_samples_are_taken_out_if_they_last(n, taken):
    recording = sensors()
    for signal in ("acc", "gyr"):
        recording[signal].values[1, :, 101 : 101 + n] = recording[signal].values[1, :, [100]].T
    before = recording.copy(deep=True)
    out, findings = without_frozen(recording, 0.02, "run.h5")
    missing = np.isnan(out["gyr"].values)
    assert missing[1, :, 101 : 101 + n].all() == taken
    assert missing.sum() == 3 * n * taken
    assert [finding.place for finding in findings] == ["left shank, first at t = 0.500 s"] * taken
    np.testing.assert_array_equal(recording["gyr"].values, before["gyr"].values)


def test_one_channel_at_its_range_is_no_stop():
    recording = sensors()
    recording["acc"].values[0, 2, 200:300] = 16.0
    assert without_frozen(recording, 0.02, "run.h5")[1] == []


def test_missing_samples_are_not_frozen():
    recording = sensors()
    for signal in ("acc", "gyr"):
        recording[signal].values[0, :, 200:300] = np.nan
    assert without_frozen(recording, 0.02, "run.h5")[1] == []


def test_standing_sways_and_does_not_turn():
    require_standing(sensors(), "stand.h5")
    with pytest.raises(RecordingError, match=r"stand\.h5: .*: the static trial is not quiet"):
        require_standing(sensors(gyr_sd_rad_s=1.0), "stand.h5")


def test_rates_agree_within_a_thousandth():
    files = {"running_imu": "run.h5", "running_markers": "run.c3d"}
    require_same_rate(sensors(rate_hz=200.1), film(10), files)
    with pytest.raises(
        RecordingError, match=r"run\.c3d: .*expected 128 Hz as in run\.h5; found 200"
    ):
        require_same_rate(sensors(rate_hz=128.0), film(10), files)


def test_a_film_that_ends_early_is_told():
    assert require_overlap(sensors(), film(1000), 2.0, "run.c3d") == []
    assert require_overlap(sensors(), film(2000), 2.0, "run.c3d") == []
    assert require_overlap(sensors(), film(801), 2.0, "run.c3d") == []
    (told,) = require_overlap(sensors(), film(600), 2.0, "run.c3d")
    assert (told.check, told.file) == ("markers_end_early", "run.c3d")
    assert told.found == "markers end at 3.00 s; later strides have none"


@pytest.mark.parametrize(("start_s", "n", "found"), [(0.0, 300, "1.50"), (3.0, 900, "1.50"), (9.0, 900, "0.00")])  # fmt: skip
def test_too_little_film_leaves_the_trial_out(start_s, n, found):
    with pytest.raises(UnusableTrialError, match=rf"run\.c3d: too little .*found {found} s"):
        require_overlap(sensors(start_s=start_s), film(n), 2.0, "run.c3d")
