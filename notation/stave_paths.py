"""Movement lines within a frame, and locomotion lines from one frame to the next."""

from __future__ import annotations

import math
from collections.abc import Iterator

from enpointe.notation.movement import Limb, PathKind, PathMark, StepKind
from enpointe.notation.stave_ink import Mark, Point, between, glyph

__all__ = ["locomotion_line", "movement_line"]

_STOP = 0.36
"""How far from the middle of the sign a movement line ends, in stave spaces."""

_START = 0.08
_SHORTEST = 0.25
_HIPS_AND_SHOULDERS = {"hand": 1.0, "foot": 2.0}
_NARROWEST = 0.3
_APART = 0.1


def movement_line(limb: Limb, path: PathMark, old: Point, new: Point) -> Iterator[Mark]:
    """The line from the old place of a hand or foot to the new one, with its tick.

    Args:
        limb: Whose path it is; an arc bulges away from the shoulders or hips.
        path: The path as written.
        old: The place of the sign in the frame before.
        new: The place of the sign in this frame.

    Yields:
        The line, unless the two places are the same, and the tick of what it passes through.
    """
    dx, dy = new[0] - old[0], new[1] - old[1]
    length = math.hypot(dx, dy)
    middle = ((old[0] + new[0]) / 2, (old[1] + new[1]) / 2)
    angle = math.degrees(math.atan2(-dy, dx))
    if length > _START + _STOP + _SHORTEST:
        ux, uy = dx / length, dy / length
        start = (old[0] + _START * ux, old[1] + _START * uy)
        end = (new[0] - _STOP * ux, new[1] - _STOP * uy)
        pivot = (0.0, _HIPS_AND_SHOULDERS[limb.kind])
        # To the left of the way, which is where the table's arc bulges.
        left = (uy, -ux)
        away = (middle[0] - pivot[0]) * left[0] + (middle[1] - pivot[1]) * left[1]
        flip = path.kind is PathKind.CIRCULAR and away < 0
        mark = between(f"path {path.kind}", start, end, flip)
        yield mark
        if path.kind is PathKind.CIRCULAR:
            bulge = 0.195 * math.dist(start, end) * (-1.0 if flip else 1.0)
            centre = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
            middle = (centre[0] + bulge * left[0], centre[1] + bulge * left[1])
        else:
            middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
    else:
        # Nothing to draw a line along: the tick stands above the sign.
        middle, angle = (new[0], new[1] - 0.62), 0.0
    if path.via is not None:
        yield glyph(f"via {path.via}", *middle, angle)


def locomotion_line(kind: str, start: float, end: float, floor: float) -> Mark:
    """A line between the feet of two frames.

    Args:
        kind: "steps", "slides" or "jumps".
        start: x of the foot that is left.
        end: x of the foot that is reached.
        floor: y of the floor line.
    """
    if kind != StepKind.JUMP:
        # A step is clear of the signs that it links, a slide of the slide that follows.
        stop = _STOP if kind == StepKind.STEP else _APART
        way = 1.0 if end > start else -1.0
        start, end = start + way * stop, end - way * stop
        if (end - start) * way < 0:
            start = end = (start + end) / 2
    if abs(end - start) < _NARROWEST:
        middle = (start + end) / 2
        start, end = middle - _NARROWEST / 2, middle + _NARROWEST / 2
    return between(f"locomotion {kind}", (start, floor), (end, floor))
