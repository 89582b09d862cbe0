import numpy as np
import pandas as pd
import pytest
import xarray as xr

from swaystride.errors import RecordingError
from swaystride.gait.strides import distance_m, stride_lengths_at, stride_table


def trajectory(position, epochs, is_rest, *, zero=(), piece=None, rate_hz=10.0):
    """A trajectory of which only positions and epochs matter."""
    position = np.asarray(position, dtype=float)
    still = np.zeros(position.shape[1], dtype=bool)
    still[list(zero)] = True
    return xr.Dataset(
        {
            "position": (("axis", "time"), position),
            "zero_velocity": (("time",), still),
            "epoch_index": (("epoch",), np.array(epochs, dtype=np.int64)),
            "epoch_is_rest": (("epoch",), np.array(is_rest)),
            "epoch_piece": (("epoch",), np.zeros(len(epochs), int) if piece is None else piece),
        },
        coords={"time": np.arange(position.shape[1]) / rate_hz},
        attrs={"rate_hz": rate_hz},
    )


def corner():
    """3 m along x, 4 m along y, 1 m up; rests of three samples at both ends."""
    position = np.zeros((3, 16))
    position[0, 5:] = 3.0
    position[1, 9:] = 4.0
    position[2, 13:] = 1.0
    zero = [0, 1, 2, 5, 9, 13, 14, 15]
    return trajectory(position, [0, 2, 5, 9, 13, 15], [1, 1, 0, 0, 1, 1], zero=zero)


def test_lengths_angles_and_halves_of_a_known_path():
    strides = stride_table(corner())
    assert strides["length_m"].tolist() == [3.0, 4.0, 1.0]
    assert np.allclose(strides["angle_rad"], [np.pi / 2, np.pi / 2, np.nan], equal_nan=True)
    assert strides["start_s"].tolist() == [0.2, 0.5, 0.9]
    assert strides["stop_s"].tolist() == [0.5, 0.9, 1.3]
    assert np.allclose(strides["speed_m_s"], [10.0, 10.0, 2.5])
    assert strides["is_half"].tolist() == [True, False, True]
    assert distance_m(strides) == 8.0


def test_no_stride_spans_a_rest_or_a_gap():
    position = np.zeros((3, 12))
    position[0] = [0, 0, 1, 1, 1, 1, 2, 2, 3, 3, 3, 3]
    path = trajectory(
        position,
        [0, 2, 5, 6, 8, 11],
        [0, 1, 1, 0, 0, 0],
        zero=[2, 3, 4, 5],
        piece=np.array([0, 0, 0, 0, 1, 1]),
    )
    strides = stride_table(path)
    # 0-2, then the rest 2-5, then 5-6, then the gap 6-8, then 8-11
    assert strides["start_s"].tolist() == [0.0, 0.5, 0.8]
    assert np.isnan(strides["angle_rad"]).all()


def test_without_epochs_there_are_no_strides():
    none = stride_table(trajectory(np.zeros((3, 4)), [], np.empty(0, bool)))
    assert isinstance(none, pd.DataFrame)
    assert len(none) == 0
    assert distance_m(none) == 0.0


def test_lengths_at_given_instants_interpolate_and_may_leave_out_the_vertical():
    position = np.stack([np.arange(11.0), np.zeros(11), np.arange(11.0)])
    path = trajectory(position, [], np.empty(0, bool))
    assert np.allclose(stride_lengths_at(path, [0.05, 0.25, 0.55]), [2.0, 3.0])
    three = stride_lengths_at(path, [0.05, 0.25], horizontal=False)
    assert np.allclose(three, [2.0 * np.sqrt(2.0)])
    with pytest.raises(RecordingError, match=r"between 0 and 1 s; found 0\.5 to 1\.5 s"):
        stride_lengths_at(path, [0.5, 1.5])
