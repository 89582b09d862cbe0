"""Rows of results/validation/summary.csv: our value beside a number that somebody else found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, dataclass
from typing import Final

import numpy as np
import pandas as pd

SUMMARY_COLUMNS: Final = (
    "dataset",
    "quantity",
    "value",
    "reference",
    "reference_source",
    "tolerance",
    "within",
)


@dataclass(frozen=True)
class Check:
    """One quantity of one data set.

    Parameters
    ----------
    dataset, quantity : str
        What was computed on what.
    value : float
        Ours.
    reference : float
        Theirs; NaN where nobody published one and the value is only reported.
    reference_source : str
        Where the reference comes from.
    tolerance : float
        Largest accepted absolute difference; NaN if only reported.
    """

    dataset: str
    quantity: str
    value: float
    reference: float
    reference_source: str
    tolerance: float

    @property
    def within(self) -> str:
        """``yes``, ``no``, or ``reported`` if there is nothing to compare with."""
        if np.isnan(self.reference):
            return "reported"
        return "yes" if abs(self.value - self.reference) <= self.tolerance else "no"


def reported(dataset: str, quantity: str, value: float, note: str) -> Check:
    """Row of a quantity that has no published counterpart.

    Parameters
    ----------
    dataset, quantity : str
        What was computed on what.
    value : float
        Ours.
    note : str
        What the reader should know, in place of a source.
    """
    return Check(dataset, quantity, float(value), float("nan"), note, float("nan"))


def summary_frame(checks: Iterable[Check]) -> pd.DataFrame:
    """Table of `checks`, in their order.

    Examples
    --------
    >>> row = Check("plate", "area", 1.02, 1.0, "authors", 0.05)
    >>> summary_frame([row])["within"].tolist()
    ['yes']
    """
    rows = [{**asdict(check), "within": check.within} for check in checks]
    return pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS))
