"""Time the mixed models of this library beside statsmodels, mixedlm and printed times of lme4.

Run by ``make benchmark-models``, after ``make peers`` also with mixedlm. All programs use one
thread. Crossed models are fitted to the table ``mixed_models/i.csv`` of a folder with reference
fits by lme4 (``--reference``, or SWAYSTRIDE_REFERENCE_DATA, or the folder ``reference`` beside
``real_data_dir``), else to a simulated table of the same shape.
"""

import json
import os
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import numpy as np
import pandas as pd
import yaml

from swaystride.command_line import run_script, script_parser
from swaystride.stats.mixed_model import MixedModelFit, fit_mixed_model

REPOSITORY = Path(__file__).resolve().parents[1]
PEERS = {
    "statsmodels": (Path(sys.executable), "peers_statsmodels.py"),
    "mixedlm": (REPOSITORY / ".venv-peers/bin/python", "peers_mixedlm.py"),
}
NINE = (
    "patient patient:exercise rater patient:rater patient:exercise:rater patient:trial "
    "patient:exercise:trial rater:trial patient:rater:trial"
)
THIRTEEN = (
    "exercise patient rater exercise:patient exercise:rater patient:rater exercise:patient:rater "
    "trial:exercise trial:patient trial:rater trial:exercise:patient trial:exercise:rater "
    "trial:patient:rater"
)
SUBJECT = "logy ~ speed_p + load + slope + age + mass + height + sex + x1 + x2 + x3 + x4"


@dataclass(frozen=True)
class Task:
    """One model, its table, and what lme4 needed on another machine."""

    name: str
    formula: str
    table: pd.DataFrame
    repeats: int
    lme4_s: float
    refits: int = 0


def rated(fixed: str, groups: str) -> str:
    """Formula with a random intercept for each of the groups."""
    return " + ".join([f"rating ~ {fixed}", *(f"(1|{group})" for group in groups.split())])


def simulated_ratings(rng: np.random.Generator) -> pd.DataFrame:
    """Ratings of 10 patients, 15 exercises, 3 trials and 3 to 5 of 8 raters (1935 rows)."""
    counts = [5, 5, 5, 5, 4, 4, 4, 4, 4, 3]
    rows = [
        (f"P{p}", f"E{e}", f"T{t}", f"R{r}")
        for p, count in enumerate(counts)
        for r in rng.choice(8, count, replace=False)
        for e in range(15)
        for t in range(3)
    ]
    table = pd.DataFrame(rows, columns=["patient", "exercise", "trial", "rater"])
    rating = 3.0 + 0.35 * rng.normal(size=len(table))
    for names, sd in [("patient", 0.4), ("patient:exercise", 0.9), ("rater", 0.2),
                      ("patient:rater", 0.2), ("patient:exercise:rater", 0.2),
                      ("patient:exercise:trial", 0.3)]:  # fmt: skip
        code = table.groupby(names.split(":")).ngroup().to_numpy()
        rating += sd * rng.normal(size=code.max() + 1)[code]
    return table.assign(rating=rating)


def simulated_subjects(rng: np.random.Generator) -> pd.DataFrame:
    """708 rows of 12 subjects with eleven covariates."""
    table = pd.DataFrame({"subject": np.repeat([f"s{at:02d}" for at in range(12)], 59)})
    for name in SUBJECT.replace("+", " ").split()[2:]:
        table[name] = rng.normal(size=len(table))
    level = rng.normal(size=12)[np.repeat(np.arange(12), 59)]
    return table.assign(logy=table["speed_p"] + level + rng.normal(size=len(table)))


def reference_folder(given: str | None) -> Path | None:
    """Folder with ``i.csv`` and ``a.csv``, if it is at hand."""
    config = yaml.safe_load((REPOSITORY / "config/config.yaml").read_text(encoding="utf-8"))
    real = os.environ.get("SWAYSTRIDE_REAL_DATA") or config["real_data_dir"]
    folders = [given, os.environ.get("SWAYSTRIDE_REFERENCE_DATA")]
    folders += [str(Path(real).parent / "reference")] if real else []
    for folder in filter(None, folders):
        if (Path(folder) / "mixed_models/i.csv").exists():
            return Path(folder) / "mixed_models"
    return None


def tasks(folder: Path | None) -> list[Task]:
    """What is timed."""
    rng = np.random.default_rng(1)
    if folder:
        ratings, subjects = (pd.read_csv(folder / name) for name in ("i.csv", "a.csv"))
    else:
        ratings, subjects = simulated_ratings(rng), simulated_subjects(rng)
    small = pd.DataFrame({"subject": np.repeat(np.arange(30), 14), "x": rng.normal(size=420)})
    small["y"] = small["x"] + rng.normal(size=30)[small["subject"]] + rng.normal(size=420)
    return [
        Task("9 crossed components, 1935 rows", rated("trial", NINE), ratings, 5, 2.3),
        Task("13 crossed components, 1935 rows", rated("trial", THIRTEEN), ratings, 3, 20.0),
        Task("random intercept, 708 rows", f"{SUBJECT} + (1|subject)", subjects, 20, 0.046),
        Task("1000 refits, 420 rows", "y ~ x + (1|subject)", small, 5, 11.0, refits=1000),
    ]


