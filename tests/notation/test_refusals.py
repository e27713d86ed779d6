"""Wrong scores: one line that says what is wrong, where, and what would be right."""

from __future__ import annotations

import pytest

from enpointe.errors import ScoreError
from enpointe.notation import MAX_BYTES, parse_score

HEAD = "benesh 1\ntitle: T\nmethod: Cecchetti\nmetre: 4/4\ntempo: 60\n"
START = HEAD + "beat 0:\n  feet: first\n  arms: first\n"


def frame(lines: str) -> str:
    """A good score, then beat 1 on line 9 and these lines from line 10."""
    return f"{START}beat 1:\n{lines}\n"


WRONG: dict[str, tuple[str | bytes, int, int, str]] = {
    "no header": ("title: T\n", 1, 1, "benesh 1"),
    "empty": ("", 1, 1, "empty"),
    "only blanks": (" \n\t\n", 1, 1, "empty"),
    "only a comment": ("# nothing\n", 1, 1, "benesh 1"),
    "a later version": (START.replace("benesh 1", "benesh 2"), 1, 8, "version '2'"),
    "no title": (START.replace("title: T\n", ""), 5, 1, "lacks its title"),
    "no tempo": (START.replace("tempo: 60\n", ""), 5, 1, "lacks its tempo"),
    "title twice": (HEAD + "title: U\n", 6, 1, "already given on line 2"),
    "unknown field": (HEAD + "composer: X\n", 6, 1, "title, method, metre, tempo"),
    "metre 4/0": (START.replace("4/4", "4/0"), 4, 8, "not a metre"),
    "metre 4/3": (START.replace("4/4", "4/3"), 4, 8, "not a metre"),
    "metre in words": (START.replace("4/4", "waltz"), 4, 8, "not a metre"),
    "tempo 0": (START.replace("60", "0"), 5, 8, "1 to 250"),
    "tempo 251": (START.replace("60", "251"), 5, 8, "1 to 250"),
    "tempo infinite": (START.replace("60", "1e999"), 5, 8, "1 to 250"),
    "tempo nan": (START.replace("60", "nan"), 5, 8, "1 to 250"),
    "tempo empty": (START.replace("tempo: 60", "tempo:"), 5, 7, "some words"),
    "unclosed quote": (START.replace("title: T", 'title: "T'), 2, 8, "some words"),
    "bad escape": (START.replace("title: T", r'title: "\q"'), 2, 8, "backslash"),
    "empty quotes": (START.replace("title: T", 'title: ""'), 2, 8, "missing"),
    "control character": (START.replace("title: T", 'title: "\\u0007"'), 2, 8, "control"),
    "no frames": (HEAD, 5, 1, "no frames"),
    "starts late": (START.replace("beat 0", "beat 1"), 6, 6, "beat 0"),
    "no feet at first": (START.replace("  feet: first\n", ""), 6, 1, "both feet"),
    "one hand at first": (
        START.replace("arms: first", "left hand: 1 wide, 4 high, level"),
        6,
        1,
        "both arms",
    ),
    "beat repeated": (START + "beat 0:\n", 9, 6, "already written on line 6"),
    "beat going back": (frame("beat 1/2:"), 10, 6, "beats go forward"),
    "beat without count": (START + "beat:\n", 9, 5, "a count"),
    "beat over zero": (START + "beat 1/0:\n", 9, 6, "not a beat"),
    "beat plus over zero": (START + "beat 1+1/0:\n", 9, 6, "not a beat"),
    "beat huge": (START + "beat 99999999999999999999:\n", 9, 6, "not a beat"),
    "beat too late": (START + "beat 999999:\n", 9, 6, "not a beat"),
    "beat too fine": (START + "beat 1/997:\n", 9, 6, "not a beat"),
    "beat negative": (START + "beat -1:\n", 9, 6, "not a beat"),
    "unknown part": (frame("  hat: erect"), 10, 3, "head"),
    "misspelt part": (frame("  hed: erect"), 10, 3, "did you mean 'head'"),
    "unknown arms": (frame("  arms: fith en haut"), 10, 9, "fifth en haut"),
    "unlike any arms": (frame("  arms: xyzzy"), 10, 9, "known are first"),
    "unknown feet": (frame("  feet: sixth right front"), 10, 9, "not a position of the feet"),
    "no name": (frame("  arms:"), 10, 8, "end of the line"),
    "fifth without front": (frame("  feet: fifth"), 10, 9, "foot in front"),
    "first with front": (frame("  feet: first left front"), 10, 15, "no foot is in front"),
    "fourth without lead": (frame("  arms: fourth en haut"), 10, 9, "arm that leads"),
    "third without lead": (frame("  arms: third"), 10, 9, "arm that leads"),
    "fifth with lead": (frame("  arms: fifth en bas left"), 10, 22, "both arms do the same"),
    "unknown depth": (frame("  left hand: 1 wide, 4 high, beside"), 10, 30, "'behind'"),
    "no depth": (frame("  left hand: 1 wide, 4 high"), 10, 3, "lacks its depth"),
    "width twice": (frame("  left hand: 1 wide, 1 wide, level"), 10, 22, "written twice"),
    "below the floor": (frame("  left hand: 1 wide, 0.5 high, level"), 10, 22, "1 to 6"),
    "above reach": (frame("  left hand: 1 wide, 6.1 high, level"), 10, 22, "1 to 6"),
    "arm too long": (frame("  left hand: 1.5 wide, 4 high, level"), 10, 14, "out of reach"),
    "infinite width": (frame("  left hand: 1e999 wide, 4 high, level"), 10, 14, "not a number"),
    "huge height": (
        frame("  left hand: 1 wide, 99999999999999999999 high, level"),
        10,
        22,
        "not a number",
    ),
    "nan width": (frame("  left hand: nan wide, 4 high, level"), 10, 14, "a number"),
    "no unit": (frame("  left hand: 1, 4 high, level"), 10, 15, "'wide' or 'high'"),
    "hand twice": (
        frame("  left hand: 1 wide, 4 high, level\n  left hand: 1 wide, 4 high, front"),
        11,
        3,
        "already written",
    ),
    "arms and hand": (
        frame("  arms: first\n  left hand: 1 wide, 4 high, level"),
        11,
        3,
        "contradicts 'arms' on line 10",
    ),
    "elbow and arms": (
        frame("  right elbow: .5 wide, 4 high, level\n  arms: first"),
        11,
        3,
        "contradicts 'right elbow'",
    ),
    "feet and foot": (
        frame("  left foot: 1 wide, 3 high, front\n  feet: first"),
        11,
        3,
        "contradicts",
    ),
    "straight and bent": (
        frame("  left hand: 1 wide, 4 high, level, straight\n  left elbow: .5 wide, 4 high, front"),
        11,
        3,
        "straight and bent",
    ),
    "straight foot": (
        frame("  left foot: 1 wide, 3 high, level, straight"),
        10,
        37,
        "only a hand",
    ),
    "turned twice": (frame("  head: turn left, turn right"), 10, 20, "turn of the head"),
    "erect and tilted": (frame("  head: erect, tilt left"), 10, 14, "end of the line"),
    "turned forward": (frame("  head: turn forward"), 10, 14, "'left' or 'right'"),
    "turned too far": (frame("  head: turn left 720"), 10, 19, "0 to 90"),
    "stray comma": (frame("  head: turn left,"), 10, 19, "end of the line"),
    "nested": (frame("  head: ((((((turn))))))"), 10, 9, "'erect'"),
    "frame in a frame": (frame("  arms: beat 2: feet: first"), 10, 14, "but found '2'"),
    "unknown leg": (frame("  left leg: tendoo devant"), 10, 13, "tendu devant"),
    "leg without direction": (frame("  left leg: retiré"), 10, 13, "'retiré devant'"),
    "arabesque devant": (frame("  left leg: arabesque devant"), 10, 13, "no form devant"),
    "leg too high": (frame("  left leg: raised side 170"), 10, 25, "36 to 150"),
    "height of a tendu": (frame("  left leg: tendu side 45"), 10, 24, "one height"),
    "two legs": (frame("  left leg: retiré devant, plié"), 10, 28, "keep one of the two"),
    "two bends": (frame("  left leg: plié, straight"), 10, 19, "contradicts"),
    "unknown stance": (frame("  left leg: plié, tiptoe"), 10, 19, "a way to stand"),
    "feet in the air": (frame("  feet: first, retiré"), 10, 16, "both feet"),
    "feet twice bent": (
        frame("  feet: first, plié\n  left leg: straight"),
        11,
        3,
        "'left leg' is already",
    ),
    "feet and leg": (frame("  feet: first\n  left leg: tendu side"), 11, 3, "contradicts 'feet'"),
    "leg and knee": (
        frame("  left leg: tendu side\n  left knee: .2 wide, 2 high, front"),
        11,
        3,
        "contradicts 'left leg'",
    ),
    "plié and knee": (
        frame("  left leg: plié\n  left knee: .2 wide, 2 high, front"),
        11,
        3,
        "demi-plié",
    ),
    "open fifth": (frame("  feet: fifth open right front"), 10, 9, "no open"),
    "flat in the air": (frame("  left foot: 0 wide, 2 high, front, flat"), 10, 3, "off the floor"),
    "flat alone": (frame("  left foot: flat"), 10, 3, "left leg: straight, flat"),
    "foot on hip": (frame("  left foot: on hip"), 10, 17, "only a hand"),
    "hand on nose": (frame("  left hand: on nose"), 10, 17, "place for a hand"),
    "arms and contact": (frame("  arms: first\n  left hand: on hip"), 11, 3, "contradicts 'arms'"),
    "path of a knee": (
        frame("  left knee: .2 wide, 2 high, front, by a circle"),
        10,
        41,
        "only a hand or a foot",
    ),
    "crooked path": (frame("  left hand: by a zigzag"), 10, 17, "by a circle"),
    "pose without leg": (frame("  pose: first arabesque"), 10, 9, "first arabesque on left"),
    "unknown pose": (frame("  pose: first arabesk on left"), 10, 9, "first arabesque"),
    "unknown direction": (frame("  face: corner 5"), 10, 9, "not a direction"),
    "facing too far": (frame("  face: left 181"), 10, 14, "0 to 180"),
    "face and turn": (frame("  face: audience\n  turn: 90 left"), 11, 3, "contradicts 'face'"),
    "place and travel": (
        frame("  place: centre\n  travel: 1 towards corner 1"),
        11,
        3,
        "contradicts 'place'",
    ),
    "left and right": (frame("  place: 1 left, 2 right"), 10, 20, "twice"),
    "off the stage": (frame("  place: 51 left"), 10, 10, "0 to 50"),
    "no turn": (frame("  turn: 0 left"), 10, 9, "0 degrees"),
    "turn without side": (frame("  turn: 90"), 10, 11, "'left' or 'right'"),
    "jump that falls": (frame("  jump: off 1, on 1/2"), 10, 3, "before it lands"),
    "jump that lands late": (frame("  jump: off 1, on 2"), 10, 3, "of its frame or before"),
    "jump at the start": (
        START.replace("first\n", "first\n  jump: off 0, on 0\n", 1),
        8,
        3,
        "before",
    ),
    "turn at the start": (START + "  turn: 90 left\n", 9, 3, "beat 0"),
    "step at the start": (START + "  left foot: steps\n", 9, 3, "beat 0"),
    "beat of no bar": (START + "bar 1 beat 5:\n", 9, 12, "beats 1 to 4"),
    "bar 0": (START + "bar 0 beat 1:\n", 9, 5, "whole number"),
    "pickup of a bar": (HEAD + "pickup: 4\nbeat 0:\n", 6, 9, "not a pickup"),
    "unknown tempo": (START.replace("60", "Schnell"), 5, 8, "Adagio"),
    "repeat too long": (START.replace("beat 0", "repeat 1 to 2: once\nbeat 0"), 6, 1, "ends at"),
    "one ending": (
        START.replace("beat 0", "repeat 1 to 2: once, first ending 2 to 2\nbeat 0"),
        6,
        1,
        "second ending",
    ),
    "repeat of nothing": (
        START.replace("beat 0", "repeat 1 to 2:\nbeat 0"),
        6,
        15,
        "'once'",
    ),
    "slowing up": (
        START.replace("beat 0", "phrase 1 to 2: slowing to 1.2\nbeat 0"),
        6,
        27,
        "below 1",
    ),
    "unknown quality": (START.replace("beat 0", "phrase 1 to 2: glad\nbeat 0"), 6, 16, "quality"),
    "two qualities": (
        START.replace("beat 0", "phrase 1 to 2: sad, time=-3\nbeat 0"),
        6,
        21,
        "keep one",
    ),
    "phrases that overlap": (
        START.replace("beat 0", "phrase 1 to 2: sad\nphrase 2 to 3: sad\nbeat 0"),
        7,
        1,
        "none over another",
    ),
    "phrase across a repeat": (
        START.replace("beat 0", "repeat 1 to 2: once\nphrase 2 to 3: sad\nbeat 0") + "beat 4:\n",
        7,
        1,
        "within this phrase",
    ),
    "jump into a repeat": (
        START.replace("beat 0", "repeat 2 to 2: once\nbeat 0") + "beat 2:\n  jump: off 1/2, on 2\n",
        11,
        3,
        "during this jump",
    ),
    "long line": (frame("  head: " + "turn left, " * 200), 10, 1001, "too long"),
    "binary": (b"PK\x03\x04\n\x00\x00", 2, 1, "binary"),
    "not utf-8": (HEAD.encode() + b"beat 0: \xff\n", 6, 9, "UTF-8"),
    "too large": (b"#" * (MAX_BYTES + 1), 1, 1, "too large"),
    "lone surrogate": (START.replace("title: T", "title: \ud800"), 2, 8, "U+D800"),
    "escape code": (START.replace("title: T", "title: \x1b[0m"), 2, 8, "U+001B"),
}


@pytest.mark.parametrize("case", WRONG)
def test_says_what_is_wrong_and_where(case: str) -> None:
    """Each malformed score: one line, the exact line and column, and what would be right."""
    text, line, column, message = WRONG[case]
    with pytest.raises(ScoreError) as caught:
        parse_score(text, "a.bmn")
    assert (caught.value.line, caught.value.column) == (line, column), caught.value
    assert message in caught.value.message
    assert str(caught.value).startswith(f"a.bmn:{line}:{column}: ")
    assert "\n" not in str(caught.value)
