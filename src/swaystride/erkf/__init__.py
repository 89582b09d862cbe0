"""Error-state Kalman filter: 3-D joint angles of the lower limbs from seven inertial sensors."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "Body": "body",
        "FilterOptions": "options",
        "HingeSearch": "hinge_axis",
        "NoiseSet": "noise",
        "Start": "start",
        "estimate_lower_limbs": "lower_limbs",
        "hinge_axis_of": "hinge_axis",
        "imu_centres": "imu_initialisation",
        "level_mounting": "alignment",
        "lower_limb_body": "body",
        "optical_start": "optical_initialisation",
        "start_at_rest": "imu_initialisation",
        "start_from_poses": "start",
        "start_in_stance": "imu_initialisation",
    },
)
