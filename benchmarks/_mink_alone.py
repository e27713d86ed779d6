"""How many steps differential IK alone needs to bring feet and wrists to their places."""

from __future__ import annotations

import mink
import mujoco
import numpy as np

from enpointe.models import PoseTarget
from enpointe.models.anatomy import side_sign
from enpointe.models.leg_target import InAir, OnPointe, Standing, ToeOnFloor, ToeOnLeg
from enpointe.models.rules.legs import TOE_THICKNESS
from enpointe.models.seed import differential_ik
from enpointe.notation import Side

NEAR = 2e-3
"""What "there" means for mink alone: feet and wrists within this, m."""
MOST_STEPS = 400


def distance_left(configuration: mink.Configuration, target: PoseTarget) -> float:
    """How far the feet and wrists are from their places, the farthest of them, m."""
    data = configuration.data
    torso = data.body("torso")
    errors: list[float] = []
    for side in Side:
        wrist = data.site(f"{side}_wrist").xpos
        local = torso.xmat.reshape(3, 3).T @ (wrist - torso.xpos)
        errors.append(float(np.linalg.norm(local - target.arms[side].wrist)))
        errors.append(foot_left(configuration, target, side))
    return float(max(errors))


def foot_left(configuration: mink.Configuration, target: PoseTarget, side: Side) -> float:
    """How far one foot is from its place: the ball or tip on the floor, the ankle in the air, m."""
    data, figure, leg = configuration.data, target.figure, target.legs[side]
    tip = data.site(f"{side}_toe_tip").xpos
    if isinstance(leg, Standing):
        height = -configuration.model.site(f"{side}_toe_tip").pos[2]
        mark = [*leg.footprint.point(figure.ball_forward), height]
        return float(np.linalg.norm(data.body(f"{side}_toe").xpos - mark))
    if isinstance(leg, OnPointe):
        mark = [*leg.footprint.point(figure.ball_forward + figure.toe_length), 0.0]
        return float(np.linalg.norm(tip - mark))
    if isinstance(leg, InAir):
        ankle = data.site(f"{side}_ankle").xpos - data.site(f"{side}_hip").xpos
        return float(np.linalg.norm(target.upright.T @ ankle - leg.ankle + figure.hips[side]))
    if isinstance(leg, ToeOnLeg):
        gap = target.upright.T @ (tip - data.site(f"{side.other}_{leg.site}").xpos)
        outward = side_sign(side)
        ahead, aside, up = leg.offset
        return float(np.linalg.norm(gap - [ahead, outward * aside, up]))
    assert isinstance(leg, ToeOnFloor)
    place = target.upright.T @ (tip - data.body("pelvis").xpos)
    return float(np.hypot(tip[2] - TOE_THICKNESS, np.dot(leg.across, place[:2])))


def steps_until_near(model: mujoco.MjModel, target: PoseTarget) -> int | None:
    """Fewest steps of mink that bring feet and wrists near; None if it never does."""

    def left(steps: int) -> float:
        qpos = differential_ik(model, target, steps=steps)
        return distance_left(mink.Configuration(model, q=qpos), target)

    steps = 1
    while left(steps) > NEAR:
        steps *= 2
        if steps > MOST_STEPS:
            return None
    low, high = steps // 2, steps
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if left(middle) <= NEAR else (middle, high)
    return high
