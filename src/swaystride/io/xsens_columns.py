"""The column names of Xsens exports, shared by every text format that uses them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from swaystride.errors import RecordingError
from swaystride.io.table import Table, read_numbers
from swaystride.rotations import quaternion_from_matrix, quaternion_from_roll_pitch_yaw
from swaystride.units import RAD_PER_DEG

Array = NDArray[np.float64]

PACKET_COUNTER = "PacketCounter"
SAMPLE_TIME_FINE = "SampleTimeFine"

VECTORS = {
    signal: tuple(f"{prefix}_{axis}" for axis in "XYZ")
    for signal, prefix in (("acc", "Acc"), ("gyr", "Gyr"), ("mag", "Mag"))
}
#: Forms of the orientation, the first one present is read. Matrix elements are listed by row.
ORIENTATIONS = {
    "quaternion": tuple(f"Quat_q{i}" for i in range(4)),
    "matrix": tuple(f"Mat[{row}][{column}]" for row in (1, 2, 3) for column in (1, 2, 3)),
    "roll_pitch_yaw": ("Roll", "Pitch", "Yaw"),
}
KNOWN_COLUMN = re.compile(
    r"PacketCounter|SampleTimeFine|(?:Acc|Gyr|Mag)_[XYZ]|Quat_q[0-3]|Mat\[\d\]\[\d\]"
    r"|Roll|Pitch|Yaw"
)


def read_signals(table: Table, others: Sequence[str]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Read the signals that a table holds, and further columns if it has them.

    Parameters
    ----------
    table : Table
    others : sequence of str
        Columns that need not be there, such as the packet counter.

    Returns
    -------
    others : dict of str to ndarray, shape (n_rows,)
        Those of the other columns that are present.
    signals : dict of str to ndarray, shape (n_channels, n_rows)
        ``acc``, ``gyr``, ``mag`` as printed; ``quat`` (r_world_from_sensor, scalar first) from
        whichever form of orientation the file has.

    Raises
    ------
    RecordingError
        If a signal lacks some of its columns, there is no signal, or a field is bad.
    """
    groups: dict[str, tuple[str, ...]] = {name: (name,) for name in others if name in table.columns}
    groups |= {s: names for s, names in VECTORS.items() if _is_present(table, names)}
    orientation = next((f for f, names in ORIENTATIONS.items() if _is_present(table, names)), None)
    if orientation is not None:
        groups[orientation] = ORIENTATIONS[orientation]
    if not groups.keys() - set(others):
        raise RecordingError(
            "no signal columns",
            file=table.source.name,
            place=f"line {table.first_line - 1}",
            expected="Acc_X, Acc_Y, Acc_Z, or Gyr_…, or an orientation",
            found=", ".join(table.columns),
        )
    names = [name for group in groups.values() for name in group]
    rows = read_numbers(table, table.positions(names))
    blocks = np.split(rows, np.cumsum([len(group) for group in groups.values()])[:-1])
    block_of = dict(zip(groups, blocks, strict=True))
    signals = {signal: block_of[signal] for signal in VECTORS if signal in block_of}
    if orientation is not None:
        signals["quat"] = _quaternion(orientation, block_of[orientation])
    return {name: block_of[name][0] for name in others if name in block_of}, signals


def _is_present(table: Table, names: Sequence[str]) -> bool:
    """All columns of a group or none; a part of them is an error that names the missing one."""
    if not any(name in table.columns for name in names):
        return False
    table.positions(names)
    return True


def _quaternion(form: str, values: Array) -> Array:
    """Scalar-first quaternion (4, n) of an orientation in its printed form."""
    if form == "quaternion":
        return values
    if form == "matrix":
        return quaternion_from_matrix(values.T.reshape(-1, 3, 3)).T
    return quaternion_from_roll_pitch_yaw(values.T * RAD_PER_DEG).T
