"""Conversions to SI."""

import numpy as np
import pytest

from swaystride.errors import RecordingError
from swaystride.units import DEG_PER_RAD, FACTORS_TO_SI, GRAVITY_M_S2, RAD_PER_DEG, to_si


@pytest.mark.parametrize(
    ("value", "unit", "quantity", "expected"),
    [
        (1.0, "g", "acceleration", 9.80665),
        (1000.0, "mg", "acceleration", 9.80665),
        (180.0, "deg/s", "angular_rate", np.pi),
        (180_000.0, "mdeg/s", "angular_rate", np.pi),
        (50.0, "uT", "magnetic_field", 50e-6),
        (0.7, "a.u.", "magnetic_field", 0.7),
        (1_550_879_504_438_281.0, "us", "time", 1_550_879_504.438281),
    ],
)
def test_known_conversions(value: float, unit: str, quantity: str, expected: float) -> None:
    assert float(to_si(value, unit, quantity)) == pytest.approx(expected, rel=1e-15)


def test_spellings_of_one_unit_agree() -> None:
    for spellings, quantity in (
        (("m/s^2", "m/s²", "m/s2"), "acceleration"),
        (("deg/s", "°/s", "dps"), "angular_rate"),
        (("uT", "µT"), "magnetic_field"),
        (("us", "µs"), "time"),
    ):
        assert len({FACTORS_TO_SI[quantity][spelling] for spelling in spellings}) == 1


def test_shape_and_type() -> None:
    converted = to_si([[1, 2], [3, 4]], "g", "acceleration")
    assert converted.dtype == np.float64
    np.testing.assert_allclose(converted, GRAVITY_M_S2 * np.array([[1, 2], [3, 4]]))
    assert pytest.approx(1.0) == DEG_PER_RAD * RAD_PER_DEG


def test_an_unknown_unit_is_not_guessed() -> None:
    with pytest.raises(RecordingError) as caught:
        to_si(1.0, "G", "acceleration")
    assert str(caught.value) == (
        "unknown unit of acceleration; expected one of m/s^2, m/s², m/s2, g, mg; found 'G'"
    )
