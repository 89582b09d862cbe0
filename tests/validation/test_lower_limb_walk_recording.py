"""Reader of the walking trial, on files written from the rigid chain."""

import numpy as np
import pandas as pd
import pytest
from rigid_chain import chain
from scipy.spatial.transform import Rotation

from swaystride.errors import RecordingError
from swaystride.validation.lower_limb_imu_vicon_walk import angles_deg, optical_mounting
from swaystride.validation.lower_limb_walk_recording import read_walk

SERIALS = ["00B40B91", "00B40C3C", "00B40C45", "00B40C35", "00B40BA5", "00B40C48", "00B40C55"]
SEGMENTS = ["RPV", "RTH", "LTH", "RSK", "LSK", "RFT", "LFT"]
CENTRES = {"right_hip": "RFEP", "left_hip": "LFEP", "right_knee": "RFEO", "left_knee": "LFEO"}
FIRST, LAG = 120, 3


@pytest.fixture(scope="module")
def moving():
    return chain(duration_s=8.0, rate_hz=100.0)


@pytest.fixture
def folder(moving, tmp_path):
    """Optical frames run from sample FIRST on, and the sensors lag by LAG samples."""
    (tmp_path / "rawimu").mkdir()
    (tmp_path / "vicon").mkdir()
    for j, serial in enumerate(SERIALS):
        frame = pd.DataFrame({"PacketCounter": 500 + np.arange(moving.acc.shape[2])})
        for kind, signal in (("Acc", moving.acc[j]), ("Gyr", moving.gyr[j])):
            for axis, values in zip("XYZ", signal, strict=True):
                frame[f"{kind}_{axis}"] = values
        path = tmp_path / "rawimu" / f"S02_{serial}.txt"
        path.write_text("// Update Rate: 100.0Hz\n" + frame.to_csv(index=False), encoding="utf-8")
    write_optical(moving, tmp_path / "vicon" / "S02.csv", f"// idx={FIRST + 1},900\n")
    return tmp_path


def truth(moving):
    """Anatomical orientations of the optical frames."""
    mounting = moving.body.r_anatomical_from_sensor
    return (moving.rotation @ np.swapaxes(mounting, 1, 2))[FIRST + LAG : -20]


def write_optical(moving, path, header):
    anatomical = truth(moving)
    table = {}
    for j, name in enumerate(SEGMENTS):
        x, y, z = np.moveaxis(anatomical[:, j], 2, 0)
        # a leg has x forward, y left, z up; a foot x down, y left, z forward
        axes = (-y, -z, x) if name.endswith("FT") else (x, -z, y)
        q = Rotation.from_matrix(np.stack(axes, axis=2)).as_quat(scalar_first=True)
        table |= {f"q{name}_{i + 1}": q[:, i] for i in range(4)}
    for code in (*CENTRES.values(), "RTIO", "LTIO"):
        table |= {f"{code}_{i + 1}": np.full(len(anatomical), float(i)) for i in range(3)}
    path.write_text(header + pd.DataFrame(table).to_csv(index=False), encoding="utf-8")


def test_frames_lag_and_angles(folder, moving):
    walk = read_walk(folder)
    assert (walk.first, walk.lag) == (FIRST + LAG, LAG)
    np.testing.assert_allclose(walk.rotation, truth(moving), atol=1e-9)
    assert walk.centres_m["left_knee"][5].tolist() == [0.0, 1.0, 2.0]
    np.testing.assert_array_equal(walk.gyr_rad_s[6], moving.gyr[6])
    expected = np.degrees(moving.angles[FIRST + LAG : -20])
    np.testing.assert_allclose(angles_deg(walk.rotation), expected, atol=1e-9)


def test_mounting_is_found_whatever_the_heading(moving):
    heading = Rotation.from_euler("z", 73.0, degrees=True).as_matrix()
    anatomical = moving.rotation[:, 3] @ moving.body.r_anatomical_from_sensor[3].T
    turned, found = optical_mounting(anatomical, heading @ moving.rotation[:, 3])
    assert np.degrees(turned) == pytest.approx(-73.0, abs=1e-9)
    np.testing.assert_allclose(found, moving.body.r_anatomical_from_sensor[3], atol=1e-9)


def test_a_lost_packet_is_an_error(folder):
    path = folder / "rawimu" / f"S02_{SERIALS[2]}.txt"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines[:50] + lines[51:]), encoding="utf-8")
    with pytest.raises(RecordingError, match=r"00B40C45\.txt: row 49: lost packets"):
        read_walk(folder)


def test_sensors_of_different_length_are_an_error(folder):
    path = folder / "rawimu" / f"S02_{SERIALS[2]}.txt"
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(lines[:-1]), encoding="utf-8")
    with pytest.raises(RecordingError, match="do not start and end together"):
        read_walk(folder)


def test_missing_parts_are_errors(folder, moving):
    path = folder / "vicon" / "S02.csv"
    write_optical(moving, path, "// fs=100\n")
    with pytest.raises(RecordingError, match="no synchronisation; expected a line"):
        read_walk(folder)
    text = path.read_text(encoding="utf-8").replace("qLSK_2", "other")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(RecordingError, match="missing columns; expected qLSK_2"):
        read_walk(folder)
    (folder / "rawimu" / f"S02_{SERIALS[0]}.txt").unlink()
    with pytest.raises(RecordingError, match=r"file not found; expected one \*_00B40B91\.txt"):
        read_walk(folder)
