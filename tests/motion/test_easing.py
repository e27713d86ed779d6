"""A stretch of a movement from rest to rest, and the contacts of a capture as steps."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import MotionError
from enpointe.models import dancer_model
from enpointe.motion import Event, Motion
from enpointe.motion.contact_schedule import ContactSchedule, contact_schedule
from enpointe.motion.easing import cut, ease, still_at
from enpointe.motion.settling import led, stances
from enpointe.motion.stretches import IN_THE_AIR, Obstacle, obstacles, stretches

MODEL = dancer_model(flesh=False)
STANDING = MODEL.key("standing").qpos
ELBOW = MODEL.joint("left_elbow_bend").qposadr[0]


def waving(seconds: float = 4.0, rate: float = 120.0) -> Motion:
    """She bends an elbow to and fro and never rests."""
    time = np.arange(round(seconds * rate) + 1) / rate
    qpos = np.tile(STANDING, (len(time), 1))
    qpos[:, ELBOW] += 0.5 + 0.4 * np.sin(4.0 * time + 0.3)
    events = [Event(2.0, "key pose", "in the middle", 1.0)]
    return Motion.from_qpos(MODEL, time, qpos, events=events)


def moved(bears: np.ndarray, rate: float = 100.0) -> ContactSchedule:
    """Soles that wander a little, bearing as told, (T, S)."""
    motion = waving((len(bears) - 1) / rate, rate)
    made = contact_schedule(motion)
    points = made.points + np.random.default_rng(3).normal(0.0, 0.01, made.points.shape)
    return ContactSchedule(made.time, made.soles, points, bears)


def parts(side: str) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the soles under a foot's heel, and under its toes."""
    names = [MODEL.geom(int(g)).name for g in contact_schedule(waving(0.1)).soles]
    heel = np.array([n.startswith(f"{side}_heel") for n in names])
    return heel, np.array([n.startswith(side) for n in names]) & ~heel


@settings(max_examples=10, deadline=None)
@given(
    start=st.floats(0.0, 1.5),
    length=st.floats(0.3, 2.4),
    speed=st.sampled_from([0.5, 1.0, 2.0]),
)
def test_a_stretch_goes_the_same_way_from_rest_to_rest(
    start: float, length: float, speed: float
) -> None:
    motion = waving()
    eased = ease(motion, contact_schedule(motion), start, start + length, speed)
    assert still_at(eased.motion, 0.0)
    assert still_at(eased.motion, eased.motion.duration)
    assert eased.source[0] == pytest.approx(start)
    assert eased.source[-1] == pytest.approx(start + length)
    assert np.all(np.diff(eased.source) >= -1e-12)
    assert np.gradient(eased.source, eased.motion.time).max() <= speed * 1.001
    ramps = 2 * min(1.0, length / speed)
    assert eased.motion.duration == pytest.approx(length / speed + 1.0 + ramps / 2, abs=0.02)
    asked = [motion.sample(float(t))[0][ELBOW] for t in eased.source]
    np.testing.assert_allclose(eased.motion.qpos[:, ELBOW], asked, atol=1e-12)
    assert eased.contacts.bears.all()
    assert len(eased.contacts.time) == len(eased.motion.time)


def test_a_movement_that_rests_at_both_ends_is_left_as_it_is() -> None:
    time = np.arange(200) / 100.0
    motion = Motion.from_qpos(MODEL, time, np.tile(STANDING, (len(time), 1)))
    contacts = contact_schedule(motion)
    eased = ease(motion, contacts, 0.0, motion.duration)
    assert eased.motion is motion
    assert eased.contacts is contacts


def test_events_move_with_their_moment() -> None:
    motion = waving()
    eased = ease(motion, contact_schedule(motion), 1.0, 3.0)
    (event,) = eased.motion.events
    assert eased.source_time(event.time) == pytest.approx(2.0, abs=0.01)
    assert ease(motion, contact_schedule(motion), 2.5, 3.5).motion.events == ()


def test_a_cut_is_not_eased() -> None:
    motion = waving()
    taken = cut(motion, contact_schedule(motion), 1.0, 2.0)
    assert taken.motion.duration == pytest.approx(1.0)
    assert not still_at(taken.motion, 0.0)


@pytest.mark.parametrize("span", [(-1.0, 2.0), (2.0, 2.0), (3.0, 5.0), (1.0, 1.001)])
def test_what_is_no_stretch_is_refused(span: tuple[float, float]) -> None:
    motion = waving()
    with pytest.raises(MotionError, match="no stretch"):
        ease(motion, contact_schedule(motion), *span)


