"""Units: SI inside the library, everything else converted once, at the edge."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from swaystride.errors import RecordingError

#: Standard gravity (CGPM 1901), the one value used for every conversion and simulation.
GRAVITY_M_S2: Final = 9.80665

DEG_PER_RAD: Final = 180.0 / np.pi
RAD_PER_DEG: Final = np.pi / 180.0

#: For each quantity: accepted spelling of a unit -> factor to the SI unit.
FACTORS_TO_SI: Final[dict[str, dict[str, float]]] = {
    "acceleration": {
        "m/s^2": 1.0,
        "m/s²": 1.0,
        "m/s2": 1.0,
        "g": GRAVITY_M_S2,
        "mg": GRAVITY_M_S2 / 1000.0,
    },
    "angular_rate": {
        "rad/s": 1.0,
        "deg/s": RAD_PER_DEG,
        "°/s": RAD_PER_DEG,
        "dps": RAD_PER_DEG,
        "mdeg/s": RAD_PER_DEG / 1000.0,
    },
    "magnetic_field": {"T": 1.0, "uT": 1e-6, "µT": 1e-6, "mT": 1e-3, "nT": 1e-9, "a.u.": 1.0},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3},
    "voltage": {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "µV": 1e-6},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9},
}


def to_si(values: ArrayLike, unit: str, quantity: str) -> NDArray[np.float64]:
    """Convert values to the SI unit of a quantity.

    Parameters
    ----------
    values : array_like
        Numbers in `unit`.
    unit : str
        As spelled in the file or argument; never guessed.
    quantity : {"acceleration", "angular_rate", "magnetic_field", "length", "voltage", "time"}
        What the numbers are. Magnetic fields in arbitrary units (``a.u.``) stay as they are.

    Returns
    -------
    ndarray of float64

    Raises
    ------
    RecordingError
        If the unit is not one of the accepted spellings of the quantity.

    Examples
    --------
    >>> float(to_si(1.0, "g", "acceleration"))
    9.80665
    """
    factors = FACTORS_TO_SI[quantity]
    if unit not in factors:
        raise RecordingError(
            f"unknown unit of {quantity.replace('_', ' ')}",
            expected="one of " + ", ".join(factors),
            found=repr(unit),
        )
    return np.asarray(values, dtype=np.float64) * factors[unit]
