"""From a mixed-model formula and a table to a checked design and its outcome."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pandas as pd
from formulaic import Formula
from formulaic.errors import FormulaicError

from swaystride.errors import ModelError
from swaystride.stats.grouping_factor import FloatArray
from swaystride.stats.mixed_design import (
    MixedDesign,
    check_columns,
    check_finite,
    factors_from_frame,
)
from swaystride.stats.mixed_formula import MixedFormula


@lru_cache(maxsize=256)
def _fixed_part(text: str) -> Formula:
    return Formula(text)


def design_from_formula(
    formula: MixedFormula, frame: pd.DataFrame
) -> tuple[MixedDesign, FloatArray]:
    """Design and outcome of a formula.

    Parameters
    ----------
    formula : MixedFormula
    frame : pandas.DataFrame

    Returns
    -------
    MixedDesign
    array, shape (n,)
        The outcome.

    Raises
    ------
    ModelError
        If the formula or the table is not what the model needs.

    Examples
    --------
    >>> from swaystride.stats.mixed_formula import parse_mixed_formula
    >>> table = pd.DataFrame({"y": [1.0, 4, 2, 5], "s": list("uvuv"), "who": list("aabb")})
    >>> design, y = design_from_formula(parse_mixed_formula("y ~ s + (1|who)"), table)
    >>> design.names
    ('Intercept', 's[T.v]')
    """
    try:
        parsed = _fixed_part(formula.fixed)
        needed = sorted(map(str, parsed.required_variables))
    except FormulaicError as error:
        raise ModelError(
            "the fixed part cannot be read", place=formula.text, found=_first_line(error)
        ) from None
    check_columns(frame, needed)
    try:
        matrices = parsed.get_model_matrix(frame[needed], context={}, na_action="ignore")
    except FormulaicError as error:
        raise ModelError(
            "the fixed part cannot be evaluated", place=formula.text, found=_first_line(error)
        ) from None
    outcome = matrices.lhs
    if outcome.shape[1] != 1:
        raise ModelError(
            "the outcome is not one numeric column",
            place=formula.text,
            found=", ".join(map(str, outcome.columns)),
        )
    y = outcome.to_numpy(dtype=float)
    check_finite(y, list(outcome.columns))
    X = np.ascontiguousarray(matrices.rhs.to_numpy(dtype=float))
    names = tuple(map(str, matrices.rhs.columns))
    if not names:
        raise ModelError("there is no fixed effect, not even an intercept", place=formula.text)
    return MixedDesign(X, names, factors_from_frame(frame, formula.groups)), y[:, 0]


def _first_line(error: Exception) -> str:
    """First line of a formulaic message, without its terminal colours."""
    lines = str(error).split("\n")
    return lines[0] if lines else type(error).__name__
