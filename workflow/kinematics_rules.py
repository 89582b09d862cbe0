"""Inputs of the rules of the kinematics study, as functions of their wildcards."""

from __future__ import annotations

from typing import Any, Final

from participant_rules import ParticipantRules
from project import Project
from swaystride.errors import ConfigurationError

#: Tables of the stages that each result table needs; those of people and noise need none.
TABLE_INPUTS: Final = {
    "table_4_1": (),
    "table_4_2": (),
    "table_4_3": ("agreement",),
    "table_4_4": ("strides",),
    "table_4_5": ("strides",),
    "table_4_6": ("strides",),
    "table_4_7": ("strides",),
    "table_4_8": ("perturbation",),
    "table_4_9": ("agreement", "course"),
    "table_4_10": ("agreement", "course"),
    "study4_text": ("strides", "agreement", "planar", "course"),
    "cohort": (),
    "agreement_by_trial": ("agreement",),
    "claims": ("strides", "agreement", "planar", "course", "perturbation"),
}

#: Tables of errors against the truth of a simulated cohort.
TRUTH_TABLES: Final = {
    "truth_angles": ("truth",),
    "truth_summary": ("truth",),
    "truth_strides": ("truth_strides",),
}

#: What each figure needs; the first analysed trial is the representative one.
FIGURE_INPUTS: Final = {
    "figure_4_5": ("agreement", "strides", "estimates"),
    "figure_4_7": ("agreement", "curves"),
    "figure_4_8": ("agreement", "perturbation_curves"),
    "figure_4_8_hip": ("agreement", "perturbation_curves"),
    "figure_4_9": ("agreement", "strides", "estimates"),
    "figure_4_10": ("agreement", "strides", "estimates"),
    "figure_4_11": ("agreement", "curves"),
    "figure_4_12": ("agreement", "strides"),
    "figure_truth": ("agreement", "truth"),
}


class KinematicsRules(ParticipantRules):
    """Input functions of the kinematics study.

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        super().__init__(project, "kinematics", ("participants", "trials"))

    def quality_parts(self, wildcards: Any) -> list[str]:
        """Findings and exclusions of the import; findings and strides of the base variant."""
        folder = f"{self.results(wildcards)}/{self.project.base_variant}"
        kinds = ("findings/estimate/{}.csv", "findings/measure/{}.csv", "strides/{}.parquet")
        return [
            *super().quality_parts(wildcards),
            *(
                f"{folder}/{kind.format(participant)}"
                for participant in self.participants(wildcards)
                for kind in kinds
            ),
        ]

    def source_folder(self, wildcards: Any) -> str:
        """Folder with the stages of the variant, or of the base that it shares."""
        variant = self.project.source_variant(self.study, wildcards.variant, "metrics")
        return f"{self.results(wildcards)}/{variant}"

    def table_inputs(self, wildcards: Any) -> list[str]:
        """Tables of the stages that one result table needs."""
        kinds = TABLE_INPUTS[wildcards.table]
        if wildcards.table == "table_4_8" and self.project.is_simulated(wildcards.cohort):
            kinds = (*kinds, "truth")
        return self._stage_files(wildcards, kinds)

    def truth_inputs(self, wildcards: Any) -> list[str]:
        """Errors against the truth that one table needs."""
        return self._stage_files(wildcards, TRUTH_TABLES[wildcards.table])

    def figure_inputs(self, wildcards: Any) -> list[str]:
        """Tables and estimates that one figure needs."""
        return self._stage_files(wildcards, FIGURE_INPUTS[wildcards.figure])

    def recovery_cohort(self, _: Any = None) -> str:
        """Simulated cohort of the published size, which recovery is judged on.

        Raises
        ------
        ConfigurationError
            If there is none.
        """
        for cohort in self.project.simulated_cohorts:
            if self.project.scale(cohort) == "published":
                return cohort
        raise ConfigurationError(
            "recovery needs a simulated cohort of the published size",
            file="config/config.yaml",
            place="cohorts",
            expected="one with simulated: true and scale: published",
        )

    def recovery_inputs(self, _: Any) -> list[str]:
        """Errors against the truth of all variants of that cohort."""
        cohort = self.recovery_cohort()
        return [
            f"results/{cohort}/{self.study}/{variant}/{kind}/{participant}.parquet"
            for variant in self.project.variants(self.study)
            for kind in ("truth", "truth_strides")
            for participant in self.project.units(self.study, cohort)
        ]

    def recovery_participants(self, _: Any) -> list[str]:
        """Names of the participants of that cohort."""
        return self.project.units(self.study, self.recovery_cohort())

    def recovery_folder(self, _: Any) -> str:
        """Results of that cohort."""
        return f"results/{self.recovery_cohort()}/{self.study}"

    def _stage_files(self, wildcards: Any, kinds: tuple[str, ...]) -> list[str]:
        """Files of every participant, by kind."""
        folder = self.source_folder(wildcards)
        return [
            f"{folder}/{kind}/{participant}.{'nc' if kind == 'estimates' else 'parquet'}"
            for kind in kinds
            for participant in self.participants(wildcards)
        ]
