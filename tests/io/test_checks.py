"""Checks that need no file."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.io import checks
from swaystride.recording import Recording, make_recording
from swaystride.units import GRAVITY_M_S2


@pytest.mark.parametrize(
    ("size", "verdict"),
    [
        (GRAVITY_M_S2, None),
        (4.1, None),
        (39.0, None),
        (1.0, "looks like g"),
        (1000.0, "looks like mg"),
        (0.05, ""),
        (300.0, ""),
    ],
)
def test_the_size_of_the_acceleration(size: float, verdict: str | None) -> None:
    acc = np.outer([0.6, 0.0, 0.8], np.full(40, size))
    findings = checks.acceleration_unit(acc, file="a.txt")
    assert [finding.severity for finding in findings] == ([] if verdict is None else ["error"])
    if verdict is not None:
        assert ("look like" in findings[0].found) == bool(verdict)
        assert verdict.replace("looks", "look") in findings[0].found


def test_a_median_ignores_missing_samples_and_needs_twenty() -> None:
    acc = np.zeros((3, 60))
    acc[2] = 1.0
    assert len(checks.acceleration_unit(acc[:, :20], file="")) == 1
    assert checks.acceleration_unit(acc[:, :19], file="") == []
    acc[0, 19:] = np.nan
    assert checks.acceleration_unit(acc, file="") == []


def test_a_runner_in_flight_most_of_the_time_is_no_wrong_unit() -> None:
    """Free fall for more than half of the samples, 2.4 times gravity in the others."""
    acc = np.zeros((3, 100))
    acc[2, :42] = GRAVITY_M_S2 / 0.42
    assert checks.acceleration_unit(acc, file="") == []
    assert len(checks.acceleration_unit(acc / GRAVITY_M_S2, file="")) == 1


def test_the_size_of_the_angular_rate() -> None:
    gyr = np.outer([0.0, 1.0, 0.0], np.full(40, 34.0))
    assert checks.angular_rate_unit(gyr, file="") == []
    assert [f.severity for f in checks.angular_rate_unit(gyr + 2.0, file="")] == ["error"]


def test_nan_runs_are_counted_once_per_sample() -> None:
    values = np.zeros((3, 10))
    values[0, 0] = values[1, 0] = values[2, 4:6] = values[0, 5:9] = np.nan
    (finding,) = checks.nan_run(
        values, np.arange(10), 10.0, file="a.txt", first_line=5, signal="gyr"
    )
    assert finding.place == "gyr, first at t = 0.000 s, line 5"
    assert finding.found == (
        "6 of 10 samples without a number in 2 runs, the longest 5 samples (0.500 s)"
    )


def recording(rate: float = 100.0, n: int = 40, first: int | None = None) -> Recording:
    made = make_recording(
        rate_hz=rate,
        rate_source="header",
        sensors=["lumbar"],
        acc_m_s2=np.zeros((1, 3, n)),
        source_file=f"{rate:g}_{n}_{first}.txt",
    )
    return made if first is None else made.assign_attrs(first_packet=first)


def test_files_of_one_trial_agree() -> None:
    assert checks.check_same_trial([]) == []
    assert checks.check_same_trial([recording()]) == []
    assert checks.check_same_trial([recording(), recording(100.05), recording(first=7)]) == []


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        (
            recording(128.0, first=7),
            Finding(
                "same_trial_rate",
                "error",
                "128_40_7.txt",
                "beside 100_40_7.txt",
                "100 Hz",
                "128 Hz",
            ),
        ),
        (
            recording(n=39, first=7),
            Finding(
                "same_trial_length",
                "error",
                "100_39_7.txt",
                "beside 100_40_7.txt",
                "40 samples",
                "39 samples",
            ),
        ),
        (
            recording(first=9),
            Finding(
                "same_trial_start",
                "warning",
                "100_40_9.txt",
                "beside 100_40_7.txt",
                "packet 7",
                "packet 9",
            ),
        ),
    ],
)
def test_files_of_one_trial_disagree(other: Recording, expected: Finding) -> None:
    assert checks.check_same_trial([recording(first=7), other]) == [expected]


def test_only_errors_stop() -> None:
    warning = Finding("packet_loss", "warning", "a.txt", "line 3", "none", "4")
    error = Finding("nan_run", "error", "a.txt", "line 4", "a number", "none")
    assert checks.stop_on_error([warning]) == [warning]
    with pytest.raises(RecordingError) as caught:
        checks.stop_on_error([warning, error])
    assert str(caught.value) == "a.txt: line 4: nan run; expected a number; found none"
