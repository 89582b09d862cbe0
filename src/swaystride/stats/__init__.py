"""Statistics that know no biomechanics: mixed models, selection of terms, resampling."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {"fit_mixed_model": "mixed_model"},
)
