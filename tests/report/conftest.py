"""A small study with result files, printed tables and two figures, made in a temporary folder."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml

from swaystride.findings import FINDING_COLUMNS
from swaystride.presentation.figure_style import figure_style, new_figure, save_figure
from swaystride.presentation.table_files import read_table, write_table
from swaystride.report.assemble import study_content
from swaystride.report.content import Exclusion, Flow, Parameter
from swaystride.report.page_text import load_page_text

PUBLISHED = Path(__file__).resolve().parents[2] / "data" / "published"

TEXT = {
    "title": "Balance",
    "source": "chapter 2",
    "question": "Does it work?",
    "design": ["Nineteen people stood."],
    "notes": ["One note."],
    "items": [
        {
            "id": "table_2_3",
            "kind": "table",
            "title": "Table 2.3",
            "caption": "Effects.",
            "file": "tables/table_2_3.csv",
            "printed": "table_2_3.csv",
            "keys": ["panel", "feature", "effect"],
            "group": "panel",
            "values": [
                {
                    "estimate": "estimate",
                    "format": "number:3",
                    "ci": ["ci_low", "ci_high"],
                    "confidence": 0.95,
                },
                {"estimate": "p", "format": "p"},
            ],
        },
        {
            "id": "table_2_2",
            "kind": "agreement",
            "title": "Table 2.2",
            "caption": "Terms.",
            "file": "tables/table_2_2.csv",
            "printed": "table_2_2.csv",
            "keys": ["feature"],
            "columns": ["order", "block", "age"],
        },
        {
            "id": "claims",
            "kind": "claims",
            "title": "Claims",
            "caption": "What the text says.",
            "file": "tables/claims.csv",
        },
        {
            "id": "figure_1",
            "kind": "figure",
            "title": "Figure 1",
            "caption": "A curve.",
            "alt": "A rising line.",
            "file": "figures/figure_1",
        },
        {
            "id": "residuals",
            "kind": "assumption",
            "title": "Residuals",
            "caption": "Normality.",
            "alt": "Points on a line.",
            "file": "figures/figure_1",
        },
    ],
}


@pytest.fixture(scope="session")
def repository(tmp_path_factory):
    """Folder with results/ and printed/ of the toy study."""
    root = tmp_path_factory.mktemp("repository")
    (root / "printed").mkdir()
    results = root / "results" / "toy"
    formats = {"exponent": 1, "estimate": 3, "ci_low": 3, "ci_high": 3, "p": "p"}
    for name in ("table_2_2", "table_2_3"):
        (root / "printed" / f"{name}.csv").write_bytes((PUBLISHED / f"{name}.csv").read_bytes())
        frame = read_table(PUBLISHED / f"{name}.csv").drop(
            columns="p_is_upper_bound", errors="ignore"
        )
        write_table(
            frame,
            results / "tables" / name,
            caption="c",
            formats={key: value for key, value in formats.items() if key in frame},
            simulated=True,
        )
    claims = pd.DataFrame({"claim": ["Sway falls."], "evidence": ["b < 0"], "reproduced": ["yes"]})
    write_table(claims, results / "tables" / "claims", caption="c", formats={}, simulated=True)
    with figure_style():
        figure = new_figure(height_mm=40)
        figure.add_subplot().plot(np.arange(3), np.arange(3))
        save_figure(figure, results / "figures" / "figure_1", simulated=True)
    return root


@pytest.fixture
def toy_text():
    """The words of the toy study."""
    return TEXT


@pytest.fixture
def make_content(repository, tmp_path):
    """Make a content; ``text`` changes the words, other keywords the content."""

    def make(*, text=None, **options):
        file = tmp_path / "toy.yaml"
        file.write_text(yaml.safe_dump(TEXT | (text or {})), encoding="utf-8")
        rows = [("packet_loss", "warning", f"P{n:02d}.txt", "", "none", "4") for n in range(3)]
        settings = {
            "slug": "balance",
            "cohort": "synthetic",
            "variant": "printed",
            "scale": "demo",
            "simulated": True,
            "flow": [
                Flow("participants", 19, 19, (), 19),
                Flow("trials", None, 10, (Exclusion("too short", 2),), 8),
            ],
            "findings": pd.DataFrame(rows, columns=FINDING_COLUMNS),
            "parameters": [
                Parameter("cutoff_hz", "2", "Hz", "section 2.3", "Filtering"),
                Parameter("coding", "running", "", "inferred", "Model", True),
            ],
            "results_dir": "results/toy",
            "printed_dir": "printed",
            "root": repository,
        } | options
        return study_content(load_page_text(file), **settings)

    return make
