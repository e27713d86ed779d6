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
from enpointe.models.rules.balance import centroid
from enpointe.models.target import ALOFT, ArmShape, ArmTarget, PoseTarget
from enpointe.motion.arm_path import ArmPath
from enpointe.motion.effort import Effort
from enpointe.motion.inflection import inflected
from enpointe.motion.leg_path import WEIGHT_SHIFT, LegPath
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

    Args:
        solver: Of the dancer.
        start: Solved.
        end: Solved.
        effort: Its space draws the path, its weight bends the wrist.
        inflect: Let the wrists trail; False for the plain path.
    """
    way = _Way(solver, start, end, effort, inflect)
    between: list[KeyPose] = []
    guess = start.qpos
    count = way.intermediate
    for step in range(1, count + 1):
        ahead = np.array([1.0 / (count + 2 - step)])
        guess = slerp_poses(solver.model, guess, end.qpos, ahead)[0]
        pose = solver.solve(way.at(step / (count + 1)), guess)
        guess = pose.qpos
        between.append(pose)
    return Passage(start, end, tuple(between))


class _Way:
    """What is asked between two key poses, at any share of the passage."""

    def __init__(
        self,
        solver: KeyPoseSolver,
        start: KeyPose,
        end: KeyPose,
        effort: Effort,
        inflect: bool,
    ) -> None:
        self._solver, self._effort, self._inflect = solver, effort, inflect
        self._start, self._end = start.target, end.target
        self._arms = {
            side: ArmPath(
                solver.figure,
                side,
                _as_solved(solver.model, start, side),
                _as_solved(solver.model, end, side),
                effort.space,
            )
            for side in Side
        }
        self._legs = {side: LegPath(solver.model, side, start, end) for side in Side}

    @property
    def intermediate(self) -> int:
        """Poses to solve on the way; a foot that leaves the floor or comes to it needs more."""
        steps = any(path.leaves or path.arrives for path in self._legs.values())
        return 2 * INTERMEDIATE + 1 if steps else INTERMEDIATE

    def at(self, share: float) -> PoseTarget:
        start, end = self._start, self._end

        def blend(a: Array, b: Array) -> Array:
            return (1 - share) * a + share * b

        target = replace(
            start,
            arms={
                side: _arm_at(path, path.at_share(share), self._effort, self._solver, self._inflect)
                for side, path in self._arms.items()
            },
            legs={side: path.at(share) for side, path in self._legs.items()},
            head=blend(start.head, end.head),
            body=blend(start.body, end.body),
            pelvis=blend(start.pelvis, end.pelvis),
            facing=(1 - share) * start.facing + share * end.facing,
            com=None,
            name=f"{start.name} to {end.name}, {share:.0%}",
        )
        return replace(target, **self._balance(target, share))

    def _balance(self, target: PoseTarget, share: float) -> dict[str, Array]:
        """Where the weight is: over the feet that stay, before others leave and after they come."""
        if len(target.support) == 0:
            return {"com": _between_coms(self._start, self._end, share)}
        if len(self._start.support) == 0 or len(self._end.support) == 0:
            return {}
        leaving = any(path.leaves for path in self._legs.values())
        arriving = any(path.arrives for path in self._legs.values())
        low = 0.0 if leaving or not arriving else 1.0 - WEIGHT_SHIFT
        high = 1.0 if arriving or not leaving else WEIGHT_SHIFT
        moved = float(np.clip((share - low) / (high - low), 0.0, 1.0))
        first, last = centroid(self._start.support), centroid(self._end.support)
        return {"weight": (1 - moved) * first + moved * last}


def _between_coms(start: PoseTarget, end: PoseTarget, share: float) -> Array:
    """A first guess for the air, until a jump's parabola says better: straight from pose to pose."""
    ends = [
        pose.com
        if pose.com is not None
        else np.array([*centroid(pose.support), ALOFT * pose.figure.lines[-1]])
        for pose in (start, end)
    ]
    return np.asarray((1 - share) * ends[0] + share * ends[1])


def _as_solved(model: mujoco.MjModel, pose: KeyPose, side: Side) -> ArmTarget:
    """An arm with the forearm as the solver turned it: a straight arm leaves that to the palm."""
    turn = float(pose.qpos[model.joint(f"{side}_forearm_turn").qposadr[0]])
    return replace(pose.target.arms[side], forearm_turn=turn)


def _arm_at(
    path: ArmPath, k: float, effort: Effort, solver: KeyPoseSolver, inflect: bool
) -> ArmTarget:
    wrist = path.wrist(k)
    blend = {
        name: (1 - k) * getattr(path.start, name) + k * getattr(path.end, name)
        for name in ("wrist_bend", "wrist_cross", "forearm_turn")
    }
    shape = path.shape
    if shape is ArmShape.WRITTEN:
        elbow = _between_elbows(path, k, solver)
    elif shape is ArmShape.ROUNDED:
        elbow = elbow_of_rounded_arm(solver.figure, path.side, wrist)
    else:
        elbow = (1 - k) * path.start.elbow + k * path.end.elbow
    arm = ArmTarget(shape, path.start.shoulder, wrist, elbow, **blend)
    if shape is ArmShape.ROUNDED:
        # An arm drawn in curves more at the elbow; a hand that curved on as well would cross over.
        at_rest = (1 - k) * path.start.elbow_bend + k * path.end.elbow_bend
        arm = replace(arm, wrist_bend=arm.wrist_bend - max(arm.elbow_bend - at_rest, 0.0))
    if not inflect or path.waits or shape is ArmShape.STRAIGHT:
        return arm
    bend, cross = inflected(arm, path.side, path.heading(k), k, effort.weight)
    return replace(arm, wrist_bend=bend, wrist_cross=cross)


def _between_elbows(path: ArmPath, k: float, solver: KeyPoseSolver) -> Array:
    """An elbow on its way to a written place, kept at its distance from the shoulder."""
    elbow = (1 - k) * path.start.elbow + k * path.end.elbow - path.start.shoulder
    return path.start.shoulder + solver.figure.upper_arm * elbow / np.linalg.norm(elbow)


def _continuous(qpos: Array) -> Array:
    """Flip quaternions onto one hemisphere, so that a spline does not pass through zero."""
    out = qpos.copy()
    for i in range(1, len(out)):
        if out[i, 3:7] @ out[i - 1, 3:7] < 0:
            out[i, 3:7] *= -1
    return out
