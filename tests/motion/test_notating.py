"""A danced score is read back: the same names at the same beats, and nothing written twice."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from enpointe.errors import MotionError
from enpointe.models import dancer_model, pose_target
from enpointe.models.recognition import recogniser_of
from enpointe.motion import PRESETS, Interpolation, Motion, interpolate
from enpointe.motion.beats import find_pulse, on_the_beat
from enpointe.motion.notating import notate, read_motion
from enpointe.notation import (
    FloorContact,
    LegPosition,
    ResolvedFrame,
    Score,
    Side,
    format_score,
    load_score,
    parse_score,
    score_from_json,
    score_to_json,
    shipped_scores,
)

from .captured import captured
from .dancing import choreography, motion, solved, solver, written_score

PORTS_DE_BRAS = ("first-port-de-bras", "third-port-de-bras", "fourth-port-de-bras")
STEPS = ("releve", "releve-one-foot", "plie-releve", "fondu", "grand-battement")
WITHOUT_JUMPS = ("adage-developpe", "temps-lie-grand-battement", "evaluation-poses", *STEPS)


WITH_JUMPS = {
    "glissade-jete-assemble": {
        "11/4": "in the air of the temps levé the free foot leaves the ankle",
        "27/4": "the same to the other side",
    },
    "grand-jete-en-tournant": {
        "15/4": "in the air, where nothing pauses, the pose is found a twelfth of a beat early",
    },
}
"""What is not read back by its name, and why."""


def leg_class(position: LegPosition | None) -> object:
    """Two words that ballet has for a straight leg behind are one."""
    if position is None:
        return None
    name = "raised" if position.name == "arabesque" else position.name
    return name, position.direction, position.degrees


def names_of(frame: ResolvedFrame) -> object:
    """All that has a name in a frame."""
    legs = tuple(
        (leg.position, leg_class(leg.named), leg.support)
        for leg in (frame.legs[side] for side in Side)
    )
    return legs, tuple(frame.arms[side].named for side in Side)


def read_back(name: str, preset: str = "natural", *, tempo: float | None) -> Score:
    """The score of a dance without its own events, which say too much."""
    danced = motion(name, preset)
    return notate(Motion.from_qpos(danced.model, danced.time, danced.qpos), tempo)


@pytest.mark.parametrize("preset", ["natural", "angry"])
@pytest.mark.parametrize("name", PORTS_DE_BRAS)
def test_a_port_de_bras_is_read_back(name: str, preset: str) -> None:
    """With the tempo estimated."""
    score = read_back(name, preset, tempo=None)
    wanted, found = load_score(name).performed().resolved(), score.resolved()
    assert [frame.beat for frame in found] == [frame.beat for frame in wanted]
    assert [names_of(frame) for frame in found] == [names_of(frame) for frame in wanted]


@pytest.mark.slow
@pytest.mark.parametrize("name", WITHOUT_JUMPS)
def test_an_exercise_on_the_floor_is_read_back(name: str) -> None:
    """Every named position at its beat; a slow passage between two may have one more."""
    score = read_back(name, tempo=choreography(name, "natural").tempo)
    wanted = load_score(name).performed().resolved()
    found = {frame.beat: frame for frame in score.resolved()}
    assert {frame.beat for frame in wanted} <= set(found)
    for frame in wanted:
        assert names_of(found[frame.beat]) == names_of(frame), f"beat {frame.beat}"
    assert len(found) - len(wanted) <= len(wanted) // 4


def test_every_shipped_score_is_read_back() -> None:
    assert {*PORTS_DE_BRAS, *WITHOUT_JUMPS, *WITH_JUMPS} == set(shipped_scores())


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_JUMPS)
def test_an_allegro_is_read_back(name: str) -> None:
    """All jumps at their counts; all names but those of `WITH_JUMPS`, heights within 5 degrees."""
    danced = interpolate(solved(name), PRESETS["natural"].effort, Interpolation("expressive"))
    without_events = Motion.from_qpos(danced.model, danced.time, danced.qpos)
    written = load_score(name).performed()
    score = notate(without_events, written.tempo)
    found = {frame.beat: frame for frame in score.resolved()}
    unread = set()
    before = None
    for frame in written.resolved():
        same = before is not None and names_of(frame) == names_of(before)
        there = frame.beat in found
        if not (alike(found[frame.beat], frame) if there else same):
            unread.add(str(frame.beat))
        before = frame
    assert unread <= set(WITH_JUMPS[name])
    beats = {frame.beat for frame in written.frames}
    assert len([beat for beat in found if beat not in beats]) <= len(beats) // 4
    landings = [frame.jump.on for frame in score.frames if frame.jump is not None]
    assert landings == [frame.jump.on for frame in written.frames if frame.jump is not None]


def alike(found: ResolvedFrame, wanted: ResolvedFrame) -> bool:
    """The same names, heights of a leg that is on its way within 5 degrees."""
    for side in Side:
        read, written = found.legs[side].named, wanted.legs[side].named
        if (read is None) != (written is None):
            return False
        if read is not None and written is not None:
            if leg_class(replace(read, degrees=None)) != leg_class(replace(written, degrees=None)):
                return False
            if abs((read.degrees or 0.0) - (written.degrees or 0.0)) > 5.0:
                return False
        if found.legs[side].support != wanted.legs[side].support:
            return False
        if found.legs[side].position != wanted.legs[side].position:
            return False
    return all(found.arms[side].named == wanted.arms[side].named for side in Side)


@pytest.mark.parametrize("preset", ["natural", "happy"])
def test_what_nobody_can_see_is_not_read(preset: str) -> None:
    """A thousandth of a nanometre, now and then: while arms rest, that is all that moves them."""
    danced = motion("third-port-de-bras", preset)
    beats = []
    for seed in range(3):
        rng = np.random.default_rng(seed)
        now_and_then = rng.random((len(danced.time), 1)) < 0.1
        blips = 1e-12 * rng.standard_normal(danced.qpos.shape) * now_and_then
        score = notate(Motion.from_qpos(danced.model, danced.time, danced.qpos + blips))
        beats.append([frame.beat for frame in score.frames])
    written = load_score("third-port-de-bras").performed()
    assert beats == 3 * [[frame.beat for frame in written.frames]]


@pytest.mark.parametrize("name", PORTS_DE_BRAS)
def test_what_is_written_is_a_score(name: str) -> None:
    score = read_back(name, tempo=None)
    assert parse_score(format_score(score)) == score
    assert score_from_json(score_to_json(score)) == score
    for frame in score.resolved():
        assert solver().solve(pose_target(frame, solver().figure)).held


def test_only_what_changes_is_written() -> None:
    score = read_back("third-port-de-bras", tempo=None)
    assert score.frames[0].feet is not None
    assert all(frame.feet is None for frame in score.frames[1:])
    # The head goes to the other side while the arms stay.
    assert score.frames[2].arms is None
    assert score.frames[2].head is not None
    assert all(frame.facing is None and frame.travel is None for frame in score.frames[1:])


def test_a_given_tempo_decides_the_beats() -> None:
    own = choreography("first-port-de-bras", "natural").tempo
    twice = read_back("first-port-de-bras", tempo=2 * own)
    assert [frame.beat for frame in twice.frames] == [0, 2, 4, 6]


def test_a_hold_is_written_where_it_ends() -> None:
    text = written_score(
        "feet: first; arms: fifth en bas", "arms: fifth en haut", "", "arms: à la seconde"
    )
    danced = motion(text, "natural")
    score = notate(danced, choreography(text, "natural").tempo)
    assert [frame.beat for frame in score.frames] == [0, 1, 2, 3]
    arms = [frame.arms and frame.arms.name for frame in score.frames]
    assert arms == ["fifth en bas", "fifth en haut", "fifth en haut", "à la seconde"]


def test_raw_signs_stand_where_there_is_no_name() -> None:
    text = written_score(
        "feet: first; arms: fifth en bas",
        "left hand: 0.5 wide, 5.4 high, front; right hand: 0.6 wide, 3.1 high, front",
    )
    found = notate(motion(text, "natural"), choreography(text, "natural").tempo).resolved()[-1]
    wanted = parse_score(text).resolved()[-1]
    for side in Side:
        assert found.arms[side].named is None
        assert found.arms[side].wrist.width == pytest.approx(wanted.arms[side].wrist.width, abs=0.1)
        assert found.arms[side].wrist.height == pytest.approx(
            wanted.arms[side].wrist.height, abs=0.1
        )


def test_each_frame_knows_its_moment() -> None:
    danced = motion("first-port-de-bras", "natural")
    read = read_motion(danced)
    assert read.estimated
    for frame, event in zip(read.frames, danced.key_events, strict=True):
        assert frame.time == pytest.approx(event.time, abs=0.12)
        assert frame.frame.beat == event.beat
        assert frame.recognition.named


def test_a_dancer_who_stands_still_has_no_score() -> None:
    still = solved("first-port-de-bras").key_poses[0].qpos
    motionless = Motion.from_qpos(solver().model, np.arange(100) / 50.0, np.tile(still, (100, 1)))
    with pytest.raises(MotionError, match="nothing moves"):
        notate(motionless)


@pytest.mark.parametrize("tempo", [0.0, -60.0, 1e4])
def test_a_tempo_that_cannot_be_danced_is_refused(tempo: float) -> None:
    with pytest.raises(MotionError, match="tempo"):
        notate(motion("first-port-de-bras", "natural"), tempo)


@given(
    st.floats(50.0, 90.0),
    st.floats(0.0, 2.0),
    st.lists(st.sampled_from([1, 1, 1, 2]), min_size=4, max_size=12).filter(
        lambda steps: steps.count(1) >= steps.count(2)
    ),
    st.integers(0, 2**32 - 1),
)
def test_a_steady_pulse_is_found(tempo: float, start: float, steps: list[int], seed: int) -> None:
    """Moments on whole beats, 10 ms off at most, most of them one beat apart."""
    rng = np.random.default_rng(seed)
    beats = np.concatenate([[0, 1, 2], 2 + np.cumsum(steps)])
    times = start + beats * 60.0 / tempo + rng.uniform(-0.01, 0.01, len(beats))
    found = find_pulse([float(t) for t in times])
    assert found.tempo == pytest.approx(tempo, rel=0.02)
    assert [on_the_beat(found.beat(float(t))) for t in times] == [int(b) for b in beats]


@given(st.integers(-8, 64), st.sampled_from([1, 2, 3, 4]), st.floats(-0.02, 0.02))
def test_the_nearest_part_of_a_beat_is_taken(whole: int, parts: int, off: float) -> None:
    beat = Fraction(whole, parts)
    assert on_the_beat(float(beat) + off) == beat


@pytest.fixture(scope="module")
def cmu(data_dir: Path) -> Path:
    folder = data_dir / "cmu_05"
    if not folder.is_dir():
        pytest.skip("no captures of CMU's subject 05")
    return folder


def test_a_captured_pointe_tendue_is_found(cmu: Path) -> None:
    """05_12: behind her, the left from 2.1 to 3.3 s and the right about 10.4 s."""
    recogniser = recogniser_of(dancer_model(flesh=False))
    take = captured(cmu, "05_12", recogniser.figure.straight_leg)
    tendus: dict[Side, list[float]] = {side: [] for side in Side}
    for time, joints in take.items():
        found = recogniser.of_joints(joints)
        for side, match in found.legs.items():
            support = found.signs.legs[side].support
            touching = support is not None and support.floor is FloorContact.TOUCH
            if touching and match.named and match.name == "tendu derrière":
                tendus[side].append(time)
    for time in (2.2, 2.6, 3.0, 3.2):
        assert min(abs(t - time) for t in tendus[Side.LEFT]) < 0.06
    assert min(abs(t - 10.4) for t in tendus[Side.RIGHT]) < 0.11
    # Nothing of the kind while she stands on both feet.
    assert not [t for times in tendus.values() for t in times if 0.6 < t < 1.6 or 8.6 < t < 9.4]


def test_a_captured_arabesque_is_found(cmu: Path) -> None:
    """05_14: the left leg goes up behind her, highest at 4.4 s; nothing of the kind elsewhere."""
    recogniser = recogniser_of(dancer_model(flesh=False))
    take = captured(cmu, "05_14", recogniser.figure.straight_leg)
    nearest = {}
    for time, joints in take.items():
        match = recogniser.of_joints(joints).legs.get(Side.LEFT)
        if match is not None and match.name.split()[0] in ("arabesque", "attitude"):
            position = match.position
            assert isinstance(position, LegPosition)
            if match.named:
                nearest[time] = position.direction
    assert {round(time, 1) for time in nearest} >= {4.2, 4.3, 4.4, 4.5}
    assert set(nearest.values()) == {"derrière"}
    assert all(4.1 < time < 4.6 for time in nearest)
