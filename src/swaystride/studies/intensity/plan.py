"""Plan of the analysis: what is rated, what is measured, which choices (dissertation §3.3.4)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

from swaystride.stats.reliability import ReliabilityForm

RatingLevel = Literal["per_trial", "per_exercise"]
FeatureTransform = Literal["none", "log"]

PARTICIPANT: Final = "participant"
EXERCISE: Final = "exercise"
TRIAL: Final = "trial"
RATER: Final = "rater"

#: A rating belongs to a trial or to the exercise of three trials: key and label.
RATING_LEVELS: Final[dict[RatingLevel, str]] = {
    "per_trial": "per trial",
    "per_exercise": "per exercise",
}

#: Four dimensions of difficulty, in the order of Table 3.2.
DIMENSIONS: Final = {
    "surface": "Surface",
    "stance": "Stance",
    "visual_input": "Visual input",
    "head_movements": "Head movements",
}

#: The eight features of Table 3.3, in its order: label and unit.
FEATURES: Final[dict[str, tuple[str, str]]] = {
    "phi_rms": ("Phi RMS", "deg"),
    "ap_rms": ("AP RMS", "deg"),
    "ml_rms": ("ML RMS", "deg"),
    "phi_mv": ("Phi MV", "deg/s"),
    "ap_mv": ("AP MV", "deg/s"),
    "ml_mv": ("ML MV", "deg/s"),
    "path_length": ("Path length", "deg"),
    "ellipse_area": ("Elliptical area", "deg²"),
}

#: How a feature enters a correlation: key and label.
TRANSFORMS: Final[dict[FeatureTransform, str]] = {"none": "raw", "log": "ln"}

#: Columns of every table of results: key, estimate, both intervals.
RESULT_COLUMNS: Final = (
    "quantity",
    "estimate",
    "se",
    "df",
    "n",
    "ci_low",
    "ci_high",
    "p",
    "participant_ci_low",
    "participant_ci_high",
)


@dataclass(frozen=True)
class IntensityPlan:
    """Choices of the statistical analysis (config/studies/intensity.yaml, ``analysis.model``).

    Parameters
    ----------
    icc_form : {"printed", "recommended"}
        Variance components of the reliability: exercise crossed with the patient, or nested in it.
        They are estimated by REML in either case.
    estimator : {"ml", "reml"}
        Of the models with fixed effects.
    degrees_of_freedom : {"residual", "satterthwaite"}
        Of their tests and intervals.
    exercise_within_patient : bool
        Whether the models of difficulty and of rating differences have a random intercept for the
        exercise within the patient.
    prediction_transform : {"none", "log"}
        How the features enter the prediction of ratings.
    ellipse_measure : {"ellipse_area", "ellipse_area_prediction"}
        Which measure stands for the elliptical area.
    icc_bootstrap_n, icc_bootstrap_seed : int
        Parametric bootstrap of the reliability.
    cluster_bootstrap_n, cluster_bootstrap_seed : int
        Resamples of patients for the participant-level intervals.
    confidence_level : float
    significance_level : float
    processes : int
        Processes of the bootstrap of the reliability; the numbers do not depend on it.
    """

    icc_form: ReliabilityForm
    estimator: Literal["ml", "reml"]
    degrees_of_freedom: Literal["residual", "satterthwaite"]
    exercise_within_patient: bool
    prediction_transform: FeatureTransform
    ellipse_measure: Literal["ellipse_area", "ellipse_area_prediction"]
    icc_bootstrap_n: int
    icc_bootstrap_seed: int
    cluster_bootstrap_n: int
    cluster_bootstrap_seed: int
    confidence_level: float
    significance_level: float
    processes: int

    @property
    def reml(self) -> bool:
        """Whether models with fixed effects are fitted by REML."""
        return self.estimator == "reml"

    def random_terms(self, *, rater: bool) -> list[str]:
        """Random intercepts of a regression of ratings.

        Parameters
        ----------
        rater : bool
            Whether the therapist has one.
        """
        nested = [f"{PARTICIPANT}:{EXERCISE}"] if self.exercise_within_patient else []
        return [PARTICIPANT, *nested, *([RATER] if rater else [])]
