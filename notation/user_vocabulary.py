"""Reads a user's own names for positions."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from lark import Token, Tree

from enpointe.notation.check import written_parts
from enpointe.notation.frame import Frame
from enpointe.notation.frame_builder import FrameBuilder
from enpointe.notation.macros import Vocabulary, laid_under
from enpointe.notation.parser import check_version
from enpointe.notation.plain_text import parse_tree
from enpointe.notation.reading import Reader, location, tokens_of, trees_of, words_of
from enpointe.notation.signs import Side
from enpointe.notation.spelling import fold
from enpointe.notation.vocabulary import Part, find_arms, find_leg, find_pose, pose_frame

__all__ = ["parse_vocabulary"]

_PARTS: dict[str, Part] = {"arms": "arms", "leg": "leg", "pose": "pose"}
_OF_AN_ARM = {f"{side} {kind}" for side in Side for kind in ("hand", "elbow")}
_OF_THE_LEG = {f"{Side.RIGHT} {kind}" for kind in ("foot", "knee", "support")}
_NOT_OF_A_POSE = {"turn", "place", "travel"}


def parse_vocabulary(text: str | bytes, source: str | None = None) -> Vocabulary:
    """Reads a vocabulary from its text; see :func:`~enpointe.notation.shelf.load_vocabulary`.

    Raises:
        ScoreError: Anything is wrong with it, with line and column.
    """
    reader = Reader(source)
    version, *nodes = trees_of(parse_tree(text, source, "vocabulary"))
    check_version(reader, version)
    vocabulary = Vocabulary()
    for node in nodes:
        part, name, frame = _macro(reader, node, vocabulary)
        key = (part, fold(name))
        vocabulary = Vocabulary(
            {**vocabulary.macros, key: frame}, {**vocabulary.spellings, key: name}
        )
    return vocabulary


def _macro(reader: Reader, node: Tree[Token], vocabulary: Vocabulary) -> tuple[Part, str, Frame]:
    keyword, kind = tokens_of(node)
    title, *lines = trees_of(node)
    part, name, at = _PARTS[kind.lower()], words_of(title), tokens_of(title)[0]
    known = {"arms": find_arms, "leg": find_leg, "pose": find_pose}[part](name)
    if known is not None or vocabulary.find(name, part) is not None:
        raise reader.fail(f"'{name[:60]}' has its meaning already; choose another name", at)
    builder = FrameBuilder(reader, vocabulary)
    for line in lines:
        builder.add(line)
    frame = builder.frame(Fraction(0), location(keyword), None)
    if part != "pose":
        return part, name, _only(reader, frame, part, at)
    if frame.pose is not None:
        frame = replace(laid_under(pose_frame(frame.pose, frame), frame), pose=None)
    for wrong in _NOT_OF_A_POSE.intersection(written_parts(frame)):
        raise reader.fail(f"'{wrong}' is no part of a pose; write it in the score", at)
    return part, name, frame


def _only(reader: Reader, frame: Frame, part: Part, at: Token) -> Frame:
    """The frame, if it has signs of its part and of nothing else."""
    mine = _OF_AN_ARM if part == "arms" else _OF_THE_LEG
    written = set(written_parts(frame))
    others = [frame.head, frame.body, frame.pelvis, frame.pose]
    if not written or not written <= mine or any(each is not None for each in others):
        lines = "left or right hand or elbow" if part == "arms" else "right foot, knee or leg"
        raise reader.fail(f"under 'define {part}' write signs of the {lines}, and nothing else", at)
    return frame
