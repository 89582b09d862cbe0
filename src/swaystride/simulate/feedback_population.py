"""The population of the feedback study (dissertation chapter 2): true effects and their scatter.

Only AP RMS, ML RMS and the mean velocity (MV) are free: ``Phi² = AP² + ML²``,
``EA = π z² AP ML √(1 − ρ²) n/(n − 1)`` and ``PL = MV · T`` follow, so that the printed effects of
all six features cannot hold together (register I-02c). The three free features have the printed
effects at the printed exponents as their truth; those of the others are what follows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from swaystride.errors import ConfigurationError
from swaystride.simulate.feedback_truth import FeatureTruth, FeedbackPopulation
from swaystride.simulate.standing_model import TrialSettings
from swaystride.simulate.standing_response import FEATURES, PhysicalInputs
from swaystride.sway.metrics import ELLIPSE_Z

Array = NDArray[np.float64]

#: All features of the chapter, in the order of its tables.
SIX_FEATURES: Final = ("phi_rms", "ap_rms", "ml_rms", "phi_mv", "path_length", "ellipse_area")

#: Model columns (named as in table_2_2.csv) that a design must have.
DESIGN_COLUMNS: Final = (
    "participant",
    "order",
    "block",
    "trial_number",
    "concurrent_feedback_removed",
    "terminal_feedback_removed",
    "age",
    "sex",
    "pendulum_height_m",
)

_QUADRATURE: Final = np.polynomial.hermite_e.hermegauss(31)


@dataclass(frozen=True)
class TrialTruth:
    """What trials are meant to be, and how they come to be it. Rows are trials.

    Parameters
    ----------
    expectation : ndarray, shape (n, 3)
        Expected log features given fixed effects and participant (:data:`FEATURES`).
    scatter : ndarray, shape (n, 3)
        Added between-trial scatter.
    attained : ndarray, shape (n, 3)
        Expectation given the physical inputs: expectation + scatter, except where that lies
        outside the response surface.
    inputs : PhysicalInputs
        Physical inputs.
    """

    expectation: Array
    scatter: Array
    attained: Array
    inputs: PhysicalInputs


def fixed_part(design: pd.DataFrame, population: FeedbackPopulation) -> Array:
    """Expected log AP RMS, ML RMS and MV of the average participant, shape (n, 3).

    Parameters
    ----------
    design : DataFrame
        One row per trial with :data:`DESIGN_COLUMNS`.
    population : FeedbackPopulation
        The truth.

    Raises
    ------
    ConfigurationError
        If a column is missing.
    """
    missing = [name for name in DESIGN_COLUMNS if name not in design]
    if missing:
        raise ConfigurationError(
            "design lacks a column", expected=", ".join(DESIGN_COLUMNS), found=f"no {missing[0]}"
        )
    x = {name: design[name].to_numpy(dtype=np.float64) for name in DESIGN_COLUMNS[1:]}
    columns = []
    for name in FEATURES:
        truth: FeatureTruth = getattr(population, name)
        # 0 ** exponent is 0: the baselines before any training.
        trained = x["trial_number"] ** truth.exponent
        c = truth.coefficients()
        columns.append(
            c["intercept"]
            + c["order"] * x["order"]
            + c["block"] * x["block"]
            + (c["trial_number"] + c["block_x_trial_number"] * x["block"]) * trained
            + c["block_x_order"] * x["block"] * x["order"]
            + (
                c["concurrent_feedback_removed"]
                + c["concurrent_feedback_removed_x_order"] * x["order"]
            )
            * x["concurrent_feedback_removed"]
            + (c["terminal_feedback_removed"] + c["terminal_feedback_removed_x_order"] * x["order"])
            * x["terminal_feedback_removed"]
            + c["age"] * (x["age"] - population.reference_age_years)
            + c["sex"] * x["sex"]
        )
    return np.stack(columns, axis=1)


def draw_trials(
    design: pd.DataFrame, population: FeedbackPopulation, rng: np.random.Generator
) -> TrialTruth:
    """Draw participants and between-trial scatter, and find the physical inputs of every trial.

    The added scatter has the covariance that the body's own scatter (which depends on how active
    the participant stands) leaves of the total.

    Parameters
    ----------
    design : DataFrame
        One row per trial with :data:`DESIGN_COLUMNS`; one or many participants.
    population : FeedbackPopulation
        The truth.
    rng : numpy.random.Generator
        Source of the random numbers: intercepts first, then trials.

    Returns
    -------
    TrialTruth
    """
    response = population.response()
    height = design["pendulum_height_m"].to_numpy(dtype=np.float64)
    people, row_of = np.unique(design["participant"].to_numpy(), return_inverse=True)
    intercepts = (
        rng.standard_normal((len(people), 3)) @ _root(population.spread.participant_covariance()).T
    )
    expectation = fixed_part(design, population) + intercepts[row_of]
    process = response.process_covariance(response.invert(expectation, height))
    added = _root(population.spread.residual_covariance() - process)
    scatter = (added @ rng.standard_normal((len(design), 3, 1)))[..., 0]
    inputs = response.invert(expectation + scatter, height)
    attained = response.expected(
        np.stack([inputs.ln_noise_ap, inputs.ln_noise_ml, inputs.activity, height], axis=1)
    )
    return TrialTruth(expectation, scatter, attained, inputs)


def draw_features(
    design: pd.DataFrame, population: FeedbackPopulation, rng: np.random.Generator
) -> pd.DataFrame:
    """Draw the six log features of a whole cohort without simulating a body.

    For studies of recovery with many cohorts: participants, trials and physical inputs are drawn
    as for the full simulation; the scatter of the 30 s of sway is drawn from its measured
    covariance instead of being simulated.

    Parameters
    ----------
    design : DataFrame
        One row per trial with :data:`DESIGN_COLUMNS`.
    population : FeedbackPopulation
        The truth.
    rng : numpy.random.Generator
        Source of the random numbers.

    Returns
    -------
    DataFrame
        Natural logarithms of :data:`SIX_FEATURES`, rows and index as in `design`.
    """
    response = population.response()
    trials = draw_trials(design, population, rng)
    own = _root(response.process_covariance(trials.inputs))
    features = trials.attained + (own @ rng.standard_normal((len(design), 3, 1)))[..., 0]
    fisher_z = response.fisher_z_sd(trials.inputs) * rng.standard_normal(len(design))
    ln_ap, ln_ml, ln_mv = features.T
    return _six(
        design.index,
        ln_ap=ln_ap,
        ln_ml=ln_ml,
        ln_mv=ln_mv,
        ln_phi=np.logaddexp(2.0 * ln_ap, 2.0 * ln_ml) / 2.0,
        # ½ ln(1 − ρ²) = −ln cosh(artanh ρ)
        ln_shape=-np.log(np.cosh(fisher_z)),
        trial=population.trial,
    )


def expected_log_features(design: pd.DataFrame, population: FeedbackPopulation) -> pd.DataFrame:
    """Expected log features of every row, averaged over participants and trials.

    The free features are exact; Phi RMS and the ellipse area follow by Gauss-Hermite quadrature
    over the scatter of ``ln ML − ln AP`` and over the correlation of AP and ML sway.

    Parameters
    ----------
    design : DataFrame
        One row per trial with :data:`DESIGN_COLUMNS`.
    population : FeedbackPopulation
        The truth.

    Returns
    -------
    DataFrame
        :data:`SIX_FEATURES`, rows and index as in `design`.
    """
    response = population.response()
    expectation = fixed_part(design, population)
    ln_ap, ln_ml, ln_mv = expectation.T
    nodes, weights = _QUADRATURE[0], _QUADRATURE[1] / _QUADRATURE[1].sum()
    spread = population.spread
    total = spread.participant_covariance() + spread.residual_covariance()
    sd = np.sqrt(total[0, 0] + total[1, 1] - 2.0 * total[0, 1])
    difference = (ln_ml - ln_ap)[:, None] + sd * nodes
    height = design["pendulum_height_m"].to_numpy(dtype=np.float64)
    fisher_z = response.fisher_z_sd(response.invert(expectation, height))[:, None] * nodes
    return _six(
        design.index,
        ln_ap=ln_ap,
        ln_ml=ln_ml,
        ln_mv=ln_mv,
        ln_phi=ln_ap + np.logaddexp(0.0, 2.0 * difference) @ weights / 2.0,
        ln_shape=-np.log(np.cosh(fisher_z)) @ weights,
        trial=population.trial,
    )


def variance_ratios(population: FeedbackPopulation) -> dict[str, float]:
    """Variance between participants over that of single trials, of each log feature.

    Parameters
    ----------
    population : FeedbackPopulation
        The truth. The features that follow from others are linearised at the typical values.
    """
    ap, ml = np.exp(
        2.0 * np.log([population.ap_rms.typical_value, population.ml_rms.typical_value])
    )
    gradients = {
        "phi_rms": [ap / (ap + ml), ml / (ap + ml), 0.0],
        "ap_rms": [1.0, 0.0, 0.0],
        "ml_rms": [0.0, 1.0, 0.0],
        "phi_mv": [0.0, 0.0, 1.0],
        "path_length": [0.0, 0.0, 1.0],
        "ellipse_area": [1.0, 1.0, 0.0],
    }
    between, within = (
        population.spread.participant_covariance(),
        population.spread.residual_covariance(),
    )
    return {
        feature: float(np.array(g) @ between @ g / (np.array(g) @ within @ g))
        for feature, g in gradients.items()
    }


def _six(
    index: pd.Index,
    *,
    ln_ap: Array,
    ln_ml: Array,
    ln_mv: Array,
    ln_phi: Array,
    ln_shape: Array,
    trial: TrialSettings,
) -> pd.DataFrame:
    """The six log features from what determines them."""
    n = trial.n_samples
    ln_constant = np.log(np.pi * ELLIPSE_Z**2 * n / (n - 1))
    columns: Mapping[str, Array] = {
        "phi_rms": ln_phi,
        "ap_rms": ln_ap,
        "ml_rms": ln_ml,
        "phi_mv": ln_mv,
        "path_length": ln_mv + np.log((n - 1) / trial.rate_hz),
        "ellipse_area": ln_constant + ln_ap + ln_ml + ln_shape,
    }
    return pd.DataFrame({name: columns[name] for name in SIX_FEATURES}, index=index)


def _root(covariance: Array) -> Array:
    """Square root of covariances, shape (..., 3, 3); what is negative counts as zero."""
    values, vectors = np.linalg.eigh(covariance)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :])
