"""Features of strides against a slow plain twin, and closed forms."""

import numpy as np
import pytest

from swaystride.studies.kinematics.features import (
    RANGE_FEATURES,
    STRIDE_FEATURES,
    peak_features,
    ranges_of_motion,
)
from swaystride.studies.kinematics.plan import ANGLE_NAMES, FEATURES
from swaystride.studies.kinematics.stride_selection import (
    StrideRule,
    counted_strides,
    regular_strides,
)

HIP, KNEE, ANKLE = (
    ANGLE_NAMES.index(name) for name in ("hip_flexion", "knee_flexion", "ankle_dorsiflexion")
)


@pytest.fixture
def walk():
    rng = np.random.default_rng(1)
    angles = rng.standard_normal((2, 9, 400))
    contacts = np.array([13, 90, 155, 290, 370])
    toe_off = np.array([40.4, 120.0, np.nan, 300.9])
    return angles, contacts, toe_off


def test_ranges_and_peaks_are_those_of_a_plain_loop(walk):
    angles, contacts, toe_off = walk
    ranges = ranges_of_motion(angles, contacts)
    peaks = peak_features(angles, contacts, toe_off)
    assert peaks.shape == (2, len(FEATURES), 4)
    for s in range(2):
        for k in range(4):
            own = angles[s, :, contacts[k] : contacts[k + 1]]
            assert np.array_equal(ranges[s, :, k], own.max(axis=1) - own.min(axis=1))
            in_stance = np.nan
            if np.isfinite(toe_off[k]):
                stop = int(toe_off[k]) + 1
                in_stance = angles[s, KNEE, contacts[k] : stop].max()
            expected = [
                own[HIP].max(),
                -own[HIP].min(),
                in_stance,
                own[ANKLE].max(),
                -own[ANKLE].min(),
                own[ANKLE, 0],
            ]
            assert np.array_equal(peaks[s, :, k], expected, equal_nan=True)


def test_a_missing_sample_takes_its_stride_only(walk):
    angles, contacts, toe_off = walk
    angles[0, KNEE, 100] = np.nan
    ranges, peaks = ranges_of_motion(angles, contacts), peak_features(angles, contacts, toe_off)
    assert np.argwhere(np.isnan(ranges)).tolist() == [[0, KNEE, 1]]
    missing = np.argwhere(np.isnan(peaks)).tolist()
    assert missing == [[0, 2, 1], [0, 2, 2], [1, 2, 2]]


def test_toe_off_in_the_sample_before_the_next_contact(walk):
    angles, contacts, _ = walk
    late = contacts[1:] - 1.0
    peaks = peak_features(angles, contacts, late)
    for k in range(4):
        own = angles[0, KNEE, contacts[k] : contacts[k + 1] - 1]
        assert peaks[0, 2, k] >= own.max()


def test_names_and_order():
    assert len(STRIDE_FEATURES) == 18
    assert STRIDE_FEATURES[:9] == RANGE_FEATURES
    assert RANGE_FEATURES[0] == "rom_hip_flexion"


@pytest.mark.parametrize(
    ("n_used", "numbers"), [(150, (11, 160)), (None, (11, 516)), (600, (11, 516))]
)
def test_which_strides_count(n_used, numbers):
    rule = StrideRule(10, n_used, 0.25)
    regular = regular_strides(np.arange(517) * 139.0, rule)
    counted = np.flatnonzero(counted_strides(regular, rule)) + 1
    assert (counted[0], counted[-1]) == numbers
    assert len(counted) == numbers[1] - numbers[0] + 1


def test_a_missed_contact_costs_one_stride_and_no_number():
    contacts = np.delete(np.arange(30) * 140, 15)
    rule = StrideRule(10, 10, 0.25)
    counted = counted_strides(regular_strides(contacts, rule), rule)
    assert (np.flatnonzero(counted) + 1).tolist() == [11, 12, 13, 14, 16, 17, 18, 19, 20]
    assert regular_strides([5.0], rule).size == 0
