"""Spatiotemporal measures: identities, rejected strides, lengths of a known path, simulated runs."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.running_events import RECOMMENDED_EVENTS, SIDES, running_events
from swaystride.gait.spatiotemporal import (
    RUNNING_STRIDES,
    STRIDE_COLUMNS,
    mean_of_sides,
    running_strides,
    with_lengths,
    zero_velocity_lengths,
)
from swaystride.gait.trajectory import foot_trajectory


def alternating(step_s, contact_s):
    """Events of a run with given step and contact times, right foot first."""
    contact = np.concatenate([[0.0], np.cumsum(step_s)])
    side = np.where(np.arange(contact.size) % 2 == 0, "right", "left")
    columns = {"initial_contact_s": contact, "toe_off_s": contact + contact_s}
    return pd.DataFrame({"side": side, **columns})


@settings(max_examples=30)
@given(st.lists(st.floats(0.33, 0.37), min_size=6, max_size=30), st.floats(0.15, 0.3))
def test_times_add_up(step_s, contact_s):
    strides = running_strides(alternating(step_s, contact_s), RUNNING_STRIDES)
    assert tuple(strides.columns) == STRIDE_COLUMNS
    assert len(strides) == len(step_s) - 1
    assert strides["is_valid"].all()
    pairs = np.array(step_s)
    assert np.allclose(strides["stride_time_s"], pairs[:-1] + pairs[1:])
    assert np.allclose(strides["step_time_s"], pairs[:-1])
    assert np.allclose(strides["contact_time_s"], contact_s)
    assert np.allclose(strides["contact_time_s"] + strides["flight_time_s"], strides["step_time_s"])
    assert np.allclose(strides["duty_factor"] * strides["stride_time_s"], contact_s)
    assert np.allclose(strides["step_frequency_hz"] * strides["stride_time_s"], 2.0)


def test_the_order_of_the_rows_does_not_matter():
    events = alternating(np.full(12, 0.35), 0.2)
    shuffled = events.sample(frac=1.0, random_state=1)
    pd.testing.assert_frame_equal(
        running_strides(events, RUNNING_STRIDES), running_strides(shuffled, RUNNING_STRIDES)
    )


def test_a_missed_contact_rejects_one_stride_and_blinds_its_neighbours():
    events = alternating(np.full(20, 0.35), 0.2).drop(index=10)  # a right contact at 3.5 s
    strides = running_strides(events, RUNNING_STRIDES)
    rejected = strides[~strides["is_valid"]]
    assert rejected["start_s"].tolist() == pytest.approx([8 * 0.35])
    assert rejected["stride_time_s"].tolist() == pytest.approx([1.4])
    # the left stride around the missed contact has no contact of the other foot within it
    unknown = strides[strides["other_contact_s"].isna()]
    assert unknown["start_s"].tolist() == pytest.approx([9 * 0.35])
    assert unknown[["flight_time_s", "step_time_s"]].isna().all(axis=None)
    assert unknown["is_valid"].all()


@pytest.mark.parametrize("contact_s", [0.11, 0.41, np.nan])
def test_contact_times_outside_the_limits(contact_s):
    events = alternating(np.full(10, 0.45), 0.2)
    events.loc[4, "toe_off_s"] = events.loc[4, "initial_contact_s"] + contact_s
    strides = running_strides(events, RUNNING_STRIDES)
    assert strides.loc[~strides["is_valid"], "start_s"].tolist() == pytest.approx([4 * 0.45])


def test_no_events_no_strides():
    events = alternating(np.full(1, 0.35), 0.2).iloc[:0]
    assert running_strides(events, RUNNING_STRIDES).empty


def path(epochs_s, places_m, pieces, rate_hz=100.0):
    """A trajectory that is known at its epochs."""
    index = np.round(np.array(epochs_s) * rate_hz).astype(int)
    position = np.full((3, index[-1] + 50), np.nan)
    position[:, index] = np.array(places_m, dtype=float).T
    return xr.Dataset(
        {
            "position": (("axis", "time"), position),
            "epoch_index": ("epoch", index),
            "epoch_piece": ("epoch", np.array(pieces)),
        },
        attrs={"rate_hz": rate_hz},
    )


def test_lengths_from_stance_to_stance():
    """Horizontal displacement of 3-4-5 triangles; an epoch in swing and a gap are no stride."""
    strides = pd.DataFrame({"start_s": [1.0, 1.7, 2.4, 3.1], "stop_s": [1.7, 2.4, 3.1, 3.8]})
    trajectory = path(
        [1.1, 1.8, 2.5, 3.7, 3.9],
        [[0, 0, 0], [3, 4, 7], [6, 8, 0], [99, 99, 0], [12, 16, 0]],
        [0, 0, 1, 1, 1],
    )
    assert zero_velocity_lengths(strides, trajectory).tolist() == pytest.approx(
        [5.0, np.nan, np.nan, np.nan], nan_ok=True
    )
    nowhere = trajectory.isel(epoch=slice(0, 0))
    assert np.isnan(zero_velocity_lengths(strides, nowhere)).all()


def test_means_of_sides_need_both():
    values = pd.DataFrame({"x": [1.0, 3.0, 5.0], "y": [1.0, np.nan, 2.0], "z": [1.0, 2.0, np.nan]})
    means = mean_of_sides(values, pd.Series(["right", "right", "left"]))
    assert means.tolist() == pytest.approx([3.5, 1.5, np.nan], nan_ok=True)


@pytest.mark.parametrize("speed_km_h", [12.0, 14.0])
def test_lengths_and_speed_of_a_simulated_run(thirteen_imus, speed_km_h):
    run = thirteen_imus(speed_km_h)
    events = running_events(
        {side: run.signals[f"foot_{side}"] for side in SIDES},
        run.signals["lumbar"],
        rate_hz=run.rate_hz,
        rule=RECOMMENDED_EVENTS,
    )
    strides = running_strides(events, RUNNING_STRIDES)
    worn = run.feet_as_worn.items()
    trajectories = {
        side: foot_trajectory(foot.acc_m_s2, foot.gyr_rad_s, run.rate_hz, RECOMMENDED)
        for side, foot in worn
    }
    strides = with_lengths(strides, trajectories)
    for side, own in strides[strides["is_valid"]].groupby("side"):
        ends = np.stack([own["start_s"], own["stop_s"]]) + 0.1
        whole = ends[1] < run.foot_path_m[side].shape[1] / run.rate_hz
        time = np.arange(run.foot_path_m[side].shape[1]) / run.rate_hz
        at = np.stack([np.interp(ends, time, axis) for axis in run.foot_path_m[side][:2]])
        true = np.hypot(*(at[:, 1] - at[:, 0]))[whole]
        found = own["stride_length_m"].to_numpy()[whole]
        assert np.isfinite(found).all()
        assert found.mean() == pytest.approx(true.mean(), rel=0.02)
        assert own["speed_m_s"].mean() == pytest.approx(run.speed_m_s, rel=0.02)
