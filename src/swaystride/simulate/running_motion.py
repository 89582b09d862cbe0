"""Motion of a whole runner: compact, exact, and evaluated at any times.

What is stored are parameters of the steps and pieces of the feet; poses of all segments with their
velocities and accelerations are computed on demand. Pelvis and feet are closed form, legs follow by
two-link inverse kinematics, all else by recursion along the chain.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.lower_limb_joints import SEGMENTS as LOWER_LIMB_SEGMENTS
from swaystride.lower_limb_joints import lower_limb_angles
from swaystride.simulate._running_coordinates import impact_pulse
from swaystride.simulate._running_kernel import BodyTables
from swaystride.simulate._running_points import segment_states
from swaystride.simulate.foot_motion import FootMotion
from swaystride.simulate.foot_spline import PiecewiseQuintic
from swaystride.simulate.running_body import SEGMENTS, RunnerBody
from swaystride.simulate.running_phases import PhaseTables
from swaystride.simulate.running_steps import RunPath

Array = NDArray[np.float64]

#: What an impact starts: frequency (Hz), damping, delay, rise, begin and end of fading (s).
#: Pelvis and head as in spec §9.1 step 7, soft tissue of thigh, shank and pelvis as in its table;
#: rises and fading are [N].
_PULSES: Final = (
    (13.5, 0.4, 0.010, 0.02, 0.30, 0.42),
    (7.0, 0.4, 0.020, 0.04, 0.30, 0.42),
    (12.0, 0.25, 0.005, 0.02, 0.30, 0.42),
    (18.0, 0.25, 0.0, 0.015, 0.30, 0.42),
    (15.0, 0.25, 0.010, 0.02, 0.30, 0.42),
)

#: Joints as (name, proximal, distal) rows of the segments, in the order of the filter (spec §0.2).
JOINTS: Final = (
    ("hip_right", 0, 1),
    ("hip_left", 0, 2),
    ("knee_right", 1, 3),
    ("knee_left", 2, 4),
    ("ankle_right", 3, 5),
    ("ankle_left", 4, 6),
)


@dataclass(frozen=True)
class BodyStates:
    """Segments at some times; the axis of the segments follows ``SEGMENTS``.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Times.
    r_world_from_segment : ndarray, shape (n, 13, 3, 3)
        Orientations.
    omega_rad_s, alpha_rad_s2 : ndarray, shape (n, 13, 3)
        Angular velocity and acceleration in axes of the segment.
    position_m, velocity_m_s, acceleration_m_s2 : ndarray, shape (n, 13, 3)
        Of the proximal joint (pelvis: midway between the hips; foot: ankle), in the world; on a
        treadmill the world is the frame of the belt.
    belt_m_s2 : ndarray, shape (n,)
        Acceleration of the frame of the belt against the laboratory, along x; zero overground.
    """

    time_s: Array
    r_world_from_segment: Array
    omega_rad_s: Array
    alpha_rad_s2: Array
    position_m: Array
    velocity_m_s: Array
    acceleration_m_s2: Array
    belt_m_s2: Array

    def point_m(self, segment: int, point_m: ArrayLike) -> Array:
        """Position in the world of a point given in axes of a segment, shape (n, 3)."""
        r = self.r_world_from_segment[:, segment]
        return np.asarray(self.position_m[:, segment] + r @ np.asarray(point_m, dtype=np.float64))

    def joint_angles_rad(self) -> dict[str, Array]:
        """ISB joint angles with clinical signs, alike on both sides.

        Returns
        -------
        dict of str to ndarray, shape (n, 3)
            For every joint of :data:`JOINTS` flexion (dorsiflexion), adduction (varus, inversion)
            and internal rotation; methods, section 1.8.
        """
        # JOINTS and the first seven segments stand in the order of the definition
        angles = lower_limb_angles(self.r_world_from_segment[:, : len(LOWER_LIMB_SEGMENTS)])
        return {name: angles[:, row] for row, (name, _, _) in enumerate(JOINTS)}


@dataclass(frozen=True)
class RunningMotion:
    """Motion of all segments over a recording.

    Parameters
    ----------
    body : RunnerBody
        Of whom.
    duration_s : float
        Length of the recording; it begins at time 0.
    feet : tuple of FootMotion, or None
        Right and left, as they were built; a motion that was read from a file has its tables only.
    tables : BodyTables
        What the kernel reads.
    belt : PiecewiseQuintic
        What the belt does beyond its mean speed, in m.
    belt_speed_m_s : float
        Mean speed of the belt; 0 overground.
    """

    body: RunnerBody
    duration_s: float
    feet: tuple[FootMotion, FootMotion] | None
    tables: BodyTables
    belt: PiecewiseQuintic
    belt_speed_m_s: float

    def states(self, time_s: ArrayLike) -> BodyStates:
        """All segments at any times.

        Parameters
        ----------
        time_s : array_like, shape (n,)
            Times, in any order.

        Returns
        -------
        BodyStates
        """
        time = np.asarray(time_s, dtype=np.float64)
        order = np.argsort(time, kind="stable")
        _, states, _, belt = segment_states(self.tables, time[order])
        back = np.argsort(order, kind="stable")
        rows, belt = states[back, : len(SEGMENTS)], belt[back]
        n = len(time)
        return BodyStates(
            time_s=time,
            r_world_from_segment=rows[..., :9].reshape(n, -1, 3, 3),
            omega_rad_s=rows[..., 9:12],
            alpha_rad_s2=rows[..., 12:15],
            position_m=rows[..., 15:18],
            velocity_m_s=rows[..., 18:21],
            acceleration_m_s2=rows[..., 21:24],
            belt_m_s2=belt,
        )

    def belt_way_m(self, time_s: ArrayLike) -> Array:
        """How far the belt has gone under the runner: subtract it for laboratory coordinates."""
        time = np.asarray(time_s, dtype=np.float64)
        return np.asarray(self.belt_speed_m_s * time + self.belt(time)[0])

    def contacts_s(self, side: int) -> tuple[Array, Array]:
        """First and last touches within the recording, of the right (0) or left (1) foot.

        Returns
        -------
        contact_s, toe_off_s : ndarray
            Instants between the begin and the end of the recording; not necessarily in pairs.
        """
        inside = []
        for column in range(2):
            instants = self.tables.stances[side, :, column]
            inside.append(instants[(instants >= 0.0) & (instants <= self.duration_s)])
        return inside[0], inside[1]


def assembled(
    body: RunnerBody,
    *,
    duration_s: float,
    feet: tuple[FootMotion, FootMotion],
    path: RunPath,
    pelvis: Array,
    phases: tuple[PhaseTables, PhaseTables, PhaseTables],
    belt: PiecewiseQuintic | None = None,
    belt_speed_m_s: float = 0.0,
) -> RunningMotion:
    """Motion from its parts.

    Parameters
    ----------
    body : RunnerBody
        Lengths.
    duration_s : float
        Length of the recording.
    feet : tuple of FootMotion
        Right and left.
    path : RunPath
        Way of the hips over ground or belt.
    pelvis : ndarray, shape (n, 7)
        Steps of the pelvis.
    phases : tuple of PhaseTables
        Coordinates that follow the right leg, the left leg, and the steps of both.
    belt : PiecewiseQuintic, optional
        What the belt does beyond its mean speed, in m.
    belt_speed_m_s : float
        Mean speed of the belt.

    Returns
    -------
    RunningMotion
    """
    if belt is None:
        belt = PiecewiseQuintic(np.zeros(1), np.zeros((1, 6)))
    joints = np.zeros((len(SEGMENTS) + 1, 3))
    joints[: len(SEGMENTS)] = body.joints_m()
    sole = body.sole
    tables = BodyTables(
        joints=joints,
        links=np.array([body.thigh_m, body.shank_m]),
        path=_stacked([_rows(p) for p in (path.x, path.y, path.heading, belt)], np.inf),
        steps=np.ascontiguousarray(pelvis),
        pulses=_pulses(),
        strength=_stacked([p.strength for p in phases]),
        contact_s=_stacked([p.contact_s[:, None] for p in phases], np.inf)[..., 0].copy(),
        phase=_stacked([_rows(p.phase) for p in phases], np.inf),
        offset=_stacked([p.offset for p in phases]),
        amplitude=_stacked([p.amplitude for p in phases]),
        fourier=np.stack([_with_highest(p.fourier) for p in phases]),
        pieces=_foot_pieces(feet),
        stances=_stacked([_stance_rows(foot) for foot in feet], np.inf),
        sole=np.array([*sole._constants, sole.corner_radius_m]),
        edges=np.array(
            [(e.angle_rad, e.length_m, e.half_width_rad) for e in sole.edges], dtype=np.float64
        ).reshape(-1, 3),
    )
    return RunningMotion(body, duration_s, feet, tables, belt, belt_speed_m_s)


@cache
def _pulses() -> Array:
    """Pulses of unit size: peak upward acceleration for pelvis and head, displacement for tissue."""
    rows = np.array([(*pulse, 1.0) for pulse in _PULSES])
    since = np.arange(0.0, 0.2, 2e-4)
    for kind, order in enumerate((2, 2, 0, 0, 0)):
        rows[kind, 6] = 1.0 / max(impact_pulse(rows, kind, t)[order] for t in since)
    return rows


def _rows(pieces: PiecewiseQuintic) -> Array:
    """Start and coefficients side by side, shape (n, 7)."""
    return np.column_stack([pieces.start_s, pieces.coefficients])


def _stacked(tables: list[Array], begin: float | None = None) -> Array:
    """Tables of unequal length, padded with their last row, which then begins at `begin`."""
    longest = max(len(table) for table in tables)
    padded = []
    for table in tables:
        more = np.repeat(table[-1:], longest - len(table), axis=0)
        if begin is not None:
            more[:, 0] = begin
        padded.append(np.concatenate([table, more]))
    return np.stack(padded)


def _with_highest(fourier: Array) -> Array:
    """Coefficients and the number of the highest harmonic that is there, shape (n, 13)."""
    there = np.any(fourier.reshape(len(fourier), 6, 2) != 0.0, axis=2)
    highest = np.max(np.where(there, np.arange(1, 7), 0), axis=1)
    return np.column_stack([fourier, highest])


def _foot_pieces(feet: tuple[FootMotion, FootMotion]) -> Array:
    """Pieces of x, y, z, heading, roll and pitch of both feet, shape (2, 6, n, 7)."""
    tables = [
        _rows(pieces)
        for foot in feet
        for pieces in (*foot.swing, foot.heading, foot.roll, foot.pitch)
    ]
    stacked = _stacked(tables, np.inf)
    return stacked.reshape(2, 6, *stacked.shape[1:])


def _stance_rows(motion: FootMotion) -> Array:
    """Contact, toe-off, arrest, place and excess velocity of every stance, shape (n, 8)."""
    stances = motion.stances
    return np.column_stack(
        [
            np.where(np.isnan(stances.contact_s), -np.inf, stances.contact_s),
            np.where(np.isnan(stances.toe_off_s), np.inf, stances.toe_off_s),
            np.where(np.isnan(stances.arrest_s), 0.0, stances.arrest_s),
            stances.x_m,
            stances.y_m,
            motion.excess_m_s.T,
        ]
    )
