"""A first guess for the key-pose solver by differential inverse kinematics (mink).

Cold, an interior-point solver calls legal poses infeasible; from a few dozen small steps of
differential IK it finds them in milliseconds.
"""

from __future__ import annotations

from functools import lru_cache

import mink
import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.leg_target import InAir, OnPointe, Standing, ToeOnFloor, ToeOnLeg
from enpointe.models.rules.balance import centroid
from enpointe.models.target import ArmShape, PoseTarget, turn_tilt_bend
from enpointe.notation import Side

__all__ = ["SEED_STEPS", "differential_ik", "ik_tasks", "starting_pose"]

SEED_STEPS = 40
_DT = 0.1
"""Nominal step of the differential IK, s: with unit gains each step closes most of the error."""
_HINGES = ("turn", "tilt", "bend")


def differential_ik(
    model: mujoco.MjModel, target: PoseTarget, *, steps: int = SEED_STEPS
) -> NDArray[np.float64]:
    """Steer the standing dancer towards a target.

    Args:
        model: The dancer.
        target: The pose.
        steps: Number of velocity steps, each one QP (daqp).

    Returns:
        A configuration (nq,) near the target, inside the joint ranges.
    """
    configuration = mink.Configuration(model, q=starting_pose(model, target))
    tasks = ik_tasks(model, target)
    limits = [mink.ConfigurationLimit(model)]
    for _ in range(steps):
        velocity = mink.solve_ik(configuration, tasks, _DT, "daqp", 1e-6, limits=limits)
        configuration.integrate_inplace(velocity, _DT)
    return np.array(configuration.q)


def starting_pose(model: mujoco.MjModel, target: PoseTarget) -> NDArray[np.float64]:
    """Standing over the support, with the angles that the target gives outright.

    Limbs start off their singular line.
    """
    qpos = np.array(model.key("standing").qpos)
    qpos[:3] = [*_weight(target)[:2], qpos[2]]
    qpos[3:7] = [np.cos(target.facing / 2), 0, 0, np.sin(target.facing / 2)]
    angles = {
        **{f"neck_{h}": v for h, v in zip(_HINGES, target.head, strict=True)},
        **{f"waist_{h}": v for h, v in zip(_HINGES, target.body, strict=True)},
    }
    for side in Side:
        arm = target.arms[side]
        angles |= {
            f"{side}_elbow_bend": 0.05 if arm.shape is ArmShape.STRAIGHT else 0.5,
            f"{side}_shoulder_raise": 0.4,
            f"{side}_forearm_turn": arm.forearm_turn,
            f"{side}_wrist_bend": arm.wrist_bend,
            f"{side}_wrist_cross": arm.wrist_cross,
            **{f"{side}_{j}": v for j, v in _leg_angles(target, side).items()},
        }
    for name, angle in angles.items():
        low, high = model.joint(name).range
        qpos[model.joint(name).qposadr[0]] = np.clip(angle, low, high)
    return qpos


def _leg_angles(target: PoseTarget, side: Side) -> dict[str, float]:
    leg = target.legs[side]
    if isinstance(leg, Standing):
        bend = leg.knee_bend
        return {
            "hip_turn": 0.85,
            "hip_raise": 0.5 * bend,
            "knee_bend": max(bend, 0.02),
            "ankle_point": leg.rise - 0.5 * bend,
            "toe_raise": leg.rise,
        }
    if isinstance(leg, OnPointe):
        return {"hip_turn": 0.85, "knee_bend": 0.02, "ankle_point": 1.4, "toe_raise": -0.14}
    pointed = {"hip_turn": 0.85, "ankle_point": 1.3, "toe_raise": -0.26}
    if isinstance(leg, ToeOnFloor):
        return {**pointed, "hip_raise": 0.4 * leg.ahead, "hip_cross": 0.4 * leg.ahead - 0.3}
    if isinstance(leg, ToeOnLeg):
        return {**pointed, "hip_raise": 1.0, "hip_cross": -0.5, "knee_bend": 1.8}
    hip = target.figure.hips[side]
    knee = leg.knee if leg.knee is not None else 0.5 * (hip + leg.ankle)
    return {**pointed, **_leg_in_air(side, knee - hip, leg.ankle - knee)}


def _leg_in_air(
    side: Side, thigh: NDArray[np.float64], shank: NDArray[np.float64]
) -> dict[str, float]:
    """Hip and knee angles that point thigh and shank along two directions, in closed form.

    With the hip's swing axes a1, a2 at 45 degrees, the thigh's direction d has d . a1 = sin(cross)
    and swings about a1 by `raise`; the shank then fixes the turn about the thigh.
    """
    mirror = np.array([1.0, 1.0 if side is Side.LEFT else -1.0, 1.0])
    d, s = (mirror * v / np.linalg.norm(v) for v in (thigh, shank))
    a1, b = np.array([1.0, -1.0, 0.0]) / np.sqrt(2), np.array([1.0, 1.0, 0.0]) / np.sqrt(2)
    cross = float(np.arcsin(np.clip(d @ a1, -1.0, 1.0)))
    swing = float(np.arctan2(d @ b, -d[2]))
    turned = Rotation.from_rotvec(swing * a1) * Rotation.from_rotvec(-cross * b)
    local = turned.inv().apply(s)
    bend = float(np.arccos(np.clip(-local[2], -1.0, 1.0)))
    turn = float(np.arctan2(-local[1], -local[0])) if bend > 0.1 else 0.6
    return {"hip_raise": swing, "hip_cross": cross, "hip_turn": turn, "knee_bend": bend}


