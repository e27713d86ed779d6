"""Who dances: the body, its kinematics in CasADi, the rules of ballet, the key-pose solver."""

from __future__ import annotations

from typing import TYPE_CHECKING

from enpointe.lazy import lazy

if TYPE_CHECKING:
    from enpointe.models.anthropometry import Anthropometry as Anthropometry
    from enpointe.models.anthropometry import Sex as Sex
    from enpointe.models.certificate import Certificate as Certificate
    from enpointe.models.certificate import RuleResult as RuleResult
    from enpointe.models.dancer import build_dancer as build_dancer
    from enpointe.models.dancer import dancer_model as dancer_model
    from enpointe.models.figure import Figure as Figure
    from enpointe.models.keypose import KeyPose as KeyPose
    from enpointe.models.keypose import KeyPoseSolver as KeyPoseSolver
    from enpointe.models.kinematics import Kinematics as Kinematics
    from enpointe.models.style import Style as Style
    from enpointe.models.target import PoseTarget as PoseTarget
    from enpointe.models.target import pose_target as pose_target

_HOMES = {
    "Anthropometry": "enpointe.models.anthropometry",
    "Certificate": "enpointe.models.certificate",
    "Figure": "enpointe.models.figure",
    "KeyPose": "enpointe.models.keypose",
    "KeyPoseSolver": "enpointe.models.keypose",
    "Kinematics": "enpointe.models.kinematics",
    "PoseTarget": "enpointe.models.target",
    "RuleResult": "enpointe.models.certificate",
    "Sex": "enpointe.models.anthropometry",
    "Style": "enpointe.models.style",
    "build_dancer": "enpointe.models.dancer",
    "dancer_model": "enpointe.models.dancer",
    "pose_target": "enpointe.models.target",
}

__all__ = [
    "Anthropometry",
    "Certificate",
    "Figure",
    "KeyPose",
    "KeyPoseSolver",
    "Kinematics",
    "PoseTarget",
    "RuleResult",
    "Sex",
    "Style",
    "build_dancer",
    "dancer_model",
    "pose_target",
]
__getattr__, __dir__ = lazy(__name__, _HOMES)
