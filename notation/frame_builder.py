"""Builds one frame from the lines under its beat."""

from __future__ import annotations

from fractions import Fraction

from lark import Token, Tree

from enpointe.notation.amounts import DEFAULT_DEGREES, MAX_DEGREES
from enpointe.notation.check import frame_faults
from enpointe.notation.draft import Draft
from enpointe.notation.frame import Frame
from enpointe.notation.limb_lines import read_leg, read_limb, read_path, read_stance
from enpointe.notation.macros import Vocabulary, laid_under
from enpointe.notation.mirror import mirrored
from enpointe.notation.movement import Limb
from enpointe.notation.numerals import number
from enpointe.notation.reading import (
    Reader,
    location,
    side_of,
    token_of,
    tokens_of,
    trees_of,
    words_of,
)
from enpointe.notation.signs import (
    ArmsPosition,
    FeetPosition,
    Location,
    Orientation,
    PosePosition,
    Side,
)
from enpointe.notation.spelling import fold
from enpointe.notation.stage_lines import (
    read_face,
    read_jump,
    read_place,
    read_travel,
    read_turn,
)
from enpointe.notation.vocabulary import (
    Part,
    find_arms,
    find_feet,
    find_pose,
    names,
    nearest,
)
from enpointe.notation.wording import either

__all__ = ["FrameBuilder"]


