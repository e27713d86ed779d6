"""What can't be together in a score, whatever form it is written in.

The readers of text and of JSON judge each value where they meet it; here stands what only shows
when values are seen side by side. Text has more to say about some of it (the line that contradicts)
and says it first.
"""

from __future__ import annotations

import functools
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from enpointe.notation.frame import Frame
from enpointe.notation.phrasing import Phrase, Repeat
from enpointe.notation.resolving import FLOOR_LINE
from enpointe.notation.score import Score
from enpointe.notation.signs import Bend, FloorContact, Location, Side

__all__ = ["Fault", "excluded_by", "faults", "faults_between", "frame_faults", "written_parts"]


@dataclass(frozen=True, slots=True)
class Fault:
    """Something wrong.

    Attributes:
        where: The part, such as "frames[2].jump".
        message: What is wrong and what to do.
        at: Where it was written, if it was in a text.
    """

    where: str
    message: str
    at: Location | None


@functools.cache
def excluded_by(part: str) -> tuple[str, ...]:
    """The parts that a frame can't write together with a part.

    Parts are "feet", "arms", "face", "turn", "place", "travel", and "left hand", "left elbow",
    "left foot", "left knee", "left leg" (a named position), "left support"; and of the right.
    """
    if part in _ONE_OF_TWO:
        return (_ONE_OF_TWO[part],)
    if part in ("arms", "feet"):
        kinds = ("hand", "elbow") if part == "arms" else ("foot", "leg")
        return tuple(f"{side} {kind}" for kind in kinds for side in Side)
    side, _, kind = part.partition(" ")
    whole = _WHOLES.get(kind, ())
    return (*whole, *(f"{side} {other}" for other in _SAME_LEG.get(kind, ())))


_ONE_OF_TWO = {"face": "turn", "turn": "face", "place": "travel", "travel": "place"}
_WHOLES = {"hand": ("arms",), "elbow": ("arms",), "foot": ("feet",), "leg": ("feet",)}
_SAME_LEG = {
    "leg": ("foot", "support", "knee"),
    "foot": ("leg",),
    "support": ("leg",),
    "knee": ("leg",),
}


def written_parts(frame: Frame) -> Iterator[str]:
    """The parts that a frame writes, by the names of :func:`excluded_by`."""
    for name, part in (
        ("feet", frame.feet),
        ("arms", frame.arms),
        ("face", frame.facing),
        ("turn", frame.turn),
        ("place", frame.place),
        ("travel", frame.travel),
    ):
        if part is not None:
            yield name
    for kind, signs in (
        ("hand", {**frame.hands, **frame.contacts}),
        ("elbow", frame.elbows),
        ("foot", frame.foot_signs),
        ("knee", frame.knees),
        ("leg", frame.legs),
        ("support", frame.support),
    ):
        yield from (f"{side} {kind}" for side in signs)


def faults(score: Score) -> Iterator[Fault]:
    """Everything wrong with a score whose single values are right, in order."""
    if not score.frames:
        yield Fault("frames", "the score has no frames", None)
        return
    before: Frame | None = None
    for index, frame in enumerate(score.frames):
        for fault in frame_faults(frame, before):
            yield Fault(f"frames[{index}]{fault.where}", fault.message, fault.at)
        before = frame
    yield from faults_between(score)


def faults_between(score: Score) -> Iterator[Fault]:
    """What is wrong with a score whose frames are right."""
    yield from _repeat_faults(score)
    yield from _phrase_faults(score.phrases, score.repeats)
    yield from _jump_faults(score)


def frame_faults(frame: Frame, before: Frame | None) -> Iterator[Fault]:
    """Everything wrong with one frame; `before` is the one before it, None for the first."""
    parts = set(written_parts(frame))
    for part in sorted(parts):
        for other in excluded_by(part):
            if other in parts:
                yield Fault("", f"'{part}' contradicts '{other}'; keep one of them", frame.at)
    if before is None and frame.beat != 0:
        yield Fault(".beat", "the first frame stands at beat 0, the pose to start from", frame.at)
    if before is not None and frame.beat <= before.beat:
        yield Fault(".beat", "beats go forward, each at its own moment", frame.at)
    for side in Side:
        yield from _limb_faults(frame, side)
    if before is None:
        yield from _arrival_faults(frame)
    jump = frame.jump
    if jump is not None and not jump.off < jump.on <= frame.beat:
        yield Fault(
            ".jump",
            "a jump leaves the floor before it lands, and lands at the beat of its frame or before",
            jump.at,
        )


