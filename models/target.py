"""What one frame of a score asks of a body, in metres and radians."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import radians

import numpy as np
from numpy.typing import NDArray

from enpointe.models.extremities import elbow_of_rounded_arm, extremity
from enpointe.models.figure import Figure
from enpointe.models.foot_positions import support_hull
from enpointe.models.leg_target import InAir, LegTarget, OnPointe, Standing, ToeOnLeg, leg_target
from enpointe.models.stances import Ground, StanceTracker
from enpointe.models.style import Style
from enpointe.notation import ArmSigns, Orientation, ResolvedFrame, Side

__all__ = [
    "ALOFT",
    "ArmShape",
    "ArmTarget",
    "PoseTarget",
    "pose_target",
    "rounded_arm",
    "turn_tilt_bend",
]

Vector = NDArray[np.float64]


class ArmShape(StrEnum):
    """How the arm gets from shoulder to wrist."""

    ROUNDED = "rounded"
    STRAIGHT = "straight"
    WRITTEN = "written elbow"


@dataclass(frozen=True, slots=True)
class ArmTarget:
    """One arm, in the torso's frame.

    Attributes:
        shape: Rounded, straight, or through a written elbow.
        shoulder: (3,), m.
        wrist: (3,), m.
        elbow: (3,), m; where the shape puts it.
        wrist_bend: Towards the palm, rad.
        wrist_cross: Towards the thumb, rad.
        forearm_turn: Towards the upturned palm, rad; what a straight arm prefers is 0.
    """

    shape: ArmShape
    shoulder: Vector
    wrist: Vector
    elbow: Vector
    wrist_bend: float = 0.0
    wrist_cross: float = 0.0
    forearm_turn: float = 0.0

    @property
    def elbow_bend(self) -> float:
        """Bend of the elbow between its two bones, rad (eq. 4.8 from the straight arm)."""
        upper, lower = self.elbow - self.shoulder, self.wrist - self.elbow
        cosine = upper @ lower / (np.linalg.norm(upper) * np.linalg.norm(lower))
        return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


@dataclass(frozen=True, slots=True)
class PoseTarget:
    """One key pose to solve, in the world.

    Attributes:
        figure: The dancer's lengths.
        arms: By side, in the torso's frame.
        legs: By side.
        head: Turn, tilt and bend of the head against the torso, rad, in `Orientation`'s senses.
        body: The same of the torso against the pelvis as written.
        pelvis: The same of the pelvis against the upright that faces `facing`.
        facing: Where the dancer faces, from the audience, + to her left, rad.
        weight: Where the centre of mass should be, (2,), m; None is the middle of the support.
        com: Where the centre of mass is, (3,), m, in the air or on its way from foot to foot; None
            where it rests over the feet.
        real: Whether the dancer has a real dancer's range of motion.
        name: For messages.
    """

    figure: Figure
    arms: Mapping[Side, ArmTarget]
    legs: Mapping[Side, LegTarget]
    head: Vector
    body: Vector
    pelvis: Vector
    facing: float = 0.0
    weight: Vector | None = None
    com: Vector | None = None
    real: bool = False
    name: str = "pose"

    @property
    def upright(self) -> NDArray[np.float64]:
        """Rotation of the pelvis as written, in the world, (3, 3)."""
        return turn_tilt_bend(self.pelvis + np.array([self.facing, 0.0, 0.0]))

    @property
    def support(self) -> NDArray[np.float64]:
        """Hull of the soles that bear weight, counter-clockwise, (H, 2), m."""
        soles = [
            leg.soles(self.figure)
            for leg in self.legs.values()
            if isinstance(leg, Standing | OnPointe)
        ]
        return support_hull(np.vstack(soles)) if soles else np.empty((0, 2))

    @property
    def structure(self) -> tuple[object, ...]:
        """What decides which rules apply; poses of one structure share a compiled problem."""
        legs = tuple(_kind_of(self.legs[side]) for side in Side)
        arms = tuple(self.arms[side].shape for side in Side)
        return (legs, arms, self.real, self.com is not None)


def _kind_of(leg: LegTarget) -> tuple[object, ...]:
    if isinstance(leg, ToeOnLeg):
        return (ToeOnLeg, leg.site)
    if isinstance(leg, InAir):
        return (InAir, leg.knee is not None)
    if isinstance(leg, Standing):
        return (Standing, leg.knee_bend > 0, leg.yields)
    return (type(leg),)


def turn_tilt_bend(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation matrix (3, 3) of turn, tilt and bend in that order (eq. 4.9)."""
    turn, tilt, bend = angles
    ct, st = np.cos(turn), np.sin(turn)
    about_z = np.array([[ct, -st, 0], [st, ct, 0], [0, 0, 1]])
    cx, sx = np.cos(-tilt), np.sin(-tilt)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    cy, sy = np.cos(bend), np.sin(bend)
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return np.asarray(about_z @ about_x @ about_y, dtype=np.float64)


