"""Hypothesis strategies for scores: whatever they draw can be written, read and resolved."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import TypeVar

from hypothesis import strategies as st

from enpointe.notation import (
    ArmsPosition,
    Bend,
    BodyPlace,
    Depth,
    Facing,
    FeetPosition,
    FloorContact,
    Frame,
    HandContact,
    Jump,
    LegPosition,
    Limb,
    Locomotion,
    Orientation,
    PathKind,
    PathMark,
    Phrase,
    PosePosition,
    Repeat,
    Score,
    Side,
    Sign,
    StagePlace,
    StepKind,
    Support,
    Travel,
    Turn,
    Via,
)
from enpointe.notation.phrasing import EFFORT_FACTORS, EFFORTS, effort_text
from enpointe.notation.tempo import TEMPO_WORDS
from enpointe.notation.vocabulary import ARMS, FEET, LEGS, POSES

Value = TypeVar("Value")


def amounts(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers in a range, without a negative zero."""
    return st.floats(low, high).map(lambda value: value + 0.0)


sides = st.sampled_from(Side)
rotations = amounts(-90, 90)
orientations = st.builds(Orientation, turn=rotations, tilt=rotations, bend=rotations)
feet = st.sampled_from(FEET).flatmap(
    lambda entry: st.builds(
        FeetPosition,
        st.just(entry.name),
        sides if entry.crossed else st.none(),
        st.booleans() if entry.has_open else st.just(False),
    )
)
arms = st.sampled_from(ARMS).flatmap(
    lambda entry: st.builds(
        ArmsPosition, st.just(entry.name), sides if entry.needs_leading else st.none()
    )
)
legs = st.sampled_from(LEGS).flatmap(
    lambda entry: st.builds(
        LegPosition,
        st.just(entry.name),
        st.sampled_from(entry.directions),
        amounts(entry.degrees[0], entry.degrees[2]) if entry.degrees else st.none(),
    )
)
poses = st.builds(PosePosition, st.sampled_from([entry.name for entry in POSES]), sides)
supports = st.builds(Support, st.sampled_from(FloorContact), st.sampled_from(Bend)).filter(
    lambda stance: stance.bears or stance.bend is not Bend.GRAND_PLIE
)
contacts = st.builds(HandContact, st.sampled_from(BodyPlace))
bearings = amounts(-180, 180) | st.sampled_from([-135.0, -45.0, 0.0, 45.0, 90.0, 180.0])
places = st.builds(StagePlace, amounts(-50, 50), amounts(-50, 50))
travels = st.builds(Travel, bearings, amounts(0, 50), st.just(0.0) | amounts(-360, 360))
turns = st.builds(Turn, st.floats(0, 3600, exclude_min=True), sides)
paths = st.builds(PathMark, st.sampled_from(PathKind), st.none() | st.sampled_from(Via))
steps = st.builds(Locomotion, st.sampled_from(StepKind))
efforts = (
    st.none()
    | st.sampled_from(EFFORTS)
    | st.fixed_dictionaries(
        {}, optional={name: amounts(*ends) for name, ends in EFFORT_FACTORS.items()}
    ).map(lambda factors: effort_text(factors) or None)
)
words = st.text(st.characters(exclude_categories=("Cc", "Cs")), min_size=1, max_size=200).filter(
    lambda text: text.strip() != ""
)
beat_steps = st.sampled_from([Fraction(1, parts) for parts in (1, 1, 1, 2, 3, 4, 6, 12)])


def signs(straight: bool = False) -> st.SearchStrategy[Sign]:
    """Signs within the stave; straight arms among them if asked for."""
    return st.builds(
        Sign,
        width=st.floats(-1, 1),
        height=st.floats(1, 6),
        depth=st.sampled_from(Depth),
        straight=st.booleans() if straight else st.just(False),
    )


def some(values: st.SearchStrategy[Value]) -> st.SearchStrategy[dict[Side, Value]]:
    """Neither side, one or both."""
    return st.dictionaries(sides, values, max_size=2)


def maybe(values: st.SearchStrategy[Value]) -> st.SearchStrategy[Value | None]:
    """A value, or nothing written."""
    return st.none() | values


flags = st.booleans()
plain_signs, hand_signs = signs(), signs(straight=True)
some_signs, some_hands = some(plain_signs), some(hand_signs)
some_contacts, some_legs = some(contacts), some(legs)
some_supports, some_steps = some(supports), some(steps)
some_paths = st.dictionaries(st.sampled_from(Limb), paths, max_size=4)
maybe_oriented, maybe_posed = maybe(orientations), maybe(poses)
maybe_placed, maybe_travelled, maybe_turned = maybe(places), maybe(travels), maybe(turns)
maybe_facing = maybe(st.builds(Facing, bearings))


@st.composite
def _arms_of(draw: st.DrawFn, first: bool) -> Frame:
    """The arms of a frame: a name, or signs; of the first frame, both."""
    if draw(flags):
        return Frame(Fraction(0), arms=draw(arms))
    hands = draw(some_hands)
    touching = draw(some_contacts)
    if first:
        hands |= {side: draw(plain_signs) for side in Side if side not in {**hands, **touching}}
    straight = {side for side, sign in hands.items() if sign.straight}
    elbows = {side: sign for side, sign in draw(some_signs).items() if side not in straight}
    return Frame(Fraction(0), hands=hands, contacts=touching, elbows=elbows)


