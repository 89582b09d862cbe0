"""Joint angles from markers: exact on rigid segments, alike on both sides, independent of the room."""

from dataclasses import replace

import numpy as np
import optical_person
import pytest
from optical_person import BODY, HIPS_M

from swaystride.errors import RecordingError
from swaystride.findings import findings_from_json
from swaystride.lower_limb_joints import JOINT_NAMES
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT
from swaystride.mocap.optical_angles import optical_joint_angles
from swaystride.mocap.static_calibration import OpticalOptions
from swaystride.rotations import exp_map


def angles(recording, static, markers, options, axes, hips=HIPS_M):
    return optical_joint_angles(
        recording, static, BODY, markers=markers, options=options, axes=axes, hip_centres_m=hips
    )


def noisy(recording, rng, size_m=0.01):
    position = recording["position"]
    return recording.assign(position=position + size_m * rng.standard_normal(position.shape))


def moved(recording, r, shift_m):
    turned = np.einsum("ab,mbt->mat", r, recording["position"].to_numpy())
    turned = turned + np.asarray(shift_m)[None, :, None]
    return recording.assign(position=recording["position"].copy(data=turned))


@pytest.mark.parametrize("frames", ["axes", "least_squares"])
def test_rigid_trios_give_the_true_angles_and_centres(static, motion, own_axes, frames):
    recording, truth = motion
    options = OpticalOptions("average_axes", frames, True, "malleoli")
    found = angles(recording, static, CONVENTIONAL_GAIT, options, own_axes)
    np.testing.assert_allclose(
        found["joint_angle"].transpose("time", "joint", "angle"), truth, atol=1e-9
    )
    knee = found["joint_centre"].sel(joint="left_knee").to_numpy()
    medial = recording["position"].sel(marker=["LKNE", "LKNM"]).mean("marker").to_numpy()
    np.testing.assert_allclose(knee, medial, atol=1e-9)


def test_rigid_clusters_give_the_true_angles(static, motion, clusters):
    recording, truth = motion
    options = OpticalOptions("medial_markers", "least_squares", True, "malleoli")
    found = angles(recording, static, clusters, options, None)
    np.testing.assert_allclose(
        found["joint_angle"].transpose("time", "joint", "angle"), truth, atol=1e-9
    )
    assert "planar_angle" not in found


def test_planar_angles_are_those_of_the_places(static, motion, own_axes, printed):
    found = angles(motion[0], static, CONVENTIONAL_GAIT, printed, own_axes)["planar_angle"]
    hip, wand = np.zeros(3), np.array([0.01, -0.215, 0.085])
    knee = np.array([0.0, -0.43, 0.06])
    at_hip = np.arccos((wand - hip) @ knee / np.linalg.norm(wand) / np.linalg.norm(knee))
    thigh = found.sel(trio="right_thigh", vertex="first").to_numpy()
    np.testing.assert_allclose(thigh, at_hip, atol=1e-9)
    foot = found.sel(trio="left_foot", vertex="first").to_numpy()
    np.testing.assert_allclose(foot, np.arctan2(0.045, 0.145), atol=1e-9)


def test_left_and_right_are_mirror_images(static, motion, own_axes, printed, rng):
    """A mirrored room with exchanged names exchanges the legs, soft tissue and all."""
    recording, standing = noisy(motion[0], rng), noisy(static, rng, 0.003)

    def mirrored(of):
        names = [{"R": "L", "L": "R"}[name[0]] + name[1:] for name in of["marker"].to_numpy()]
        flipped = of["position"].to_numpy() * np.array([1.0, -1.0, 1.0])[None, :, None]
        return of.assign(position=of["position"].copy(data=flipped)).assign_coords(marker=names)

    hips = np.array([[-0.05, -0.08, 0.08], [-0.06, -0.07, -0.09]])
    one = angles(recording, standing, CONVENTIONAL_GAIT, printed, own_axes, hips)
    swapped = hips[::-1] * [1.0, 1.0, -1.0]
    two = angles(
        mirrored(recording), mirrored(standing), CONVENTIONAL_GAIT, printed, own_axes, swapped
    )
    other = [
        name.replace("right", "x").replace("left", "right").replace("x", "left")
        for name in JOINT_NAMES
    ]
    np.testing.assert_allclose(
        one["joint_angle"].to_numpy(), two["joint_angle"].sel(joint=other).to_numpy(), atol=1e-9
    )


@pytest.mark.parametrize("frames", ["axes", "least_squares"])
def test_the_room_does_not_matter(static, motion, own_axes, rng, frames):
    """Motion may be turned in any way; the static trial about the vertical, which it needs."""
    options = OpticalOptions("average_axes", frames, True, "malleoli")
    recording, standing = noisy(motion[0], rng), noisy(static, rng, 0.003)
    before = angles(recording, standing, CONVENTIONAL_GAIT, options, own_axes)["joint_angle"]
    after = angles(
        moved(recording, exp_map([0.7, -1.1, 0.4]), [3.0, -2.0, 1.0]),
        moved(standing, exp_map([0.0, 0.0, 2.0]), [-1.0, 5.0, 0.5]),
        CONVENTIONAL_GAIT,
        options,
        own_axes,
    )["joint_angle"]
    np.testing.assert_allclose(before, after, atol=1e-9)