def ik_tasks(model: mujoco.MjModel, target: PoseTarget) -> list[mink.Task]:
    """The target as mink tasks: feet, wrists and elbows, pelvis, centre of mass, posture."""
    posture = mink.PostureTask(model, cost=_posture_cost(model))
    posture.set_target(starting_pose(model, target))
    com = mink.ComTask(cost=[2.0, 2.0, 0.0 if target.com is None else 2.0])
    com.set_target(_weight(target))
    pelvis = mink.FrameTask("pelvis", "body", position_cost=0.0, orientation_cost=0.5)
    pelvis.set_target(mink.SE3.from_rotation(mink.SO3.from_matrix(target.upright)))
    torso = mink.FrameTask("torso", "body", position_cost=0.0, orientation_cost=1.0)
    upper = target.upright @ turn_tilt_bend(target.body)
    torso.set_target(mink.SE3.from_rotation(mink.SO3.from_matrix(upper)))
    tasks: list[mink.Task] = [posture, com, pelvis, torso]
    for side in Side:
        arm = target.arms[side]
        tasks.append(_point_task(f"{side}_wrist", "torso", arm.wrist, 10.0))
        tasks.append(_point_task(f"{side}_elbow", "torso", arm.elbow, 5.0))
        tasks += _leg_tasks(model, target, side)
    return tasks


def _leg_tasks(model: mujoco.MjModel, target: PoseTarget, side: Side) -> list[mink.Task]:
    leg = target.legs[side]
    figure = target.figure
    if isinstance(leg, Standing):
        place = np.array([*leg.footprint.point(figure.ball_forward), _toe_height(model)])
        toe = mink.FrameTask(f"{side}_toe", "body", position_cost=10.0, orientation_cost=5.0)
        turned = mink.SO3.from_z_radians(leg.footprint.direction)
        toe.set_target(mink.SE3.from_rotation_and_translation(turned, place))
        return [toe]
    if isinstance(leg, OnPointe):
        tip = leg.footprint.point(figure.ball_forward + figure.toe_length)
        # Turned out as well as upright: on its tip alone the leg may arrive twisted about itself.
        down = mink.SO3.from_z_radians(leg.footprint.direction) @ mink.SO3.from_y_radians(np.pi / 2)
        toe = mink.FrameTask(f"{side}_toe_tip", "site", position_cost=10.0, orientation_cost=1.0)
        toe.set_target(mink.SE3.from_rotation_and_translation(down, np.array([*tip, 0.0])))
        return [toe]
    if isinstance(leg, InAir):
        tasks: list[mink.Task] = [_point_task(f"{side}_ankle", "pelvis", leg.ankle, 10.0)]
        if leg.knee is not None:
            tasks.append(_point_task(f"{side}_knee", "pelvis", leg.knee, 3.0))
        return tasks
    if isinstance(leg, ToeOnLeg):
        ahead, aside, up = leg.offset
        outward = 1.0 if side is Side.LEFT else -1.0
        root = f"{side.other}_{'shank' if leg.site == 'knee' else 'foot'}"
        place = np.array([ahead, outward * aside, up])
        return [_point_task(f"{side}_toe_tip", root, place, 5.0)]
    return [_point_task(f"{side}_toe_tip", "pelvis", _tendu_place(leg, side, figure), 5.0)]


def _tendu_place(leg: ToeOnFloor, side: Side, figure: object) -> NDArray[np.float64]:
    from enpointe.models.figure import Figure

    assert isinstance(figure, Figure)
    drop = figure.stretched_leg + figure.ankle_height
    far = 0.55 * drop
    outward = 1.0 if side is Side.LEFT else -1.0
    if leg.ahead:
        return np.array([leg.ahead * far, 0.0, -drop])
    return np.array([0.0, outward * far, -drop])


def _weight(target: PoseTarget) -> NDArray[np.float64]:
    if target.com is not None:
        return target.com
    centre = centroid(target.support) if target.weight is None else target.weight
    return np.array([*centre, 0.9])


def _point_task(
    site: str, frame: str, point: NDArray[np.float64], cost: float
) -> mink.RelativeFrameTask:
    task = mink.RelativeFrameTask(
        site, "site", frame, "body", position_cost=cost, orientation_cost=0.0
    )
    task.set_target(mink.SE3.from_translation(point))
    return task


def _toe_height(model: mujoco.MjModel) -> float:
    return -float(model.site("left_toe_tip").pos[2])


@lru_cache(maxsize=4)
def _posture_cost(model: mujoco.MjModel) -> NDArray[np.float64]:
    """Spine and forearm know their angles from the score; the rest is free to move."""
    cost = np.full(model.nv, 1e-2)
    stiff = ("neck", "forearm", "wrist", "toe")
    for j in range(1, model.njnt):
        name = model.joint(j).name
        if any(part in name for part in stiff):
            cost[model.jnt_dofadr[j]] = 1.0
        elif any(part in name for part in ("knee", "waist", "ankle")):
            cost[model.jnt_dofadr[j]] = 0.1
    cost.setflags(write=False)
    return cost
