"""Hypothesis strategies for scores: whatever they draw can be written, read and resolved."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import strategies as st

from enpointe.notation import (
    ArmsPosition,
    Depth,
    FeetPosition,
    Frame,
    Orientation,
    Score,
    Side,
    Sign,
)
from enpointe.notation.vocabulary import ARMS, FEET

sides = st.sampled_from(Side)
amounts = st.floats(-90, 90).map(lambda value: value + 0.0)
orientations = st.builds(Orientation, turn=amounts, tilt=amounts, bend=amounts)
feet = st.sampled_from(FEET).flatmap(
    lambda entry: st.builds(
        FeetPosition, st.just(entry.name), sides if entry.crossed else st.none()
    )
)
arms = st.sampled_from(ARMS).flatmap(
    lambda entry: st.builds(
        ArmsPosition, st.just(entry.name), sides if entry.needs_leading else st.none()
    )
)
words = st.text(st.characters(exclude_categories=("Cc", "Cs")), min_size=1, max_size=200).filter(
    lambda text: text.strip() != ""
)


def signs(straight: bool = False) -> st.SearchStrategy[Sign]:
    """Signs within the stave; straight arms among them if asked for."""
    return st.builds(
        Sign,
        width=st.floats(-1, 1),
        height=st.floats(1, 6),
        depth=st.sampled_from(Depth),
        straight=st.booleans() if straight else st.just(False),
    )


@st.composite
def frames(draw: st.DrawFn, beat: Fraction, first: bool = False) -> Frame:
    """A frame without contradictions; the first one gives all limbs."""
    named_arms, named_feet = draw(st.booleans()), draw(st.booleans())
    both = {"min_size": 2} if first else {}
    hands = {} if named_arms else draw(st.dictionaries(sides, signs(straight=True), **both))
    straight = {side for side, sign in hands.items() if sign.straight}
    elbows = {} if named_arms else draw(st.dictionaries(sides, signs()))
    return Frame(
        beat,
        feet=draw(feet) if named_feet else None,
        arms=draw(arms) if named_arms else None,
        hands=hands,
        elbows={side: sign for side, sign in elbows.items() if side not in straight},
        foot_signs={} if named_feet else draw(st.dictionaries(sides, signs(), **both)),
        knees=draw(st.dictionaries(sides, signs())),
        head=draw(st.none() | orientations),
        body=draw(st.none() | orientations),
        pelvis=draw(st.none() | orientations),
    )


@st.composite
def scores(draw: st.DrawFn, max_frames: int = 8) -> Score:
    """A whole valid score."""
    steps = draw(
        st.lists(
            st.fractions(Fraction(1, 12), 20, max_denominator=12).filter(
                lambda step: step.denominator in (1, 2, 3, 4, 6, 12)
            ),
            max_size=max_frames - 1,
        )
    )
    beat = Fraction(0)
    drawn = [draw(frames(beat, first=True))]
    for step in steps:
        beat += step
        drawn.append(draw(frames(beat)))
    return Score(
        title=draw(words),
        method=draw(words),
        metre=(draw(st.integers(1, 32)), draw(st.sampled_from((1, 2, 4, 8, 16)))),
        tempo=draw(st.floats(1, 250)),
        frames=tuple(drawn),
    )
