"""What the rules need to know: cohorts, units, paths, parameters, pages.

Everything here is known when the Snakefile is parsed, so that a dry run shows the true DAG.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from import_graph import REPOSITORY
from study_parameters import BASE_VARIANT, SCHEMAS, STAGES, load_study, resolve, sections_json
from study_units import PASSING_RECORDINGS, files_of, lab_rows, simulated_units, unit_of
from swaystride.configuration import Tree, iter_parameters, load_yaml, plain_values, validate
from swaystride.errors import ConfigurationError

#: Public real recordings that `make validation` uses.
VALIDATION_DATASETS = (
    "standing_force_plate",
    "lumbar_imu_standing",
    "reliability_and_mixed_models",
    "foot_imu_vicon",
    "foot_imu_mocap_walk",
    "chest_strap_ecg",
    "running_markers_grf",
    "running_full_body_ik",
    "lower_limb_imu_vicon_walk",
)

#: Of these, the foot recordings, which gaitmap computes too (``make peers``).
FOOT_DATASETS = ("foot_imu_vicon", "foot_imu_mocap_walk")

#: Runners beside whom the simulated one is laid.
RUNNING_DATASETS = ("running_markers_grf", "running_full_body_ik")

#: Marker of gaitmap's own environment, written when it is complete.
GAITMAP_ENVIRONMENT = ".venv-peers-gait/.complete"


class Project:
    """The configuration, validated, and the questions that rules ask of it.

    Parameters
    ----------
    config : mapping
        Content of config/config.yaml, command-line overrides included.
    """

    def __init__(self, config: Mapping[str, Any]) -> None:
        validate(config, load_yaml(SCHEMAS / "config.schema.yaml"), file="config/config.yaml")
        self.config = config
        self.seed: int = config["seed"]
        self.cohort: str = config["cohort"]
        self.studies: list[str] = config["studies"]
        self.cohorts: dict[str, Tree] = config["cohorts"]
        if self.cohort not in self.cohorts:
            raise ConfigurationError(
                "unknown cohort",
                file="config/config.yaml",
                place="cohort",
                expected="one of " + ", ".join(self.cohorts),
                found=self.cohort,
            )
        folder = os.environ.get("SWAYSTRIDE_REAL_DATA") or config["real_data_dir"]
        self.real_data_dir = Path(folder) if folder else None
        self.study_files = {name: load_study(name) for name in self.studies}

    # -- cohorts -----------------------------------------------------------------------------
    base_variant = BASE_VARIANT

    @property
    def simulated_cohorts(self) -> list[str]:
        """Names of the simulated cohorts."""
        return [name for name, cohort in self.cohorts.items() if cohort["simulated"]]

    def is_simulated(self, cohort: str) -> bool:
        """Whether a cohort is simulated."""
        return bool(self.cohorts[cohort]["simulated"])

    def raw_folder(self, cohort: str, study: str) -> str:
        """Folder of the raw files of one study."""
        folder = self.cohorts[cohort].get("folder", f"data/raw/{cohort}")
        return f"{folder}/{study}"

    @property
    def simulated_pattern(self) -> str:
        """Regular expression of the names of the simulated cohorts."""
        return "|".join(self.simulated_cohorts) or "(?!)"

    def units(self, study: str, cohort: str) -> list[str]:
        """Units of work of a study: from the configuration, or from the lab's table.

        Raises
        ------
        ConfigurationError
            If a real cohort has no table of its recordings, or one without rows.
        """
        if self.is_simulated(cohort):
            tree = self.parameter_tree(study, cohort, BASE_VARIANT)
            return simulated_units(study, plain_values(tree)["simulation"]["cohort"]["protocol"])
        rows = lab_rows(Path(self.raw_folder(cohort, study)), study)
        return list(dict.fromkeys(unit_of(study, row) for row in rows))

    def existing_files(self, study: str, cohort: str, unit: str) -> list[str]:
        """Recordings of a unit that are there; what is missing is the import's to report."""
        folder = Path(self.raw_folder(cohort, study))
        rows = [row for row in lab_rows(folder, study) if unit_of(study, row) == unit]
        files = [folder / name for row in rows for name in files_of(study, row)]
        return [str(file) for file in files if file.is_file()]

    # -- variants and parameters -------------------------------------------------------------
    def variants(self, study: str) -> list[str]:
        """Variants of a study, the base variant first."""
        return list(self.study_files[study]["variants"])

    def source_variant(self, study: str, variant: str, stage: str) -> str:
        """Variant whose results of a stage are used: its own, or the shared base."""
        first = self.study_files[study]["variants"][variant]["first_stage"]
        changed = STAGES.index(stage) >= STAGES.index(first)
        return variant if changed else BASE_VARIANT

    def parameter_tree(self, study: str, cohort: str, variant: str) -> Tree:
        """Parameters with units and sources, overlays of scale and variant applied."""
        scale = self.cohorts[cohort].get("scale", "published")
        return resolve(study, variant, scale)

    def parameters(self, study: str, cohort: str, variant: str, *sections: str) -> str:
        """Plain values of the named sections (dotted paths), as JSON for a script."""
        return sections_json(self.parameter_tree(study, cohort, variant), sections)

    def recovery_parameters(self, study: str, *sections: str) -> str:
        """Parameters of the published scale, as JSON: recovery belongs to no cohort."""
        return sections_json(resolve(study, BASE_VARIANT, "published"), sections)

    # -- pages -------------------------------------------------------------------------------
    def page_files(self, study: str, cohort: str, variant: str) -> list[str]:
        """Tables and figures that a study's page shows, from the words of the page."""
        folder = f"results/{cohort}/{study}/{variant}"
        files = []
        for item in load_yaml(REPOSITORY / "workflow" / "report" / f"{study}.yaml")["items"]:
            if item.get("simulated_only") and not self.is_simulated(cohort):
                continue
            if item["kind"] in ("figure", "assumption"):
                files += [f"{folder}/{item['file']}.svg", f"{folder}/{item['file']}.png"]
            else:
                files.append(f"{folder}/{item['file']}")
            if "printed" in item:
                files.append(f"data/published/{item['printed']}")
        return list(dict.fromkeys(files))

    def study_page_files(self, study: str, cohort: str, variant: str) -> list[str]:
        """Everything that the page of a study reads."""
        folder = f"results/{cohort}/{study}"
        return [
            f"workflow/report/{study}.yaml",
            f"{folder}/quality/findings.csv",
            f"{folder}/quality/flow.json",
            f"{folder}/{variant}/parameters.csv",
            *self.page_files(study, cohort, variant),
        ]

    def result_files(self, cohort: str) -> list[str]:
        """Results of a cohort that its provenance lists: the base variant of every study."""
        files = [f"results/{cohort}/report.html"]
        for study in self.studies:
            folder = f"results/{cohort}/{study}"
            variant = f"{folder}/{BASE_VARIANT}"
            shown = self.study_page_files(study, cohort, BASE_VARIANT)
            for file in [name for name in shown if name.startswith(folder)]:
                stem, _, suffix = file.rpartition(".")
                is_table = suffix == "csv" and f"{variant}/tables/" in file
                files += (
                    [f"{stem}.{s}" for s in ("csv", "md", "tex", "html")] if is_table else [file]
                )
                if suffix == "svg":
                    files.append(f"{stem}.pdf")
            files += [f"{folder}/quality/exclusions.csv", f"{variant}/report.html"]
            if study not in PASSING_RECORDINGS:
                files += [f"{folder}/recordings/{unit}.nc" for unit in self.units(study, cohort)]
        return files

    def simulated_flag(self, wildcards: Any) -> str:
        """Option of the scripts that mark their output as simulated."""
        return "--simulated" if self.is_simulated(wildcards.cohort) else ""

    def cohort_scale(self, wildcards: Any) -> str:
        """Scale of the cohort of a rule."""
        return self.scale(wildcards.cohort)

    @property
    def validation_datasets(self) -> list[str]:
        """Public data sets that are at hand."""
        folder = self.real_data_dir
        return [name for name in VALIDATION_DATASETS if folder and (folder / name).is_dir()]

    def validation_files(self, dataset: str) -> list[str]:
        """Everything that a data set's validation writes, from the words of the page."""
        folder = f"results/validation/{dataset}"
        files = [f"{folder}/checks.csv", f"{folder}/trials.csv"]
        page = load_yaml(REPOSITORY / "workflow" / "report" / "validation.yaml")
        for item in page["items"]:
            if not item["file"].startswith(f"{dataset}/"):
                continue
            shown = f"results/validation/{item['file']}"
            is_figure = item["kind"] == "figure"
            files += [f"{shown}.{s}" for s in ("svg", "png", "pdf")] if is_figure else [shown]
        return list(dict.fromkeys(files))

    @property
    def has_gaitmap(self) -> bool:
        """Whether gaitmap's environment is set up."""
        return (REPOSITORY / GAITMAP_ENVIRONMENT).is_file()

    def gaitmap_table(self, dataset: str) -> list[str]:
        """Table of gaitmap's results on a data set, if it is there or can be computed."""
        table = f"results/peers/gaitmap_{dataset}.csv"
        return [table] if self.has_gaitmap or (REPOSITORY / table).is_file() else []

    def scale(self, cohort: str) -> str:
        """Scale of a cohort; recordings of people have none."""
        return str(self.cohorts[cohort].get("scale", "as recorded"))

    def parameter_rows(self, study: str, cohort: str, variant: str) -> str:
        """Parameters in force as JSON rows: group, name, value, unit, source, changed."""
        tree = self.parameter_tree(study, cohort, variant)
        if not self.is_simulated(cohort):
            tree = {"analysis": tree["analysis"]}
        rows = []
        for path, leaf in iter_parameters(tree):
            group, _, name = path.rpartition(".")
            value = leaf["value"]
            text = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
            changed = leaf.get("changed_by", "")
            rows.append([group, name, text, leaf["unit"], leaf["source"], changed])
        return json.dumps(rows, ensure_ascii=False)

    # -- provenance --------------------------------------------------------------------------
    def config_json(self, cohort: str) -> str:
        """Configuration of one cohort as canonical JSON, for its hash."""
        config = {
            "cohort": {cohort: self.cohorts[cohort]},
            "seed": self.seed,
            "studies": {name: self.study_files[name] for name in self.studies},
        }
        return json.dumps(config, sort_keys=True)
