"""What a real dancer lends to a position that her hips alone do not give: the cheats, by name."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.certificate import Cheat
from enpointe.models.leg_target import OnPointe, Passing, Standing
from enpointe.models.target import PoseTarget, turn_tilt_bend
from enpointe.notation import Side

__all__ = ["cheats_of"]

LEAST_DEG = 3.0
"""What nobody sees and every rule lets pass, degrees."""


def cheats_of(
    model: mujoco.MjModel, qpos: NDArray[np.float64], target: PoseTarget
) -> tuple[Cheat, ...]:
    """How a pose departs from the square hips and full turnout of the perfect dancer.

    Neagle 2005 §4.8: real dancers "make compensations known in the ballet world as 'cheats'", such
    as hips twisted for a leg behind. Measured are the rotation vectors of pelvis and torso from
    where the score has them, the turnout that a working leg lacks and what a standing foot is
    turned out farther than its shin.

    Args:
        model: The dancer.
        qpos: A configuration (nq,).
        target: What was asked.

    Returns:
        Those of at least `LEAST_DEG`, greatest first; all amounts in degrees and positive.
    """
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_kinematics(model, data)
    pelvis, torso = (_rotation(data, body) for body in ("pelvis", "torso"))
    written = Rotation.from_matrix(target.upright)
    body = written * Rotation.from_matrix(turn_tilt_bend(target.body))
    found = [
        *_lent("pelvis", written.inv() * pelvis, _working_side(target)),
        *_lent("back", body.inv() * torso, None),
    ]
    for side, leg in target.legs.items():
        if isinstance(leg, Standing | OnPointe):
            turn = float(data.joint(f"{side}_ankle_turn").qpos[0])
            found.append(_cheat(f"{side} foot turned out past the shin", turn))
        elif not isinstance(leg, Passing):
            twist = _outward_twist(pelvis.inv() * _rotation(data, f"{side}_thigh"), side)
            found.append(_cheat(f"{side} leg turned out less", leg.turnout - twist))
    return tuple(sorted((c for c in found if c.value >= LEAST_DEG), key=lambda c: -c.value))


def _lent(part: str, rotation: Rotation, working: Side | None) -> list[Cheat]:
    leaning, tipping, turning = rotation.as_rotvec()
    to_the_left = working is not Side.RIGHT
    opening = turning if to_the_left else -turning
    turned = {True: "opened to the working leg", False: "turned from the working leg"}
    names = turned if working is not None else {True: "turned left", False: "turned right"}
    return [
        _cheat(f"{part} tipped {'forward' if tipping > 0 else 'back'}", abs(tipping)),
        _cheat(f"{part} leaning {'right' if leaning > 0 else 'left'}", abs(leaning)),
        _cheat(f"{part} {names[opening > 0]}", abs(opening)),
    ]


def _working_side(target: PoseTarget) -> Side | None:
    working = [
        side for side, leg in target.legs.items() if not isinstance(leg, Standing | OnPointe)
    ]
    return working[0] if len(working) == 1 else None


def _outward_twist(rotation: Rotation, side: Side) -> float:
    """Twist about the limb once the shortest swing is taken away, + outwards, rad."""
    _, _, z, w = rotation.as_quat()
    twist = (2 * np.arctan2(z, w) + np.pi) % (2 * np.pi) - np.pi
    return float(twist if side is Side.LEFT else -twist)


def _rotation(data: mujoco.MjData, body: str) -> Rotation:
    return Rotation.from_matrix(data.body(body).xmat.reshape(3, 3))


def _cheat(name: str, radians: float) -> Cheat:
    return Cheat(name, float(np.degrees(radians)), "deg")
