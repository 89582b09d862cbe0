"""Where the arrays of an Opal HDF5 file stand and what it says about its sensors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from swaystride.errors import RecordingError
from swaystride.io.hdf5_arrays import padded_texts, require_stored, small_attribute
from swaystride.io.source_binary import SourceBinary

if TYPE_CHECKING:
    import h5py

_V5_NAMES = {"acc": "Accelerometer", "gyr": "Gyroscope", "mag": "Magnetometer"}
_CASE_NAMES = {
    "acc": "Calibrated/Accelerometers",
    "gyr": "Calibrated/Gyroscopes",
    "mag": "Calibrated/Magnetometers",
    "quat": "Calibrated/Orientation",
}
_LABEL_IN_CONFIG_STRINGS = 2


@dataclass(frozen=True)
class OpalSensor:
    """One sensor of a file.

    Parameters
    ----------
    group : h5py.Group
        Holds its ``Time``.
    label : str
        Label, or the id where the file has none.
    paths : dict of str to str
        Data set of each signal, from the group.
    rate_hz, timezone_h : float or None
        As the file states them.
    """

    group: h5py.Group
    label: str
    paths: dict[str, str]
    rate_hz: float | None
    timezone_h: float | None = None


def opal_version(file: h5py.File, source: SourceBinary) -> int:
    """Version of the layout: first number of the root attribute ``FileFormatVersion``.

    Parameters
    ----------
    file : h5py.File
        Opened file.
    source : SourceBinary

    Raises
    ------
    RecordingError
        If the file does not say, or it is not from 2 to 5.
    """
    stated = small_attribute(file, "FileFormatVersion", source=source)
    texts = padded_texts(stated)
    if len(texts) == 1 and texts[0].split(".")[0] in {"2", "3", "4", "5"}:
        return int(texts[0].split(".")[0])
    raise RecordingError(
        "not an Opal HDF5 file" if stated is None else "unknown version of Opal HDF5",
        file=source.name,
        place="root attribute FileFormatVersion",
        expected="2, 3, 4 or 5",
        found="no such attribute" if stated is None else ", ".join(texts),
    )


def opal_sensors(file: h5py.File, source: SourceBinary) -> list[OpalSensor]:
    """Sensors of a file, in its order.

    Parameters
    ----------
    file : h5py.File
        Opened file.
    source : SourceBinary

    Raises
    ------
    RecordingError
        If the version is unknown, there is no sensor, or the lists of the file contradict each other.
    """
    if opal_version(file, source) >= 5:
        sensors = [_sensor_v5(file, name, source) for name in _group(file, "Sensors", source)]
    else:
        sensors = _sensors_of_cases(file, source)
    if not sensors:
        raise RecordingError("no sensor in the file", file=source.name, expected="one at least")
    return sensors


def _group(parent: h5py.Group, name: str, source: SourceBinary) -> h5py.Group:
    import h5py

    group = parent.get(name)
    if not isinstance(group, h5py.Group):
        raise RecordingError(
            "a group is missing",
            file=source.name,
            place=f"{parent.name.rstrip('/')}/{name}",
            expected="a group",
            found=", ".join(parent.keys()) or "an empty group",
        )
    return group


def _sensor_v5(file: h5py.File, name: str, source: SourceBinary) -> OpalSensor:
    group = _group(file, f"Sensors/{name}", source)
    configuration = _group(group, "Configuration", source)
    paths = {signal: path for signal, path in _V5_NAMES.items() if path in group}
    orientation = f"/Processed/{name}/Orientation"
    if orientation in file:
        paths["quat"] = orientation
    texts = padded_texts(small_attribute(configuration, "Label 0", source=source))
    if not any(texts) and "Config Strings" in configuration:
        strings = configuration["Config Strings"]
        require_stored(strings, source=source)
        # One compound row; its third field is the label.
        texts = padded_texts(strings[0][_LABEL_IN_CONFIG_STRINGS])
    return OpalSensor(
        group,
        texts[0] if any(texts) else name,
        paths,
        _number(configuration, "Sample Rate", source),
        _number(configuration, "Timezone Offset", source),
    )


def _sensors_of_cases(file: h5py.File, source: SourceBinary) -> list[OpalSensor]:
    """Versions 2 to 4: lists at the root, as attributes or (version 2) as data sets."""
    lists = {}
    for name in ("CaseIdList", "MonitorLabelList"):
        value = small_attribute(file, name, source=source)
        if value is None and name in file:
            require_stored(file[name], source=source)
            value = file[name][()]
        lists[name] = padded_texts(value)
    cases, labels = lists["CaseIdList"], lists["MonitorLabelList"]
    if len(cases) != len(labels):
        raise RecordingError(
            "cases and labels differ in number",
            file=source.name,
            place="CaseIdList and MonitorLabelList",
            expected=f"{len(cases)} labels",
            found=f"{len(labels)} labels",
        )
    sensors = []
    for case, label in zip(cases, labels, strict=True):
        group = _group(file, case, source)
        paths = {signal: path for signal, path in _CASE_NAMES.items() if path in group}
        sensors.append(
            OpalSensor(group, label or case, paths, _number(group, "SampleRate", source))
        )
    return sensors


def _number(item: h5py.Group, name: str, source: SourceBinary) -> float | None:
    value = small_attribute(item, name, source=source)
    if value is None:
        return None
    number = np.asarray(value).ravel()
    if number.size == 1 and number.dtype.kind in "iuf" and np.isfinite(number[0]):
        return float(number[0])
    raise RecordingError(
        "an attribute is not a number",
        file=source.name,
        place=f"{item.name} attribute {name}",
        expected="a number",
        found=repr(value),
    )
