"""Inputs of the rules of the intensity study, as functions of their wildcards."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

from participant_rules import ParticipantRules
from project import Project

#: The lab's tables.
LAB_TABLES: Final = ("participants", "raters", "trials", "ratings")

#: What the job of each block of the analysis writes.
MODEL_FILES: Final = {
    "reliability": ("results", "components"),
    "difficulty": ("results", "residuals"),
    "self_ratings": ("results", "predictions"),
    "kinematics": ("correlations", "results", "left_out", "predicted", "dropped", "findings"),
}

#: Blocks of the analysis that each table needs.
TABLE_BLOCKS: Final = {
    "table_3_1": (),
    "cohort": (),
    "rating_counts": (),
    "table_3_2": ("difficulty",),
    "table_3_3": ("kinematics",),
    "study3_text": tuple(MODEL_FILES),
    "variance_components": ("reliability",),
    "prediction": ("self_ratings", "kinematics"),
    "dropped_features": ("kinematics",),
    "coverage": tuple(MODEL_FILES),
    "claims": tuple(MODEL_FILES),
}

#: Results of the variant that each figure needs.
FIGURE_FILES: Final = {
    "figure_3_3a": ("models/ratings.parquet",),
    "figure_3_3b": ("models/ratings.parquet",),
    "figure_3_4a": ("models/kinematics/predicted.parquet",),
    "figure_3_4b": ("models/kinematics/predicted.parquet",),
    "figure_difficulty": ("tables/table_3_2.csv",),
    "figure_residuals": ("models/difficulty/residuals.parquet",),
}

#: Printed numbers of the chapter.
PRINTED_TABLES: Final = tuple(
    f"data/published/{name}.csv" for name in ("table_3_2", "table_3_3", "study3_text")
)

#: Recovery: cohorts in one job, and the first seed of each job; 100 in all, fixed beforehand.
RECOVERY_BATCH: Final = 10
RECOVERY_FIRST_SEEDS: Final = tuple(range(3101, 3201, RECOVERY_BATCH))


def block_files(block: str) -> list[str]:
    """Files of one block of the analysis, with the wildcards of its rule."""
    folder = f"results/{{cohort}}/intensity/{{variant}}/models/{block}"
    return [f"{folder}/{name}.parquet" for name in MODEL_FILES[block]]


class IntensityRules(ParticipantRules):
    """Input functions of the intensity study.

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        super().__init__(project, "intensity", LAB_TABLES)

    def table_models(self, wildcards: Any) -> list[str]:
        """Model files that one table needs."""
        return self._models(wildcards, TABLE_BLOCKS[wildcards.table])

    def figure_files(self, wildcards: Any) -> list[str]:
        """Results that one figure needs."""
        folder = f"{self.results(wildcards)}/{wildcards.variant}"
        return [f"{folder}/{file}" for file in FIGURE_FILES[wildcards.figure]]

    def all_models(self, wildcards: Any) -> list[str]:
        """All model files of the variant."""
        return self._models(wildcards, MODEL_FILES)

    def _models(self, wildcards: Any, blocks: Iterable[str]) -> list[str]:
        """Files of some blocks of the analysis."""
        return [
            file.format(cohort=wildcards.cohort, variant=wildcards.variant)
            for block in blocks
            for file in block_files(block)
        ]
