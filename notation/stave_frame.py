"""One frame on the stave: which signs stand where, so that none hides another.

Places are in stave spaces from the frame's centre line (x, the dancer's right to the right) and
from the top line of the stave (y down), so that the floor line is at y = 4. Only what a frame
writes is drawn; a named position is drawn by the signs that it stands for.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from enpointe.notation.frame import Frame, ResolvedFrame, ResolvedLeg
from enpointe.notation.glyphs import FEET_APART, GLYPHS, extremity, joint, orientation
from enpointe.notation.movement import Limb
from enpointe.notation.resolving import overlaid
from enpointe.notation.signs import Bend, Depth, FloorContact, Side, Sign, Support
from enpointe.notation.stave_ink import Box, Mark, Point, glyph, line, pieces, union
from enpointe.notation.stave_paths import movement_line
from enpointe.notation.vocabulary import feet_signs, pose_frame

__all__ = ["FLOOR", "REACH", "frame_marks", "spot", "written"]

REACH = 2.0
"""Stave spaces of a limb stretched to the side, width 1 (the frame is about as wide as high)."""

FLOOR = 4.0
LINE = 0.05
"""Thickness of a stave line."""

_AIR = 0.22
_GAP = 0.06
_CLEAR = 0.14
_WIDEST = 0.4
_SETTLED_STEP = 0.09
_LEADER = 1.0
_KNEES: Mapping[Bend, tuple[float, float]] = {
    Bend.DEMI_PLIE: (0.55, FLOOR - 0.78),
    Bend.GRAND_PLIE: (0.95, FLOOR - 0.5),
}
"""How far out from its foot, and where from the top line, the knee of a plié is drawn: the knees of
a plié go down and out from the centre line (Ballet Alert 11260); the figures are ours."""


@dataclass(frozen=True, slots=True)
class _Group:
    """Marks that stay together, and where they may go to make room."""

    marks: tuple[Mark, ...]
    ways: tuple[float, ...] = ()
    led: bool = False

    @property
    def box(self) -> Box:
        return union(mark.box for mark in self.marks)

    def moved(self, dx: float) -> _Group:
        return _Group(tuple(mark.moved(dx, 0.0) for mark in self.marks), self.ways, self.led)


def _outward(side: Side) -> float:
    return 1.0 if side is Side.RIGHT else -1.0


def _reach(name: str) -> float:
    """How far a sign stands up (and down) from its place."""
    box = glyph(name, 0.0, 0.0).box
    return max(-box.top, box.bottom)


def spot(limb: Limb, frame: ResolvedFrame) -> Point:
    """Where the sign of a hand or foot stands, or would if it were written."""
    if limb.kind == "hand":
        return _place(frame.arms[limb.side].wrist, limb.side)
    return _foot_place(frame.legs[limb.side], limb.side, _alone(frame, limb.side))


def _alone(frame: ResolvedFrame, side: Side) -> bool:
    return frame.legs[side.other].position is None


def _place(sign: Sign, side: Side) -> Point:
    return _outward(side) * sign.width * REACH, FLOOR + 1.0 - sign.height


def _foot_place(leg: ResolvedLeg, side: Side, alone: bool) -> Point:
    sign, x = _foot_sign(leg, side, alone)
    if leg.support is not None:
        return x, FLOOR + _standing(leg.support, extremity(sign.depth))
    clear = FLOOR - 2.0 * _reach("front") - _AIR
    return x, min(FLOOR + 1.0 - sign.height, clear)


def _foot_sign(leg: ResolvedLeg, side: Side, alone: bool) -> tuple[Sign, float]:
    """The sign of a foot and how far it stands from the centre line.

    A foot that the other has left `alone` in a named position is neither in front nor behind.
    """
    if leg.foot is not None:
        return leg.foot, _outward(side) * leg.foot.width * REACH
    assert leg.position is not None
    form = f"{leg.position.name} open" if leg.position.open else leg.position.name
    sign = feet_signs(leg.position)[side]
    if alone:
        sign = replace(sign, depth=Depth.LEVEL)
    return sign, _outward(side) * FEET_APART[form]


def _standing(support: Support, name: str) -> float:
    """How far below the floor line the sign of a foot on the floor is centred."""
    way = GLYPHS[f"floor {support.floor}"].floor or 0
    return way * (_reach(name) + LINE / 2)


def written(frame: Frame) -> Frame:
    """What a frame writes, its named pose taken apart into its limbs."""
    return frame if frame.pose is None else overlaid(pose_frame(frame.pose, frame), frame)


def frame_marks(
    frame: Frame, resolved: ResolvedFrame, before: ResolvedFrame | None
) -> tuple[Mark, ...]:
    """The signs in the stave that a frame writes.

    Args:
        frame: What it writes, as :func:`written` gives it.
        resolved: The same frame with all filled in.
        before: The frame before, where movement lines start; None for the first.

    Returns:
        The marks, x from the frame's centre line, y from the top line. Signs keep to their own side
        of the centre line unless they are crossed; those of head, body and pelvis give way to the
        limbs', with a leader to their place if they go far.
    """
    limbs = [*_feet(frame, resolved), *_hands(frame, resolved), *_bends(frame, resolved)]
    paths = [] if before is None else list(_paths(frame, resolved, before))
    on_the_way = [box for mark in paths for box in pieces(mark)]
    settled = _settle([*limbs, *_orientations(frame)], on_the_way)
    return (*(mark for group in settled for mark in group.marks), *paths)


def _hands(frame: Frame, resolved: ResolvedFrame) -> list[_Group]:
    groups: dict[Side, _Group] = {}
    whole = frame.arms is not None
    for side in Side:
        if not (whole or side in frame.hands or side in frame.contacts):
            continue
        sign = resolved.arms[side].wrist
        x, y = _place(sign, side)
        marks = [glyph(extremity(sign.depth), x, y, limb=f"{side} hand")]
        if sign.width < 0:
            marks.append(glyph(f"crossed {side}", x, y))
        if sign.straight:
            marks.append(glyph("straight", x, y))
        if side in resolved.contacts:
            marks.append(glyph(f"contact {side}", x, y))
        groups[side] = _Group(tuple(marks), _ways(side, sign.width < 0))
    if len(groups) < len(Side) or any(arm.wrist.width < 0 for arm in resolved.arms.values()):
        return list(groups.values())
    return list(_apart(groups[Side.LEFT], groups[Side.RIGHT]))


def _feet(frame: Frame, resolved: ResolvedFrame) -> Iterator[_Group]:
    whole = frame.feet is not None
    moved = [
        side
        for side in Side
        if whole or side in frame.foot_signs or side in frame.legs or side in frame.support
    ]
    together: list[Mark] = []
    apart: list[_Group] = []
    for side in moved:
        leg = resolved.legs[side]
        sign, _ = _foot_sign(leg, side, _alone(resolved, side))
        x, y = _foot_place(leg, side, _alone(resolved, side))
        marks = [glyph(extremity(sign.depth), x, y, limb=f"{side} foot")]
        if leg.support is not None and leg.support.floor is FloorContact.TOUCH:
            ring = glyph("floor touching", x, 0.0)
            marks.append(ring.moved(0.0, FLOOR + LINE / 2 - ring.box.top + 0.02))
        if sign.width < 0:
            marks.append(glyph(f"crossed {side}", x, y))
        if leg.position is not None:
            together += marks
        else:
            apart.append(_Group(tuple(marks), _ways(side, sign.width < 0)))
    if together:
        yield _Group(tuple(together))
    yield from apart


def _bends(frame: Frame, resolved: ResolvedFrame) -> Iterator[_Group]:
    for side in Side:
        elbow = resolved.arms[side].elbow
        moved = side in frame.hands or side in frame.elbows or side in frame.contacts
        if elbow is not None and (frame.arms is not None or moved):
            x, y = _place(elbow, side)
            yield _Group(
                (glyph(joint(elbow.depth), x, y, limb=f"{side} elbow"),),
                _ways(side, elbow.width < 0),
            )
    for side in Side:
        leg = resolved.legs[side]
        moved = (
            frame.feet is not None
            or side in frame.foot_signs
            or side in frame.legs
            or side in frame.support
            or side in frame.knees
        )
        if moved and leg.knee is not None:
            x, y = _place(leg.knee, side)
            yield _Group(
                (glyph(joint(leg.knee.depth), x, y, limb=f"{side} knee"),),
                _ways(side, leg.knee.width < 0),
            )
        elif moved and leg.support is not None and leg.support.bend in _KNEES:
            out, y = _KNEES[leg.support.bend]
            x = spot(Limb.of(side, "foot"), resolved)[0] + _outward(side) * out
            yield _Group((glyph("bend level", x, y, limb=f"{side} knee"),), _ways(side, False))


def _ways(side: Side, across: bool) -> tuple[float, ...]:
    """Where a limb's sign may go: outward on its own side, or further across."""
    way = _outward(side) * (-1.0 if across else 1.0)
    return tuple(way * _SETTLED_STEP * step for step in range(1, 16))


