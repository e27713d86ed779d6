"""Reads one frame of the JSON form."""

from __future__ import annotations

from enpointe.notation.amounts import (
    HEIGHTS,
    MAX_CURVE,
    MAX_DEGREES,
    MAX_METRES,
    MAX_TURN,
    WIDTHS,
)
from enpointe.notation.frame import Frame
from enpointe.notation.json_values import Node
from enpointe.notation.movement import (
    Jump,
    Limb,
    Locomotion,
    PathKind,
    PathMark,
    StepKind,
    Via,
)
from enpointe.notation.signs import (
    ArmsPosition,
    Bend,
    BodyPlace,
    Depth,
    Direction,
    FeetPosition,
    FloorContact,
    HandContact,
    LegPosition,
    Orientation,
    PosePosition,
    Side,
    Sign,
    Support,
)
from enpointe.notation.stage import Facing, StagePlace, Travel, Turn
from enpointe.notation.vocabulary import find_arms, find_feet, find_leg, find_pose

__all__ = ["read_frame"]

_NAME = 80


def read_frame(node: Node) -> Frame:
    """A frame.

    Raises:
        ScoreError: A value is missing, of the wrong kind, out of range or unknown.
    """

    def sides(key: str, read):  # type: ignore[no-untyped-def]
        child = node.get(key)
        return {} if child is None else child.sides(read)

    def part(key: str, read):  # type: ignore[no-untyped-def]
        child = node.get(key)
        return None if child is None else read(child)

    frame = Frame(
        beat=node.need("beat").beat(),
    )
    node.done()
    return frame
