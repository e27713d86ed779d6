"""Who dances: the dancer's body, its kinematics in CasADi, the rules of ballet and the pose solver."""

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
from enpointe.models.target import PoseTarget as PoseTarget
from enpointe.models.target import Style as Style
from enpointe.models.target import pose_target as pose_target
