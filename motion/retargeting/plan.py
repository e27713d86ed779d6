"""Where every part of the body is to be: the captured directions on its own limbs, feet planted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from enpointe.models.anatomy import SIDES
from enpointe.motion.averaging import averaged
from enpointe.motion.clearance import LIFTING, lifted
from enpointe.motion.retargeting.body import BALL, HEEL, NONE, TIP, Body, Foot
from enpointe.motion.retargeting.directions import unit
from enpointe.motion.retargeting.floor import Steps
from enpointe.motion.retargeting.holding import hysteresis, ramped, runs, shifted
from enpointe.motion.retargeting.landmarks import SEGMENTS
from enpointe.motion.retargeting.source import Source

__all__ = ["FootPlan", "Plan", "make_plan"]

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
_FLAT, _RISEN = np.radians(8.0), np.radians(15.0)
"""A foot on the floor pitched by less than the first lies flat, until it is by the second."""
_TURNING, _SPINNING = np.radians(45.0), np.radians(120.0)
"""rad/s: a standing foot that turns slower than the first does not turn; that spins, above the
second."""
_ASTRAY = np.radians(20.0)
"""A standing foot's heading is held unless it turns farther than this, however slowly."""
_SETTLE = 0.1
"""s: how long a foot takes to lie as the floor has it, and to leave it."""
_CHANGE = 0.06
"""s: how long a foot takes to shift from heel to ball, or ball to tip, before it is held again."""
_FOLLOW = 0.25
"""s: the root follows what its feet are shifted by over this window."""
_BRUSH = 0.004
"""m: a foot in the air is carried so high over the floor."""


@dataclass(frozen=True)
class FootPlan:
    """One foot over time.

    Attributes:
        kind: (T,), what of it is on the floor (`floor.NONE` and so on).
        still: (T,), whether it stands there.
        flat: (T,), whether heel and ball are both down.
        ankle: (T, 3), m.
        turn: (T, 3, 3), of the foot.
        raised: (T,), how far the toes bend up against it, rad.
        place: (T, 3), of the point that is on the floor, on the sole, m.
    """

    kind: NDArray[np.int8]
    still: Mask
    flat: Mask
    ankle: Array
    turn: Array
    raised: Array
    place: Array


@dataclass(frozen=True)
class Plan:
    """What a body is asked to do.

    Attributes:
        time: (T,), s.
        pelvis: (T, 3), place of the pelvis, m.
        frames: Of pelvis, torso and head, (T, 3, 3), from upright.
        directions: Of the segments, (T, 3), unit.
        feet: By side.
        scale: Size of the body over that of the source.
    """

    time: Array
    pelvis: Array
    frames: Mapping[str, Array]
    directions: Mapping[str, Array]
    feet: Mapping[str, FootPlan]
    scale: float

    @property
    def aloft(self) -> Mask:
        """(T,), when no foot is on the floor."""
        return np.asarray(np.all([foot.kind == NONE for foot in self.feet.values()], axis=0))


def make_plan(source: Source, body: Body, steps: Mapping[str, Steps], scale: float) -> Plan:
    """Plan a movement.

    Args:
        source: Levelled.
        body: Who is to move.
        steps: What each foot does on the floor.
        scale: Size of the body over that of the source.
    """
    directions = {
        name: unit(source.points[end] - source.points[start])
        for name, (start, end) in SEGMENTS.items()
        if start in source.points and end in source.points
    }
    frames = {k: v for k, v in source.frames.items() if not k.endswith("_foot")}
    turn = frames["pelvis"]
    hips = scale * 0.5 * (source.points["left_hip"] + source.points["right_hip"])
    middle = 0.5 * (body.hip("left") + body.hip("right"))
    pelvis = hips - turn @ middle
    feet, shifts, weights = {}, [], []
    for side in SIDES:
        ankle = pelvis + turn @ body.hip(side)
        for part in ("thigh", "shank"):
            ankle = ankle + body.segments[f"{side}_{part}"][2] * directions[f"{side}_{part}"]
        feet[side], shift = _planted(ankle, steps[side], body.feet[side], source)
        shifts.append(shift)
        weights.append(ramped(steps[side].kind != NONE, 2 * _SETTLE, source.rate) + 1e-3)
    weight = np.array(weights)[:, :, None]
    followed = np.sum(weight * np.array(shifts), axis=0) / weight.sum(axis=0)
    pelvis = pelvis + averaged(followed, _FOLLOW, source.rate)
    return Plan(source.time, pelvis, frames, directions, feet, scale)


