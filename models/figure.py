"""The upright figure of a dancer: the lengths that notation and rules are measured on.

Read off a compiled model at its "standing" keyframe, so that any model with the dancer's sites can
be notated, whatever its proportions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sqrt

import mujoco
import numpy as np
from numpy.typing import NDArray

from enpointe.errors import ModelError
from enpointe.notation import Side

__all__ = ["ROUNDED_ELBOW_DEG", "Figure"]

ROUNDED_ELBOW_DEG = 27.0
"""Bend of the elbow of a rounded arm, degrees: 153 inside the arm (Neagle 2005 §4.4.1)."""

STRETCHED_DEG = 2.0
"""Bend left in a stretched joint, degrees. At exactly 0 a limb is singular: no small rotation
brings its end closer, and solvers and muscles alike lose it."""


@dataclass(frozen=True, slots=True)
class Figure:
    """Lengths of a standing dancer, m.

    Attributes:
        lines: Heights above the floor of the stave's lines 1 to 6 for the arms: floor, knee, waist,
            shoulder, crown, and the wrist of an arm stretched overhead (Neagle 2005 §4.4.1).
        leg_lines: The same for the legs, whose third line is the hip (§4.7.3).
        shoulders: Shoulder joints in the torso's frame, by side.
        hips: Hip joints in the pelvis' frame, by side.
        torso_origin: Where the torso's frame stands, in the world.
        pelvis_origin: Where the pelvis' frame stands, in the world.
        upper_arm: Shoulder to elbow.
        forearm: Elbow to wrist.
        thigh: Hip to knee.
        shank: Knee to ankle.
        ankle_height: Ankle joint above the sole.
        heel_back: Heel behind the ankle.
        ball_forward: Toe joint in front of the ankle.
        toe_length: Toe joint to the tip of the toes.
        ball_half_breadth: Half the breadth of the foot at the toe joint.
    """

    lines: tuple[float, ...]
    leg_lines: tuple[float, ...]
    shoulders: Mapping[Side, NDArray[np.float64]]
    hips: Mapping[Side, NDArray[np.float64]]
    torso_origin: NDArray[np.float64]
    pelvis_origin: NDArray[np.float64]
    upper_arm: float
    forearm: float
    thigh: float
    shank: float
    ankle_height: float
    heel_back: float
    ball_forward: float
    toe_length: float
    ball_half_breadth: float

    @classmethod
    def of(cls, model: mujoco.MjModel) -> Figure:
        """Measure `model` at its keyframe "standing".

        Raises:
            ModelError: The model lacks the keyframe or one of the dancer's sites or bodies.
        """
        try:
            data = mujoco.MjData(model)
            mujoco.mj_resetDataKeyframe(model, data, model.key("standing").id)
            mujoco.mj_kinematics(model, data)

            def site(name: str) -> NDArray[np.float64]:
                return np.array(data.site(name).xpos)

            torso, pelvis = np.array(data.body("torso").xpos), np.array(data.body("pelvis").xpos)
            shoulders = {side: site(f"{side}_shoulder") - torso for side in Side}
            hips = {side: site(f"{side}_hip") - pelvis for side in Side}
            upper_arm = _distance(site("left_shoulder"), site("left_elbow"))
            forearm = _distance(site("left_elbow"), site("left_wrist"))
            ankle, ball = site("left_ankle"), site("left_ball")
            knee, hip = site("left_knee")[2], site("left_hip")[2]
            shoulder = site("left_shoulder")[2]
            upper_lines = (shoulder, site("crown")[2], shoulder + upper_arm + forearm)
            waist = float(torso[2])
            ball_spheres = [model.geom(f"left_ball_{edge}") for edge in ("inner", "outer")]
        except KeyError as error:
            raise ModelError(f"this model is not a dancer's: {error}") from None
        return cls(
            lines=(0.0, knee, waist, *upper_lines),
            leg_lines=(0.0, knee, hip, *upper_lines),
            shoulders=shoulders,
            hips=hips,
            torso_origin=torso,
            pelvis_origin=pelvis,
            upper_arm=upper_arm,
            forearm=forearm,
            thigh=_distance(site("left_hip"), site("left_knee")),
            shank=_distance(site("left_knee"), ankle),
            ankle_height=float(ankle[2]),
            heel_back=float(ankle[0] - site("left_heel")[0]),
            ball_forward=float(ball[0] - ankle[0]),
            toe_length=_distance(ball, site("left_toe_tip")),
            ball_half_breadth=max(abs(g.pos[1]) + g.size[0] for g in ball_spheres),
        )

    @property
    def straight_arm(self) -> float:
        """Shoulder to wrist of a straight arm (Neagle 2005 eq. 4.4)."""
        return self.upper_arm + self.forearm

    @property
    def straight_leg(self) -> float:
        """Hip to ankle of a straight leg."""
        return self.thigh + self.shank

    @property
    def stretched_arm(self) -> float:
        """Shoulder to wrist of an arm as straight as a body holds it (`STRETCHED_DEG`)."""
        return self.arm_reach(radians(STRETCHED_DEG))

    @property
    def stretched_leg(self) -> float:
        """Hip to ankle of a leg in the air as straight as a body holds it."""
        return _third_side(self.thigh, self.shank, radians(STRETCHED_DEG))

    @property
    def foot_length(self) -> float:
        return self.heel_back + self.ball_forward + self.toe_length

    def arm_reach(self, elbow_bend: float) -> float:
        """Shoulder to wrist, the elbow bent by `elbow_bend` radians (eq. 4.5 with pi - bend)."""
        return _third_side(self.upper_arm, self.forearm, elbow_bend)

    @property
    def rounded_arm(self) -> float:
        """Reach of a rounded arm."""
        return self.arm_reach(radians(ROUNDED_ELBOW_DEG))

    def full_width(self, *, leg: bool) -> float:
        """Centre line to a wrist or ankle stretched sideways: width 1 on the stave (§4.3)."""
        root = self.hips if leg else self.shoulders
        limb = self.straight_leg if leg else self.straight_arm
        return float(root[Side.LEFT][1]) + limb

    def height(self, line: float, *, leg: bool = False) -> float:
        """Height above the floor of a place on the stave (eq. 4.1), m; linear between lines."""
        lines = self.leg_lines if leg else self.lines
        return float(np.interp(line, np.arange(1, len(lines) + 1), lines))

    def line(self, height: float, *, leg: bool = False) -> float:
        """The stave height of a height in metres; the inverse of `height`."""
        lines = self.leg_lines if leg else self.lines
        return float(np.interp(height, lines, np.arange(1, len(lines) + 1)))


def _third_side(a: float, b: float, bend: float) -> float:
    return sqrt(a * a + b * b + 2 * a * b * cos(bend))


def _distance(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(a - b))
