"""The braces in which BVH and ASK describe a skeleton."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from enpointe.errors import FormatError
from enpointe.motion.formats.skeleton import CHANNELS
from enpointe.motion.formats.text import finite_number, refuse_merge_marks, whole_number

__all__ = ["Node", "Vector", "parsed_tree", "unlike"]

Vector = tuple[float, float, float]
_CHANNEL = {name.lower(): name for name in CHANNELS}
_DEEPEST = 10_000


@dataclass
class Node:
    """One ROOT or JOINT.

    Attributes:
        name: As in the file.
        parent: Index among the nodes, or -1.
        line: Where it starts.
        offset: As in the file; None until it is read.
        channels: Names out of `CHANNELS`.
        ends: Offsets of its end sites, as in the file.
        end_names: What the file calls them, "Site" for nearly all.
    """

    name: str
    parent: int
    line: int
    offset: Vector | None = None
    channels: tuple[str, ...] | None = None
    ends: list[Vector] = field(default_factory=list)
    end_names: list[str] = field(default_factory=list)


@dataclass
class _Open:
    """A brace that is not closed yet: of a node, or of an end site (`node` is whose it is)."""

    node: int
    site: str | None = None
    offset: Vector | None = None


def parsed_tree(text: str, path: Path, first_line: int = 1) -> list[Node]:
    """The nodes between HIERARCHY and the end of the text, each behind its parent.

    Args:
        text: The head of the file.
        path: The file, for messages.
        first_line: Line of the file at which the text starts.

    Raises:
        FormatError: Anything that is no hierarchy, with its line.
    """
    reader = _Tree(path)
    line = first_line
    for line, words in _statements(text, first_line):
        reader.take(words, line)
    return reader.finished(line)


def unlike(names: list[str]) -> tuple[list[str], list[str]]:
    """Names made unlike one another by numbers behind them, and the warnings that say so."""
    taken, renamed = set(names), []
    seen: set[str] = set()
    fresh, last = [], dict.fromkeys(names, 1)
    for name in names:
        new = name
        if name in seen:
            while new in taken:
                last[name] += 1
                new = f"{name}_{last[name]}"
            renamed.append(f"a second joint is called {name!r}: it is {new!r} here")
        seen.add(name)
        taken.add(new)
        fresh.append(new)
    return fresh, renamed


def _statements(text: str, first_line: int) -> Iterator[tuple[int, list[str]]]:
    """Lines that are not blank, braces on lines of their own."""
    for line, content in enumerate(text.split("\n"), start=first_line):
        for part in content.replace("{", "\n{\n").replace("}", "\n}\n").split("\n"):
            words = part.split()
            if words:
                yield line, words


class _Tree:
    """Takes a hierarchy statement by statement."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.nodes: list[Node] = []
        self.open: list[_Open] = []
        self.named: _Open | None = None
        self.begun = False

    def take(self, words: list[str], line: int) -> None:
        key = words[0].lower()
        if not self.begun:
            refuse_merge_marks(words[0], self.path, line)
            if key != "hierarchy" or len(words) > 1:
                raise self.error(f"HIERARCHY expected, got {_shown(words)}", line)
            self.begun = True
        elif self.named is not None:
            if key != "{":
                raise self.error(f"'{{' expected behind a name, got {_shown(words)}", line)
            self.open.append(self.named)
            self.named = None
        elif key in ("root", "joint"):
            self.name_node(key, words, line)
        elif key == "end" and self.inside(line).site is None:
            site = " ".join(words[1:]) or "Site"
            self.named = _Open(self.open[-1].node, site)
        elif key == "offset":
            self.take_offset(words, line)
        elif key in ("channels", "channel") and self.inside(line).site is None:
            self.take_channels(words, line)
        elif key == "}":
            self.close(line)
        else:
            refuse_merge_marks(words[0], self.path, line)
            raise self.error(f"no part of a hierarchy: {_shown(words)}", line)

    def name_node(self, key: str, words: list[str], line: int) -> None:
        name = " ".join(words[1:])
        if not name:
            raise self.error(f"{words[0]} needs a name", line)
        if (key == "root") == bool(self.open):
            where = "a ROOT inside a joint" if self.open else "a JOINT outside every ROOT"
            raise self.error(f"{where}: {name[:40]!r}", line)
        if self.open and self.open[-1].site is not None:
            raise self.error(f"a joint inside an end site: {name[:40]!r}", line)
        if len(self.open) > _DEEPEST:
            raise self.error(f"more than {_DEEPEST} joints in a chain", line)
        parent = self.open[-1].node if self.open else -1
        self.nodes.append(Node(name, parent, line))
        self.named = _Open(len(self.nodes) - 1)

    def take_offset(self, words: list[str], line: int) -> None:
        inside = self.inside(line)
        if len(words) != 4:
            raise self.error(f"OFFSET needs 3 numbers, got {len(words) - 1}", line)
        x, y, z = (finite_number(word, self.path, line, "an OFFSET") for word in words[1:])
        node = self.nodes[inside.node]
        if (node.offset if inside.site is None else inside.offset) is not None:
            raise self.error(f"a second OFFSET in {node.name[:40]!r}", line)
        if inside.site is None:
            node.offset = (x, y, z)
        else:
            inside.offset = (x, y, z)

    def take_channels(self, words: list[str], line: int) -> None:
        node = self.nodes[self.inside(line).node]
        if node.channels is not None:
            raise self.error(f"second CHANNELS in {node.name[:40]!r}", line)
        if len(words) < 2:
            raise self.error("CHANNELS needs a number and names", line)
        count = whole_number(words[1], self.path, line, "the number of CHANNELS")
        if count != len(words) - 2:
            raise self.error(f"CHANNELS says {count} and names {len(words) - 2}", line)
        for word in words[2:]:
            if word.lower() not in _CHANNEL:
                raise self.error(f"no channel is called {word[:40]!r}; {' '.join(CHANNELS)}", line)
        channels = tuple(_CHANNEL[word.lower()] for word in words[2:])
        if len(set(channels)) < len(channels):
            raise self.error(f"a channel twice in {node.name[:40]!r}", line)
        node.channels = channels

    def close(self, line: int) -> None:
        inside = self.inside(line)
        self.open.pop()
        node = self.nodes[inside.node]
        if inside.site is None:
            if node.offset is None:
                raise self.error(f"{node.name[:40]!r} ends without an OFFSET", line)
            return
        if inside.offset is None:
            raise self.error(f"the end site of {node.name[:40]!r} has no OFFSET", line)
        node.ends.append(inside.offset)
        node.end_names.append(inside.site)

    def inside(self, line: int) -> _Open:
        if not self.open:
            raise self.error("outside every joint; is a '{' missing?", line)
        return self.open[-1]

    def finished(self, line: int) -> list[Node]:
        if self.named is not None or self.open:
            inside = self.named or self.open[-1]
            name = self.nodes[inside.node].name
            raise self.error(f"the hierarchy ends inside {name[:40]!r}; is a '}}' missing?", line)
        if not self.nodes:
            raise self.error("a hierarchy without a ROOT", line)
        return self.nodes

    def error(self, message: str, line: int) -> FormatError:
        return FormatError(message, self.path, line=line)


def _shown(words: list[str]) -> str:
    return repr(" ".join(words)[:40])
