"""Every position of the vocabulary solved once a process, on both dancers and both sides."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from enpointe.models import KeyPose, Style, pose_target
from enpointe.models.recognition import Recogniser, recogniser_of
from enpointe.notation import ResolvedFrame, Side, mirrored, names
from enpointe.posing import vocabulary_score

from .posing import solver_of

ALL = tuple((name, side, real) for name in names() for side in Side for real in (False, True))


def frame_of(name: str, side: Side = Side.RIGHT) -> ResolvedFrame:
    """The frame of a position; the side leads, works or is in front."""
    score = vocabulary_score(name)
    assert score is not None
    return (score if side is Side.RIGHT else mirrored(score)).resolved()[0]


@cache
def solved(name: str, side: Side = Side.RIGHT, real: bool = False) -> KeyPose:
    solver = solver_of("default")
    return solver.solve(
        pose_target(frame_of(name, side), solver.figure, replace(Style(), real=real), name=name)
    )


@cache
def recogniser() -> Recogniser:
    return recogniser_of(solver_of("default").model)
