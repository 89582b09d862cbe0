"""What the measures of a trial find worth saying: how many strides there are, and what is missing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from swaystride.findings import Finding, Severity
from swaystride.lower_limb_joints import Side
from swaystride.studies.kinematics.features import RANGE_FEATURES, STRIDE_FEATURES
from swaystride.studies.kinematics.plan import SOURCES
from swaystride.studies.kinematics.stride_selection import FootStrides, StrideRule

Array = NDArray[np.float64]

_N_RANGES = len(RANGE_FEATURES)
_LENGTH = STRIDE_FEATURES.index("stride_length_m")


def stride_findings(
    side: Side, foot: FootStrides, rule: StrideRule, features: Array, time_s: Array
) -> list[Finding]:
    """Findings of one foot of a trial; whoever knows the file adds its name.

    Parameters
    ----------
    side : {"right", "left"}
    foot : FootStrides
    rule : StrideRule
    features : ndarray, shape (n_sources, n_features, n_counted)
        Of the strides that count, in the order of
        :data:`~swaystride.studies.kinematics.features.STRIDE_FEATURES`.
    time_s : ndarray, shape (n_samples,)

    Returns
    -------
    list of Finding
        ``strides_counted`` always; ``irregular_strides``, ``incomplete_strides`` (a missing angle,
        by source), ``strides_without_toe_off`` and ``strides_without_length`` where there are some.
    """
    place = f"{side} foot"
    n_counted = int(foot.counted.sum())
    findings = [_counted(place, foot, rule)]
    if not foot.regular.all():
        findings.append(_irregular(place, foot, rule, time_s))
    for source, values in zip(SOURCES, features, strict=True):
        holes = int(np.isnan(values[:_N_RANGES]).any(axis=0).sum())
        findings += _missing("incomplete_strides", f"{place}, {source}", holes, n_counted)
    no_toe_off = int(np.isnan(foot.toe_off[foot.counted]).sum())
    findings += _missing("strides_without_toe_off", place, no_toe_off, n_counted)
    no_length = int(np.isnan(features[:, _LENGTH]).any(axis=0).sum())
    return findings + _missing("strides_without_length", place, no_length, n_counted)


def _counted(place: str, foot: FootStrides, rule: StrideRule) -> Finding:
    """How many strides count; a warning if there are fewer than the rule uses."""
    n, total = int(foot.counted.sum()), foot.regular.size
    if rule.n_used is None:
        expected = f"all strides after the first {rule.n_dropped}"
    else:
        expected = f"strides {rule.n_dropped + 1} to {rule.n_dropped + rule.n_used}"
    severity: Severity = "warning" if rule.n_used is not None and n < rule.n_used else "info"
    return Finding("strides_counted", severity, "", place, expected, f"{n} of {total} strides")


def _irregular(place: str, foot: FootStrides, rule: StrideRule, time_s: Array) -> Finding:
    """Strides of unusual duration, and how many contacts they seem to miss."""
    at_s = time_s[foot.contacts]
    duration = np.diff(at_s)
    usual = float(np.median(duration))
    odd = np.flatnonzero(~foot.regular)
    missed = int(np.maximum(np.round(duration[odd] / usual) - 1, 0).sum())
    return Finding(
        "irregular_strides",
        "warning",
        "",
        f"{place}, first at {at_s[odd[0]]:.2f} s",
        f"stride times within {100 * rule.time_tolerance:g} % of {usual:.3f} s",
        f"{odd.size} others, with about {missed} missed contacts",
    )


def _missing(check: str, place: str, n: int, total: int) -> list[Finding]:
    """A warning if something is missing."""
    found = f"{n} of {total} strides"
    return [Finding(check, "warning", "", place, "none", found)] if n else []
