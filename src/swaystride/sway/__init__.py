"""Standing balance: from the signals of a lumbar sensor to trunk angles and sway measures."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {"sway_metrics": "metrics", "trunk_angles": "angles"},
)
