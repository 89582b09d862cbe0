"""What jobs depend on and inherit: code, commit, environment."""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache
from pathlib import Path

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
