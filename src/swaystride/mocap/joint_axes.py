"""Average knee and ankle axes of other people, and the joint centres that follow (methods §5.5).

A person without medial markers gets the joint axis of the average of people who had them. The axis
is given in a frame of lateral markers. The figure that shows that frame is lost; its caption names
posterior spine, lateral knee and lateral ankle, which is the recipe ``spine_plane`` [N]. Its forward
direction turns by degrees with the few centimetres by which a knee is before or behind the spine;
``pelvis_forward`` does not have that lever. Coordinates are (anterior, up, outward) on both sides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from io import StringIO
from typing import Final, Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.lower_limb_joints import Side
from swaystride.marker_recording import MarkerRecording
from swaystride.mocap.marker_set import SIDES, MarkerSet, points
from swaystride.mocap.segment_frames import across, frame_of, pelvis_frame, unit

Array = NDArray[np.float64]
Recipe = Literal["spine_plane", "pelvis_forward"]

RECIPES: Final[tuple[Recipe, Recipe]] = ("spine_plane", "pelvis_forward")
#: Fewer people than this have no usable standard deviation; then ±5 mm [N] (methods §5.8).
LEAST_PEOPLE: Final = 5
FALLBACK_SHIFT_M: Final = 0.005


@dataclass(frozen=True, eq=False)
class JointAxes:
    """Average axes from the lateral to the medial landmark.

    Parameters
    ----------
    knee, ankle : ndarray, shape (3,)
        Unit vectors (anterior, up, outward) in the knee and the ankle axis frame.
    knee_sd, ankle_sd : ndarray, shape (3,)
        Standard deviation over people of the components; NaN for one person.
    n_people : int
        How many people were averaged.
    source : str
        Who they were.
    recipe : {"spine_plane", "pelvis_forward"}
        Of the knee axis frame: x across the plane of shank and posterior spine, or forward with the
        pelvis.
    """

    knee: Array
    ankle: Array
    knee_sd: Array
    ankle_sd: Array
    n_people: int
    source: str
    recipe: Recipe

    def centre_shift_m(self, joint: str, distance_m: float) -> Array:
        """Scatter of a centre between people, for the perturbation (methods §5.8).

        Parameters
        ----------
        joint : {"knee", "ankle"}
        distance_m : float
            From the lateral marker to the centre.

        Returns
        -------
        ndarray, shape (3,)
            Along (anterior, up, outward); ±5 mm each where fewer than five people are at hand.
        """
        if self.n_people < LEAST_PEOPLE:
            return np.full(3, FALLBACK_SHIFT_M)
        return distance_m * (self.knee_sd if joint == "knee" else self.ankle_sd)


def knee_axis_basis(
    knee: Array, ankle: Array, spine: Array, forward: Array, side: Side, recipe: Recipe
) -> Array:
    """Basis of the knee axis: y along the shank markers, x forward by one of two recipes.

    Parameters
    ----------
    knee, ankle, spine : ndarray, shape (n, 3)
        Lateral epicondyle, lateral malleolus, posterior superior iliac spine of the side.
    forward : ndarray, shape (n, 3)
        Of the pelvis.
    side : {"right", "left"}
    recipe : {"spine_plane", "pelvis_forward"}

    Returns
    -------
    ndarray, shape (n, 3, 3)
        Columns anterior, up, outward (a mirrored basis on the left).
    """
    y = unit(knee - ankle)
    if recipe == "pelvis_forward":
        return _with_outward(across(forward, y), y, side)
    x = unit(np.cross(y, unit(knee - spine)))
    x = x * np.sign(np.sum(x * forward, axis=-1, keepdims=True))
    return _with_outward(x, y, side)


def ankle_axis_basis(knee: Array, ankle: Array, heel: Array, toe: Array, side: Side) -> Array:
    """Basis of the ankle axis: y along the shank markers, x along the foot.

    Parameters
    ----------
    knee, ankle, heel, toe : ndarray, shape (n, 3)
    side : {"right", "left"}

    Returns
    -------
    ndarray, shape (n, 3, 3)
        Columns anterior, up, outward (a mirrored basis on the left).
    """
    y = unit(knee - ankle)
    return _with_outward(across(toe - heel, y), y, side)


def _with_outward(x: Array, y: Array, side: Side) -> Array:
    right = np.cross(x, y)
    return frame_of(x, y, right if side == "right" else -right)


def axis_bases(
    static: MarkerRecording, markers: MarkerSet, side: Side, recipe: Recipe
) -> tuple[Array, Array]:
    """Knee and ankle axis bases of a static trial.

    Parameters
    ----------
    static : MarkerRecording
    markers : MarkerSet
    side : {"right", "left"}
    recipe : {"spine_plane", "pelvis_forward"}

    Returns
    -------
    knee_basis, ankle_basis : ndarray, shape (n, 3, 3)
    """
    pelvis = points(static, (*markers.front, *markers.back))
    forward = pelvis_frame(pelvis[:2], pelvis[2:])[0][..., 0]
    leg = markers.leg(side)
    knee, ankle, heel, toe = points(static, (leg.knee, leg.ankle, leg.heel, leg.toe))
    spine = pelvis[2 if side == "right" else 3]
    return (
        knee_axis_basis(knee, ankle, spine, forward, side, recipe),
        ankle_axis_basis(knee, ankle, heel, toe, side),
    )


def person_axes(static: MarkerRecording, markers: MarkerSet, recipe: Recipe) -> Array:
    """Axes of a person with medial markers, mean of both sides.

    Parameters
    ----------
    static : MarkerRecording
    markers : MarkerSet
        With ``knee_medial`` and ``ankle_medial``.
    recipe : {"spine_plane", "pelvis_forward"}

    Returns
    -------
    ndarray, shape (2, 3)
        Unit vectors of knee and ankle, (anterior, up, outward).

    Raises
    ------
    RecordingError
        If the marker set has no medial landmarks or one is missing throughout.
    """
    sides = []
    for side in SIDES:
        leg = markers.leg(side)
        if leg.knee_medial is None or leg.ankle_medial is None:
            raise RecordingError(
                "no medial landmarks",
                file=static.attrs["source_file"] or None,
                expected="markers on the medial epicondyle and malleolus",
                found="none in the marker set",
            )
        lateral = points(static, (leg.knee, leg.ankle))
        medial = points(static, (leg.knee_medial, leg.ankle_medial))
        bases = np.stack(axis_bases(static, markers, side, recipe))
        local = np.einsum("jnba,jnb->jna", bases, unit(medial - lateral))
        sides.append(unit(np.nanmean(local, axis=1)))
    return unit(np.mean(sides, axis=0))


def average_joint_axes(people: Sequence[Array], source: str, recipe: Recipe) -> JointAxes:
    """Average over people.

    Parameters
    ----------
    people : sequence of ndarray, shape (2, 3)
        Of each person, from :func:`person_axes`.
    source : str
        Who they are.
    recipe : {"spine_plane", "pelvis_forward"}
        With which the axes were found.

    Returns
    -------
    JointAxes
    """
    stacked = np.stack(people)
    mean = unit(stacked.mean(axis=0))
    sd = stacked.std(axis=0, ddof=1) if len(people) > 1 else np.full((2, 3), np.nan)
    return JointAxes(mean[0], mean[1], sd[0], sd[1], len(people), source, recipe)


@cache
def public_joint_axes(recipe: Recipe) -> JointAxes:
    """Axes of the people whose static files are at hand, from ``average_joint_axes.csv``.

    Parameters
    ----------
    recipe : {"spine_plane", "pelvis_forward"}

    Returns
    -------
    JointAxes
        Two runners, Fukuchi, Fukuchi and Duarte (2017, CC BY 4.0). ``make validation`` computes
        them anew from the recordings.
    """
    text = files("swaystride.mocap").joinpath("average_joint_axes.csv").read_text(encoding="utf-8")
    table = pd.read_csv(StringIO(text))
    chosen = table[table["recipe"] == recipe].set_index("joint").loc[["knee", "ankle"]]
    columns = ["anterior", "up", "outward"]
    mean = unit(chosen[columns].to_numpy(dtype=np.float64))
    sd = chosen[[f"{name}_sd" for name in columns]].to_numpy(dtype=np.float64)
    n_people, source = int(chosen["n_people"].iloc[0]), str(chosen["source"].iloc[0])
    return JointAxes(mean[0], mean[1], sd[0], sd[1], n_people, source, recipe)
