"""Writes the tables of the docs that are made from the code, between their markers.

    python docs/make_tables.py

A table stands between `<!-- made by docs/make_tables.py: NAME -->` and `<!-- end -->`.
tests/docs fails where a page and the code differ.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable
from importlib.resources import files
from inspect import isabstract
from pathlib import Path

from enpointe.models import rules
from enpointe.models.anatomy import ANKLE, ELBOW, HIP, KNEE, NECK, SHOULDER, TOE, WAIST, WRIST
from enpointe.models.anthropometry import Anthropometry, Sex
from enpointe.models.rules import Kind, Rule
from enpointe.motion import PRESETS
from enpointe.notation.amounts import DEFAULT_DEGREES
from enpointe.notation.glyphs import GLYPHS
from enpointe.notation.stage import DIRECTION_WORDS
from enpointe.notation.tempo import TEMPO_WORDS
from enpointe.notation.vocabulary import ARM_PLACES, ARMS, FEET, LEGS, POSES
from enpointe.notation.vocabulary_arms import BODY_PLACES, CONTACT_PLACES
from enpointe.notation.vocabulary_feet import BENDS, FLOOR

sys.path.insert(0, str(Path(__file__).parent))
from prepose import CLAIMS, measured

DOCS = Path(__file__).parent
MARKED = re.compile(
    r"(<!-- made by docs/make_tables\.py: (\w+) -->\n).*?(<!-- end -->)", flags=re.DOTALL
)
SEGMENTS = (
    "head",
    "upper_trunk",
    "middle_trunk",
    "lower_trunk",
    "upper_arm",
    "forearm",
    "hand",
    "thigh",
    "shank",
    "foot",
)


def table(heads: Iterable[str], rows: Iterable[Iterable[object]]) -> str:
    """A Markdown table with a blank line before and after."""
    heads = list(heads)
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n" + "".join(f"| {' | '.join(str(c) for c in line)} |\n" for line in lines) + "\n"


def feet() -> str:
    return table(
        ("feet", "also called", "says which foot is in front", "open form", "is", "source"),
        (
            (
                e.name,
                ", ".join(e.aliases),
                "yes" if e.crossed else "no",
                "yes" if e.has_open else "no",
                e.description,
                e.source,
            )
            for e in FEET
        ),
    )


def legs() -> str:
    def height(degrees: tuple[float, float, float] | None) -> str:
        if degrees is None:
            return ""
        least, usual, most = degrees
        return f"{usual:g}°, {least:g}° to {most:g}°"

    return table(
        ("leg", "also called", "directions", "height", "is", "source"),
        (
            (
                e.name,
                ", ".join(e.aliases),
                ", ".join(e.directions),
                height(e.degrees),
                e.description,
                e.source,
            )
            for e in LEGS
        ),
    )


def poses() -> str:
    return table(
        ("pose on the left leg", "also called", "right leg", "is", "source", "ours"),
        (
            (
                e.name,
                ", ".join(e.aliases),
                " ".join(str(word) for word in (e.leg.name, e.leg.direction) if word is not None),
                e.description,
                e.source,
                e.ours,
            )
            for e in POSES
        ),
    )


def arms() -> str:
    return table(
        ("arms", "also called", "leading arm", "other arm", "is", "source"),
        ((e.name, ", ".join(e.aliases), e.leading, e.other, e.description, e.source) for e in ARMS),
    )


def places() -> str:
    def sign(name: str) -> str:
        wrist = ARM_PLACES[name].wrist
        straight = ", straight" if wrist.straight else ""
        return f"{wrist.width:g} wide, {wrist.height:g} high, {wrist.depth}{straight}"

    return table(
        ("place", "sign of the wrist", "is", "source of the words"),
        ((name, sign(name), p.description, p.source) for name, p in ARM_PLACES.items()),
    )


def degrees() -> str:
    parts = ("head", "body", "pelvis")
    turns = ("turn", "tilt", "bend")
    return table(
        ("", *turns),
        ((part, *(f"{DEFAULT_DEGREES[part, turn]:g}°" for turn in turns)) for part in parts),
    )


def tempos() -> str:
    return table(("word", "beats a minute"), ((word, f"{n:g}") for word, n in TEMPO_WORDS.items()))


def stances() -> str:
    words = [(also, "the foot") for also in FLOOR.values()]
    words += [(also, "the knee") for also in BENDS.values()]
    return table(
        ("word", "also", "says of"),
        ((also[0], ", ".join(also[1:]), of) for also, of in words),
    )


def body() -> str:
    return table(
        ("place", "also", "is"),
        (
            (words[0], ", ".join(words[1:]), CONTACT_PLACES[place].description)
            for place, words in BODY_PLACES.items()
        ),
    )


def directions() -> str:
    def side(degrees: float) -> str:
        if degrees in (0.0, 180.0):
            return f"{degrees:g}°"
        return f"{'left' if degrees > 0 else 'right'} {abs(degrees):g}°"

    return table(
        ("direction", "also", "from the audience"),
        ((words[0], ", ".join(words[1:]), side(d)) for d, words in DIRECTION_WORDS.items()),
    )


def grammar() -> str:
    text = files("enpointe.notation").joinpath("grammar.lark").read_text("utf-8")
    rules = text[text.index("start:") : text.index("\n_BENESH:")].strip()
    return f"\n```lark\n{rules}\n```\n\n"


def glyphs() -> str:
    return table(
        ("sign", "shape", "source"),
        (
            (name, "confirmed" if g.confirmed else "provisional", g.source)
            for name, g in GLYPHS.items()
        ),
    )


def presets() -> str:
    return table(
        ("effort", "time $b$", "weight $x_0$", "space $S$", "tempo", "source"),
        (
            (
                p.name,
                f"{p.effort.time:g}",
                f"{p.effort.weight:g}",
                f"{p.effort.space:g}",
                f"{p.tempo:g}",
                p.source,
            )
            for p in PRESETS.values()
        ),
    )


def segments() -> str:
    bodies = (Anthropometry(), Anthropometry(1.80, 72.0, Sex.MALE))

    def row(name: str) -> list[str]:
        cells = [name.replace("_", " ")]
        for body in bodies:
            s = body.segment(name)
            cells += [
                f"{1000 * s.length:.0f}",
                f"{s.mass:.2f}",
                f"{1000 * s.com:.0f}",
                ", ".join(f"{1000 * r:.0f}" for r in s.gyration),
            ]
        return cells

    heads = ["segment"]
    for who in ("she", "he"):
        heads += [f"{who}: length", "mass", "centre", "gyration"]
    return table(heads, map(row, SEGMENTS))


def joints() -> str:
    def axis(v: Iterable[float]) -> str:
        return "(" + ", ".join(f"{x:.2g}".replace("0.71", ".71") for x in v) + ")"

    groups = (WAIST, NECK, SHOULDER, ELBOW, WRIST, HIP, KNEE, ANKLE, TOE)
    return table(
        ("hinge", "axis, left side", "range", "strength, N m/kg", "armature", "damping"),
        (
            (
                f"`{h.name}`",
                axis(h.axis),
                f"{h.range_deg[0]:g}° to {h.range_deg[1]:g}°",
                f"{h.strength:g}",
                f"{h.armature:g}",
                f"{h.damping:g}",
            )
            for group in groups
            for h in group
        ),
    )


def ballet() -> str:
    found = [value for value in vars(rules).values() if _is_rule(value)]
    words = {
        Kind.EQUAL: "equation",
        Kind.AT_LEAST: "inequality",
        Kind.PREFER: "cost",
        Kind.CHECK: "checked only",
        Kind.CHECK_AT_LEAST: "checked only",
    }
    return table(
        ("rule", "the solver sees", "holds within", "weight", "source"),
        (
            (
                r.name,
                words[r.kind],
                f"{'at least ' if r.kind.is_margin else ''}{r.bound:g} "
                f"{'°' if r.unit == 'deg' else r.unit}".replace(" °", "°"),
                f"{r.weight:g}" if r.kind is Kind.PREFER else "",
                r.source,
            )
            for r in sorted(found, key=lambda r: (r.__module__, r.name))
        ),
    )


def prepose() -> str:
    rows = zip(CLAIMS, measured(), strict=True)
    return table(
        ("position", "limb", "from", "Prepose", "ours", "difference"),
        (
            (
                c.position,
                f"{c.side} {c.bone}",
                "up" if c.up else "down",
                f"{c.degrees:+g}°",
                f"{ours:+.0f}°",
                f"{ours - c.degrees:+.0f}°",
            )
            for c, ours in rows
        ),
    )


def _is_rule(value: object) -> bool:
    return isinstance(value, type) and issubclass(value, Rule) and not isabstract(value)


TABLES: dict[str, Callable[[], str]] = {
    f.__name__: f
    for f in (
        feet,
        legs,
        arms,
        poses,
        places,
        degrees,
        tempos,
        stances,
        body,
        directions,
        grammar,
        glyphs,
        presets,
        segments,
        joints,
        ballet,
        prepose,
    )
}


def filled(text: str) -> str:
    """A page with its tables made anew."""
    return MARKED.sub(lambda m: m[1] + TABLES[m[2]]() + m[3], text)


if __name__ == "__main__":
    for page in sorted(DOCS.glob("*.md")):
        old = page.read_text(encoding="utf-8")
        new = filled(old)
        if new != old:
            page.write_text(new, encoding="utf-8")
            print(page.name)
