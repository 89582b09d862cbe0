"""Events of simulated runners against the truth, invariances, and sensors that are wrong."""

from dataclasses import replace

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.gait.running_events import (
    EVENT_COLUMNS,
    PRINTED_EVENTS,
    RECOMMENDED_EVENTS,
    SIDES,
    running_events,
    step_frequency_hz,
)
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.spatiotemporal import LITERAL_STRIDES, RUNNING_STRIDES, running_strides
from swaystride.gait.toe_off import RESULTANT_MINIMUM

SHARPEST = replace(PRINTED_EVENTS, contact="sharpest_peak")
LITERAL = replace(RECOMMENDED_EVENTS, toe_off=RESULTANT_MINIMUM)
#: A sensor that is strapped on upside down: half a turn about the forward axis.
TURNED_OVER = np.diag([1.0, -1.0, -1.0])


def events_of(run, rule, **changed):
    feet = {side: changed.get(side, run.signals[f"foot_{side}"]) for side in SIDES}
    sacrum = changed.get("sacrum", run.signals["lumbar"])
    return running_events(feet, sacrum, rate_hz=run.rate_hz, rule=rule)


def turned(signals, rotation):
    return SegmentSignals(rotation @ signals.acc_m_s2, rotation @ signals.gyr_rad_s)


def cut(signals, part):
    return SegmentSignals(signals.acc_m_s2[:, part], signals.gyr_rad_s[:, part])


def errors_ms(run, events, rule=RUNNING_STRIDES):
    """Found minus true, for every valid stride of both feet."""
    found = running_strides(events, rule)
    found = found[found["is_valid"]]
    true = running_strides(run.events, RUNNING_STRIDES)
    rows = []
    for side in SIDES:
        own, real = found[found["side"] == side], true[true["side"] == side].reset_index()
        nearest = np.abs(real["start_s"].to_numpy() - own["start_s"].to_numpy()[:, None]).argmin(1)
        numbers = own.drop(columns=["side", "is_valid"]).reset_index(drop=True)
        rows.append(1e3 * (numbers - real.loc[nearest, numbers.columns].reset_index(drop=True)))
    return rows


@pytest.mark.parametrize("speed_km_h", [9.0, 12.0, 16.0])
def test_recommended_events_are_the_true_ones(thirteen_imus, speed_km_h):
    run = thirteen_imus(speed_km_h)
    for late in errors_ms(run, events_of(run, RECOMMENDED_EVENTS)):
        assert len(late) >= 28  # every stride of 25 s but those at the ends
        assert abs(late["start_s"].mean()) < 4.0
        assert late["start_s"].std() < 2.5
        assert abs(late["toe_off_s"].mean()) < 5.0
        assert late["toe_off_s"].std() < 4.0
        assert abs(late["stride_time_s"].mean()) < 0.5
        assert abs(late["contact_time_s"].mean()) < 9.0
        assert abs(late["flight_time_s"].mean()) < 9.0
        assert abs(late["duty_factor"].mean()) < 12.0  # thousandths


def test_the_peak_is_late_by_a_constant(thirteen_imus):
    """Half the arrest, 22 to 30 ms long: it cancels in stride times and shortens the contact."""
    run = thirteen_imus(12.0)
    for late in errors_ms(run, events_of(run, SHARPEST)):
        assert 9.0 < late["start_s"].mean() < 15.0
        assert late["start_s"].std() < 3.0
        assert abs(late["stride_time_s"].mean()) < 0.5
        assert -15.0 < late["contact_time_s"].mean() < -5.0


def test_the_printed_peak_may_be_the_arrest_of_the_swing(thirteen_imus):
    """The highest acceleration within ± 60 ms: right on average in time, to 30 ms per stride."""
    run = thirteen_imus(12.0)
    for late in errors_ms(run, events_of(run, PRINTED_EVENTS)):
        assert len(late) >= 30
        assert abs(late["start_s"].mean()) < 30.0
        assert 10.0 < late["start_s"].std() < 30.0
        assert abs(late["stride_time_s"].mean()) < 3.0


def test_the_literal_toe_off_halves_the_duty_factor(thirteen_imus):
    run = thirteen_imus(12.0)
    strides = running_strides(events_of(run, LITERAL), LITERAL_STRIDES)
    true = running_strides(run.events, RUNNING_STRIDES)
    share = strides["duty_factor"].median() / true["duty_factor"].median()
    assert 0.3 < share < 0.7
    # what its contact times look like to the rule for real ones
    usual = running_strides(events_of(run, LITERAL), RUNNING_STRIDES)
    assert usual["is_valid"].mean() < 0.2


def test_feet_take_turns_and_rows_rise(thirteen_imus):
    events = events_of(thirteen_imus(14.0), RECOMMENDED_EVENTS)
    assert tuple(events.columns) == EVENT_COLUMNS
    assert np.all(np.diff(events["initial_contact_s"]) > 0.0)
    assert np.all(events["side"].to_numpy()[1:] != events["side"].to_numpy()[:-1])


def test_axes_of_the_sacrum_do_not_matter(thirteen_imus):
    run = thirteen_imus(14.0)
    turn = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    other = events_of(run, RECOMMENDED_EVENTS, sacrum=turned(run.signals["lumbar"], turn))
    whole = events_of(run, RECOMMENDED_EVENTS)
    assert np.allclose(whole["initial_contact_s"], other["initial_contact_s"], atol=1e-9)


