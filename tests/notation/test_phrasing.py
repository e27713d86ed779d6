"""Above the stave: repeats written out, tempo that slows and quickens, bars."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.notation import Phrase, Repeat, Score, Side, load_score, parse_score

from .strategies import scores
from .texts import FIFTH, HEAD


def danced(heading: str, beats: int) -> list[tuple[float, float]]:
    """Beats and heads of the dance; at beat n the head is turned n degrees to the left."""
    frames = "".join(f"beat {n}:\nhead: turn left {n}\n" for n in range(1, beats + 1))
    score = parse_score(HEAD + heading + FIFTH + frames)
    return [
        (float(frame.beat), frame.head.turn)
        for frame in score.performed().frames
        if frame.head is not None
    ]


def test_counts_are_repeated() -> None:
    """Counts 1 to 2 are what comes after beat 0, up to and including beat 2."""
    turns = [turn for _, turn in danced("repeat 2 to 3: twice more\n", 4)]
    assert turns == [1, 2, 3, 2, 3, 2, 3, 4]


def test_the_other_side_alternates() -> None:
    """Each time is the mirror image of the time before; what follows is as written."""
    heads = danced("repeat 1 to 2: twice more, other side\n", 3)
    assert heads == [(1, 1), (2, 2), (3, -1), (4, -2), (5, 1), (6, 2), (7, 3)]


def test_upbeats_belong_to_the_count_that_they_lead_to() -> None:
    """Beat 1/2 is repeated with count 1, beat 2+1/2 is not repeated with count 2."""
    frames = "beat 1/2:\nbeat 1:\nbeat 2:\nbeat 2+1/2:\nbeat 3:\n"
    score = parse_score(HEAD + "repeat 1 to 2: once\n" + FIFTH + frames).performed()
    assert [float(frame.beat) for frame in score.frames] == [0, 0.5, 1, 2, 2.5, 3, 4, 4.5, 5]


def test_the_second_ending_takes_the_place_of_the_first() -> None:
    """The last time through leaves out the first ending and goes on with the second."""
    heading = "repeat 1 to 4: twice, other side, first ending 3 to 4, second ending 5 to 5\n"
    heads = danced(heading, 6)
    assert [turn for _, turn in heads] == [1, 2, 3, 4, -1, -2, -3, -4, 1, 2, 5, 6]
    assert [beat for beat, _ in heads] == list(range(1, 13))


def test_jumps_and_phrases_go_along() -> None:
    """A repeated jump has its own moments, a repeated phrase its own counts."""
    text = HEAD + "repeat 1 to 2: once more\nphrase 1 to 2: sad\n" + FIFTH
    score = parse_score(text + "beat 1:\nbeat 2:\njump: off 1+1/2, on 2\n").performed()
    jumps = [(float(frame.jump.off), float(frame.jump.on)) for frame in score.frames if frame.jump]
    assert jumps == [(1.5, 2.0), (3.5, 4.0)]
    assert [(phrase.first, phrase.last) for phrase in score.phrases] == [(1, 2), (3, 4)]


def test_a_repeated_side_ends_where_the_other_began() -> None:
    """The exercises that go to the other side close so that they can."""
    for name in ("adage-developpe", "glissade-jete-assemble"):
        score = load_score(name)
        start, end = (score.resolved()[index].feet for index in (0, -1))
        assert start is not None
        assert end is not None
        assert {start.front, end.front} == set(Side)
        assert score.performed().resolved()[-1].feet == start


@given(scores())
def test_a_dance_has_the_frames_of_every_time_through(score: Score) -> None:
    """As many frames and beats as its repeats say, in order."""
    dance = score.performed()
    beats = [frame.beat for frame in dance.frames]
    assert beats == sorted(set(beats))
    assert not dance.repeats
    assert dance.performed() == dance
    longer = sum(
        repeat.times * (repeat.last - repeat.first + 1)
        - (repeat.last - repeat.endings[0][0] + 1 if repeat.endings else 0)
        for repeat in score.repeats
    )
    assert beats[-1] == score.frames[-1].beat + longer


@given(scores(max_frames=2), st.lists(st.fractions(0, 60), min_size=2))
def test_time_goes_forward(score: Score, beats: list[Fraction]) -> None:
    """A later beat is later, whatever slows and quickens."""
    beats = sorted(beats)
    times = [score.seconds(beat) for beat in beats]
    for (first, one), (second, other) in zip(
        zip(beats, times, strict=True), zip(beats[1:], times[1:], strict=True), strict=False
    ):
        assert other > one or first == second or float(second - first) < 1e-9


def test_tempo_changes_linearly_with_the_beat() -> None:
    """From the score's own to the phrase's end, by the sum of many small steps; then back."""
    score = replace(load_score("third-port-de-bras"), tempo=60.0)
    slowing = replace(score, phrases=(Phrase(1, 4, tempo_end=0.5),))
    steps = 20_000
    middles = [(step + 0.5) * 4 / steps for step in range(steps)]
    expected = sum(4 / steps / (1 - 0.5 * beat / 4) for beat in middles)
    assert slowing.seconds(4) == pytest.approx(expected, rel=1e-6)
    assert slowing.seconds(6) - slowing.seconds(5) == pytest.approx(1.0)
    quickening = replace(score, phrases=(Phrase(5, 8, tempo_end=2.0),))
    assert quickening.seconds(4) == 4.0
    assert quickening.seconds(8) < 8.0
    assert quickening.seconds(8, 120) == pytest.approx(quickening.seconds(8) / 2)


def test_an_even_phrase_changes_nothing() -> None:
    """A quality alone leaves the tempo as it is."""
    score = load_score("third-port-de-bras")
    assert replace(score, phrases=(Phrase(1, 4, "sad"),)).seconds(3) == score.seconds(3)


@given(
    st.integers(1, 12),
    st.fractions(0, 1, max_denominator=4),
    st.integers(1, 50),
    st.fractions(1, 2, max_denominator=12).filter(lambda count: count < 2),
)
def test_bars_and_beats_agree(pulses: int, pickup: Fraction, bar: int, count: Fraction) -> None:
    """The bar of a beat of a bar is that bar; the pose to start from is before the first."""
    whole = load_score("third-port-de-bras")
    score = replace(whole, metre=(pulses, 4), pickup=min(pickup, Fraction(pulses) / 2))
    assert score.bar(score.beat_of(bar, count)) == bar
    assert score.bar(Fraction(0)) < 1


def test_a_repeat_knows_its_beats() -> None:
    """Its counts, as beats after which it begins and with which it ends."""
    repeat = Repeat(3, 6)
    assert (repeat.start, repeat.end) == (Fraction(2), Fraction(6))
