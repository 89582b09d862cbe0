"""Error-state Kalman filter: 3-D joint angles of the lower limbs from seven inertial sensors."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "Body": "body",
        "FilterOptions": "options",
        "NoiseSet": "noise",
        "Start": "start",
        "estimate_lower_limbs": "lower_limbs",
        "lower_limb_body": "body",
        "start_from_poses": "start",
    },
)
