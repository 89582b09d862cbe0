"""Plan of the analysis (Potter et al. 2019, §2.3 and appendix A): models, limits, printed tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from swaystride.studies.imu_design.experiments import ExperimentName

#: Table of the appendix that each experiment fills.
TABLES: Final[dict[ExperimentName, str]] = {
    "accelerometer_range": "table_a1",
    "gyro_range": "table_a2",
    "downsampling": "table_a3",
    "decimation": "table_a4",
}

#: Columns of Tables A1 to A4 that are printed.
SLOPE: Final = "slope_pct_per_m_s"

#: Random intercepts of the two models that are always fitted: as printed, and with one for the
#: trial, because all conditions of a trial share its error.
RANDOM_TERMS: Final[dict[str, tuple[str, ...]]] = {
    "subject": ("participant",),
    "subject_and_trial": ("participant", "participant:trial"),
}

#: Columns of the effects of an experiment, per model.
EFFECT_COLUMNS: Final = (
    "experiment",
    "model",
    "effect",
    SLOPE,
    "se",
    "df",
    "p",
    "ci_low",
    "ci_high",
    "n",
    "n_trials",
    "n_participants",
)


@dataclass(frozen=True)
class ImuDesignPlan:
    """Choices of the statistical analysis (config/studies/imu_design.yaml, ``analysis.model``).

    Parameters
    ----------
    trial_intercept : bool
        Whether the tables rest on the model with a random intercept of the trial within the
        participant.
    confidence_level : float
        Of the profile intervals.
    significance_level : float
        Below which p counts as significant.
    distance_error_limit_pct : float
        Distance error that is still acceptable, either sign.
    sample_walking_speed_m_s, sample_running_speed_m_s : float
        The trials nearest to these speeds are drawn as examples.
    """

    trial_intercept: bool
    confidence_level: float
    significance_level: float
    distance_error_limit_pct: float
    sample_walking_speed_m_s: float
    sample_running_speed_m_s: float

    @property
    def model(self) -> str:
        """The model that the tables rest on: a key of :data:`RANDOM_TERMS`."""
        return "subject_and_trial" if self.trial_intercept else "subject"


def model_formula(model: str) -> str:
    """Formula of a model of the distance error.

    Parameters
    ----------
    model : str
        A key of :data:`RANDOM_TERMS`.

    Examples
    --------
    >>> model_formula("subject")
    'error_pct ~ speed_m_s*condition + (1|participant)'
    """
    random = " + ".join(f"(1|{group})" for group in RANDOM_TERMS[model])
    return f"error_pct ~ speed_m_s*condition + {random}"
