"""Reads a score: text to :class:`~enpointe.notation.score.Score`, or a ScoreError with its place.

The grammar (grammar.lark) knows what may follow what. What it lexes loosely on purpose, numbers,
beats, names and header values, is judged here and by the readers of each kind of line, where an
error can say what a dancer should write instead.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from lark import Token, Tree

from enpointe.notation.check import faults_between
from enpointe.notation.frame import Frame
from enpointe.notation.frame_builder import FrameBuilder
from enpointe.notation.header import Header, read_phrase, read_repeat
from enpointe.notation.macros import Vocabulary
from enpointe.notation.plain_text import MAX_BYTES, parse_tree
from enpointe.notation.reading import Reader, location, tokens_of, trees_of
from enpointe.notation.score import Score
from enpointe.notation.signs import Location

__all__ = ["MAX_BYTES", "MAX_FRAMES", "VERSION", "check_version", "parse_score"]

VERSION = 1
"""The version of the format that this reads and writes."""

MAX_FRAMES = 10_000
"""Most key poses of a score; danced one a second, they last for three hours."""


def parse_score(
    text: str | bytes, source: str | None = None, vocabulary: Vocabulary | None = None
) -> Score:
    """Reads a score from its text.

    Args:
        text: The score; bytes are UTF-8, with or without a byte-order mark. Line ends may be of any
            kind.
        source: The name to give in error messages, such as the file's.
        vocabulary: A user's own names (:func:`~enpointe.notation.shelf.load_vocabulary`), which the
            score may use besides those of ballet.

    Returns:
        The score, with the place of everything in the text.

    Raises:
        ScoreError: Anything is wrong with it; nothing else is ever raised.
    """
    tree = parse_tree(text, source, "start")
    return _ScoreReader(Reader(source), vocabulary or Vocabulary()).score(tree)


def check_version(reader: Reader, node: Tree[Token]) -> int:
    """The version that a file starts with.

    Raises:
        ScoreError: It is another.
    """
    token = tokens_of(node)[0]
    if token != str(VERSION):
        raise reader.fail(
            f"version '{token[:20]}' of the format is not known; this reads 'benesh {VERSION}'",
            token,
        )
    return VERSION


class _ScoreReader:
    """Walks the parse tree of one score."""

    def __init__(self, reader: Reader, vocabulary: Vocabulary) -> None:
        self._reader = reader
        self._vocabulary = vocabulary
        self._header = Header(reader, {})

    def score(self, tree: Tree[Token]) -> Score:
        first, *nodes = trees_of(tree)
        version = check_version(self._reader, first)
        heading = [node for node in nodes if node.data != "frame"]
        beats = nodes[len(heading) :]
        for node in heading:
            if node.data == "field":
                self._header.add(node)
        if not beats:
            end = location(tokens_of(nodes[-1] if nodes else first)[0])
            self._header.require(end)
            raise self._reader.fail(
                "the score has no frames; after the header write 'beat 0:' and its signs", end
            )
        self._header.require(tokens_of(beats[0])[0])
        metre = self._header.metre()
        tempo, word = self._header.tempo()
        score = Score(
            title=self._header.text("title"),
            method=self._header.text("method"),
            metre=metre,
            tempo=tempo,
            frames=(),
            source=self._reader.source,
            version=version,
            tempo_word=word,
            pickup=self._header.pickup(metre),
            repeats=tuple(read_repeat(self._reader, n) for n in heading if n.data == "repeat"),
            phrases=tuple(read_phrase(self._reader, n) for n in heading if n.data == "phrase"),
        )
        return self._whole(score, beats)

    def _whole(self, score: Score, nodes: list[Tree[Token]]) -> Score:
        frames: list[Frame] = []
        for node in nodes:
            if len(frames) == MAX_FRAMES:
                raise self._reader.fail(
                    f"too long; a score has at most {MAX_FRAMES} frames", tokens_of(node)[0]
                )
            frames.append(self._frame(score, node, frames[-1] if frames else None))
        score = replace(score, frames=tuple(frames))
        for fault in faults_between(score):
            raise self._reader.fail(fault.message, fault.at or Location(1, 1))
        score.resolved()
        return score

    def _frame(self, score: Score, node: Tree[Token], before: Frame | None) -> Frame:
        tokens = tokens_of(node)
        beat, when = self._beat(score, tokens), tokens[-1]
        if before is None and beat != 0:
            raise self._reader.fail(
                "the first frame stands at beat 0, the pose to start from", when
            )
        if before is not None and beat == before.beat:
            raise self._reader.fail(
                f"beat {when} was already written on line {before.at.line}", when
            )
        if before is not None and beat < before.beat:
            raise self._reader.fail(
                f"beat {when} comes after a later one on line {before.at.line}; beats go forward",
                when,
            )
        builder = FrameBuilder(self._reader, self._vocabulary)
        for line in trees_of(node):
            builder.add(line)
        return builder.frame(beat, location(tokens[0]), before)

    def _beat(self, score: Score, tokens: list[Token]) -> Fraction:
        when = tokens[-1]
        beat = self._reader.beat(when)
        if tokens[0].type != "BAR":
            return beat
        bar = self._reader.count(tokens[1])
        if not 1 <= beat < score.metre[0] + 1:
            raise self._reader.fail(
                f"a bar of {score.metre[0]}/{score.metre[1]} has the beats 1 to "
                f"{score.metre[0]} and their parts",
                when,
            )
        return score.beat_of(bar, beat)