def _orientations(frame: Frame) -> Iterator[_Group]:
    for space, part in enumerate((frame.head, frame.body, frame.pelvis)):
        if part is None:
            continue
        marks = tuple(glyph(name, dx, space + 0.5 + dy) for name, dx, dy in orientation(part))
        aside = [sign * 0.12 * step for step in range(1, 30) for sign in (1.0, -1.0)]
        yield _Group(marks, tuple(aside), led=True)


def _settle(groups: Iterable[_Group], on_the_way: Sequence[Box]) -> list[_Group]:
    """Each in turn at its home, or at the nearest place that is free.

    Signs of head, body and pelvis keep clear of the movement lines too.
    """
    settled: list[_Group] = []
    for group in groups:
        taken = [mark.box for each in settled for mark in each.marks]
        avoid = [*taken, *on_the_way] if group.led else taken
        gap = _CLEAR if group.led else _GAP

        def free(there: _Group, avoid: Sequence[Box] = avoid, gap: float = gap) -> bool:
            return not any(mark.box.touches(box, gap) for mark in there.marks for box in avoid)

        choices = (group.moved(dx) for dx in (0.0, *group.ways))
        place = next((there for there in choices if free(there)), group)
        settled.append(_led(place, group, taken) if group.led else place)
    return settled


