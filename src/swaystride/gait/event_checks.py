"""What is doubtful about the events of a run: uneven steps, strides that were rejected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import pandas as pd

from swaystride.findings import Finding
from swaystride.gait.running_events import SIDES


@dataclass(frozen=True)
class EventLimits:
    """From when on events are doubtful.

    Parameters
    ----------
    most_uneven : float
        Largest difference of the median step times of both feet, as a share of their mean. A foot
        sensor that lags behind the other one makes one step longer and the next one shorter.
    most_rejected : float
        Largest share of strides outside the rule.
    least_strides : int
        Fewer strides say nothing.
    """

    most_uneven: float
    most_rejected: float
    least_strides: int


#: [N]: simulated runners differ by 1 % from foot to foot; 15 strides as for the variability of
#: coordination.
USUAL_EVENTS: Final = EventLimits(0.1, 0.1, 15)


def event_findings(strides: pd.DataFrame, limits: EventLimits, *, file: str) -> list[Finding]:
    """Check the strides of a run.

    Parameters
    ----------
    strides : DataFrame
        As from :func:`swaystride.gait.spatiotemporal.running_strides`.
    limits : EventLimits
    file : str
        Of the run, for the findings.

    Returns
    -------
    list of Finding
        Warnings ``few_strides``, ``strides_rejected`` and ``steps_uneven``.

    Examples
    --------
    >>> strides = pd.DataFrame({"side": ["right", "left"] * 20, "step_time_s": [0.38, 0.32] * 20,
    ...                         "is_valid": True})
    >>> [finding.check for finding in event_findings(strides, USUAL_EVENTS, file="R01.h5")]
    ['steps_uneven']
    """
    valid = strides[strides["is_valid"]]
    if len(valid) < limits.least_strides:
        return [
            Finding(
                "few_strides",
                "warning",
                file,
                "",
                f"{limits.least_strides} valid strides at least",
                f"{len(valid)} of {len(strides)}",
            )
        ]
    found: list[Finding] = []
    rejected = 1.0 - len(valid) / len(strides)
    if rejected > limits.most_rejected:
        expected = f"{100 * limits.most_rejected:g} % at most"
        measured = f"{100 * rejected:.0f} % of {len(strides)} strides"
        found.append(Finding("strides_rejected", "warning", file, "", expected, measured))
    step = valid.groupby("side")["step_time_s"].median().reindex(list(SIDES))
    uneven = float((step["right"] - step["left"]) / step.mean())
    # a missing foot is uneven as well
    if not abs(uneven) <= limits.most_uneven:
        expected = f"steps of both feet alike within {100 * limits.most_uneven:g} %"
        measured = f"{step['right']:.3f} s from the right foot, {step['left']:.3f} s from the left"
        found.append(Finding("steps_uneven", "warning", file, "feet", expected, measured))
    return found
