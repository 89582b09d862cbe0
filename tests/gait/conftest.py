from dataclasses import dataclass

import numpy as np
import pytest

from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import USUAL_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_recording import recorded
from swaystride.simulate.running_run import Treadmill, run_motion
from swaystride.simulate.running_sensors import USUAL_MOUNTING, wear_sensors
from swaystride.simulate.running_tissue import common_tissue, usual_tissue


@dataclass(frozen=True)
class RunningFoot:
    """Foot sensor of a simulated runner at 14 km/h, and the true events."""

    rate_hz: float
    acc: np.ndarray
    gyr: np.ndarray
    pitch: np.ndarray
    contact_s: np.ndarray
    toe_off_s: np.ndarray


@pytest.fixture(scope="session")
def running_feet() -> list[RunningFoot]:
    rng = np.random.default_rng(14)
    body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
    motion = run_motion(
        body,
        RunnerManner(),
        steady_run(15.0, 14.0 / 3.6),
        duration_s=15.0,
        variability=USUAL_VARIABILITY,
        rng=rng,
        treadmill=Treadmill(0.02),
    )
    sensors = wear_sensors(
        body,
        ("foot_right", "foot_left"),
        mounting=USUAL_MOUNTING,
        tissue=usual_tissue(),
        common=common_tissue(rng),
        rng=rng,
    )
    (chunk,) = recorded(motion, sensors, rate_hz=200.0, rng=rng)
    omega = motion.states(np.arange(chunk.acc_m_s2.shape[2]) / 200.0).omega_rad_s
    return [
        RunningFoot(
            200.0,
            np.linalg.norm(chunk.acc_m_s2[side].astype(float), axis=0),
            chunk.gyr_rad_s[side].astype(float),
            omega[:, 5 + side, 2],
            *motion.contacts_s(side),
        )
        for side in range(2)
    ]
