"""Gap filling against known truth, and every gap listed."""

import numpy as np
import pandas as pd
import pytest

from swaystride.mocap.marker_gaps import PRINTED_LIMITS, fill_gaps, gap_findings
from swaystride.rotations import exp_map

RATE_HZ = 200.0
PELVIS = ("RASI", "LASI", "RPSI", "LPSI")


@pytest.fixture
def pelvis():
    """Four markers of a rigid body that bobs, sways and turns."""
    t = np.arange(400) / RATE_HZ
    shape = np.array([[0.0, 0.12, 0.0], [0.0, -0.12, 0.0], [-0.16, 0.05, 0.0], [-0.16, -0.05, 0.0]])
    vector = np.stack([0.1 * np.sin(9 * t), 0.1 * np.cos(17 * t), 0.15 * np.sin(9 * t)], axis=1)
    way = np.stack([0.03 * np.sin(17 * t), 0.02 * np.sin(9 * t), 1 + 0.04 * np.sin(18 * t)], axis=1)
    return np.einsum("nab,mb->mna", exp_map(vector), shape) + way


def with_gap(truth, row, start, length):
    lost = truth.copy()
    lost[row, start : start + length] = np.nan
    return lost


def fill(lost, names=PELVIS, rigid=(PELVIS,), patterns=(PELVIS,)):
    return fill_gaps(lost, names, limits=PRINTED_LIMITS, rigid=rigid, patterns=patterns)


def test_a_quintic_is_filled_exactly():
    t = np.linspace(-1, 1, 60)
    truth = np.stack([np.polyval([3.0, -1, 2, 0.5, -1, k], t) for k in range(3)], axis=1)[None]
    filled, gaps = fill(with_gap(truth, 0, 20, 10), ("KNE",), (), ())
    np.testing.assert_allclose(filled, truth, atol=1e-9)
    assert gaps.to_dict("records") == [
        {"marker": "KNE", "start": 20, "length": 10, "method": "smooth"}
    ]


@pytest.mark.parametrize("length", [11, 20])
def test_a_rigid_body_is_filled_exactly(pelvis, length):
    filled, gaps = fill(with_gap(pelvis, 1, 100, length))
    np.testing.assert_allclose(filled, pelvis, atol=1e-9)
    assert gaps["method"].tolist() == ["rigid"]


def test_a_pattern_follows_a_neighbour_and_meets_both_ends(pelvis):
    neighbour = pelvis[0] + np.array([0.0, 0.0, -0.3])
    drift = np.linspace(0.0, 0.01, 400)[:, None]
    truth = np.stack([pelvis[0], neighbour + drift])
    filled, gaps = fill(with_gap(truth, 1, 200, 15), ("THI", "KNE"), (), (("THI", "KNE"),))
    np.testing.assert_allclose(filled, truth, atol=1e-9)
    assert gaps["method"].tolist() == ["pattern"]


def test_running_markers_are_filled_to_millimetres(motion, rng):
    """Gaps of ten frames, with the noise of cameras: printed filling of a brisk motion."""
    recording, _ = motion
    names = tuple(recording["marker"].to_numpy())
    truth = recording["position"].to_numpy().transpose(0, 2, 1)
    lost = truth + 0.3e-3 * rng.standard_normal(truth.shape)
    for row in range(len(names)):
        lost[row, 30 + 15 * row : 40 + 15 * row] = np.nan
    filled, gaps = fill(lost, names, (), ())
    assert (gaps["method"] == "smooth").all()
    was_lost = np.isnan(lost).any(axis=2)
    apart = np.linalg.norm((filled - truth)[was_lost], axis=1)
    assert np.sqrt(np.mean(apart**2)) < 2e-3


def test_what_no_method_may_fill_stays_and_is_told(pelvis):
    lost = pelvis.copy()
    lost[0, :4] = np.nan  # at an end
    lost[1, 100:121] = np.nan  # longer than any limit
    lost[2, 200:215] = np.nan  # in the middle of
    lost[3, 195:220] = np.nan  # a longer one: two markers do not make a body
    filled, gaps = fill(lost, rigid=(PELVIS,), patterns=())
    assert (gaps["method"] == "").all()
    np.testing.assert_array_equal(np.isnan(filled), np.isnan(lost))
    findings = gap_findings(gaps, RATE_HZ, "run.c3d")
    assert [f.severity for f in findings] == ["warning"] * 4
    assert findings[1].place == "LASI, t = 0.50 s"
    assert findings[1].found.startswith("21 frames")


def test_a_filled_gap_is_told_too():
    gaps = pd.DataFrame({"marker": ["KNE"], "start": [20], "length": [3], "method": ["smooth"]})
    (finding,) = gap_findings(gaps, RATE_HZ, "run.c3d")
    assert (finding.check, finding.severity) == ("marker_gap_filled", "info")
    assert finding.found == "3 frames, filled (smooth)"


def test_frames_that_were_seen_stay_as_they_were(pelvis, rng):
    lost = with_gap(pelvis + 1e-3 * rng.standard_normal(pelvis.shape), 0, 50, 8)
    filled, _ = fill(lost)
    seen = np.isfinite(lost)
    np.testing.assert_array_equal(filled[seen], lost[seen])