def test_a_frame_without_a_marker_has_no_angles_downstream(static, motion, own_axes, printed):
    recording = motion[0].copy(deep=True)
    recording["position"].loc[{"marker": "RTIB", "time": recording["time"][100]}] = np.nan
    found = angles(recording, static, CONVENTIONAL_GAIT, printed, own_axes)["joint_angle"]
    lost = found.isel(time=100).isnull().all("angle").to_numpy()
    assert dict(zip(JOINT_NAMES, lost, strict=True)) == {
        name: name in ("right_knee", "right_ankle") for name in JOINT_NAMES
    }
    assert not found.isel(time=101).isnull().any()


def test_frames_with_a_marker_at_the_origin_do_not_count(static, motion, own_axes, printed):
    """Some systems write a lost marker at the origin of the laboratory."""
    lost = static.copy(deep=True)
    lost["position"].loc[{"marker": "RKNE", "time": static["time"][:3]}] = 0.0
    whole = angles(motion[0], static, CONVENTIONAL_GAIT, printed, own_axes)["joint_angle"]
    found = angles(motion[0], lost, CONVENTIONAL_GAIT, printed, own_axes)["joint_angle"]
    np.testing.assert_allclose(found, whole, atol=1e-9)


def test_exchanged_labels_are_found(static, motion, clusters):
    recording = motion[0]
    names = [
        {"RTOE": "RMT5", "RMT5": "RTOE"}.get(str(name), str(name))
        for name in recording["marker"].to_numpy()
    ]
    options = OpticalOptions("medial_markers", "least_squares", True, "malleoli")
    clean = angles(recording, static, clusters, options, None)
    wrong = angles(recording.assign_coords(marker=names), static, clusters, options, None)
    assert findings_from_json(clean.attrs["findings"]) == []
    (finding,) = findings_from_json(wrong.attrs["findings"])
    assert finding.check == "segment_changed_its_shape"
    assert "RHEE" in finding.place


def test_bad_input_is_told_in_one_line(static, motion, own_axes, printed, with_medial):
    recording = motion[0]

    def refused(recording=recording, static=static, markers=CONVENTIONAL_GAIT, body=BODY, **other):
        with pytest.raises(RecordingError) as caught:
            optical_joint_angles(
                recording,
                static,
                body,
                markers=markers,
                options=other.get("options", printed),
                axes=other.get("axes", own_axes),
            )
        return str(caught.value)

    assert "static trial missing" in refused(static=None)
    lost = recording.copy(deep=True)
    lost["position"].loc[{"marker": "LTIB"}] = np.nan
    assert refused(lost) == (
        "run.c3d: LTIB: marker missing throughout; "
        "expected seen in at least one frame; found in none"
    )
    assert "no such marker" in refused(recording.drop_sel(marker="RHEE"))
    assert "leg_length_m, left: a measure of the person cannot be right" in refused(
        body=replace(BODY, leg_length_m=(0.92, 920.0))
    )
    assert "right leg: leg length contradicts the markers" in refused(
        body=replace(BODY, leg_length_m=(1.05, 0.92))
    )
    assert "not quiet standing" in refused(static=recording)
    swap = {"RKNE": "LKNE", "LKNE": "RKNE"}
    names = [swap.get(str(name), str(name)) for name in static["marker"].to_numpy()]
    assert "left and right are exchanged" in refused(static=static.assign_coords(marker=names))
    for exchanged, told in (
        (("RHEE", "RTOE"), "RHEE, RTOE: markers of heel and toe are exchanged"),
        (("RHEE", "LHEE"), "RHEE, LHEE: markers of left and right are exchanged"),
    ):
        swap = dict(zip(exchanged, exchanged[::-1], strict=True))
        names = [swap.get(str(name), str(name)) for name in static["marker"].to_numpy()]
        assert told in refused(static=static.assign_coords(marker=names))
    pelvis = {"RASI": "LASI", "LASI": "RASI"}
    names = [pelvis.get(str(name), str(name)) for name in static["marker"].to_numpy()]
    assert "upside down" in refused(static=static.assign_coords(marker=names))
    assert "average joint axes missing" in refused(axes=None)
    medial = OpticalOptions("medial_markers", "axes", True, "malleoli")
    assert "no medial landmarks" in refused(options=medial)


def test_the_static_trial_may_face_anywhere(motion, own_axes, printed):
    recording, truth = motion
    standing = optical_person.standing(heading_rad=2.5)
    found = angles(recording, standing, CONVENTIONAL_GAIT, printed, own_axes)
    np.testing.assert_allclose(
        found["joint_angle"].transpose("time", "joint", "angle"), truth, atol=1e-9
    )
