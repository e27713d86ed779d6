"""A frame while its lines are being read."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from fractions import Fraction

from enpointe.notation.check import excluded_by
from enpointe.notation.frame import Frame
from enpointe.notation.movement import Jump, Limb, Locomotion, PathMark
from enpointe.notation.reading import Reader
from enpointe.notation.signs import (
    ArmsPosition,
    FeetPosition,
    HandContact,
    LegPosition,
    Location,
    Orientation,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import Facing, StagePlace, Travel, Turn

__all__ = ["Draft"]


@dataclass
class Draft:
    """The parts read so far, by the names that a frame has for them.

    Attributes:
        reader: Refuses what is wrong.
    """

    reader: Reader
    feet: FeetPosition | None = None
    arms: ArmsPosition | None = None
    hands: dict[Side, Sign] = field(default_factory=dict)
    elbows: dict[Side, Sign] = field(default_factory=dict)
    foot_signs: dict[Side, Sign] = field(default_factory=dict)
    knees: dict[Side, Sign] = field(default_factory=dict)
    head: Orientation | None = None
    body: Orientation | None = None
    pelvis: Orientation | None = None
    support: dict[Side, Support] = field(default_factory=dict)
    legs: dict[Side, LegPosition] = field(default_factory=dict)
    pose: PosePosition | None = None
    contacts: dict[Side, HandContact] = field(default_factory=dict)
    facing: Facing | None = None
    place: StagePlace | None = None
    travel: Travel | None = None
    turn: Turn | None = None
    paths: dict[Limb, PathMark] = field(default_factory=dict)
    locomotion: dict[Side, Locomotion] = field(default_factory=dict)
    jump: Jump | None = None
    _claims: dict[str, Location] = field(default_factory=dict)

    def claim(self, part: str, at: Location) -> None:
        """Notes that the frame writes a part.

        Raises:
            ScoreError: It is written already, or what is written contradicts it.
        """
        earlier = self._claims.get(part)
        name = _spoken(part)
        if earlier is not None:
            raise self.reader.fail(
                f"'{name}' is already written in this frame, on line {earlier.line}; keep one", at
            )
        for other in excluded_by(part):
            earlier = self._claims.get(other)
            if earlier is not None:
                raise self.reader.fail(
                    f"'{name}' contradicts '{_spoken(other)}' on line {earlier.line}; "
                    "keep one of them",
                    at,
                )
        self._claims[part] = at

    def frame(self, beat: Fraction, at: Location) -> Frame:
        """The frame of all that was read, at a beat that stands in a line."""
        return Frame(beat=beat, at=at, **{name: getattr(self, name) for name in _PARTS})


_PARTS = tuple(each.name for each in fields(Frame) if each.name not in ("beat", "at"))


def _spoken(part: str) -> str:
    """The part as scores write it: how a leg stands is written on its leg's line."""
    return part.replace("support", "leg")
