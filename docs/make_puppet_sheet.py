"""Paints positions on the bodies of servos, for docs/puppet.md.

    python docs/make_puppet_sheet.py [FOLDER]

A row of the dancer, who is asked, and under her a row of the body that does what it can.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
import mujoco
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from enpointe.models import KeyPoseSolver, Style, dancer_model, pose_target
from enpointe.models.puppet import op3_model, puppet_model
from enpointe.motion import Motion
from enpointe.motion.puppeteering import puppeteer
from enpointe.posing import vocabulary_score
from enpointe.sim.camera import View
from enpointe.sim.render import open_painter

FOLDER = Path(__file__).parent / "images"
FONT = Path(matplotlib.get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf"
"""Pillow's own font has no accents."""
WIDTH, HEIGHT, LABEL = 170, 210, 16
POSITIONS = {
    "feet first": ("first", 180.0),
    "feet fifth": ("fifth", 180.0),
    "leg raised devant 90": ("grand battement", 130.0),
    "leg raised seconde 90": ("à la seconde", 180.0),
    "pose first arabesque": ("arabesque", 0.0),
}
"""Of each position what it is called, and the camera's azimuth, degrees."""
BODIES = {"puppet": puppet_model, "op3": op3_model}
HELD = 0.5
"""s that a position is held, to be put on a body."""
Array = NDArray[np.float64]


def asked(solver: KeyPoseSolver) -> dict[str, Array]:
    """The dancer's poses."""
    found = {}
    for name in POSITIONS:
        score = vocabulary_score(name)
        assert score is not None, name
        target = pose_target(score.resolved()[0], solver.figure, Style(real=True))
        found[name] = solver.solve(target).qpos
    return found


def on_body(model: mujoco.MjModel, dancer: mujoco.MjModel, pose: Array) -> Array:
    """A body in a dancer's pose."""
    time = np.arange(0.0, HELD, 0.01)
    held = Motion.from_qpos(dancer, time, np.tile(pose, (len(time), 1)))
    found: Array = puppeteer(held, model).motion.qpos[-1]
    return found


def row(model: mujoco.MjModel, poses: dict[str, Array], size: float) -> Image.Image:
    """Poses beside each other, from in front or from where the position is seen best."""
    page = Image.new("RGB", (WIDTH * len(poses), HEIGHT), "white")
    with open_painter(model, WIDTH, HEIGHT, quality="fine")[0] as painter:
        for column, (name, qpos) in enumerate(poses.items()):
            place = (float(qpos[0]), float(qpos[1]), 0.9 * size)
            view = View(azimuth=POSITIONS[name][1], distance=4.8 * size, lookat=place)
            page.paste(painter.paint(qpos, camera=view), (column * WIDTH, 0))
    return page


def tall(model: mujoco.MjModel) -> float:
    """Height of the crown in the first keyframe, m."""
    data = mujoco.MjData(model)
    data.qpos[:] = model.key_qpos[0]
    mujoco.mj_kinematics(model, data)
    return float(data.site("crown").xpos[2])


def main(folder: Path) -> None:
    solver = KeyPoseSolver(dancer_model())
    poses = asked(solver)
    font = ImageFont.truetype(str(FONT), 12)
    above = row(solver.model, poses, 1.0)
    for name, make in BODIES.items():
        model = make()
        made = {position: on_body(model, solver.model, pose) for position, pose in poses.items()}
        below = row(model, made, tall(model) / tall(solver.model))
        page = Image.new("RGB", (above.width, 2 * HEIGHT + LABEL), "white")
        page.paste(above, (0, 0))
        page.paste(below, (0, HEIGHT))
        ink = ImageDraw.Draw(page)
        for column, (words, _) in enumerate(POSITIONS.values()):
            ink.text((column * WIDTH + 4, 2 * HEIGHT + 1), words, fill="black", font=font)
        path = folder / f"{name}-poses.png"
        page.quantize(128).save(path, optimize=True)
        print(path)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
