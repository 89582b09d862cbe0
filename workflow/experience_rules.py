"""Inputs of the rules of the experience study, as functions of their wildcards."""

from __future__ import annotations

import json
from typing import Any, Final

from participant_rules import ParticipantRules
from project import Project
from swaystride.errors import ConfigurationError

#: Tables of single runs and of all runs that each result table needs; ``checks`` is what the import
#: says of every run.
TABLE_INPUTS: Final = {
    "table_5_1": (),
    "table_5_2": (),
    "table_5_3": ("models/associations",),
    "table_5_4": ("models/associations",),
    "study5_text": ("observations/runs", "answers/affect", "answers/scores"),
    "cohort": (),
    "runs": ("observations/runs", "observations/windows", "answers/scores", "checks"),
    "within_runs": ("models/within_runs",),
    "classes": ("observations/runs",),
    "claims": (
        "models/associations",
        "models/within_runs",
        "observations/runs",
        "answers/affect",
        "answers/scores",
    ),
}

#: Tables that only a simulated cohort can have.
TRUTH_TABLES: Final = {
    "truth_errors": ("truth",),
    "truth_summary": ("truth",),
    "attainable": ("models/associations",),
    "null_cohort": ("models/associations", "observations/runs"),
}

FIGURE_INPUTS: Final = {
    "figure_5_2": ("strides",),
    "figure_5_3": ("strides", "observations/windows", "answers/affect"),
    "figure_5_4": ("answers/affect", "checks"),
    "figure_5_5": ("answers/affect",),
    "figure_5_6": ("answers/scores",),
    "figure_5_7": ("models/associations",),
    "figure_5_8": ("models/within_runs",),
    "figure_5_9": ("strides", "observations/windows", "answers/affect", "models/within_runs"),
    "figure_truth": ("truth",),
}

#: What the simulation writes of a run; its ratings come from a job of all runs.
RUN_FILES: Final = (".h5", "_standing.h5", "_walking.h5", "_events.tsv")


#: Parameters of the runs; other ratings do not need other runs.
SIMULATION: Final = ("simulation.cohort", "simulation.runner", "simulation.equipment")


