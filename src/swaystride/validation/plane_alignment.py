"""Best turn and shift of one path onto another in the plane."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError


@dataclass(frozen=True)
class PlaneAlignment:
    """Turn and shift in the plane: ``r_target_from_source @ source + shift_m``.

    Parameters
    ----------
    r_target_from_source : array, shape (2, 2)
        Rotation, or reflection where that was asked for.
    shift_m : array, shape (2,)
    rms_m : float
        Root mean square distance that remains.
    """

    r_target_from_source: NDArray[np.float64]
    shift_m: NDArray[np.float64]
    rms_m: float

    def apply(self, path_m: ArrayLike) -> NDArray[np.float64]:
        """Path of shape (2, n) in the frame of the target.

        Parameters
        ----------
        path_m : array_like, shape (2, n)
        """
        moved = self.r_target_from_source @ np.asarray(path_m, dtype=np.float64)
        return np.asarray(moved + self.shift_m[:, None])


def align_in_plane(
    source_m: ArrayLike, target_m: ArrayLike, *, mirrored: bool = False
) -> PlaneAlignment:
    """Rotation and translation of least squared distance; the scale stays.

    With complex numbers z and w for the centred points, the sum of ``|w - exp(iθ) z|²`` is least
    where θ is the argument of ``Σ w conj(z)``. A reflection is the same after ``z -> conj(z)``.

    Parameters
    ----------
    source_m, target_m : array_like, shape (2, n)
        The same points in two frames.
    mirrored : bool
        Align with a reflection instead, to see which of the two hands fits.

    Raises
    ------
    RecordingError
        If the shapes differ or there are fewer than two points.

    Examples
    --------
    >>> found = align_in_plane([[0, 1, 1], [0, 0, 2]], [[5, 5, 3], [1, 2, 2]])
    >>> found.r_target_from_source.round(9) + 0.0
    array([[ 0., -1.],
           [ 1.,  0.]])
    >>> found.shift_m.round(9).tolist()
    [5.0, 1.0]
    """
    source, target = (np.asarray(path, dtype=np.float64) for path in (source_m, target_m))
    if source.shape != target.shape or source.ndim != 2 or len(source) != 2 or source.shape[1] < 2:
        raise RecordingError(
            "paths cannot be aligned",
            expected="two paths of the same two or more points in the plane",
            found=f"shapes {source.shape} and {target.shape}",
        )
    hand = np.diag([1.0, -1.0 if mirrored else 1.0])
    centre, goal = source.mean(axis=1), target.mean(axis=1)
    z, w = (
        path[0] + 1j * path[1]
        for path in (hand @ (source - centre[:, None]), target - goal[:, None])
    )
    angle = np.angle(np.sum(w * np.conj(z)))
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]) @ hand
    distance = np.abs(w - np.exp(1j * angle) * z)
    return PlaneAlignment(turn, goal - turn @ centre, float(np.sqrt(np.mean(distance**2))))
