"""Inputs of the rules of the feedback study, as functions of their wildcards."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from project import Project

#: Features of the study, one model job each.
FEATURES: Final = ("phi_rms", "ap_rms", "ml_rms", "phi_mv", "path_length", "ellipse_area")

#: What a model job writes.
MODEL_FILES: Final = ("fixed_effects", "contrasts", "exponents", "elimination", "predictions")

#: Recovery: cohorts at the level of features, and seeds of whole cohorts from raw files.
RECOVERY_COHORTS: Final = 200
RECOVERY_RAW_SEEDS: Final = (101, 102, 103, 104, 105)


class FeedbackRules:
    """Input functions; ``wildcards`` is what Snakemake passes.

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        self.project = project

    def raw(self, wildcards: Any) -> str:
        """Folder of the raw files."""
        return self.project.raw_folder(wildcards.cohort, "feedback")

    def participants(self, wildcards: Any) -> list[str]:
        """Names of the participants."""
        return self.project.units("feedback", wildcards.cohort)

    def parameters(self, *sections: str) -> Callable[[Any], str]:
        """File with the parameters of these sections: of the variant, or of the base variant."""

        def file(wildcards: Any) -> str:
            variant = getattr(wildcards, "variant", self.project.base_variant)
            folder = f"results/{wildcards.cohort}/feedback/{variant}/parameters"
            return f"{folder}/{'+'.join(sections)}.json"

        return file

    def design_tables(self, wildcards: Any) -> list[str]:
        """The lab's two tables."""
        raw = self.raw(wildcards)
        return [f"{raw}/participants.tsv", f"{raw}/trials.tsv"]

    def recordings(self, wildcards: Any) -> list[str]:
        """Raw files of one participant; a file that is named but absent is the import's to say."""
        if self.project.is_simulated(wildcards.cohort):
            return [f"{self.raw(wildcards)}/{wildcards.participant}"]
        return self.project.existing_files("feedback", wildcards.cohort, wildcards.participant)

    def quality_parts(self, wildcards: Any) -> list[str]:
        """Findings and exclusions of every participant."""
        folder = f"results/{wildcards.cohort}/feedback/quality"
        return [
            f"{folder}/{kind}/{participant}.csv"
            for kind in ("findings", "exclusions")
            for participant in self.participants(wildcards)
        ]

    def metrics(self, wildcards: Any) -> list[str]:
        """Measures of every participant, of the variant or of the base that it shares."""
        variant = self.project.source_variant("feedback", wildcards.variant, "metrics")
        return [
            f"results/{wildcards.cohort}/feedback/{variant}/metrics/{participant}.parquet"
            for participant in self.participants(wildcards)
        ]

    def models(self, wildcards: Any) -> list[str]:
        """All model files of the variant."""
        folder = f"results/{wildcards.cohort}/feedback/{wildcards.variant}/models"
        return [
            f"{folder}/{feature}/{name}.parquet" for feature in FEATURES for name in MODEL_FILES
        ]

    def truth(self, wildcards: Any) -> list[str]:
        """Expected features and their weights, of simulated cohorts only."""
        if not self.project.is_simulated(wildcards.cohort):
            return []
        folder = f"{self.raw(wildcards)}/truth"
        return [f"{folder}/expected.tsv", f"{folder}/variance_ratios.tsv"]

    def all_recordings(self, wildcards: Any) -> list[str]:
        """Recordings of every participant; the first with usable trials is the exemplar."""
        folder = f"results/{wildcards.cohort}/feedback/recordings"
        return [f"{folder}/{participant}.nc" for participant in self.participants(wildcards)]
