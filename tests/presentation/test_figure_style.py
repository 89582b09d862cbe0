"""Figures: the same bytes in two processes, the mark where it belongs, the style in force."""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import matplotlib.image
import numpy as np
import pytest

from swaystride.errors import ConfigurationError
from swaystride.presentation.figure_style import (
    OKABE_ITO,
    figure_style,
    new_figure,
    save_figure,
)

DRAW = """
import sys
from swaystride.presentation.figure_style import figure_style, new_figure, save_figure
with figure_style():
    fig = new_figure("single", height_mm=50)
    ax = fig.add_subplot()
    ax.plot([0, 1, 2], [0.5, -1, 2], marker="o", label="sway − angle ± φ")
    ax.fill_between([0, 1, 2], [0, 1, 0], hatch="//", alpha=0.3, clip_on=True)
    ax.set(xlabel="trial (N)", ylabel="ln φ", title="Äpfel")
    ax.legend()
    save_figure(fig, sys.argv[1], simulated=True)
"""
SOURCE = Path(__file__).resolve().parents[2] / "src"


def toy():
    fig = new_figure("single", height_mm=50)
    ax = fig.add_subplot()
    ax.plot([0, 1, 2], [0.5, -1, 2])
    ax.set(xlabel="x", ylabel="y")
    return fig


def test_two_processes_write_the_same_bytes(tmp_path):
    digests = []
    for number, zone in enumerate(("UTC", "Asia/Tokyo")):
        stem = tmp_path / str(number) / "figure"
        environment = {
            **os.environ,
            "PYTHONHASHSEED": str(number + 1),
            "PYTHONPATH": str(SOURCE),
            "TZ": zone,
        }
        subprocess.run([sys.executable, "-c", DRAW, str(stem)], check=True, env=environment)
        files = sorted(stem.parent.iterdir())
        assert [file.suffix for file in files] == [".pdf", ".png", ".svg"]
        digests.append([hashlib.sha256(file.read_bytes()).hexdigest() for file in files])
    assert digests[0] == digests[1]


def test_saving_twice_gives_the_same_bytes_and_leaves_the_figure_alone(tmp_path):
    with figure_style():
        fig = toy()
        n_texts = len(fig.texts)
        one = [file.read_bytes() for file in save_figure(fig, tmp_path / "a", simulated=True)]
        two = [file.read_bytes() for file in save_figure(fig, tmp_path / "b", simulated=True)]
    assert one == two
    assert len(fig.texts) == n_texts


@pytest.mark.parametrize("simulated", [True, False])
def test_files_carry_no_date_and_no_program(tmp_path, simulated):
    with figure_style():
        svg, png, pdf = save_figure(toy(), tmp_path / "f", simulated=simulated)
    assert not re.search(rb"\d{4}-\d\d-\d\d|Matplotlib|<dc:", svg.read_bytes())
    assert b"tEXt" not in png.read_bytes()
    assert not re.search(rb"CreationDate|Matplotlib|Producer", pdf.read_bytes())


def test_mark_is_a_strip_above_an_unchanged_figure(tmp_path):
    with figure_style():
        plain = save_figure(toy(), tmp_path / "plain", simulated=False)
        marked = save_figure(toy(), tmp_path / "marked", simulated=True)
    a, b = (matplotlib.image.imread(files[1])[..., :3] for files in (plain, marked))
    strip = b.shape[0] - a.shape[0]
    assert strip == pytest.approx(5.0 / 25.4 * 200, abs=1.5)
    assert a.shape[1] == b.shape[1]
    orange = np.array([int(OKABE_ITO["orange"][i : i + 2], 16) / 255 for i in (1, 3, 5)])
    is_orange = np.all(np.abs(b - orange) < 0.02, axis=2)
    assert is_orange[: strip + 1].mean() > 0.05
    assert not is_orange[strip + 1 :].any()
    assert not np.all(np.abs(a - orange) < 0.02, axis=2).any()
    # the drawing below the strip is what it was without the mark, up to a pixel of rounding
    ink = [(image.min(axis=2) < 0.5).sum() for image in (a, b[strip:])]
    assert ink[0] == pytest.approx(ink[1], rel=0.02)


def test_mark_can_be_read_in_the_vector_files(tmp_path):
    with figure_style():
        plain = save_figure(toy(), tmp_path / "plain", simulated=False)
        marked = save_figure(toy(), tmp_path / "marked", simulated=True)
    assert "SIMULATED COHORT" in marked[0].read_text()
    assert "SIMULATED COHORT" not in plain[0].read_text()


def test_text_in_svg_is_drawn_as_outlines(tmp_path):
    with figure_style():
        svg = save_figure(toy(), tmp_path / "f", simulated=False)[0].read_text()
    assert "<text" not in svg
    assert "font-family" not in svg


def test_png_has_200_dots_per_inch(tmp_path):
    with figure_style():
        png = save_figure(toy(), tmp_path / "f", simulated=False)[1]
    assert matplotlib.image.imread(png).shape[:2] == (int(50 / 25.4 * 200), int(85 / 25.4 * 200))


def test_style_ends_with_the_block_and_ignores_the_readers_settings():
    with matplotlib.rc_context({"axes.linewidth": 9.0, "axes.labelpad": 99.0}):
        with figure_style():
            assert matplotlib.rcParams["axes.linewidth"] == 0.6
            assert (
                matplotlib.rcParams["axes.labelpad"] == matplotlib.rcParamsDefault["axes.labelpad"]
            )
        assert matplotlib.rcParams["axes.linewidth"] == 9.0


def test_palette_is_the_published_one():
    """RGB values of Figure 16 of Okabe and Ito's guide, in its order."""
    published = [
        (0, 0, 0),
        (230, 159, 0),
        (86, 180, 233),
        (0, 158, 115),
        (240, 228, 66),
        (0, 114, 178),
        (213, 94, 0),
        (204, 121, 167),
    ]
    ours = [tuple(bytes.fromhex(code.removeprefix("#"))) for code in OKABE_ITO.values()]
    assert ours == published


@pytest.mark.parametrize(("width", "mm"), [("single", 85), ("double", 175)])
def test_widths(width, mm):
    with figure_style():
        fig = new_figure(width, height_mm=70)
    np.testing.assert_allclose(fig.get_size_inches() * 25.4, [mm, 70])


def test_unknown_width_and_height_are_refused():
    with pytest.raises(ConfigurationError, match=r"'single' or 'double'; found 'triple'"):
        new_figure("triple", height_mm=50)
    with pytest.raises(ConfigurationError, match=r"millimetres above 0; found 0"):
        new_figure(height_mm=0)
