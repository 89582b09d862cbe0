"""The rigid convex sole: closed forms against geometry and calculus."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from swaystride.errors import ConfigurationError
from swaystride.simulate.sole import Sole, SoleEdge

PITCH = np.linspace(-2.6, 1.2, 4001)


@st.composite
def soles(draw: st.DrawFn) -> Sole:
    edges = [
        SoleEdge(
            draw(st.floats(-1.2, 0.8)), draw(st.floats(0.005, 0.3)), draw(st.floats(0.02, 1.5))
        )
        for _ in range(draw(st.integers(0, 4)))
    ]
    return Sole(
        tuple(edges),
        corner_radius_m=draw(st.floats(0.001, 0.05)),
        ankle_height_m=draw(st.floats(0.05, 0.15)),
        contact_ahead_m=draw(st.floats(-0.05, 0.1)),
    )


@pytest.fixture(scope="module")
def shoe(runners) -> Sole:
    return runners.sole.sole(0.26)


@settings(max_examples=60, deadline=None)
@given(sole=soles())
def test_every_sole_is_convex(sole: Sole) -> None:
    assert (sole.curvature_radius_m(PITCH) >= sole.corner_radius_m - 1e-9).all()


@settings(max_examples=60, deadline=None)
@given(sole=soles())
def test_a_level_foot_stands_as_told(sole: Sole) -> None:
    x, z = sole.contact_m(0.0)
    assert float(sole.support_m(0.0)) == pytest.approx(sole.ankle_height_m, abs=1e-12)
    assert (float(x), float(z)) == pytest.approx(
        (sole.contact_ahead_m, -sole.ankle_height_m), abs=1e-12
    )
    assert float(sole.rolled_m(0.0)) == pytest.approx(0.0, abs=1e-12)


@settings(max_examples=60, deadline=None)
@given(sole=soles())
def test_derivatives_follow_from_each_other(sole: Sole) -> None:
    step = 1e-5
    ahead, behind = sole.rolling(PITCH + step), sole.rolling(PITCH - step)
    values = sole.rolling(PITCH)
    for order in range(3):
        slope = (ahead[order] - behind[order]) / (2 * step)
        curvature = 1.0 + np.abs(values[3]).max() / 0.02**2
        np.testing.assert_allclose(slope, values[order + 1], rtol=0, atol=1e-9 * curvature)


@example(sole=Sole((SoleEdge(0.78125, 0.25, 1.0),), 0.015625, 0.125, 0.0))
@settings(max_examples=40, deadline=None)
@given(sole=soles())
def test_the_support_function_is_that_of_the_points_that_touch(sole: Sole) -> None:
    """The lowest point of the outline is the one said to touch, and lies on the ground.

    Of an outline that turns by more than half a circle without being closed, parts further away than
    that may lie deeper; no foot turns so far.
    """
    x, z = sole.contact_m(PITCH)
    for pitch in PITCH[::400]:
        near = np.abs(PITCH - pitch) < np.pi
        height = x[near] * np.sin(pitch) + z[near] * np.cos(pitch)
        assert -height.min() == pytest.approx(float(sole.support_m(pitch)), abs=1e-7)


def test_a_polygon_without_bends_has_the_length_of_its_edges(shoe: Sole) -> None:
    """The outline between two touching points is as long as edges and rounded corners together."""
    x, z = shoe.contact_m(PITCH)
    length = np.hypot(np.diff(x), np.diff(z)).sum()
    edges = sum(edge.length_m for edge in shoe.edges)
    assert length == pytest.approx(edges + shoe.corner_radius_m * np.ptp(PITCH), rel=1e-5)


def test_a_wheel_rolls_as_a_wheel() -> None:
    wheel = Sole((), corner_radius_m=0.3, ankle_height_m=0.3, contact_ahead_m=0.0)
    np.testing.assert_allclose(wheel.support_m(PITCH), 0.3, atol=1e-15)
    np.testing.assert_allclose(wheel.rolled_m(PITCH), -0.3 * PITCH, atol=1e-15)


def test_the_point_that_touches_is_at_rest(shoe: Sole) -> None:
    """World position of a material point while the sole rolls over it: its velocity vanishes."""
    for pitch in np.linspace(-1.6, 0.5, 40):
        x, z = shoe.contact_m(pitch)

        def world(angle: float, x: float = float(x), z: float = float(z)) -> np.ndarray:
            return np.array(
                [
                    float(shoe.rolled_m(angle)) + x * np.cos(angle) - z * np.sin(angle),
                    float(shoe.support_m(angle)) + x * np.sin(angle) + z * np.cos(angle),
                ]
            )

        assert abs(world(float(pitch))[1]) < 1e-12
        speed = (world(pitch + 1e-6) - world(pitch - 1e-6)) / 2e-6
        assert np.abs(speed).max() < 1e-8


def test_the_contact_moves_from_heel_to_toes(shoe: Sole) -> None:
    x, _ = shoe.contact_m(np.radians([25.0, 0.0, -10.0, -50.0]))
    assert (np.diff(x) > 0).all()
    assert -0.09 < x[0] < -0.03
    assert 0.15 < x[-1] < 0.22


@pytest.mark.parametrize(
    ("edges", "radius"),
    [((), 0.0), ((SoleEdge(0.0, -0.1, 0.1),), 0.01), ((SoleEdge(0.0, 0.1, 0.0),), 0.01)],
)
def test_a_sole_that_is_not_convex_is_refused(edges, radius) -> None:
    with pytest.raises(ConfigurationError, match="the sole is not convex"):
        Sole(edges, corner_radius_m=radius, ankle_height_m=0.08, contact_ahead_m=0.0)
