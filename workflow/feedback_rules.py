"""Inputs of the rules of the feedback study, as functions of their wildcards."""

from __future__ import annotations

from typing import Any, Final

from participant_rules import ParticipantRules
from project import Project

#: Features of the study, one model job each.
FEATURES: Final = ("phi_rms", "ap_rms", "ml_rms", "phi_mv", "path_length", "ellipse_area")

#: What a model job writes.
MODEL_FILES: Final = ("fixed_effects", "contrasts", "exponents", "elimination", "predictions")

#: Recovery: cohorts at the level of features, and seeds of whole cohorts from raw files.
RECOVERY_COHORTS: Final = 200
RECOVERY_RAW_SEEDS: Final = (101, 102, 103, 104, 105)


class FeedbackRules(ParticipantRules):
    """Input functions of the feedback study.

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        super().__init__(project, "feedback", ("participants", "trials"))

    def models(self, wildcards: Any) -> list[str]:
        """All model files of the variant."""
        folder = f"{self.results(wildcards)}/{wildcards.variant}/models"
        return [
            f"{folder}/{feature}/{name}.parquet" for feature in FEATURES for name in MODEL_FILES
        ]

    def truth(self, wildcards: Any) -> list[str]:
        """Expected features and their weights, of simulated cohorts only."""
        if not self.project.is_simulated(wildcards.cohort):
            return []
        folder = f"{self.raw(wildcards)}/truth"
        return [f"{folder}/expected.tsv", f"{folder}/variance_ratios.tsv"]
