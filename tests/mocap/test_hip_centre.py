"""Hip centres and the range of a person's measures."""

from dataclasses import replace

import numpy as np
import pytest
from optical_person import BODY

from swaystride.errors import RecordingError
from swaystride.mocap.hip_centre import hara_hip_centres


def test_the_example_of_the_methods():
    body = replace(BODY, leg_length_m=(0.9, 0.9))
    bare = hara_hip_centres(body, marker_offset=False)
    np.testing.assert_allclose(bare[0], [-0.0457, -0.0792, 0.0854])
    np.testing.assert_allclose(bare[1], bare[0] * [1, 1, -1])
    on_markers = hara_hip_centres(body, marker_offset=True)
    np.testing.assert_allclose(on_markers - bare, [[-0.009, 0, 0]] * 2, atol=1e-12)


def test_each_leg_has_its_own_length():
    right, left = hara_hip_centres(replace(BODY, leg_length_m=(0.9, 0.8)), marker_offset=False)
    assert right[2] + left[2] == pytest.approx(0.086 * 0.1)


@pytest.mark.parametrize(
    ("field", "value"),
    [("leg_length_m", (92.0, 92.0)), ("knee_width_m", (0.1, 0.3)), ("ankle_width_m", (0.0, 0.07))],
)
def test_measures_that_cannot_be_right(field, value):
    with pytest.raises(RecordingError, match=field):
        replace(BODY, **{field: value}).check()
