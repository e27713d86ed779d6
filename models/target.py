"""What one frame of a score asks of a body, in metres and radians."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from math import radians

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ScoreError
from enpointe.models.extremities import elbow_of_rounded_arm, extremity
from enpointe.models.figure import ROUNDED_ELBOW_DEG, Figure
from enpointe.models.foot_positions import (
    DEFAULT_TURNOUT_DEG,
    Footprint,
    footprints,
    support_hull,
)
from enpointe.notation import ArmSigns, Orientation, ResolvedFrame, Side, Sign

__all__ = ["ArmShape", "ArmTarget", "LegTarget", "PoseTarget", "Style", "pose_target"]

Vector = NDArray[np.float64]


class ArmShape(StrEnum):
    """How the arm gets from shoulder to wrist."""

    ROUNDED = "rounded"
    STRAIGHT = "straight"
    WRITTEN = "written elbow"


@dataclass(frozen=True, slots=True)
class Style:
    """What a method or a teacher decides.

    Attributes:
        turnout_deg: Each foot from straight ahead.
        elbow_deg: Bend of the elbow of a rounded arm (Neagle 2005 §4.4.1).
        wrist_deg: Bend of the wrist of a rounded arm. The thesis bends it as much as the elbow
            (§4.4.4); on a hand with fingers, which carry the curve on, that breaks the line, so
            ours is less.
        palm_deg: Turn of the forearm from thumb-forward to the palm that faces along the curve.
            The thesis turns 90 (§4.4.4) and finds it more than its dancers' (§4.5.3 b); 80 is the
            supination of adults (AAOS).
    """

    turnout_deg: float = DEFAULT_TURNOUT_DEG
    elbow_deg: float = ROUNDED_ELBOW_DEG
    wrist_deg: float = 14.0
    palm_deg: float = 80.0


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
class LegTarget:
    """One leg: flat on the floor at a footprint, or with its ankle in the pelvis' frame.

    Attributes:
        footprint: Where the flat foot stands; None for a leg in the air.
        ankle: (3,), m, in the pelvis' frame, for a leg in the air.
        knee: (3,), m, in the pelvis' frame where a bent knee is written; None for a straight leg.
        turnout: Of the leg, rad.
    """

    footprint: Footprint | None
    ankle: Vector | None
    knee: Vector | None
    turnout: float


@dataclass(frozen=True, slots=True)
class PoseTarget:
    """One key pose to solve, the dancer facing x with the feet about the origin.

    Attributes:
        arms: By side.
        legs: By side.
        head: Turn, tilt and bend of the head against the torso, rad, in `Orientation`'s senses.
        body: The same of the torso against the pelvis.
        pelvis: The same of the pelvis against the world.
        support: Hull of the soles on the floor, counter-clockwise, (H, 2), m.
        name: For messages.
    """

    arms: Mapping[Side, ArmTarget]
    legs: Mapping[Side, LegTarget]
    head: Vector
    body: Vector
    pelvis: Vector
    support: NDArray[np.float64]
    name: str = "pose"

    @property
    def structure(self) -> tuple[tuple[str, str, bool], ...]:
        """What decides which rules apply; poses of one structure share a compiled problem."""
        return tuple(
            (
                self.arms[side].shape.value,
                "floor" if self.legs[side].footprint is not None else "air",
                self.legs[side].knee is not None,
            )
            for side in Side
        )


def pose_target(
    frame: ResolvedFrame,
    figure: Figure,
    style: Style | None = None,
    *,
    source: str | None = None,
    name: str | None = None,
) -> PoseTarget:
    """Measure one frame of a score on one dancer.

    Args:
        frame: With everything filled in.
        figure: The dancer's lengths.
        style: The method's amounts.
        source: Name of the score, for errors.
        name: For messages; the beat if None.

    Raises:
        ScoreError: A sign that no limb of this dancer reaches, or no foot on the floor.
    """
    style = style or Style()
    legs = _legs(frame, figure, style, source)
    soles = [leg.footprint.sole(figure) for leg in legs.values() if leg.footprint is not None]
    if not soles:
        raise ScoreError(
            "no foot is on the floor in this frame; write one at height 1",
            frame.at.line,
            frame.at.column,
            source,
        )
    return PoseTarget(
        arms={side: _arm(frame.arms[side], side, figure, style, source) for side in Side},
        legs=legs,
        head=_angles(frame.head),
        body=_angles(frame.body),
        pelvis=_angles(frame.pelvis),
        support=support_hull(np.vstack(soles)),
        name=name or f"beat {frame.beat}",
    )


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
    return ArmTarget(ArmShape.STRAIGHT, shoulder, wrist, elbow)


def _legs(
    frame: ResolvedFrame, figure: Figure, style: Style, source: str | None
) -> dict[Side, LegTarget]:
    turnout = radians(style.turnout_deg)
    prints: dict[Side, Footprint] = {}
    if frame.feet is not None:
        prints.update(footprints(figure, frame.feet, style.turnout_deg))
    legs: dict[Side, LegTarget] = {}
    for side in Side:
        knee_sign = frame.knees.get(side)
        knee = (
            extremity(figure, side, knee_sign, figure.thigh, leg=True, source=source)
            if knee_sign is not None
            else None
        )
        sign = frame.foot_signs.get(side)
        if sign is None:
            legs[side] = LegTarget(prints[side], None, knee, turnout)
        elif sign.height <= _FLOOR_LINE:
            foot = _written_print(sign, side, figure, turnout)
            legs[side] = LegTarget(foot, None, knee, turnout)
        else:
            reach = figure.stretched_leg if knee is None else figure.shank
            ankle = extremity(figure, side, sign, reach, leg=True, root=knee, source=source)
            legs[side] = LegTarget(None, ankle, knee, turnout)
    return legs


_FLOOR_LINE = 1.0 + 1e-9


def _written_print(sign: Sign, side: Side, figure: Figure, turnout: float) -> Footprint:
    """A foot written on the floor line: under its width, as deep as the straight leg allows."""
    floor = Sign(sign.width, sign.height, sign.depth)
    ankle = extremity(figure, side, floor, figure.straight_leg + figure.ankle_height, leg=True)
    outward = 1.0 if side is Side.LEFT else -1.0
    return Footprint(ankle[:2], outward * turnout)


def _angles(orientation: Orientation) -> Vector:
    return np.radians([orientation.turn, orientation.tilt, orientation.bend])
