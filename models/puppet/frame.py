"""The puppet's measures: where her joints are, and how far their brackets let them go.

She is a dancer of 0.62 m. Proportions are the dancer's (`enpointe.models.anatomy`) as near as
servos allow: hips are wider and ankles higher, because a servo of 28.5 mm by 46.5 mm by 34 mm sits
at each, and shank and thigh are alike, so that a deep plie folds. Ours, drawn for this project; no
such puppet is sold.

A servo of the 430 class turns a whole turn; between a U-shaped horn bracket and its own case a
hinge reaches about 125 degrees either way of straight in line, and about 100 from a right angle.
The ranges below keep within that, less where cables run or a printed shell comes in the way.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

__all__ = [
    "ANKLE_HEIGHT",
    "BALL_FORWARD",
    "BALL_HALF_BREADTH",
    "FACET_ANGLE",
    "FACET_LENGTH",
    "FOREARM",
    "HAND",
    "HEEL_BACK",
    "HEEL_HALF_BREADTH",
    "HIP_HALF_WIDTH",
    "HIP_HEIGHT",
    "NECK_HEIGHT",
    "RANGES_DEG",
    "SHANK",
    "SHOULDER_HALF_WIDTH",
    "SHOULDER_HEIGHT",
    "SOLE_RADIUS",
    "THIGH",
    "UPPER_ARM",
    "WAIST_HEIGHT",
]

HIP_HALF_WIDTH = 0.045
THIGH = 0.130
SHANK = 0.130
ANKLE_HEIGHT = 0.042
HIP_HEIGHT = THIGH + SHANK + ANKLE_HEIGHT
WAIST_HEIGHT = 0.062
"""Above the hips, m."""
SHOULDER_HEIGHT = 0.115
"""Above the waist, m."""
SHOULDER_HALF_WIDTH = 0.074
NECK_HEIGHT = 0.150
"""Above the waist, m."""
UPPER_ARM = 0.095
FOREARM = 0.088
HAND = 0.055

HEEL_BACK = 0.030
BALL_FORWARD = 0.044
BALL_HALF_BREADTH = 0.024
HEEL_HALF_BREADTH = 0.017
FACET_LENGTH = 0.032
FACET_ANGLE = 0.7854
"""rad between the sole and the second sole in front of it. A toe that bends would be a servo more
a foot, and one on a spring would need 3.5 N m/rad to hold her: so the foot is rigid and has two
flat soles, one to stand on and one for demi-pointe, which carries her when the heel is 45 degrees
up."""
SOLE_RADIUS = 0.004
"""Of the rubber studs at the soles' corners, m."""

RANGES_DEG: Mapping[str, tuple[float, float]] = MappingProxyType(
    {
        "waist_turn": (-60, 60),
        "waist_bend": (-40, 65),
        "neck_turn": (-80, 80),
        "neck_tilt": (-35, 35),
        "neck_bend": (-45, 45),
        "shoulder_raise": (-60, 185),
        "shoulder_cross": (-85, 85),
        "shoulder_turn": (-120, 110),
        "elbow_bend": (0, 125),
        "hip_turn": (-60, 100),
        "hip_cross": (-75, 75),
        "hip_raise": (-110, 130),
        "knee_bend": (-2, 130),
        "ankle_point": (-50, 75),
        "ankle_roll": (-35, 35),
    }
)
"""Least and greatest angle of each joint, degrees, without its side."""
