"""What is told of refused constraints, and of a belt that does not go as the table says."""

import kinematics_results as made
import numpy as np
import pytest
import xarray as xr

from swaystride.studies.kinematics.estimate_findings import belt_speed, refused_constraints


def test_a_constraint_is_judged_by_the_samples_at_which_it_is_due():
    """A foot that rests at one sample of a stride may be refused at every one of them."""
    names = ["ContactPoint: right_foot", "ContactPoint: left_foot", "JointCentre: pelvis"]
    filtered = xr.Dataset(
        {"due": (("constraint",), [35, 36, 1216]), "refused": (("constraint",), [35, 0, 60])},
        coords={"constraint": names},
    )
    (found,) = refused_constraints(filtered)
    assert (found.place, found.found) == (names[0], "refused at 35 of 35 samples")


@pytest.mark.parametrize("told", [False, True])
def test_a_belt_of_another_speed_is_told(told):
    """Feet at rest on the belt, but for the marker that rolls on and samples that are missing."""
    estimates = made.estimates()
    time = estimates["time"].to_numpy()
    way = np.zeros_like(estimates["foot_position_m"].values)
    way[..., 0, :] = (made.BELT_M_S - 12.0 / 3.6 if told else 0.1) * time
    way[..., 1000:1400] = np.nan
    estimates["foot_position_m"].values[:] = way
    found = belt_speed(estimates)
    assert len(found) == told
    if told:
        assert found[0].check == "belt_speed_contradicts_markers"
        assert found[0].found.startswith("3.33 m/s; ")
        assert "3.89 m/s" in found[0].expected


def test_without_markers_nothing_is_said():
    estimates = made.estimates()
    estimates["foot_position_m"].values[:] = np.nan
    assert belt_speed(estimates) == []
