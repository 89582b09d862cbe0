"""One restrained look for every figure, and files that are the same byte for byte.

Text in SVG files is drawn as outlines (``svg.fonttype = "path"``): a page shows the SVG as an
image, where only fonts of the reader's machine could be used, and a substitute font would shift
every label. The words stay searchable in the PDF and in the alt text of the page.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Literal

import matplotlib.style
from cycler import cycler
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from swaystride.errors import ConfigurationError

MM_PER_INCH = 25.4
WIDTHS_MM = {"single": 85.0, "double": 175.0}
PNG_DPI = 200

OKABE_ITO = {
    "black": "#000000",
    "orange": "#E69F00",
    "sky_blue": "#56B4E9",
    "bluish_green": "#009E73",
    "yellow": "#F0E442",
    "blue": "#0072B2",
    "vermillion": "#D55E00",
    "reddish_purple": "#CC79A7",
}
"""Colours that people with any colour vision can tell apart (Okabe and Ito, 2008)."""

_CYCLE = ("blue", "vermillion", "bluish_green", "reddish_purple", "orange", "sky_blue", "black")
_INK = "#222222"
_STYLE = {
    "font.family": ["DejaVu Sans"],
    "font.size": 7.5,
    "mathtext.fontset": "dejavusans",
    "axes.titlesize": 8.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 5.0,
    "axes.labelsize": 7.5,
    "axes.labelcolor": _INK,
    "axes.edgecolor": _INK,
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "axes.prop_cycle": cycler(color=[OKABE_ITO[name] for name in _CYCLE]),
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.5,
    "xtick.color": _INK,
    "ytick.color": _INK,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.minor.size": 1.5,
    "ytick.minor.size": 1.5,
    "text.color": _INK,
    "legend.fontsize": 7.0,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "lines.linewidth": 1.1,
    "lines.markersize": 3.5,
    "patch.linewidth": 0.6,
    "errorbar.capsize": 0.0,
    "image.cmap": "cividis",
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "savefig.dpi": PNG_DPI,
    "svg.fonttype": "path",
    "svg.hashsalt": "swaystride",
    "pdf.fonttype": 42,
    "pdf.compression": 6,
}
_NO_METADATA: dict[str, dict[str, None]] = {
    "svg": {"Date": None, "Creator": None, "Format": None, "Type": None},
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Creator": None, "Producer": None},
}
_STRIP_MM = 5.0


@contextmanager
def figure_style() -> Iterator[None]:
    """Style in force inside a ``with`` block, whatever the reader's matplotlibrc says.

    Examples
    --------
    >>> import matplotlib
    >>> with figure_style():
    ...     matplotlib.rcParams["axes.spines.top"]
    False
    """
    with matplotlib.style.context(["default", _STYLE]):
        yield


def new_figure(width: Literal["single", "double"] = "single", *, height_mm: float) -> Figure:
    """Empty figure of a column's width, with constrained layout and without pyplot.

    Call it, and draw, inside :func:`figure_style`.

    Parameters
    ----------
    width : {"single", "double"}
        85 mm or 175 mm.
    height_mm : float
        Height in millimetres.

    Raises
    ------
    ConfigurationError
        If the width has no such name or the height is not positive.

    Examples
    --------
    >>> with figure_style():
    ...     figure = new_figure("double", height_mm=60)
    >>> [round(float(inches) * 25.4) for inches in figure.get_size_inches()]
    [175, 60]
    """
    if width not in WIDTHS_MM:
        raise ConfigurationError(
            "width of a figure", expected="'single' or 'double'", found=repr(width)
        )
    if not height_mm > 0:
        raise ConfigurationError(
            "height of a figure", expected="millimetres above 0", found=repr(height_mm)
        )
    size = (WIDTHS_MM[width] / MM_PER_INCH, height_mm / MM_PER_INCH)
    return Figure(figsize=size, layout="constrained")


def save_figure(fig: Figure, stem: Path | str, *, simulated: bool) -> list[Path]:
    """Write ``<stem>.svg``, ``.png`` (200 dpi) and ``.pdf``, the same bytes every time.

    A simulated cohort is marked in a strip above the figure, which grows by 5 mm: the mark can
    neither hide data nor be hidden by them. A legend of the figure itself ("outside upper …") would
    move into that strip; place legends by their axes.

    Parameters
    ----------
    fig : matplotlib.figure.Figure
        The figure; it is left as it came.
    stem : path or str
        Path without suffix; its folder is made if needed.
    simulated : bool
        Whether the cohort is simulated.

    Returns
    -------
    list of Path
        The three files: SVG, PNG, PDF.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder, figure_style():
    ...     figure = new_figure(height_mm=30)
    ...     [file.name for file in save_figure(figure, f"{folder}/figure_1", simulated=True)]
    ['figure_1.svg', 'figure_1.png', 'figure_1.pdf']
    """
    base = Path(stem)
    base.parent.mkdir(parents=True, exist_ok=True)
    files = [base.parent / f"{base.name}.{suffix}" for suffix in _NO_METADATA]
    with figure_style(), _simulated_mark(fig, simulated) as box:
        for file, metadata in zip(files, _NO_METADATA.values(), strict=True):
            fig.savefig(file, metadata=metadata, dpi=PNG_DPI, bbox_inches=box)
    return files


@contextmanager
def _simulated_mark(fig: Figure, simulated: bool) -> Iterator[Bbox | None]:
    """Put the mark above the figure while it is saved; yields the region to save, in inches."""
    if not simulated:
        yield None
        return
    width, height = (float(inches) for inches in fig.get_size_inches())
    strip = _STRIP_MM / MM_PER_INCH
    mark = fig.text(
        0.04 / width,
        1.0 + 0.5 * strip / height,
        "SIMULATED COHORT",
        ha="left",
        va="center_baseline",
        fontsize=6.5,
        fontweight="bold",
        color="black",
        in_layout=False,
        bbox={
            "boxstyle": "square,pad=0.28",
            "facecolor": OKABE_ITO["orange"],
            "edgecolor": "black",
            "linewidth": 0.5,
        },
    )
    mark.set_in_layout(False)
    try:
        yield Bbox([[0.0, 0.0], [width, height + strip]])
    finally:
        mark.remove()
