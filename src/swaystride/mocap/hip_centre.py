"""Hip joint centres from the length of the leg (Hara et al. 2016)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.mocap.anthropometrics import Anthropometrics

Array = NDArray[np.float64]


def hara_hip_centres(body: Anthropometrics, *, marker_offset: bool) -> Array:
    """Hip centres seen from the middle of the anterior superior iliac spines.

    Regression on computed tomography of 157 people (Hara et al. 2016, Sci Rep 6:37707), with leg
    length L in mm: forward 11 − 0.063 L, outward 8 + 0.086 L, up −9 − 0.078 L. Markers sit a radius
    and a base plate in front of the bone; with `marker_offset` that is taken from the forward
    coordinate (methods §5.4, as pyCGM2 does [N]).

    Parameters
    ----------
    body : Anthropometrics
    marker_offset : bool
        Whether the landmarks are centres of markers rather than points of the bone.

    Returns
    -------
    ndarray, shape (2, 3)
        Right and left in the axes of the pelvis (x forward, y up, z right), m.

    Examples
    --------
    >>> body = Anthropometrics((0.9, 0.9), (0.1, 0.1), (0.07, 0.07), 0.007, 0.002)
    >>> hara_hip_centres(body, marker_offset=False).round(4)
    array([[-0.0457, -0.0792,  0.0854],
           [-0.0457, -0.0792, -0.0854]])
    """
    length = np.array(body.leg_length_m)
    forward = 0.011 - 0.063 * length
    if marker_offset:
        forward = forward - body.marker_radius_m - body.base_plate_m
    outward = 0.008 + 0.086 * length
    up = -0.009 - 0.078 * length
    return np.stack([forward, up, outward * np.array([1.0, -1.0])], axis=1)
