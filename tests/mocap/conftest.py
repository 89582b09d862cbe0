from dataclasses import replace

import numpy as np
import optical_person
import pytest

from swaystride.mocap.joint_axes import average_joint_axes, person_axes
from swaystride.mocap.marker_set import CONVENTIONAL_GAIT, MarkerSet
from swaystride.mocap.static_calibration import PRINTED_OPTIONS, OpticalOptions


def _leg(leg, letter):
    return replace(
        leg,
        foot=(f"{letter}HEE", f"{letter}TOE"),
        knee_medial=f"{letter}KNM",
        ankle_medial=f"{letter}ANM",
    )


#: The conventional set with medial markers in the static trial.
WITH_MEDIAL = replace(
    CONVENTIONAL_GAIT,
    right=_leg(CONVENTIONAL_GAIT.right, "R"),
    left=_leg(CONVENTIONAL_GAIT.left, "L"),
)


@pytest.fixture(scope="session")
def with_medial() -> MarkerSet:
    return WITH_MEDIAL


@pytest.fixture(scope="session")
def clusters() -> MarkerSet:
    """Three markers on every segment, tracked without help from upstream."""

    def leg(of, letter):
        return replace(
            of,
            thigh=(f"{letter}THI", f"{letter}KNE", f"{letter}KNM"),
            shank=(f"{letter}TIB", f"{letter}ANK", f"{letter}ANM"),
            foot=(f"{letter}HEE", f"{letter}TOE", f"{letter}MT5"),
        )

    return replace(
        WITH_MEDIAL,
        right=leg(WITH_MEDIAL.right, "R"),
        left=leg(WITH_MEDIAL.left, "L"),
        tracking="cluster",
    )


@pytest.fixture(scope="session")
def static():
    return optical_person.standing()


@pytest.fixture(scope="session")
def own_axes(static):
    """The person's own joint axes, as an average over one person."""
    person = person_axes(static, WITH_MEDIAL, "spine_plane")
    return average_joint_axes([person], "the person", "spine_plane")


@pytest.fixture(scope="session")
def motion():
    return optical_person.moving()


@pytest.fixture(scope="session")
def printed() -> OpticalOptions:
    return PRINTED_OPTIONS


@pytest.fixture
def rng():
    return np.random.default_rng(11)
