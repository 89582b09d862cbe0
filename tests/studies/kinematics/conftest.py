"""One simulated run of 24.5 s as a lab would store it, imported, estimated, and to be spoilt."""

import shutil
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import pandas as pd
import pytest

from import_graph import REPOSITORY
from study_parameters import resolve
from swaystride.configuration import load_yaml, plain_values
from swaystride.io.c3d import read_c3d
from swaystride.io.c3d_writer import write_c3d
from swaystride.io.opal_hdf5_writer import write_opal_hdf5
from swaystride.io.reading import read_recording
from swaystride.simulate.kinematics_cohort import kinematics_tables
from swaystride.simulate.kinematics_parameters import cohort_from_config
from swaystride.simulate.kinematics_recordings import write_participant
from swaystride.simulate.kinematics_truth import read_truth
from swaystride.studies.kinematics import settings
from swaystride.studies.kinematics.design import read_design
from swaystride.studies.kinematics.equipment import measured_lengths
from swaystride.studies.kinematics.estimation import estimate_trial
from swaystride.studies.kinematics.imported_trials import load_trial
from swaystride.studies.kinematics.importing import import_participant
from swaystride.studies.kinematics.measures import measure_parameters
from swaystride.studies.kinematics.participant_measures import participant_measures

SEED, RUNNING_S, STANDING_S = 7, 24.5, 4.0


@cache
def analysis_of(variant):
    """Plain values of the analysis under a variant."""
    return plain_values(resolve("kinematics", variant, "published"))["analysis"]


@dataclass
class Lab:
    """Raw files of P01, which may be changed; what the pipeline makes of them."""

    folder: Path

    @property
    def design(self):
        return read_design(self.folder)

    def file(self, kind):
        phase, what = kind.split("_")
        end = "h5" if what == "imu" else "c3d"
        return self.folder / "P01" / f"P01_01_{phase}.{end}"

    def change_table(self, name, change):
        """Replace a table by what `change` makes of it; all cells are text."""
        path = self.folder / f"{name}.tsv"
        table = pd.read_csv(path, sep="\t", dtype=str, keep_default_na=False)
        change(table).to_csv(path, sep="\t", index=False)

    def change_sensors(self, phase, change):
        """Replace a recording of the sensors by what `change` makes of it."""
        path = self.file(f"{phase}_imu")
        changed = change(read_recording(path))
        ids = [f"SI-{k:06d}" for k in range(changed.sizes["sensor"])]
        write_opal_hdf5(path, changed, ids=ids, start_unix_us=1_700_000_000_000_000)

    def change_markers(self, phase, change):
        """Replace a recording of the markers by what `change` makes of it."""
        path = self.file(f"{phase}_markers")
        write_c3d(path, change(read_c3d(path)), unit="mm")

    def import_all(self):
        """Tables of the import; the recordings lie in ``recordings.nc``."""
        rules = settings.import_rules(analysis_of("printed"))
        output = self.folder / "recordings.nc"
        return import_participant("P01", self.design, self.folder, rules, output)

    def recordings(self):
        return load_trial(self.folder / "recordings.nc", "01")

    def estimate(self, variant):
        """Estimates of the trial and findings."""
        given, design = analysis_of(variant), self.design
        markers = settings.markers(given["markers"])
        return estimate_trial(
            self.recordings(),
            measured_lengths(design.participants.iloc[0], markers),
            design.belt_speed_m_s("P01", "01"),
            settings.optical_method(given["optics"]),
            settings.filter_method(given["erkf"], given["contacts"], given["zero_velocity"]),
            markers,
        )

    def measure(self, variant, estimates):
        """Tables of measures of the trial."""
        given = analysis_of(variant)
        parameters = measure_parameters(given["contacts"], given["measures"])
        return participant_measures("P01", {"01": estimates}, parameters)[0]


@pytest.fixture(scope="session")
def analysis():
    """Plain values of the analysis by variant."""
    return analysis_of


@pytest.fixture(scope="session")
def sound_lab(tmp_path_factory):
    """Raw files of one runner as simulated, imported: not to be changed."""
    folder = tmp_path_factory.mktemp("kinematics")
    tree = load_yaml(REPOSITORY / "config" / "studies" / "kinematics.yaml")
    cohort = cohort_from_config(plain_values(tree["simulation"]))
    protocol = replace(
        cohort.protocol,
        n_participants=1,
        n_trials=1,
        duration_s=RUNNING_S,
        standing_s=STANDING_S,
        failed_optics=(),
    )
    cohort = replace(cohort, protocol=protocol)
    tables = kinematics_tables(cohort, SEED)
    for name in ("participants", "trials"):
        getattr(tables, name).to_csv(folder / f"{name}.tsv", sep="\t", index=False)
    write_participant(
        "P01",
        tables=tables,
        cohort=cohort,
        seed=SEED,
        folder=folder,
        truth_file=folder / "truth" / "P01.npz",
    )
    lab = Lab(folder)
    lab.tables = lab.import_all()
    return lab


@pytest.fixture(scope="session")
def known(sound_lab):
    """Truth of the running recording."""
    return read_truth(sound_lab.folder / "truth" / "P01.npz").recording("01")


@pytest.fixture(scope="session")
def estimated(sound_lab):
    """Estimates, findings and measures of the sound recording, by variant."""

    @cache
    def of(variant):
        estimates, findings = sound_lab.estimate(variant)
        return estimates, findings, sound_lab.measure(variant, estimates)

    return of


@pytest.fixture
def lab(sound_lab, tmp_path):
    """A copy of the raw files of one's own, to be spoilt."""
    folder = tmp_path / "lab"
    shutil.copytree(
        sound_lab.folder, folder, ignore=shutil.ignore_patterns("truth", "recordings.nc")
    )
    return Lab(folder)


@pytest.fixture(scope="session")
def last_strides():
    """Of every foot, the last strides of a table of strides."""

    def of(strides, n=15):
        return strides[strides["stride"] > strides.groupby("side")["stride"].transform("max") - n]

    return of