class FrameBuilder:
    """Gathers the lines of one frame.

    Args:
        reader: Refuses what is wrong.
        vocabulary: The user's own names.
    """

    def __init__(self, reader: Reader, vocabulary: Vocabulary) -> None:
        self._reader = reader
        self._vocabulary = vocabulary
        self._draft = Draft(reader)
        self._under: Frame | None = None

    def add(self, line: Tree[Token]) -> None:
        """Takes one parsed line.

        Raises:
            ScoreError: The line is wrong in itself or contradicts an earlier one.
        """
        kind = str(line.data)
        if kind in _LINES:
            _LINES[kind](self._draft, line)
        else:
            getattr(self, f"_read_{kind}")(line)

    def frame(self, beat: Fraction, at: Location, before: Frame | None) -> Frame:
        """The frame of all lines taken; `before` is the one before it, None for the first.

        Raises:
            ScoreError: Its parts contradict each other.
        """
        frame = self._draft.frame(beat, at)
        if self._under is not None:
            frame = laid_under(self._under, frame)
        for fault in frame_faults(frame, before):
            raise self._reader.fail(fault.message, fault.at or at)
        return frame

    def _unknown(self, text: str, part: Part, at: Token) -> Exception:
        close = (*self._vocabulary.nearest(text, part), *nearest(text, part))[:3]
        hint = f"did you mean {either(close)}?" if close else f"known are {', '.join(names(part))}"
        whole = "the whole body" if part == "pose" else f"the {part}"
        return self._reader.fail(f"'{text[:60]}' is not a position of {whole}; {hint}", at)

    def _read_feet(self, line: Tree[Token]) -> None:
        keyword, side = tokens_of(line)[0], token_of(line, "SIDE")
        name, *items = trees_of(line)
        first = tokens_of(name)[0]
        self._draft.claim("feet", location(keyword))
        words = words_of(name).split()
        is_open = len(words) > 1 and fold(words[-1]) in ("open", "ouverte")
        closed = len(words) > 1 and fold(words[-1]) in ("closed", "croisee")
        text = " ".join(words[:-1] if is_open or closed else words)
        entry = find_feet(text)
        if entry is None:
            raise self._unknown(text, "feet", first)
        if (is_open or closed) and not entry.has_open:
            raise self._reader.fail(
                f"{entry.name} position has no open or closed form; write only '{entry.name}'",
                first,
            )
        if entry.crossed and side is None:
            raise self._reader.fail(
                f"{entry.name} position of the feet needs the foot in front; "
                f"write '{entry.name} right front' or '{entry.name} left front'",
                first,
            )
        if not entry.crossed and side is not None:
            raise self._reader.fail(
                f"in {entry.name} position no foot is in front; write only '{entry.name}'", side
            )
        front = side_of(side) if side else None
        self._draft.feet = FeetPosition(entry.name, front, is_open, location(first))
        if items:
            self._read_stances(items, location(keyword))

    def _read_stances(self, items: list[Tree[Token]], at: Location) -> None:
        stance = read_stance(self._draft, items, at)
        if stance is None:
            token = tokens_of(items[0])[0]
            raise self._reader.fail(
                f"'{words_of(items[0])[:60]}' is not a way for both feet to stand; write a bend "
                "such as 'demi-plié' or a contact such as 'demi-pointe'",
                token,
            )
        for side in Side:
            self._draft.claim(f"{side} support", at)
            self._draft.support[side] = stance

    def _read_arms(self, line: Tree[Token]) -> None:
        keyword, side = tokens_of(line)[0], token_of(line, "SIDE")
        name, *paths = trees_of(line)
        text, first = words_of(name), tokens_of(name)[0]
        self._draft.claim("arms", location(keyword))
        for node in paths:
            path = read_path(self._draft, node)
            for each in Side:
                self._draft.claim(f"path of the {each} hand", location(keyword))
                self._draft.paths[Limb.of(each, "hand")] = path
        macro = self._vocabulary.find(text, "arms")
        if macro is not None:
            frame = mirrored(macro) if side and side_of(side) is Side.LEFT else macro
            self._draft.hands.update(frame.hands)
            self._draft.elbows.update(frame.elbows)
            self._draft.contacts.update(frame.contacts)
            return
        entry = find_arms(text)
        if entry is None:
            raise self._unknown(text, "arms", first)
        if entry.needs_leading and side is None:
            raise self._reader.fail(
                f"'{entry.name}' needs the arm that leads ({entry.description}); "
                f"write '{entry.name} right leads' or '{entry.name} left leads'",
                first,
            )
        if not entry.needs_leading and side is not None:
            raise self._reader.fail(
                f"in '{entry.name}' both arms do the same; leave out '{side}'", side
            )
        leading = side_of(side) if side else None
        self._draft.arms = ArmsPosition(entry.name, leading, location(first))

    def _read_leg(self, line: Tree[Token]) -> None:
        keyword = tokens_of(line)[0]
        side = side_of(keyword)
        macro = self._vocabulary.find(words_of(next(trees_of(line))), "leg")
        if macro is None:
            read_leg(self._draft, line)
            return
        frame = macro if side is Side.RIGHT else mirrored(macro)
        self._draft.claim(f"{side} leg", location(keyword))
        self._draft.foot_signs.update(frame.foot_signs)
        self._draft.knees.update(frame.knees)
        self._draft.support.update(frame.support)

    def _read_pose(self, line: Tree[Token]) -> None:
        keyword, side = tokens_of(line)[0], token_of(line, "SIDE")
        name = next(trees_of(line))
        text, first = words_of(name), tokens_of(name)[0]
        self._draft.claim("pose", location(keyword))
        macro = self._vocabulary.find(text, "pose")
        if macro is not None:
            left = side is not None and side_of(side) is Side.LEFT
            self._under = mirrored(macro) if left else macro
            return
        entry = find_pose(text)
        if entry is None:
            raise self._unknown(text, "pose", first)
        if side is None:
            raise self._reader.fail(
                f"'{entry.name}' needs the leg to stand on; "
                f"write '{entry.name} on left' or '{entry.name} on right'",
                first,
            )
        self._draft.pose = PosePosition(entry.name, side_of(side), location(first))

    def _read_orientation(self, line: Tree[Token]) -> None:
        keyword = tokens_of(line)[0]
        part = str(keyword.lower())
        self._draft.claim(part, location(keyword))
        amounts: dict[str, float] = {}
        for item in trees_of(line):
            tokens = tokens_of(item)
            bend = item.data == "bend"
            kind = "bend" if bend else str(tokens[0].lower())
            direction, *amount = tokens if bend else tokens[1:]
            if kind in amounts:
                raise self._reader.fail(
                    f"the {kind} of the {part} is written twice; keep one", tokens[0]
                )
            degrees = self._degrees(amount[0]) if amount else DEFAULT_DEGREES[part, kind]
            amounts[kind] = degrees if direction.lower() in ("left", "forward") else 0.0 - degrees
        orientation = Orientation(
            amounts.get("turn", 0.0),
            amounts.get("tilt", 0.0),
            amounts.get("bend", 0.0),
            location(keyword),
        )
        setattr(self._draft, part, orientation)

    def _degrees(self, token: Token) -> float:
        value = number(str(token))
        if value is None or not 0.0 <= value <= MAX_DEGREES:
            raise self._reader.fail(
                f"'{token[:40]}' is not an amount; write degrees from 0 to {MAX_DEGREES:g}, "
                "with the direction in words",
                token,
            )
        return value


_LINES = {
    "limb": read_limb,
    "face": read_face,
    "place": read_place,
    "travel": read_travel,
    "turn": read_turn,
    "jump": read_jump,
}
