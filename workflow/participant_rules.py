"""Inputs that the rules of studies share whose unit of work is a participant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from project import Project


class ParticipantRules:
    """Input functions of one study; ``wildcards`` is what Snakemake passes.

    Parameters
    ----------
    project : Project
        The validated configuration.
    study : str
        Name of the study.
    tables : tuple of str
        The lab's tables, without suffix.
    """

    def __init__(self, project: Project, study: str, tables: tuple[str, ...]) -> None:
        self.project = project
        self.study = study
        self.tables = tables

    def raw(self, wildcards: Any) -> str:
        """Folder of the raw files."""
        return self.project.raw_folder(wildcards.cohort, self.study)

    def results(self, wildcards: Any) -> str:
        """Folder of the results of a cohort."""
        return f"results/{wildcards.cohort}/{self.study}"

    def participants(self, wildcards: Any) -> list[str]:
        """Names of the participants."""
        return self.project.units(self.study, wildcards.cohort)

    def parameters(self, *sections: str) -> Callable[[Any], str]:
        """File with the parameters of these sections: of the variant, or of the base variant."""

        def file(wildcards: Any) -> str:
            variant = getattr(wildcards, "variant", self.project.base_variant)
            return f"{self.results(wildcards)}/{variant}/parameters/{'+'.join(sections)}.json"

        return file

    def design_tables(self, wildcards: Any) -> list[str]:
        """The lab's tables."""
        return [f"{self.raw(wildcards)}/{table}.tsv" for table in self.tables]

    def recordings(self, wildcards: Any) -> list[str]:
        """Raw files of one participant; a file that is named but absent is the import's to say."""
        if self.project.is_simulated(wildcards.cohort):
            return [f"{self.raw(wildcards)}/{wildcards.participant}"]
        return self.project.existing_files(self.study, wildcards.cohort, wildcards.participant)

    def quality_parts(self, wildcards: Any) -> list[str]:
        """Findings and exclusions of every participant."""
        folder = f"{self.results(wildcards)}/quality"
        return [
            f"{folder}/{kind}/{participant}.csv"
            for kind in ("findings", "exclusions")
            for participant in self.participants(wildcards)
        ]

    def metrics(self, wildcards: Any) -> list[str]:
        """Measures of every participant, of the variant or of the base that it shares."""
        variant = self.project.source_variant(self.study, wildcards.variant, "metrics")
        folder = f"{self.results(wildcards)}/{variant}/metrics"
        return [f"{folder}/{participant}.parquet" for participant in self.participants(wildcards)]

    def all_recordings(self, wildcards: Any) -> list[str]:
        """Recordings of every participant; the first with usable trials is the exemplar."""
        folder = f"{self.results(wildcards)}/recordings"
        return [f"{folder}/{participant}.nc" for participant in self.participants(wildcards)]
