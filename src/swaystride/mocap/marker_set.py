"""Which markers there are and what each is for: landmarks, and the points that track a segment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import Side
from swaystride.marker_recording import MarkerRecording, marker_positions

Array = NDArray[np.float64]
Tracking = Literal["trio", "cluster"]

SIDES: Final[tuple[Side, Side]] = ("right", "left")


@dataclass(frozen=True)
class LegMarkers:
    """Markers of one leg.

    Parameters
    ----------
    knee, ankle : str
        Lateral epicondyle and lateral malleolus.
    heel, toe : str
        Heel and second metatarsal head; their horizontal direction in standing is that of the foot.
    thigh, shank, foot : tuple of str
        Markers that track the segments in motion. For trios (wand, distal landmark) of thigh and
        shank, and (heel, toe) of the foot: the upstream joint centre is the third point.
    knee_medial, ankle_medial : str, optional
        Medial epicondyle and malleolus of the static trial.
    """

    knee: str
    ankle: str
    heel: str
    toe: str
    thigh: tuple[str, ...]
    shank: tuple[str, ...]
    foot: tuple[str, ...]
    knee_medial: str | None = None
    ankle_medial: str | None = None


@dataclass(frozen=True)
class MarkerSet:
    """Markers of pelvis and legs.

    Parameters
    ----------
    front : tuple of str
        Right and left anterior superior iliac spine.
    back : tuple of str
        Right and left posterior superior iliac spine; one sacral marker twice if there is only one.
    right, left : LegMarkers
    tracking : {"trio", "cluster"}
        ``trio``: two markers per segment and the joint centre that the upstream segment carries
        (conventional gait model). ``cluster``: at least three markers on every segment, no help
        from upstream.
    """

    front: tuple[str, str]
    back: tuple[str, str]
    right: LegMarkers
    left: LegMarkers
    tracking: Tracking

    def leg(self, side: Side) -> LegMarkers:
        """Markers of a side.

        Parameters
        ----------
        side : {"right", "left"}
        """
        return self.right if side == "right" else self.left

    @property
    def pelvis(self) -> tuple[str, ...]:
        """The markers of the pelvis, each once."""
        return tuple(dict.fromkeys(self.front + self.back))

    def motion_markers(self) -> tuple[str, ...]:
        """Markers that have to be there in motion, each once."""
        names = list(self.pelvis)
        for side in SIDES:
            leg = self.leg(side)
            names += [*leg.thigh, *leg.shank, *leg.foot]
        return tuple(dict.fromkeys(names))

    def static_markers(self, *, medial: bool) -> tuple[str, ...]:
        """Markers that have to be there in the static trial, each once.

        Parameters
        ----------
        medial : bool
            Whether the medial landmarks are used.
        """
        names = list(self.motion_markers())
        for side in SIDES:
            leg = self.leg(side)
            names += [leg.knee, leg.ankle, leg.heel, leg.toe]
            if medial:
                names += [name for name in (leg.knee_medial, leg.ankle_medial) if name]
        return tuple(dict.fromkeys(names))


def _conventional_leg(letter: str) -> LegMarkers:
    return LegMarkers(
        knee=f"{letter}KNE",
        ankle=f"{letter}ANK",
        heel=f"{letter}HEE",
        toe=f"{letter}TOE",
        thigh=(f"{letter}THI", f"{letter}KNE"),
        shank=(f"{letter}TIB", f"{letter}ANK"),
        foot=(f"{letter}HEE", f"{letter}TOE"),
    )


#: Lower body of the conventional gait model (methods §5.2).
CONVENTIONAL_GAIT: Final = MarkerSet(
    front=("RASI", "LASI"),
    back=("RPSI", "LPSI"),
    right=_conventional_leg("R"),
    left=_conventional_leg("L"),
    tracking="trio",
)


def points(recording: MarkerRecording, names: tuple[str, ...]) -> Array:
    """Positions of named markers, frame by frame; a marker missing throughout is an error.

    Parameters
    ----------
    recording : MarkerRecording
        World axes: z up.
    names : tuple of str
        In the order wanted.

    Returns
    -------
    ndarray, shape (n_markers, n_frames, 3)
        m; NaN where a marker was not seen. Exactly at the origin of the laboratory counts as not
        seen, because some systems write a lost marker there.

    Raises
    ------
    RecordingError
        If a marker is not in the recording, or in no frame of it.
    """
    position = marker_positions(recording, names).transpose(0, 2, 1).copy()
    position[(position == 0.0).all(axis=2)] = np.nan
    missing = [name for name, marker in zip(names, position, strict=True) if not _ever_seen(marker)]
    if missing:
        raise RecordingError(
            "marker missing throughout",
            file=recording.attrs["source_file"] or None,
            place=", ".join(missing),
            expected="seen in at least one frame",
            found="in none",
        )
    return np.ascontiguousarray(position)


def _ever_seen(marker: Array) -> bool:
    """Whether there is a frame with all three coordinates."""
    return bool(np.isfinite(marker).all(axis=1).any())


def in_world_axes(recording: MarkerRecording, axes: tuple[str, str, str]) -> MarkerRecording:
    """Turn the axes of a laboratory into those of the world: x forward, y left, z up.

    Parameters
    ----------
    recording : MarkerRecording
    axes : tuple of str
        Which laboratory axis, with its sign, is forward, left and up: ``("x", "-z", "y")`` for a
        laboratory with y up and z to the right.

    Returns
    -------
    MarkerRecording
        A copy.

    Raises
    ------
    RecordingError
        If the three do not make a right-handed frame.
    """
    turn = np.zeros((3, 3))
    for row, name in enumerate(axes):
        if name.lstrip("-") not in ("x", "y", "z"):
            break
        turn[row, "xyz".index(name.lstrip("-"))] = -1.0 if name.startswith("-") else 1.0
    if not np.isclose(np.linalg.det(turn), 1.0):
        raise RecordingError(
            "axes of the laboratory do not make a right-handed frame",
            file=recording.attrs["source_file"] or None,
            expected="forward, left and up, for example ('x', '-z', 'y')",
            found=str(axes),
        )
    out = recording.copy()
    turned = np.einsum("ab,mbt->mat", turn, recording["position"].to_numpy())
    out["position"] = recording["position"].copy(data=turned)
    return out
