"""Walking and running: from the signals of body-worn sensors to strides."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "FootMethod": "foot_methods",
        "distance_m": "strides",
        "foot_trajectory": "trajectory",
        "stride_lengths_at": "strides",
        "stride_table": "strides",
    },
)
