"""The rules of ballet, one concept a file, and which of them a pose must keep."""

from __future__ import annotations

from enpointe.models.leg_target import (
    InAir,
    LegTarget,
    OnPointe,
    Passing,
    Standing,
    ToeOnFloor,
    ToeOnLeg,
)
from enpointe.models.rules.arms import (
    ElbowOnItsSign,
    ElbowOnTheSlope,
    ElbowOutward,
    ForearmTurn,
    HandOnItsSign,
    PalmDown,
    RoundedElbow,
    StraightElbow,
    WristLine,
)
from enpointe.models.rules.balance import (
    CentredWeight,
    ComInFlight,
    ComOverSupport,
    WeightOnItsWay,
    WeightOverTheFoot,
)
from enpointe.models.rules.base import Kind as Kind
from enpointe.models.rules.base import Rule as Rule
from enpointe.models.rules.base import Symbols as Symbols
from enpointe.models.rules.clearance import ArmsClearOfLegs, ArmsClearOfTheBody, LegsApart
from enpointe.models.rules.feet import (
    BallOnItsMark,
    FeetTurnedOutAlike,
    FootAboveTheFloor,
    FootOnItsWayToPoint,
    FootRaised,
    FootTurnout,
    FootYields,
    HeelAboveTheFloor,
    OnTheTip,
    PointedFoot,
    ToesFlat,
    TurnoutAtTheHip,
)
from enpointe.models.rules.hip import REAL_ROTATION_DEG, HipExtension, HipRotation
from enpointe.models.rules.legs import (
    FootOnItsSign,
    KneeBend,
    KneeOnItsSign,
    KneeOverToe,
    KneeYields,
    LegOnItsWay,
    LegTurnedOut,
    StretchedKnee,
    ToeAtTheLeg,
    ToeAway,
    ToeOnTheFloor,
)
from enpointe.models.rules.stance import (
    BodyAsWritten,
    BodyLent,
    HeadAsWritten,
    PelvisAsWritten,
    PelvisLent,
)
from enpointe.models.target import ArmShape, PoseTarget
from enpointe.notation import Side

__all__ = ["Kind", "Rule", "Symbols", "rules_for"]


def rules_for(target: PoseTarget) -> tuple[Rule, ...]:
    """The rules that apply to a pose of this structure."""
    rules: list[Rule] = [HeadAsWritten(), *_trunk_rules(target)]
    for side in Side:
        rules += _arm_rules(target.arms[side].shape, side)
        rules += _leg_rules(target.legs[side], side)
        if target.real:
            rules += [HipRotation(side, REAL_ROTATION_DEG), HipExtension(side)]
        else:
            rules.append(HipRotation(side))
    bearing = sum(isinstance(leg, Standing | OnPointe) for leg in target.legs.values())
    if target.com is not None:
        rules.append(WeightOnItsWay() if bearing else ComInFlight())
    else:
        rules += [ComOverSupport(), CentredWeight() if bearing > 1 else WeightOverTheFoot()]
    if all(isinstance(leg, Standing) and not leg.yields for leg in target.legs.values()):
        rules.append(FeetTurnedOutAlike())
    lifted = tuple(side for side, leg in target.legs.items() if isinstance(leg, InAir | ToeOnLeg))
    return (*rules, LegsApart(), ArmsClearOfLegs(lifted), ArmsClearOfTheBody())


def _trunk_rules(target: PoseTarget) -> list[Rule]:
    working = any(not isinstance(leg, Standing | OnPointe) for leg in target.legs.values())
    if target.real and working:
        return [BodyLent(), PelvisLent()]
    return [BodyAsWritten(), PelvisAsWritten()]


def _arm_rules(shape: ArmShape, side: Side) -> list[Rule]:
    if shape is ArmShape.ROUNDED:
        return [
            HandOnItsSign(side),
            ElbowOnTheSlope(side),
            ElbowOutward(side),
            RoundedElbow(side),
            ForearmTurn(side),
            WristLine(side),
        ]
    if shape is ArmShape.STRAIGHT:
        return [HandOnItsSign(side), StraightElbow(side), PalmDown(side), WristLine(side)]
    return [HandOnItsSign(side), ElbowOnItsSign(side), ForearmTurn(side), WristLine(side)]


def _leg_rules(leg: LegTarget, side: Side) -> list[Rule]:
    if isinstance(leg, Standing):
        rules: list[Rule] = [
            BallOnItsMark(side),
            ToesFlat(side),
            FootTurnout(side),
            TurnoutAtTheHip(side),
        ]
        if leg.yields:
            return [*rules, FootYields(side), KneeYields(side), HeelAboveTheFloor(side)]
        rules += [FootRaised(side), KneeBend(side)]
        return [*rules, KneeOverToe(side)] if leg.knee_bend > 0 else rules
    if isinstance(leg, OnPointe):
        return [OnTheTip(side), FootTurnout(side), KneeBend(side), TurnoutAtTheHip(side)]
    if isinstance(leg, Passing):
        return [LegOnItsWay(side), FootOnItsWayToPoint(side), FootAboveTheFloor(side)]
    rules = [PointedFoot(side), LegTurnedOut(side)]
    if isinstance(leg, ToeOnFloor):
        return [ToeOnTheFloor(side), ToeAway(side), *rules]
    if isinstance(leg, ToeOnLeg):
        return [ToeAtTheLeg(side, leg.site), *rules]
    assert isinstance(leg, InAir)
    if leg.knee is not None:
        return [FootOnItsSign(side), KneeOnItsSign(side), *rules]
    return [FootOnItsSign(side), StretchedKnee(side), *rules]