def _planted(ankle: Array, steps: Steps, foot: Foot, source: Source) -> tuple[FootPlan, Array]:
    """A foot's plan, and what it was shifted by, (T, 3), m."""
    rate = source.rate
    bears = (steps.kind == BALL) | (steps.kind == HEEL)
    laid = ramped(steps.kind != NONE, _SETTLE, rate)
    yaw, pitch, flat = _bearing(steps, bears, rate)
    turn = _blended(steps.turn, _standing_turn(yaw, pitch), laid)
    pitch = -np.arcsin(np.clip(turn[:, 2, 0], -1.0, 1.0))
    heeled, tipped = ((steps.kind == HEEL) & ~flat)[:, None], (steps.kind == TIP)[:, None]
    raised = ramped(bears, _SETTLE, rate) * np.maximum(pitch, 0.0)
    ahead = np.stack([np.cos(yaw), np.sin(yaw), np.zeros_like(yaw)], axis=1)
    ball, heel, tip = _sole(turn, raised, foot)
    # Where the ball would be if the foot were laid down about the point that it touches with.
    mark = np.where(
        tipped, tip - foot.toes * ahead, np.where(heeled, heel + foot.span * ahead, ball)
    )
    lowest = np.min([point[:, 2] for point in (ball, heel, tip)], axis=0)
    still = steps.still & ~_changing(steps.kind, rate)
    shift = np.empty_like(ankle)
    shift[:, :2] = shifted((ankle + mark)[:, :2], still)
    height = (ankle[:, 2] + lowest)[:, None]
    shift[:, 2:] = shifted(height, steps.kind != NONE, lambda low: np.zeros_like(low))
    carried = shift + _lift(height[:, 0] + shift[:, 2], steps.kind, rate)
    placed = ankle + carried
    place = placed + np.where(tipped, tip, np.where(heeled, heel, ball))
    plan = FootPlan(steps.kind, still, flat, placed, turn, raised, place)
    return plan, shift


def _bearing(steps: Steps, bears: Mask, rate: float) -> tuple[Array, Array, Mask]:
    """Heading and pitch of a foot, rad, as the floor has them; when it is flat."""
    yaw = steps.heading
    pitch = steps.pitch
    spin = np.abs(np.gradient(averaged(yaw[:, None], _SETTLE, rate)[:, 0]) * rate)
    steady = hysteresis(steps.still & (spin < _TURNING), steps.still & (spin < _SPINNING))
    for run in runs(steady):
        steady[run] &= np.abs(yaw[run] - np.median(yaw[run])) < _ASTRAY
    bears = bears & (steady | ~steps.still)
    flat = hysteresis(bears & (np.abs(pitch) < _FLAT), bears & (np.abs(pitch) < _RISEN))
    yaw = yaw + shifted(yaw[:, None], steady)[:, 0]
    pitch = pitch + shifted(pitch[:, None], flat, lambda low: np.zeros_like(low))[:, 0]
    pitch = np.where(steps.kind == BALL, np.maximum(pitch, 0.0), pitch)
    return yaw, pitch, flat


def _standing_turn(yaw: Array, pitch: Array) -> Array:
    return np.asarray(Rotation.from_euler("ZY", np.stack([yaw, pitch], axis=1)).as_matrix())


def _blended(one: Array, other: Array, share: Array) -> Array:
    """Rotations (T, 3, 3) from `one` to `other` by a share (T,) of the way."""
    start = Rotation.from_matrix(one)
    way = (start.inv() * Rotation.from_matrix(other)).as_rotvec()
    return np.asarray((start * Rotation.from_rotvec(share[:, None] * way)).as_matrix())


def _sole(turn: Array, raised: Array, foot: Foot) -> tuple[Array, Array, Array]:
    """Ball, heel and tip from the ankle, (T, 3) each, m."""
    ball, heel = turn @ foot.ball, turn @ foot.heel
    bent = Rotation.from_matrix(turn) * Rotation.from_euler("y", -raised[:, None])
    return ball, heel, ball + bent.apply([foot.toes, 0.0, 0.0])


def _changing(kind: NDArray[np.int8], rate: float) -> Mask:
    """Where a foot goes from one point of it to another without leaving the floor."""
    changes = np.flatnonzero((kind[1:] != kind[:-1]) & (kind[1:] != NONE) & (kind[:-1] != NONE))
    # A heel that comes down turns to a flat foot about the same mark.
    changes = changes[(kind[changes] == TIP) | (kind[changes + 1] == TIP)]
    moving = np.zeros(len(kind), dtype=bool)
    half = max(round(_CHANGE * rate), 1)
    for change in changes:
        moving[max(change + 1 - half, 0) : change + 1 + half] = True
    return moving


def _lift(height: Array, kind: NDArray[np.int8], rate: float) -> Array:
    """How much higher a foot is carried, (T, 3), m, so that it neither sinks nor drags."""
    free = 1.0 - ramped(kind != NONE, LIFTING, rate)
    smooth = lifted(np.maximum(_BRUSH * free - height, 0.0), rate)
    return np.outer(smooth * (kind == NONE), [0.0, 0.0, 1.0]) * np.minimum(free * 4.0, 1.0)[:, None]
