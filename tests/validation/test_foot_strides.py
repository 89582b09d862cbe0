"""The whole comparison on walks in closed form: tables, peers, hand of the path, figures."""

import numpy as np
import pandas as pd
import pytest
from closed_form_walk import walk

from swaystride.errors import RecordingError
from swaystride.presentation.figure_style import figure_style, save_figure
from swaystride.validation.foot_checks import distance_checks, hand_of_paths, mocap_checks
from swaystride.validation.foot_errors import trial_table
from swaystride.validation.foot_figures import figure_errors, figure_sheet, figure_trial
from swaystride.validation.foot_peers import peer_lengths
from swaystride.validation.foot_recording import FootRecording, displacements
from swaystride.validation.foot_strides import all_strides, foot_trial


def recording(name="left", *, stored=True, **settings):
    """A turning walk; its stored path is 2 % short, its toe marker moves 1 % further."""
    truth = walk(**{"n_strides": 6, "turn_rad_s": 0.3, **settings})
    time_s = np.arange(truth.acc.shape[1]) / truth.rate_hz
    instants_s = truth.stances / truth.rate_hz
    path = truth.position[:2]
    moved = displacements(path, time_s, instants_s)
    return FootRecording(
        dataset="foot_imu_mocap_walk",
        trial=name,
        gait="walk",
        rate_hz=truth.rate_hz,
        acc_m_s2=truth.acc,
        gyr_rad_s=truth.gyr,
        instants_s=instants_s,
        reference_m=moved,
        path_s=time_s[::2],
        path_m=path[:, ::2],
        stored_path_m=0.98 * path if stored else None,
        other_references_m={"TOE": 1.01 * moved, "FM5": moved},
    )


@pytest.fixture(scope="module")
def trials():
    feet = [recording("left"), recording("right", stride_m=1.2)]
    return [foot_trial(foot, {"left": feet[0].reference_m + 0.03}) for foot in feet]


def test_every_method_stands_beside_the_reference(trials):
    table = all_strides(trials)
    assert len(table) == 8
    assert table["stride"].tolist() == [1, 2, 3, 4] * 2
    for column in ("length_m", "printed_m", "vqf_m"):
        np.testing.assert_allclose(table[column], table["reference_m"], atol=0.03, err_msg=column)
    np.testing.assert_allclose(table["error_m"], table["length_m"] - table["reference_m"])
    np.testing.assert_allclose(table["stored_m"], 0.98 * table["reference_m"])
    left = table["trial"] == "left"
    np.testing.assert_allclose(table.loc[left, "gaitmap_m"], table.loc[left, "reference_m"] + 0.03)
    assert table.loc[~left, "gaitmap_m"].isna().all()
    np.testing.assert_allclose(table["reference_toe_m"], 1.01 * table["reference_m"])


def test_own_strides_include_the_half_ones(trials):
    own = trials[0].own_strides
    assert len(own) == 6
    np.testing.assert_allclose(own["length_m"], own["reference_m"], atol=0.03)
    quantities = [check.quantity for check in distance_checks("set", trials)]
    assert "own strides: RMSE, m" in quantities


def test_distance_of_a_trial_is_the_sum_of_its_strides(trials):
    table = trial_table(trials).set_index("trial")
    reference = trials[1].recording.reference_m.sum()
    assert table.loc["right", "reference_distance_m"] == pytest.approx(reference)
    assert table.loc["right", "distance_m"] == pytest.approx(reference, rel=0.02)
    assert table.loc["right", "strides"] == 4


def test_a_path_fits_by_a_rotation_and_that_of_negated_acceleration_by_a_reflection(trials):
    hands = hand_of_paths(trials)
    assert (hands["rotated_m"] < 0.2 * hands["mirrored_m"]).all()
    foot = trials[0].recording
    negated = FootRecording(**{**vars(foot), "acc_m_s2": -foot.acc_m_s2})
    hands = hand_of_paths([foot_trial(negated, {})])
    assert (hands["mirrored_m"] < 0.2 * hands["rotated_m"]).all()


def test_all_markers_are_reported_for_each_foot(trials):
    rows = {check.quantity: check for check in mocap_checks(trials)}
    for foot in ("left", "right"):
        against = {m: rows[f"{foot}: RMSE against {m}, m"].value for m in ("FCC", "TOE", "FM5")}
        assert against["FM5"] == pytest.approx(against["FCC"])
        assert against["TOE"] > 0.0
    assert rows["walk: RMSE of stride length, m"].within == "yes"


def peer_table(tmp_path, **changes):
    foot = recording()
    table = pd.DataFrame(
        {
            "trial": "left",
            "stride": np.arange(1, 5),
            "start_s": foot.instants_s[:-1],
            "stop_s": foot.instants_s[1:],
            "length_m": foot.reference_m,
        }
    ).assign(**changes)
    path = tmp_path / "gaitmap.csv"
    table.sample(frac=1.0, random_state=1).to_csv(path, index=False)
    return path


def test_a_table_of_a_peer_is_joined_by_stride_and_may_be_absent(tmp_path):
    foot = recording()
    found = peer_lengths(peer_table(tmp_path), [foot])
    assert found["left"] == pytest.approx(foot.reference_m)
    assert peer_lengths(None, [foot]) == {}
    assert peer_lengths(tmp_path / "absent.csv", [foot]) == {}


@pytest.mark.parametrize(
    ("changes", "line"),
    [
        ({"trial": "right"}, r"trial left: strides are missing; expected 4; found 0"),
        (
            {"start_s": [1.6, 2.7, 3.9, 4.9]},
            r"trial left, stride 1: computed between other instants; expected start at 2.600 s; found 1.600 s",
        ),
    ],
)
def test_a_table_of_other_strides_is_refused(tmp_path, changes, line):
    with pytest.raises(RecordingError, match=line):
        peer_lengths(peer_table(tmp_path, **changes), [recording()])


def test_a_table_without_lengths_is_refused(tmp_path):
    path = peer_table(tmp_path)
    pd.read_csv(path).drop(columns="length_m").to_csv(path, index=False)
    with pytest.raises(RecordingError, match=r"columns are missing; .*; found no length_m"):
        peer_lengths(path, [recording()])


def test_figures_draw_every_stride_and_are_the_same_each_time(trials, tmp_path):
    with figure_style():
        for name, figure in (
            ("errors", figure_errors(all_strides(trials))),
            ("trial", figure_trial(trials[0])),
            ("sheet", figure_sheet([*trials, trials[0]])),
        ):
            one = save_figure(figure, tmp_path / name, simulated=False)[1].read_bytes()
            two = save_figure(figure, tmp_path / f"{name}2", simulated=False)[1].read_bytes()
            assert one == two
        left, right = figure_trial(trials[0]).axes
        assert [line.get_label() for line in left.lines][:3] == [
            "optical path",
            "our path",
            "path in the files",
        ]
        drawn = {line.get_label(): line.get_ydata() for line in right.lines}
        ours = trials[0].strides["error_m"].to_numpy()
        np.testing.assert_allclose(drawn["recommended"], ours)


def test_an_error_beyond_the_edge_is_drawn_there_and_counted(trials):
    table = all_strides(trials)
    table.loc[0, "stored_m"] = table.loc[0, "reference_m"] + 3.0
    with figure_style():
        (axes,) = figure_errors(table).axes
    assert "1" in [text.get_text() for text in axes.texts]
    stored = max(np.max(line.get_ydata()) for line in axes.lines if len(line.get_xdata()) == 8)
    assert stored == pytest.approx(0.15)
