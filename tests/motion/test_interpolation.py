"""From key pose to key pose: met on the beat, feet planted, rules kept on the way, no jerk."""

from __future__ import annotations

from itertools import pairwise

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from enpointe.errors import MotionError, ScoreError
from enpointe.motion import PRESETS, Effort, Interpolation, Motion, interpolate, solve_key_poses
from enpointe.motion.inbetween import INTERMEDIATE, solve_passage
from enpointe.motion.interpolation import COUNT_IN, HOLD, RATE, ROUNDING
from enpointe.motion.wrist import wrist_paths
from enpointe.notation import load_score, parse_score

from .dancing import (
    EFFORTS,
    PORTS_DE_BRAS,
    choreography,
    motion,
    sites,
    solved,
    solver,
    timed,
    written_score,
)

KINDS = tuple(kind.value for kind in Interpolation)
THIRD = "third-port-de-bras"
every_kind = pytest.mark.parametrize("kind", KINDS)
every_preset = pytest.mark.parametrize("preset", EFFORTS)


def joints_off(score: str, preset: str, kind: str) -> float:
    """Largest distance from a key pose at its beat, rad."""
    reference, chosen = motion(score, preset, kind), choreography(score, preset)
    return max(
        float(np.abs(reference.sample(t)[0][7:] - pose.qpos[7:]).max())
        for t, pose in zip(chosen.key_times, chosen.key_poses, strict=True)
    )


def sole_places(reference: Motion) -> np.ndarray:
    model = reference.model
    data = mujoco.MjData(model)
    geoms = [g for g in range(model.ngeom) if model.geom(g).name.endswith(("inner", "outer"))]
    out = np.empty((len(reference.time), len(geoms), 3))
    for i, pose in enumerate(reference.qpos):
        data.qpos[:] = pose
        mujoco.mj_kinematics(model, data)
        out[i] = data.geom_xpos[geoms] - np.outer(model.geom_size[geoms, 0], [0, 0, 1])
    return out


@every_preset
def test_key_poses_are_met_on_their_beats_within_the_rounding(preset: str) -> None:
    assert joints_off(THIRD, preset, "expressive") < np.radians(2.0)
    reference, chosen = motion(THIRD, preset), choreography(THIRD, preset)
    at_beats = np.array([reference.sample(t)[0] for t in chosen.key_times])
    written = np.array([pose.qpos for pose in chosen.key_poses])
    for there, wanted in zip(
        wrist_paths(reference.model, at_beats).values(),
        wrist_paths(reference.model, written).values(),
        strict=True,
    ):
        assert np.linalg.norm(there - wanted, axis=1).max() < 0.01


def test_the_baseline_meets_key_poses_exactly() -> None:
    reference, chosen = motion(THIRD, "happy", "slerp"), choreography(THIRD, "happy")
    for t, pose in zip(chosen.key_times, chosen.key_poses, strict=True):
        i = round(t * RATE)
        if abs(i / RATE - t) < 1e-9:
            np.testing.assert_allclose(reference.qpos[i, 7:], pose.qpos[7:], atol=1e-9)


@every_kind
def test_it_waits_counts_in_and_holds(kind: str) -> None:
    reference, chosen = motion(THIRD, "happy", kind), choreography(THIRD, "happy")
    assert chosen.key_times[0] == COUNT_IN
    assert reference.duration == pytest.approx(COUNT_IN + 8 * 60 / 80 + HOLD, abs=1 / RATE)
    still = reference.time < COUNT_IN - ROUNDING
    held = reference.time > chosen.key_times[-1] + ROUNDING
    np.testing.assert_allclose(reference.qpos[still] - chosen.key_poses[0].qpos, 0, atol=1e-12)
    np.testing.assert_allclose(reference.qpos[held] - chosen.key_poses[-1].qpos, 0, atol=1e-12)
    assert np.abs(reference.qvel[[0, -1]]).max() < 1e-9
    np.testing.assert_allclose(np.linalg.norm(reference.qpos[:, 3:7], axis=1), 1, atol=1e-9)


@every_kind
def test_each_frame_is_an_event_at_its_time(kind: str) -> None:
    reference, chosen = motion(THIRD, "sad", kind), choreography(THIRD, "sad")
    assert [e.time for e in reference.key_events] == pytest.approx(list(chosen.key_times))
    assert [e.beat for e in reference.key_events] == [float(b) for b in range(9)]


