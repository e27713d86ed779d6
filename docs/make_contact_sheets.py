"""Paints every position of the vocabulary from the front and from the side, for docs/positions.md.

    python docs/make_contact_sheets.py [FOLDER]

One sheet each for feet, arms, legs and poses of the perfect dancer, and one of the legs of the real
one, who lends her pelvis to them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
from PIL import Image, ImageDraw, ImageFont

from enpointe.models import KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.notation import names
from enpointe.posing import vocabulary_score
from enpointe.sim.camera import View
from enpointe.sim.render import open_painter

FOLDER = Path(__file__).parent / "images"
FONT = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
"""Pillow's own font has no accents."""
WIDTH, HEIGHT, LABEL = 140, 180, 18
COLUMNS = 6
VIEWS = (View(distance=4.6), View(azimuth=90.0, distance=4.6))
SHEETS = {
    "feet": ("feet ", False),
    "arms": ("arms ", False),
    "legs": ("leg ", False),
    "legs-real": ("leg ", True),
    "poses": ("pose ", False),
}


def sheet(solver: KeyPoseSolver, part: str, *, real: bool) -> Image.Image:
    """The positions whose names begin with `part`, a row after another."""
    chosen = [name for name in names() if name.startswith(part)]
    rows = -(-len(chosen) // COLUMNS)
    cell = (2 * WIDTH, HEIGHT + LABEL)
    page = Image.new("RGB", (COLUMNS * cell[0], rows * cell[1]), "white")
    ink, font = ImageDraw.Draw(page), ImageFont.truetype(str(FONT), 12)
    with open_painter(solver.model, WIDTH, HEIGHT, quality="fine")[0] as painter:
        for i, name in enumerate(chosen):
            score = vocabulary_score(name)
            assert score is not None
            style = Style(real=real)
            qpos = solver.solve(pose_target(score.resolved()[0], solver.figure, style)).qpos
            x, y = i % COLUMNS * cell[0], i // COLUMNS * cell[1]
            for j, view in enumerate(VIEWS):
                page.paste(painter.paint(qpos, camera=view.following()), (x + j * WIDTH, y))
            ink.text((x + 4, y + HEIGHT + 2), name.removeprefix(part), fill="black", font=font)
    return page


def main(folder: Path) -> None:
    solver = KeyPoseSolver(dancer_model())
    for name, (part, real) in SHEETS.items():
        path = folder / f"positions-{name}.jpg"
        sheet(solver, part, real=real).save(path, quality=82)
        print(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
