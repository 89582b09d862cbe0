"""The standing exercises of the intensity study, and which of them a patient does."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

#: Levels of each aspect from easy to hard, as trials.tsv names them (dissertation §3.3.4.1).
SURFACES: Final = ("firm", "foam")
STANCES: Final = ("feet_apart", "feet_together", "partial_tandem", "tandem", "single_leg")
VISIONS: Final = ("eyes_open", "eyes_closed")
HEADS: Final = ("none", "pitch", "yaw")

#: Levels of the rating scale; a patient's exercises are spread over them.
N_LEVELS: Final = 5


@dataclass(frozen=True)
class Exercise:
    """One combination of surface, stance, vision and head movement.

    Parameters
    ----------
    surface, stance, vision, head : str
        Levels of :data:`SURFACES`, :data:`STANCES`, :data:`VISIONS`, :data:`HEADS`.
    """

    surface: str
    stance: str
    vision: str
    head: str

    @property
    def name(self) -> str:
        """Identifier in trials.tsv, the same for all patients."""
        return "-".join(
            (
                self.surface,
                self.stance,
                self.vision.removeprefix("eyes_"),
                self.head,
            )
        )

    @property
    def difficulty(self) -> tuple[int, int, int, int]:
        """Steps above the easiest level: surface, stance, vision, head (pitch and yaw alike)."""
        return (
            SURFACES.index(self.surface),
            STANCES.index(self.stance),
            VISIONS.index(self.vision),
            int(self.head != "none"),
        )


#: All 60 combinations but the six of single-leg stance on foam (spec §8.4).
EXERCISES: Final = tuple(
    exercise
    for exercise in (Exercise(*levels) for levels in product(SURFACES, STANCES, VISIONS, HEADS))
    if not (exercise.surface == "foam" and exercise.stance == "single_leg")
)

#: Difficulty steps of :data:`EXERCISES`, shape (54, 4).
DIFFICULTY: Final[Array] = np.array([exercise.difficulty for exercise in EXERCISES], dtype=float)


def choose_exercises(
    planned: Array,
    n: int,
    *,
    head_avoidance: float,
    extreme_stance_avoidance: float,
    rng: np.random.Generator,
) -> IntArray:
    """Choose exercises that span the rating scale for one patient.

    The same number is drawn from each level of the scale, by the intensity that is to be expected
    of this patient; a level with too few exercises gives its share to the nearest ones. Within a
    level, an exercise with head movement is preferred on easy levels and avoided on hard ones.

    Parameters
    ----------
    planned : ndarray, shape (54,)
        Expected intensity of each of :data:`EXERCISES` on the scale 1 to 5.
    n : int
        Number of exercises, a multiple of 5.
    head_avoidance : float
        Per level above the middle, the log odds by which an exercise with head movement is less
        likely than one without.
    extreme_stance_avoidance : float
        Log odds by which a stance at the end of its five levels is less likely than the middle
        one; the levels between lose a quarter of it.
    rng : numpy.random.Generator
        Source of the choice.

    Returns
    -------
    ndarray of int, shape (n,)
        Indices into :data:`EXERCISES`, in the random order in which they are done.

    Raises
    ------
    ConfigurationError
        If `n` is not a multiple of the number of levels, or too large.

    Examples
    --------
    >>> chosen = choose_exercises(
    ...     1.5 + DIFFICULTY @ [0.4, 0.6, 0.6, 0.1], 15, head_avoidance=0.2,
    ...     extreme_stance_avoidance=0.5, rng=np.random.default_rng(1))
    >>> len(set(chosen.tolist()))
    15
    """
    if n % N_LEVELS or not 0 < n <= len(EXERCISES):
        raise ConfigurationError(
            "exercises cannot be spread over the scale",
            expected=f"a multiple of {N_LEVELS}, at most {len(EXERCISES)}",
            found=str(n),
        )
    head = -head_avoidance * DIFFICULTY[:, 3]
    stance = -extreme_stance_avoidance * ((DIFFICULTY[:, 1] - 2.0) / 2.0) ** 2
    noise = rng.gumbel(size=len(EXERCISES))
    free = np.ones(len(EXERCISES), dtype=bool)
    chosen: list[int] = []
    # Hard and easy ends first: they are the rare ones.
    for level in (5, 1, 4, 2, 3):
        distance = np.abs(np.clip(planned, 0.5, 5.5) - level)
        in_level = distance <= 0.5
        # Gumbel noise on log odds draws without replacement; outside the level the nearest win.
        score = np.where(in_level, head * (level - 3) + stance + noise, -1e3 * distance)
        score[~free] = -np.inf
        picked = np.argsort(-score, kind="stable")[: n // N_LEVELS]
        free[picked] = False
        chosen += picked.tolist()
    return rng.permutation(np.array(chosen, dtype=np.intp))
