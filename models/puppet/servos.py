"""Which servo turns which joint, in the order of the IDs on the bus."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

__all__ = ["OP3_IDS", "PUPPET_IDS", "SERVOS"]

_ARM = ("shoulder_raise", "shoulder_cross", "shoulder_turn", "elbow_bend")
_LEG = {
    "hip_turn": "XM430-W210",
    "hip_cross": "XM430-W210",
    "hip_raise": "XM430-W210",
    "knee_bend": "XM430-W350",
    "ankle_point": "XM430-W350",
    "ankle_roll": "XM430-W350",
}
_SMALL = "XC330-T288"

_PUPPET = {
    "waist_turn": "XM430-W350",
    "waist_bend": "XM430-W350",
    **dict.fromkeys(("neck_turn", "neck_tilt", "neck_bend"), _SMALL),
    **{f"{side}_{joint}": _SMALL for side in ("left", "right") for joint in _ARM},
    **{f"{side}_{joint}": servo for side in ("left", "right") for joint, servo in _LEG.items()},
}
PUPPET_IDS: Mapping[str, int] = MappingProxyType({joint: i + 1 for i, joint in enumerate(_PUPPET)})
"""ID of each joint's servo: 1 to 25, trunk, head, arms, legs, left before right."""

_OP3 = (
    *("r_sho_pitch", "l_sho_pitch", "r_sho_roll", "l_sho_roll", "r_el", "l_el"),
    *("r_hip_yaw", "l_hip_yaw", "r_hip_roll", "l_hip_roll", "r_hip_pitch", "l_hip_pitch"),
    *("r_knee", "l_knee", "r_ank_pitch", "l_ank_pitch", "r_ank_roll", "l_ank_roll"),
    *("head_pan", "head_tilt"),
)
OP3_IDS: Mapping[str, int] = MappingProxyType({joint: i + 1 for i, joint in enumerate(_OP3)})
"""IDs as ROBOTIS gives them (ROBOTIS-OP3, op3_manager/config/OP3.robot)."""

SERVOS: Mapping[str, Mapping[str, str]] = MappingProxyType(
    {
        "puppet": MappingProxyType(_PUPPET),
        "op3": MappingProxyType(dict.fromkeys(_OP3, "XM430-W350")),
    }
)
"""Model of the servo at each joint, by body. The puppet's hips have the fast gears (77 rpm), for
kicks; knees, ankles and waist the strong ones, which hold her weight; arms and head are light."""