def pose_target(
    frame: ResolvedFrame,
    figure: Figure,
    style: Style | None = None,
    *,
    ground: Ground | None = None,
    source: str | None = None,
    name: str | None = None,
) -> PoseTarget:
    """Measure one frame of a score on one dancer.

    Args:
        frame: With everything filled in.
        figure: The dancer's lengths.
        style: The method's amounts.
        ground: Where the feet stand; as if this were the first frame of a score if None.
        source: Name of the score, for errors.
        name: For messages; the beat if None.

    Raises:
        ScoreError: A sign that no limb of this dancer reaches.
    """
    style = style or Style()
    ground = ground or StanceTracker(figure, style.turnout_deg).follow(frame)
    legs = {
        side: leg_target(leg, side, figure, style, ground.prints.get(side), source)
        for side, leg in frame.legs.items()
    }
    floored = any(isinstance(leg, Standing | OnPointe) for leg in legs.values())
    return PoseTarget(
        figure=figure,
        arms={side: _arm(frame.arms[side], side, figure, style, source) for side in Side},
        legs=legs,
        head=_angles(frame.head),
        body=_angles(frame.body),
        pelvis=_angles(frame.pelvis),
        facing=ground.facing,
        com=None if floored else np.array([*ground.middle, ALOFT * figure.lines[-1]]),
        real=style.real,
        name=name or f"beat {frame.beat}",
    )


ALOFT = 0.68
"""Where the centre of mass of a pose in the air is put, as a share of the stretched wrist's height,
until a jump says better: a hand's breadth above a dancer on demi-pointe."""


def rounded_arm(
    wrist: Vector, side: Side, figure: Figure, style: Style, bend: float, cross: float = 0.0
) -> ArmTarget:
    """The rounded arm whose wrist is at `wrist`, with `bend` and `cross` at the wrist (rad)."""
    return ArmTarget(
        ArmShape.ROUNDED,
        figure.shoulders[side],
        wrist,
        elbow_of_rounded_arm(figure, side, wrist),
        wrist_bend=bend,
        wrist_cross=cross,
        forearm_turn=radians(style.palm_deg),
    )


def _arm(
    signs: ArmSigns, side: Side, figure: Figure, style: Style, source: str | None
) -> ArmTarget:
    if signs.elbow is not None:
        elbow = extremity(figure, side, signs.elbow, figure.upper_arm, source=source)
        wrist = extremity(figure, side, signs.wrist, figure.forearm, root=elbow, source=source)
        palm = radians(style.palm_deg)
        shoulder = figure.shoulders[side]
        return ArmTarget(ArmShape.WRITTEN, shoulder, wrist, elbow, forearm_turn=palm)
    if signs.rounded:
        reach = figure.arm_reach(radians(style.elbow_deg))
        named = signs.named is not None
        wrist = extremity(figure, side, signs.wrist, reach, gives=named, source=source)
        return rounded_arm(wrist, side, figure, style, radians(style.wrist_deg))
    wrist = extremity(figure, side, signs.wrist, figure.stretched_arm, source=source)
    shoulder = figure.shoulders[side]
    elbow = shoulder + figure.upper_arm / figure.straight_arm * (wrist - shoulder)
    lifted = -radians(style.wrist_break_deg)
    return ArmTarget(ArmShape.STRAIGHT, shoulder, wrist, elbow, wrist_bend=lifted)


def _angles(orientation: Orientation) -> Vector:
    return np.radians([orientation.turn, orientation.tilt, orientation.bend])
