"""Plan of the analysis: what is measured, which model, which effects (dissertation §2.3.3)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

from swaystride.studies.feedback.design import TrialNumberCoding

#: The six features of the chapter, in the order of its tables: label and unit.
FEATURES: Final[dict[str, tuple[str, str]]] = {
    "phi_rms": ("Phi RMS", "deg"),
    "ap_rms": ("AP RMS", "deg"),
    "ml_rms": ("ML RMS", "deg"),
    "phi_mv": ("MV", "deg/s"),
    "path_length": ("PL", "deg"),
    "ellipse_area": ("EA", "deg²"),
}

TRIAL_NUMBER: Final = "trial_number"
BLOCK_X_TRIAL_NUMBER: Final = "block:trial_number"
CONCURRENT_REMOVED: Final = "concurrent_feedback_removed"
TERMINAL_REMOVED: Final = "terminal_feedback_removed"
TERMINAL_REMOVED_X_ORDER: Final = "terminal_feedback_removed:order"

#: Effects of direct interest; their terms are never eliminated (§2.3.3).
TERMS_OF_INTEREST: Final = (TRIAL_NUMBER, CONCURRENT_REMOVED, TERMINAL_REMOVED)

#: Maximal model of §2.3.3, in the order of the columns of Table 2.2.
MAXIMAL_TERMS: Final = (
    "order",
    "block",
    TRIAL_NUMBER,
    CONCURRENT_REMOVED,
    TERMINAL_REMOVED,
    BLOCK_X_TRIAL_NUMBER,
    "block:order",
    "concurrent_feedback_removed:order",
    TERMINAL_REMOVED_X_ORDER,
    "age",
    "sex",
)


@dataclass(frozen=True)
class ModelPlan:
    """Choices of the statistical analysis (config/studies/feedback.yaml, ``analysis.model``).

    Parameters
    ----------
    trial_number_coding : {"continue", "reset"}
        See :func:`swaystride.studies.feedback.design.model_variables`.
    ellipse_measure : str
        Which measure stands for the elliptical area.
    smallest_exponent, largest_exponent, exponent_step : float
        Grid of the exponent on the trial number.
    printed_exponents : mapping of str to float
        Exponent of each feature in Table 2.2.
    printed_terms : mapping of str to sequence of str
        Fixed effects of each feature's final model in Table 2.2, intercept aside.
    estimator : {"ml", "reml"}
        Of the models whose effects are reported; selection is by maximum likelihood.
    degrees_of_freedom : {"residual", "satterthwaite"}
    confidence_level : float
    significance_level : float
    last_training_trial : int
        Trial number at the end of the first block, for Table 2.4.
    """

    trial_number_coding: TrialNumberCoding
    ellipse_measure: Literal["ellipse_area", "ellipse_area_prediction"]
    smallest_exponent: float
    largest_exponent: float
    exponent_step: float
    printed_exponents: Mapping[str, float]
    printed_terms: Mapping[str, Sequence[str]]
    estimator: Literal["ml", "reml"]
    degrees_of_freedom: Literal["residual", "satterthwaite"]
    confidence_level: float
    significance_level: float
    last_training_trial: int


@dataclass(frozen=True)
class Effect:
    """An effect as a weighted sum of fixed effects.

    Parameters
    ----------
    panel : {"training", "removal", "block_change"}
        Upper and lower half of Table 2.3; Table 2.4.
    name : {"concurrent", "terminal", "terminal_minus_concurrent"}
    weights : mapping of str to float
        Weight of each term.
    required : tuple of str
        Terms without which the effect does not exist: if selection dropped one, the effect comes
        from a refit with it.
    """

    panel: Literal["training", "removal", "block_change"]
    name: Literal["concurrent", "terminal", "terminal_minus_concurrent"]
    weights: Mapping[str, float]
    required: tuple[str, ...] = ()


def effects(exponent: float, last_training_trial: int) -> list[Effect]:
    """Effects of Tables 2.3 and 2.4, for the first training block (spec §8.3, "Effects").

    In the first block, concurrent feedback means ``block`` 1 and ``order`` 0, terminal feedback
    ``block`` 0 and ``order`` 1. The last trial of the block is a trial without feedback.

    Parameters
    ----------
    exponent : float
        Exponent a on the trial number.
    last_training_trial : int
        Trial number N at the end of the block.

    Returns
    -------
    list of Effect
        In the order of the printed tables.

    Examples
    --------
    >>> training = effects(0.5, 15)[0]
    >>> training.panel, dict(training.weights)
    ('training', {'trial_number': 1.0, 'block:trial_number': 1.0})
    """
    end = float(last_training_trial) ** exponent
    concurrent_change = {
        TRIAL_NUMBER: end,
        BLOCK_X_TRIAL_NUMBER: end,
        CONCURRENT_REMOVED: 1.0,
    }
    terminal_change = {
        TRIAL_NUMBER: end,
        TERMINAL_REMOVED: 1.0,
        TERMINAL_REMOVED_X_ORDER: 1.0,
    }
    change_difference = {
        BLOCK_X_TRIAL_NUMBER: -end,
        TERMINAL_REMOVED: 1.0,
        TERMINAL_REMOVED_X_ORDER: 1.0,
        CONCURRENT_REMOVED: -1.0,
    }
    return [
        Effect("training", "concurrent", {TRIAL_NUMBER: 1.0, BLOCK_X_TRIAL_NUMBER: 1.0}),
        Effect(
            "training",
            "terminal_minus_concurrent",
            {BLOCK_X_TRIAL_NUMBER: -1.0},
            required=(BLOCK_X_TRIAL_NUMBER,),
        ),
        Effect("removal", "concurrent", {CONCURRENT_REMOVED: 1.0}),
        Effect("removal", "terminal", {TERMINAL_REMOVED: 1.0, TERMINAL_REMOVED_X_ORDER: 1.0}),
        Effect("block_change", "concurrent", concurrent_change),
        Effect("block_change", "terminal", terminal_change),
        Effect(
            "block_change",
            "terminal_minus_concurrent",
            change_difference,
            required=(BLOCK_X_TRIAL_NUMBER,),
        ),
    ]
