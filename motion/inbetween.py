"""Key poses and the poses between them, all solved by the same rules of ballet.

The thesis solves seven poses between two key poses, since with fewer than five the eye sees kinks
(Neagle 2005 §5.5.4). A `Passage` is such a row: at equal shares of the wrists' way, so that a
movement's timing is applied along the way afterwards.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from enpointe.models.extremities import elbow_of_rounded_arm
from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.target import ArmShape, ArmTarget, LegTarget, PoseTarget
from enpointe.motion.arm_path import ArmPath
from enpointe.motion.effort import Effort
from enpointe.motion.inflection import inflected
from enpointe.motion.slerp import slerp_poses
from enpointe.notation import Side

__all__ = ["INTERMEDIATE", "Passage", "solve_passage"]

Array = NDArray[np.float64]
INTERMEDIATE = 7
"""Poses between two key poses (Neagle 2005 §5.5.4)."""


@dataclass(frozen=True)
class Passage:
    """The way from one key pose to the next.

    Attributes:
        start: The key pose before.
        end: The next one.
        between: The solved poses on the way, at equal shares of it.
    """

    start: KeyPose
    end: KeyPose
    between: tuple[KeyPose, ...]

    @property
    def poses(self) -> tuple[KeyPose, ...]:
        """All of them, in order."""
        return (self.start, *self.between, self.end)

    def curve(self, model: mujoco.MjModel) -> Callable[[Array], Array]:
        """qpos (S, nq) as a smooth function of the share of the way (S,) in [0, 1]."""
        qpos = _continuous(np.array([pose.qpos for pose in self.poses]))
        spline = CubicSpline(np.linspace(0.0, 1.0, len(qpos)), qpos)

        def at(share: Array) -> Array:
            poses = np.asarray(spline(share))
            for row in poses:
                mujoco.mj_normalizeQuat(model, row)
            return poses

        return at


def solve_passage(
    solver: KeyPoseSolver,
    start: KeyPose,
    end: KeyPose,
    effort: Effort,
    *,
    inflect: bool = True,
) -> Passage:
    """Solve the poses between two key poses.

    Where a foot leaves or changes its place, legs and root go from pose to pose by rotation alone:
    the rules of stepping are not in this solver.

    Args:
        solver: Of the dancer.
        start: Solved.
        end: Solved.
        effort: Its space draws the path, its weight bends the wrist.
        inflect: Let the wrists trail; False for the plain path.
    """
    paths = {
        side: ArmPath(
            solver.figure, side, start.target.arms[side], end.target.arms[side], effort.space
        )
        for side in Side
    }
    legs_stay = all(_same_stance(start.target.legs[side], end.target.legs[side]) for side in Side)
    between: list[KeyPose] = []
    guess = start.qpos
    for step in range(1, INTERMEDIATE + 1):
        share = step / (INTERMEDIATE + 1)
        target = _target_at(paths, start.target, end.target, share, effort, solver, inflect)
        pose = solver.solve(target, guess)
        guess = pose.qpos
        between.append(pose if legs_stay else _with_legs(solver.model, pose, start, end, share))
    return Passage(start, end, tuple(between))


def _target_at(
    paths: dict[Side, ArmPath],
    start: PoseTarget,
    end: PoseTarget,
    share: float,
    effort: Effort,
    solver: KeyPoseSolver,
    inflect: bool,
) -> PoseTarget:
    arms = {
        side: _arm_at(path, path.at_share(share), effort, solver, inflect)
        for side, path in paths.items()
    }
    return replace(
        start,
        arms=arms,
        head=(1 - share) * start.head + share * end.head,
        body=(1 - share) * start.body + share * end.body,
        pelvis=(1 - share) * start.pelvis + share * end.pelvis,
        name=f"{start.name} to {end.name}, {share:.0%}",
    )


def _arm_at(
    path: ArmPath, k: float, effort: Effort, solver: KeyPoseSolver, inflect: bool
) -> ArmTarget:
    wrist = path.wrist(k)
    blend = {
        name: (1 - k) * getattr(path.start, name) + k * getattr(path.end, name)
        for name in ("wrist_bend", "wrist_cross", "forearm_turn")
    }
    if path.shape is ArmShape.WRITTEN:
        elbow = _between_elbows(path, k, solver)
    elif path.shape is ArmShape.ROUNDED:
        elbow = elbow_of_rounded_arm(solver.figure, path.side, wrist)
    else:
        elbow = (1 - k) * path.start.elbow + k * path.end.elbow
    arm = ArmTarget(path.shape, path.start.shoulder, wrist, elbow, **blend)
    if path.shape is ArmShape.ROUNDED:
        # An arm drawn in curves more at the elbow; a hand that curved on as well would cross over.
        at_rest = (1 - k) * path.start.elbow_bend + k * path.end.elbow_bend
        arm = replace(arm, wrist_bend=arm.wrist_bend - max(arm.elbow_bend - at_rest, 0.0))
    if not inflect or path.waits or path.shape is ArmShape.STRAIGHT:
        return arm
    bend, cross = inflected(arm, path.side, path.heading(k), k, effort.weight)
    return replace(arm, wrist_bend=bend, wrist_cross=cross)


def _between_elbows(path: ArmPath, k: float, solver: KeyPoseSolver) -> Array:
    """An elbow on its way to a written place, kept at its distance from the shoulder."""
    elbow = (1 - k) * path.start.elbow + k * path.end.elbow - path.start.shoulder
    return path.start.shoulder + solver.figure.upper_arm * elbow / np.linalg.norm(elbow)


def _same_stance(a: LegTarget, b: LegTarget) -> bool:
    if a.footprint is None or b.footprint is None or a.knee is not None or b.knee is not None:
        return False
    return (
        float(np.linalg.norm(a.footprint.ankle - b.footprint.ankle)) < 1e-9
        and abs(a.footprint.direction - b.footprint.direction) < 1e-9
    )


def _with_legs(
    model: mujoco.MjModel, pose: KeyPose, start: KeyPose, end: KeyPose, share: float
) -> KeyPose:
    turned = slerp_poses(model, start.qpos, end.qpos, np.array([share]))[0]
    qpos = pose.qpos.copy()
    for j in range(model.njnt):
        name = model.joint(j).name
        if name == "root" or any(p in name for p in ("hip", "knee", "ankle", "toe")):
            address = model.joint(j).qposadr[0]
            width = 7 if name == "root" else 1
            qpos[address : address + width] = turned[address : address + width]
    return replace(pose, qpos=qpos)


def _continuous(qpos: Array) -> Array:
    """Flip quaternions onto one hemisphere, so that a spline does not pass through zero."""
    out = qpos.copy()
    for i in range(1, len(out)):
        if out[i, 3:7] @ out[i - 1, 3:7] < 0:
            out[i, 3:7] *= -1
    return out
