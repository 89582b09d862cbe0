"""Readers and writers, one module per vendor format; the format is found by content."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {"read_recording": "reading"},
)
