"""Lazy package exports, so that importing a room costs nothing until something in it is used."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lazy_exports(
    package: str, home_of: Mapping[str, str]
) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Build the ``__getattr__``, ``__dir__`` and ``__all__`` of a package.

    Parameters
    ----------
    package : str
        Name of the package (its ``__name__``).
    home_of : mapping of str to str
        Public name to the submodule that defines it, relative to the package.

    Returns
    -------
    tuple
        ``__getattr__``, ``__dir__`` and ``__all__`` for the package's namespace.

    Examples
    --------
    >>> from swaystride.sway import sway_metrics  # resolved on first use
    >>> sway_metrics.__module__
    'swaystride.sway.metrics'
    """

    def getattr_(name: str) -> Any:
        if name not in home_of:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(import_module(f"{package}.{home_of[name]}"), name)

    def dir_() -> list[str]:
        return sorted(home_of)

    return getattr_, dir_, sorted(home_of)
