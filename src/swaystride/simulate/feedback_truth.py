"""What is true of the population of the feedback study; the values stand in ``config/``."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from swaystride.simulate.standing_model import StandingModel, TrialSettings
from swaystride.simulate.standing_response import StandingResponse, checked_response

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FeatureTruth:
    """True model of one free feature's logarithm.

    Parameters
    ----------
    exponent : float
        Of the trial number, as printed.
    concurrent, terminal_minus_concurrent : float
        Printed effects of training per ``trial_number ** exponent`` (Table 2.3).
    concurrent_share : float
        Share of ``β_{Block:N}`` in the printed concurrent effect: 1 where the printed model has
        that term; otherwise its `concurrent` is the common slope of both blocks, and this is the
        share of the concurrent block in it.
    concurrent_removed, terminal_removed : float
        Printed effects of removing feedback in the first block (Table 2.3).
    typical_value : float
        Expected value of the feature where all columns are 0: a woman of the reference age of the
        group that starts with concurrent feedback, in the baseline of her terminal block. In deg
        or deg/s.
    order, block, block_x_order : float
        Unprinted coefficients.
    concurrent_removed_x_order, terminal_removed_x_order : float
        Unprinted coefficients.
    age_per_year, sex : float
        Unprinted coefficients: per year above the reference age; of men.
    """

    exponent: float
    concurrent: float
    terminal_minus_concurrent: float
    concurrent_share: float
    concurrent_removed: float
    terminal_removed: float
    typical_value: float
    order: float
    block: float
    block_x_order: float
    concurrent_removed_x_order: float
    terminal_removed_x_order: float
    age_per_year: float
    sex: float

    def coefficients(self) -> dict[str, float]:
        """Coefficients of the model, named by the columns of Table 2.2.

        The printed effects are those of the first block (spec §8.3): concurrent training is
        ``β_N + share · β_{Block:N}``, terminal minus concurrent ``−β_{Block:N}``, and terminal
        removal ``β_TR + β_{TR:Order}``, because who has the terminal block first has Order = 1.

        Examples
        --------
        >>> truth = FeatureTruth(
        ...     exponent=0.1, concurrent=0.044, terminal_minus_concurrent=-0.116,
        ...     concurrent_share=1.0, concurrent_removed=-0.170, terminal_removed=-0.027,
        ...     typical_value=1.4, order=0.0, block=0.0, block_x_order=0.0,
        ...     concurrent_removed_x_order=0.0, terminal_removed_x_order=0.05,
        ...     age_per_year=0.0, sex=0.0)
        >>> coefficients = truth.coefficients()
        >>> round(coefficients["trial_number"], 6), round(coefficients["block_x_trial_number"], 6)
        (-0.072, 0.116)
        >>> round(coefficients["terminal_feedback_removed"], 6)
        -0.077
        """
        return {
            "intercept": float(np.log(self.typical_value)),
            "order": self.order,
            "block": self.block,
            "trial_number": self.concurrent
            + self.concurrent_share * self.terminal_minus_concurrent,
            "concurrent_feedback_removed": self.concurrent_removed,
            "terminal_feedback_removed": self.terminal_removed - self.terminal_removed_x_order,
            "block_x_trial_number": -self.terminal_minus_concurrent,
            "block_x_order": self.block_x_order,
            "concurrent_feedback_removed_x_order": self.concurrent_removed_x_order,
            "terminal_feedback_removed_x_order": self.terminal_removed_x_order,
            "age": self.age_per_year,
            "sex": self.sex,
        }


@dataclass(frozen=True)
class FeedbackSpread:
    """Scatter of the log features between participants and between trials.

    Parameters
    ----------
    participant_sd, participant_correlation : float
        Standard deviation of the participants' intercepts, the same for the three free features,
        and their correlation.
    residual_sd_ap, residual_sd_ml, residual_sd_mv : float
        Total standard deviation of single trials about the participant's expectation: what the
        body scatters by itself plus what is added between trials.
    residual_correlation_ap_ml, residual_correlation_ap_mv, residual_correlation_ml_mv : float
        Correlations of the total scatter.
    """

    participant_sd: float
    participant_correlation: float
    residual_sd_ap: float
    residual_sd_ml: float
    residual_sd_mv: float
    residual_correlation_ap_ml: float
    residual_correlation_ap_mv: float
    residual_correlation_ml_mv: float

    def participant_covariance(self) -> Array:
        """Covariance of the participants' intercepts, shape (3, 3)."""
        correlation = np.full((3, 3), self.participant_correlation)
        np.fill_diagonal(correlation, 1.0)
        return np.asarray(self.participant_sd**2 * correlation)

    def residual_covariance(self) -> Array:
        """Total covariance of single trials, shape (3, 3)."""
        correlation = np.eye(3)
        rows, columns = np.triu_indices(3, 1)
        correlation[rows, columns] = correlation[columns, rows] = (
            self.residual_correlation_ap_ml,
            self.residual_correlation_ap_mv,
            self.residual_correlation_ml_mv,
        )
        sd = np.array([self.residual_sd_ap, self.residual_sd_ml, self.residual_sd_mv])
        return np.asarray(correlation * np.outer(sd, sd))


@dataclass(frozen=True)
class FeedbackPopulation:
    """Everything that is true of the population.

    Parameters
    ----------
    ap_rms, ml_rms, phi_mv : FeatureTruth
        Models of the free features.
    spread : FeedbackSpread
        Scatter.
    reference_age_years : float
        Age at which the age term is zero.
    standing, trial : StandingModel, TrialSettings
        Body and trial; the response surface must have been fitted for them.
    """

    ap_rms: FeatureTruth
    ml_rms: FeatureTruth
    phi_mv: FeatureTruth
    spread: FeedbackSpread
    reference_age_years: float
    standing: StandingModel
    trial: TrialSettings

    def response(self) -> StandingResponse:
        """The response surface, checked against the settings."""
        return checked_response(self.standing, self.trial)
