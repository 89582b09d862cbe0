"""Measure the studies: whole build and largest process of each, and the search of the models.

Run by hand: ``make benchmark``. It builds each study once more in a temporary folder, with as many
cores as asked for, and prints wall time and peak memory.
"""

import os
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from swaystride.command_line import json_file, run_script, script_parser
from swaystride.configuration import from_mapping
from swaystride.studies.feedback.models import analyse_feature
from swaystride.studies.feedback.plan import FEATURES, ModelPlan

REPOSITORY = Path(__file__).resolve().parents[1]
PARTS = ("Snakefile", "config", "workflow", "scripts", "src", "data/published", "requirements.txt")


def main() -> None:
    """Build, measure, print."""
    parser = script_parser(__doc__)
    parser.add_argument("--cores", type=int, default=2)
    parser.add_argument(
        "--studies",
        nargs="+",
        default=["feedback", "intensity", "imu_design", "kinematics", "experience"],
    )
    arguments = parser.parse_args()
    for study in arguments.studies:
        with TemporaryDirectory() as name:
            root = Path(name)
            measure_build(study, root, arguments.cores)
            if study == "feedback":
                measure_search(root / "results/synthetic/feedback/printed")


def measure_build(study: str, root: Path, cores: int) -> None:
    """Build one study at published scale in an empty folder; print time and memory."""
    for part in PARTS:
        (root / part).parent.mkdir(parents=True, exist_ok=True)
        copy = shutil.copytree if (REPOSITORY / part).is_dir() else shutil.copy2
        copy(REPOSITORY / part, root / part)
    command = [sys.executable, "-m", "snakemake", "--cores", str(cores), "--quiet", "all"]
    start = time.perf_counter()
    subprocess.run([*command, "--", study], cwd=root, check=True)
    wall_s = time.perf_counter() - start
    # of all children so far: a later study reports at least what an earlier one needed
    peak_mib = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    print(f"{study} at published scale, {cores} cores: {wall_s:.0f} s")
    print(f"largest process: {peak_mib:.0f} MiB")


def measure_search(folder: Path) -> None:
    """Time the exponent search, elimination and fits of the feedback study on one core."""
    frame = pd.read_parquet(folder / "models/observations.parquet")
    given = json_file(str(folder / "parameters/analysis.model.json"))
    plan = from_mapping(ModelPlan, given["model"], place="analysis.model")
    start = time.perf_counter()
    for feature in FEATURES:
        analyse_feature(frame, feature, plan)
    print(
        "exponent search, elimination and printed fits of "
        f"{len(FEATURES)} features, one core: {time.perf_counter() - start:.2f} s"
    )


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    run_script(main)
