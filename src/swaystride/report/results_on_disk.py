"""Read what a page shows from the folder of results, the same way for every study."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from swaystride.report.assemble import study_content
from swaystride.report.content import Exclusion, Flow, Parameter, StudyContent
from swaystride.report.page_text import load_page_text


@dataclass(frozen=True)
class PageSource:
    """Where a study's page finds its content.

    Parameters
    ----------
    study, cohort, variant, scale : str
        Names as in the configuration.
    simulated : bool
        Whether the cohort is simulated.
    """

    study: str
    cohort: str
    variant: str
    scale: str
    simulated: bool

    @property
    def study_folder(self) -> Path:
        """Results of the study, all variants."""
        return Path("results") / self.cohort / self.study

    @property
    def folder(self) -> Path:
        """Results of the variant."""
        return self.study_folder / self.variant


def load_study_content(source: PageSource) -> StudyContent:
    """Content of a study's page, from the working directory.

    Parameters
    ----------
    source : PageSource
        Names of the study, cohort and variant.

    Raises
    ------
    SwaystrideError
        If a file is missing or does not fit.
    """
    quality = source.study_folder / "quality"
    return study_content(
        load_page_text(Path("workflow/report") / f"{source.study}.yaml"),
        slug=source.study,
        cohort=source.cohort,
        variant=source.variant,
        scale=source.scale,
        simulated=source.simulated,
        flow=_flow(quality / "flow.json"),
        findings=pd.read_csv(quality / "findings.csv", dtype=str, keep_default_na=False),
        parameters=_parameters(source.folder / "parameters.csv"),
        results_dir=source.folder,
        printed_dir="data/published",
        command=".venv/bin/snakemake --cores all {path}",
    )


def _flow(path: Path) -> list[Flow]:
    """Flow of participants and trials."""
    rows = json.loads(path.read_text(encoding="utf-8"))["flow"]
    return [
        Flow(**{**row, "excluded": tuple(Exclusion(**reason) for reason in row["excluded"])})
        for row in rows
    ]


def _parameters(path: Path) -> list[Parameter]:
    """Parameters in force."""
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    return [
        Parameter(
            name=row["name"],
            value=row["value"],
            unit=row["unit"],
            source=row["source"],
            group=row["group"],
            changed_by_variant=row["changed"] != "",
        )
        for row in table.to_dict("records")
    ]
