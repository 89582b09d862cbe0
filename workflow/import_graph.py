"""Which files a module depends on, read from its import statements without running anything."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = REPOSITORY / "src"
PACKAGE = "swaystride"


@cache
def module_file(module: str) -> Path | None:
    """File that defines a module of the package, or None if there is no such module."""
    base = SOURCE.joinpath(*module.split("."))
    for candidate in (base.with_suffix(".py"), base / "__init__.py"):
        if candidate.is_file():
            return candidate
    return None


def module_name(file: Path) -> str:
    """Dotted name of the module that a file under src/ defines."""
    parts = file.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


@cache
def imported_modules(file: Path) -> tuple[str, ...]:
    """Modules of the package that a file imports, in order of their names."""
    found: set[str] = set()
    for node in _statements(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [f"{node.module}.{alias.name}" for alias in node.names] + [node.module]
        else:
            continue
        found.update(name for name in names if name.split(".")[0] == PACKAGE and module_file(name))
    return tuple(sorted(found))


def _statements(tree: ast.Module) -> Iterator[ast.AST]:
    """All statements of a module; expressions, nine of ten nodes, hold no import."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        yield node
        for block in ("body", "orelse", "finalbody", "handlers", "cases"):
            waiting += getattr(node, block, ())


@cache
def named_data(file: Path) -> tuple[Path, ...]:
    """Data files beside or below a module that its text names."""
    if file.parent == SOURCE / PACKAGE:
        return ()
    text = file.read_text(encoding="utf-8")
    return tuple(data for data in _data_below(file.parent) if data.name in text)


@cache
def _data_below(folder: Path) -> tuple[Path, ...]:
    """All data files of a folder of the package and of those below it, sorted."""
    kinds = {".json", ".csv", ".html", ".css"}
    return tuple(sorted(data for data in folder.rglob("*.*") if data.suffix in kinds))


def dependencies(file: Path) -> list[Path]:
    """All files of the package that a file needs, itself excluded, sorted.

    A module brings its parent packages along, because importing it runs their ``__init__``.
    A data file of the package (JSON, CSV, HTML, CSS) belongs to every module of its folder, or of
    a folder above, whose text names it.
    """
    seen: set[Path] = set()
    waiting = [file]
    while waiting:
        for module in imported_modules(waiting.pop()):
            parts = module.split(".")
            for depth in range(1, len(parts) + 1):
                part = module_file(".".join(parts[:depth]))
                if part is not None and part not in seen:
                    seen.add(part)
                    waiting.append(part)
                    seen.update(named_data(part))
    return sorted(seen - {file})
