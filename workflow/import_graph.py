"""Which files a module depends on, read from its import statements without running anything."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
SOURCE = REPOSITORY / "src"
PACKAGE = "swaystride"


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
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            names = [f"{node.module}.{alias.name}" for alias in node.names] + [node.module]
        else:
            continue
        found.update(
            name for name in names if name.split(".")[0] == PACKAGE and module_file(name)
        )
    return tuple(sorted(found))


def dependencies(file: Path) -> list[Path]:
    """All files of the package that a file needs, itself excluded, sorted.

    A module brings its parent packages along, because importing it runs their ``__init__``.
    A data file that stands beside a module and carries its name (``standing_response.json``
    beside ``standing_response.py``) belongs to it.
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
                    seen.update(
                        data
                        for data in part.parent.glob(f"{part.stem}.*")
                        if data.suffix in {".json", ".css", ".html"}
                    )
    return sorted(seen - {file})
