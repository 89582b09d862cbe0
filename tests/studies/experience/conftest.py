"""A simulated run of 50 s as a lab would store it, to be imported, measured, and spoilt."""

import json
import shutil
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

from import_graph import REPOSITORY
from study_parameters import resolve
from swaystride.configuration import plain_values
from swaystride.io.opal_hdf5_writer import write_opal_hdf5
from swaystride.io.reading import read_recording
from swaystride.io.study_tables import write_study_table
from swaystride.presentation.table_files import read_table
from swaystride.simulate.experience_cohort import experience_tables
from swaystride.simulate.experience_parameters import cohort_from_config
from swaystride.simulate.experience_runs import write_run
from swaystride.studies.experience.design import read_design
from swaystride.studies.experience.importing import RunOutputs, import_run_files
from swaystride.studies.experience.measure_settings import measure_rules
from swaystride.studies.experience.measuring_files import RunInputs, measured_files
from swaystride.studies.experience.recording_settings import (
    import_rules,
    metric_rules,
    worn_equipment,
)

RUN, SEED, RUN_S, WARM_UP_S, TURN_S = "P01_01", 5, 50.0, 6.0, 22.0


@cache
def _resolved(variant):
    return plain_values(resolve("experience", variant, "published"))


def short_analysis(variant):
    """Parameters of the analysis for a run of 50 s: a shorter warm-up, turn and windows."""
    given = json.loads(json.dumps(_resolved(variant)["analysis"]))
    given["steady"] |= {"warm_up_s": WARM_UP_S, "turn_margin_s": 1.0}
    given["windows"] |= {"length_s": 10.0, "step_s": 5.0, "least_strides": 8}
    given["recording"]["run"]["shortest_after_warm_up_s"] = 10.0
    given["recording"]["steps"] |= {"span_s": 15.0, "n_spans": 2}
    given["measures"]["coding"]["least_strides"] = 4
    return given


@dataclass
class Lab:
    """Raw files of one run, which may be changed; what the pipeline makes of them."""

    folder: Path
    truth: Path

    @property
    def design(self):
        return read_design(self.folder)

    def file(self, end):
        return self.folder / "P01" / f"{RUN}{end}"

    def change_table(self, path, change):
        """Replace a table by what `change` makes of it; all cells are text."""
        table = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
        write_study_table(change(table), path)

    def change_sensors(self, end, change):
        """Replace a file of sensors by what `change` makes of the recording."""
        changed = change(read_recording(self.file(end)).load())
        labels = changed["sensor"].values
        write_opal_hdf5(
            self.file(end),
            changed,
            ids=[f"SI-{k:06d}" for k in range(1, len(labels) + 1)],
            start_unix_us=int(changed.attrs["start_unix_us"]),
        )

    def outputs(self):
        names = ("recordings", "alignment", "heart_rate", "spans", "run_json")
        ends = ("nc", "parquet", "parquet", "parquet", "json")
        paths = [self.folder / f"{name}.{end}" for name, end in zip(names, ends, strict=True)]
        return RunOutputs(*paths, self.folder / "findings.csv", self.folder / "exclusions.csv")

    def imported(self):
        """Import the run; what it wrote: findings, exclusions, summary."""
        outputs = self.outputs()
        rules = import_rules(short_analysis("printed"))
        import_run_files(RUN, self.design, self.folder, rules, outputs)
        summary = json.loads(outputs.run_json.read_text())
        return pd.read_csv(outputs.findings), pd.read_csv(outputs.exclusions), summary

    def measured(self, variant):
        """Measures of the imported run: tables and findings."""
        outputs, given = self.outputs(), short_analysis(variant)
        summary = json.loads(outputs.run_json.read_text())
        run = self.design.run(RUN)
        return measured_files(
            run,
            RunInputs(outputs.recordings, outputs.heart_rate, outputs.spans, summary),
            mass_kg=float(self.design.person("P01")["mass_kg"]),
            equipment=worn_equipment(given),
            rules=metric_rules(given),
        )


@pytest.fixture(scope="session")
def stored_run(tmp_path_factory):
    """Raw files and truth of one run; not to be changed."""
    folder = tmp_path_factory.mktemp("experience")
    cohort = cohort_from_config(_resolved("printed")["simulation"])
    protocol = replace(
        cohort.protocol, runs_per_participant=(1,), duration_s=RUN_S, warm_up_s=WARM_UP_S
    )
    course = replace(
        cohort.course,
        turn_s=TURN_S,
        turn_sd_s=0.2,
        turn_lasts_s=(6.0, 7.0),
        turn_ramp_s=2.0,
        turn_margin_s=1.0,
    )
    none = replace(
        cohort.losses, heart_rate_runs=(), head_lost_runs=(), head_loose_runs=(), ratings_runs=()
    )
    cohort = replace(cohort, protocol=protocol, course=course, losses=none)
    people = read_table(REPOSITORY / "data" / "published" / "table_5_1.csv")
    tables = experience_tables(cohort, people, SEED)
    for name in ("participants", "runs"):
        write_study_table(getattr(tables, name), folder / f"{name}.tsv")
    rules = measure_rules(short_analysis("printed")["measures"])
    write_run(
        RUN,
        tables=tables,
        cohort=cohort,
        rules=rules,
        seed=SEED,
        folder=folder,
        truth_folder=folder / "truth",
    )
    return folder


@pytest.fixture
def lab(stored_run, tmp_path):
    """A copy of the run that may be spoilt."""
    shutil.copytree(stored_run, tmp_path / "raw")
    return Lab(tmp_path / "raw", stored_run / "truth")


@pytest.fixture(scope="session")
def whole_lab(stored_run, tmp_path_factory):
    """The run, imported; not to be changed."""
    folder = tmp_path_factory.mktemp("whole") / "raw"
    shutil.copytree(stored_run, folder)
    lab = Lab(folder, stored_run / "truth")
    lab.imported()
    return lab
