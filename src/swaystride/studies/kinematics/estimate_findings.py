"""What the estimates of a trial find worth saying: refused constraints, a belt of another speed."""

from __future__ import annotations

from typing import Final

import numpy as np
import xarray as xr

from swaystride.findings import Finding

#: Share of the samples at which a constraint is due that may be refused without a word [N]: in sound
#: simulated runs none is.
_REFUSED_SHARE: Final = 0.05
#: Mean speed of a foot over the belt at its still samples that is no surprise, m/s [N]: sensors on
#: rolling feet move at less than 0.1 m/s in simulated runs and at 0.3 m/s in the print (spec §1.11);
#: belts of 12 and 14 km/h differ by more.
_SLIP_M_S: Final = 0.5


def refused_constraints(filtered: xr.Dataset) -> list[Finding]:
    """Constraints that the gate often refused.

    Parameters
    ----------
    filtered : Dataset
        From :func:`swaystride.erkf.lower_limbs.estimate_lower_limbs`: ``due`` and ``refused``
        (constraint).

    Returns
    -------
    list of Finding
        ``constraint_refused``, one per constraint.
    """
    due, refused = filtered["due"].to_numpy(), filtered["refused"].to_numpy()
    return [
        Finding(
            "constraint_refused",
            "warning",
            "",
            str(name),
            "innovations within the gate",
            f"refused at {no} of {n} samples",
        )
        for name, n, no in zip(filtered["constraint"].to_numpy(), due, refused, strict=True)
        if no > _REFUSED_SHARE * n
    ]


def belt_speed(estimates: xr.Dataset) -> list[Finding]:
    """Whether the markers on the feet rest on the belt that trials.tsv describes.

    Parameters
    ----------
    estimates : Dataset
        ``foot_position_m`` (source, side, axis, time) in the frame of the belt and
        ``zero_velocity`` (side, time); attributes ``rate_hz`` and ``belt_speed_m_s``.

    Returns
    -------
    list of Finding
        ``belt_speed_contradicts_markers``, or none.
    """
    forward = estimates["foot_position_m"].sel(source="optic", axis="x")
    speed = np.gradient(forward.transpose("side", "time").to_numpy(), axis=1)
    still = estimates["zero_velocity"].transpose("side", "time").to_numpy().astype(bool)
    known = speed[still & np.isfinite(speed)] * float(estimates.attrs["rate_hz"])
    slip = float(np.median(known)) if known.size else 0.0
    if abs(slip) <= _SLIP_M_S:
        return []
    belt = float(estimates.attrs["belt_speed_m_s"])
    return [
        Finding(
            "belt_speed_contradicts_markers",
            "warning",
            "",
            "markers on the feet in stance",
            f"a belt that moves backward at {belt:.2f} m/s, as in trials.tsv",
            f"{belt - slip:.2f} m/s; stride lengths of the markers are wrong by the difference",
        )
    ]