@pytest.mark.parametrize("score", PORTS_DE_BRAS)
def test_planted_feet_stay_planted(score: str) -> None:
    for preset in ("happy", "sad"):
        places = sole_places(motion(score, preset))
        assert np.abs(places - places[0]).max() < 0.5e-3
        assert np.abs(places[:, :, 2]).max() < 0.5e-3


@pytest.mark.slow
@every_preset
@pytest.mark.parametrize("score", PORTS_DE_BRAS)
def test_the_rules_hold_on_the_way_too(score: str, preset: str) -> None:
    seen = set()
    for start, end in pairwise(solved(score).key_poses):
        key = (start.qpos.tobytes(), end.qpos.tobytes())
        if key in seen:
            continue
        seen.add(key)
        passage = solve_passage(solver(), start, end, PRESETS[preset].effort)
        assert len(passage.between) == INTERMEDIATE
        for pose in passage.poses:
            assert pose.held, f"{pose.name}: {pose.certificate}"


def test_what_is_danced_stays_within_the_joints() -> None:
    for kind in KINDS[:2]:
        reference = motion(THIRD, "happy", kind)
        low, high = reference.model.jnt_range[1:].T
        assert np.all(reference.qpos[:, 7:] > low - np.radians(0.5))
        assert np.all(reference.qpos[:, 7:] < high + np.radians(0.5))


@every_preset
def test_expressive_movement_has_no_jerks(preset: str) -> None:
    """The logistic alone leaves a key pose with a leap of speed; no muscle does."""
    reference = motion(THIRD, preset)
    steps = np.abs(np.diff(reference.qvel, axis=0)).max()
    assert steps < 0.08 * np.abs(reference.qvel).max()
    assert np.abs(reference.qacc).max() < 120.0
    assert np.abs(np.diff(reference.qacc, axis=0)).max() < 0.25 * np.abs(reference.qacc).max()


def test_the_baseline_has_corners() -> None:
    """What the comparison is about: constant speed turns on the spot at each key pose."""
    slerp, expressive = motion(THIRD, "happy", "slerp"), motion(THIRD, "happy")
    assert np.abs(slerp.qacc).max() > 3 * np.abs(expressive.qacc).max()


def test_repeated_phrases_are_danced_alike() -> None:
    """Tempo 60 puts every beat on a sample, so that equal phrases must have equal numbers."""
    chosen = timed(solved(THIRD), 60.0)
    reference = interpolate(chosen, PRESETS["happy"].effort)
    begin, phrase = int(COUNT_IN * RATE), int(4 * RATE)
    margin = int(ROUNDING * RATE)
    first = reference.qpos[begin + margin : begin + phrase]
    second = reference.qpos[begin + phrase + margin : begin + 2 * phrase]
    np.testing.assert_allclose(first[:-margin], second[:-margin], atol=1e-9)


@settings(max_examples=6)
@given(st.sampled_from([30.0, 50.0, 75.0, 100.0]))
def test_time_scales_with_tempo(tempo: float) -> None:
    """Half the tempo is the same way at half the speed (by slerp, which rounds nothing)."""
    slow = interpolate(timed(solved(THIRD), tempo), Effort(-3, 0.5, 1), Interpolation.SLERP)
    fast = interpolate(timed(solved(THIRD), 2 * tempo), Effort(-3, 0.5, 1), Interpolation.SLERP)
    for t in np.linspace(0, 8 * 30 / tempo, 50):
        np.testing.assert_allclose(
            fast.sample(COUNT_IN + t)[0], slow.sample(COUNT_IN + 2 * t)[0], atol=0.02
        )


def test_the_same_score_gives_the_same_motion_bit_for_bit() -> None:
    chosen = choreography("first-port-de-bras", "angry")
    again = interpolate(
        solve_key_poses(load_score("first-port-de-bras"), solver(), tempo=chosen.tempo),
        PRESETS["angry"].effort,
    )
    reference = motion("first-port-de-bras", "angry")
    for name in ("time", "qpos", "qvel", "qacc"):
        np.testing.assert_array_equal(getattr(again, name), getattr(reference, name))