def _apart(left: _Group, right: _Group) -> tuple[_Group, _Group]:
    """Two signs of either side that would stand on each other, each moved out as far."""
    overlap = left.box.right + _GAP - right.box.left
    if overlap <= 0 or not left.box.touches(right.box, _GAP, _GAP) or overlap > 2 * _WIDEST:
        return left, right
    return left.moved(-overlap / 2), right.moved(overlap / 2)


def _led(place: _Group, group: _Group, taken: Sequence[Box]) -> _Group:
    """With a thin line towards its place in the middle, if it had to go far."""
    shift = place.box.left - group.box.left
    if abs(shift) < _LEADER:
        return place
    box, y = place.box, (group.box.top + group.box.bottom) / 2
    way = 1.0 if shift > 0 else -1.0
    near = box.left - 0.06 if way > 0 else box.right + 0.06
    blocking = [
        edge
        for other in taken
        if other.top < y < other.bottom
        for edge in ((other.right + 0.06) if way > 0 else (other.left - 0.06),)
        if (edge - near) * way < 0 and edge * way > 0
    ]
    stop = max(blocking, key=lambda edge: edge * way, default=0.0)
    if (near - stop) * way < 0.08:
        return place
    return _Group((*place.marks, line("leader", near, y, stop, y, 0.03)))


def _paths(frame: Frame, resolved: ResolvedFrame, before: ResolvedFrame) -> Iterator[Mark]:
    for limb, path in frame.paths.items():
        yield from movement_line(limb, path, spot(limb, before), spot(limb, resolved))
