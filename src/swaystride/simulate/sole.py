"""One rigid convex sole that rolls without slip, by its support function.

Seen from the side, a sole in the frame of the foot (x to the toes, z up, origin at the ankle) is a
convex curve. With the foot pitched by φ (toes up positive) the ankle stands s(φ) above level
ground, where s is the support function of the curve, and the ground is touched s'(φ) behind the
ankle. If the sole rolls without slip the ankle moves along

    x = −∫ s dφ,    z = s(φ),

in closed form for any course φ(t): s·φ' is the speed with which a wheel of that radius rolls.
The radius of curvature is s + s'', and the sole is convex if and only if it is positive.

The sole is a polygon (heel bevel, flat part, toe rocker, …) whose edges are bent a little: an edge
of length L under the angle α has the curvature radius L/(2w)·(1 + cos(π(φ−α)/w)) for |φ−α| < w,
and all corners are rounded with one radius. Each edge then adds an elementary function to s.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import ConfigurationError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SoleEdge:
    """One edge of the sole.

    Parameters
    ----------
    angle_rad : float
        Pitch of the foot at which the edge lies flat on the ground.
    length_m : float
        Length.
    half_width_rad : float
        The edge is rolled over between ``angle_rad ± half_width_rad``; at most π/2.
    """

    angle_rad: float
    length_m: float
    half_width_rad: float


@dataclass(frozen=True)
class Sole:
    """A rigid convex sole.

    Parameters
    ----------
    edges : tuple of SoleEdge
        In any order.
    corner_radius_m : float
        Radius that every corner has at least.
    ankle_height_m : float
        Height of the ankle with a level foot.
    contact_ahead_m : float
        Distance of the point of contact ahead of the ankle with a level foot.

    Raises
    ------
    ConfigurationError
        If a length, width or radius is not positive: the sole would not be convex.

    Examples
    --------
    A wheel is a sole without edges; it rolls 2π·r in one turn.

    >>> wheel = Sole((), corner_radius_m=0.5, ankle_height_m=0.5, contact_ahead_m=0.0)
    >>> round(float(wheel.rolled_m(-2.0 * np.pi)), 6)
    3.141593
    """

    edges: tuple[SoleEdge, ...]
    corner_radius_m: float
    ankle_height_m: float
    contact_ahead_m: float

    def __post_init__(self) -> None:
        """Refuse a sole that is not convex."""
        sizes = [self.corner_radius_m]
        for edge in self.edges:
            sizes += [edge.length_m, edge.half_width_rad, np.pi / 2 - edge.half_width_rad + 1e-12]
        if not min(sizes) > 0:
            raise ConfigurationError(
                "the sole is not convex",
                expected="positive lengths and radii, half widths up to 90°",
                found=repr(self),
            )

    def support_m(self, pitch_rad: ArrayLike, derivative: int = 0) -> Array:
        """Height of the ankle over the ground, or one of its derivatives by the pitch.

        Parameters
        ----------
        pitch_rad : array_like
            Pitch φ, toes up positive.
        derivative : int
            −1 (the integral from a level foot) to 2.

        Returns
        -------
        ndarray
            In m, or m/rad, m/rad², …
        """
        return self.rolling(pitch_rad)[derivative + 1]

    def rolling(self, pitch_rad: ArrayLike) -> tuple[Array, Array, Array, Array]:
        """Support function with its integral and two derivatives, all at once.

        Parameters
        ----------
        pitch_rad : array_like
            Pitch φ, toes up positive.

        Returns
        -------
        integral, s, s1, s2 : ndarray
            ``∫ s dφ`` from a level foot, s, s' and s''.
        """
        pitch = np.asarray(pitch_rad, dtype=np.float64)
        up, back, at_level = self._constants
        sine, cosine = np.sin(pitch), np.cos(pitch)
        wave = up * cosine + back * sine
        turned = up * sine - back * cosine
        integral = turned + self.corner_radius_m * pitch - at_level
        s, s1, s2 = wave + self.corner_radius_m, -turned, -wave
        for edge in self.edges:
            added = _edge(edge, pitch)
            integral, s, s1, s2 = integral + added[0], s + added[1], s1 + added[2], s2 + added[3]
        return integral, s, s1, s2

    def rolled_m(self, pitch_rad: ArrayLike) -> Array:
        """How far ahead of its place with a level foot the ankle is, after rolling to a pitch.

        Parameters
        ----------
        pitch_rad : array_like
            Pitch φ, toes up positive.

        Returns
        -------
        ndarray
            ``−∫ s dφ`` from 0 to φ.
        """
        return -self.rolling(pitch_rad)[0]

    def curvature_radius_m(self, pitch_rad: ArrayLike) -> Array:
        """Radius of curvature where the sole touches the ground, ``s + s''``.

        Parameters
        ----------
        pitch_rad : array_like
            Pitch φ, toes up positive.
        """
        _, s, _, s2 = self.rolling(pitch_rad)
        return s + s2

    def contact_m(self, pitch_rad: ArrayLike) -> Array:
        """Point of contact in the frame of the foot.

        Parameters
        ----------
        pitch_rad : array_like, shape (...)
            Pitch φ, toes up positive.

        Returns
        -------
        ndarray, shape (2, ...)
            Coordinates x (to the toes) and z (up) from the ankle.
        """
        pitch = np.asarray(pitch_rad, dtype=np.float64)
        _, s, slope, _ = self.rolling(pitch)
        sine, cosine = np.sin(pitch), np.cos(pitch)
        return np.stack([-slope * cosine - s * sine, slope * sine - s * cosine])

    @cached_property
    def _constants(self) -> tuple[float, float, float]:
        """Height of the ankle over the corner at the toes, minus its distance ahead, and ∫ s at 0.

        The integral is what the sum of the antiderivatives of the parts gives for a level foot.
        """
        added = [_edge(edge, np.zeros(1)) for edge in self.edges]
        up = self.ankle_height_m - self.corner_radius_m - sum(float(a[1][0]) for a in added)
        back = -self.contact_ahead_m - sum(float(a[2][0]) for a in added)
        return up, back, sum(float(a[0][0]) for a in added) - back


def _edge(edge: SoleEdge, pitch: Array) -> tuple[Array, Array, Array, Array]:
    """What an edge adds to the support function, ∫ sin(φ−θ)·ρ(θ) dθ over its curvature radius ρ.

    With k = π/w, K = k²/(k²−1) and u = φ − α + w this is L/(2w)·(1 + cos(ku)/(k²−1) − K cos u)
    while the edge is rolled over, and L/w·K·sin w·sin(φ−α) behind it: integral, value and two
    derivatives.
    """
    w = edge.half_width_rad
    k = np.pi / w
    share = 1.0 / (k * k - 1.0)
    whole = k * k * share
    scale = edge.length_m / (2.0 * w)
    angle = pitch - edge.angle_rad
    u = np.clip(angle + w, 0.0, 2.0 * w)
    behind = angle > w
    # Behind the edge only an arc is left; its phase and size replace those of the slow wave.
    phase = np.where(behind, angle - np.pi / 2, u)
    size = scale * np.where(behind, -2.0 * np.sin(w) * whole, whole)
    slow_sine, slow_cosine = size * np.sin(phase), size * np.cos(phase)
    inside = np.where(behind, 0.0, scale * share)
    fast_sine, fast_cosine = inside * np.sin(k * u), inside * np.cos(k * u)
    return (
        scale * u + fast_sine / k - slow_sine,
        np.where(behind, 0.0, scale) + fast_cosine - slow_cosine,
        slow_sine - k * fast_sine,
        slow_cosine - k * k * fast_cosine,
    )
