"""Description of the way of one foot: where and how it stands, stance after stance."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FootStances:
    """All stances of one foot from rest to rest, and the swings between them.

    Every field has the shape (n_stances,). The first stance is the rest before the first step, the
    last one the rest behind the last; what a rest does not have is NaN (the contact of the first,
    heel-off, toe-off and the swing of the last).

    Parameters
    ----------
    contact_s, arrest_s : ndarray
        First touch, and the duration of the arrest of the foot that it starts.
    flat_s, heel_off_s, toe_off_s : ndarray
        When the sole lies as flat as it will, when the heel begins to rise, and the last touch.
    x_m, y_m, heading_rad : ndarray
        Ankle of the level foot and direction of the foot on the ground (x forward, y left,
        counter-clockwise positive).
    contact_pitch_rad, contact_rate_rad_s : ndarray
        Pitch (toes up positive) at first touch, and its rate.
    flat_pitch_rad, quiet_rate_rad_s : ndarray
        Pitch at `flat_s`, and the slowest (positive) rate at which the heel rises after it.
    toe_off_pitch_rad, toe_off_rate_rad_s : ndarray
        Pitch at the last touch, and its rate.
    contact_roll_rad, flat_roll_rad, toe_off_roll_rad : ndarray
        Roll about the direction of the foot, right edge down positive.
    impact_forward_m_s, impact_down_m_s : ndarray
        Velocity of the ankle at first touch.
    swing_pitch_rad, swing_pitch_time : ndarray
        Lowest pitch of the swing that follows, and when it is reached (share of the swing).
    swing_roll_rad, swing_turn_rad : ndarray
        Roll in the middle of the swing, and how far the heading turns out and back meanwhile.
    rise_time, rise_clearance_m, late_clearance_m : ndarray
        How far the sole clears the ground at a share of the swing, and late in it.
    forward_share : ndarray
        Share of the way of the swing that is done in the middle of its time.
    """

    contact_s: Array
    arrest_s: Array
    flat_s: Array
    heel_off_s: Array
    toe_off_s: Array
    x_m: Array
    y_m: Array
    heading_rad: Array
    contact_pitch_rad: Array
    contact_rate_rad_s: Array
    flat_pitch_rad: Array
    quiet_rate_rad_s: Array
    toe_off_pitch_rad: Array
    toe_off_rate_rad_s: Array
    contact_roll_rad: Array
    flat_roll_rad: Array
    toe_off_roll_rad: Array
    impact_forward_m_s: Array
    impact_down_m_s: Array
    swing_pitch_rad: Array
    swing_pitch_time: Array
    swing_roll_rad: Array
    swing_turn_rad: Array
    rise_time: Array
    rise_clearance_m: Array
    late_clearance_m: Array
    forward_share: Array

    def __len__(self) -> int:
        """Number of stances, both rests included."""
        return len(self.x_m)

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """Names of the fields."""
        return tuple(field.name for field in fields(cls))
