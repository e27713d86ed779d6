"""Where the feet stand, frame after frame: a foot that stays on the floor keeps its place."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np
from numpy.typing import NDArray

from enpointe.models.anatomy import side_sign
from enpointe.models.extremities import extremity
from enpointe.models.figure import Figure
from enpointe.models.foot_positions import Footprint, footprints
from enpointe.notation import FloorContact, ResolvedFrame, Side, Sign

__all__ = ["Ground", "StanceTracker"]


@dataclass(frozen=True, slots=True)
class Ground:
    """The floor under one frame.

    Attributes:
        prints: Of the feet that bear weight, by side.
        facing: Where the dancer faces, from the audience, + to her left, rad.
        middle: The floor under the middle of the dancer, (2,), m.
    """

    prints: Mapping[Side, Footprint]
    facing: float
    middle: NDArray[np.float64]


class StanceTracker:
    """Follows a score and keeps the feet where they are.

    A frame's own signs say where its feet are about the dancer's middle. In the world that layout
    is laid so that the foot that bears weight before and after stays on its ball; where both feet
    do and the position changes (an echappe), the middle between them stays. A written place or
    travel moves the whole.

    Args:
        figure: The dancer's lengths.
        turnout_deg: Of each foot.
    """

    def __init__(self, figure: Figure, turnout_deg: float) -> None:
        self._figure = figure
        self._turnout = turnout_deg
        self._before: Ground | None = None
        self._place = np.zeros(2)

    def follow(self, frame: ResolvedFrame) -> Ground:
        """The ground of the next frame."""
        facing = radians(frame.facing_degrees)
        place = np.array([-frame.place.up, frame.place.left])
        layout = self._layout(frame)
        middle = place.copy()
        if self._before is not None:
            middle = self._anchored(layout, facing) + (place - self._place)
        self._place = place
        prints = {side: _laid(p, facing, middle) for side, p in layout.items()}
        self._before = Ground(prints, facing, middle)
        return self._before

    def _layout(self, frame: ResolvedFrame) -> dict[Side, Footprint]:
        """The feet that bear weight, about the dancer's middle, facing the audience."""
        layout: dict[Side, Footprint] = {}
        for side, leg in frame.legs.items():
            if not leg.bears:
                continue
            if leg.position is not None:
                prints = footprints(self._figure, leg.position, self._turnout)
                on_pointe = leg.support is not None and leg.support.floor is FloorContact.POINTE
                layout[side] = self._drawn_under(prints, side) if on_pointe else prints[side]
            elif leg.foot is not None:
                layout[side] = self._under(leg.foot, side)
        return layout

    def _drawn_under(self, prints: Mapping[Side, Footprint], side: Side) -> Footprint:
        """A foot that rises on pointe draws its tip in towards where its heel was (sous-sus)."""
        foot = prints[side]
        tip = foot.point(self._figure.ball_forward + self._figure.toe_length)
        heel = foot.point(-0.5 * self._figure.heel_back)
        wanted = heel + 0.25 * (tip - heel)
        return Footprint(foot.ankle + wanted - tip, foot.direction)

    def _under(self, sign: Sign, side: Side) -> Footprint:
        """A foot written on the floor line: under its width, as deep as a straight leg allows."""
        length = self._figure.straight_leg + self._figure.ankle_height
        floor = Sign(sign.width, 1.0, sign.depth)
        ankle = extremity(self._figure, side, floor, length, leg=True, gives=True)
        outward = side_sign(side)
        return Footprint(ankle[:2], outward * radians(self._turnout))

    def _anchored(self, layout: Mapping[Side, Footprint], facing: float) -> NDArray[np.float64]:
        assert self._before is not None
        stays = [side for side in layout if side in self._before.prints]
        if not stays:
            return self._before.middle
        balls = [
            self._before.prints[side].point(self._figure.ball_forward)
            - _turned(layout[side].point(self._figure.ball_forward), facing)
            for side in stays
        ]
        if len(self._before.prints) == 1:
            return np.asarray(balls[0])
        return np.asarray(np.mean(balls, axis=0))


def _laid(footprint: Footprint, facing: float, middle: NDArray[np.float64]) -> Footprint:
    return Footprint(middle + _turned(footprint.ankle, facing), footprint.direction + facing)


def _turned(point: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    c, s = cos(angle), sin(angle)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])