@st.composite
def _legs_of(draw: st.DrawFn, first: bool) -> Frame:
    """The legs of a frame: a name for both feet, or for each leg a name, signs or a stance."""
    if draw(flags):
        frame = Frame(Fraction(0), feet=draw(feet), support=draw(some_supports))
    else:
        working = draw(some_legs)
        foot_signs = {s: v for s, v in draw(some_signs).items() if s not in working}
        floor = {s: replace(v, height=1.0) for s, v in foot_signs.items() if draw(flags)}
        foot_signs |= floor
        standing = {
            side: stance
            for side, stance in draw(some_supports).items()
            if side not in working and side not in foot_signs.keys() - floor.keys()
        }
        if first:
            missing = [side for side in Side if side not in {*working, *foot_signs, *standing}]
            standing |= {side: draw(supports) for side in missing}
        frame = Frame(Fraction(0), legs=working, foot_signs=foot_signs, support=standing)
    knees = {
        side: sign
        for side, sign in draw(some_signs).items()
        if side not in frame.legs
        and (side not in frame.support or frame.support[side].bend is Bend.STRAIGHT)
    }
    return replace(frame, knees=knees)


@st.composite
def frames(draw: st.DrawFn, beat: Fraction, before: Fraction | None = None) -> Frame:
    """A frame without contradictions; without one before it, it gives all limbs."""
    first = before is None
    upper, lower = draw(_arms_of(first)), draw(_legs_of(first))
    turn = None if first else draw(maybe_turned)
    travel = None if first else draw(maybe_travelled)
    jump = None
    if before is not None and draw(flags):
        jump = Jump(before, draw(st.sampled_from([beat, (before + beat) / 2])))
        if jump.on.denominator > 96:
            jump = Jump(before, beat)
    return replace(
        lower,
        beat=beat,
        arms=upper.arms,
        hands=upper.hands,
        elbows=upper.elbows,
        contacts=upper.contacts,
        head=draw(maybe_oriented),
        body=draw(maybe_oriented),
        pelvis=draw(maybe_oriented),
        pose=draw(maybe_posed),
        facing=draw(maybe_facing) if turn is None else None,
        turn=turn,
        place=draw(maybe_placed) if travel is None else None,
        travel=travel,
        paths={} if first else draw(some_paths),
        locomotion={} if first else draw(some_steps),
        jump=jump,
    )


@st.composite
def _repeats(draw: st.DrawFn, counts: int) -> tuple[Repeat, ...]:
    """Repeats one after another within so many counts."""
    found: list[Repeat] = []
    free = 1
    while free <= counts and draw(flags):
        first = draw(st.integers(free, counts))
        last = draw(st.integers(first, counts))
        end = last
        endings: tuple[tuple[int, int], ...] = ()
        if first < last < counts and draw(flags):
            end = draw(st.integers(last + 1, counts))
            endings = ((draw(st.integers(first + 1, last)), last), (last + 1, end))
        times, other_side = draw(st.integers(1, 4)), draw(flags)
        found.append(Repeat(first, last, times, other_side, endings))
        free = end + 1
    return tuple(found)


@st.composite
def _phrases(draw: st.DrawFn, repeats: tuple[Repeat, ...]) -> tuple[Phrase, ...]:
    """Phrases in order that no repeat cuts."""
    cuts = {cut for each in repeats for cut in (each.first, each.last + 1)}
    cuts |= {each.endings[0][0] for each in repeats if each.endings}
    found: list[Phrase] = []
    first = 1
    for _ in range(draw(st.integers(0, 3))):
        first += draw(st.integers(0, 3))
        last = first + draw(st.integers(0, 5))
        last = min([last, *(cut - 1 for cut in cuts if cut > first)])
        change = draw(st.none() | amounts(0.1, 10).filter(lambda factor: factor != 1))
        effort = draw(efforts)
        name = draw(words if change is None and effort is None else st.none() | words)
        found.append(Phrase(first, last, effort, change, name))
        first = last + 1
    return tuple(found)


@st.composite
def scores(draw: st.DrawFn, max_frames: int = 4) -> Score:
    """A whole valid score."""
    drawn = [draw(frames(Fraction(0)))]
    for step in draw(st.lists(beat_steps, max_size=max_frames - 1)):
        beat = drawn[-1].beat + step
        drawn.append(draw(frames(beat, drawn[-1].beat)))
    metre = (draw(st.integers(1, 32)), draw(st.sampled_from((1, 2, 4, 8, 16))))
    repeats = draw(_repeats(int(drawn[-1].beat)))
    score = Score(
        title=draw(words),
        method=draw(words),
        metre=metre,
        tempo=draw(st.floats(1, 250)),
        frames=tuple(drawn),
        tempo_word=draw(st.none() | st.sampled_from([*TEMPO_WORDS, "Tempo di valse", "l'istesso"])),
        pickup=draw(
            st.just(Fraction(0))
            | st.fractions(0, metre[0], max_denominator=4).filter(lambda pulses: pulses < metre[0])
        ),
        repeats=repeats,
        phrases=draw(_phrases(repeats)),
    )
    return replace(score, frames=tuple(_uncut(frame, score) for frame in score.frames))


def _uncut(frame: Frame, score: Score) -> Frame:
    """Without a jump that a repeat begins or ends in."""
    cuts = {cut for each in score.repeats for cut in (each.start, each.end)}
    jump = frame.jump
    if jump is not None and any(jump.off < cut < frame.beat for cut in cuts):
        return replace(frame, jump=None)
    return frame
