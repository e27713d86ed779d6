"""Paints captured dancers beside what `retarget` makes of them, for docs/retargeting.md.

    python docs/make_retarget_sheet.py FOLDER [PICTURE]

FOLDER holds CMU's subject 05 (05.asf and its takes). Each cell is one moment: the captured skeleton
as sticks, its left in red, and the dancer from the same side.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from enpointe.motion.formats import SkeletonMotion, read
from enpointe.motion.retargeting import Retargeted, retarget
from enpointe.motion.retargeting.floor import levelled
from enpointe.motion.retargeting.source import source_of
from enpointe.sim.camera import Projection, View
from enpointe.sim.render import Painter, open_painter

PICTURE = Path(__file__).parent / "images" / "retargeting.jpg"
WIDTH, HEIGHT, LABEL = 190, 240, 16
SHEET = {
    "05_14": ("arabesque", (480, 505, 520, 540)),
    "05_16": ("jeté", (186, 198, 210, 222)),
    "05_09": ("glissade", (600, 640, 690, 740)),
}
"""Of each take, what it is and frames at its own rate."""
LEFT, RIGHT, MIDDLE = (200, 60, 50), (40, 80, 160), (70, 70, 70)
Array = NDArray[np.float64]


def sticks(motion: SkeletonMotion, made: Retargeted, frame: int, view: View) -> Image.Image:
    """The captured skeleton, as large as the dancer and over her place."""
    source = source_of(motion, made.map)
    points = motion.skeleton.space.points(motion.world()[0][frame])
    raised = levelled(source).points["left_toe"][frame] - source.points["left_toe"][frame]
    hips = 0.5 * (source.points["left_hip"] + source.points["right_hip"])[frame]
    placed = made.scale * (points + raised)
    placed[:, :2] += made.motion.qpos[frame, :2] - made.scale * (hips + raised)[:2]
    page = Image.new("RGB", (WIDTH, HEIGHT), (247, 244, 237))
    ink = ImageDraw.Draw(page)
    projection = Projection(view, WIDTH, HEIGHT)
    floor = np.array([*made.motion.qpos[frame, :2], 0.0])
    rim = [floor + [0.6 * np.cos(a), 0.6 * np.sin(a), 0.0] for a in np.linspace(0, 2 * np.pi, 33)]
    ink.line([tuple(p) for p in projection.to_pixels(projection.to_camera(np.array(rim)))], "#bbb")
    pixels = projection.to_pixels(projection.to_camera(placed))
    for joint, parent in enumerate(each.parent for each in motion.skeleton.joints):
        if parent >= 0:
            name = motion.skeleton.names[joint].lower()
            side = LEFT if name[0] == "l" and not name.startswith("low") else MIDDLE
            colour = RIGHT if name[0] == "r" else side
            ink.line([tuple(pixels[parent]), tuple(pixels[joint])], fill=colour, width=3)
    return page


def cell(painter: Painter, motion: SkeletonMotion, made: Retargeted, frame: int) -> Image.Image:
    """One moment, captured and danced."""
    qpos = made.motion.qpos[frame]
    heading = np.degrees(
        np.arctan2(
            2 * (qpos[3] * qpos[6] + qpos[4] * qpos[5]), 1 - 2 * (qpos[5] ** 2 + qpos[6] ** 2)
        )
    )
    view = View(
        azimuth=heading + 125.0, distance=5.2, lookat=(float(qpos[0]), float(qpos[1]), 0.95)
    )
    page = Image.new("RGB", (2 * WIDTH, HEIGHT), "white")
    page.paste(sticks(motion, made, frame, view), (0, 0))
    page.paste(painter.paint(qpos, camera=view), (WIDTH, 0))
    return page


def main(folder: Path, picture: Path) -> None:
    columns = max(len(frames) for _, frames in SHEET.values())
    page = Image.new("RGB", (columns * 2 * WIDTH, len(SHEET) * (HEIGHT + LABEL)), "white")
    ink = ImageDraw.Draw(page)
    for row, (take, (what, frames)) in enumerate(SHEET.items()):
        motion = read(folder / f"{take}.amc").motion
        assert isinstance(motion, SkeletonMotion)
        made = retarget(motion)
        with open_painter(made.motion.model, WIDTH, HEIGHT, quality="fine")[0] as painter:
            for column, frame in enumerate(frames):
                x, y = column * 2 * WIDTH, row * (HEIGHT + LABEL)
                page.paste(cell(painter, motion, made, frame), (x, y))
                ink.text((x + 4, y + HEIGHT + 2), f"{take} {what}, frame {frame}", fill="black")
    page.save(picture, quality=82)
    print(picture)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else PICTURE)
