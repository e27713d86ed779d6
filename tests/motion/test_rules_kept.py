"""Rules over a whole movement, and phrases danced in their own quality."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import enpointe
from enpointe.motion import (
    PRESETS,
    Interpolation,
    Motion,
    RuleKept,
    interpolate,
    rules_kept,
    ways_of,
)
from enpointe.motion.ways import Ways
from enpointe.notation import parse_score
from enpointe.performing import PHRASED

from .dancing import solved, written_score

ARMS = written_score(
    "feet: first, straight; arms: fifth en bas", "arms: fifth en avant", "arms: à la seconde"
)
NATURAL = PRESETS["natural"].effort


@cache
def moved() -> tuple[Motion, Ways]:
    ways = ways_of(solved(ARMS), NATURAL)
    return interpolate(solved(ARMS), NATURAL, ways=ways), ways


def by_name(rules: tuple[RuleKept, ...]) -> dict[str, RuleKept]:
    return {kept.rule: kept for kept in rules}


def test_rules_hold_in_between() -> None:
    rules = by_name(rules_kept(*moved()))
    assert {"head as written", "left rounded elbow", "right foot on its mark"} <= set(rules)
    for kept in rules.values():
        assert kept.held > 0.9, kept
        assert kept.applies == 1.0
        assert 0.5 <= kept.at <= 2.5


def test_a_rule_that_is_broken_on_the_way_is_found_there() -> None:
    motion, ways = moved()
    neck = motion.model.joint("neck_turn").qposadr[0]
    qpos = motion.qpos.copy()
    wrong = (motion.time > 1.8) & (motion.time < 2.0)
    qpos[wrong, neck] += np.radians(20)
    kept = by_name(rules_kept(replace(motion, qpos=qpos), ways))["head as written"]
    assert kept.worst == pytest.approx(20, abs=1.0)
    assert 1.8 < kept.at < 2.0
    assert kept.between == ("beat 1", "beat 2")
    assert kept.held == pytest.approx(0.9, abs=0.03)


def test_where_nothing_is_asked_nothing_is_measured() -> None:
    ways = ways_of(solved(ARMS), NATURAL, Interpolation.SLERP)
    motion = interpolate(solved(ARMS), NATURAL, Interpolation.SLERP, ways=ways)
    assert rules_kept(motion, ways) == ()


PHRASES = ARMS.replace("\nbeat 0:", "phrase 1 to 1: sad\n\nbeat 0:", 1)


def test_a_phrase_is_danced_in_its_own_quality() -> None:
    own = ways_of(solved(PHRASES), NATURAL, phrased=True)
    assert own.efforts == [PRESETS["sad"].effort, NATURAL]
    assert ways_of(solved(PHRASES), NATURAL).efforts == [NATURAL, NATURAL]


def test_an_effort_asked_for_goes_before_the_phrases() -> None:
    score = parse_score(PHRASES)
    phrased = enpointe.perform(score, controller="kinematic")
    asked = enpointe.perform(score, effort="time=-3,weight=0.55", controller="kinematic")
    assert phrased.effort_name == PHRASED
    assert asked.effort_name == "time=-3,weight=0.55"
    early, late = (phrased.motion.time < 1.4), (phrased.motion.time > 1.7)
    apart = np.abs(phrased.motion.qpos - asked.motion.qpos).max(axis=1)
    assert apart[early].max() > 0.02
    assert apart[late].max() < 1e-6


def test_the_summary_lists_the_rules() -> None:
    rules = enpointe.perform(parse_score(ARMS), controller="kinematic").summary()["rules"]
    assert isinstance(rules, list)
    assert set(rules[0]) == {
        "rule",
        "unit",
        "bound",
        "at_least",
        "worst",
        "at",
        "between",
        "held_fraction",
    }
