"""What is to be danced: a score in machine-readable Benesh notation.

Example:
    >>> from enpointe.notation import format_score, load_score, parse_score
    >>> from enpointe.notation import score_from_json, score_to_json
    >>> score = load_score("third-port-de-bras")
    >>> len(score.frames), score.frames[1].arms.name
    (9, 'fifth en haut')
    >>> score.resolved()[2].arms["left"].wrist.height  # not written at beat 2: held from beat 1
    5.75
    >>> parse_score(format_score(score)) == score == score_from_json(score_to_json(score))
    True
    >>> adage = load_score("adage-developpe").performed()  # its repeat written out, to the left
    >>> [str(adage.resolved()[index].feet.front) for index in (0, 9, -1)]
    ['right', 'left', 'right']
"""

from __future__ import annotations

from enpointe.notation.frame import ArmSigns as ArmSigns
from enpointe.notation.frame import Frame as Frame
from enpointe.notation.frame import ResolvedFrame as ResolvedFrame
from enpointe.notation.frame import ResolvedLeg as ResolvedLeg
from enpointe.notation.json_form import score_from_json as score_from_json
from enpointe.notation.json_form import score_schema as score_schema
from enpointe.notation.json_form import score_to_json as score_to_json
from enpointe.notation.macros import Vocabulary as Vocabulary
from enpointe.notation.mirror import mirrored as mirrored
from enpointe.notation.movement import Jump as Jump
from enpointe.notation.movement import Limb as Limb
from enpointe.notation.movement import Locomotion as Locomotion
from enpointe.notation.movement import PathKind as PathKind
from enpointe.notation.movement import PathMark as PathMark
from enpointe.notation.movement import StepKind as StepKind
from enpointe.notation.movement import Via as Via
from enpointe.notation.parser import VERSION as VERSION
from enpointe.notation.parser import parse_score as parse_score
from enpointe.notation.phrasing import Phrase as Phrase
from enpointe.notation.phrasing import Repeat as Repeat
from enpointe.notation.plain_text import MAX_BYTES as MAX_BYTES
from enpointe.notation.score import TEMPO_RANGE as TEMPO_RANGE
from enpointe.notation.score import Score as Score
from enpointe.notation.shelf import load_score as load_score
from enpointe.notation.shelf import load_vocabulary as load_vocabulary
from enpointe.notation.shelf import shipped_scores as shipped_scores
from enpointe.notation.signs import ArmsPosition as ArmsPosition
from enpointe.notation.signs import Bend as Bend
from enpointe.notation.signs import BodyPlace as BodyPlace
from enpointe.notation.signs import Depth as Depth
from enpointe.notation.signs import Direction as Direction
from enpointe.notation.signs import FeetPosition as FeetPosition
from enpointe.notation.signs import FloorContact as FloorContact
from enpointe.notation.signs import HandContact as HandContact
from enpointe.notation.signs import LegPosition as LegPosition
from enpointe.notation.signs import Location as Location
from enpointe.notation.signs import Orientation as Orientation
from enpointe.notation.signs import PosePosition as PosePosition
from enpointe.notation.signs import Side as Side
from enpointe.notation.signs import Sign as Sign
from enpointe.notation.signs import Support as Support
from enpointe.notation.stage import Facing as Facing
from enpointe.notation.stage import StagePlace as StagePlace
from enpointe.notation.stage import Travel as Travel
from enpointe.notation.stage import Turn as Turn
from enpointe.notation.stave import stave_svg as stave_svg
from enpointe.notation.vocabulary import arm_signs as arm_signs
from enpointe.notation.vocabulary import feet_signs as feet_signs
from enpointe.notation.vocabulary import leg_signs as leg_signs
from enpointe.notation.vocabulary import names as names
from enpointe.notation.vocabulary import pose_frame as pose_frame
from enpointe.notation.writer import format_beat as format_beat
from enpointe.notation.writer import format_score as format_score
