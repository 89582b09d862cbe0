"""A copy of the repository to run the workflow in, and the demo cohort built once."""

import hashlib
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from import_graph import REPOSITORY

#: What a run of the workflow needs; nothing generated.
PARTS = ("Snakefile", "config", "workflow", "scripts", "src", "data/published", "requirements.txt")
#: Folders of compiled code.
COMPILED = "__pycache__"


@dataclass
class Sandbox:
    """A checkout of its own, in a temporary folder.

    Parameters
    ----------
    root : Path
        Its top level.
    """

    root: Path

    def snakemake(self, *arguments, cores=2):
        """Run Snakemake; returns the finished process with both streams in ``stdout``."""
        environment = {k: v for k, v in os.environ.items() if k != "SWAYSTRIDE_REAL_DATA"}
        command = [sys.executable, "-m", "snakemake", "--cores", str(cores), *arguments]
        return subprocess.run(
            command,
            cwd=self.root,
            env=environment,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            check=False,
        )

    def planned(self, *arguments):
        """Jobs of a dry run: rule to number."""
        output = self.snakemake("--dry-run", *arguments).stdout
        if "Nothing to be done" in output:
            return {}
        table = output.rsplit("Job stats:", 1)[1].split("\n\n", 1)[0]
        rows = [line.split() for line in table.splitlines()]
        return {
            row[0]: int(row[1])
            for row in rows
            if len(row) == 2 and row[1].isdigit() and row[0] != "total"
        }

    def bytes_of(self, folder):
        """SHA-256 of every file below a folder."""
        base = self.root / folder
        return {
            str(path.relative_to(base)): hashlib.sha256(path.read_bytes()).hexdigest()
            for path in sorted(base.rglob("*"))
            if path.is_file()
        }


def checkout(root):
    """Copy the repository without what it generated.

    Compiled code takes minutes to make; the checkouts share that of the repository, so that what one
    process has compiled is there for all. It belongs to sources of one time and size, which a copy
    keeps: an edited module has its own.
    """
    for part in PARTS:
        source, target = REPOSITORY / part, root / part
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=shutil.ignore_patterns(COMPILED))
        else:
            shutil.copy2(source, target)
    for module in (REPOSITORY / "src").rglob("__init__.py"):
        shared = module.parent / COMPILED
        shared.mkdir(exist_ok=True)
        (root / shared.relative_to(REPOSITORY)).symlink_to(shared)
    return Sandbox(root)


@pytest.fixture(scope="session")
def new_checkout(tmp_path_factory):
    """Function that makes a fresh checkout."""
    return lambda name: checkout(tmp_path_factory.mktemp(name) / "checkout")


@pytest.fixture
def sandbox(tmp_path):
    """A fresh checkout."""
    return checkout(tmp_path / "checkout")


@pytest.fixture(scope="session")
def demo(tmp_path_factory):
    """A checkout with the demo cohort built on two cores."""
    built = checkout(tmp_path_factory.mktemp("two_cores") / "checkout")
    process = built.snakemake("--quiet", "rules", "--config", "cohort=synthetic_demo", "--", "all")
    assert process.returncode == 0, process.stdout
    return built
