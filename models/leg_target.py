"""What a leg is asked: to stand, to point at the floor or the other leg, or to be in the air."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np
from numpy.typing import NDArray

from enpointe.models.contact_geometry import PLATFORM, PLATFORM_RISE
from enpointe.models.extremities import extremity
from enpointe.models.figure import Figure
from enpointe.models.foot_positions import Footprint
from enpointe.models.style import Style
from enpointe.notation import Bend, Direction, FloorContact, ResolvedLeg, Side

__all__ = [
    "DEMI_POINTE_DEG",
    "FOOT_JOINTS",
    "POINTED_DEG",
    "InAir",
    "LegTarget",
    "OnPointe",
    "Standing",
    "ToeOnFloor",
    "ToeOnLeg",
    "leg_target",
]

Vector = NDArray[np.float64]
DEMI_POINTE_DEG = 62.0
"""How far the foot is raised about its ball on demi-pointe. The toe joint goes to 80-90 degrees in
dancers; a foot carried there by a straight leg stands at about 60."""


@dataclass(frozen=True, slots=True)
class Standing:
    """On the floor and bearing weight, flat or on the ball of the foot.

    Attributes:
        footprint: Where the foot is when it is flat; a rising foot keeps its ball.
        rise: Angle of the foot to the floor about the ball, rad; 0 is flat.
        knee_bend: rad; 0 is straight.
    """

    footprint: Footprint
    rise: float = 0.0
    knee_bend: float = 0.0

    def soles(self, figure: Figure) -> NDArray[np.float64]:
        """Points of the sole that bear weight, (S, 2), m."""
        corners = self.footprint.sole(figure)
        return corners if self.rise < radians(1.0) else corners[2:]


@dataclass(frozen=True, slots=True)
class OnPointe:
    """On the tip of the toes and bearing weight.

    Attributes:
        footprint: Where the foot would be flat; the tip of the toes stays where it was.
        knee_bend: rad.
    """

    footprint: Footprint
    knee_bend: float = 0.0

    def soles(self, figure: Figure) -> NDArray[np.float64]:
        """Corners of the platform, `PLATFORM` m, (4, 2)."""
        middle = figure.ball_forward + figure.toe_length + PLATFORM_RISE
        long, broad = PLATFORM
        return np.array(
            [
                self.footprint.point(middle + sx * long / 2, sy * broad / 2)
                for sx in (-1.0, 1.0)
                for sy in (-1.0, 1.0)
            ]
        )


@dataclass(frozen=True, slots=True)
class ToeOnFloor:
    """Stretched, the tip of the toes on the floor without weight: a tendu.

    Attributes:
        across: Unit normal, in the pelvis' horizontal plane, of the line that the toe points along,
            (2,): (0, 1) for devant and derriere, (1, 0) a la seconde.
        ahead: -1 behind, +1 in front, 0 to the side; a first guess, not a rule.
        turnout: rad.
    """

    across: tuple[float, float]
    ahead: float
    turnout: float


@dataclass(frozen=True, slots=True)
class ToeOnLeg:
    """Bent, the pointed toe at the other leg: retire and cou-de-pied.

    Attributes:
        site: Of the other leg without its side, "knee" or "ankle".
        offset: From that site in the pelvis' frame, forward, to the working side, up, (3,), m.
        turnout: rad.
    """

    site: str
    offset: tuple[float, float, float]
    turnout: float


@dataclass(frozen=True, slots=True)
class InAir:
    """With the ankle, and the knee if it is bent, at places in the pelvis' frame.

    Attributes:
        ankle: (3,), m.
        knee: (3,), m, or None for a stretched leg.
        turnout: rad.
        foot: For a leg on its way, the angles that the foot passes through, in the order of
            `FOOT_JOINTS`, (4,), rad; None for a leg in its place, whose foot is pointed. A leg on
            its way keeps to it as well as the floor lets it.
    """

    ankle: Vector
    knee: Vector | None
    turnout: float
    foot: Vector | None = None

    @property
    def passing(self) -> bool:
        """Whether the leg is on its way."""
        return self.foot is not None


FOOT_JOINTS = ("ankle_point", "ankle_turn", "ankle_roll", "toe_raise")
POINTED_DEG = (75.0, 0.0, 0.0, -15.0)
"""A stretched foot, in the order of `FOOT_JOINTS`: instep out, toes carrying the line on. Dancers'
ankles go to 77-83 degrees (Russell et al. 2010)."""


LegTarget = Standing | OnPointe | ToeOnFloor | ToeOnLeg | InAir


def leg_target(
    leg: ResolvedLeg,
    side: Side,
    figure: Figure,
    style: Style,
    footprint: Footprint | None,
    source: str | None = None,
) -> LegTarget:
    """Measure one leg of a frame on one dancer.

    Args:
        leg: With everything filled in.
        side: Whose.
        figure: The dancer's lengths.
        style: The method's amounts.
        footprint: Where the foot stands, for a leg that bears weight.
        source: Name of the score, for errors.

    Raises:
        ScoreError: A sign that the leg does not reach.
    """
    turnout = radians(style.turnout_deg)
    gives = leg.named is not None
    if leg.bears and leg.support is not None and footprint is not None:
        bend = _knee_bend(leg, style)
        if leg.support.floor is FloorContact.POINTE:
            return OnPointe(footprint, bend)
        return Standing(footprint, _rise(leg, style), bend)
    if leg.named is not None and leg.named.name in _TOUCHES:
        return _touching(leg.named.name, leg.named.direction, turnout)
    assert leg.foot is not None
    if leg.support is not None:
        ahead = {"front": 1.0, "behind": -1.0, "level": 0.0}[leg.foot.depth.value]
        return ToeOnFloor(_LINES[ahead != 0.0], ahead, turnout)
    if leg.knee is None:
        ankle = extremity(
            figure, side, leg.foot, figure.stretched_leg, leg=True, gives=gives, source=source
        )
        return InAir(ankle, None, turnout)
    knee = extremity(figure, side, leg.knee, figure.thigh, leg=True, gives=gives, source=source)
    ankle = extremity(
        figure, side, leg.foot, figure.shank, leg=True, root=knee, gives=gives, source=source
    )
    return InAir(ankle, knee, turnout)


_LINES = {True: (0.0, 1.0), False: (1.0, 0.0)}
_TOUCHES = ("tendu", "retiré", "cou-de-pied")
# Where the pointed toe is: forward of the other leg's joint, to the working side, up; m. Toe and
# leg have a thickness: it lies on the flesh, not on the bone.
_RETIRE = {
    Direction.DEVANT: (0.075, 0.015, 0.0),
    Direction.SECONDE: (0.0, 0.075, 0.0),
    Direction.DERRIERE: (-0.075, 0.015, 0.0),
}
_COU_DE_PIED = {
    Direction.DEVANT: (0.065, 0.01, 0.09),
    Direction.SECONDE: (0.0, 0.06, 0.09),
    Direction.DERRIERE: (-0.07, 0.01, 0.09),
}


def _touching(name: str, direction: Direction | None, turnout: float) -> LegTarget:
    towards = direction or Direction.DEVANT
    if name == "tendu":
        ahead = {Direction.DEVANT: 1.0, Direction.SECONDE: 0.0, Direction.DERRIERE: -1.0}[towards]
        return ToeOnFloor(_LINES[ahead != 0.0], ahead, turnout)
    if name == "cou-de-pied":
        return ToeOnLeg("ankle", _COU_DE_PIED[towards], turnout)
    return ToeOnLeg("knee", _RETIRE[towards], turnout)


def _knee_bend(leg: ResolvedLeg, style: Style) -> float:
    assert leg.support is not None
    degrees = {
        Bend.STRAIGHT: 0.0,
        Bend.DEMI_PLIE: style.demi_plie_deg,
        Bend.GRAND_PLIE: style.grand_plie_deg,
    }[leg.support.bend]
    return radians(style.demi_plie_deg if leg.knee is not None and not degrees else degrees)


def _rise(leg: ResolvedLeg, style: Style) -> float:
    assert leg.support is not None
    if leg.support.floor is FloorContact.DEMI_POINTE:
        return radians(DEMI_POINTE_DEG)
    wide = leg.position is not None and (leg.position.name == "second" or leg.position.open)
    if leg.support.bend is Bend.GRAND_PLIE and not wide:
        return radians(style.grand_plie_rise_deg)
    return 0.0