def ours(task: Task) -> tuple[dict[str, object], MixedModelFit]:
    """Time this library."""
    seconds = []
    for _ in range(task.repeats):
        start = time.perf_counter()
        fit = fit_mixed_model(task.formula, task.table)
        seconds.append(time.perf_counter() - start)
    if task.refits:
        responses, seconds = fit.simulate(task.refits, seed=2), []
        for _ in range(task.repeats):
            start = time.perf_counter()
            # a new fit, so that nothing computed for the design before is used again
            fit_mixed_model(task.formula, task.table).refit_many(responses)
            seconds.append(time.perf_counter() - start)
    found = {"repeats": len(seconds), "minimum_s": min(seconds), "median_s": median(seconds)}
    return found | {"loglik": fit.loglik, "note": "" if fit.converged else fit.message}, fit


def peer(name: str, task: Task, fit: MixedModelFit, limit_s: float) -> dict[str, object]:
    """Time another library in a process of its own, which is stopped after the limit."""
    python, script = PEERS[name]
    if not python.exists():
        return {"note": "not installed; run `make peers`"}
    with TemporaryDirectory() as folder:
        table, responses = Path(folder) / "table.csv", Path(folder) / "responses.npy"
        task.table.to_csv(table, index=False)
        repeats = 1 if task.refits else task.repeats
        command = [python, REPOSITORY / "scripts" / script, table, task.formula]
        command += ["--repeats", str(repeats), "--limit-s", str(limit_s / 4.0)]
        if task.refits:
            np.save(responses, fit.simulate(task.refits, seed=2))
            command += ["--responses", responses]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=limit_s)
        except subprocess.TimeoutExpired:
            return {"note": f"stopped after {limit_s:g} s"}
    if done.returncode != 0:
        return {"note": f"failed: {(done.stderr.strip().splitlines() or ['?'])[-1][:100]}"}
    answer = json.loads(done.stdout.strip().splitlines()[-1])
    seconds, note = answer["seconds"], f"version {answer['version']}"
    if task.refits:
        each = answer["refit_seconds"] / answer["refits"]
        seconds = [each * task.refits]
        if answer["refits"] < task.refits:
            note += f"; from {answer['refits']} refits"
    return {
        "repeats": len(seconds),
        "minimum_s": min(seconds),
        "median_s": median(seconds),
        "loglik": answer["loglik"],
        "note": note,
    }


def main() -> None:
    """Time, print, write."""
    parser = script_parser(__doc__)
    parser.add_argument("--reference", help="folder with reference fits by lme4")
    parser.add_argument("--limit-s", type=float, default=120.0, help="time a peer gets per model")
    parser.add_argument("--output", default=str(REPOSITORY / "results/benchmark/mixed_models.csv"))
    arguments = parser.parse_args()
    folder = reference_folder(arguments.reference)
    print(f"tables: {folder or 'simulated in the shape of the reference tables'}; one thread")
    rows = []
    for task in tasks(folder):
        found, fit = ours(task)
        mine = float(str(found["median_s"]))
        results = {"swaystride": found}
        results |= {name: peer(name, task, fit, arguments.limit_s) for name in PEERS}
        results["lme4"] = {"median_s": task.lme4_s, "note": "1.1-31, quoted, another machine"}
        print(f"\n{task.name}")
        for name, result in results.items():
            row = {"model": task.name, "program": name} | result
            if "median_s" in row:
                row["ratio"] = float(str(row["median_s"])) / mine
            rows.append(row)
            print("  " + line(row))
    frame = pd.DataFrame(rows)
    frame = frame[
        ["model", "program", "repeats", "minimum_s", "median_s", "ratio", "loglik", "note"]
    ]
    output = Path(arguments.output)
    output.parent.mkdir(parents=True, exist_ok=True)
    frame.astype({"repeats": "Int64"}).to_csv(output, index=False, float_format="%.10g")
    print(f"\nwritten: {output}")


def line(row: dict[str, object]) -> str:
    """One result in words."""
    text = f"{row['program']:<12}"
    if "minimum_s" in row:
        text += f"minimum {row['minimum_s']:9.4f} s  "
    if "median_s" in row:
        text += f"median {row['median_s']:9.4f} s  x{row['ratio']:<8.3g} "
    if "loglik" in row:
        text += f"log-likelihood {row['loglik']:.6f}  "
    return f"{text}{row.get('note', '')}".rstrip()


if __name__ == "__main__":
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    run_script(main)
