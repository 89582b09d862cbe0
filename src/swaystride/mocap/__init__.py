"""Optical motion capture: from markers to joint centres, joint angles and events of the feet."""

from swaystride.lazy import lazy_exports

__getattr__, __dir__, __all__ = lazy_exports(
    __name__,
    {
        "Anthropometrics": "anthropometrics",
        "Cleaning": "marker_cleaning",
        "MarkerSet": "marker_set",
        "average_joint_axes": "joint_axes",
        "clean_markers": "marker_cleaning",
        "fill_gaps": "marker_gaps",
        "foot_contacts": "foot_events",
        "hara_hip_centres": "hip_centre",
        "optical_joint_angles": "optical_angles",
        "perturbed_angles": "perturbation",
        "static_model": "static_calibration",
    },
)
