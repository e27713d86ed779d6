"""The public functions: a score in, a dance with its figures out, and one line when it can't be."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import enpointe
from enpointe import EnpointeError, Performance
from enpointe.controllers import FeedForward, Gains, Recording
from enpointe.errors import ModelError, MotionError, ScoreError
from enpointe.models import Anthropometry, Style
from enpointe.motion.npz import load_motion
from enpointe.notation import Score, Side, load_score, names, parse_score, shipped_scores

from ..motion.dancing import written_score
from .commands import SHORT

PHYSICAL = (
    "completed",
    "fell_at",
    "duration",
    "steps",
    "root_force_max",
    "tracking_rms_deg",
    "support_margin_min",
    "slip_max",
    "flights",
    "torque_limit_fraction_max",
    "realtime_factor",
)


@cache
def dance(controller: str = "pd") -> Performance:
    return enpointe.perform(parse_score(SHORT), effort="happy", controller=controller)


def test_a_dance_has_the_promised_figures() -> None:
    summary = dance().summary()
    assert set(PHYSICAL) <= set(summary)
    assert summary["completed"] is True
    assert summary["fell_at"] is None
    assert summary["root_force_max"] == 0.0
    assert summary["flights"] == []
    assert summary["steps"] == len(dance().recording.time)  # type: ignore[union-attr]
    assert summary["duration"] == pytest.approx(0.5 + 60 / 80 + 1.0, abs=0.01)
    assert json.loads(json.dumps(summary))["steps"] == summary["steps"]


def test_a_kinematic_dance_has_no_physics() -> None:
    moved = dance("kinematic")
    assert moved.recording is None
    assert moved.measures is None
    assert moved.completed
    assert moved.danced is moved.motion
    assert "root_force_max" not in moved.summary()
    assert "fell_at" not in moved.summary()
    assert json.dumps(moved.summary())


def test_the_reference_does_not_depend_on_the_controller() -> None:
    np.testing.assert_array_equal(dance().motion.qpos, dance("kinematic").motion.qpos)


def test_a_preset_brings_its_tempo_and_numbers_leave_the_scores_own() -> None:
    def seconds(**asked: object) -> float:
        moved = enpointe.perform(parse_score(SHORT), controller="kinematic", **asked)  # type: ignore[arg-type]
        return float(np.diff(moved.choreography.key_times)[0])

    assert seconds(effort="sad") == pytest.approx(60 / 37)
    assert seconds(effort="time=-3") == pytest.approx(60 / 90)
    assert seconds(effort="sad", tempo=120.0) == pytest.approx(0.5)


def test_names_files_and_scores_are_all_scores(tmp_path: Path) -> None:
    file = tmp_path / "short.bmn"
    file.write_text(SHORT, "utf-8")
    for source in (file, str(file), parse_score(SHORT)):
        moved = enpointe.perform(source, effort="happy", controller="kinematic")
        np.testing.assert_array_equal(moved.motion.qpos, dance().motion.qpos)


def test_another_dancer_dances_too() -> None:
    tall = enpointe.perform(
        parse_score(SHORT), controller="kinematic", dancer=Anthropometry(1.80, 65.0)
    )
    assert tall.motion.qpos[0, 2] > dance().motion.qpos[0, 2] + 0.03
    assert tall.completed
    assert not tall.broken


def test_the_asked_fit_is_near_the_danced_one() -> None:
    asked, danced = dance().asked_fit(), dance().danced_fit()
    assert asked is not None
    assert danced is not None
    assert danced.time == pytest.approx(asked.time, abs=0.4)
    assert danced.weight == pytest.approx(asked.weight, abs=0.06)


def test_a_dance_can_be_saved_and_read_again(tmp_path: Path) -> None:
    files = dance().save(tmp_path / "new folder")
    model = dance().motion.model
    assert sorted(p.name for p in (tmp_path / "new folder").iterdir()) == [
        "balance.csv",
        "motion.npz",
        "recording.npz",
    ]
    recording = dance().recording
    assert recording is not None
    np.testing.assert_array_equal(load_motion(files["motion"], model).qpos, recording.qpos)
    np.testing.assert_array_equal(Recording.load(files["recording"], model).qpos, recording.qpos)
    assert set(dance("kinematic").save(tmp_path / "k")) == {"motion"}


def test_progress_names_its_tasks_in_order() -> None:
    told: list[tuple[str, float, float]] = []
    enpointe.perform(parse_score(SHORT), progress=lambda *a: told.append(a))
    assert list(dict.fromkeys(task for task, _, _ in told)) == ["key poses", "movement", "dance"]
    assert all(0 <= done <= total for _, done, total in told)
    last = {task: (done, total) for task, done, total in told}
    assert all(done == total for done, total in last.values())


LEAP = written_score(
    "feet: first; arms: fifth en bas",
    "feet: first, demi-plié",
    "left leg: pointed seconde; right leg: pointed seconde",
    "feet: first, demi-plié; jump: off 1+3/4, on 2+1/4",
    tempo=120,
)


def test_a_jump_is_danced_kinematically() -> None:
    """Half a pulse at 120: a quarter of a second in the air."""
    leapt = enpointe.perform(parse_score(LEAP), controller="kinematic")
    assert leapt.completed
    assert len(leapt.choreography.key_times) == 4
    assert json.dumps(leapt.summary())
    flown = [s.flight for s in leapt.choreography.stations if s.flight is not None]
    assert {flight.seconds for flight in flown} == {0.25}


def test_a_repeat_is_danced_and_the_score_stays_as_it_is_written() -> None:
    text = SHORT.replace("tempo: 90", "tempo: 90\nrepeat 1 to 1: once more, other side")
    moved = enpointe.perform(parse_score(text), controller="kinematic", tempo=90.0)
    assert len(moved.score.frames) == 2
    assert moved.score == parse_score(text)
    turns = [frame.head.turn for frame in moved.choreography.score.resolved()]
    assert turns == [0.0, -20.0, 20.0]
    assert np.diff(moved.choreography.key_times) == pytest.approx(60 / 90)


@pytest.mark.slow
@pytest.mark.parametrize("score", ["temps-lie-grand-battement", "glissade-jete-assemble"])
def test_who_can_not_dance_it_yet_says_so(score: str) -> None:
    """PD has no balance of its own: off two feet it may fall, and nothing holds it up meanwhile."""
    tried = enpointe.perform(score)
    summary = tried.summary()
    assert summary["root_force_max"] == 0.0
    assert summary["completed"] is (summary["fell_at"] is None)
    assert tried.measures is not None
    stood = tried.measures.margin[-1] > 0
    assert stood or not tried.completed
    assert json.dumps(summary)


def test_a_fall_is_an_answer_and_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    make_limp(monkeypatch)
    fallen = enpointe.perform(parse_score(SHORT), tempo=20.0)
    summary = fallen.summary()
    assert not fallen.completed
    assert summary["completed"] is False
    assert 0 < summary["fell_at"] < fallen.motion.duration  # type: ignore[operator]
    assert summary["fault"] == "fell"
    assert json.dumps(summary)


def test_who_topples_over_has_not_completed_the_dance() -> None:
    """A leg to the side in one count throws the dancer: legal poses, no balance on the way."""
    score = parse_score(
        written_score("feet: first; arms: first", "left foot: 0.95 wide, 2.5 high, front")
    )
    thrown = enpointe.perform(score)
    assert thrown.measures is not None
    assert thrown.measures.margin[-1] > 0 or not thrown.completed


def make_limp(monkeypatch: pytest.MonkeyPatch) -> None:
    def none(cls: type[Gains], model: object, qpos: object) -> Gains:
        return Gains(np.zeros(36), np.zeros(36))

    monkeypatch.setattr(Gains, "suggested", classmethod(none))
    monkeypatch.setattr(FeedForward, "at", lambda self, t: np.zeros(36))


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"effort": "joyful"}, MotionError, "no effort 'joyful'"),
        ({"effort": "time=9"}, MotionError, "time=9 is outside -4..-2"),
        ({"tempo": 0.0}, ScoreError, "can't be danced"),
        ({"controller": "telepathy"}, EnpointeError, "use kinematic or pd"),
        ({"interpolation": "cubic"}, MotionError, "use expressive, logistic, slerp"),
    ],
)
def test_what_cannot_be_danced_is_one_line(
    arguments: dict[str, object], error: type[EnpointeError], message: str
) -> None:
    with pytest.raises(error) as refused:
        enpointe.perform(parse_score(SHORT), **arguments)  # type: ignore[arg-type]
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(("height", "mass"), [(9.0, 54.0), (1.68, -1.0), (float("nan"), 54.0)])
def test_bodies_that_nobody_has_are_refused(height: float, mass: float) -> None:
    with pytest.raises(ModelError):
        enpointe.perform(parse_score(SHORT), dancer=Anthropometry(height, mass))


def test_an_arm_that_is_too_short_is_refused_with_its_place() -> None:
    text = SHORT.replace("arms: à la seconde", "left hand: 0.9 wide, 5.9 high, front")
    with pytest.raises(ScoreError, match="beyond the reach of the arm") as refused:
        enpointe.perform(parse_score(text, "mine.bmn"))
    assert (refused.value.source, refused.value.line) == (
        "mine.bmn",
        text.split("\n").index("  left hand: 0.9 wide, 5.9 high, front") + 1,
    )


@cache
def compared() -> enpointe.Comparison:
    return enpointe.compare(parse_score(SHORT), effort="happy")


def test_a_comparison_has_every_variant_and_every_difference() -> None:
    comparison = compared()
    assert list(comparison.performances) == ["slerp", "logistic", "expressive", "physical"]
    assert comparison.completed
    assert len(comparison.differences) == 6
    assert {(d.first, d.second) for d in comparison.differences} == {
        (a, b)
        for i, a in enumerate(comparison.performances)
        for b in list(comparison.performances)[i + 1 :]
    }
    summary = comparison.summary()
    assert list(json.loads(json.dumps(summary))["variants"]) == list(comparison.performances)


def test_the_physical_dancer_is_nearer_to_what_was_asked_than_to_the_baseline() -> None:
    apart = {(d.first, d.second): d for d in compared().differences}
    close, far = apart["expressive", "physical"], apart["slerp", "physical"]
    assert close.joint_rms_deg < far.joint_rms_deg
    for side in Side:
        assert close.wrist_path_rms[side] < 0.01
        assert close.wrist_path_rms[side] < far.wrist_path_rms[side]


def test_every_variant_dances_at_the_same_times() -> None:
    ends = [p.motion.duration for p in compared().performances.values()]
    assert max(ends) == min(ends)


@pytest.mark.parametrize(
    "name",
    [
        "arms fifth en haut",
        "feet fourth",
        "feet fourth open",
        "arms third",
        "Arms First",
        "leg retiré devant",
        "leg arabesque derrière 90",
        "pose attitude effacée derrière",
    ],
)
def test_positions_of_the_vocabulary_can_be_posed(name: str) -> None:
    poses = enpointe.pose(name)
    (summary,) = poses.summary()["poses"]  # type: ignore[misc]
    assert poses.held
    assert summary["name"] == name.lower()
    assert len(summary["qpos"]) == 43
    assert summary["solve_ms"] > 0
    over = [r for r in summary["rules"] if r["rule"] == "centre of mass over the support"]
    assert [r["held"] for r in over] == [True]
    for rule in summary["rules"]:
        assert {"rule", "value", "unit", "bound", "held"} <= set(rule)


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_the_whole_vocabulary_keeps_the_rules(name: str) -> None:
    assert enpointe.pose(name).held


def test_a_score_can_be_posed() -> None:
    poses = enpointe.pose("first-port-de-bras")
    assert [p.name for p in poses.key_poses] == [f"beat {b}" for b in range(4)]
    assert poses.held


def test_a_misspelt_position_is_corrected() -> None:
    with pytest.raises(EnpointeError, match="did you mean 'arms fifth en haut'"):
        enpointe.pose("arms fith en haut")


def test_turnout_is_the_dancers_own() -> None:
    def turned(degrees: float) -> float:
        pose = enpointe.pose("feet first", style=Style(turnout_deg=degrees)).key_poses[0]
        print_ = pose.target.legs[Side.LEFT].footprint
        assert print_ is not None
        return float(np.degrees(print_.direction))

    assert turned(70.0) - turned(50.0) == pytest.approx(20.0)


def test_the_front_door_opens_without_the_engines() -> None:
    code = (
        "import sys, enpointe\n"
        "enpointe.load_score('third-port-de-bras')\n"
        "heavy = {'mujoco', 'casadi', 'matplotlib', 'mink', 'scipy'} & set(sys.modules)\n"
        "sys.exit(' '.join(heavy) or 0)\n"
    )
    run = subprocess.run(
        [sys.executable, "-P", "-c", code], capture_output=True, text=True, check=False
    )
    assert (run.returncode, run.stderr) == (0, "")


def test_public_names_are_there() -> None:
    assert set(enpointe.__all__) <= set(dir(enpointe)) | {"__version__"}
    assert isinstance(load_score(shipped_scores()[0]), Score)
    with pytest.raises(AttributeError, match="has no attribute 'pirouette'"):
        _ = enpointe.pirouette


def test_two_frames_at_the_same_pose_are_a_dance() -> None:
    """Nobody moves; the fit has nothing to say and says null."""
    score = parse_score(written_score("feet: first; arms: first", "head: erect"))
    summary = enpointe.perform(score, controller="kinematic").summary()
    assert json.dumps(summary)
    moved = replace(dance("kinematic"), effort_name="x")
    assert moved.summary()["effort"]["name"] == "x"  # type: ignore[index]


ON_POINTE = written_score(
    "left leg: straight, pointe; right leg: raised devant 90; arms: à la seconde"
)


def test_a_pose_is_held_on_pointe_in_pointe_shoes() -> None:
    held = enpointe.perform(parse_score(ON_POINTE), controller="wholebody", hold=0.4)
    summary = held.summary()
    assert summary["completed"] is True
    assert summary["qp_failures"] == 0
    assert summary["root_force_max"] == 0.0
    assert summary["duration"] == pytest.approx(0.5 + 0.4, abs=0.01)
    names = [held.motion.model.geom(g).name for g in range(held.motion.model.ngeom)]
    assert "left_platform_upper_inner" in names
    assert json.dumps(summary)


def test_a_hold_lengthens_the_end_and_one_frame_alone_is_no_dance() -> None:
    moved = enpointe.perform(parse_score(SHORT), controller="kinematic", hold=2.5)
    longer = moved.motion.duration - dance("kinematic").motion.duration
    assert longer == pytest.approx(60 / 90 - 60 / 80 + 1.5, abs=0.01)
    with pytest.raises(MotionError, match="one frame"):
        enpointe.perform(parse_score(ON_POINTE), controller="wholebody")
    with pytest.raises(EnpointeError, match="a pose is held for up to 600 s"):
        enpointe.perform(parse_score(SHORT), hold=-1.0)
