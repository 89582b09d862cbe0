"""Counts on the way to the analysis add up."""

import pandas as pd

from swaystride.studies.kinematics.flow import study_flow
from swaystride.studies.kinematics.table_inputs import planned_trials

TRIALS = pd.DataFrame(
    [(p, t, kind) for p in ("A", "B", "C") for t in ("01", "02") for kind in ("imu", "markers")],
    columns=["participant", "trial", "kind"],
)


def strides(*trials):
    rows = [
        (p, t, side, n, source)
        for p, t in trials
        for side in ("right", "left")
        for n in (11, 12, 13)
        for source in ("optic", "erkf")
    ]
    return pd.DataFrame(rows, columns=["participant", "trial", "side", "stride", "source"])


def exclusions(*rows):
    return pd.DataFrame(rows, columns=["participant", "trial", "reason"])


def test_a_trial_of_several_files_is_planned_once():
    planned = planned_trials(TRIALS)
    assert len(planned) == 6
    assert planned["trial"].tolist() == ["01", "02"] * 3


def test_every_excluded_trial_has_a_reason():
    used = strides(("A", "01"), ("A", "02"), ("B", "01"))
    left_out = exclusions(
        ("B", "02", "markers lost"), ("C", "01", "markers lost"), ("C", "01", "again")
    )
    people, trials, counted = study_flow(planned_trials(TRIALS), left_out, used)
    assert (people["recorded"], people["analysed"]) == (3, 2)
    assert people["excluded"] == [{"reason": "no usable trial", "count": 1}]
    assert (trials["planned"], trials["recorded"], trials["analysed"]) == (6, 6, 3)
    assert trials["excluded"] == [
        {"reason": "markers lost", "count": 2},
        {"reason": "no stride that both sources measured", "count": 1},
    ]
    assert counted == {
        "unit": "strides", "planned": None, "recorded": 18, "excluded": [], "analysed": 18
    }  # fmt: skip


def test_a_participant_with_fewer_trials_lacks_planned_ones():
    fewer = planned_trials(TRIALS).iloc[:-1]
    _, trials, _ = study_flow(
        fewer, exclusions(), strides(*fewer.itertuples(index=False, name=None))
    )
    assert (trials["planned"], trials["recorded"], trials["analysed"]) == (6, 5, 5)
    assert trials["excluded"] == []


def test_nothing_left_is_counted_too():
    left_out = exclusions(*((p, t, "no markers") for p in "ABC" for t in ("01", "02")))
    people, trials, counted = study_flow(planned_trials(TRIALS), left_out, strides())
    assert (people["analysed"], trials["analysed"], counted["analysed"]) == (0, 0, 0)
