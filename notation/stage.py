"""What stands below the stave: where on the stage, facing where, travelling and turning how.

Directions are angles in degrees seen from above, from the audience (0), + to the dancer's left when
facing the audience (counter-clockwise): stage left is 90, upstage 180, stage right -90. Places are
metres from the centre of the stage. In the world of the bodies, x points to the audience and y to
stage left, so a place is ``(x, y) = (-up, left)`` and a direction is a yaw.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import ceil, cos, radians, sin

from enpointe.notation.signs import Location, Side

__all__ = ["DIRECTION_WORDS", "Facing", "StagePlace", "Travel", "Turn", "shorter_way"]

DIRECTION_WORDS: Mapping[float, tuple[str, ...]] = {
    0.0: ("audience", "wall 5", "en face", "downstage", "point 1"),
    -45.0: ("corner 1", "point 2"),
    -90.0: ("stage right", "wall 8", "point 3"),
    -135.0: ("corner 4", "point 4"),
    180.0: ("upstage", "wall 7", "point 5"),
    135.0: ("corner 3", "point 6"),
    90.0: ("stage left", "wall 6", "point 7"),
    45.0: ("corner 2", "point 8"),
}
"""Words for the eight directions; the first is the one that scores are written with.

Corners and walls are Cecchetti's, from the dancer's right front on counter-clockwise, the audience
wall 5; points are the French and Russian schools', clockwise from the audience."""


def shorter_way(degrees: float) -> float:
    """The same direction, or change of direction, above -180 and up to 180 degrees."""
    return degrees - 360.0 * (ceil((degrees + 180.0) / 360.0) - 1.0)


@dataclass(frozen=True, slots=True)
class Facing:
    """The direction that the pelvis faces.

    Attributes:
        degrees: From the audience, -180 to 180, + to the left.
        at: Where it was written; takes no part in equality.
    """

    degrees: float
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class StagePlace:
    """A place on the stage, in metres from its centre.

    Attributes:
        left: To stage left; negative is stage right.
        up: Upstage, away from the audience; negative is downstage.
        at: Where it was written; takes no part in equality.
    """

    left: float = 0.0
    up: float = 0.0
    at: Location | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Travel:
    """The way from the place of the frame before to that of this frame.

    Attributes:
        degrees: Direction of the straight line from start to end, as in :class:`Facing`.
        metres: Length of that straight line.
        curve: How far the path turns on its way, degrees, + to the left; 0 is straight.
        at: Where it was written; takes no part in equality.
    """

    degrees: float
    metres: float
    curve: float = 0.0
    at: Location | None = field(default=None, compare=False)

    def after(self, place: StagePlace) -> StagePlace:
        """Where the way ends that starts at a place."""
        angle = radians(self.degrees)
        return StagePlace(
            place.left + self.metres * sin(angle), place.up - self.metres * cos(angle), self.at
        )


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn of the whole body on the way to a frame.

    Attributes:
        degrees: Amount, more than 0; 720 is a double turn.
        sense: The dancer's side that the turn goes to.
        at: Where it was written; takes no part in equality.
    """

    degrees: float
    sense: Side
    at: Location | None = field(default=None, compare=False)

    @property
    def signed(self) -> float:
        """The amount in degrees, + to the left."""
        return self.degrees if self.sense is Side.LEFT else -self.degrees
