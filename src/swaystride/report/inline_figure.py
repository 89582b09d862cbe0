"""A figure inside the page: one data URI, chosen by size.

The image goes into ``<img>``, where the identifiers inside several SVG files cannot collide and
no script could run.
"""

from __future__ import annotations

import base64
import re
from pathlib import Path

from swaystride.errors import DesignError

SVG_UP_TO_BYTES = 600_000
"""Above this an SVG has so many points that the PNG is smaller and draws faster."""

_PX_PER_PT = 96.0 / 72.0
_SVG_TAG = re.compile(rb"<svg\b[^>]*>")


def inline_figure(stem: Path | str) -> tuple[str, int, int]:
    """Data URI and natural size of a saved figure.

    Parameters
    ----------
    stem : path or str
        As given to :func:`swaystride.presentation.figure_style.save_figure`.

    Returns
    -------
    uri : str
        ``data:image/svg+xml;base64,…`` or, for a large drawing, the PNG.
    width_px, height_px : int
        Size in CSS pixels.

    Raises
    ------
    DesignError
        If the figure is missing or its size cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from swaystride.presentation.figure_style import figure_style, new_figure, save_figure
    >>> with TemporaryDirectory() as folder, figure_style():
    ...     _ = save_figure(new_figure(height_mm=50), f"{folder}/f", simulated=False)
    ...     uri, width_px, height_px = inline_figure(f"{folder}/f")
    >>> uri[:26], width_px, height_px
    ('data:image/svg+xml;base64,', 321, 189)
    """
    base = Path(stem)
    svg, png = (base.parent / f"{base.name}.{suffix}" for suffix in ("svg", "png"))
    for file in (svg, png):
        if not file.is_file():
            raise DesignError("no such figure", file=file.name, expected="a saved figure")
    content = svg.read_bytes()
    tag = _SVG_TAG.search(content)
    sizes = [
        re.search(rb'\b%s="([\d.]+)pt"' % name, tag[0] if tag else b"")
        for name in (b"width", b"height")
    ]
    width, height = (round(float(size[1]) * _PX_PER_PT) if size else 0 for size in sizes)
    if not width or not height:
        raise DesignError("size of a figure", file=svg.name, expected="width and height in pt")
    if len(content) <= SVG_UP_TO_BYTES:
        return _data_uri("image/svg+xml", content), width, height
    return _data_uri("image/png", png.read_bytes()), width, height


def _data_uri(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode('ascii')}"
