"""What a report is made of: sections of text, tables, charts, pictures and films.

The template knows these and nothing else, so that a section without content is simply not there.
"""

from __future__ import annotations

import base64
from dataclasses import dataclass

__all__ = [
    "Block",
    "Cell",
    "Chart",
    "Film",
    "Folded",
    "Gallery",
    "Page",
    "Paragraph",
    "Picture",
    "Row",
    "Section",
    "Stave",
    "Table",
    "Verbatim",
    "data_uri",
]


@dataclass(frozen=True, slots=True)
class Paragraph:
    """A paragraph of plain text."""

    text: str
    kind: str = "paragraph"


@dataclass(frozen=True, slots=True)
class Verbatim:
    """Text whose lines and spaces matter."""

    text: str
    kind: str = "verbatim"


@dataclass(frozen=True, slots=True)
class Cell:
    """One cell of a table.

    Attributes:
        text: What people read.
        value: The number behind it, in SI units, for scripts; None where there is none.
        broken: Whether it is to stand out as broken.
    """

    text: str
    value: float | None = None
    broken: bool = False


@dataclass(frozen=True, slots=True)
class Row:
    """A row of a table.

    Attributes:
        head: Its header.
        cells: As many as the table has columns after the first.
        figure: Name of its figure in `summary()`, or "".
    """

    head: str
    cells: tuple[Cell, ...]
    figure: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table whose first column heads the rows.

    Attributes:
        caption: What it shows.
        columns: Header of each column, the first column's too.
        rows: In order.
        prose: Whether its last column is prose, to be set wide.
    """

    caption: str
    columns: tuple[str, ...]
    rows: tuple[Row, ...]
    prose: bool = False
    kind: str = "table"


@dataclass(frozen=True, slots=True)
class Chart:
    """A drawing as an SVG element with ids of its own.

    Attributes:
        svg: Trusted markup.
        caption: How to read it.
    """

    svg: str
    caption: str
    kind: str = "chart"


@dataclass(frozen=True, slots=True)
class Stave:
    """The score on the stave.

    Attributes:
        svg: Trusted markup; its frames are `frame-N`.
        caption: How to read it.
        frames: How many it has.
        times: When each frame is reached in the film, s; empty without a film to seek in.
    """

    svg: str
    caption: str
    frames: int
    times: tuple[float, ...] = ()
    kind: str = "stave"


@dataclass(frozen=True, slots=True)
class Picture:
    """One picture of a gallery.

    Attributes:
        uri: As a data URI.
        size: Width and height, pixels.
        alt: What is to be seen, for those who can't.
        title: Under it.
        lines: What the score writes there.
        note: The verdict, under that.
        broken: Whether the note is bad news.
    """

    uri: str
    size: tuple[int, int]
    alt: str
    title: str
    lines: tuple[str, ...]
    note: str
    broken: bool = False


@dataclass(frozen=True, slots=True)
class Gallery:
    """Pictures in rows.

    Attributes:
        pictures: In order.
        abreast: How many stand side by side; as many as there is room for if 0.
    """

    pictures: tuple[Picture, ...]
    abreast: int = 0
    kind: str = "gallery"


@dataclass(frozen=True, slots=True)
class Film:
    """A moving picture.

    Attributes:
        uri: As a data URI.
        mime: "video/mp4" or "image/gif".
        size: Width and height, pixels.
        alt: What is to be seen.
        caption: Under it.
    """

    uri: str
    mime: str
    size: tuple[int, int]
    alt: str
    caption: str
    kind: str = "film"


@dataclass(frozen=True, slots=True)
class Folded:
    """Blocks behind a line that unfolds them."""

    summary: str
    blocks: tuple[Block, ...]
    kind: str = "folded"


Block = Paragraph | Verbatim | Table | Chart | Stave | Gallery | Film | Folded


@dataclass(frozen=True, slots=True)
class Section:
    """A part of the page.

    Attributes:
        anchor: Its id.
        title: Its heading.
        blocks: In order.
    """

    anchor: str
    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class Page:
    """A report.

    Attributes:
        title: Of the dance.
        verdict: What it honestly is, in a sentence or two.
        good: Whether the verdict is good news; None for neither.
        facts: Pairs of a word and what it is, under the title.
        warning: What the reader must know of the pictures, or None.
        sections: In order.
        footer: How it was made.
    """

    title: str
    verdict: str
    good: bool | None
    facts: tuple[tuple[str, str], ...]
    warning: str | None
    sections: tuple[Section, ...]
    footer: str


def data_uri(mime: str, data: bytes) -> str:
    """The bytes as a URI that needs no request."""
    return f"data:{mime};base64,{base64.b64encode(data).decode('ascii')}"
