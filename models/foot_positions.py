"""The five positions of the feet as places of the soles on the floor.

Neagle 2005 §4.2.2: first, heels together; second, heels under the shoulders; third, the front heel
at the middle of the back foot; fourth, one foot's length apart; fifth, the front heel at the joint
of the back foot's big toe.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from enpointe.errors import PoseError
from enpointe.models.anatomy import SOLE_RADIUS
from enpointe.models.figure import Figure
from enpointe.notation import FeetPosition, Side

__all__ = ["DEFAULT_TURNOUT_DEG", "TURNOUT_RANGE_DEG", "Footprint", "footprints", "support_hull"]

DEFAULT_TURNOUT_DEG = 66.0
"""Each foot from straight ahead. 45 dancers of the Australian Ballet showed 133.6 deg in first
position, both feet together. Feet turned out farther than hip and shin follow roll the knees in."""
TURNOUT_RANGE_DEG = (30.0, 75.0)
_CLEARANCE = 0.005
"""Air between two feet that touch, m: contact between them is the dancer's choice, not a fault."""
_HEEL_RADIUS = 0.026


@dataclass(frozen=True, slots=True)
class Footprint:
    """A flat foot on the floor.

    Attributes:
        ankle: Point on the floor under the ankle joint, (2,), m.
        direction: Angle of the foot from straight ahead, + to the left, rad.
    """

    ankle: NDArray[np.float64]
    direction: float

    def point(self, forward: float, left: float = 0.0) -> NDArray[np.float64]:
        """A point of the sole, (2,), m, `forward` and `left` of the ankle in the foot's frame."""
        c, s = cos(self.direction), sin(self.direction)
        offset = np.array([c * forward - s * left, s * forward + c * left])
        return np.asarray(self.ankle + offset)

    def sole(self, figure: Figure) -> NDArray[np.float64]:
        """Corners of the sole: heel, ball and toe tip, two of each, (6, 2), m."""
        heel, ball = figure.heel_back - SOLE_RADIUS, figure.ball_forward
        tip = figure.ball_forward + figure.toe_length - SOLE_RADIUS
        half = figure.ball_half_breadth - SOLE_RADIUS
        marks = [(-heel, 0.55 * half), (ball, half), (tip, 0.5 * half)]
        return np.array([self.point(x, s * y) for x, y in marks for s in (1.0, -1.0)])


def footprints(
    figure: Figure, position: FeetPosition, turnout_deg: float = DEFAULT_TURNOUT_DEG
) -> Mapping[Side, Footprint]:
    """Where both feet stand, the middle between the ankles at the origin, facing x.

    Args:
        figure: The dancer's lengths.
        position: First to fifth, with the foot in front where one is.
        turnout_deg: Each foot from straight ahead, degrees.

    Raises:
        PoseError: The turnout is outside `TURNOUT_RANGE_DEG`.
    """
    low, high = TURNOUT_RANGE_DEG
    if not low <= turnout_deg <= high:
        raise PoseError(f"a turnout of {turnout_deg:g} degrees a leg is outside {low:g}..{high:g}")
    turnout = radians(turnout_deg)
    if position.name in ("first", "second"):
        apart = (
            _HEEL_RADIUS + 0.5 * _CLEARANCE
            if position.name == "first"
            else float(figure.shoulders[Side.LEFT][1])
        )
        prints = {
            Side.LEFT: _from_heel(figure, np.array([0.0, apart]), turnout),
            Side.RIGHT: _from_heel(figure, np.array([0.0, -apart]), -turnout),
        }
    else:
        prints = _crossed(figure, position, turnout)
    middle = 0.5 * (prints[Side.LEFT].ankle + prints[Side.RIGHT].ankle)
    return {side: Footprint(p.ankle - middle, p.direction) for side, p in prints.items()}


def _crossed(figure: Figure, position: FeetPosition, turnout: float) -> dict[Side, Footprint]:
    """Third, fourth and fifth, laid out with the left foot behind and mirrored if need be."""
    back = _from_heel(figure, np.zeros(2), turnout)
    heel_to_ball = figure.heel_back - _HEEL_RADIUS + figure.ball_forward
    share = 0.5 if position.name == "third" else 1.0
    gap = figure.ball_half_breadth + _HEEL_RADIUS + _CLEARANCE
    along = np.array([cos(turnout), sin(turnout)])
    before = np.array([sin(turnout), -cos(turnout)])
    heel = share * heel_to_ball * along + gap * before
    front = _from_heel(figure, heel, -turnout)
    if position.name == "fourth":
        # Opposite the fifth (croisee) or, open, opposite the first: heel before heel.
        aside = 0.0 if position.open else front.ankle[1] - back.ankle[1]
        place = back.ankle + np.array([figure.foot_length, aside])
        front = Footprint(place, -turnout)
    if position.front is Side.RIGHT:
        return {Side.LEFT: back, Side.RIGHT: front}
    return {Side.RIGHT: _mirrored(back), Side.LEFT: _mirrored(front)}


def _from_heel(figure: Figure, heel: NDArray[np.float64], direction: float) -> Footprint:
    """The print of a foot whose heel is round about `heel`."""
    forward = figure.heel_back - _HEEL_RADIUS
    return Footprint(heel + forward * np.array([cos(direction), sin(direction)]), direction)


def _mirrored(foot: Footprint) -> Footprint:
    return Footprint(foot.ankle * np.array([1.0, -1.0]), -foot.direction)


def support_hull(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Convex hull of points on the floor, counter-clockwise, (H, 2), by Andrew's monotone chain.

    Kept exact for the two or one points that a rising foot leaves, where qhull refuses.
    """
    ordered = sorted({(float(x), float(y)) for x, y in points})
    if len(ordered) < 3:
        return np.array(ordered)

    def chain(row: list[tuple[float, float]]) -> list[tuple[float, float]]:
        kept: list[tuple[float, float]] = []
        for p in row:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], p) <= 0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(o: tuple[float, float], a: tuple[float, float], b: tuple[float, float]) -> float:
    return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
