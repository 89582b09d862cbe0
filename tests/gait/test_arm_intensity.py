"""Root mean square of the acceleration of an arm."""

import numpy as np
import pandas as pd
import pytest

from swaystride.gait.arm_intensity import ARM_COLUMNS, arm_intensity
from swaystride.units import GRAVITY_M_S2

STRIDES = pd.DataFrame({"start_s": [0.0, 1.0], "stop_s": [1.0, 2.0]})


@pytest.mark.parametrize("remove_mean", [True, False])
def test_a_swinging_arm_in_closed_form(remove_mean):
    """Sines of 2, 3 and 1 g about 0, 1 and 0 g: A/√2, and √(A²/2 + 1) with gravity."""
    phase = 2 * np.pi * np.arange(1000) / 500.0
    waves = np.stack([2 * np.sin(phase), 1.0 + 3 * np.cos(phase), np.sin(2 * phase)])
    found = arm_intensity(STRIDES, GRAVITY_M_S2 * waves, 500.0, remove_mean=remove_mean)
    assert tuple(found.columns) == ARM_COLUMNS
    vertical = np.sqrt(4.5) if remove_mean else np.sqrt(5.5)
    assert np.allclose(found, [np.sqrt(2.0), vertical, np.sqrt(0.5)], rtol=1e-6)


def test_the_sign_of_an_axis_does_not_matter():
    """Left and right arm are alike although their lateral axes are mirrored."""
    acc = np.random.default_rng(5).standard_normal((3, 1000))
    mirrored = acc * np.array([[1.0], [1.0], [-1.0]])
    found, other = (arm_intensity(STRIDES, a, 500.0, remove_mean=False) for a in (acc, mirrored))
    pd.testing.assert_frame_equal(found, other)
