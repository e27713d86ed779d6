"""The rules of ballet, one concept a file, and which of them a pose must keep."""

from __future__ import annotations

from enpointe.models.rules.arms import (
    ElbowOnItsSign,
    ElbowOnTheSlope,
    ForearmTurn,
    HandOnItsSign,
    PalmDown,
    RoundedElbow,
    StraightElbow,
    WristLine,
)
from enpointe.models.rules.balance import CentredWeight, ComOverSupport
from enpointe.models.rules.base import Kind as Kind
from enpointe.models.rules.base import Rule as Rule
from enpointe.models.rules.base import Symbols as Symbols
from enpointe.models.rules.feet import (
    FeetTurnedOutAlike,
    FlatFoot,
    FootOnItsMark,
    FootOnItsSign,
    FootTurnout,
    PointedFoot,
    TurnoutAtTheHip,
)
from enpointe.models.rules.legs import KneeOnItsSign, LegTurnedOut, StraightKnee
from enpointe.models.rules.stance import BodyAsWritten, HeadAsWritten, PelvisAsWritten
from enpointe.models.target import ArmShape, PoseTarget
from enpointe.notation import Side

__all__ = ["Kind", "Rule", "Symbols", "rules_for"]


def rules_for(target: PoseTarget) -> tuple[Rule, ...]:
    """The rules that apply to a pose of this structure."""
    rules: list[Rule] = [HeadAsWritten(), BodyAsWritten(), PelvisAsWritten()]
    for side in Side:
        rules += _arm_rules(target.arms[side].shape, side)
        rules += _leg_rules(target, side)
    rules += [ComOverSupport(), CentredWeight()]
    if all(leg.footprint is not None for leg in target.legs.values()):
        rules.append(FeetTurnedOutAlike())
    return tuple(rules)


def _arm_rules(shape: ArmShape, side: Side) -> list[Rule]:
    if shape is ArmShape.ROUNDED:
        return [
            HandOnItsSign(side),
            ElbowOnTheSlope(side),
            RoundedElbow(side),
            ForearmTurn(side),
            WristLine(side),
        ]
    if shape is ArmShape.STRAIGHT:
        return [HandOnItsSign(side), StraightElbow(side), PalmDown(side), WristLine(side)]
    return [HandOnItsSign(side), ElbowOnItsSign(side), ForearmTurn(side), WristLine(side)]


def _leg_rules(target: PoseTarget, side: Side) -> list[Rule]:
    leg = target.legs[side]
    if leg.footprint is not None:
        rules: list[Rule] = [
            FootOnItsMark(side),
            FlatFoot(side),
            FootTurnout(side),
            TurnoutAtTheHip(side),
        ]
    else:
        rules = [FootOnItsSign(side), PointedFoot(side), LegTurnedOut(side)]
    if leg.knee is not None:
        rules.append(KneeOnItsSign(side))
    elif leg.footprint is not None:
        rules.append(StraightKnee(side))
    return rules
