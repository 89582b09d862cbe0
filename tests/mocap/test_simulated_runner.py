"""The simulated runner through the optical side: markers on bone, and on soft tissue with cameras."""

import numpy as np
import pytest

from swaystride.lower_limb_joints import JOINT_NAMES
from swaystride.marker_recording import make_marker_recording
from swaystride.mocap.anthropometrics import Anthropometrics
from swaystride.mocap.foot_events import RUNNING_CONTACT, foot_contacts
from swaystride.mocap.joint_axes import public_joint_axes
from swaystride.mocap.marker_cleaning import PRINTED_CLEANING, clean_markers
from swaystride.mocap.marker_gaps import PRINTED_LIMITS, fill_gaps
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT, points
from swaystride.mocap.optical_angles import optical_joint_angles
from swaystride.mocap.static_calibration import PRINTED_OPTIONS
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import NO_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_markers import USUAL_CAMERAS, filmed, wear_markers
from swaystride.simulate.running_run import Treadmill, run_motion
from swaystride.simulate.running_sensors import USUAL_MOUNTING, sensor_places, wear_sensors
from swaystride.simulate.running_standing import StandingManner, standing_motion
from swaystride.simulate.running_tissue import common_tissue, usual_tissue

RATE_HZ, SPEED_M_S, DURATION_S = 200.0, 3.9, 10.0


@pytest.fixture(scope="module")
def runner():
    """A run on a treadmill with soft tissue, camera noise and gaps, its static trial and truth."""
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    rng = np.random.default_rng(3)
    motion = run_motion(
        body,
        RunnerManner(),
        steady_run(DURATION_S, SPEED_M_S),
        duration_s=DURATION_S,
        variability=NO_VARIABILITY,
        rng=rng,
        treadmill=Treadmill(0.02),
    )
    manner = StandingManner(0.04, 0.2, 0.01, 0.1, 0.05, 0.05, 0.03, 0.2, 0.003)
    standing = standing_motion(body, manner, duration_s=3.0, rng=rng)
    worn = {"common": common_tissue(rng), "tissue": usual_tissue(), "rng": rng}
    sensors = wear_sensors(body, tuple(sensor_places()), mounting=USUAL_MOUNTING, **worn)
    markers = wear_markers(body, sensors, place_sd_m=0.004, **worn)

    def recorded(of, name):
        chunks = filmed(of, markers, rate_hz=RATE_HZ, errors=USUAL_CAMERAS, rng=rng)
        position = np.concatenate([chunk.position_m for chunk in chunks]).transpose(1, 2, 0)
        return make_marker_recording(
            position,
            markers=markers.names,
            rate_hz=RATE_HZ,
            rate_source="simulated",
            source_file=name,
        )

    return motion, recorded(motion, "run.c3d"), recorded(standing, "static.c3d")


def test_sagittal_angles_of_a_runner_with_soft_tissue(runner):
    """After one constant per angle; the knee axis of other people, 4 mm of placement."""
    motion, run, static = runner
    body = Anthropometrics((0.9, 0.9), (0.102, 0.102), (0.072, 0.072), 0.007, 0.002)
    clean = clean_markers(run, CONVENTIONAL_GAIT, PRINTED_CLEANING)
    found = optical_joint_angles(
        clean,
        static,
        body,
        markers=CONVENTIONAL_GAIT,
        options=PRINTED_OPTIONS,
        axes=public_joint_axes("pelvis_forward"),
    )
    truth = motion.states(run["time"].to_numpy()).joint_angles_rad()
    steady = slice(round(2.0 * RATE_HZ), round(9.0 * RATE_HZ))
    for name in JOINT_NAMES:
        side, kind = name.split("_")
        angle = found["joint_angle"].sel(joint=name, angle="flexion").to_numpy()
        error = np.degrees(angle - truth[f"{kind}_{side}"][:, 0])[steady]
        assert np.nanstd(error) < 3.0, name


@pytest.mark.parametrize(("letter", "side"), [("R", 0), ("L", 1)])
def test_stride_times_of_a_runner(runner, letter, side):
    """The simulated foot is stiff: toe-off is found late, but always by the same time."""
    motion, run, _ = runner
    names = (f"{letter}HEE", f"{letter}TOE")
    filled, _ = fill_gaps(
        points(run, names), names, limits=PRINTED_LIMITS, rigid=(), patterns=(names,)
    )
    found = foot_contacts(
        filled[:1],
        filled[1:],
        rate_hz=RATE_HZ,
        running_speed_m_s=SPEED_M_S,
        belt_speed_m_s=SPEED_M_S,
        rule=RUNNING_CONTACT,
    )
    for column, instants in zip(found.columns, motion.contacts_s(side), strict=True):
        ours = found[column].to_numpy()
        nearest = instants[np.argmin(np.abs(ours[:, None] - instants), axis=1)]
        error = ours - nearest
        assert np.abs(error).max() < 0.04
        assert np.std(error) < 0.002
    assert len(found) >= len(motion.contacts_s(side)[0]) - 3
