"""Our positions beside those that Microsoft Prepose wrote for a depth camera, angle by angle.

Prepose (MIT licence) describes Cecchetti positions after Grant as rotations of arm and leg bones
seen from the front: a bone points down or up and is rotated out to its own side or in. The numbers
here are those of its `ballet.app`; tests compare them with that file where it is at hand.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees

import mujoco

from enpointe.models import KeyPoseSolver, dancer_model, pose_target
from enpointe.notation import Side
from enpointe.posing import vocabulary_score

__all__ = ["CLAIMS", "Claim", "measured"]

BONES = {
    "upper arm": ("shoulder", "elbow"),
    "forearm": ("elbow", "wrist"),
    "arm": ("shoulder", "wrist"),
    "leg": ("hip", "ankle"),
}


@dataclass(frozen=True)
class Claim:
    """One angle of Prepose's.

    Attributes:
        gesture: Its name there.
        pose: The part of the gesture that says it.
        position: Ours.
        side: Whose limb of ours, the right leading.
        bone: One of `BONES`.
        degrees: From straight down, or from straight up; + out to its own side, - in.
        up: Whether it is counted from straight up.
    """

    gesture: str
    pose: str
    position: str
    side: Side
    bone: str
    degrees: float
    up: bool = False


_L, _R = Side.LEFT, Side.RIGHT
CLAIMS = (
    Claim("first-position", "low-arc-arms", "arms first", _R, "upper arm", 15),
    Claim("first-position", "low-arc-arms", "arms first", _R, "forearm", -5),
    Claim("second-position", "high-arc-arms", "arms à la seconde", _R, "arm", 70),
    Claim("second-position", "open-legs-frontal-plane", "feet second", _R, "leg", 10),
    Claim("third-position", "mid-arc-arms-to-right", "arms third", _L, "upper arm", 30),
    Claim("third-position", "mid-arc-arms-to-right", "arms third", _L, "forearm", 20),
    Claim("third-position", "mid-arc-arms-to-right", "arms third", _R, "upper arm", 10),
    Claim("third-position", "mid-arc-arms-to-right", "arms third", _R, "forearm", -10),
    Claim(
        "fourth-position-en-avant", "high-arc-arms-to-right", "arms fourth en avant", _L, "arm", 70
    ),
    Claim(
        "fourth-position-en-avant",
        "high-arc-arms-to-right",
        "arms fourth en avant",
        _R,
        "upper arm",
        20,
    ),
    Claim(
        "fourth-position-en-avant",
        "high-arc-arms-to-right",
        "arms fourth en avant",
        _R,
        "forearm",
        -25,
    ),
    Claim(
        "fourth-position-en-haunt",
        "high-arc-arms-to-right-and-up",
        "arms fourth en haut",
        _L,
        "arm",
        70,
    ),
    Claim(
        "fourth-position-en-haunt",
        "high-arc-arms-to-right-and-up",
        "arms fourth en haut",
        _R,
        "upper arm",
        15,
        up=True,
    ),
    Claim(
        "fourth-position-en-haunt",
        "high-arc-arms-to-right-and-up",
        "arms fourth en haut",
        _R,
        "forearm",
        -5,
        up=True,
    ),
    Claim("fifth-position-en-avant", "inner-arc-arms", "arms fifth en avant", _R, "upper arm", 20),
    Claim("fifth-position-en-avant", "inner-arc-arms", "arms fifth en avant", _R, "forearm", -25),
    Claim(
        "fifth-position-en-haunt", "arc-arms-up", "arms fifth en haut", _R, "upper arm", 15, up=True
    ),
    Claim(
        "fifth-position-en-haunt", "arc-arms-up", "arms fifth en haut", _R, "forearm", -5, up=True
    ),
    Claim("a-la-seconde", "seconde-legs", "pose à la seconde", _R, "leg", 20),
)


def measured(claims: tuple[Claim, ...] = CLAIMS) -> list[float]:
    """The same angles of our perfect dancer, degrees, seen from the front of her pelvis."""
    solver = KeyPoseSolver(dancer_model())
    data = mujoco.MjData(solver.model)
    solved: dict[str, object] = {}
    angles = []
    for claim in claims:
        if claim.position not in solved:
            score = vocabulary_score(claim.position)
            assert score is not None
            target = pose_target(score.resolved()[0], solver.figure)
            solved[claim.position] = solver.solve(target).qpos
        data.qpos[:] = solved[claim.position]
        mujoco.mj_kinematics(solver.model, data)
        start, end = (data.site(f"{claim.side}_{point}").xpos for point in BONES[claim.bone])
        _, left, up = data.body("pelvis").xmat.reshape(3, 3).T @ (end - start)
        out = left if claim.side is Side.LEFT else -left
        angles.append(degrees(atan2(out, up if claim.up else -up)))
    return angles
