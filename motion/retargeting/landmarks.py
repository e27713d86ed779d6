"""The points of a body that a movement is carried over by, and the segments between them."""

from __future__ import annotations

from enpointe.models.anatomy import SIDES

__all__ = ["FRAMES", "LANDMARKS", "NEEDED", "SEGMENTS", "sided"]


def sided(*names: str) -> tuple[str, ...]:
    """Each name on both sides, "left_knee" and so on."""
    return tuple(f"{side}_{name}" for side in SIDES for name in names)


_LEG = ("hip", "knee", "ankle", "toe")
LANDMARKS = (
    "pelvis",
    "chest",
    "neck",
    "head",
    *sided(*_LEG, "heel", "toe_tip", "front_hip", "back_hip"),
    *sided("shoulder", "elbow", "wrist", "hand"),
    "chest_front",
    "chest_back",
    "sternum",
    "back",
    "sacrum",
    *sided("front_head", "back_head"),
)
"""All of them. "toe" is the joint between foot and toes; "front_hip" and "back_hip" are the iliac
spines, and the last two lines the trunk's and the head's own markers, from which marker sets get
what a skeleton has as rotations."""
NEEDED = sided(*_LEG)
"""Without these nothing is retargeted; hips may come from the iliac spines."""
FRAMES = ("pelvis", "torso", "head", *sided("foot"))
"""Parts whose whole rotation is carried over, named by the joint of a skeleton that turns them."""
SEGMENTS = {
    **{f"{side}_thigh": (f"{side}_hip", f"{side}_knee") for side in SIDES},
    **{f"{side}_shank": (f"{side}_knee", f"{side}_ankle") for side in SIDES},
    **{f"{side}_upper_arm": (f"{side}_shoulder", f"{side}_elbow") for side in SIDES},
    **{f"{side}_forearm": (f"{side}_elbow", f"{side}_wrist") for side in SIDES},
    **{f"{side}_hand": (f"{side}_wrist", f"{side}_hand") for side in SIDES},
}
"""Parts of which the direction is carried over, from landmark to landmark."""
