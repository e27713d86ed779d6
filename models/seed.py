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

from enpointe.models.rules.balance import centroid
from enpointe.models.rules.stance import turn_tilt_bend
from enpointe.models.target import ArmShape, LegTarget, PoseTarget
from enpointe.notation import Side

__all__ = ["SEED_STEPS", "differential_ik"]

SEED_STEPS = 40
_DT = 0.1
"""Nominal step of the differential IK, s: with unit gains each step closes most of the error."""


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
    """Standing, with the angles that the target gives outright; limbs off their singular line."""
    qpos = np.array(model.key("standing").qpos)
    angles = {
        **{f"neck_{h}": v for h, v in zip(_HINGES, target.head, strict=True)},
        **{f"waist_{h}": v for h, v in zip(_HINGES, target.body, strict=True)},
    }
    for side in Side:
        arm, leg = target.arms[side], target.legs[side]
        angles |= {
            f"{side}_elbow_bend": 0.05 if arm.shape is ArmShape.STRAIGHT else 0.5,
            f"{side}_shoulder_raise": 0.4,
            f"{side}_forearm_turn": arm.forearm_turn,
            f"{side}_wrist_bend": arm.wrist_bend,
            f"{side}_wrist_cross": arm.wrist_cross,
            f"{side}_hip_turn": min(leg.turnout, 0.85),
            f"{side}_knee_bend": 0.02 if leg.knee is None else 1.0,
        }
    for name, angle in angles.items():
        qpos[model.joint(name).qposadr[0]] = angle
    return qpos


_HINGES = ("turn", "tilt", "bend")


def ik_tasks(model: mujoco.MjModel, target: PoseTarget) -> list[mink.Task]:
    """The target as mink tasks: feet, wrists and elbows, pelvis, centre of mass, posture."""
    posture = mink.PostureTask(model, cost=_posture_cost(model))
    posture.set_target(starting_pose(model, target))
    com = mink.ComTask(cost=[2.0, 2.0, 0.0])
    com.set_target(np.array([*centroid(target.support), 0.9]))
    pelvis = mink.FrameTask("pelvis", "body", position_cost=0.0, orientation_cost=0.5)
    pelvis.set_target(mink.SE3.from_rotation(mink.SO3.from_matrix(turn_tilt_bend(target.pelvis))))
    tasks: list[mink.Task] = [posture, com, pelvis]
    for side in Side:
        arm = target.arms[side]
        tasks.append(_point_task(f"{side}_wrist", "torso", arm.wrist, 10.0))
        tasks.append(_point_task(f"{side}_elbow", "torso", arm.elbow, 5.0))
        tasks += _leg_tasks(target.legs[side], side, _ankle_height(model))
    return tasks


def _leg_tasks(leg: LegTarget, side: Side, ankle_height: float) -> list[mink.Task]:
    tasks: list[mink.Task] = []
    if leg.footprint is not None:
        foot = mink.FrameTask(f"{side}_foot", "body", position_cost=10.0, orientation_cost=5.0)
        rotation = mink.SO3.from_z_radians(leg.footprint.direction)
        place = np.array([*leg.footprint.ankle, ankle_height])
        foot.set_target(mink.SE3.from_rotation_and_translation(rotation, place))
        tasks.append(foot)
    if leg.ankle is not None:
        tasks.append(_point_task(f"{side}_ankle", "pelvis", leg.ankle, 10.0))
    if leg.knee is not None:
        tasks.append(_point_task(f"{side}_knee", "pelvis", leg.knee, 3.0))
    return tasks


def _point_task(
    site: str, frame: str, point: NDArray[np.float64], cost: float
) -> mink.RelativeFrameTask:
    task = mink.RelativeFrameTask(
        site, "site", frame, "body", position_cost=cost, orientation_cost=0.0
    )
    task.set_target(mink.SE3.from_translation(point))
    return task


def _ankle_height(model: mujoco.MjModel) -> float:
    return -float(model.site("left_heel").pos[2])


@lru_cache(maxsize=4)
def _posture_cost(model: mujoco.MjModel) -> NDArray[np.float64]:
    """Spine and forearm know their angles from the score; the rest is free to move."""
    cost = np.full(model.nv, 1e-2)
    stiff = ("neck", "waist", "forearm", "wrist", "toe")
    for j in range(1, model.njnt):
        name = model.joint(j).name
        if any(part in name for part in stiff):
            cost[model.jnt_dofadr[j]] = 1.0
        elif "knee" in name:
            cost[model.jnt_dofadr[j]] = 0.1
    cost.setflags(write=False)
    return cost
