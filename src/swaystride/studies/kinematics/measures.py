"""All measures of one trial: strides, features, agreement of waveforms, mean curves, planar angles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from swaystride.configuration import from_mapping
from swaystride.errors import RecordingError
from swaystride.findings import Finding
from swaystride.gait.initial_contact import InitialContactRule, initial_contacts
from swaystride.gait.stride_curves import N_PHASES, ensemble, stride_curves
from swaystride.gait.toe_off import ToeOffRule, toe_offs
from swaystride.lower_limb_joints import Side
from swaystride.studies.kinematics.agreement import AGREEMENT_COLUMNS, waveform_agreement
from swaystride.studies.kinematics.features import (
    STRIDE_FEATURES,
    peak_features,
    ranges_of_motion,
    spatial_features,
)
from swaystride.studies.kinematics.plan import ANGLE_NAMES, SIDES, SOURCES
from swaystride.studies.kinematics.stride_findings import stride_findings
from swaystride.studies.kinematics.stride_selection import (
    FootStrides,
    StrideRule,
    counted_strides,
    regular_strides,
)

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MeasureParameters:
    """Choices of the measures (config/studies/kinematics.yaml).

    Parameters
    ----------
    contacts : InitialContactRule
        ``analysis.contacts``.
    toe_off : ToeOffRule
        ``analysis.measures.toe_off``.
    strides : StrideRule
        ``analysis.measures.strides``.
    horizontal_length : bool
        ``analysis.measures.footfalls.horizontal_length``: whether stride length leaves out the
        vertical.
    """

    contacts: InitialContactRule
    toe_off: ToeOffRule
    strides: StrideRule
    horizontal_length: bool


def measure_parameters(
    contacts: Mapping[str, Any], measures: Mapping[str, Any]
) -> MeasureParameters:
    """Parameters from plain values of the configuration.

    Parameters
    ----------
    contacts : mapping
        ``analysis.contacts``, which the estimates use too.
    measures : mapping
        ``analysis.measures``: ``toe_off``, ``strides``, ``footfalls``.

    Returns
    -------
    MeasureParameters

    Raises
    ------
    ConfigurationError
        If a key is missing or unknown.
    """
    groups = from_mapping(_MeasureGroups, measures, place="analysis.measures")
    footfall = from_mapping(_Footfalls, groups.footfalls, place="analysis.measures.footfalls")
    return MeasureParameters(
        from_mapping(InitialContactRule, contacts, place="analysis.contacts"),
        from_mapping(ToeOffRule, groups.toe_off, place="analysis.measures.toe_off"),
        from_mapping(StrideRule, groups.strides, place="analysis.measures.strides"),
        footfall.horizontal_length,
    )


@dataclass(frozen=True, eq=False)
class TrialMeasures:
    """Tables of one trial, without columns for participant and trial.

    Parameters
    ----------
    strides : DataFrame
        One row per stride that counts, source and feature: ``side``, ``stride``,
        ``initial_contact_s``, ``next_contact_s``, ``source``, ``feature``, ``value``. A feature that
        a stride does not have (a missing marker, no toe-off, no still sample) is NaN.
    agreement : DataFrame
        One row per side and angle: ``side``, ``angle`` and
        :data:`~swaystride.studies.kinematics.agreement.AGREEMENT_COLUMNS`.
    curves : DataFrame
        ``source``, ``side``, ``angle``, ``phase_pct``, ``mean_deg``, ``sd_deg`` over the strides
        that count.
    planar : DataFrame
        ``trio``, ``mean_deg``, ``sd_deg`` over the samples of these strides of the same side.
    findings : list of Finding
        How many strides there are and what is missing.
    """

    strides: pd.DataFrame
    agreement: pd.DataFrame
    curves: pd.DataFrame
    planar: pd.DataFrame
    findings: list[Finding]


def trial_measures(estimates: xr.Dataset, parameters: MeasureParameters) -> TrialMeasures:
    """Measure one trial.

    Parameters
    ----------
    estimates : xarray.Dataset
        Coordinates ``source``, ``side``, ``angle``, ``time`` (s), ``trio``; ``angle_deg``,
        ``foot_position_m`` (source, side, axis, time; frame of the belt), ``zero_velocity``,
        ``foot_acc_m_s2``, ``foot_gyr_rad_s``, ``foot_pitch_rate_rad_s`` (side, time),
        ``planar_angle_deg``; attributes ``rate_hz``, ``first_usable_s``.
    parameters : MeasureParameters

    Returns
    -------
    TrialMeasures

    Raises
    ------
    RecordingError
        If a foot does not run, or no stride counts.
    """
    usable = estimates.isel(time=_usable(estimates))
    # float64: a path of a kilometre loses a tenth of a millimetre in float32, no more afterwards
    angles = usable["angle_deg"].transpose("source", "side", "angle", "time")
    degrees = angles.sel(source=list(SOURCES), side=list(SIDES), angle=list(ANGLE_NAMES))
    values = degrees.to_numpy().astype(np.float64)
    feet: dict[Side, FootStrides] = {side: foot_strides(usable, side, parameters) for side in SIDES}
    spatial = spatial_features(usable, feet, horizontal_length=parameters.horizontal_length)
    time_s = usable["time"].to_numpy()
    strides, agreement, curves = [], [], []
    findings: list[Finding] = []
    for row, side in enumerate(SIDES):
        foot, own = feet[side], values[:, row]
        features = np.concatenate(
            [
                ranges_of_motion(own, foot.contacts),
                peak_features(own, foot.contacts, foot.toe_off),
                spatial[side],
            ],
            axis=1,
        )[..., foot.counted]
        strides.append(_stride_rows(side, foot, time_s, features))
        agreement.append(_agreement_rows(side, foot, own))
        curves.append(_curve_rows(side, foot, own))
        findings += stride_findings(side, foot, parameters.strides, features, time_s)
    return TrialMeasures(
        pd.concat(strides, ignore_index=True),
        pd.concat(agreement, ignore_index=True),
        pd.concat(curves, ignore_index=True),
        _planar_rows(usable, feet),
        findings,
    )


def foot_strides(estimates: xr.Dataset, side: Side, parameters: MeasureParameters) -> FootStrides:
    """Strides of one foot, and which of them count.

    Parameters
    ----------
    estimates : xarray.Dataset
        See :func:`trial_measures`; from its first usable sample.
    side : {"right", "left"}
    parameters : MeasureParameters

    Returns
    -------
    FootStrides
        Contacts from the acceleration of the foot, for both sources.

    Raises
    ------
    RecordingError
        If the foot does not run, or no stride counts.
    """
    rate_hz, place = float(estimates.attrs["rate_hz"]), f"{side} foot"
    acc, gyr, pitch = (
        estimates[name].sel(side=side).to_numpy().astype(np.float64)
        for name in ("foot_acc_m_s2", "foot_gyr_rad_s", "foot_pitch_rate_rad_s")
    )
    contacts = initial_contacts(acc, gyr, rate_hz, parameters.contacts, place=place)
    off = toe_offs(pitch, gyr, contacts, rate_hz, parameters.toe_off)
    regular = regular_strides(contacts, parameters.strides)
    counted = counted_strides(regular, parameters.strides)
    if not counted.any():
        raise RecordingError(
            "no stride counts",
            place=place,
            expected=f"strides after the first {parameters.strides.n_dropped}",
            found=f"{regular.size} strides",
        )
    return FootStrides(contacts, off, regular, counted)


@dataclass(frozen=True)
class _MeasureGroups:
    """Groups of ``analysis.measures``."""

    toe_off: dict[str, Any]
    strides: dict[str, Any]
    footfalls: dict[str, Any]


@dataclass(frozen=True)
class _Footfalls:
    """``analysis.measures.footfalls``."""

    horizontal_length: bool


def _usable(estimates: xr.Dataset) -> slice:
    """Samples after a gap that was cut."""
    first_s = float(estimates.attrs["first_usable_s"])
    return slice(int(np.searchsorted(estimates["time"].to_numpy(), first_s - 1e-9)), None)


def _stride_rows(side: Side, foot: FootStrides, time_s: Array, features: Array) -> pd.DataFrame:
    """Long table of (source, feature, stride)."""
    n_sources, n_features, n = features.shape
    each = n_sources * n_features
    return pd.DataFrame(
        {
            "side": side,
            "stride": np.repeat(foot.numbers, each),
            "initial_contact_s": np.repeat(time_s[foot.start], each),
            "next_contact_s": np.repeat(time_s[foot.stop], each),
            "source": np.tile(np.repeat(SOURCES, n_features), n),
            "feature": np.tile(STRIDE_FEATURES, n * n_sources),
            "value": features.transpose(2, 0, 1).ravel(),
        }
    )


def _agreement_rows(side: Side, foot: FootStrides, degrees: Array) -> pd.DataFrame:
    """One row per angle."""
    rows = [
        {
            "side": side,
            "angle": angle,
            **waveform_agreement(degrees[0, a], degrees[1, a], foot.start, foot.stop),
        }
        for a, angle in enumerate(ANGLE_NAMES)
    ]
    return pd.DataFrame(rows, columns=["side", "angle", *AGREEMENT_COLUMNS])


def _curve_rows(side: Side, foot: FootStrides, degrees: Array) -> pd.DataFrame:
    """Mean curves of both sources."""
    mean, sd = ensemble(stride_curves(degrees, foot.start, foot.stop))
    n_angles = len(ANGLE_NAMES)
    return pd.DataFrame(
        {
            "source": np.repeat(SOURCES, n_angles * N_PHASES),
            "side": side,
            "angle": np.tile(np.repeat(ANGLE_NAMES, N_PHASES), len(SOURCES)),
            "phase_pct": np.tile(np.arange(N_PHASES), len(SOURCES) * n_angles),
            "mean_deg": mean.ravel(),
            "sd_deg": sd.ravel(),
        }
    )


def _planar_rows(estimates: xr.Dataset, feet: dict[Side, FootStrides]) -> pd.DataFrame:
    """Mean and scatter of the collinearity of each trio."""
    rows = []
    for trio in estimates["trio"].to_numpy():
        foot = feet["right" if str(trio).startswith("right") else "left"]
        angle = estimates["planar_angle_deg"].sel(trio=trio).to_numpy().astype(np.float64)
        edges = np.zeros(angle.size + 1, dtype=np.int64)
        edges[foot.start] += 1
        edges[foot.stop] -= 1
        known = angle[(np.cumsum(edges[:-1]) > 0) & np.isfinite(angle)]
        some = known.size > 1
        rows.append(
            {
                "trio": str(trio),
                "mean_deg": float(known.mean()) if some else float("nan"),
                "sd_deg": float(known.std(ddof=1)) if some else float("nan"),
            }
        )
    return pd.DataFrame(rows, columns=["trio", "mean_deg", "sd_deg"])