def test_soles_go_from_stance_to_stance_without_jumps() -> None:
    bears = np.ones((300, 12), dtype=bool)
    left = np.logical_or(*parts("left"))
    bears[100:200, left] = False
    made = led(stances(MODEL, moved(bears)))
    np.testing.assert_array_equal(made.bears, bears)
    assert np.all(made.points[:, left, 2] == 0.0)
    swing = made.points[99:201, left, :2]
    assert np.abs(np.diff(swing, axis=0)).max() < 0.002


def test_a_short_time_in_the_air_is_a_step_and_a_long_one_a_flight() -> None:
    bears = np.ones((300, 12), dtype=bool)
    bears[100:108] = False
    bears[200:230] = False
    raw = moved(bears)
    raw.points[:] = raw.points[0]
    raw.points[100:108, :, 0] += 0.3
    made = led(stances(MODEL, raw))
    assert made.bears[100:108].all()
    assert np.ptp(made.points[:200, :, 0], axis=0).max() < 1e-9
    assert not made.bears[200:230].any()
    motion = waving(2.99, 100.0)
    (flight,) = obstacles(motion, made)
    assert flight.start == pytest.approx(2.0)
    assert flight.end == pytest.approx(2.29)
    assert flight.why == IN_THE_AIR
    before, after = stretches(motion, made, [flight], (0.0, motion.duration))
    assert before.end < flight.start < flight.end < after.start


def test_a_foot_that_comes_down_on_its_heel_is_flat_in_place() -> None:
    bears = np.ones((300, 12), dtype=bool)
    heel, toes = parts("left")
    bears[100:200, heel | toes] = False
    bears[180:200, heel] = True
    made = led(stances(MODEL, moved(bears)))
    assert made.bears[180:, heel | toes].all()
    assert not made.bears[100:180, heel | toes].any()
    for row in range(180, 200):
        there = made.points[200, heel | toes]
        np.testing.assert_allclose(made.points[row, heel | toes], there, rtol=0.0, atol=1e-12)


def test_a_heel_that_strikes_early_glides_on_to_where_the_foot_stands() -> None:
    """The heel is seen on the floor 20 cm from where the foot comes to rest, a fifth of a second
    before it does.
    """
    bears = np.ones((300, 12), dtype=bool)
    heel, toes = parts("left")
    bears[100:200, heel | toes] = False
    bears[180:200, heel] = True
    way = np.interp(np.arange(300), [180, 198], [-0.2, 0.0])
    made = led(stances(MODEL, drawn({"left": way}, bears)))
    assert not made.bears[100:193, heel | toes].any()
    assert made.bears[200:, heel | toes].all()
    assert made.bears[:, ~(heel | toes)].all()
    assert np.abs(np.diff(made.points[:, heel | toes, 0], axis=0)).max() < 0.01


def test_a_low_heel_bears_beside_toes_that_do() -> None:
    bears = np.ones((300, 12), dtype=bool)
    heel, _ = parts("left")
    bears[100:200, heel] = False
    raw = moved(bears)
    raw.points[:] = raw.points[0] * [1.0, 1.0, 0.0]
    assert stances(MODEL, raw).bears.all()
    raw.points[100:200, heel, 2] += 0.02
    np.testing.assert_array_equal(stances(MODEL, raw).bears, bears)


def test_a_foot_that_carries_alone_has_not_glided() -> None:
    left = np.logical_or(*parts("left"))
    bears = np.ones((300, 12), dtype=bool)
    bears[50:, left] = False
    way = np.interp(np.arange(300), [140, 160], [0.0, 0.06])
    made = led(stances(MODEL, drawn({"right": way}, bears)))
    assert np.ptp(made.points[:, ~left, 0], axis=0).max() < 1e-9


def test_a_foot_that_lands_sliding_and_jumps_as_its_heel_leaves_stays_in_place() -> None:
    bears = np.ones((300, 12), dtype=bool)
    heel, toes = parts("left")
    bears[:50, heel | toes] = False
    bears[200:, heel] = False
    raw = moved(bears)
    raw.points[:] = raw.points[0]
    raw.points[50:70, heel | toes, 0] += np.linspace(0.02, 0.0, 20)[:, None]
    raw.points[200:, heel | toes, 1] += 0.01
    made = led(stances(MODEL, raw))
    assert np.ptp(made.points[50:, toes, :2], axis=0).max() < 1e-9
    assert np.ptp(made.points[50:200, heel, :2], axis=0).max() < 1e-9


