"""The poses a dance goes through: the key poses of the score, and what a jump needs besides.

A jump is written by its landing frame, with the moments of take-off and landing (`Jump`). Between
the frame before and the flight stands the take-off pose: legs pushed straight, on the balls of the
feet that bear. Between the flight and the landing frame stands the moment of touch: feet reaching
for the floor, knees giving. In between the centre of mass keeps to its parabola,

    c(t) = c0 + (c1 - c0) t / T + g t (t - T) / 2 * (0, 0, 1),   g = -9.81 m/s^2.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from math import radians

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ScoreError
from enpointe.models.keypose import KeyPose, KeyPoseSolver
from enpointe.models.leg_target import LegTarget, Standing
from enpointe.models.target import PoseTarget
from enpointe.motion.arm_path import ArmPath
from enpointe.motion.gravity import GRAVITY
from enpointe.notation import Jump, ResolvedFrame, Score, Side

__all__ = ["Law", "Parabola", "Station", "build_stations"]

Array = NDArray[np.float64]
PUSH_RISE_DEG = 60.0
"""How far the foot is raised when it leaves the floor: all but fully stretched."""
TOUCH_RISE_DEG, TOUCH_KNEE_DEG = 45.0, 18.0
"""Foot and knee at the moment of touch: toe, ball, heel, with the knee already giving."""
TURN_ON_THE_FLOOR = (0.15, 0.9)
"""Shares of a turn that are done at take-off and at landing: most of it is in the air."""


class Law(Enum):
    """How the way to a station is timed."""

    EFFORT = "effort"
    """By the logistic of the effort."""
    PUSH = "push"
    """From rest, ever faster: share = phase^2."""
    FLIGHT = "flight"
    """Evenly: gravity does the timing."""
    GIVE = "give"
    """From the speed of landing to rest: share = 1 - (1 - phase)^2."""

    def share(self, phase: Array, effort: Callable[[Array], Array]) -> Array:
        """Share of the way at shares of the time, both in [0, 1]."""
        if self is Law.PUSH:
            return np.asarray(phase**2)
        if self is Law.FLIGHT:
            return phase
        if self is Law.GIVE:
            return np.asarray(1.0 - (1.0 - phase) ** 2)
        return effort(phase)


@dataclass(frozen=True)
class Parabola:
    """The flight of a centre of mass.

    Attributes:
        start: (3,), m, at take-off.
        end: (3,), m, at landing.
        seconds: In the air.
    """

    start: Array
    end: Array
    seconds: float

    def at(self, share: float) -> Array:
        """The centre of mass (3,) at a share of the flight, m."""
        t = share * self.seconds
        fall = 0.5 * GRAVITY * t * (t - self.seconds)
        place = (1 - share) * self.start + share * self.end
        return np.asarray(place - [0.0, 0.0, fall])


@dataclass(frozen=True)
class Station:
    """A pose at its moment.

    Attributes:
        time: s from the first beat.
        pose: Solved.
        frame: Index of the score's frame; None for a take-off or a touch.
        law: How the way here from the station before is timed.
        flight: The parabola that leads here, for a station reached through the air.
        span: Shares of that parabola at the station before and here.
    """

    time: float
    pose: KeyPose
    frame: int | None
    law: Law = Law.EFFORT
    flight: Parabola | None = None
    span: tuple[float, float] = (0.0, 1.0)


def build_stations(
    score: Score,
    frames: Sequence[ResolvedFrame],
    targets: Sequence[PoseTarget],
    solver: KeyPoseSolver,
    tempo: float | None,
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Station, ...]:
    """Solve all that a score goes through.

    Args:
        score: With its repeats unrolled.
        frames: Its resolved frames.
        targets: Their targets.
        solver: Of the dancer.
        tempo: Pulses a minute; the score's own if None.
        progress: Called with (done, all).

    Raises:
        ScoreError: A frame in the air that no jump leads through, or a jump out of its frames.
    """
    builder = _Builder(score, frames, targets, solver, tempo)
    landing_of = _landings(score, frames, targets)
    for i, frame in enumerate(frames):
        if frame.jump is not None:
            builder.land(i, [aloft for aloft, landing in landing_of.items() if landing == i])
        elif i not in landing_of:
            builder.stand(i)
        if progress is not None:
            progress(i + 1, len(frames))
    return tuple(builder.stations)


def _landings(
    score: Score, frames: Sequence[ResolvedFrame], targets: Sequence[PoseTarget]
) -> dict[int, int]:
    """The landing frame of each frame in the air, by index."""
    landing: dict[int, int] = {}
    for i, target in enumerate(targets):
        if len(target.support):
            continue
        after = next((j for j in range(i + 1, len(targets)) if len(targets[j].support)), None)
        if i == 0 or after is None or frames[after].jump is None:
            at = frames[i].at
            raise ScoreError(
                "this frame is in the air, and no jump leads through it; write 'jump: off ..., "
                "on ...' in the frame that it lands in",
                at.line,
                at.column,
                score.source,
            )
        landing[i] = after
    return landing


class _Builder:
    def __init__(
        self,
        score: Score,
        frames: Sequence[ResolvedFrame],
        targets: Sequence[PoseTarget],
        solver: KeyPoseSolver,
        tempo: float | None,
    ) -> None:
        self._score, self._frames, self._targets = score, frames, targets
        self._solver, self._tempo = solver, tempo
        self.stations: list[Station] = []

    def stand(self, i: int) -> None:
        """A frame with its feet on the floor, reached on the floor."""
        pose = self._solver.solve(self._targets[i])
        self.stations.append(Station(self._seconds(self._frames[i].beat), pose, i))

    def land(self, i: int, aloft: list[int]) -> None:
        """A frame reached through the air, past the frames `aloft`."""
        jump = self._frames[i].jump
        assert jump is not None
        before = self.stations[-1]
        off, on = self._seconds(jump.off), self._seconds(jump.on)
        arrival = self._seconds(self._frames[i].beat)
        self._check(jump, before.time, off, on, arrival, i)
        end = self._targets[i]
        if off <= before.time + 1e-9 and not _stretched(before.pose.target):
            off = before.time + PUSH_SHARE * (on - before.time)
        touch = self._passing(before.pose.target, end, before.time, arrival, on, 1)
        landing = self._solver.solve(touch)
        take_off = before.pose
        if off > before.time + 1e-9:
            push = self._passing(before.pose.target, end, before.time, arrival, off, 0)
            take_off = self._solver.solve(push)
            self.stations.append(Station(off, take_off, None, Law.PUSH))
        flight = Parabola(self._com(take_off), self._com(landing), on - off)
        share = 0.0
        for j in aloft:
            moment = self._seconds(self._frames[j].beat)
            reached = float(np.clip((moment - off) / (on - off), 0.02, 0.98))
            target = replace(self._targets[j], com=flight.at(reached))
            pose = self._solver.solve(target)
            self.stations.append(Station(moment, pose, j, Law.FLIGHT, flight, (share, reached)))
            share = reached
        self.stations.append(Station(on, landing, None, Law.FLIGHT, flight, (share, 1.0)))
        if arrival > on:
            pose = self._solver.solve(end)
            self.stations.append(Station(arrival, pose, i, Law.GIVE))
        else:
            self.stations[-1] = replace(self.stations[-1], frame=i)

    def _passing(
        self,
        start: PoseTarget,
        end: PoseTarget,
        begin: float,
        arrive: float,
        moment: float,
        which: int,
    ) -> PoseTarget:
        """The take-off (0) from `start` or the touch (1) of `end`, arms and head on their way."""
        share = float(np.clip((moment - begin) / max(arrive - begin, 1e-6), 0.0, 1.0))
        arms = {}
        for side in Side:
            path = ArmPath(self._solver.figure, side, start.arms[side], end.arms[side], 1.0)
            arms[side] = path.target(path.at_share(share))
        base = start if which == 0 else end
        turn = TURN_ON_THE_FLOOR[which]
        return replace(
            base,
            arms=arms,
            legs={side: _springing(leg, which) for side, leg in base.legs.items()},
            head=(1 - share) * start.head + share * end.head,
            body=(1 - share) * start.body + share * end.body,
            facing=(1 - turn) * start.facing + turn * end.facing,
            name=f"{base.name}, {'take-off' if which == 0 else 'touch'}",
        )

    def _com(self, pose: KeyPose) -> Array:
        data = mujoco.MjData(self._solver.model)
        data.qpos[:] = pose.qpos
        mujoco.mj_kinematics(self._solver.model, data)
        mujoco.mj_comPos(self._solver.model, data)
        return np.array(data.subtree_com[0])

    def _seconds(self, beat: Fraction) -> float:
        return self._score.seconds(beat, self._tempo)

    def _check(
        self, jump: Jump, before: float, off: float, on: float, arrival: float, i: int
    ) -> None:
        if before <= off + 1e-9 and off < on <= arrival + 1e-9:
            return
        at = jump.at or self._frames[i].at
        raise ScoreError(
            "a jump takes off no sooner than the last frame on the floor and lands by its own",
            at.line,
            at.column,
            self._score.source,
        )


def _stretched(target: PoseTarget) -> bool:
    """Whether the legs that bear weight are straight, so that the pose can be a take-off."""
    return all(leg.knee_bend == 0.0 for leg in target.legs.values() if isinstance(leg, Standing))


PUSH_SHARE = 0.3
"""Where a score takes off from a plie at the very moment of its frame, the push takes this share of
the time to the landing."""


def _springing(leg: LegTarget, which: int) -> LegTarget:
    if not isinstance(leg, Standing):
        return leg
    if which == 0:
        return Standing(leg.footprint, radians(PUSH_RISE_DEG), 0.0)
    return Standing(leg.footprint, radians(TOUCH_RISE_DEG), radians(TOUCH_KNEE_DEG))
