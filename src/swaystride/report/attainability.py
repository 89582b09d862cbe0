"""Printed values that no cohort can have: they are shown and marked, and not counted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import pandas as pd

from swaystride.errors import ConfigurationError
from swaystride.report.table_join import canonical_key, cell_text


@dataclass(frozen=True)
class Unattainable:
    """Rows whose printed value no cohort can have, and why.

    Parameters
    ----------
    where : mapping of str to str
        Key columns and their values; keys that are left out match every row.
    reason : str
        Why, in one sentence.
    quantities : tuple of str
        Value columns concerned; empty for all.

    Examples
    --------
    >>> Unattainable({"feature": "phi_rms"}, "Contradicts its parts.").quantities
    ()
    """

    where: Mapping[str, str]
    reason: str
    quantities: tuple[str, ...] = field(default=())


def attainability(
    named: Mapping[str, Any],
    quantity: str,
    right: Mapping[str, Any],
    rules: Sequence[Unattainable],
) -> dict[str, Any]:
    """Tell whether the printed value of a row can be attained, and if not, why.

    Parameters
    ----------
    named : mapping
        Key columns of the row and their values.
    quantity : str
        Value column.
    right : mapping
        The reproduced row; its columns ``attainable`` (0/1) and ``attainable_reason`` count too.
    rules : sequence of Unattainable
        What the text of the page says.

    Examples
    --------
    >>> rules = [Unattainable({"feature": "phi_rms"}, "Contradicts its parts.")]
    >>> attainability({"feature": "phi_rms"}, "estimate", {}, rules)
    {'attainable': False, 'reason': 'Contradicts its parts.'}
    """
    reasons = [rule.reason for rule in rules if _matches(rule, named, quantity)]
    if cell_text(right.get("attainable")) in {"0", "0.0", "False"}:
        reasons.append(cell_text(right.get("attainable_reason")) or "marked by the analysis")
    return {"attainable": not reasons, "reason": " ".join(dict.fromkeys(reasons))}


def _matches(rule: Unattainable, named: Mapping[str, Any], quantity: str) -> bool:
    return (not rule.quantities or quantity in rule.quantities) and all(
        name in named and canonical_key(named[name]) == canonical_key(wanted)
        for name, wanted in rule.where.items()
    )


def require_used(frame: pd.DataFrame, rules: Sequence[Unattainable]) -> None:
    """Refuse a rule that marks nothing: it is a typing error.

    Parameters
    ----------
    frame : pandas.DataFrame
        A comparison.
    rules : sequence of Unattainable
        The rules that were applied to it.

    Raises
    ------
    ConfigurationError
        If a rule matches no row of the comparison.

    Examples
    --------
    >>> require_used(pd.DataFrame({"feature": ["phi_rms"], "compared": ["p"]}), [])
    """
    rows = frame.astype(object).to_dict("records")
    for rule in rules:
        if not any(
            _matches(rule, {str(k): v for k, v in row.items()}, row["compared"]) for row in rows
        ):
            raise ConfigurationError(
                "rule for unattainable rows matches no row",
                expected="key columns and values of the table",
                found=", ".join(f"{name}={value}" for name, value in rule.where.items()),
            )
