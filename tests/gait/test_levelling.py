import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from swaystride.gait.levelling import level_quaternion, mean_directions


@given(st.tuples(*[st.floats(-20, 20)] * 3))
def test_levelling_takes_the_direction_to_the_vertical_without_turning_about_it(up):
    size = np.linalg.norm(up)
    assume(size > 0.1)
    turn = Rotation.from_quat(level_quaternion(up), scalar_first=True)
    assert np.allclose(turn.apply(np.array(up) / size), [0.0, 0.0, 1.0], atol=1e-6)
    assert abs(turn.as_rotvec()[2]) < 1e-9


def test_mean_directions_cut_their_windows_at_the_ends():
    signal = np.zeros((3, 6))
    signal[2] = 1.0
    signal[0, 3] = 1.0
    found = mean_directions(signal, [0, 3], 1)
    assert np.allclose(found[0], [0.0, 0.0, 1.0])
    assert np.allclose(found[1], np.array([1.0, 0.0, 3.0]) / np.sqrt(10.0))
