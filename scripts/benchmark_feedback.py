"""Measure the feedback study: whole build, largest process, and the search of the models.

Run by hand: ``.venv/bin/python scripts/benchmark_feedback.py``. It builds the study once more in a
temporary folder, with as many cores as asked for, and prints wall time and peak memory.
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
    arguments = parser.parse_args()
    with TemporaryDirectory() as name:
        root = Path(name)
        for part in PARTS:
            (root / part).parent.mkdir(parents=True, exist_ok=True)
            copy = shutil.copytree if (REPOSITORY / part).is_dir() else shutil.copy2
            copy(REPOSITORY / part, root / part)
        command = [sys.executable, "-m", "snakemake", "--cores", str(arguments.cores)]
        start = time.perf_counter()
        subprocess.run([*command, "--quiet", "all", "--", "feedback"], cwd=root, check=True)
        wall_s = time.perf_counter() - start
        peak_mib = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        print(f"study at published scale, {arguments.cores} cores: {wall_s:.0f} s")
        print(f"largest process: {peak_mib:.0f} MiB")
        folder = root / "results/synthetic/feedback/printed"
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