def test_exchanged_feet_exchange_their_names(thirteen_imus):
    run = thirteen_imus(14.0)
    right, left = run.signals["foot_right"], run.signals["foot_left"]
    events = events_of(run, RECOMMENDED_EVENTS)
    exchanged = events_of(run, RECOMMENDED_EVENTS, right=left, left=right)
    assert np.array_equal(events["initial_contact_s"], exchanged["initial_contact_s"])
    assert np.array_equal(events["side"] == "right", exchanged["side"] == "left")


def test_a_gap_cuts_the_run_and_nothing_else(thirteen_imus):
    """Events far from the gap stay; none lies in it, and no stride across it is valid."""
    run = thirteen_imus(14.0)
    holed = SegmentSignals(
        run.signals["foot_left"].acc_m_s2.copy(), run.signals["foot_left"].gyr_rad_s
    )
    holed.acc_m_s2[1, 6000:6700] = np.nan
    events = events_of(run, RECOMMENDED_EVENTS, left=holed)
    whole = events_of(run, RECOMMENDED_EVENTS)
    at, all_at = (table["initial_contact_s"].to_numpy() for table in (events, whole))
    assert not np.any((at > 12.0) & (at < 13.4))
    for begin, end in ((2.0, 10.0), (15.0, 23.0)):
        near, all_near = at[(at > begin) & (at < end)], all_at[(all_at > begin) & (all_at < end)]
        assert np.allclose(near, all_near, atol=0.0021)
    strides = running_strides(events, RUNNING_STRIDES)
    across = (strides["start_s"] < 12.0) & (strides["stop_s"] > 13.4)
    assert across.sum() == 2
    assert not strides.loc[across, "is_valid"].any()


def test_step_frequency_of_a_run_that_changes():
    """Steps at 2.6 Hz for most of the run; a loud stride frequency below the band does not count."""
    time = np.arange(60 * 500) / 500.0
    phase = np.cumsum(np.where(time < 45.0, 2.6, 3.2)) / 500.0
    acc = 15 + 5 * np.cos(2 * np.pi * phase) + 8 * np.cos(np.pi * phase)
    assert step_frequency_hz(acc, 500.0, PRINTED_EVENTS) == pytest.approx(2.6, abs=0.03)


def test_a_missing_foot(thirteen_imus):
    run = thirteen_imus(14.0)
    with pytest.raises(
        RecordingError, match="a foot sensor is missing; expected right and left; found right"
    ):
        running_events(
            {"right": run.signals["foot_right"]},
            run.signals["lumbar"],
            rate_hz=run.rate_hz,
            rule=PRINTED_EVENTS,
        )
    nothing = np.full_like(run.signals["foot_left"].acc_m_s2, np.nan)
    lost = SegmentSignals(nothing, nothing)
    with pytest.raises(
        RecordingError, match=r"nobody runs .* found 25.0 s, 25.0 s of them missing"
    ):
        events_of(run, PRINTED_EVENTS, left=lost)


def test_sensors_of_unequal_length(thirteen_imus):
    run = thirteen_imus(14.0)
    short = cut(run.signals["lumbar"], slice(0, 9000))
    with pytest.raises(RecordingError, match="found 12500, 12500, 9000"):
        events_of(run, PRINTED_EVENTS, sacrum=short)


@pytest.mark.parametrize("side", SIDES)
def test_a_foot_sensor_that_is_turned_over(thirteen_imus, side):
    run = thirteen_imus(12.0)
    over = turned(run.signals[f"foot_{side}"], TURNED_OVER)
    with pytest.raises(
        RecordingError, match=rf"{side} foot: the medio-lateral axis .* found -\d+ °/s"
    ):
        events_of(run, RECOMMENDED_EVENTS, **{side: over})


def test_standing_and_scraps_are_no_run():
    still = SegmentSignals(np.tile([[0.0], [9.81], [0.0]], 5000), np.zeros((3, 5000)))
    for signals, found in (
        (still, "one rhythm in 0 of 7 windows"),
        (cut(still, slice(0, 100)), r"a recording of 0\.2 s, too short"),
    ):
        with pytest.raises(RecordingError, match=f"right foot: this foot does not run.*{found}"):
            running_events(
                dict.fromkeys(SIDES, signals), signals, rate_hz=500.0, rule=PRINTED_EVENTS
            )


def test_standing_before_a_run_gives_no_events(thirteen_imus):
    """A gap parts the standing from the run: the events are those of the run alone."""
    run = thirteen_imus(14.0)
    n = 4000
    still = {"acc": np.tile([[0.0], [9.81], [0.0]], n), "gyr": np.zeros((3, n))}

    def preceded(signals):
        gap = np.full((3, 50), np.nan)
        return SegmentSignals(
            np.hstack([still["acc"], gap, signals.acc_m_s2]),
            np.hstack([still["gyr"], gap, signals.gyr_rad_s]),
        )

    changed = {side: preceded(run.signals[f"foot_{side}"]) for side in SIDES}
    events = events_of(run, RECOMMENDED_EVENTS, sacrum=preceded(run.signals["lumbar"]), **changed)
    alone = events_of(run, RECOMMENDED_EVENTS)
    shift_s = (n + 50) / run.rate_hz
    assert np.allclose(events["initial_contact_s"] - shift_s, alone["initial_contact_s"])
