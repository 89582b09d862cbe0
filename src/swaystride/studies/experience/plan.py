"""What is measured in a run and which scales of experience it is laid beside (dissertation, §5.3)."""

from __future__ import annotations

from typing import Final, NamedTuple

from swaystride.gait.run_measures import MEASURES as KINEMATIC_MEASURES

#: Scales of experience, in the order of Tables 5.3 and 5.4, and what the columns of the lab hold.
SCALES: Final = ("affective_valence", "activity_enjoyment", "flow")
#: Ends of each scale: Feeling Scale, sum of PACES, sum of the Flow Short Scale (D§5.3.3, §5.4.1).
SCALE_ENDS: Final = {
    "affective_valence": (-5.0, 5.0),
    "activity_enjoyment": (18.0, 126.0),
    "flow": (13.0, 97.0),
}
#: Names of the questionnaires in the lab's table.
QUESTIONNAIRES: Final = {"paces": "activity_enjoyment", "fss": "flow"}
HEART_RATE: Final = "heart_rate_bpm"

#: Labels of the sensors in the vendor's file are parameters; these are the names inside.
SENSORS: Final = (
    "foot_right",
    "foot_left",
    "shank_right",
    "shank_left",
    "thigh_right",
    "thigh_left",
    "lumbar",
    "sternum",
    "upper_arm_right",
    "upper_arm_left",
    "wrist_right",
    "wrist_left",
    "head",
)
#: Without these there are no events, and the run is left out.
NEEDED_SENSORS: Final = ("foot_right", "foot_left", "lumbar")


class RunMeasure(NamedTuple):
    """A row of Tables 5.3 and 5.4: its column ``key`` and its printed ``name``."""

    key: str
    name: str


_COUPLE_NAMES: Final = {
    "foot_shank": "Foot-Shank",
    "shank_thigh": "Shank-Thigh",
    "thigh_pelvis": "Thigh-Pelvis",
}
_PERIOD_NAMES: Final = {
    "early_stance": "ES",
    "mid_stance": "MS",
    "late_stance": "LS",
    "terminal_swing": "TS",
}

#: All 37, in the order of the tables.
MEASURES: Final = (
    RunMeasure(HEART_RATE, "Heart Rate"),
    RunMeasure("speed_m_s", "Speed"),
    RunMeasure("stride_length_m", "Stride Length"),
    RunMeasure("stride_time_s", "Stride Time"),
    RunMeasure("contact_time_s", "Contact Time"),
    RunMeasure("flight_time_s", "Flight Time"),
    RunMeasure("duty_factor", "Duty Factor"),
    RunMeasure("peak_tibial_g", "Peak Tibial Acceleration"),
    RunMeasure("peak_pelvic_g", "Peak Pelvic Acceleration"),
    RunMeasure("peak_head_g", "Peak Head Acceleration"),
    RunMeasure("peak_tibial_g_per_kg", "Peak Tibial Acceleration Per BW"),
    RunMeasure("peak_pelvic_g_per_kg", "Peak Pelvic Acceleration Per BW"),
    RunMeasure("peak_head_g_per_kg", "Peak Head Acceleration Per BW"),
    RunMeasure("attenuation_shank_head", "Shank-to-Head Attenuation"),
    RunMeasure("attenuation_shank_pelvis", "Shank-to-Pelvis Attenuation"),
    RunMeasure("attenuation_pelvis_head", "Pelvis-to-Head Attenuation"),
    RunMeasure("vertical_ratio", "Vertical Ratio of Pelvis Acceleration RMS"),
    RunMeasure("ml_ratio", "ML Ratio of Pelvis Acceleration RMS"),
    RunMeasure("ap_ratio", "AP Ratio of Pelvis Acceleration RMS"),
    RunMeasure("hip_range_deg", "Hip ROM"),
    RunMeasure("knee_range_deg", "Knee ROM"),
    RunMeasure("peak_roll_rate_deg_s", "Foot Peak Roll Rate"),
    *(
        RunMeasure(f"{couple}_{period}", f"{first} {second} Coordination Variability")
        for couple, first in _COUPLE_NAMES.items()
        for period, second in _PERIOD_NAMES.items()
    ),
    RunMeasure("arm_vertical_rms_g", "Arm Vertical Acceleration RMS"),
    RunMeasure("arm_ml_rms_g", "Arm ML Acceleration RMS"),
    RunMeasure("arm_ap_rms_g", "Arm AP Acceleration RMS"),
)
MEASURE_KEYS: Final = tuple(measure.key for measure in MEASURES)

#: Global running patterns by the mean duty factor of a run (D§5.3.4.2).
PATTERNS: Final = ("aerial", "intermediate", "terrestrial")

assert set(MEASURE_KEYS) == {HEART_RATE, *KINEMATIC_MEASURES}
