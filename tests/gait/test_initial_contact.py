"""Impacts of a simulated runner with known contacts, of feet in closed form, and of feet that do not run."""

from dataclasses import replace

import numpy as np
import pytest
from closed_form_run import STRIDE, foot_signals
from closed_form_walk import walk

from swaystride.errors import RecordingError
from swaystride.gait.initial_contact import RUNNING_IMPACT, expected_stride_s, initial_contacts

HIGHEST = replace(RUNNING_IMPACT, peak="highest")


def lateness_ms(foot, rule):
    found = initial_contacts(foot.acc, np.linalg.norm(foot.gyr, axis=0), foot.rate_hz, rule)
    at_s = found / foot.rate_hz
    nearest = np.argmin(np.abs(at_s[:, None] - foot.contact_s), axis=1)
    assert np.array_equal(nearest, np.arange(nearest[0], nearest[0] + len(nearest)))
    return 1e3 * (at_s - foot.contact_s[nearest])


@pytest.mark.parametrize("side", [0, 1])
def test_impacts_follow_the_true_contacts_by_a_constant_time(running_feet, side):
    foot = running_feet[side]
    late = lateness_ms(foot, RUNNING_IMPACT)
    assert len(late) >= len(foot.contact_s) - 2
    assert 8.0 < late.mean() < 16.0
    assert late.std() < 2.5
    assert np.ptp(late) < 12.0


def test_the_highest_peak_may_be_the_end_of_the_swing(running_feet):
    """Why the sharpest one is taken: the highest jumps by more than 30 ms from stride to stride."""
    late = np.concatenate([lateness_ms(foot, HIGHEST) for foot in running_feet])
    assert late.min() < -20.0
    assert late.max() > 5.0


@pytest.mark.parametrize("rate_hz", [100.0, 200.0, 500.0, 1000.0])
@pytest.mark.parametrize("rule", [RUNNING_IMPACT, HIGHEST])
def test_contacts_in_closed_form_at_any_rate(rate_hz, rule):
    phase = (np.arange(round(12.0 * rate_hz)) / rate_hz - 0.3) / 0.7
    acc, gyr, _ = foot_signals(phase)
    found = initial_contacts(acc, gyr, rate_hz, rule)
    at = found / rate_hz
    assert np.allclose(at, 0.3 + 0.7 * np.arange(len(at)), atol=0.51 / rate_hz)
    assert len(at) == 17


def test_a_larger_peak_of_the_push_off_is_no_contact():
    """No stance follows it."""
    phase = np.arange(2400) / STRIDE
    acc, gyr, _ = foot_signals(phase)
    usual = initial_contacts(acc, gyr, 200.0, RUNNING_IMPACT)
    kick = 300.0 * np.exp(-(((phase % 1.0 - 0.42) / 0.012) ** 2))
    assert np.array_equal(initial_contacts(acc + kick, gyr, 200.0, RUNNING_IMPACT), usual)


def test_a_soft_impact_is_left_out_and_no_other_peak_put_in():
    phase = np.arange(2800) / STRIDE
    acc, gyr, _ = foot_signals(phase)
    usual = initial_contacts(acc, gyr, 200.0, RUNNING_IMPACT)
    acc[np.abs(phase - 8.0) < 0.3] = 3.0
    found = initial_contacts(acc, gyr, 200.0, RUNNING_IMPACT)
    assert set(usual) - set(found) == {8 * STRIDE}
    assert set(found) <= set(usual)


def test_stride_time_from_the_rate_of_the_foot(running_feet):
    for foot in running_feet:
        stride_s = expected_stride_s(np.linalg.norm(foot.gyr, axis=0), 200.0, RUNNING_IMPACT)
        assert stride_s == pytest.approx(np.median(np.diff(foot.contact_s)), abs=0.02)


def standing():
    rng = np.random.default_rng(3)
    return 9.81 + 0.02 * rng.standard_normal(4000), np.abs(0.02 * rng.standard_normal(4000))


def walking():
    """One step per second of each foot: strides of 2 s."""
    own = walk(n_strides=15, stride_s=2.0, stance_s=1.2, rest_s=0.5)
    return np.linalg.norm(own.acc, axis=0), np.linalg.norm(own.gyr, axis=0)


def noise():
    rng = np.random.default_rng(4)
    return tuple(np.linalg.norm(s * rng.standard_normal((3, 6000)), axis=0) for s in (30.0, 5.0))


@pytest.mark.parametrize(
    ("signals", "found"),
    [
        (standing, "one rhythm in 0 of 17 windows of 4 s"),
        (walking, "one rhythm in|strides of"),
        (noise, "one rhythm in"),
        (lambda: (np.ones(400), np.ones(400)), "a recording of 2.0 s, too short for a rhythm"),
    ],
)
def test_a_foot_that_does_not_run_is_one_readable_error(signals, found):
    with pytest.raises(RecordingError) as error:
        initial_contacts(*signals(), 200.0, RUNNING_IMPACT, place="left foot")
    line = str(error.value)
    assert line.startswith(
        "left foot: this foot does not run; expected strides of 0.4 to 1 s; found"
    )
    assert any(part in line for part in found.split("|"))


def test_a_rhythm_without_impacts():
    _, gyr, _ = foot_signals(np.arange(2000) / STRIDE)
    with pytest.raises(
        RecordingError, match=r"peaks of the acceleration .* every 0\.70 s; found 0"
    ):
        initial_contacts(np.full(2000, 9.81), gyr, 200.0, RUNNING_IMPACT)


@pytest.mark.parametrize("missing", ["acceleration", "angular rate"])
def test_missing_samples_are_named(missing):
    acc, gyr, _ = foot_signals(np.arange(2000) / STRIDE)
    (acc if missing == "acceleration" else gyr)[700:710] = np.nan
    with pytest.raises(RecordingError, match=f"expected the {missing} .* 10 of 2000 missing"):
        initial_contacts(acc, gyr, 200.0, RUNNING_IMPACT)
