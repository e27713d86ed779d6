"""Draws the contact sheet of docs/make_faults.py: each pose, close up, where it was wrong."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from make_images import PAPER, canvas
from numpy.typing import NDArray
from PIL import Image

from enpointe.models import KeyPose

_PIXELS = (176, 208)
_ACROSS = 8
_TALL = {
    "eyes": 0.62,
    "ankle": 0.5,
    "heel": 0.5,
    "knee": 1.0,
    "wrist": 0.62,
    "elbow": 0.95,
    "shoulder": 1.15,
    "hip": 1.75,
}
"""Height of the picture by what it looks at, m."""
_FAR = 40.0


def draw(
    faults: Sequence[Any],
    solved: Callable[[str, bool], KeyPose],
    model: mujoco.MjModel,
    path: Path,
) -> None:
    """Write the sheet."""
    width, height = _PIXELS
    rows = -(-len(faults) // _ACROSS)
    figure, axes = canvas(_ACROSS * width, rows * (height + 26))
    for n, fault in enumerate(faults):
        x, y = width * (n % _ACROSS), (height + 26) * (n // _ACROSS)
        picture = _close_up(model, solved(fault.pose, fault.real).qpos, fault.azimuth, fault.site)
        axes.imshow(picture, extent=(x + 3, x + width - 3, y + height, y + 2))
        axes.text(
            x + width / 2, y + height + 14, f"{n + 1}", ha="center", size=9, family="DejaVu Serif"
        )
    axes.set(xlim=(0, _ACROSS * width), ylim=(rows * (height + 26), 0))
    _save(figure, path)


def _close_up(
    model: mujoco.MjModel, qpos: NDArray[np.float64], azimuth: float, site: str
) -> NDArray[np.uint8]:
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    tall = next(tall for part, tall in _TALL.items() if site.endswith(part))
    camera = mujoco.MjvCamera()
    camera.azimuth, camera.elevation, camera.distance = azimuth, -6.0, _FAR
    camera.lookat[:] = data.site(site).xpos
    if tall > 1.2:
        camera.lookat[:] = data.subtree_com[0]
    model.vis.global_.fovy = float(np.degrees(2 * np.arctan(tall / 2 / _FAR)))
    option = mujoco.MjvOption()
    option.geomgroup[:] = [1, 1, 1, 0, 0, 0]
    width, height = (2 * n for n in _PIXELS)
    with mujoco.Renderer(model, height, width) as painter:
        painter.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False
        painter.update_scene(data, camera, option)
        large = Image.fromarray(painter.render())
    return np.asarray(large.resize(_PIXELS, Image.Resampling.LANCZOS))


def _save(figure: Any, path: Path) -> None:
    figure.savefig(path, dpi=100, facecolor=PAPER)
    picture = Image.open(path).convert("RGB").quantize(64, dither=Image.Dither.NONE)
    picture.save(path, optimize=True)
    print(f"{path.name}: {picture.width} x {picture.height}, {path.stat().st_size // 1000} kB")
