"""Low-pass and the whole of cleaning."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.findings import findings_from_json
from swaystride.mocap.marker_cleaning import PRINTED_CLEANING, clean_markers
from swaystride.mocap.marker_filter import filter_markers
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT, in_world_axes

RATE_HZ = 200.0


@pytest.mark.parametrize(
    ("realisation", "gain"), [("net_fourth_order", np.sqrt(0.5)), ("fourth_order_twice", 0.5)]
)
def test_gain_at_the_cutoff(realisation, gain):
    """A sine at 10 Hz: 3 dB less by the net realisation, 6 dB by the other, and no delay."""
    t = np.arange(1000) / RATE_HZ
    wave = np.sin(2 * np.pi * 10.0 * t)
    filtered = filter_markers(
        np.repeat(wave[None, :, None], 3, axis=2),
        rate_hz=RATE_HZ,
        cutoff_hz=10.0,
        realisation=realisation,
    )[0, :, 0]
    middle = slice(300, 700)
    np.testing.assert_allclose(filtered[middle], gain * wave[middle], atol=1e-4)


def test_nothing_is_filtered_across_a_gap(rng):
    marker = np.cumsum(rng.standard_normal((1, 300, 3)), axis=1)
    marker[0, 100:150] = np.nan
    options = {"rate_hz": RATE_HZ, "cutoff_hz": 10.0, "realisation": "net_fourth_order"}
    both = filter_markers(marker, **options)
    np.testing.assert_array_equal(both[:, :100], filter_markers(marker[:, :100], **options))
    np.testing.assert_array_equal(both[:, 150:], filter_markers(marker[:, 150:], **options))
    assert np.isnan(both[0, 100:150]).all()


def test_cleaning_fills_filters_and_tells(motion):
    recording = motion[0].copy(deep=True)
    recording["position"].loc[{"marker": "RTIB", "time": recording["time"][50:56]}] = np.nan
    recording["position"].loc[{"marker": "LASI", "time": recording["time"][80:96]}] = 0.0
    clean = clean_markers(recording, CONVENTIONAL_GAIT, PRINTED_CLEANING)
    assert list(clean["marker"].to_numpy()) == list(CONVENTIONAL_GAIT.motion_markers())
    names = list(CONVENTIONAL_GAIT.motion_markers())
    whole = clean_markers(motion[0], CONVENTIONAL_GAIT, PRINTED_CLEANING)
    apart = np.linalg.norm((clean - whole)["position"].to_numpy(), axis=1)
    assert apart[names.index("RTIB")].max() < 2e-3
    assert apart[names.index("LASI")].max() < 1e-6
    told = {f.place: f.found for f in findings_from_json(clean.attrs["findings"])}
    assert told == {
        "RTIB, t = 0.25 s": "6 frames, filled (smooth)",
        "LASI, t = 0.40 s": "16 frames, filled (rigid)",
    }


def test_laboratory_axes(motion):
    """y up and z to the right, as in many laboratories."""
    recording = motion[0]
    there = recording["position"].to_numpy()
    lab = np.stack([there[:, 0], there[:, 2], -there[:, 1]], axis=1)
    turned = recording.assign(position=recording["position"].copy(data=lab))
    back = in_world_axes(turned, ("x", "-z", "y"))
    np.testing.assert_allclose(back["position"], there)
    with pytest.raises(RecordingError, match="right-handed"):
        in_world_axes(turned, ("x", "z", "y"))
