"""One table of finished cells as Markdown, LaTeX and HTML.

The cells come in as text (see ``number_format``); this module only escapes and arranges them, so
the three renderings hold the same cells.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

SIMULATED_NOTE = "Simulated cohort: not measurements."

_TEX = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"$<$",
    ">": r"$>$",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "\N{MINUS SIGN}": r"$-$",
    "×": r"$\times$",
    "±": r"$\pm$",
    "≤": r"$\leq$",
    "≥": r"$\geq$",
    "≠": r"$\neq$",
    "≈": r"$\approx$",
    "∞": r"$\infty$",
    "°": r"$^{\circ}$",
    "²": r"$^{2}$",
    "³": r"$^{3}$",
    "·": r"$\cdot$",
    "µ": r"$\mu$",
    "–": "--",
    "—": "---",
    "…": r"\dots{}",
    "\N{NO-BREAK SPACE}": "~",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "\N{LEFT DOUBLE QUOTATION MARK}": "``",
    "\N{RIGHT DOUBLE QUOTATION MARK}": "''",
    "α": r"$\alpha$",
    "β": r"$\beta$",
    "γ": r"$\gamma$",
    "δ": r"$\delta$",
    "Δ": r"$\Delta$",
    "θ": r"$\theta$",
    "λ": r"$\lambda$",
    "ρ": r"$\rho$",
    "σ": r"$\sigma$",
    "φ": r"$\phi$",
    "χ": r"$\chi$",
    "ω": r"$\omega$",
}
_TEX_TABLE = str.maketrans(_TEX)
_MARKDOWN_SPECIAL = re.compile(r"([\\`*_{}\[\]<>|#~^$&])")


@dataclass(frozen=True)
class TextTable:
    """A table whose cells are finished text.

    Parameters
    ----------
    header : sequence of str
        Column headings.
    rows : sequence of sequence of str
        Cells, row by row.
    numeric : sequence of bool
        Which columns are aligned to the right.
    caption : str
        One or two sentences above the table.
    notes : sequence of str
        Remarks below the table.
    simulated : bool
        Adds the line that says that the cohort is simulated.
    """

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    numeric: Sequence[bool]
    caption: str
    notes: Sequence[str] = ()
    simulated: bool = False

    @property
    def all_notes(self) -> tuple[str, ...]:
        """The notes, led by the simulated mark where it applies."""
        return ((SIMULATED_NOTE,) if self.simulated else ()) + tuple(self.notes)


def tex_escape(text: str) -> str:
    r"""Escape text for LaTeX, line breaks included.

    Parameters
    ----------
    text : str
        Any text.

    Examples
    --------
    >>> print(tex_escape("50% of A_b & <0.001"))
    50\% of A\_b \& $<$0.001
    >>> print(tex_escape("−0.030"))
    $-$0.030
    """
    return _one_line(text).translate(_TEX_TABLE)


def markdown_escape(text: str) -> str:
    r"""Escape text for a cell of a Markdown pipe table.

    Parameters
    ----------
    text : str
        Any text.

    Examples
    --------
    >>> print(markdown_escape("yes* | phi_rms"))
    yes\* \| phi\_rms
    """
    return _MARKDOWN_SPECIAL.sub(r"\\\1", _one_line(text))


def to_markdown(table: TextTable) -> str:
    """Write a pipe table with the caption above and the notes below.

    Parameters
    ----------
    table : TextTable
        Finished cells.

    Examples
    --------
    >>> print(to_markdown(TextTable(["a", "n"], [["x", "1"]], [False, True], "Counts.")))
    **Counts.**
    <BLANKLINE>
    | a | n |
    | :-- | --: |
    | x | 1 |
    <BLANKLINE>
    """
    rule = ["--:" if numeric else ":--" for numeric in table.numeric]
    body = [[markdown_escape(cell) for cell in row] for row in (table.header, *table.rows)]
    lines = ["| " + " | ".join(row) + " |" for row in (body[0], rule, *body[1:])]
    blocks = [f"**{markdown_escape(table.caption)}**", "\n".join(lines)]
    blocks += [f"*{markdown_escape(note)}*" for note in table.all_notes]
    return "\n\n".join(blocks) + "\n"


def to_tex(table: TextTable) -> str:
    r"""Write a ``table`` environment with booktabs rules, ready for ``\input``.

    Parameters
    ----------
    table : TextTable
        Finished cells.
    """
    columns = "".join("r" if numeric else "l" for numeric in table.numeric)
    header, *body = (_tex_row(row) for row in (table.header, *table.rows))
    notes = [rf"\par\smallskip{{\footnotesize {tex_escape(note)}\par}}" for note in table.all_notes]
    lines = [
        r"% needs \usepackage{booktabs}",
        r"\begin{table}",
        r"\centering",
        rf"\caption{{{tex_escape(table.caption)}}}",
        rf"\begin{{tabular}}{{{columns}}}",
        r"\toprule",
        header,
        r"\midrule",
        *body,
        r"\bottomrule",
        r"\end{tabular}",
        *notes,
        r"\end{table}",
    ]
    return "\n".join(lines) + "\n"


def to_html(table: TextTable) -> str:
    """Write an HTML fragment: one ``div`` with the table and its notes.

    Parameters
    ----------
    table : TextTable
        Finished cells.

    Examples
    --------
    >>> print(to_html(TextTable(["a", "n"], [["<x>", "1"]], [False, True], "Counts.")))
    <div class="result-table">
    <table>
    <caption>Counts.</caption>
    <thead><tr><th scope="col">a</th><th scope="col" class="num">n</th></tr></thead>
    <tbody>
    <tr><th scope="row">&lt;x&gt;</th><td class="num">1</td></tr>
    </tbody>
    </table>
    </div>
    <BLANKLINE>
    """
    head = "".join(
        f'<th scope="col"{_number_class(numeric)}>{escape(_one_line(name))}</th>'
        for name, numeric in zip(table.header, table.numeric, strict=True)
    )
    body = [f"<tr>{_html_row(row, table.numeric)}</tr>" for row in table.rows]
    notes = [f'<p class="table-note">{escape(_one_line(note))}</p>' for note in table.all_notes]
    lines = [
        '<div class="result-table">',
        "<table>",
        f"<caption>{escape(_one_line(table.caption))}</caption>",
        f"<thead><tr>{head}</tr></thead>",
        "<tbody>",
        *body,
        "</tbody>",
        "</table>",
        *notes,
        "</div>",
    ]
    return "\n".join(lines) + "\n"


def _tex_row(row: Sequence[str]) -> str:
    r"""One row; ``{}`` keeps the ``\\`` before it from reading ``[`` or ``*`` as its argument."""
    text = " & ".join(tex_escape(cell) for cell in row)
    return ("{}" if text.startswith(("[", "*")) else "") + text + r" \\"


def _html_row(row: Sequence[str], numeric: Sequence[bool]) -> str:
    """Cells of a row; a leading text cell is the heading of its row."""
    cells = []
    for position, (cell, right) in enumerate(zip(row, numeric, strict=True)):
        text = escape(_one_line(cell))
        if position == 0 and not right:
            cells.append(f'<th scope="row">{text}</th>')
        else:
            cells.append(f"<td{_number_class(right)}>{text}</td>")
    return "".join(cells)


def _number_class(numeric: bool) -> str:
    return ' class="num"' if numeric else ""


def _one_line(text: str) -> str:
    return " ".join(text.split())
