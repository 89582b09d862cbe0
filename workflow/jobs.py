"""What jobs depend on and inherit: code, commit, environment."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from threading import Timer
from typing import Any

from import_graph import REPOSITORY, SOURCE, dependencies, module_file


@cache
def code(*modules: str) -> list[str]:
    """Files that a rule depends on: its script or modules, and all that they import.

    Parameters
    ----------
    *modules : str
        Paths of scripts (``scripts/x.py``) or dotted names of library modules.
    """
    files: set[Path] = set()
    for module in modules:
        file = REPOSITORY / module if module.endswith(".py") else module_file(module)
        if file is None or not file.is_file():
            raise FileNotFoundError(f"no such script or module: {module}")
        files |= {file, *dependencies(file)}
    return sorted(str(file.relative_to(REPOSITORY)) for file in files)


@cache
def commit() -> str:
    """Commit of the checkout, with ``+changes`` if tracked files differ; ``unknown`` without git."""
    git = ["git", "-C", str(REPOSITORY)]
    try:
        head = subprocess.run(
            [*git, "rev-parse", "HEAD"], capture_output=True, text=True, check=True
        ).stdout.strip()
        changed = subprocess.run(
            [*git, "status", "--porcelain", "--untracked-files=no"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{head}+changes" if changed else head


def look_once_a_second() -> None:
    """Let Snakemake look at its queue once a second, and whenever a job ends.

    Snakemake 9.27 sets a timer at every look, because a limit of jobs per second may have passed;
    and every job that ends adds a look. So the looks become as many a second as jobs have ended, each
    asks for the size of all inputs of all jobs that are ready, and a build of a hundred jobs keeps a
    third of a core busy with it. One timer at a time says the same.
    """
    from snakemake.scheduling.job_scheduler import JobScheduler

    def set_timer(scheduler: Any, delay: int) -> None:
        pending = getattr(scheduler, "_pending_look", None)
        if pending is None or not pending.is_alive():
            scheduler._pending_look = Timer(delay, scheduler._open_jobs.release)
            scheduler._pending_look.daemon = True
            scheduler._pending_look.start()

    # the method is private and may be gone in another version, and with it the fault
    if hasattr(JobScheduler, "_schedule_reevalutation"):
        JobScheduler._schedule_reevalutation = set_timer


def prepare_environment() -> None:
    """Set what every job inherits, in this one place.

    Jobs run side by side, one core each, so numerical libraries stay single-threaded; ``python``
    is the interpreter that runs Snakemake; the library is the one of this checkout.
    """
    for name in ("OMP", "OPENBLAS", "MKL", "NUMEXPR", "NUMBA"):
        os.environ[f"{name}_NUM_THREADS"] = "1"
    os.environ["MPLBACKEND"] = "Agg"
    os.environ["PYTHONHASHSEED"] = "0"
    os.environ["PYTHONPATH"] = str(SOURCE)
    os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
