"""The dancer's joints: where they are, how far they go, how strong they are.

Sources of the ranges: hip rotation 50.2 deg passive in professional dancers (Australian Ballet,
n = 45) and 52 deg in ABT and NYCB women, of a turnout shared about 60 % hip, 20-30 % ankle and
foot, 10-20 % knee; ankle dorsiflexion 30 deg in demi-plie and plantar flexion 83 deg en pointe
(Russell et al. 2010, 15 women); toe extension 80-90 deg on demi-pointe. Shoulder, elbow, wrist
and neck: normal ranges of adults (AAOS), widened at the spine and hip for a dancer.

Sources of the torques: ankle 3.03 +- 0.40 N m/kg in ballet jumps (Perry et al. 2019, 15 women);
toe joint 1.3 N m/kg (needed by a one-foot push-off, measured on this model's forerunner); hip,
knee and spine of the order of 4 N m/kg, the largest joint moments of trained jumpers. Shoulder,
elbow, wrist and neck moments are those of strong adults per kilogram of body mass, rounded; no
measurement of dancers was found for them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import sqrt

from enpointe.models.anthropometry import Anthropometry

__all__ = ["SIDES", "Hinge", "Skeleton", "mirrored", "side_sign"]

SIDES = ("left", "right")
NECK_RISE = 0.035
"""Neck joint above suprasternale, m: about the seventh cervical vertebra."""
SOLE_RADIUS = 0.012
"""Radius of the contact spheres, m; the toe joint is as high above the sole."""
_D = sqrt(0.5)


def side_sign(side: str) -> float:
    """+1 for the left side (y > 0), -1 for the right."""
    return 1.0 if side == "left" else -1.0


def mirrored(axis: tuple[float, float, float], side: str) -> tuple[float, float, float]:
    """A rotation axis given for the left side, on `side`: equal angles then mean mirrored poses."""
    s = side_sign(side)
    return (s * axis[0], axis[1], s * axis[2])


@dataclass(frozen=True, slots=True)
class Hinge:
    """One degree of freedom of a joint.

    Attributes:
        name: Without the side.
        axis: Unit axis for the left (or only) side, in the body's upright frame.
        range_deg: Least and greatest angle, degrees.
        strength: Torque limit over body mass, N m/kg.
        armature: Reflected inertia that stands for the muscles' own mass, kg m^2.
        damping: Passive damping, N m s/rad.
    """

    name: str
    axis: tuple[float, float, float]
    range_deg: tuple[float, float]
    strength: float
    armature: float
    damping: float


# Order turn, tilt, bend from the outside in: q = q_turn q_tilt q_bend (Neagle 2005 eq. 4.9).
WAIST = (
    Hinge("waist_turn", (0, 0, 1), (-45, 45), 2.4, 0.02, 0.8),
    Hinge("waist_tilt", (-1, 0, 0), (-35, 35), 3.2, 0.02, 0.8),
    Hinge("waist_bend", (0, 1, 0), (-45, 75), 4.0, 0.02, 0.8),
)
NECK = (
    Hinge("neck_turn", (0, 0, 1), (-80, 80), 0.4, 0.005, 0.1),
    Hinge("neck_tilt", (-1, 0, 0), (-45, 45), 0.5, 0.005, 0.1),
    Hinge("neck_bend", (0, 1, 0), (-60, 50), 0.6, 0.005, 0.1),
)
# The two swing axes stand at 45 degrees to the sagittal plane, so that the three-hinge chain
# locks only with the limb level and pointing across the front or out behind, where no position
# of ballet has it (the usual order locks a la seconde or devant).
SHOULDER = (
    Hinge("shoulder_raise", (_D, -_D, 0), (-75, 205), 1.1, 0.004, 0.15),
    Hinge("shoulder_cross", (-_D, -_D, 0), (-88, 88), 1.0, 0.004, 0.15),
    # Inward it includes what the shoulder blade adds to the joint when the arm is low in front.
    Hinge("shoulder_turn", (0, 0, 1), (-125, 110), 0.7, 0.004, 0.10),
)
ELBOW = (
    Hinge("elbow_bend", (0, -1, 0), (0, 145), 0.9, 0.002, 0.08),
    Hinge("forearm_turn", (0, 0, 1), (-95, 95), 0.25, 0.001, 0.03),
)
WRIST = (
    Hinge("wrist_bend", (-1, 0, 0), (-70, 80), 0.25, 0.001, 0.02),
    Hinge("wrist_cross", (0, -1, 0), (-35, 25), 0.2, 0.001, 0.02),
)
HIP = (
    Hinge("hip_raise", (_D, -_D, 0), (-145, 150), 4.2, 0.02, 0.5),
    Hinge("hip_cross", (-_D, -_D, 0), (-85, 85), 4.0, 0.02, 0.5),
    # Wide: with the leg raised, part of a turn of the thigh about itself shows up in this hinge and
    # part in the two before it. The rule of the hip's rotation holds the anatomy.
    Hinge("hip_turn", (0, 0, 1), (-70, 120), 2.0, 0.01, 0.3),
)
KNEE = (Hinge("knee_bend", (0, 1, 0), (-3, 150), 4.2, 0.01, 0.3),)
ANKLE = (
    Hinge("ankle_point", (0, 1, 0), (-35, 85), 3.0, 0.01, 0.2),
    Hinge("ankle_turn", (0, 0, 1), (-20, 22), 1.0, 0.01, 0.2),
    Hinge("ankle_roll", (1, 0, 0), (-30, 30), 1.4, 0.01, 0.2),
)
TOE = (Hinge("toe_raise", (0, -1, 0), (-45, 90), 1.3, 0.003, 0.1),)


@dataclass(frozen=True, slots=True)
class Skeleton:
    """Where the joints of an upright dancer are, m; every body frame is upright there.

    Trunk and limb lengths are de Leva's (1996). Foot length and breadth are women's in ANSUR II
    (Gordon et al. 2014: foot 0.151 and ball breadth 0.056 of stature), since de Leva's "foot" ends
    short of the shoe. The ankle is as high as a head in proportion leaves it: 0.0445 of stature.
    """

    measures: Anthropometry

    def _length(self, name: str) -> float:
        return self.measures.segment(name).length

    @property
    def ankle_height(self) -> float:
        return 0.0445 * self.measures.height

    @property
    def thigh(self) -> float:
        return self._length("thigh")

    @property
    def shank(self) -> float:
        return self._length("shank")

    @property
    def upper_arm(self) -> float:
        return self._length("upper_arm")

    @property
    def forearm(self) -> float:
        return self._length("forearm")

    @property
    def waist_height(self) -> float:
        """Waist joint above the mid-hip."""
        return self._length("lower_trunk")

    @property
    def torso_length(self) -> float:
        """Waist joint to suprasternale."""
        return self._length("middle_trunk") + self._length("upper_trunk")

    @property
    def head_and_neck(self) -> float:
        """Suprasternale to vertex: what trunk, legs and ankles leave of the stature."""
        below = self.ankle_height + self.shank + self.thigh + self.waist_height + self.torso_length
        return self.measures.height - below

    @property
    def hip_half_width(self) -> float:
        return 0.0495 * self.measures.height

    @property
    def shoulder_half_width(self) -> float:
        wide = 0.0925 if self.measures.sex == "female" else 0.104
        return wide * self.measures.height

    @property
    def shoulder_drop(self) -> float:
        """Shoulder joint below suprasternale."""
        return 0.019 * self.measures.height

    @property
    def foot_length(self) -> float:
        return 0.149 * self.measures.height

    @property
    def heel_back(self) -> float:
        """Heel behind the ankle joint."""
        return 0.24 * self.foot_length

    @property
    def ball_forward(self) -> float:
        """Toe joint in front of the ankle joint: it lies 0.72 of the foot from the heel."""
        return 0.48 * self.foot_length

    @property
    def toe_length(self) -> float:
        return self.foot_length - self.heel_back - self.ball_forward

    @property
    def ball_half_breadth(self) -> float:
        return 0.0225 * self.measures.height

    @property
    def hip_height(self) -> float:
        """Hip joints above the floor, standing."""
        return self.ankle_height + self.shank + self.thigh

    @property
    def straight_arm(self) -> float:
        """Shoulder to wrist (Neagle 2005 eq. 4.4)."""
        return self.upper_arm + self.forearm

    def hinges(self) -> Iterator[tuple[str, Hinge]]:
        """Every hinge with its full name, depth first as MuJoCo orders them."""
        for hinge in (*WAIST, *NECK):
            yield hinge.name, hinge
        for side in SIDES:
            for hinge in (*SHOULDER, *ELBOW, *WRIST):
                yield f"{side}_{hinge.name}", hinge
        for side in SIDES:
            for hinge in (*HIP, *KNEE, *ANKLE, *TOE):
                yield f"{side}_{hinge.name}", hinge
