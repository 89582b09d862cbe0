"""The table of anchor speeds."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

import swaystride.simulate.foot_anchors as foot_anchors
from swaystride.errors import ConfigurationError
from swaystride.simulate.foot_anchors import gait_anchors

TABLE = pd.read_csv(Path(foot_anchors.__file__).with_name("foot_anchors.csv"), dtype={"unit": str})


def test_every_row_has_a_source() -> None:
    assert TABLE["source"].str.len().min() > 12
    assert TABLE["quantity"].is_unique


def test_anchor_speeds_reach_from_a_slow_walk_to_a_sprint() -> None:
    speeds = gait_anchors().speed_m_s
    assert (np.diff(speeds) > 0).all()
    assert (speeds[0], speeds[-1]) == (1.2, 8.0)


def test_the_table_is_met_at_its_anchors_in_si() -> None:
    at = gait_anchors().at(gait_anchors().speed_m_s)
    row = TABLE.set_index("quantity").loc["contact_pitch"]
    np.testing.assert_allclose(np.degrees(at["contact_pitch_rad"]), row.iloc[1:-1].astype(float))
    assert at["arrest_time_s"][[0, -1]].tolist() == pytest.approx([0.025, 0.008])


@given(speed=st.floats(0.0, 12.0))
def test_between_two_anchors_nothing_overshoots(speed: float) -> None:
    anchors = gait_anchors()
    right = int(np.clip(np.searchsorted(anchors.speed_m_s, speed), 1, len(anchors.speed_m_s) - 1))
    for name, value in anchors.at(speed).items():
        low, high = sorted(anchors.values[name][right - 1 : right + 1])
        assert low - 1e-12 <= float(value) <= high + 1e-12


def test_speed_shortens_strides_and_contacts_and_hardens_impacts() -> None:
    values = gait_anchors().values
    for falling in ("stride_time_s", "duty_factor", "arrest_time_s", "flat_delay_s"):
        assert (np.diff(values[falling]) < 0).all(), falling
    for rising in ("impact_forward_m_s", "impact_down_m_s"):
        assert (np.diff(values[rising]) > 0).all(), rising
    running = gait_anchors().speed_m_s > 2.0
    assert (values["duty_factor"][running] < 0.5).all()
    assert (values["duty_factor"][~running] > 0.5).all()


def test_a_sprinter_stands_on_the_forefoot() -> None:
    sprint = gait_anchors().at(8.0)
    for name in ("contact_pitch_rad", "flat_pitch_rad", "toe_off_pitch_rad"):
        assert sprint[name] < 0


@pytest.mark.parametrize(("unit", "source"), [("furlong", "a book"), ("s", "")])
def test_a_row_without_unit_or_source_is_refused(tmp_path, monkeypatch, unit, source) -> None:
    (tmp_path / "foot_anchors.csv").write_text(
        f"quantity,unit,1.0,2.0,source\nstride_time,{unit},1,2,{source}\n"
    )
    monkeypatch.setattr(foot_anchors, "__file__", str(tmp_path / "foot_anchors.py"))
    gait_anchors.cache_clear()
    try:
        with pytest.raises(ConfigurationError, match="stride_time: a row without"):
            gait_anchors()
    finally:
        gait_anchors.cache_clear()
