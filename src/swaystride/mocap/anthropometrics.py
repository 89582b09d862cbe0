"""Lengths and widths that are measured on the person, and whether they can be right."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import Side

#: Lengths that an adult can have, m; [N] wide around the 5th to 95th percentile.
LEG_RANGE_M: Final = (0.65, 1.15)
KNEE_RANGE_M: Final = (0.07, 0.17)
ANKLE_RANGE_M: Final = (0.04, 0.12)
#: Largest relative difference of the entered leg length and the markers' (anterior spine to
#: lateral malleolus), and of the two legs [N].
LEG_AGREEMENT: Final = 0.08


@dataclass(frozen=True)
class Anthropometrics:
    """Measures of a person; pairs are right, left.

    Parameters
    ----------
    leg_length_m : tuple of float
        Anterior superior iliac spine to medial malleolus.
    knee_width_m, ankle_width_m : tuple of float
        Between the epicondyles and between the malleoli.
    marker_radius_m : float
        Radius of the markers.
    base_plate_m : float
        Thickness of what is between marker and skin.
    """

    leg_length_m: tuple[float, float]
    knee_width_m: tuple[float, float]
    ankle_width_m: tuple[float, float]
    marker_radius_m: float
    base_plate_m: float

    def check(self, file: str = "") -> None:
        """Refuse what no adult has, which is mostly a wrong unit.

        Parameters
        ----------
        file : str
            Where the measures come from, for the error.

        Raises
        ------
        RecordingError
            With the measure that cannot be right.
        """
        for name, pair, (low, high) in (
            ("leg_length_m", self.leg_length_m, LEG_RANGE_M),
            ("knee_width_m", self.knee_width_m, KNEE_RANGE_M),
            ("ankle_width_m", self.ankle_width_m, ANKLE_RANGE_M),
        ):
            for side, value in zip(("right", "left"), pair, strict=True):
                if not low <= value <= high:
                    raise RecordingError(
                        "a measure of the person cannot be right",
                        file=file or None,
                        place=f"{name}, {side}",
                        expected=f"{low:g} to {high:g} m",
                        found=f"{value:g}",
                    )

    def check_leg(self, side: Side, marker_leg_m: float, file: str = "") -> None:
        """Refuse a leg length that contradicts the markers of the static trial.

        Parameters
        ----------
        side : {"right", "left"}
        marker_leg_m : float
            Distance of the markers on anterior spine and lateral malleolus in standing.
        file : str
            The static trial, for the error.

        Raises
        ------
        RecordingError
            If both differ by more than :data:`LEG_AGREEMENT`.
        """
        entered = self.leg_length_m[0 if side == "right" else 1]
        if abs(entered / marker_leg_m - 1.0) > LEG_AGREEMENT:
            raise RecordingError(
                "leg length contradicts the markers",
                file=file or None,
                place=f"{side} leg",
                expected=f"within {LEG_AGREEMENT:.0%} of {marker_leg_m:.3f} m "
                "(anterior spine to lateral malleolus)",
                found=f"{entered:.3f} m",
            )
