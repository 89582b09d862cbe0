"""Curves of real runners that the simulated one aims at, and their phase."""

import numpy as np
import pandas as pd
import pytest

from import_graph import REPOSITORY
from swaystride.simulate.running_aims import (
    TOE_OFF_LAG,
    aim_angles,
    aim_curves,
    aim_phase,
    aim_way,
)
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe

PHASE = np.linspace(0.0, 1.0, 201)
TABLE = REPOSITORY / "src" / "swaystride" / "simulate" / "running_aims.csv"


@pytest.mark.parametrize("joint", ["hip", "knee"])
def test_an_aim_of_the_range_in_the_table_is_the_curve_of_the_table(joint):
    rows = pd.read_csv(TABLE)
    for row in rows[rows["coordinate"] == f"{joint}_flexion"].to_dict("records"):
        assert row["source"]
        plain = row["a0"] + sum(
            row[f"a{k}"] * np.cos(2 * np.pi * k * PHASE)
            + row[f"b{k}"] * np.sin(2 * np.pi * k * PHASE)
            for k in range(1, 7)
        )
        both = aim_angles(np.ptp(plain), np.ptp(plain), PHASE, row["speed_m_s"])
        np.testing.assert_allclose(both[joint == "knee"], plain, atol=0.05)


def test_between_two_speeds_curves_are_mixed_and_beyond_them_kept():
    slow, middle, fast = (aim_angles(1.0, 1.6, PHASE, v) for v in (3.5, 4.0, 4.5))
    for a, b, c in zip(slow, middle, fast, strict=True):
        np.testing.assert_allclose(b, (a + c) / 2, atol=1e-12)
    np.testing.assert_array_equal(aim_angles(1.0, 1.6, PHASE, 5.5)[0], fast[0])
    # One speed per row of phases.
    rows = aim_angles(1.0, 1.6, np.stack([PHASE, PHASE]), np.array([[3.5], [4.5]]))
    np.testing.assert_allclose(rows[1], np.stack([slow[1], fast[1]]), atol=1e-12)


def test_a_faster_runner_keeps_the_hip_extended_for_longer_after_toe_off():
    duty = dict(zip(aim_curves().speed_m_s, aim_curves().duty_factor, strict=True))

    def shares(speed):
        hip, _ = aim_angles(1.0, 1.0, PHASE, speed)
        return np.mean((hip < hip.min() + 0.15) & (duty[speed] < PHASE))

    assert shares(4.5) > shares(2.5) + 0.02


def test_the_toe_off_of_a_runner_like_those_of_the_table_lies_where_theirs_is():
    contact = 0.7 * np.arange(6)
    for speed, duty in zip(aim_curves().speed_m_s, aim_curves().duty_factor, strict=True):
        phase = aim_phase(contact, contact + 0.7 * duty, speed)
        np.testing.assert_allclose(phase(contact)[0], np.arange(6), atol=1e-9)
        at_toe_off = phase(contact[:-1] + 0.7 * duty)[0]
        np.testing.assert_allclose(at_toe_off, np.arange(5) + duty + TOE_OFF_LAG, atol=1e-9)


def test_the_way_of_the_ankle_is_that_of_two_links():
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    thigh, knee = aim_angles(1.1, 1.7, PHASE, 3.5)
    forward, up = aim_way(body, 1.1, 1.7, PHASE, 3.5)
    reach = body.thigh_m**2 + body.shank_m**2 + 2 * body.thigh_m * body.shank_m * np.cos(knee)
    np.testing.assert_allclose(forward**2 + up**2, reach)
    straight = aim_way(body, 0.0, 0.0, PHASE, 3.5)
    np.testing.assert_allclose(straight[1], -body.leg_m)
    assert thigh.max() > 0.5
