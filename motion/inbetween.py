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
from scipy.interpolate import CubicSpline, PchipInterpolator

from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.leg_target import LegTarget
from enpointe.models.rules.balance import centroid
from enpointe.models.target import ArmShape, ArmTarget, PoseTarget
from enpointe.motion.arm_path import ArmPath
from enpointe.motion.contacts import centre_of_mass, leg_paths
from enpointe.motion.effort import Effort
from enpointe.motion.grounding import Contact
from enpointe.motion.inflection import inflected
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
        between: The solved poses on the way.
        shares: Where on the way all the poses are, start and end included; (P,), from 0 to 1.
        steps: Whether a foot leaves the floor or comes to it on the way.
        contact: How a foot stands at a share of the way; None where it does not.
        target: What is asked at a share of the way.
    """

    start: KeyPose
    end: KeyPose
    between: tuple[KeyPose, ...]
    shares: tuple[float, ...]
    steps: bool = False
    contact: Callable[[Side, float], Contact] = lambda side, share: None
    target: Callable[[float], PoseTarget] | None = None

    @property
    def poses(self) -> tuple[KeyPose, ...]:
        """All of them, in order."""
        return (self.start, *self.between, self.end)

    def curve(self, model: mujoco.MjModel) -> Callable[[Array], Array]:
        """qpos (S, nq) as a smooth function of the share of the way (S,) in [0, 1]."""
        qpos = _continuous(np.array([pose.qpos for pose in self.poses]))
        # A foot that leaves or meets the floor turns sharply there; a cubic would swing past it.
        spline = (
            PchipInterpolator(self.shares, qpos) if self.steps else CubicSpline(self.shares, qpos)
        )

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
    com: Callable[[float], Array] | None = None,
) -> Passage:
    """Solve the poses between two key poses.

    Args:
        solver: Of the dancer.
        start: Solved.
        end: Solved.
        effort: Its space draws the path, its weight bends the wrist.
        inflect: Let the wrists trail; False for the plain path.
        com: The centre of mass (3,) at a share of a passage through the air, m.
    """
    way = _Way(solver, start, end, effort, inflect, com)
    between: list[KeyPose] = []
    guess = start.qpos
    way.plan_contacts()
    before = 0.0
    for share in way.shares[1:-1]:
        ahead = (share - before) / (1.0 - before)
        pose = solver.solve(way.at(share), _towards(guess, end.qpos, ahead))
        guess, before = pose.qpos, share
        between.append(pose)
    return Passage(start, end, tuple(between), way.shares, way.steps, way.contact, way.at)


class _Way:
    """What is asked between two key poses, at any share of the passage."""

    def __init__(
        self,
        solver: KeyPoseSolver,
        start: KeyPose,
        end: KeyPose,
        effort: Effort,
        inflect: bool,
        com: Callable[[float], Array] | None,
    ) -> None:
        self._com = com
        self._solver, self._effort, self._inflect = solver, effort, inflect
        self._start, self._end = start.target, end.target
        self._first, self._last = start, end
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
        self._legs = leg_paths(solver.model, start, end, effort)
        self._steps = com is None and any(path.steps for path in self._legs.values())
        self._yields = com is None and any(path.yields for path in self._legs.values())
        self._knots = [(0.0, start), (1.0, end)]

    @property
    def shares(self) -> tuple[float, ...]:
        """Where poses are solved; more of them where a leg is off the floor, and when it steps."""
        if self._com is not None or all(path.stays for path in self._legs.values()):
            return tuple(np.linspace(0.0, 1.0, INTERMEDIATE + 2))
        clock = next(iter(self._legs.values())).clock
        moments = [clock.share(t) for t in np.linspace(0.0, 1.0, 2 * INTERMEDIATE + 3)]
        moments += [path.leaves_at for path in self._legs.values() if path.leaves]
        moments += [path.arrives_at for path in self._legs.values() if path.arrives]
        return tuple(np.unique(np.round(moments, 6)))

    def plan_contacts(self) -> None:
        """Solve the poses at which feet leave and arrive: the ends of swings."""
        if not self.steps:
            return
        planned: dict[Side, dict[str, KeyPose]] = {side: {} for side in Side}
        for side, path in self._legs.items():
            if path.leaves:
                planned[side]["lift"] = self._contact(path.leaves_at, side, path.leaving)
            if path.arrives:
                planned[side]["touch"] = self._contact(path.arrives_at, side, path.arriving)
        self._knots.sort(key=lambda knot: knot[0])
        for side, path in self._legs.items():
            knots = tuple(self._knots) if self._yields else ()
            self._legs[side] = replace(
                path,
                lift=planned[side].get("lift"),
                touch=planned[side].get("touch"),
                knots=knots,
            )

    def _contact(self, share: float, side: Side, standing: Callable[[float], LegTarget]) -> KeyPose:
        """The pose at the moment a foot leaves or arrives: still or already in its place.

        It is far from both key poses, and the nearest solution to one may be a strained one; the
        least strained is taken.
        """
        target = self.at(share)
        target = replace(target, legs={**target.legs, side: standing(share)})
        ends = self._first.qpos, self._last.qpos
        midway = _towards(*ends, share)
        poses = [self._solver.solve(target, guess) for guess in (*ends, midway)]
        pose = min(poses, key=_strain)
        self._knots.append((share, pose))
        return pose

    @property
    def steps(self) -> bool:
        """Whether a foot leaves the floor or comes to it while another stays."""
        return self._com is None and any(p.leaves or p.arrives for p in self._legs.values())

    def contact(self, side: Side, share: float) -> Contact:
        """How a foot stands at a share of the way; None where it does not, or in the air."""
        return None if self._com is not None else self._legs[side].contact(share)

    def at(self, share: float) -> PoseTarget:
        start, end = self._start, self._end

        def blend(a: Array, b: Array) -> Array:
            return (1 - share) * a + share * b

        target = replace(
            start,
            arms={
                side: _inflected(path, path.at_share(share), self._effort.weight)
                if self._inflect
                else path.target(path.at_share(share))
                for side, path in self._arms.items()
            },
            legs={
                side: path.at(share, aloft=self._com is not None)
                for side, path in self._legs.items()
            },
            head=blend(start.head, end.head),
            body=blend(start.body, end.body),
            pelvis=blend(start.pelvis, end.pelvis),
            facing=(1 - share) * start.facing + share * end.facing,
            com=None,
            name=f"{start.name} to {end.name}, {share:.0%}",
        )
        if self._com is not None:
            return replace(target, com=self._com(share))
        if self._steps:
            return replace(target, com=self._passing_weight(share))
        return replace(target, weight=self._weight(share))

    def _passing_weight(self, share: float) -> Array:
        """The centre of mass on its way from knot to knot, (3,), m."""
        knots = sorted(self._knots, key=lambda knot: knot[0])
        places = [centre_of_mass(self._solver.model, pose.qpos) for _, pose in knots]
        shares = [at for at, _ in knots]
        return np.array([np.interp(share, shares, axis) for axis in np.array(places).T])

    def _weight(self, share: float) -> Array | None:
        """Where the weight is: over the feet that stay, before others leave and after they come."""
        if len(self._start.support) == 0 or len(self._end.support) == 0:
            return None
        paths = self._legs.values()
        low = max([path.arrives_at for path in paths if path.arrives], default=0.0)
        high = min([path.leaves_at for path in paths if path.leaves], default=1.0)
        moved = float(np.clip((share - low) / (high - low), 0.0, 1.0))
        first, last = centroid(self._start.support), centroid(self._end.support)
        return np.asarray((1 - moved) * first + moved * last)


def _towards(qpos: Array, end: Array, share: float) -> Array:
    """A guess on the way to another configuration, (nq,)."""
    guess = np.asarray((1 - share) * qpos + share * end)
    if qpos[3:7] @ end[3:7] < 0.0:
        guess[3:7] = (1 - share) * qpos[3:7] - share * end[3:7]
    guess[3:7] /= np.linalg.norm(guess[3:7])
    return guess


def _strain(pose: KeyPose) -> tuple[bool, float]:
    """Whether a pose breaks a rule that it must keep, and how far it is from what it prefers."""
    wishes = [r for r in pose.certificate.results if not r.must]
    return not pose.certificate.legal, sum((r.value / r.bound) ** 2 for r in wishes)


def _as_solved(model: mujoco.MjModel, pose: KeyPose, side: Side) -> ArmTarget:
    """An arm with the forearm as the solver turned it: a straight arm leaves that to the palm."""
    turn = float(pose.qpos[model.joint(f"{side}_forearm_turn").qposadr[0]])
    return replace(pose.target.arms[side], forearm_turn=turn)


def _inflected(path: ArmPath, k: float, weight: float) -> ArmTarget:
    arm = path.target(k)
    if path.waits or arm.shape is ArmShape.STRAIGHT:
        return arm
    bend, cross = inflected(arm, path.side, path.heading(k), k, weight)
    return replace(arm, wrist_bend=bend, wrist_cross=cross)


def _continuous(qpos: Array) -> Array:
    """Flip quaternions onto one hemisphere, so that a spline does not pass through zero."""
    out = qpos.copy()
    for i in range(1, len(out)):
        if out[i, 3:7] @ out[i - 1, 3:7] < 0:
            out[i, 3:7] *= -1
    return out
