"""Findings about strides: sensors out of sync, rejected strides."""

import numpy as np
import pandas as pd

from swaystride.gait.event_checks import USUAL_EVENTS, event_findings
from swaystride.gait.running_events import RECOMMENDED_EVENTS, SIDES, running_events
from swaystride.gait.segment_signals import SegmentSignals
from swaystride.gait.spatiotemporal import RUNNING_STRIDES, running_strides


def strides_of(run, late_samples=0):
    """Strides with the left foot sensor late."""
    feet = {}
    for side in SIDES:
        signals = run.signals[f"foot_{side}"]
        shift = late_samples if side == "left" else 0
        feet[side] = SegmentSignals(
            np.roll(signals.acc_m_s2, shift, axis=1), np.roll(signals.gyr_rad_s, shift, axis=1)
        )
    events = running_events(
        feet, run.signals["lumbar"], rate_hz=run.rate_hz, rule=RECOMMENDED_EVENTS
    )
    return running_strides(events, RUNNING_STRIDES)


def checks(strides):
    return [finding.check for finding in event_findings(strides, USUAL_EVENTS, file="R01.h5")]


def test_a_good_run_and_a_foot_out_of_sync(thirteen_imus):
    run = thirteen_imus(12.0)
    assert checks(strides_of(run)) == []
    assert checks(strides_of(run, late_samples=15)) == ["steps_uneven"]  # 30 ms
    (finding,) = event_findings(strides_of(run, late_samples=15), USUAL_EVENTS, file="R01.h5")
    right, left = (float(part.split(" s")[0]) for part in finding.found.split(", "))
    assert abs(right - left - 0.06) < 0.005


def test_rejected_few_and_one_sided_strides():
    strides = pd.DataFrame(
        {"side": ["right", "left"] * 20, "step_time_s": 0.35, "is_valid": [True] * 34 + [False] * 6}
    )
    assert checks(strides) == ["strides_rejected"]
    assert checks(strides.iloc[:30]) == []
    assert checks(strides.iloc[:14]) == ["few_strides"]
    assert checks(strides.iloc[:0]) == ["few_strides"]
    assert checks(strides.assign(is_valid=strides["side"] == "right")) == [
        "strides_rejected",
        "steps_uneven",
    ]