def _limb_faults(frame: Frame, side: Side) -> Iterator[Fault]:
    hand, elbow = frame.hands.get(side), frame.elbows.get(side)
    if hand is not None and elbow is not None and hand.straight:
        yield Fault(
            f".elbows.{side}",
            f"the {side} arm can't be straight and bent at the elbow in one frame",
            elbow.at,
        )
    foot, knee = frame.foot_signs.get(side), frame.knees.get(side)
    support = frame.support.get(side)
    if support is None:
        return
    if foot is not None and foot.height != FLOOR_LINE:
        yield Fault(
            f".support.{side}",
            f"the {side} foot is written off the floor; at height 1 it can stand or touch",
            support.at,
        )
    if knee is not None and support.bend is not Bend.STRAIGHT:
        yield Fault(
            f".knees.{side}",
            f"the {side} knee has a sign and is written '{support.bend}'; keep one of them",
            knee.at,
        )
    if support.floor is FloorContact.TOUCH and support.bend is Bend.GRAND_PLIE:
        yield Fault(
            f".support.{side}",
            f"the {side} leg bears weight in a grand plié; leave out 'touching'",
            support.at,
        )


def _arrival_faults(frame: Frame) -> Iterator[Fault]:
    for name, what in (("travel", frame.travel), ("turn", frame.turn), ("jump", frame.jump)):
        if what is not None:
            yield Fault(f".{name}", f"nothing comes before beat 0; write the {name} later", what.at)
    for limb, path in frame.paths.items():
        yield Fault(f".paths.{limb}", "nothing comes before beat 0; write the path later", path.at)
    for side, line in frame.locomotion.items():
        yield Fault(
            f".locomotion.{side}", "nothing comes before beat 0; write the step later", line.at
        )


def _repeat_faults(score: Score) -> Iterator[Fault]:
    end = score.frames[-1].beat
    free = Fraction(0)
    for index, repeat in enumerate(score.repeats):
        where = f"repeats[{index}]"
        last = repeat.last
        if not 1 <= repeat.first <= last:
            yield Fault(where, "the counts go forward, from 1 at least", repeat.at)
        if repeat.endings:
            if len(repeat.endings) != 2:
                yield Fault(where, "write both a first and a second ending", repeat.at)
                continue
            (start, stop), (again, last) = repeat.endings
            if not (repeat.first < start <= stop == repeat.last < again == stop + 1 <= last):
                yield Fault(
                    where,
                    "the first ending closes the repeated counts, and the second follows right "
                    f"after them: 'first ending ... to {repeat.last}, "
                    f"second ending {repeat.last + 1} to ...'",
                    repeat.at,
                )
                continue
        if repeat.start < free:
            yield Fault(where, "repeats stand one after another, none over another", repeat.at)
        if last > end:
            yield Fault(where, f"the score ends at beat {end}, before count {last}", repeat.at)
        free = Fraction(last)


def _phrase_faults(phrases: Sequence[Phrase], repeats: Sequence[Repeat]) -> Iterator[Fault]:
    free = Fraction(0)
    cuts = sorted(
        {repeat.start for repeat in repeats}
        | {repeat.end for repeat in repeats}
        | {Fraction(repeat.endings[0][0] - 1) for repeat in repeats if repeat.endings}
    )
    for index, phrase in enumerate(phrases):
        where = f"phrases[{index}]"
        if not 1 <= phrase.first <= phrase.last:
            yield Fault(where, "the counts go forward, from 1 at least", phrase.at)
        elif phrase.start < free:
            yield Fault(where, "phrases stand in order, none over another", phrase.at)
        if phrase.effort is None and phrase.tempo_end is None and phrase.name is None:
            yield Fault(where, "the phrase says nothing; give it a quality or a name", phrase.at)
        if _cut(phrase.start, phrase.end, cuts):
            yield Fault(
                where,
                "a repeat or an ending begins or ends within this phrase; "
                "end the phrase there and write another",
                phrase.at,
            )
        free = phrase.end


def _cut(start: Fraction, end: Fraction, cuts: Sequence[Fraction]) -> bool:
    """Whether any of the cuts, in order, is between start and end."""
    index = bisect_right(cuts, start)
    return index < len(cuts) and cuts[index] < end


def _jump_faults(score: Score) -> Iterator[Fault]:
    landed = Fraction(0)
    cuts = sorted({cut for repeat in score.repeats for cut in (repeat.start, repeat.end)})
    for index, frame in enumerate(score.frames):
        if frame.jump is None:
            continue
        where = f"frames[{index}].jump"
        if frame.jump.off < landed:
            yield Fault(
                where, "this jump leaves the floor before the last one lands", frame.jump.at
            )
        if _cut(frame.jump.off, frame.beat, cuts):
            yield Fault(
                where,
                "a repeat begins or ends during this jump; let it leave the floor after that",
                frame.jump.at,
            )
        landed = frame.jump.on
