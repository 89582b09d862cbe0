"""Words and colours that the figures of this study share."""

from __future__ import annotations

from typing import Final

from swaystride.presentation.figure_style import OKABE_ITO

#: What is positive, on the axis of each angle.
ANGLE_LABELS: Final = {
    "hip_flexion": "Hip flexion",
    "hip_adduction": "Hip adduction",
    "hip_rotation": "Hip internal rotation",
    "knee_flexion": "Knee flexion",
    "knee_adduction": "Knee adduction",
    "knee_rotation": "Knee internal rotation",
    "ankle_dorsiflexion": "Ankle dorsiflexion",
    "ankle_inversion": "Ankle inversion",
    "ankle_rotation": "Ankle internal rotation",
}
#: The same where there is little room.
SHORT_LABELS: Final = {
    "hip_flexion": "Hip\nF/E",
    "hip_adduction": "Hip\nAb/Ad",
    "hip_rotation": "Hip\nInt/Ext",
    "knee_flexion": "Knee\nF/E",
    "knee_adduction": "Knee\nAb/Ad",
    "knee_rotation": "Knee\nInt/Ext",
    "ankle_dorsiflexion": "Ankle\nD/P",
    "ankle_inversion": "Ankle\nIn/Ev",
    "ankle_rotation": "Ankle\nInt/Ext",
}
SOURCE_LABELS: Final = {"optic": "OPTIC", "erkf": "ErKF"}
SOURCE_COLOURS: Final = {"optic": OKABE_ITO["black"], "erkf": OKABE_ITO["blue"]}
#: Directions in which a joint centre is shifted: blue, red and yellow in the source.
DIRECTION_COLOURS: Final = {
    "AP": OKABE_ITO["blue"],
    "CC": OKABE_ITO["vermillion"],
    "ML": OKABE_ITO["orange"],
}
DIRECTION_LABELS: Final = {
    "AP": "anterior-posterior",
    "CC": "cranial-caudal",
    "ML": "medial-lateral",
}
PLANE_COLOURS: Final = (OKABE_ITO["blue"], OKABE_ITO["vermillion"], OKABE_ITO["bluish_green"])
CYCLE_LABEL: Final = "gait cycle (%)"
SHADE: Final = "#D9D9D9"
