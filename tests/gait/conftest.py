from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import pandas as pd
import pytest

from swaystride.gait.segment_signals import SegmentSignals
from swaystride.simulate.running_body import runner_body, usual_shares, usual_shoe
from swaystride.simulate.running_manner import USUAL_VARIABILITY, RunnerManner, steady_run
from swaystride.simulate.running_recording import ideal_signals, recorded
from swaystride.simulate.running_run import Treadmill, run_motion
from swaystride.simulate.running_sensors import USUAL_MOUNTING, sensor_places, wear_sensors
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


@dataclass(frozen=True)
class ThirteenImus:
    """Thirteen sensors of a simulated runner, turned into anatomical axes by their true mounting.

    ``ideal`` are the signals of perfect sensors at the same points, ``events`` the true ones, and
    ``rate_z`` the true rates of the bones about their medio-lateral axes.
    """

    rate_hz: float
    speed_m_s: float
    signals: dict[str, SegmentSignals]
    feet_as_worn: dict[str, SegmentSignals]
    ideal: dict[str, np.ndarray]
    events: pd.DataFrame
    rate_z: np.ndarray
    joint_angles_rad: dict[str, np.ndarray]
    foot_path_m: dict[str, np.ndarray]


@pytest.fixture(scope="session")
def thirteen_imus() -> Callable[..., ThirteenImus]:
    """Runs overground by speed in km/h, with soft tissue or with sensors on bone."""

    @cache
    def of(speed_km_h: float, tissue: bool = True, duration_s: float = 25.0) -> ThirteenImus:
        rng = np.random.default_rng(round(10 * speed_km_h))
        body = runner_body(1.72, 70.0, shares=usual_shares(), shoe=usual_shoe())
        speed = speed_km_h / 3.6
        motion = run_motion(
            body,
            RunnerManner(),
            steady_run(duration_s, speed),
            duration_s=duration_s,
            variability=USUAL_VARIABILITY,
            rng=rng,
        )
        names = tuple(sensor_places())
        worn = wear_sensors(
            body,
            names,
            mounting=USUAL_MOUNTING,
            tissue=usual_tissue() if tissue else {},
            common=common_tissue(rng),
            rng=rng,
        )
        (chunk,) = recorded(motion, worn, rate_hz=500.0, rng=rng, chunk_s=duration_s)
        turned = [unit.r_sensor_from_body.T for unit in worn.units]
        acc, gyr = chunk.acc_m_s2.astype(float), chunk.gyr_rad_s.astype(float)
        n = acc.shape[2]
        states = motion.states(np.arange(n) / 500.0)
        ideal = ideal_signals(motion, worn.skin, 500.0, 0, n)
        feet = {"right": names.index("foot_right"), "left": names.index("foot_left")}
        return ThirteenImus(
            500.0,
            speed,
            {
                name: SegmentSignals(r @ acc[k], r @ gyr[k])
                for k, (name, r) in enumerate(zip(names, turned, strict=True))
            },
            {side: SegmentSignals(acc[k], gyr[k]) for side, k in feet.items()},
            dict(zip(names, ideal, strict=True)),
            _true_events(motion),
            states.omega_rad_s[:, :, 2].T,
            states.joint_angles_rad(),
            {side: states.position_m[:, 5 + k].T for k, side in enumerate(("right", "left"))},
        )

    return of


def _true_events(motion) -> pd.DataFrame:
    """First touches, each with the toe-off that follows."""
    tables = []
    for k, side in enumerate(("right", "left")):
        contact, off = motion.contacts_s(k)
        after = np.append(off, np.nan)[np.searchsorted(off, contact)]
        columns = {"initial_contact_s": contact, "toe_off_s": after}
        tables.append(pd.DataFrame({"side": side, **columns}))
    return pd.concat(tables).sort_values("initial_contact_s", ignore_index=True)