class ExperienceRules(ParticipantRules):
    """Input functions of the experience study, whose unit of work is a run (``P01_01``).

    Parameters
    ----------
    project : Project
        The validated configuration.
    """

    def __init__(self, project: Project) -> None:
        super().__init__(project, "experience", ("participants", "runs"))

    def runs(self, wildcards: Any) -> list[str]:
        """Names of the runs."""
        return self.project.units(self.study, wildcards.cohort)

    def recordings(self, wildcards: Any) -> list[str]:
        """Raw files of one run; a file that is named but absent is the import's to say.

        The chest strap's file is written by the same job as the sensors', but not by name, because
        some runs have lost theirs.
        """
        if self.project.is_simulated(wildcards.cohort):
            participant = wildcards.run.rpartition("_")[0]
            stem = f"{self.raw(wildcards)}/{participant}/{wildcards.run}"
            return [f"{stem}{end}" for end in RUN_FILES]
        return self.project.existing_files(self.study, wildcards.cohort, wildcards.run)

    def true_values(self, wildcards: Any) -> list[str]:
        """True measures of all runs of a simulated cohort."""
        folder = self.truth_folder(wildcards)
        return [f"{folder}/{run}.json" for run in self.runs(wildcards)]

    def rated_files(self, wildcards: Any) -> list[str]:
        """Questionnaires and ratings over time.

        Of a simulated cohort the job that writes the questionnaires writes the ratings too, in one
        file per run, whose number a rule cannot declare.
        """
        raw = self.raw(wildcards)
        files = [f"{raw}/questionnaires.tsv"]
        if not self.project.is_simulated(wildcards.cohort):
            files += [
                file
                for run in self.runs(wildcards)
                for file in self.project.existing_files(self.study, wildcards.cohort, run)
                if file.endswith((".tsv", ".csv"))
            ]
        return files

    def checks(self, wildcards: Any) -> list[str]:
        """Length, missing sensors and exclusion of every run."""
        folder = f"{self.results(wildcards)}/quality/runs"
        return [f"{folder}/{run}.json" for run in self.runs(wildcards)]

    def spans(self, wildcards: Any) -> list[str]:
        """Events of every run."""
        folder = f"{self.results(wildcards)}/spans"
        return [f"{folder}/{run}.parquet" for run in self.runs(wildcards)]

    def quality_parts(self, wildcards: Any) -> list[str]:
        """Findings and exclusions of the import; findings and measures of the base variant."""
        folder = f"{self.results(wildcards)}/{self.project.base_variant}"
        return [
            *super().quality_parts(wildcards),
            *(
                f"{folder}/{kind}"
                for run in self.runs(wildcards)
                for kind in (f"findings/{run}.csv", f"runs/{run}.parquet")
            ),
        ]

    def measured(self, kind: str) -> Any:
        """Tables of every run under a variant, or under the base that it shares.

        Parameters
        ----------
        kind : str
            ``strides``, ``windows``, ``runs`` or ``truth``.
        """

        def files(wildcards: Any) -> list[str]:
            return self._files(wildcards, kind)

        return files

    def measured_folder(self, wildcards: Any) -> str:
        """Folder of the tables of single runs."""
        return self._folder(wildcards, "metrics")

    def model_folder(self, wildcards: Any) -> str:
        """Folder of observations and models."""
        return self._folder(wildcards, "models")

    def table_inputs(self, wildcards: Any) -> list[str]:
        """Tables of the stages that one result table needs."""
        files = self._all_files(wildcards, TABLE_INPUTS[wildcards.table])
        if wildcards.table == "classes" and self.project.is_simulated(wildcards.cohort):
            files += self.true_values(wildcards)
        return files

    def truth_inputs(self, wildcards: Any) -> list[str]:
        """What a table needs that only a simulated cohort has."""
        files = self._all_files(wildcards, TRUTH_TABLES[wildcards.table])
        if wildcards.table in ("attainable", "null_cohort"):
            folder = self.truth_folder(wildcards)
            files += [f"{folder}/population.json", f"{folder}/null.parquet"]
        return files

    def figure_inputs(self, wildcards: Any) -> list[str]:
        """Tables that one figure needs."""
        return self._all_files(wildcards, FIGURE_INPUTS[wildcards.figure])

    def truth_folder(self, wildcards: Any) -> str:
        """Folder of the truth of a simulated cohort."""
        return f"{self.raw(wildcards)}/truth"

    def recovery_cohort(self) -> str:
        """Simulated cohort of the published size, whose measures recovery keeps.

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

    def recovery_observations(self, wildcards: Any) -> str:
        """Measures of all runs of that cohort under a variant."""
        variant = self.project.source_variant(self.study, wildcards.variant, "models")
        folder = f"results/{self.recovery_cohort()}/{self.study}/{variant}"
        return f"{folder}/observations/runs.parquet"

    def recovery_population(self, _: Any) -> str:
        """What its ratings are drawn from."""
        raw = self.project.raw_folder(self.recovery_cohort(), self.study)
        return f"{raw}/truth/population.json"

    def recovery_true_values(self, _: Any) -> list[str]:
        """True measures of its runs."""
        cohort = self.recovery_cohort()
        folder = f"{self.project.raw_folder(cohort, self.study)}/truth"
        return [f"{folder}/{run}.json" for run in self.project.units(self.study, cohort)]

    def recovery_start_s(self, _: Any) -> float:
        """Where the mean of the ratings of affect begins."""
        return float(self._recovery_values("analysis.steady")["steady"]["warm_up_s"])

    def recovery_mean(self, _: Any) -> str:
        """How ratings of affect are averaged."""
        return str(self._recovery_values("analysis.answers")["answers"]["mean"])

    def _recovery_values(self, section: str) -> Any:
        return json.loads(self.project.recovery_parameters(self.study, section))

    def _all_files(self, wildcards: Any, kinds: tuple[str, ...]) -> list[str]:
        return [file for kind in kinds for file in self._files(wildcards, kind)]

    def _files(self, wildcards: Any, kind: str) -> list[str]:
        """Files of one kind: of every run, or one for all runs."""
        if kind == "checks":
            return self.checks(wildcards)
        if kind.startswith("answers/"):
            return [f"{self.results(wildcards)}/{kind}.parquet"]
        if "/" in kind:
            return [f"{self.model_folder(wildcards)}/{kind}.parquet"]
        folder = f"{self.measured_folder(wildcards)}/{kind}"
        return [f"{folder}/{run}.parquet" for run in self.runs(wildcards)]

    def _folder(self, wildcards: Any, stage: str) -> str:
        """Results of the variant, or of the base whose stage it shares."""
        variant = self.project.source_variant(self.study, wildcards.variant, stage)
        return f"{self.results(wildcards)}/{variant}"