def drawn(ways: dict[str, np.ndarray], bears: np.ndarray) -> ContactSchedule:
    """Feet that slide along ways (T,), m forward of where they stand at first."""
    raw = moved(bears)
    raw.points[:] = raw.points[0]
    for side, way in ways.items():
        raw.points[:, np.logical_or(*parts(side)), 0] += way[:, None]
    return raw


def test_a_foot_that_slides_to_where_it_rests_is_on_its_way_while_the_other_stands() -> None:
    """Captured down a fifth of a second too early, 20 cm from where it will stand."""
    left = np.logical_or(*parts("left"))
    bears = np.ones((300, 12), dtype=bool)
    bears[:80, left] = False
    way = np.interp(np.arange(300), [80, 100], [0.0, 0.2])
    made = led(stances(MODEL, drawn({"left": way}, bears)))
    assert not made.bears[:90, left].any()
    assert made.bears[100:, left].all()
    assert made.bears[:, ~left].all()
    standing = made.points[:, left, 0][made.bears[:, left].all(axis=1)]
    assert np.ptp(standing, axis=0).max() < 1e-9
    np.testing.assert_allclose(made.points[-1, left, 0], made.points[0, left, 0], atol=1e-9)


def test_a_foot_that_slides_alone_stands_where_it_rests() -> None:
    """Nobody else bears: it has one place before and one after, and none in between."""
    left = np.logical_or(*parts("left"))
    bears = np.ones((300, 12), dtype=bool)
    bears[:, left] = False
    way = np.interp(np.arange(300), [140, 160], [0.0, 0.2])
    made = led(stances(MODEL, drawn({"right": way}, bears)))
    assert made.bears[:, ~left].all()
    places = np.unique(made.points[:, ~left, 0].mean(axis=1).round(6))
    assert np.ptp(places) == pytest.approx(0.2, abs=1e-5)
    assert len(places) == 2


def test_of_two_feet_that_slide_the_nearer_to_its_place_bears() -> None:
    """Weight goes from one to the other: at no time do both skate, and one stands always."""
    left = np.logical_or(*parts("left"))
    bears = np.ones((300, 12), dtype=bool)
    bears[:100, left] = False
    bears[140:, ~left] = False
    rows = np.arange(300)
    ways = {
        "left": np.interp(rows, [100, 130], [-0.15, 0.0]),
        "right": np.interp(rows, [110, 140], [0.0, 0.15]),
    }
    made = led(stances(MODEL, drawn(ways, bears)))
    assert made.bears.any(axis=1).all()
    assert not made.bears[100:110, left].any()
    assert not made.bears[131:140, ~left].any()
    for foot in (left, ~left):
        standing = made.points[:, foot, 0][made.bears[:, foot].all(axis=1)]
        assert np.ptp(standing, axis=0).max() < 1e-9


def test_a_heel_that_never_lies_flat_is_left_alone() -> None:
    bears = np.ones((300, 12), dtype=bool)
    _, toes = parts("left")
    bears[:, toes] = False
    assert not led(stances(MODEL, moved(bears))).bears[:, toes].any()


def test_a_stretch_begins_and_ends_on_a_whole_foot() -> None:
    bears = np.ones((301, 12), dtype=bool)
    bears[:, np.logical_or(*parts("right"))] = False
    bears[:60, parts("left")[0]] = False
    bears[250:, parts("left")[0]] = False
    motion = waving(3.0, 100.0)
    (found,) = stretches(motion, moved(bears), [], (0.0, 3.0))
    assert found.start == pytest.approx(0.60)
    assert found.end == pytest.approx(2.49)
    assert stretches(motion, moved(bears), [Obstacle(0.9, 2.2, "")], (0.0, 2.5)) == ()


def test_a_hand_on_the_floor_stands_in_the_way() -> None:
    motion = waving(1.0)
    qpos = motion.qpos.copy()
    qpos[40:80, 2] -= 0.9
    fallen = Motion.from_qpos(MODEL, motion.time, qpos)
    found = obstacles(fallen, contact_schedule(motion))
    assert any("hand on the floor" in each.why for each in found)
    assert all(0.3 < each.start < each.end < 0.7 for each in found)