def test_space_changes_the_path_and_time_does_not() -> None:
    chosen = timed(solved("first-port-de-bras"), 60.0)
    direct, indirect, sudden = (
        interpolate(chosen, effort)
        for effort in (Effort(-2.5, 0.5, 1), Effort(-2.5, 0.5, 0), Effort(-4.0, 0.5, 1))
    )

    def places(m: Motion) -> np.ndarray:
        return sites(m.model, m.qpos[::5], "left_wrist")[:, 0]

    def stray(a: np.ndarray, b: np.ndarray) -> float:
        """Farthest of b from the nearest of a."""
        return float(np.linalg.norm(a[:, None] - b[None], axis=2).min(axis=0).max())

    path = sites(direct.model, direct.qpos, "left_wrist")[:, 0]
    assert stray(path, places(sudden)) < 0.012
    assert stray(path, places(indirect)) > 0.015


@every_preset
def test_the_hands_keep_a_face_between_them(preset: str) -> None:
    """Up through the front the wrists stay as far apart as they are at both ends (§5.6.2)."""
    reference, chosen = motion(THIRD, preset), choreography(THIRD, preset)
    begin, end = chosen.key_times[:2]
    rising = (reference.time >= begin) & (reference.time <= end)
    wrists = sites(reference.model, reference.qpos[rising], "left_wrist", "right_wrist")
    gap = np.linalg.norm(wrists[:, 0] - wrists[:, 1], axis=1)
    assert gap.min() > gap[[0, -1]].min() - 0.005
    assert gap.max() < gap[[0, -1]].max() + 0.005


def test_slerp_does_not_keep_the_hands_apart_as_the_expressive_way_does() -> None:
    """Rotations alone know nothing of a face's width (Neagle 2005 §5.6.2, figure 5.19)."""
    strays = {}
    for kind in ("slerp", "expressive"):
        reference, chosen = motion(THIRD, "happy", kind), choreography(THIRD, "happy")
        begin, end = chosen.key_times[:2]
        rising = (reference.time >= begin) & (reference.time <= end)
        wrists = sites(reference.model, reference.qpos[rising], "left_wrist", "right_wrist")
        gap = np.linalg.norm(wrists[:, 0] - wrists[:, 1], axis=1)
        strays[kind] = float(np.abs(gap - np.linspace(gap[0], gap[-1], len(gap))).max())
    assert strays["slerp"] > 0.05
    assert strays["expressive"] < 0.01


@every_preset
def test_the_fingertips_never_cross(preset: str) -> None:
    reference = motion(THIRD, preset)
    tips = sites(reference.model, reference.qpos[::2], "left_fingertips", "right_fingertips")
    assert (tips[:, 0, 1] - tips[:, 1, 1]).min() > 0.01


def test_one_frame_is_no_motion() -> None:
    score = parse_score(written_score("feet: first; arms: fifth en bas"))
    with pytest.raises(MotionError, match="'Test' has one frame; a motion needs two at least"):
        solve_key_poses(score, solver())


@pytest.mark.parametrize("tempo", [0.0, -60.0, 251.0, float("nan"), float("inf")])
def test_a_tempo_that_cannot_be_danced_is_refused(tempo: float) -> None:
    with pytest.raises(ScoreError, match="can't be danced; use 1 to 250 beats a minute"):
        solve_key_poses(load_score("first-port-de-bras"), solver(), tempo=tempo)


def test_an_unknown_interpolation_names_the_known_ones() -> None:
    assert Interpolation.named("slerp") is Interpolation.SLERP
    with pytest.raises(MotionError) as refused:
        Interpolation.named("cubic")
    assert str(refused.value) == "no interpolation 'cubic'; use expressive, logistic, slerp"


def test_progress_is_told_to_the_end() -> None:
    told: list[tuple[int, int]] = []
    chosen = solve_key_poses(
        load_score("first-port-de-bras"), solver(), progress=lambda *a: told.append(a)
    )
    assert told == [(i, 4) for i in range(1, 5)]
    told.clear()
    interpolate(chosen, PRESETS["sad"].effort, progress=lambda *a: told.append(a))
    assert told == [(i, 3) for i in range(1, 4)]
