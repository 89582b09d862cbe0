import numpy as np
import pytest
from closed_form_walk import walk
from scipy.spatial.transform import Rotation

from swaystride.gait.foot_height import height_shares
from swaystride.gait.foot_methods import RECOMMENDED
from swaystride.gait.stance_rhythm import stances_in_rhythm
from swaystride.gait.stillness import find_rests, find_stances, stillness_rad_s

RUN = {"stride_s": 0.7, "stance_s": 0.2, "stride_m": 2.8, "roll_rad_s": 1.0}
RATE_HZ = 200.0
NO_RESTS = np.empty((0, 2), dtype=np.int64)


def _movement(acc, gyr):
    return stillness_rad_s(
        acc,
        gyr,
        RATE_HZ,
        window_s=RECOMMENDED.stillness_window_s,
        acc_m_s2_per_rad_s=RECOMMENDED.stillness_acc_m_s2_per_rad_s,
    )


def _slow_height_share(acc, gyr, at, reach):
    """The same in plain NumPy and SciPy: rotations by composition, integrals by sums."""
    window = slice(max(at - reach, 0), min(at + reach + 1, acc.shape[1]))
    acc, gyr, own = acc[:, window], gyr[:, window], at - window.start
    turned = [Rotation.identity()]
    for first, second in zip(gyr.T[:-1], gyr.T[1:], strict=True):
        turned.append(turned[-1] * Rotation.from_rotvec(0.5 * (first + second) / RATE_HZ))
    force = Rotation.concatenate(turned).apply(acc.T)
    up = force.mean(axis=0) / np.linalg.norm(force.mean(axis=0))
    vertical = force @ up - np.linalg.norm(force.mean(axis=0))
    velocity = np.cumsum(vertical)
    height = np.cumsum(velocity - velocity.mean())
    near = height[max(own - reach // 2, 0) : own + reach // 2 + 1]
    return (height[own] - near.min()) / np.ptp(near)


def test_the_kernel_agrees_with_a_slow_twin():
    own = walk(n_strides=9, rate_hz=RATE_HZ, **RUN)
    at = np.r_[own.stances[2:6], own.stances[2:6] + 60]
    found = height_shares(own.acc, own.gyr, RATE_HZ, at, [140.0] * 8)
    slow = [_slow_height_share(own.acc, own.gyr, k, 140) for k in at]
    assert np.allclose(found, slow, atol=1e-9)


@pytest.mark.parametrize("tilt_deg", [0.0, 90.0, 200.0])
def test_a_stance_is_low_and_a_swing_is_high_in_any_mounting(tilt_deg):
    mounting = Rotation.from_euler("xyz", [tilt_deg, 20.0, -50.0], degrees=True).as_matrix()
    own = walk(n_strides=9, rate_hz=RATE_HZ, mounting=mounting, **RUN)
    inner = own.stances[2:-2]
    stance = height_shares(own.acc, own.gyr, RATE_HZ, inner, [140.0] * len(inner))
    swing = height_shares(own.acc, own.gyr, RATE_HZ, inner + 70, [140.0] * len(inner))
    assert stance.max() < 0.1
    assert swing.min() > 0.8


def test_no_rhythm_and_clipped_strides_have_no_height():
    own = walk(n_strides=9, rate_hz=RATE_HZ, **RUN)
    at = own.stances[3:5]
    assert np.isnan(height_shares(own.acc, own.gyr, RATE_HZ, at, [0.0, 0.0])).all()
    limit = np.quantile(np.abs(own.acc).max(axis=0)[at[0] - 140 : at[0] + 140], 0.8)
    clipped = np.clip(own.acc, -limit, limit)
    assert np.isnan(height_shares(clipped, own.gyr, RATE_HZ, at, [140.0, 140.0])).all()
    limit = np.quantile(np.abs(own.gyr).max(axis=0)[at[0] - 140 : at[0] + 140], 0.5)
    clipped = np.clip(own.gyr, -limit, limit)
    assert np.isnan(height_shares(own.acc, clipped, RATE_HZ, at, [140.0, 140.0])).all()


def test_a_stiller_turn_of_the_swing_does_not_replace_its_stance():
    """Candidates in stance and in swing, the swings stiller: the low ones stay."""
    own = walk(n_strides=12, rate_hz=RATE_HZ, **RUN)
    movement = _movement(own.acc, own.gyr)
    swings = own.stances[4:9] + 65
    movement[swings] = 0.5 * movement[own.stances].min()
    candidates = np.sort(np.r_[own.stances, swings])
    assert np.array_equal(
        stances_in_rhythm(candidates, movement, own.acc, own.gyr, RATE_HZ, NO_RESTS), own.stances
    )


@pytest.mark.parametrize("n_missing", [1, 3, 9])
def test_up_to_nine_stances_in_a_row_are_put_back(n_missing):
    own = walk(n_strides=20, rate_hz=RATE_HZ, **RUN)
    missing = slice(5, 5 + n_missing)
    given = np.delete(own.stances, missing)
    movement = _movement(own.acc, own.gyr)
    found = stances_in_rhythm(given, movement, own.acc, own.gyr, RATE_HZ, NO_RESTS)
    assert len(found) == len(own.stances)
    assert np.abs(found[missing] - own.stances[missing]).max() <= 0.1 * RATE_HZ
    assert set(given) <= set(found)


def test_ten_missing_stances_stay_missing():
    own = walk(n_strides=20, rate_hz=RATE_HZ, **RUN)
    given = np.delete(own.stances, slice(5, 15))
    movement = _movement(own.acc, own.gyr)
    found = stances_in_rhythm(given, movement, own.acc, own.gyr, RATE_HZ, NO_RESTS)
    assert np.array_equal(found, given)


def test_no_stance_is_put_back_across_a_rest():
    own = walk(n_strides=20, rate_hz=RATE_HZ, **RUN)
    given = np.delete(own.stances, slice(8, 10))
    rest = np.array([[own.stances[8] - 20, own.stances[9] + 20]])
    movement = _movement(own.acc, own.gyr)
    found = stances_in_rhythm(given, movement, own.acc, own.gyr, RATE_HZ, rest)
    assert np.array_equal(found, given)


def test_nothing_is_put_into_a_rest():
    """Run, two seconds of rest, run: no stance between the two runs."""
    one = walk(n_strides=9, rest_s=1.0, rate_hz=RATE_HZ, **RUN)
    acc, gyr = np.tile(one.acc, 2), np.tile(one.gyr, 2)
    rests = find_rests(acc, gyr, RATE_HZ, RECOMMENDED)
    found = find_stances(acc, gyr, RATE_HZ, RECOMMENDED, rests)
    first, stop = rests[1]
    assert stop - first >= 1.9 * RATE_HZ
    assert not ((found > first) & (found < stop)).any()


def test_without_a_rhythm_nothing_changes():
    noise = 1.0 + 0.2 * np.random.default_rng(3).random(3000)
    still = np.tile([[0.0], [0.0], [9.80665]], 3000)
    given = np.array([100, 130, 900, 1800])
    assert np.array_equal(stances_in_rhythm(given, noise, still, 0 * still, 100.0, NO_RESTS), given)
