"""Inputs of the rules of the IMU-design study, as functions of their wildcards."""

from __future__ import annotations

from typing import Any, Final

from participant_rules import ParticipantRules
from project import Project

#: Files of the models, by what needs them.
MODELS: Final = ("observations", "effects", "components", "residuals")

#: Model files that each table needs; tables of people and sensors need none.
TABLE_MODELS: Final = {
    "table_1": (),
    "table_a1": ("effects",),
    "table_a2": ("effects",),
    "table_a3": ("effects",),
    "table_a4": ("effects",),
    "imu_design_text": ("observations", "effects"),
    "model_comparison": ("effects",),
    "variance_components": ("components",),
    "requirements": ("observations", "effects"),
    "recommendation": ("observations", "effects"),
    "cohort": (),
    "speeds": ("observations",),
    "claims": ("observations", "effects"),
}

#: Figures that draw recordings.
RAW_FIGURES: Final = ("figure_4", "figure_8")

#: Model files that each of the other figures needs.
FIGURE_MODELS: Final = {
    **{f"figure_{n}": ("observations",) for n in range(3, 13) if f"figure_{n}" not in RAW_FIGURES},
    "figure_residuals": ("observations", "residuals"),
}

#: Recovery: seeds of whole cohorts, fixed beforehand.
RECOVERY_SEEDS: Final = tuple(range(2601, 2621))


class ImuDesignRules(ParticipantRules):
    """Input functions of the IMU-design study.

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        super().__init__(project, "imu_design", ("participants", "trials"))

    def quality_parts(self, wildcards: Any) -> list[str]:
        """Findings, exclusions and measures of every participant, of the base variant."""
        folder = f"{self.results(wildcards)}/{self.project.base_variant}"
        return [
            *super().quality_parts(wildcards),
            *(
                f"{folder}/{kind}"
                for participant in self.participants(wildcards)
                for kind in (f"findings/{participant}.csv", f"metrics/{participant}.parquet")
            ),
        ]

    def ranges(self, wildcards: Any) -> list[str]:
        """Largest readings of the recordings of every participant."""
        folder = f"{self.results(wildcards)}/quality/ranges"
        return [f"{folder}/{participant}.csv" for participant in self.participants(wildcards)]

    def table_models(self, wildcards: Any) -> list[str]:
        """Model files that one table needs."""
        return self._models(wildcards, TABLE_MODELS[wildcards.table])

    def figure_models(self, wildcards: Any) -> list[str]:
        """Model files that one figure needs."""
        return self._models(wildcards, FIGURE_MODELS[wildcards.figure])

    def strides(self, wildcards: Any) -> list[str]:
        """Strides of every participant, of the variant or of the base that it shares."""
        folder = self.strides_folder(wildcards)
        return [f"{folder}/{participant}.parquet" for participant in self.participants(wildcards)]

    def stride_errors(self, wildcards: Any) -> list[str]:
        """Strides against the truth, of every participant."""
        folder = f"{self.results(wildcards)}/stride_errors"
        return [f"{folder}/{participant}.parquet" for participant in self.participants(wildcards)]

    def methods(self, wildcards: Any) -> list[str]:
        """Foot methods of all variants that measure by themselves."""
        return [
            f"{self.results(wildcards)}/{variant}/parameters/analysis.measurement.json"
            for variant in self.measuring_variants
        ]

    @property
    def measuring_variants(self) -> list[str]:
        """Variants with a foot method of their own."""
        return [
            variant
            for variant in self.project.variants(self.study)
            if self.project.source_variant(self.study, variant, "metrics") == variant
        ]

    def strides_folder(self, wildcards: Any) -> str:
        """Folder of the strides."""
        variant = self.project.source_variant(self.study, wildcards.variant, "metrics")
        return f"{self.results(wildcards)}/{variant}/strides"

    def _models(self, wildcards: Any, names: tuple[str, ...]) -> list[str]:
        """Some of the model files of the variant."""
        folder = f"{self.results(wildcards)}/{wildcards.variant}/models"
        return [f"{folder}/{name}.parquet" for name in names]
