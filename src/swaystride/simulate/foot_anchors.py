"""How a foot moves at a speed: a table of anchor speeds with sources, interpolated between them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import PchipInterpolator

from swaystride.errors import ConfigurationError
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

#: Suffix of the name and factor to the SI unit, for each unit of the table.
_UNITS = {
    "1": ("", 1.0),
    "s": ("_s", 1.0),
    "ms": ("_s", 1e-3),
    "m": ("_m", 1.0),
    "m/s": ("_m_s", 1.0),
    "deg": ("_rad", RAD_PER_DEG),
    "deg/s": ("_rad_s", RAD_PER_DEG),
}


@dataclass(frozen=True)
class GaitAnchors:
    """Gait parameters at anchor speeds.

    Parameters
    ----------
    speed_m_s : ndarray, shape (n_speeds,)
        Rising.
    values : dict of str to ndarray, shape (n_speeds,)
        Parameters in SI, the unit in the name.
    """

    speed_m_s: Array
    values: dict[str, Array]

    def at(self, speed_m_s: ArrayLike) -> dict[str, Array]:
        """Parameters at any speeds; beyond the ends of the table those of its ends.

        Monotone between neighbouring anchors (PCHIP).

        Parameters
        ----------
        speed_m_s : array_like, shape (n,)
            Speeds.

        Returns
        -------
        dict of str to ndarray, shape (n,)

        Examples
        --------
        >>> round(float(gait_anchors().at([8.0])["arrest_time_s"][0]), 6)
        0.008
        """
        speed = np.clip(np.asarray(speed_m_s, dtype=np.float64), *self.speed_m_s[[0, -1]])
        table = np.stack(list(self.values.values()), axis=-1)
        rows = PchipInterpolator(self.speed_m_s, table)(speed)
        return {name: rows[..., i] for i, name in enumerate(self.values)}


@cache
def gait_anchors() -> GaitAnchors:
    """Return the table ``foot_anchors.csv`` in this folder.

    Raises
    ------
    ConfigurationError
        If a unit is unknown or a source is missing.
    """
    return read_anchors(Path(__file__).with_name("foot_anchors.csv"))


def read_anchors(path: Path) -> GaitAnchors:
    """Read a table of parameters at anchor speeds.

    Parameters
    ----------
    path : Path
        CSV with ``quantity``, ``unit``, one column per speed in m/s, and ``source``.

    Returns
    -------
    GaitAnchors

    Raises
    ------
    ConfigurationError
        If a unit is unknown or a source is missing.
    """
    table = pd.read_csv(path, dtype={"unit": str})
    speeds = [name for name in table.columns if name not in ("quantity", "unit", "source")]
    values = {}
    for row in table.to_dict("records"):
        if row["unit"] not in _UNITS or not isinstance(row["source"], str):
            raise ConfigurationError(
                "a row without a known unit or a source",
                file=path,
                place=str(row["quantity"]),
                expected="one of " + ", ".join(_UNITS) + ", and a source",
                found=f"{row['unit']!r}, {row['source']!r}",
            )
        suffix, factor = _UNITS[row["unit"]]
        values[f"{row['quantity']}{suffix}"] = factor * np.array([row[s] for s in speeds], float)
    return GaitAnchors(np.array(speeds, dtype=np.float64), values)
